//! Where values lie on an axis, and which of them are written beside it.

use super::axis::{Axis, Scale};

/// Labels that fit beside an axis.
const MOST_LABELS: f64 = 9.0;

/// An axis with its ends; all of them in the axis' own coordinate, which is the decadic logarithm on a logarithmic one.
#[derive(Debug, Clone)]
pub(super) struct Ruler {
    scale: Scale,
    low: f64,
    high: f64,
}

impl Ruler {
    /// An axis that shows all `values` that can be shown on it. `floor`: whether its lower edge is to lie apart from them, because
    /// something else is drawn there.
    pub(super) fn new(axis: &Axis, values: impl Iterator<Item = f64>, floor: bool) -> Self {
        let scale = axis.scale;
        let shown = values.filter(|v| v.is_finite() && (scale == Scale::Linear || *v > 0.0));
        let places = shown.map(|v| if scale == Scale::Log { v.log10() } else { v });
        let (mut low, mut high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // An axis of what is not negative begins at zero, unless that would squeeze the values together.
        if scale == Scale::Linear && low > 0.0 && low < 0.5 * high {
            low = 0.0;
        }
        let least = if scale == Scale::Log { 0.5 } else { (0.02 * low.abs().max(high.abs())).max(1e-300) };
        let spare = (0.5 * (least - (high - low))).max(0.04 * (high - low));
        let below = if scale == Scale::Linear && low == 0.0 { 0.0 } else { spare };
        let floor = if floor { 0.08 * (high - low) + 0.2 } else { 0.0 };
        Ruler { scale, low: low - below - floor, high: high + spare }
    }

    /// The share of the axis that lies below `value`, 0 to 1: what is not above zero lies on the lower edge of a logarithmic axis.
    pub(super) fn place(&self, value: f64) -> f64 {
        let at = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => value.log10(),
            Scale::Log => self.low,
        };
        ((at - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }

    /// The values that are labelled.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let (decades, first) = (self.high - self.low, self.low.floor() as i32 - 1);
        match self.scale {
            Scale::Log if decades >= 2.0 => {
                let step = (decades / MOST_LABELS).ceil() as i32;
                let exponents = (first..=self.high.floor() as i32).filter(|e| e.rem_euclid(step) == 0);
                self.inside(exponents.map(ten_to))
            }
            Scale::Log => {
                let digits: &[f64] =
                    if decades >= 0.8 { &[1.0, 2.0, 5.0] } else { &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0] };
                let exponents = first..=self.high.floor() as i32;
                self.inside(exponents.flat_map(|e| digits.iter().map(move |digit| digit * ten_to(e))))
            }
            Scale::Linear => {
                let step = self.step();
                let (first, last) = ((self.low / step).floor() as i64, (self.high / step).ceil() as i64);
                self.inside((first..=last).map(|i| i as f64 * step))
            }
        }
    }

    fn inside(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let slack = 1e-9 * (self.high - self.low);
        let at = |v: f64| if self.scale == Scale::Log { v.log10() } else { v };
        values.filter(|v| at(*v) >= self.low - slack && at(*v) <= self.high + slack).collect()
    }

    /// The distance of labels on a linear axis: 1, 2 or 5 of some power of ten.
    fn step(&self) -> f64 {
        let least = (self.high - self.low) / MOST_LABELS;
        let power = 10f64.powi(least.log10().floor() as i32);
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * power).find(|step| *step >= least).unwrap_or(10.0 * power)
    }

    /// The label of a tick.
    pub(super) fn label(&self, value: f64) -> String {
        let plain = match self.scale {
            Scale::Log => self.low >= -3.5 && self.high <= 4.5,
            Scale::Linear => {
                let largest = self.low.abs().max(self.high.abs());
                largest < 1e5 && self.step() >= 1e-4
            }
        };
        match self.scale {
            _ if value == 0.0 => "0".into(),
            Scale::Log if plain => format!("{}", (value * 1e6).round() / 1e6),
            Scale::Log => short(value),
            Scale::Linear if plain => format!("{value:.*}", (-self.step().log10().floor()).max(0.0) as usize),
            Scale::Linear => short(value),
        }
    }
}

/// A power of ten, exactly where there is one.
fn ten_to(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

/// Three digits and the power of ten.
fn short(value: f64) -> String {
    let text = format!("{value:.2e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, values: &[f64]) -> Vec<String> {
        let ruler = Ruler::new(axis, values.iter().copied(), false);
        ruler.ticks().into_iter().map(|v| ruler.label(v)).collect()
    }

    #[test]
    fn labels_are_readable() {
        assert_eq!(labels(&Axis::linear("x"), &[0.0, 1.0]), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&Axis::linear("x"), &[-3.0, 40.0]), ["0", "10", "20", "30", "40"]);
        assert_eq!(labels(&Axis::linear("x"), &[0.0, 2e6]), ["0", "5e5", "1e6", "1.5e6", "2e6"]);
        assert_eq!(labels(&Axis::log("x"), &[0.01, 1000.0]), ["0.01", "0.1", "1", "10", "100", "1000"]);
        assert_eq!(labels(&Axis::log("x"), &[1e-5, 1e-2]), ["1e-5", "1e-4", "1e-3", "1e-2"]);
        let wide = labels(&Axis::log("x"), &[1e-18, 1e18]);
        assert!(wide.len() <= 10 && wide.contains(&"1e0".to_string()), "{wide:?}");
        assert_eq!(labels(&Axis::log("x"), &[1.0, 10.0]), ["1", "2", "5", "10"]);
    }

    /// Whatever the values, an axis has ends, a few labels, and its values on it in their order.
    #[test]
    fn every_range_is_an_axis() {
        let ranges: [&[f64]; 9] = [
            &[],
            &[0.0],
            &[5.0],
            &[-1.0, 0.0],
            &[f64::NAN, 3.0],
            &[1e-300, 1e300],
            &[1.0, 1.0 + 1e-9],
            &[-1e-30, 1e-30],
            &[f64::INFINITY, 1.0, 2.0],
        ];
        for values in ranges {
            for axis in [Axis::linear("x"), Axis::log("x")] {
                for floor in [false, true] {
                    let ruler = Ruler::new(&axis, values.iter().copied(), floor);
                    assert!(ruler.low < ruler.high && ruler.low.is_finite() && ruler.high.is_finite(), "{ruler:?}");
                    let ticks = ruler.ticks();
                    assert!((1..=14).contains(&ticks.len()), "{values:?} {axis:?}: {ticks:?}");
                    assert!(ticks.windows(2).all(|pair| ruler.place(pair[0]) < ruler.place(pair[1])), "{ticks:?}");
                }
            }
        }
        let ruler = Ruler::new(&Axis::log("x"), [0.0, 1.0, 100.0].into_iter(), true);
        assert_eq!((ruler.place(0.0), ruler.place(-3.0)), (0.0, 0.0));
        assert!(ruler.place(1.0) > 0.05, "the lower edge lies apart from the least value");
    }
}
