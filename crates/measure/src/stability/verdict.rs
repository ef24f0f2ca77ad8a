//! What a sweep says of a method: safe, noisy, not known or wrong, and from where to where.

/// Rays a million that may go wrong before it is more than single pixels. The rays of the sweeps are aimed at edges, corners and rims, where next
/// to none of a picture's go; if a tenth of even these goes wrong, whole surfaces look wrong.
pub const WRONG_RAYS: f64 = 1e5;
/// How far off something may be, as a share of what it is held against. Of a body's size: a pixel of a picture in which the body is a thousand
/// pixels wide. Of light: a ninth of a step of an 8-bit sRGB picture at full brightness.
pub const WRONG_SHARE: f64 = 1e-3;
/// Variance of a sample over the squared mean from which on a method is noisy. A sample is then ten times the mean off.
pub const NOISY_VARIANCE: f64 = 100.0;
/// Noise of a pixel, over its mean, that is counted as even: what it takes in samples is the variance over its square.
pub const EVEN: f64 = 0.05;
/// How well a mean has to be known before a method is called right, as a share of the light: [`SURE`] standard errors may be so much. A bias that
/// hides in more would be seen in a picture: a tenth of the light is eleven steps of an 8-bit sRGB picture at full brightness.
pub const KNOWN: f64 = 0.1;
/// Standard errors by which a mean has to be off before it is called biased: by chance one mean in 370 is as far off.
pub const SURE: f64 = 3.0;

/// What becomes of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    /// Right.
    Safe,
    /// Right in the mean or but for single pixels.
    Noisy,
    /// Too few samples to say: no bias is proved, and none is ruled out.
    Unknown,
    /// Wrong, however many samples there are.
    Wrong,
}

impl Judgement {
    /// Of so many failing rays a million.
    pub fn of_rays(failing: f64) -> Self {
        match failing {
            0.0 => Judgement::Safe,
            some if some <= WRONG_RAYS => Judgement::Noisy,
            _ => Judgement::Wrong,
        }
    }

    /// Of a share that something is off. What gave no number is wrong.
    pub fn of_share(off: f64) -> Self {
        if off <= WRONG_SHARE { Judgement::Safe } else { Judgement::Wrong }
    }

    /// Of light by the variance of a sample over the squared mean, NaN where too little was found to know it, by the share that its mean is
    /// certainly off, and by the standard error of that share. Where the variance is that large no bias is held against the mean.
    pub fn of_light(variance: f64, bias: f64, error: f64) -> Self {
        // NaN is neither.
        let (even, known) = (variance <= NOISY_VARIANCE, SURE * error <= KNOWN);
        match Judgement::of_share(bias) {
            _ if !even => Judgement::Noisy,
            Judgement::Safe if !known => Judgement::Unknown,
            judgement => judgement,
        }
    }

    /// As the page has it.
    pub fn symbol(self) -> char {
        match self {
            Judgement::Safe => '●',
            Judgement::Noisy => '▲',
            Judgement::Unknown => '?',
            Judgement::Wrong => '✖',
        }
    }
}

/// Which end of a sweep is the hard one, and so where it ends on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Worse {
    /// Large values of x are hard.
    Upwards,
    /// Small values of x are hard.
    Downwards,
}

/// A stretch of a sweep with one judgement. Both ends were measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Where it begins, on the sweep's way.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// What it is.
    pub judgement: Judgement,
}

/// What a sweep says of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Its name.
    pub method: String,
    /// One after the other, on the sweep's way; neighbours differ.
    pub ranges: Vec<Range>,
    /// The numbers behind it, in a few words.
    pub evidence: String,
}

impl Verdict {
    /// The verdict from what was judged at each `x`, in any order; of several at one `x` the worst counts.
    pub fn new(
        method: impl Into<String>,
        judged: impl IntoIterator<Item = (f64, Judgement)>,
        worse: Worse,
        evidence: impl Into<String>,
    ) -> Self {
        let mut judged: Vec<_> = judged.into_iter().collect();
        judged.sort_by(|a, b| a.0.total_cmp(&b.0));
        if worse == Worse::Downwards {
            judged.reverse();
        }
        let mut ranges: Vec<Range> = Vec::new();
        for same_x in judged.chunk_by(|a, b| a.0 == b.0) {
            let x = same_x[0].0;
            let judgement = same_x.iter().map(|(_, judgement)| *judgement).fold(Judgement::Safe, Judgement::max);
            match ranges.last_mut() {
                Some(last) if last.judgement == judgement => last.to = x,
                _ => ranges.push(Range { from: x, to: x, judgement }),
            }
        }
        Verdict { method: method.into(), ranges, evidence: evidence.into() }
    }

