//! Encodings of text files.

/// Returns the text of a file in UTF-8, if it is UTF-16, as some programs on Windows write. It is recognized by its
/// byte order mark or, since the first character is ASCII in all formats here, by a zero among the first two bytes. Any
/// other text is returned as it is. A byte order mark stays.
#[must_use]
pub fn utf8_text(bytes: Vec<u8>) -> Vec<u8> {
    let unit = match bytes[..] {
        [0xff, 0xfe, ..] | [1..=0xff, 0, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] | [0, 1..=0xff, ..] => u16::from_be_bytes,
        _ => return bytes,
    };
    let (units, _) = bytes.as_chunks::<2>();
    let characters = char::decode_utf16(units.iter().map(|&pair| unit(pair)));
    let text: String = characters.map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    text.into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf16_is_decoded_and_everything_else_stays() {
        let text = "\u{feff}v 1 \u{4e2d}\u{1f4a1}\r\n";
        for text in [text, &text[3..]] {
            for order in [u16::to_le_bytes, u16::to_be_bytes] {
                let bytes: Vec<u8> = text.encode_utf16().flat_map(order).collect();
                assert_eq!(utf8_text(bytes.clone()), text.as_bytes());
                assert_eq!(utf8_text([&bytes[..], b"x"].concat()), text.as_bytes());
            }
        }
        for bytes in [&b""[..], b"v", b"v 1 2", b"\xff", b"\0", b"\0\0", b"caf\xe9", b"\xef\xbb\xbfv"] {
            assert_eq!(utf8_text(bytes.to_vec()), bytes);
        }
    }
}
