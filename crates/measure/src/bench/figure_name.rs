//! The names of figures, which are measured numbers and no charts: `section/what/quantity`.

use std::fmt;

/// The name of a figure: section, what it is of, and quantity, with slashes between. `convergence/cornell/cpu/default/16-spp/relmse` is of
/// the scene, backend, estimator and samples in its middle, which may have as many parts as it takes, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct FigureName<'a> {
    /// The section.
    pub section: &'a str,
    /// What it is of.
    pub of: &'a str,
    /// What is measured.
    pub quantity: &'a str,
}

impl<'a> FigureName<'a> {
    /// The parts of a name. One without a slash is section and quantity alike.
    pub fn parse(name: &'a str) -> Self {
        let Some((section, rest)) = name.split_once('/') else {
            return FigureName { section: name, of: "", quantity: name };
        };
        let (of, quantity) = rest.rsplit_once('/').unwrap_or(("", rest));
        FigureName { section, of, quantity }
    }
}

impl fmt::Display for FigureName<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let FigureName { section, of, quantity } = self;
        if of.is_empty() { write!(f, "{section}/{quantity}") } else { write!(f, "{section}/{of}/{quantity}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_three_parts() {
        for (name, section, of, quantity) in [
            ("convergence/room/cpu/default/1-spp/seconds", "convergence", "room/cpu/default/1-spp", "seconds"),
            ("growth/bounces-1/cpu/rays", "growth", "bounces-1/cpu", "rays"),
            ("a/b", "a", "", "b"),
        ] {
            let parts = FigureName { section, of, quantity };
            assert_eq!((FigureName::parse(name), parts.to_string()), (parts, name.into()));
        }
        assert_eq!(FigureName::parse("a"), FigureName { section: "a", of: "", quantity: "a" });
    }
}
