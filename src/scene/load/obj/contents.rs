//! What an OBJ file has that is no triangle: free-form curves and surfaces, lines, points, and words that nothing here knows.

use crate::scene::load::text_file::{Tally, shortened};
use std::path::Path;

/// Statements of free-form geometry: the format's own, and its older ones.
const FREE_FORM: [&str; 21] = [
    "bmat", "bsp", "bzp", "cdc", "cdp", "con", "cstype", "ctech", "curv", "curv2", "deg", "end", "hole", "parm", "res",
    "scrv", "sp", "stech", "step", "surf", "trim",
];
/// So many different words are named.
const MOST_WORDS: usize = 12;

/// Statements that make no triangle.
#[derive(Debug, Default)]
pub(super) struct Contents {
    free_form: Words,
    /// `call` and `csh`, which would read another file and run a command.
    calls: Words,
    lines: Words,
    points: Words,
    unknown: Words,
}

/// Words of one kind.
#[derive(Debug, Default)]
struct Words {
    tally: Tally,
    /// Each with its count, in the order in which they were met.
    words: Vec<(String, usize)>,
    count: usize,
}

impl Words {
    fn add(&mut self, word: &str, line: usize) {
        self.tally.add(line);
        self.count += 1;
        let word = shortened(word);
        if let Some((_, count)) = self.words.iter_mut().find(|(known, _)| *known == word) {
            *count += 1;
        } else if self.words.len() < MOST_WORDS {
            self.words.push((word.into_owned(), 1));
        }
    }

    /// The words, with how often each was met.
    fn counted(&self) -> String {
        let word = |(word, count): &(String, usize)| format!("{count} `{word}`");
        self.words.iter().map(word).collect::<Vec<_>>().join(", ")
    }

    fn named(&self) -> String {
        self.words.iter().map(|(word, _)| format!("`{word}`")).collect::<Vec<_>>().join(", ")
    }
}

impl Contents {
    /// Counts a statement that makes no triangle.
    pub(super) fn add(&mut self, keyword: &str, line: usize) {
        let words = match keyword {
            "l" => &mut self.lines,
            "p" => &mut self.points,
            "call" | "csh" => &mut self.calls,
            "vp" => &mut self.free_form,
            _ if FREE_FORM.contains(&keyword) => &mut self.free_form,
            _ => &mut self.unknown,
        };
        words.add(keyword, line);
    }

    /// One warning for each kind that was met.
    pub(super) fn warn(&self, path: &Path, warnings: &mut Vec<String>) {
        let free_form = format!(
            "free-form curves and surfaces are not modelled and left out ({}); convert them to polygons in the program that made them",
            self.free_form.counted()
        );
        let calls =
            format!("{} would read another file or run a command, which is never done; skipped", self.calls.named());
        let unknown = match self.unknown.words.as_slice() {
            [(word, _)] => format!("a line with the keyword `{word}`, which is not modelled, is skipped"),
            _ => format!("a line with a keyword that is not modelled ({}) is skipped", self.unknown.named()),
        };
        for (words, what) in [
            (&self.free_form, free_form.as_str()),
            (&self.calls, &calls),
            (&self.lines, "a line (`l`) has no area to see; skipped"),
            (&self.points, "a point (`p`) has no area to see; skipped"),
            (&self.unknown, &unknown),
        ] {
            words.tally.warn(path, what, warnings);
        }
    }

    /// What a file has instead of faces, for the error that it has none.
    pub(super) fn instead(&self, vertices: usize) -> String {
        let mut parts = vec![format!("{vertices} vertices")];
        for (words, one) in [
            (&self.lines, "lines (`l`)"),
            (&self.points, "points (`p`)"),
            (&self.unknown, "lines with unknown keywords"),
        ] {
            if words.count > 0 {
                parts.push(format!("{} {one}", words.count));
            }
        }
        if self.free_form.count > 0 {
            parts.push(format!("free-form curves and surfaces ({})", self.free_form.counted()));
        }
        parts.join(", ")
    }
}
