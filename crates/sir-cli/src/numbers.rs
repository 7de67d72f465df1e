//! Parsers of option values, with range checks.

use std::num::NonZeroUsize;
use std::time::Duration;

use sir_geom::Rgb;

pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let number = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    number.ok_or_else(|| "write a number of seconds, 0 or more".into())
}

/// Parses a time in minutes.
pub(crate) fn minutes(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|minutes| (0.001..=100_000.0).contains(minutes));
    number.ok_or_else(|| "write a number of minutes from 0.001 to 100000, such as 2".into())
}

/// Parses a share in per cent, such as `2%`.
pub(crate) fn per_cent(text: &str) -> Result<f64, String> {
    let number = text.trim().strip_suffix('%').and_then(|number| number.trim().parse::<f64>().ok());
    let number = number.filter(|number| (0.001..=100.0).contains(number));
    number
        .map(|number| number / 100.0)
        .ok_or_else(|| "write a number from 0.001 to 100 with a per cent sign, such as 2%".into())
}

pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let number = text.parse().ok().filter(|&n| n <= 4096).and_then(NonZeroUsize::new);
    number.ok_or_else(|| "write a whole number from 1 to 4096".into())
}

fn number(text: &str, most: usize) -> Option<NonZeroUsize> {
    text.trim().parse().ok().filter(|&n| n <= most).and_then(NonZeroUsize::new)
}

/// Parses the factor of a light group, such as `desk=0.5` or `sky=(1, 0.9, 0.8)`.
pub(crate) fn factor(text: &str) -> Result<(String, Rgb), String> {
    let help =
        || "write the name of a light group and a factor, such as `desk=0.5` or `sky=1,0.9,0.8`".to_owned();
    // A name may contain an equals sign, a factor does not.
    let (name, factor) = text.rsplit_once('=').filter(|(name, _)| !name.is_empty()).ok_or_else(help)?;
    let factor = factor.trim();
    let inner = factor.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(factor);
    let numbers: Vec<f64> =
        inner.split(',').map(|number| number.trim().parse()).collect::<Result<_, _>>().map_err(|_| help())?;
    if !numbers.iter().all(|number| number.is_finite() && *number >= 0.0) {
        return Err("a factor must be a finite number, 0 or more".into());
    }
    match numbers[..] {
        [gray] => Ok((name.into(), Rgb::splat(gray))),
        [r, g, b] => Ok((name.into(), Rgb::new(r, g, b))),
        _ => Err(help()),
    }
}

pub(crate) fn workers(text: &str) -> Result<NonZeroUsize, String> {
    number(text, 4096).ok_or_else(|| "write whole numbers from 1 to 4096, with commas between them".into())
}

pub(crate) fn repeats(text: &str) -> Result<NonZeroUsize, String> {
    number(text, 1000).ok_or_else(|| "write a whole number from 1 to 1000".into())
}

pub(crate) fn command_words(text: &str) -> Result<String, String> {
    if text.trim().is_empty() {
        return Err("write a command, such as `mpirun` or `srun`".into());
    }
    Ok(text.into())
}

pub(crate) fn scale(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|&s| s > 0.0 && s <= 1.0);
    number.ok_or_else(|| "write a number above 0 and at most 1, such as 0.01".into())
}

pub(crate) fn reference(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|f| (1.0..=10_000.0).contains(f));
    number.ok_or_else(|| "write a number from 1 to 10000, such as 20".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_has_a_per_cent_sign() {
        assert_eq!((per_cent("2%"), per_cent("0.5 %")), (Ok(0.02), Ok(0.005)));
        for bad in ["2", "0.02", "%", "-1%", "0%", "NaN%", "101%"] {
            assert!(per_cent(bad).is_err(), "{bad}");
        }
        assert_eq!(minutes("0.5"), Ok(0.5));
        for bad in ["0", "-1", "NaN", "inf", "soon"] {
            assert!(minutes(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn factors_are_numbers_or_colors() {
        assert_eq!(factor("desk=0.5"), Ok(("desk".into(), Rgb::splat(0.5))));
        assert_eq!(factor("a=b = 2"), Ok(("a=b ".into(), Rgb::splat(2.0))));
        for color in ["(1,0.9,0)", "1, 0.9, 0", "( 1,0.9 , 0 )"] {
            assert_eq!(factor(&format!("sky={color}")), Ok(("sky".into(), Rgb::new(1.0, 0.9, 0.0))));
        }
        for bad in [
            "desk",
            "=1",
            "desk=",
            "desk=bright",
            "desk=1,2",
            "desk=(1,2,3",
            "desk=-1",
            "desk=inf",
            "desk=NaN",
        ] {
            assert!(factor(bad).is_err(), "{bad}");
        }
    }
}
