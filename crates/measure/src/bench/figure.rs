//! A figure: a measured number, with its unit and spread, that a later run is compared with. It is no chart.

use super::rounds::{Rounds, Spread};

/// Which way a figure gets better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Better {
    /// Rates.
    Higher,
    /// Times, memory, errors.
    Lower,
}

/// A measured number and how far its rounds lie apart.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Figure {
    /// What it is, the same in every run: a [`FigureName`](super::figure_name::FigureName).
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Median over the rounds.
    pub median: f64,
    /// Least of the rounds.
    pub least: f64,
    /// Most of the rounds.
    pub most: f64,
    /// How many rounds there were.
    pub rounds: usize,
    /// Which way is better.
    pub better: Better,
}

impl Figure {
    /// The figure of some rounds; none if there is no round, or one gave no number.
    pub fn of(name: String, unit: &str, better: Better, values: &[f64]) -> Option<Figure> {
        if values.is_empty() || values.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let Spread { median, least, most } = Rounds(values.to_vec()).spread();
        Some(Figure { name, unit: unit.into(), median, least, most, rounds: values.len(), better })
    }

    /// Its rounds in short.
    pub fn spread(&self) -> Spread {
        Spread { median: self.median, least: self.least, most: self.most }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_made_of_numbers() {
        let figure = |values: &[f64]| Figure::of("a/b".into(), "s", Better::Lower, values);
        let made = figure(&[3.0, 1.0, 2.0]).unwrap();
        assert_eq!((made.spread(), made.rounds), (Spread { median: 2.0, least: 1.0, most: 3.0 }, 3));
        assert!([&[][..], &[1.0, f64::NAN], &[f64::INFINITY]].iter().all(|values| figure(values).is_none()));
    }
}
