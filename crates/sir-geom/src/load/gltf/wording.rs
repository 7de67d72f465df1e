//! Messages of the JSON reader in plain words.

/// Rewrites a message about a value of a wrong type, such as ``invalid type: map, expected u32``, without the names of
/// Rust types. Other messages are returned as they are.
pub(super) fn plain(message: &str) -> String {
    if let Some(name) = message.strip_prefix("missing field ") {
        return format!("{name} is missing");
    }
    let rest =
        ["invalid type: ", "invalid value: ", "invalid length "].iter().find_map(|p| message.strip_prefix(p));
    let Some((found, expected)) = rest.and_then(|rest| rest.split_once(", expected ")) else {
        return message.to_owned();
    };
    let found = match found.split_once(' ') {
        _ if message.starts_with("invalid length ") => format!("a list of length {found}"),
        Some(("integer" | "number" | "boolean", value)) => value.trim_matches('`').to_owned(),
        Some(("floating", value)) => value.trim_start_matches("point ").trim_matches('`').to_owned(),
        Some(("string", value)) => format!("the text {value}"),
        _ => match found {
            "map" => "an object".to_owned(),
            "sequence" => "a list".to_owned(),
            _ => found.to_owned(),
        },
    };
    format!("found {found}, expected {}", expectation(expected))
}

/// Describes what the reader expected.
fn expectation(expected: &str) -> &str {
    match expected {
        "u8" | "u16" | "u32" | "u64" | "usize" | "index into child of root" => {
            "a whole number that is not negative"
        }
        "f32" | "f64" => "a number",
        "a boolean" => "true or false",
        "a sequence" => "a list",
        "a map" => "an object",
        "a string" => "a text",
        _ if expected.starts_with("struct ") => "an object",
        _ if expected.starts_with("tuple struct ") => "a number or a list of numbers",
        _ => match expected.strip_prefix("an array of length ") {
            Some("2") => "a list of 2 numbers",
            Some("3") => "a list of 3 numbers",
            Some("4") => "a list of 4 numbers",
            Some("16") => "a list of 16 numbers",
            _ => expected,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn messages_name_no_types_of_the_program() {
        for (message, expected) in [
            (
                "invalid type: floating point `1.5`, expected u32",
                "found 1.5, expected a whole number that is not negative",
            ),
            (
                "invalid value: integer `-1`, expected index into child of root",
                "found -1, expected a whole number that is not negative",
            ),
            ("invalid type: string \"much\", expected f32", "found the text \"much\", expected a number"),
            ("invalid type: map, expected a sequence", "found an object, expected a list"),
            (
                "invalid length 0, expected struct Asset with 6 elements",
                "found a list of length 0, expected an object",
            ),
            (
                "invalid length 2, expected an array of length 3",
                "found a list of length 2, expected a list of 3 numbers",
            ),
            ("invalid type: null, expected a string", "found null, expected a text"),
            ("missing field `count`", "`count` is missing"),
            ("something else", "something else"),
        ] {
            assert_eq!(plain(message), expected, "{message}");
        }
    }
}
