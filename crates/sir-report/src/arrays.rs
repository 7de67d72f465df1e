//! Arrays of numbers, coded so that they deflate well.

use serde_json::{Map, Value, json};

/// How an array is coded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Coding {
    /// Differences to the element before, modulo the range of the numbers, with the sign in the lowest bit.
    Differences,
    /// The numbers themselves.
    Plain,
}

/// Coded arrays, and the part of a JSON header that describes them.
#[derive(Default)]
pub(crate) struct Arrays {
    header: Map<String, Value>,
    bytes: Vec<u8>,
}

impl Arrays {
    /// Adds an array of elements with `N` components of `width` bytes: planes of bytes, component by component, the low byte
    /// first.
    pub(crate) fn add<const N: usize>(
        &mut self,
        name: &str,
        elements: &[[u32; N]],
        width: usize,
        coding: Coding,
    ) {
        let bits = 8 * width as u32;
        let mask = if bits == 32 { u32::MAX } else { (1 << bits) - 1 };
        let code = |element: u32, before: u32| {
            let difference = element.wrapping_sub(before) & mask;
            let is_negative = difference >> (bits - 1) == 1;
            ((difference << 1) ^ if is_negative { mask } else { 0 }) & mask
        };
        let offset = self.bytes.len();
        for component in 0..N {
            let coded: Vec<u32> = match coding {
                Coding::Plain => elements.iter().map(|element| element[component]).collect(),
                Coding::Differences => {
                    let before = std::iter::once(0).chain(elements.iter().map(|element| element[component]));
                    elements
                        .iter()
                        .zip(before)
                        .map(|(element, before)| code(element[component], before))
                        .collect()
                }
            };
            for byte in 0..width {
                self.bytes.extend(coded.iter().map(|code| (code >> (8 * byte)) as u8));
            }
        }
        let mut description =
            json!({ "offset": offset, "bytes": width, "stride": N, "count": elements.len() });
        if coding == Coding::Plain {
            description["plain"] = json!(true);
        }
        self.header.insert(name.into(), description);
    }

    /// Returns the length of the header, the header with these other entries, and all arrays.
    pub(crate) fn finish(self, mut header: Value) -> Vec<u8> {
        header["arrays"] = Value::Object(self.header);
        let header = header.to_string().into_bytes();
        let mut all = Vec::with_capacity(4 + header.len() + self.bytes.len());
        all.extend((header.len() as u32).to_le_bytes());
        all.extend(header);
        all.extend(self.bytes);
        all
    }
}

/// Returns the codes of three bands as the second, and the differences of the others from it, which are small for gray light.
pub(crate) fn differences_of_bands([r, g, b]: [u16; 3]) -> [u32; 3] {
    [g, r.wrapping_sub(g), b.wrapping_sub(g)].map(u32::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_small_numbers_in_planes() {
        let mut arrays = Arrays::default();
        arrays.add("a", &[[5, 0], [4, 0xffff], [6, 1]], 2, Coding::Differences);
        arrays.add("b", &[[0x0102_0304]], 4, Coding::Plain);
        let bytes = arrays.finish(json!({ "own": 1 }));
        let length = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize;
        let header: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap_or_default();
        assert_eq!(header["own"], 1);
        assert_eq!(header["arrays"]["a"], json!({ "offset": 0, "bytes": 2, "stride": 2, "count": 3 }));
        assert_eq!(header["arrays"]["b"]["plain"], true);
        // 5, −1, 2 and 0, −1, 2 with the sign in the lowest bit; low bytes, then high bytes.
        let planes = [10, 1, 4, 0, 0, 0, 0, 1, 4, 0, 0, 0, 4, 3, 2, 1];
        assert_eq!(bytes[4 + length..], planes);
    }

    #[test]
    fn bands_of_gray_light_differ_by_nothing() {
        assert_eq!(differences_of_bands([7, 7, 7]), [7, 0, 0]);
        assert_eq!(differences_of_bands([0, 7, 9]), [7, 65_529, 2]);
    }
}
