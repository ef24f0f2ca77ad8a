//! What a lamp sends in which direction, as it was measured: the intensities of a photometric file.

use std::f64::consts::TAU;

/// Angles nearer to each other than this, in radians.
const CLOSE: f64 = 1e-3;

/// Intensities by the angles of type C of IES LM-63: from the lamp's axis (vertical), and around it (horizontal). Between the angles both are interpolated;
/// beyond the vertical ones there is no light.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// A name for messages: the file name.
    pub name: String,
    /// Degrees from the axis, rising, within 0 to 180; two at least.
    pub vertical: Vec<f32>,
    /// Degrees around it, rising, from 0 to 360; or 0 alone, where it is the same all around.
    pub horizontal: Vec<f32>,
    /// Candelas, finite and not negative: for each horizontal angle those of every vertical one.
    pub candela: Vec<f32>,
}

impl Profile {
    /// The candelas at a horizontal angle.
    fn row(&self, horizontal: usize) -> &[f32] {
        &self.candela[horizontal * self.vertical.len()..][..self.vertical.len()]
    }

    /// All of its light, in lumens: exactly the integral of what is interpolated.
    pub fn flux(&self) -> f64 {
        let rows: Vec<f64> = (0..self.horizontal.len()).map(|index| self.row_integral(index)).collect();
        match rows[..] {
            [even] => TAU * even,
            _ => (1..rows.len())
                .map(|i| {
                    f64::from(self.horizontal[i] - self.horizontal[i - 1]).to_radians() * 0.5 * (rows[i] + rows[i - 1])
                })
                .sum(),
        }
    }

    /// Integral of a row over the cosine of the vertical angle.
    fn row_integral(&self, horizontal: usize) -> f64 {
        let angles = self.vertical.iter().map(|degrees| f64::from(*degrees).to_radians());
        let points: Vec<(f64, f64)> = angles.zip(self.row(horizontal).iter().map(|c| f64::from(*c))).collect();
        let of_pair = |pair: &[(f64, f64)]| {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            if b - a < CLOSE {
                // Differences of cosines would cancel: Simpson's rule, off by the fourth power of the step.
                let middle = 2.0 * (from + to) * (0.5 * (a + b)).sin();
                return (b - a) / 6.0 * (from * a.sin() + middle + to * b.sin());
            }
            let slope = (to - from) / (b - a);
            from * a.cos() - to * b.cos() + slope * (b.sin() - a.sin())
        };
        points.windows(2).map(of_pair).sum()
    }

    /// The most intensity in any direction, in candelas.
    pub fn largest(&self) -> f64 {
        self.candela.iter().fold(0.0, |most, c| most.max((*c).into()))
    }

    /// Degrees from the axis beyond which there is no light.
    pub fn reach(&self) -> f64 {
        let lit = |index: &usize| (0..self.horizontal.len()).any(|row| self.row(row)[*index] > 0.0);
        let last = (0..self.vertical.len()).rev().find(lit);
        last.map_or(0.0, |index| self.vertical[(index + 1).min(self.vertical.len() - 1)].into())
    }

    /// Bytes of its numbers.
    pub fn bytes(&self) -> usize {
        4 * (self.vertical.len() + self.horizontal.len() + self.candela.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn even(vertical: &[f32], candela: &[f32]) -> Profile {
        Profile { name: "lamp".into(), vertical: vertical.into(), horizontal: vec![0.0], candela: candela.into() }
    }

    #[test]
    fn flux_is_the_integral() {
        // The same everywhere: 4 pi; into a half: 2 pi.
        assert!((even(&[0.0, 180.0], &[2.0; 2]).flux() / (8.0 * PI) - 1.0).abs() < 1e-12);
        assert!((even(&[0.0, 30.0, 90.0], &[2.0; 3]).flux() / (4.0 * PI) - 1.0).abs() < 1e-12);
        // Angles that are all but one are no matter.
        let split = even(&[0.0, 1e-6, 30.0, 30.000002, 90.0], &[2.0; 5]).flux();
        assert!((split / (4.0 * PI) - 1.0).abs() < 1e-12, "{split}");
        let point = even(&[0.0, 1e-7, 2e-7], &[0.0, 1.0, 0.0]).flux();
        assert!(point > 0.0 && point < 1e-16, "{point}");
        // Falling evenly with the angle from 1 to 0: the integral of (1 - 2 t / pi) sin t is 1 - 2 / pi.
        let falling = even(&[0.0, 90.0], &[1.0, 0.0]).flux() / TAU;
        assert!((falling - (1.0 - 2.0 / PI)).abs() < 1e-12, "{falling}");
        // Twice as much on one side, rising evenly in between and back: the mean is 1.5.
        let sided = Profile {
            horizontal: vec![0.0, 180.0, 360.0],
            candela: vec![1.0, 1.0, 2.0, 2.0, 1.0, 1.0],
            ..even(&[0.0, 180.0], &[])
        };
        assert!((sided.flux() / (6.0 * PI) - 1.0).abs() < 1e-12);
        assert_eq!(sided.largest(), 2.0);
    }

    #[test]
    fn reach_is_where_interpolation_ends() {
        assert_eq!(even(&[0.0, 10.0, 20.0, 90.0], &[1.0, 1.0, 0.0, 0.0]).reach(), 20.0);
        assert_eq!(even(&[0.0, 90.0], &[0.0, 1.0]).reach(), 90.0);
        assert_eq!(even(&[0.0, 90.0], &[0.0, 0.0]).reach(), 0.0);
    }
}
