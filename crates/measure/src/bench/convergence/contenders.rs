//! The estimators that run against each other, by their names.

use luminaire::sampling::Sampler;
use luminaire::scene::{Estimator, Integrator, LightSampling, Scene};

/// What runs unless the user chooses: the best there is, the same with independent numbers, the lecture's light sampling with cosine-distributed
/// directions, Kajiya's path tracing, and what the scene itself asks for.
pub const STANDARD: [&str; 5] = ["default", "default+independent", "cosine", "no-light-sampling", "own"];

/// An estimator and its numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Contender {
    pub name: String,
    pub integrator: Integrator,
    pub sampler: Sampler,
}

/// Checks the name of an estimator: `own` (the scene's) or one of [`Estimator::preset_names`], and after it, if wanted, `+independent` or
/// `+sobol` for where the random numbers come from.
///
/// # Errors
/// What is expected, in words.
pub fn check_estimator(name: &str) -> Result<String, String> {
    let (estimator, numbers) = name.split_once('+').unwrap_or((name, "sobol"));
    let known = estimator == "own" || Estimator::preset(estimator).is_some();
    if known && ["sobol", "independent"].contains(&numbers) {
        return Ok(name.into());
    }
    let names: Vec<_> = Estimator::preset_names().map(|name| format!("`{name}`")).collect();
    Err(format!("expected `own`, {}, and after it perhaps `+independent` or `+sobol`", names.join(", ")))
}

/// What an estimator does, for readers who do not know its name.
pub(super) fn words(name: &str) -> String {
    let (estimator, numbers) = name.split_once('+').unwrap_or((name, ""));
    let words = match estimator {
        "default" => {
            "light is sampled and also found by chance (multiple importance sampling), directions by the BSDF, Russian roulette"
        }
        "no-light-sampling" => {
            "light is only found where a path happens to meet it (Kajiya), cosine-distributed directions"
        }
        "uniform" => "light is sampled by area, directions evenly over the hemisphere",
        "cosine" => "light is sampled by area, cosine-distributed directions, the survivors of extinction re-weighted",
        "literal-extinction" => "the same as cosine, but survivors are not re-weighted: darker than the truth",
        "threshold" => "cosine, and a path ends below a combined albedo of 1e-4: a little darker than the truth",
        _ => "what the scene asks for",
    };
    match numbers {
        "independent" => format!("`{name}`: {words}; independent random numbers"),
        "" if estimator == "own" => format!("`{name}`: {words}"),
        _ => format!("`{name}`: {words}; Sobol points"),
    }
}

/// The contenders of these names for a scene, each once, and why any is left out. All of them have the same expectation, but for the biases
/// that they are known for.
pub(super) fn contenders(scene: &Scene, names: &[String]) -> (Vec<Contender>, Vec<String>) {
    let (mut found, mut left_out): (Vec<Contender>, Vec<String>) = (Vec::new(), Vec::new());
    for name in names {
        match contender(scene, name) {
            Err(reason) => left_out.push(format!("`{name}` is left out: {reason}.")),
            Ok(new) if found.iter().any(|c| (c.integrator, c.sampler) == (new.integrator, new.sampler)) => {}
            Ok(new) => found.push(new),
        }
    }
    (found, left_out)
}

fn contender(scene: &Scene, name: &str) -> Result<Contender, &'static str> {
    let (estimator, numbers) =
        name.split_once('+').map_or((name, None), |(estimator, numbers)| (estimator, Some(numbers)));
    let integrator = match (estimator, Estimator::preset(estimator), scene.integrator) {
        ("own", _, integrator) => integrator,
        (_, _, Integrator::Simple { .. }) => {
            return Err("the scene asks for the simple ray tracer, whose picture is another");
        }
        (_, None, _) => return Err("there is no such estimator"),
        // A limit of the bounces is part of what the picture is.
        (_, Some(preset), Integrator::Path(own)) => {
            Integrator::Path(Estimator { max_bounces: own.max_bounces, ..preset })
        }
    };
    if let Integrator::Path(estimator) = integrator {
        if !estimator.ends() {
            return Err("its paths never end");
        }
        if estimator.light_sampling == LightSampling::None && !scene.luminaires.is_empty() {
            return Err("it never finds the luminaires without an area");
        }
    }
    let sampler = match numbers {
        Some("independent") => Sampler::Independent,
        None if estimator == "own" => scene.settings.sampler,
        _ => Sampler::Sobol,
    };
    Ok(Contender { name: name.into(), integrator, sampler })
}

/// What the reference of a scene is rendered with: the default estimator, or the simple ray tracer where the scene asks for it.
pub(super) fn reference(scene: &Scene) -> Contender {
    let integrator = match scene.integrator {
        Integrator::Path(own) => Integrator::Path(Estimator { max_bounces: own.max_bounces, ..Estimator::default() }),
        simple => simple,
    };
    let name = if matches!(integrator, Integrator::Path(_)) { "default" } else { "simple" };
    Contender { name: name.into(), integrator, sampler: Sampler::Sobol }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use luminaire::scene::Luminaire;
    use luminaire::scene::build::{empty, estimator};

    fn run(scene: &Scene, names: &[&str]) -> (Vec<String>, usize) {
        let (found, left_out) = contenders(scene, &names.iter().map(|n| n.to_string()).collect::<Vec<_>>());
        (found.into_iter().map(|c| c.name).collect(), left_out.len())
    }

    #[test]
    fn equal_contenders_run_once_and_unfit_ones_never() {
        let mut scene = empty(1, 1);
        // Its own numbers are independent.
        assert_eq!(run(&scene, &STANDARD), (STANDARD[..4].iter().map(|n| n.to_string()).collect(), 0));
        assert_eq!(
            run(&scene, &["own", "default+independent", "default+sobol", "default"]).0,
            ["own", "default+sobol"]
        );
        estimator(&mut scene).max_bounces = Some(3);
        let limited = contenders(&scene, &["uniform".into()]).0;
        assert_eq!(limited[0].integrator.estimator().max_bounces, Some(3), "all have the same expectation");
        assert_eq!(reference(&scene).integrator.estimator().max_bounces, Some(3));
        scene.luminaires.push(Luminaire::Point { position: Vec3::ZERO, intensity: Vec3::ONE });
        assert_eq!(run(&scene, &["cosine", "no-light-sampling"]), (vec!["cosine".into()], 1));
        scene.integrator = Integrator::Simple { ambient: Vec3::ZERO };
        assert_eq!(run(&scene, &STANDARD), (vec!["own".into()], 4));
    }

    #[test]
    fn every_preset_is_explained() {
        let known = words("own");
        for name in Estimator::preset_names() {
            assert!(!words(name).contains(known.split_once(": ").unwrap().1), "{name}");
        }
        assert!(words("cosine+independent").ends_with("; independent random numbers"));
    }

    #[test]
    fn names_are_checked() {
        for good in STANDARD.into_iter().chain(["own+independent", "uniform+sobol", "threshold"]) {
            assert_eq!(check_estimator(good), Ok(good.into()));
        }
        for bad in ["", "photon", "default+", "default+halton", "simple", "+sobol"] {
            assert!(check_estimator(bad).unwrap_err().contains("`no-light-sampling`"), "{bad}");
        }
    }
}
