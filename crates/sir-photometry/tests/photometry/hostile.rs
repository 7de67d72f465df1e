//! Random and damaged files: each ends in a distribution or one short error.

use std::path::Path;

use proptest::prelude::*;
use sir_photometry::Photometry;

/// Reads files, and uses what they describe.
fn attempt(bytes: &[u8]) -> Result<(), TestCaseError> {
    match Photometry::parse(bytes) {
        Ok(file) => {
            let flux = file.distribution.flux();
            prop_assert!(flux.is_finite() && flux > 0.0, "{}", flux);
            prop_assert!(file.warnings.len() < 20);
            for u in [0.0, 0.3, 0.999_999] {
                let direction = file.distribution.sample([u, 1.0 - u]);
                prop_assert!((direction.length() - 1.0).abs() < 1e-9, "{}", direction);
                prop_assert!(file.distribution.intensity(direction).is_finite());
            }
            if let Some(tilt) = file.tilt {
                prop_assert!(tilt.factor(10.0).is_finite());
            }
        }
        Err(error) => {
            let text = error.to_string();
            prop_assert!(text.chars().count() < 400 && !text.contains(char::is_control), "{:?}", text);
        }
    }
    Ok(())
}

/// Returns our files.
fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().filter(|path| path.is_file()).map(|path| std::fs::read(path).unwrap()).collect()
}

/// Words with a meaning, and numbers at the limits of types.
const WORDS: [&str; 30] = [
    "0",
    "-1",
    "1",
    "2",
    "3",
    "4",
    "90",
    "180",
    "360",
    "1e9",
    "4294967296",
    "1e12",
    "-1e12",
    "1e-300",
    "1e308",
    "1e999",
    "nan",
    "inf",
    ".",
    "-",
    ",",
    "\r",
    "\n",
    "\0",
    "\u{1b}[2J",
    "ß",
    "TILT=INCLUDE\n",
    "TILT=../x\n",
    "[MORE]",
    "\u{feff}",
];

/// A change of a file: a place, a length, and what replaces it.
#[derive(Clone, Debug)]
enum Change {
    Word(usize),
    Bytes(Vec<u8>),
    Repeat(usize),
    Truncate,
}

fn change() -> impl Strategy<Value = (usize, usize, Change)> {
    let kind = prop_oneof![
        4 => (0..WORDS.len()).prop_map(Change::Word),
        2 => proptest::collection::vec(any::<u8>(), 0..8).prop_map(Change::Bytes),
        1 => (1..200usize).prop_map(Change::Repeat),
        1 => Just(Change::Truncate),
    ];
    (any::<usize>(), 0..12usize, kind)
}

fn apply(bytes: &mut Vec<u8>, (place, length, change): &(usize, usize, Change)) {
    let start = place % (bytes.len() + 1);
    let range = start..(start + length).min(bytes.len());
    match change {
        Change::Word(word) => drop(bytes.splice(range, WORDS[*word].bytes())),
        Change::Bytes(other) => drop(bytes.splice(range, other.iter().copied())),
        Change::Repeat(times) => {
            let piece = bytes[range.clone()].repeat(*times);
            drop(bytes.splice(range, piece));
        }
        Change::Truncate => bytes.truncate(start),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        attempt(&bytes)?;
    }

    #[test]
    fn random_numbers_never_panic(
        numbers in proptest::collection::vec(-5..200i32, 0..80),
        kind in 1..4u8,
        [v, h] in [1..6u8, 1..6u8],
    ) {
        let numbers = numbers.iter().map(i32::to_string).collect::<Vec<_>>();
        attempt(format!("TILT=NONE\n1 -1 1 {v} {h} {kind} 2 0 0 0 1 1 0\n{}", numbers.join(" ")).as_bytes())?;
        attempt(format!("x\n1\n{kind}\n{v}\n0\n{h}\n0\n{}", numbers.join("\n")).as_bytes())?;
    }

    #[test]
    fn damaged_files_never_panic(seed in any::<usize>(), changes in proptest::collection::vec(change(), 1..5)) {
        let seeds = seeds();
        let mut bytes = seeds[seed % seeds.len()].clone();
        changes.iter().for_each(|change| apply(&mut bytes, change));
        attempt(&bytes)?;
    }
}
