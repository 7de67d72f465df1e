//! Cycles in the dependency graph of files.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use crate::names::Arrows;

/// Returns a shortest cycle for each file that is in one. Cycles of the same files are listed once. A cycle begins with
/// the first file for which it was found.
pub(crate) fn circles(arrows: &Arrows) -> Vec<Vec<String>> {
    let mut used: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (from, to) in arrows.keys() {
        used.entry(from).or_default().push(to);
    }
    let mut known: BTreeSet<Vec<&str>> = BTreeSet::new();
    let mut circles = Vec::new();
    for &start in used.keys() {
        let Some(circle) = shortest(&used, start) else { continue };
        let mut files = circle.clone();
        files.sort_unstable();
        if known.insert(files) {
            circles.push(circle.into_iter().map(str::to_owned).collect());
        }
    }
    circles
}

/// Returns a shortest cycle through a file.
fn shortest<'a>(used: &BTreeMap<&'a str, Vec<&'a str>>, start: &'a str) -> Option<Vec<&'a str>> {
    let mut came_from: BTreeMap<&str, &str> = BTreeMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(file) = queue.pop_front() {
        for &next in used.get(file).into_iter().flatten() {
            if next == start {
                let mut circle = vec![file];
                while let Some(&before) = came_from.get(circle[circle.len() - 1]) {
                    circle.push(before);
                }
                circle.reverse();
                return Some(circle);
            }
            if !came_from.contains_key(next) {
                came_from.insert(next, file);
                queue.push_back(next);
            }
        }
    }
    None
}

/// Describes a cycle in words, with the line of each dependency.
pub(crate) fn describe(folder: &str, arrows: &Arrows, circle: &[String]) -> String {
    let next = circle.iter().cycle().skip(1);
    let steps: Vec<String> = circle
        .iter()
        .zip(next)
        .map(|(from, to)| format!("{folder}{from}:{} uses {to}", arrows[&(from.clone(), to.clone())]))
        .collect();
    steps.join(", ")
}
