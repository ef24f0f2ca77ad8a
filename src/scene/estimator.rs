//! Which of the lecture's estimators computes the radiance along a camera ray.

use crate::{Error, Result};
use glam::Vec3;
use serde::Deserialize;

/// What runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Integrator {
    /// The path tracer.
    Path(Estimator),
    /// The simple ray tracer: emission, direct light, and the ambient term in place of indirect light.
    Simple {
        /// Ambient radiance, multiplied by the surface's ambient albedo.
        ambient: Vec3,
    },
}

impl Integrator {
    /// How light is found and directions are chosen. The simple ray tracer samples direct light, and area luminaires by their area; it
    /// does not bounce.
    pub fn estimator(&self) -> Estimator {
        match self {
            Integrator::Path(estimator) => *estimator,
            Integrator::Simple { .. } => Estimator {
                light_sampling: LightSampling::Direct,
                area_sampling: AreaSampling::Area,
                max_bounces: Some(0),
                ..Estimator::default()
            },
        }
    }

    /// Refuses what never ends.
    ///
    /// # Errors
    /// [`Error::Usage`] if its paths have no end ([`Estimator::ends`]).
    pub fn check_ends(&self) -> Result<()> {
        match self {
            Integrator::Path(estimator) if !estimator.ends() => Err(Error::Usage(format!(
                "without extinction a path never ends: limit max_bounces to at most {}",
                Estimator::MOST_BOUNCES
            ))),
            _ => Ok(()),
        }
    }
}

/// The choices that the lecture discusses; any mix that ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimator {
    /// How light is found.
    pub light_sampling: LightSampling,
    /// How a point on an area luminaire is chosen.
    pub area_sampling: AreaSampling,
    /// How the luminaire is chosen whose light is sampled.
    pub light_choice: LightChoice,
    /// How the direction of indirect light is chosen.
    pub directions: Directions,
    /// How chance ends a path.
    pub extinction: Extinction,
    /// A path whose combined albedo falls below this ends (slide "Albedo Termination"): a bias.
    pub albedo_threshold: Option<f32>,
    /// At most this many indirect bounces, up to [`Estimator::MOST_BOUNCES`]; none: no limit. 0 is direct light only. Emission at
    /// bounce `max_bounces + 1` still counts where it is direct light.
    pub max_bounces: Option<u32>,
    /// Whether coarse meshes with vertex normals are lit as the smooth surfaces that they stand for: rays leave from above their triangles, and the shading normal alone
    /// says what is above (Hanika, "Hacking the Shadow Terminator", 2021). It takes the steps out of the edges of their own shadows: a bias.
    pub smooth_terminator: bool,
}

/// How light is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightSampling {
    /// Only where a path happens to meet emission. Luminaires without an area are never found.
    None,
    /// Direct light alone: one luminaire a bounce (next-event estimation).
    Direct,
    /// Direct light and what the path meets, weighted by the power heuristic (Veach and Guibas 1995).
    Mis,
}

/// How a point on an emissive triangle is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AreaSampling {
    /// Evenly over its area.
    Area,
    /// Evenly over the solid angle where the triangle is near, over the area where it is far.
    SolidAngle,
}

/// How one of several luminaires is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LightChoice {
    /// By the tree where it pays ([`super::LuminaireTable`] says where), else by power.
    Auto,
    /// In proportion to their power, wherever the light is wanted.
    Power,
    /// By a tree over all that are not infinitely far away, in proportion to what may arrive (Conty Estevez and Kulla 2018).
    Tree,
}

/// How the direction of indirect light is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Directions {
    /// Evenly over the hemisphere (slide "Inefficient Integration").
    Uniform,
    /// In proportion to the cosine (slide "More Efficient Integration").
    Cosine,
    /// The diffuse lobe by the cosine, the glossy lobe by its half vector.
    Bsdf,
}

/// How chance ends a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extinction {
    /// It does not; `max_bounces` has to.
    Off,
    /// By the surface's extinction coefficient, survivors not re-weighted, as the slide "Extinction" has it: a bias.
    Literal,
    /// By the surface's extinction coefficient, re-weighted.
    Surface,
    /// By the throughput of the whole path, re-weighted (Russian roulette), once that is below 0.25: behind the first surface that
    /// scatters it, so that a dark surface that is seen directly, in a mirror or through glass is no noisier for it. The factor `eta^2` of
    /// transmission is left out.
    Throughput,
}

impl Default for Estimator {
    fn default() -> Self {
        Estimator {
            light_sampling: LightSampling::Mis,
            area_sampling: AreaSampling::SolidAngle,
            light_choice: LightChoice::Auto,
            directions: Directions::Bsdf,
            extinction: Extinction::Throughput,
            albedo_threshold: None,
            max_bounces: None,
            smooth_terminator: false,
        }
    }
}

