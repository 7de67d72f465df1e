//! Suggestions for misspelled names.

/// Returns "did you mean …?" if `name` resembles one of `candidates`.
pub(crate) fn did_you_mean<S: AsRef<str>>(name: &str, candidates: &[S]) -> Option<String> {
    resembling(name, candidates).map(|best| format!("did you mean `{}`?", best.as_ref()))
}

/// Shortest name that may be the beginning of another.
const MIN_BEGINNING: usize = 3;

/// Returns the one of `candidates` that `name` probably misspells: one that begins with it, or else the nearest.
pub(crate) fn resembling<'c, S: AsRef<str>>(name: &str, candidates: &'c [S]) -> Option<&'c S> {
    let lower = name.to_lowercase();
    let near = |c: &S| strsim::damerau_levenshtein(&lower, &c.as_ref().to_lowercase());
    let begins = |c: &&S| name.len() >= MIN_BEGINNING && c.as_ref().to_lowercase().starts_with(&lower);
    if let Some(longer) = candidates.iter().filter(begins).min_by_key(|c| near(c)) {
        return Some(longer);
    }
    let best = candidates.iter().min_by_key(|c| near(c))?;
    (near(best) <= 1 + best.as_ref().len() / 4 && !name.is_empty()).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_are_near() {
        let fields = ["patches", "max_area"];
        assert_eq!(did_you_mean("patch", &fields), Some("did you mean `patches`?".into()));
        assert_eq!(did_you_mean("MaxArea", &fields).as_deref(), Some("did you mean `max_area`?"));
        assert_eq!(did_you_mean("color", &fields), None);
        assert_eq!(did_you_mean("dim", &["aim", "dimming"]).as_deref(), Some("did you mean `dimming`?"));
    }
}
