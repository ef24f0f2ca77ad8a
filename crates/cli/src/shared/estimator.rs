//! The options of the estimator and of its random numbers.

use luminaire::glam::Vec3;
use luminaire::scene::{
    AreaSampling, Directions, Estimator, EstimatorChanges, Extinction, Integrator, LightChoice, LightSampling, Sampler,
    Scene,
};
use luminaire::{Error, Result};
use serde::Deserialize;
use serde::de::value::{Error as ValueError, StrDeserializer};

/// The stages of the lecture, for the long help.
const PRESET_TABLE: &str = "\
Which estimator computes the radiance, in place of all that the scene says about it [default: the scene's]:

  simple              the simple ray tracer: emission, direct light, and an ambient term in place of indirect light
  default             what has the least noise in most scenes: light is sampled and also found by chance (multiple
                      importance sampling), near lamps by solid angle, directions by the BSDF, Russian roulette
  no-light-sampling   light is only found where a path happens to meet it (Kajiya); cosine-distributed directions
  uniform             direct light is sampled by area; directions evenly over the hemisphere
  cosine              the same with cosine-distributed directions, the survivors of extinction re-weighted
  literal-extinction  the same, but survivors are not re-weighted: darker than the truth
  threshold           cosine, and a path ends once its combined albedo falls below 1e-4: a little darker than the truth

The options below replace single parts of it.";

/// Which estimator, and which numbers it draws.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Estimator")]
pub struct EstimatorOptions {
    /// The estimator: simple, default, no-light-sampling, uniform, cosine, literal-extinction or threshold (see --help).
    #[arg(long, value_name = "NAME", value_parser = estimator, long_help = PRESET_TABLE)]
    pub estimator: Option<Choice>,
    /// How light is found: none (by chance), direct (sampled), mis (both, weighted).
    #[arg(long, value_name = "NAME", value_parser = named::<LightSampling>)]
    pub light_sampling: Option<LightSampling>,
    /// How a point on a lamp is chosen: area (evenly), solid-angle (evenly as seen, where the lamp is near).
    #[arg(long, value_name = "NAME", value_parser = named::<AreaSampling>)]
    pub area_sampling: Option<AreaSampling>,
    /// How one of several luminaires is chosen: power, tree (by what may arrive of each), auto (the tree where there are several lamps, else
    /// power) [default: the scene's, or auto].
    #[arg(long, value_name = "NAME", value_parser = named::<LightChoice>)]
    pub light_choice: Option<LightChoice>,
    /// How the direction of indirect light is chosen: uniform, cosine or bsdf.
    #[arg(long, value_name = "NAME", value_parser = named::<Directions>)]
    pub directions: Option<Directions>,
    /// How chance ends a path: off, literal (not re-weighted: a bias), surface (re-weighted), throughput (Russian roulette).
    #[arg(long, value_name = "NAME", value_parser = named::<Extinction>)]
    pub extinction: Option<Extinction>,
    /// End a path whose combined albedo falls below this, from 0 to 1: a bias.
    #[arg(long, value_name = "ALBEDO", allow_negative_numbers = true, value_parser = threshold)]
    pub albedo_threshold: Option<f32>,
    /// At most so many indirect bounces; 0 is direct light alone.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(..=i64::from(Estimator::MOST_BOUNCES)))]
    pub max_bounces: Option<u32>,
    /// Light coarse meshes with vertex normals as the smooth surfaces that they stand for, without steps at the edges of their own shadows: a bias.
    #[arg(long)]
    pub smooth_terminator: bool,
    /// Where the random numbers come from: independent, or sobol (less noise) [default: the scene's].
    #[arg(long, value_name = "NAME", value_parser = named::<Sampler>)]
    pub sampler: Option<Sampler>,
}

/// `--estimator`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice {
    /// The simple ray tracer.
    Simple,
    /// A path tracer.
    Path(Estimator),
}

/// An enum's variant by its name in scene files.
fn named<T: for<'de> Deserialize<'de>>(name: &str) -> std::result::Result<T, String> {
    T::deserialize(StrDeserializer::<ValueError>::new(name)).map_err(|error| error.to_string())
}

