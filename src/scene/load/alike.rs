//! Warnings that say the same of many things: the first few are enough.

use std::collections::HashMap;

/// So many warnings of one kind are said in full.
const MOST_ALIKE: usize = 8;

/// Keeps the first few warnings of each kind, and says behind the last of them how many more there are.
pub(super) fn shorten(warnings: &mut Vec<String>) {
    let kinds: Vec<String> = warnings.iter().map(|warning| kind(warning)).collect();
    let mut counts: HashMap<&str, usize> = HashMap::new();
    for kind in &kinds {
        *counts.entry(kind).or_default() += 1;
    }
    let mut seen: HashMap<&str, usize> = HashMap::new();
    let mut kept = Vec::with_capacity(warnings.len());
    for (warning, kind) in warnings.drain(..).zip(&kinds) {
        let (seen, all) = (seen.entry(kind).or_default(), counts[kind.as_str()]);
        *seen += 1;
        // A line that only says that there is one more says less than the one.
        if *seen < MOST_ALIKE || all <= MOST_ALIKE {
            kept.push(warning);
        } else if *seen == MOST_ALIKE {
            kept.push(format!("{warning} (and {} more like this)", all - MOST_ALIKE));
        }
    }
    *warnings = kept;
}

/// A warning without its names, places and numbers.
fn kind(warning: &str) -> String {
    let words = warning.split_inclusive('`').enumerate().filter(|(i, _)| i % 2 == 0).map(|(_, outside)| outside);
    // Paths are the words with a separator or an ending.
    let words = words.flat_map(str::split_whitespace).filter(|word| !word.contains(['/', '\\', '.']));
    words.flat_map(|word| [word.trim_matches(|c: char| c.is_ascii_digit()), " "]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_of_a_kind_become_a_few_and_others_stay() {
        let alike = |n: usize| {
            format!("/a b/c.mtl:{n}: material `m {n}` would create energy: it reaches 1.{n}; scaled by 0.{n}")
        };
        let mut warnings: Vec<String> = (0..120).map(alike).collect();
        warnings.insert(60, "c.mtl: something else".into());
        shorten(&mut warnings);
        assert_eq!(warnings.len(), 9, "{warnings:?}");
        assert!(warnings[7] == alike(7) + " (and 112 more like this)" && warnings[8].contains("else"));
        let mut few: Vec<String> = (0..8).map(alike).collect();
        shorten(&mut few);
        assert_eq!(few, (0..8).map(alike).collect::<Vec<_>>());
    }
}
