//! The line that describes an integrator.

use luminaire::scene::{AreaSampling, Directions, Estimator, Extinction, Integrator, LightChoice, LightSampling};

/// The integrator in plain words: the preset's name, if there is one, and every part.
pub fn describe(integrator: &Integrator) -> String {
    let estimator = match integrator {
        Integrator::Simple { ambient } => {
            return format!(
                "simple ray tracer: direct light and ambient radiance ({} {} {})",
                ambient.x, ambient.y, ambient.z
            );
        }
        Integrator::Path(estimator) => estimator,
    };
    // A preset with a limit of bounces is still that preset.
    let unlimited = Estimator { max_bounces: None, ..*estimator };
    let preset = Estimator::preset_names().find(|name| Estimator::preset(name) == Some(unlimited));
    let preset = preset.map_or(String::new(), |name| format!(", estimator `{name}`"));
    let light = match estimator.light_sampling {
        LightSampling::None => "light found by chance alone",
        LightSampling::Direct => "light sampled",
        LightSampling::Mis => "light sampled and found by chance",
    };
    let area = match (estimator.light_sampling, estimator.area_sampling) {
        (LightSampling::None, _) => "",
        (_, AreaSampling::Area) => ", lamps by area",
        (_, AreaSampling::SolidAngle) => ", near lamps by solid angle",
    };
    let choice = match (estimator.light_sampling, estimator.light_choice) {
        (LightSampling::None, _) | (_, LightChoice::Auto) => "",
        (_, LightChoice::Power) => ", luminaires by power",
        (_, LightChoice::Tree) => ", luminaires by the light tree",
    };
    let directions = match estimator.directions {
        Directions::Uniform => "uniform directions",
        Directions::Cosine => "cosine-distributed directions",
        Directions::Bsdf => "directions by the BSDF",
    };
    let extinction = match estimator.extinction {
        Extinction::Off => "no extinction",
        Extinction::Literal => "extinction by the surface, not re-weighted",
        Extinction::Surface => "extinction by the surface",
        Extinction::Throughput => "Russian roulette",
    };
    let threshold = match estimator.albedo_threshold {
        Some(threshold) => format!(", ends below a combined albedo of {threshold}"),
        None => String::new(),
    };
    let bounces = match estimator.max_bounces {
        None => "any number of bounces".into(),
        Some(0) => "direct light only".into(),
        Some(1) => "at most 1 indirect bounce".into(),
        Some(n) => format!("at most {n} indirect bounces"),
    };
    let terminator = if estimator.smooth_terminator { ", smooth terminator" } else { "" };
    format!("path tracer{preset}: {light}{area}{choice}, {directions}, {extinction}{threshold}, {bounces}{terminator}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_recognised() {
        let cosine = Estimator::preset("cosine").unwrap();
        let said = describe(&Integrator::Path(Estimator { max_bounces: Some(4), ..cosine }));
        assert!(said.contains("`cosine`") && said.contains("at most 4 indirect bounces"), "{said}");
        let said = describe(&Integrator::Path(Estimator { extinction: Extinction::Throughput, ..cosine }));
        assert!(!said.contains('`') && said.contains("Russian roulette"), "{said}");
    }
}
