//! Small changes to inputs: to bytes, to words, and to the tree of a JSON document.

use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};
use serde_json::{Value, json};

use crate::seeds::{self, Target};

/// Random numbers of a case.
pub(crate) struct Dice(SplitMix64);

impl Dice {
    /// Returns the generator of a case.
    pub(crate) fn new(seed: u64, case: u64) -> Self {
        Self(SplitMix64::seed_from_u64(
            SplitMix64::seed_from_u64(seed).next_u64() ^ case.wrapping_mul(0x9e37_79b9),
        ))
    }

    /// Returns a uniform whole number below `n`, or 0 if `n` is 0.
    fn below(&mut self, n: usize) -> usize {
        (self.0.next_u64() % n.max(1) as u64) as usize
    }

    fn chance(&mut self, one_in: usize) -> bool {
        self.below(one_in) == 0
    }

    /// Returns a random range of bytes within `length`, usually a short one.
    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        let most = if self.chance(4) { length } else { 12 };
        start..(start + self.below(most + 1)).min(length)
    }
}

/// Returns the files of a case: those of the seed, one or more of them changed.
pub(crate) fn case(target: Target, dice: &mut Dice) -> Vec<(&'static str, Vec<u8>)> {
    let mut files = target.seed();
    let mut in_tree = false;
    if matches!(target, Target::Gltf | Target::Glb) && !dice.chance(3) {
        let mut document = seeds::document((target == Target::Gltf).then_some("data.bin"));
        for _ in 0..=dice.below(4) {
            change_tree(&mut document, dice);
        }
        files[0].1 = match target {
            Target::Glb => seeds::glb(&document, &seeds::data()),
            _ => document.to_string().into_bytes(),
        };
        in_tree = true;
    }
    // If the tree was changed, usually keep valid JSON.
    if !in_tree || dice.chance(4) {
        let words = target.words();
        for _ in 0..=dice.below(6) {
            // Usually the file itself, sometimes one that it names.
            let which = if dice.chance(3) { dice.below(files.len()) } else { 0 };
            change_bytes(&mut files[which].1, &words, dice);
        }
    }
    files
}

/// Maximum size of a file \[bytes\]. Without it, repetitions of repetitions would have hundreds of millions of bytes,
/// and reading alone would exceed the time limit of a case.
const MAX_FILE_SIZE: usize = 4 << 20;

fn change_bytes(bytes: &mut Vec<u8>, words: &[&str], dice: &mut Dice) {
    let range = dice.range(bytes.len());
    let word = words[dice.below(words.len())].as_bytes();
    match dice.below(9) {
        0 => bytes.truncate(range.start),
        1 => drop(bytes.drain(range)),
        2 => bytes[range].iter_mut().for_each(|byte| *byte = dice.below(256) as u8),
        3 if !range.is_empty() => bytes[range.start] ^= 1 << dice.below(8),
        4 => {
            // Repeats a piece, sometimes so often that nesting depth or length becomes a problem.
            let piece = bytes[range.clone()].to_vec();
            let times = if dice.chance(20) { 2000 } else { 1 + dice.below(4) };
            let times = times.min(MAX_FILE_SIZE.saturating_sub(bytes.len()) / piece.len().max(1));
            drop(bytes.splice(range.end..range.end, piece.repeat(times)));
        }
        5 => {
            let piece = bytes[dice.range(bytes.len())].to_vec();
            drop(bytes.splice(range, piece));
        }
        6 => {
            let times = if dice.chance(20) { 2000 } else { 1 };
            drop(bytes.splice(range.start..range.start, word.repeat(times)));
        }
        7 => replace_number(bytes, range.start, word),
        _ => drop(bytes.splice(range, word.iter().copied())),
    }
}

/// Replaces the first number at or after a position.
fn replace_number(bytes: &mut Vec<u8>, place: usize, by: &[u8]) {
    let digit = |byte: &u8| byte.is_ascii_digit();
    let Some(start) = bytes[place..].iter().position(digit).map(|i| place + i) else { return };
    let end = bytes[start..].iter().position(|byte| !digit(byte)).map_or(bytes.len(), |i| start + i);
    drop(bytes.splice(start..end, by.iter().copied()));
}

/// Replaces, removes or repeats a value of a document.
fn change_tree(document: &mut Value, dice: &mut Dice) {
    let paths = pointers(document);
    let other = document.pointer(&paths[dice.below(paths.len())]).cloned().unwrap_or_default();
    let path = &paths[dice.below(paths.len())];
    let odd = odd_value(dice);
    let (parent, key) = path.rsplit_once('/').unwrap_or_default();
    match (dice.below(5), document.pointer_mut(parent)) {
        (0, Some(Value::Object(members))) => drop(members.remove(key)),
        (0, Some(Value::Array(list))) if !list.is_empty() => drop(list.remove(dice.below(list.len()))),
        (1, Some(Value::Array(list))) if !list.is_empty() => {
            let again = list[dice.below(list.len())].clone();
            let times = if dice.chance(20) { 2000 } else { 1 };
            list.extend(vec![again; times]);
        }
        (2, _) => drop(document.pointer_mut(path).map(|value| std::mem::replace(value, other))),
        _ => drop(document.pointer_mut(path).map(|value| std::mem::replace(value, odd))),
    }
}

/// Returns the JSON pointers of all values except the document itself.
fn pointers(document: &Value) -> Vec<String> {
    let mut found = Vec::new();
    let mut stack = vec![(String::new(), document)];
    while let Some((path, value)) = stack.pop() {
        match value {
            Value::Object(members) => {
                stack.extend(members.iter().map(|(key, v)| (format!("{path}/{key}"), v)))
            }
            Value::Array(list) => {
                stack.extend(list.iter().enumerate().map(|(i, v)| (format!("{path}/{i}"), v)))
            }
            _ => {}
        }
        found.push(path);
    }
    found.retain(|path| !path.is_empty());
    if found.is_empty() { vec!["/asset".to_owned()] } else { found }
}

fn odd_value(dice: &mut Dice) -> Value {
    let whole = [
        0,
        1,
        2,
        3,
        255,
        5121,
        5125,
        1 << 20,
        (1 << 20) + 1,
        1 << 31,
        u64::from(u32::MAX),
        1 << 32,
        1 << 62,
        u64::MAX,
    ];
    let real = [-1.0, 0.5, 1e-40, 1e20, 3.5e38, -3.5e38, 1e150, 1e300];
    match dice.below(6) {
        0 | 1 => json!(dice.below(8)),
        2 => json!(whole[dice.below(whole.len())]),
        3 => json!(real[dice.below(real.len())]),
        4 => json!(["x", "", "../x", "\u{1b}[2J", "data:;base64,AAAA", "t.png", "KHR_x"][dice.below(7)]),
        _ => [json!(null), json!([]), json!({}), json!(true), json!([0, 0, 0]), json!({"extensions": {}})]
            [dice.below(6)]
        .clone(),
    }
}