    /// The same, but what was worse on the way does not become better again: none found of so few rays is no proof that there is none.
    pub fn lasting(mut self) -> Self {
        let mut lasting: Vec<Range> = Vec::new();
        for range in self.ranges {
            match lasting.last_mut() {
                Some(last) if range.judgement <= last.judgement => last.to = range.to,
                _ => lasting.push(range),
            }
        }
        self.ranges = lasting;
        self
    }

    /// Whether it is safe all the way.
    pub fn is_safe(&self) -> bool {
        self.ranges.iter().all(|range| range.judgement == Judgement::Safe)
    }

    /// Whether it is wrong anywhere.
    pub fn has_wrong(&self) -> bool {
        self.ranges.iter().any(|range| range.judgement == Judgement::Wrong)
    }

    /// The stretch with which the way begins, if that is safe.
    pub fn safe_start(&self) -> Option<&Range> {
        self.ranges.first().filter(|range| range.judgement == Judgement::Safe)
    }

    /// The stretch with which the way ends, if that is safe.
    pub fn safe_end(&self) -> Option<&Range> {
        self.ranges.last().filter(|range| range.judgement == Judgement::Safe)
    }

    /// As a cell of a table: `● to 1e5, ▲ to 1e6, ✖ beyond`, or a symbol alone for all of the way.
    pub fn in_words(&self) -> String {
        let [first, .., last] = &self.ranges[..] else {
            return self.ranges.first().map_or("–".into(), |only| only.judgement.symbol().into());
        };
        let rest = if first.from < last.to { "beyond" } else { "below" };
        let words = |(index, range): (usize, &Range)| {
            let symbol = range.judgement.symbol();
            match index {
                _ if index + 1 == self.ranges.len() => format!("{symbol} {rest}"),
                0 if range.from == range.to => format!("{symbol} at {}", place(range.to)),
                _ => format!("{symbol} to {}", place(range.to)),
            }
        };
        self.ranges.iter().enumerate().map(words).collect::<Vec<_>>().join(", ")
    }
}

/// A place on the way of a sweep, for which the report's [`number`](crate::report::words::number) has too few digits near 1 and too many zeros
/// elsewhere: three digits, but all of them near 1, where the distance from it counts.
pub fn place(x: f64) -> String {
    let trimmed = |text: String| text.trim_end_matches('0').trim_end_matches('.').to_owned();
    let size = x.abs();
    match size {
        0.0 => "0".into(),
        _ if (0.9..1.1).contains(&size) => trimmed(format!("{x:.6}")),
        _ if (0.01..1e4).contains(&size) => {
            let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
            format!("{rounded}")
        }
        _ => {
            let text = format!("{x:.2e}");
            let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{}e{exponent}", trimmed(digits.into()))
        }
    }
}

