//! A case of the closed forms: what is rendered or computed, and the true value it is compared with.

use luminaire::scene::Scene;

/// Relative bound on single precision's roundings where chance does not enter.
pub(super) const BOUND: f64 = 2e-6;

/// A picture whose mean counts.
#[derive(Debug, Clone)]
pub struct View {
    /// What is seen.
    pub scene: Scene,
    /// Factor to the mean radiance of the picture.
    pub weight: f64,
}

/// What is compared with the expectation.
#[derive(Debug, Clone)]
pub enum Measured {
    /// The sum of the weighted means of some pictures, which chance estimates.
    Estimated(Vec<View>),
    /// The weighted mean of a picture that chance does not enter.
    Certain {
        /// The picture.
        view: Box<View>,
        /// The relative bound.
        bound: f64,
    },
    /// The tracers' own function, Fresnel's reflectance.
    Reflectance {
        /// The index behind the surface over that in front.
        eta: f64,
        /// From the normal, in radian.
        angle: f64,
        /// The absolute bound.
        bound: f64,
    },
}

/// A closed form or published case.
#[derive(Debug, Clone)]
pub struct Case {
    /// What it is about: cases of one subject stand together.
    pub subject: &'static str,
    /// Scene and quantity, in words.
    pub name: String,
    /// The formula, in words or symbols.
    pub formula: &'static str,
    /// The true value.
    pub expected: f64,
    /// By how much, relatively, the scene's true mean may be off because its shapes are only approximated; 0 if they are not.
    pub slack: f64,
    /// How many times the samples of an easy case it gets: more where its samples vary more.
    pub effort: u32,
    /// What is compared.
    pub measured: Measured,
}

impl Case {
    /// A case that chance estimates, of an easy scene without slack.
    pub(super) fn estimated(
        subject: &'static str,
        name: String,
        formula: &'static str,
        expected: f64,
        views: Vec<View>,
    ) -> Self {
        Case { subject, name, formula, expected, slack: 0.0, effort: 1, measured: Measured::Estimated(views) }
    }

    /// A case that chance does not enter.
    pub(super) fn certain(
        subject: &'static str,
        name: String,
        formula: &'static str,
        expected: f64,
        view: View,
        bound: f64,
    ) -> Self {
        let measured = Measured::Certain { view: Box::new(view), bound };
        Case { subject, name, formula, expected, slack: 0.0, effort: 1, measured }
    }

    /// The same with `effort` times the samples.
    pub(super) fn effort(self, effort: u32) -> Self {
        Case { effort, ..self }
    }

    /// The same with a slack.
    pub(super) fn slack(self, slack: f64) -> Self {
        Case { slack, ..self }
    }
}