/// What the slide "More Efficient Integration" has, with the extinction put right.
const COSINE: Estimator = Estimator {
    light_sampling: LightSampling::Direct,
    area_sampling: AreaSampling::Area,
    light_choice: LightChoice::Power,
    directions: Directions::Cosine,
    extinction: Extinction::Surface,
    albedo_threshold: None,
    max_bounces: None,
    smooth_terminator: false,
};

/// Names for stages of the lecture, besides `simple` and `default`.
pub const PRESETS: [(&str, Estimator); 5] = [
    // Path tracing as Kajiya had it: light is only found by chance.
    ("no-light-sampling", Estimator { light_sampling: LightSampling::None, ..COSINE }),
    ("uniform", Estimator { directions: Directions::Uniform, ..COSINE }),
    ("cosine", COSINE),
    ("literal-extinction", Estimator { extinction: Extinction::Literal, ..COSINE }),
    ("threshold", Estimator { albedo_threshold: Some(1e-4), ..COSINE }),
];

impl Estimator {
    /// The largest limit of bounces; whatever is beyond counts as no limit.
    pub const MOST_BOUNCES: u32 = 1_000_000;

    /// The preset of a name; none if there is no such.
    pub fn preset(name: &str) -> Option<Estimator> {
        if name == "default" {
            return Some(Estimator::default());
        }
        PRESETS.iter().find(|(preset, _)| *preset == name).map(|(_, estimator)| *estimator)
    }

    /// The names that [`Estimator::preset`] knows: `default` and those of [`PRESETS`].
    pub fn preset_names() -> impl Iterator<Item = &'static str> {
        std::iter::once("default").chain(PRESETS.iter().map(|(name, _)| *name))
    }

    /// The names of all estimators, the simple ray tracer among them, for messages: "`simple`, `default`, ...".
    pub fn names_in_words() -> String {
        let names: Vec<_> =
            std::iter::once("simple").chain(Self::preset_names()).map(|name| format!("`{name}`")).collect();
        names.join(", ")
    }

    /// Whether every path ends: chance ends it, or a limit of at most [`Estimator::MOST_BOUNCES`]. The tracers do not check it, and
    /// may never come back where it is false; `backend::open` does ([`Integrator::check_ends`]).
    pub fn ends(&self) -> bool {
        self.extinction != Extinction::Off || self.max_bounces.is_some_and(|bounces| bounces <= Self::MOST_BOUNCES)
    }
}

/// What replaces parts of an [`Estimator`]; none: the part stays.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EstimatorChanges {
    /// See [`Estimator::light_sampling`].
    pub light_sampling: Option<LightSampling>,
    /// See [`Estimator::area_sampling`].
    pub area_sampling: Option<AreaSampling>,
    /// See [`Estimator::light_choice`].
    pub light_choice: Option<LightChoice>,
    /// See [`Estimator::directions`].
    pub directions: Option<Directions>,
    /// See [`Estimator::extinction`].
    pub extinction: Option<Extinction>,
    /// See [`Estimator::albedo_threshold`].
    pub albedo_threshold: Option<f32>,
    /// See [`Estimator::max_bounces`].
    pub max_bounces: Option<u32>,
    /// See [`Estimator::smooth_terminator`].
    pub smooth_terminator: Option<bool>,
}

impl EstimatorChanges {
    /// The estimator with these parts replaced.
    pub fn apply(&self, estimator: Estimator) -> Estimator {
        Estimator {
            light_sampling: self.light_sampling.unwrap_or(estimator.light_sampling),
            area_sampling: self.area_sampling.unwrap_or(estimator.area_sampling),
            light_choice: self.light_choice.unwrap_or(estimator.light_choice),
            directions: self.directions.unwrap_or(estimator.directions),
            extinction: self.extinction.unwrap_or(estimator.extinction),
            albedo_threshold: self.albedo_threshold.or(estimator.albedo_threshold),
            max_bounces: self.max_bounces.or(estimator.max_bounces),
            smooth_terminator: self.smooth_terminator.unwrap_or(estimator.smooth_terminator),
        }
    }

    /// Which of these parts, by their keys, change nothing of the estimator that came of them: how luminaires are sampled, where they are not.
    pub fn without_effect(&self, applied: &Estimator) -> impl Iterator<Item = &'static str> {
        let unsampled = applied.light_sampling == LightSampling::None;
        [("area_sampling", self.area_sampling.is_some()), ("light_choice", self.light_choice.is_some())]
            .into_iter()
            .filter_map(move |(key, given)| (given && unsampled).then_some(key))
    }
}