/// A stretch of values on the way of a sweep: `0.1 to 1e7 sizes from the origin`.
pub fn stretch(values: impl IntoIterator<Item = f64>, worse: Worse, unit: &str) -> String {
    let values: Vec<f64> = values.into_iter().collect();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (from, to) = if worse == Worse::Upwards { (least, most) } else { (most, least) };
    format!("{} to {} {unit}", place(from), place(to)).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::Judgement::*;
    use super::*;

    fn verdict(judged: &[(f64, Judgement)], worse: Worse) -> Verdict {
        Verdict::new("method", judged.iter().copied(), worse, "")
    }

    #[test]
    fn limits_belong_to_the_better_side() {
        assert_eq!(
            [0.0, 1.0, WRONG_RAYS, 1.01 * WRONG_RAYS, f64::NAN].map(Judgement::of_rays),
            [Safe, Noisy, Noisy, Wrong, Wrong]
        );
        assert_eq!(
            [0.0, WRONG_SHARE, 2.0 * WRONG_SHARE, f64::NAN].map(Judgement::of_share),
            [Safe, Safe, Wrong, Wrong]
        );
        let of_light = |variance, bias| Judgement::of_light(variance, bias, 0.0);
        assert_eq!([of_light(NOISY_VARIANCE, 0.0), of_light(1.0, 0.5), of_light(1.0, f64::NAN)], [Safe, Wrong, Wrong]);
        // A mean of which the samples know nothing is not called biased.
        assert_eq!([of_light(f64::NAN, 1.0), of_light(1e3, 1.0)], [Noisy, Noisy]);
    }

    #[test]
    fn what_is_not_known_is_not_safe() {
        let known = KNOWN / SURE;
        let of_error = |error| Judgement::of_light(1.0, 0.0, error);
        assert_eq!([0.0, known, 1.01 * known, f64::NAN].map(of_error), [Safe, Safe, Unknown, Unknown]);
        // What is proved is proved, however large the error; and much noise is found by any error.
        assert_eq!(Judgement::of_light(1.0, 0.5, 1.0), Wrong);
        assert_eq!(Judgement::of_light(1e3, 0.0, 1.0), Noisy);
        let judged = [(0.5, Safe), (0.999, Safe), (0.9999, Unknown), (0.99999, Wrong)];
        assert_eq!(verdict(&judged[..3], Worse::Upwards).in_words(), "● to 0.999, ? beyond");
        assert!(!verdict(&judged[..3], Worse::Upwards).is_safe() && !verdict(&judged[..3], Worse::Upwards).has_wrong());
        assert_eq!(verdict(&[(1.0, Unknown), (1.0, Noisy)], Worse::Upwards).in_words(), "?");
        assert!(verdict(&judged, Worse::Upwards).has_wrong());
    }

    #[test]
    fn only_the_ends_of_the_way_are_its_ends() {
        let island = verdict(&[(1.0, Wrong), (2.0, Safe), (3.0, Noisy)], Worse::Upwards);
        assert_eq!((island.safe_start(), island.safe_end()), (None, None));
        let ends = verdict(&[(1.0, Safe), (2.0, Wrong), (3.0, Safe)], Worse::Downwards);
        assert_eq!((ends.safe_start().unwrap().to, ends.safe_end().unwrap().from), (3.0, 1.0));
    }

    #[test]
    fn points_become_ranges() {
        // In any order, the worst of several at one place, neighbours of one judgement together.
        let judged = [(1e3, Wrong), (1.0, Safe), (10.0, Safe), (100.0, Safe), (100.0, Noisy), (1e4, Wrong)];
        let up = verdict(&judged, Worse::Upwards);
        let range = |from, to, judgement| Range { from, to, judgement };
        assert_eq!(up.ranges, [range(1.0, 10.0, Safe), range(100.0, 100.0, Noisy), range(1e3, 1e4, Wrong)]);
        assert_eq!(up.in_words(), "● to 10, ▲ to 100, ✖ beyond");
        assert_eq!(verdict(&judged, Worse::Downwards).in_words(), "✖ to 1000, ▲ to 100, ● below");
        assert!(!up.is_safe() && up.safe_start() == Some(&range(1.0, 10.0, Safe)));
        let none = verdict(&[], Worse::Upwards);
        assert_eq!((none.in_words().as_str(), none.safe_start()), ("–", None));
        let all = verdict(&[(1.0, Safe), (2.0, Safe)], Worse::Upwards);
        assert_eq!((all.in_words().as_str(), all.is_safe()), ("●", true));
        assert_eq!(verdict(&[(1e-6, Wrong), (1e-5, Safe)], Worse::Upwards).in_words(), "✖ at 1e-6, ● beyond");
    }

    #[test]
    fn what_failed_once_is_not_safe_further_on() {
        let judged = [(1.0, Safe), (2.0, Noisy), (3.0, Safe), (4.0, Wrong), (5.0, Noisy)];
        assert_eq!(verdict(&judged, Worse::Upwards).lasting().in_words(), "● at 1, ▲ to 3, ✖ beyond");
        assert_eq!(verdict(&judged, Worse::Downwards).lasting().in_words(), "▲ at 5, ✖ below");
    }

    #[test]
    fn places() {
        assert_eq!(
            [0.0, 0.5, 0.9999, 1.0001, 1.33, 1000.0, 31623.0, 1e-8, 2.15443e5].map(place),
            ["0", "0.5", "0.9999", "1.0001", "1.33", "1000", "3.16e4", "1e-8", "2.15e5"]
        );
        assert_eq!(stretch([1e7, 0.1, 10.0], Worse::Upwards, "sizes"), "0.1 to 1e7 sizes");
        assert_eq!(stretch([1e-8, 0.1], Worse::Downwards, ""), "0.1 to 1e-8");
    }
}