fn estimator(name: &str) -> std::result::Result<Choice, String> {
    if name == "simple" {
        return Ok(Choice::Simple);
    }
    Estimator::preset(name).map(Choice::Path).ok_or_else(|| format!("expected {}", Estimator::names_in_words()))
}

fn threshold(text: &str) -> std::result::Result<f32, String> {
    match text.parse::<f32>() {
        Ok(threshold) if (0.0..=1.0).contains(&threshold) => Ok(threshold),
        _ => Err("expected a number from 0 to 1, for example 1e-4".into()),
    }
}

impl EstimatorOptions {
    fn changes(&self) -> EstimatorChanges {
        EstimatorChanges {
            light_sampling: self.light_sampling,
            area_sampling: self.area_sampling,
            light_choice: self.light_choice,
            directions: self.directions,
            extinction: self.extinction,
            albedo_threshold: self.albedo_threshold,
            max_bounces: self.max_bounces,
            smooth_terminator: self.smooth_terminator.then_some(true),
        }
    }

    /// The first option that only the path tracer understands.
    fn path_option(&self) -> Option<&'static str> {
        [
            ("--light-sampling", self.light_sampling.is_some()),
            ("--area-sampling", self.area_sampling.is_some()),
            ("--light-choice", self.light_choice.is_some()),
            ("--directions", self.directions.is_some()),
            ("--extinction", self.extinction.is_some()),
            ("--albedo-threshold", self.albedo_threshold.is_some()),
            ("--max-bounces", self.max_bounces.is_some()),
            ("--smooth-terminator", self.smooth_terminator),
        ]
        .into_iter()
        .find_map(|(name, given)| given.then_some(name))
    }

    /// Refuses options that contradict each other.
    pub fn check(&self) -> Result<()> {
        match (self.path_option(), self.estimator) {
            (Some(option), Some(Choice::Simple)) => Err(Error::Usage(format!(
                "{option} belongs to the path tracer, but --estimator is simple: leave one of them out"
            ))),
            _ => Ok(()),
        }
    }

    /// Puts the options in the place of the scene's estimator and sampler. A usage error if they do not fit the scene's integrator.
    pub fn apply(&self, scene: &mut Scene) -> Result<()> {
        // Whether the picture can only be black depends on the estimator.
        let dark = scene.dark_because();
        scene.warnings.extend(self.change(&mut scene.integrator)?);
        scene.settings.sampler = self.sampler.unwrap_or(scene.settings.sampler);
        let now = scene.dark_because();
        if now != dark {
            scene.warnings.retain(|warning| Some(warning) != dark.as_ref());
            scene.warnings.extend(now);
        }
        Ok(())
    }

    /// Puts the options in the place of what the scene says; returns a warning, if there is one.
    fn change(&self, integrator: &mut Integrator) -> Result<Option<String>> {
        let mut warning = None;
        match (self.estimator, &*integrator) {
            (None, _) | (Some(Choice::Simple), Integrator::Simple { .. }) => {}
            (Some(Choice::Path(estimator)), _) => *integrator = Integrator::Path(estimator),
            (Some(Choice::Simple), Integrator::Path(_)) => {
                *integrator = Integrator::Simple { ambient: Vec3::ZERO };
                warning =
                    Some("the scene gives no ambient radiance: the simple ray tracer shows direct light alone".into());
            }
        }
        match integrator {
            Integrator::Path(estimator) => {
                *estimator = self.changes().apply(*estimator);
                if !estimator.ends() {
                    return Err(Error::Usage("without extinction a path never ends: add --max-bounces".into()));
                }
                let changes = self.changes();
                let idle = changes.without_effect(estimator).map(|key| format!("--{}", key.replace('_', "-")));
                let idle = idle.collect::<Vec<_>>().join(" and ");
                if !idle.is_empty() {
                    warning =
                        Some(format!("{idle}: without effect, because this estimator does not sample luminaires"));
                }
            }
            Integrator::Simple { .. } => {
                if let Some(option) = self.path_option() {
                    return Err(Error::Usage(format!(
                        "{option} belongs to the path tracer, but the scene asks for the simple ray tracer: \
                         add --estimator default"
                    )));
                }
            }
        }
        Ok(warning)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Args, FromArgMatches};

    fn applied(words: &[&str], mut integrator: Integrator) -> Result<(Integrator, bool)> {
        let command = EstimatorOptions::augment_args(clap::Command::new("test"));
        let matches = command.try_get_matches_from(std::iter::once(&"test").chain(words)).unwrap();
        let options = EstimatorOptions::from_arg_matches(&matches).unwrap();
        options.check()?;
        let warning = options.change(&mut integrator)?;
        Ok((integrator, warning.is_some()))
    }

    #[test]
    fn options_without_effect_are_named() {
        let path = Integrator::Path(Estimator::default());
        let warned = |words: &[&str]| applied(words, path).unwrap().1;
        assert!(warned(&["--light-sampling", "none", "--light-choice", "tree"]));
        assert!(warned(&["--area-sampling", "area", "--estimator", "no-light-sampling"]));
        assert!(!warned(&["--light-choice", "tree", "--area-sampling", "area"]));
        assert!(!warned(&["--light-sampling", "none"]));
    }

    #[test]
    fn options_replace_the_scenes_estimator_or_parts_of_it() {
        let limited = Estimator { max_bounces: Some(3), ..Estimator::default() };
        let path = Integrator::Path(limited);
        let simple = Integrator::Simple { ambient: Vec3::ONE };
        let uniform = Estimator::preset("uniform").unwrap();
        for (words, from, to) in [
            (&[][..], path, path),
            (&["--max-bounces", "9"], path, Integrator::Path(Estimator { max_bounces: Some(9), ..limited })),
            (&["--estimator", "default"], path, Integrator::Path(Estimator::default())),
            (&["--estimator", "uniform"], simple, Integrator::Path(uniform)),
            (&["--estimator", "simple"], simple, simple),
            (
                &["--estimator", "uniform", "--light-sampling", "none", "--albedo-threshold", "0.5"],
                path,
                Integrator::Path(Estimator {
                    light_sampling: LightSampling::None,
                    albedo_threshold: Some(0.5),
                    ..uniform
                }),
            ),
            (
                &["--extinction", "off", "--area-sampling", "area", "--directions", "uniform"],
                path,
                Integrator::Path(Estimator {
                    extinction: Extinction::Off,
                    area_sampling: AreaSampling::Area,
                    directions: Directions::Uniform,
                    ..limited
                }),
            ),
        ] {
            assert_eq!(applied(words, from).unwrap(), (to, false), "{words:?}");
        }
        assert!(applied(&["--estimator", "simple"], path).unwrap().1, "a warning about the ambient term");
    }

    #[test]
    fn what_makes_no_sense_is_a_usage_error() {
        let path = Integrator::Path(Estimator::default());
        let simple = Integrator::Simple { ambient: Vec3::ONE };
        for (words, from, says) in [
            (&["--extinction", "off"][..], path, "--max-bounces"),
            (&["--max-bounces", "1"], simple, "--estimator default"),
            (&["--estimator", "simple", "--directions", "uniform"], path, "--directions"),
        ] {
            let error = applied(words, from).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{words:?}");
            assert!(error.to_string().contains(says), "{error}");
        }
    }

    #[test]
    fn the_long_help_names_every_preset() {
        for name in ["simple"].into_iter().chain(Estimator::preset_names()) {
            assert!(PRESET_TABLE.contains(&format!("\n  {name} ")), "{name}");
        }
    }

    #[test]
    fn every_estimator_that_is_listed_is_an_estimator() {
        let message = estimator("photon").unwrap_err();
        let listed: Vec<_> = message.split('`').skip(1).step_by(2).collect();
        assert_eq!(listed.len(), 7, "{message}");
        for name in listed {
            assert!(estimator(name).is_ok(), "{name}");
        }
    }
}
