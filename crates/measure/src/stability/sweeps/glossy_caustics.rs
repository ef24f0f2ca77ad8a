//! Light that reaches a floor by way of a sharp lobe: where it turns into fireflies.

use crate::Workbench;
use crate::chart::{Axis, Point, Series};
use crate::stability::judge::{light, safe_until, up_to};
use crate::stability::light::{Spot, Tally, chart, off, over_parallelogram, series, within, without_roulette};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{EVEN, Verdict, Worse, stretch};
use crate::stability::wall::{ALBEDO, IMAGE, LIGHT, REFLECTANCE, WALL, room, variance};
use glam::{DVec3, Vec3};
use luminaire::Result;
use luminaire::reference::bsdf::glossy_normalization;
use luminaire::scene::build::matte;
use luminaire::scene::{LightSampling, Luminaire, Material, Scene};
use std::f64::consts::PI;

/// The sweep over the exponent of the lobe in the mirror's place.
pub const DEFINITION: Definition = Definition {
    name: "glossy-caustics",
    family: Family::Light,
    title: "a floor lit by a point luminaire by way of a glossy wall: exponent, 1 to 1e8",
    run: |bench| {
        let steps = if bench.long { 2 } else { 1 };
        let exponents: Vec<f32> = (0..=8 * steps).map(|i| 10f32.powf(i as f32 / steps as f32)).collect();
        sweep(bench, &exponents, if bench.long { 1 << 20 } else { 1 << 17 })
    },
};

/// A point luminaire and a glossy wall: the light that comes straight, and by way of the wall.
fn lobed(exponent: f32) -> (Scene, f64, f64) {
    let mut scene = room(Material { glossy: Vec3::splat(REFLECTANCE), exponent, ..matte(Vec3::ZERO) });
    scene.luminaires.push(Luminaire::Point { position: LIGHT, intensity: Vec3::ONE });
    let (m, light) = (f64::from(exponent), LIGHT.as_dvec3());
    let straight = f64::from(ALBEDO) / PI * light.y / light.length().powi(3);
    let wall = WALL.map(|v| v.as_dvec3());
    // Where the mirror would show the light.
    let image = IMAGE.as_dvec3() / f64::from(IMAGE.x);
    let shares = [image.y / wall[1].y, (image.z - wall[0].z) / wall[2].z];
    let seen = over_parallelogram(wall, shares, 0.5 * (1.0 + m).sqrt(), |p| {
        let (to_light, to_floor) = (light - p, -p);
        let (wi, wo) = (to_light.normalize(), to_floor.normalize());
        // The wall's normal is -x; cos^m by the sine, which is small.
        let sine2 = (wi + wo).normalize().cross(DVec3::X).length_squared();
        let f = glossy_normalization(m) * (0.5 * m * f64::ln_1p(-sine2.min(1.0))).exp();
        let radiance = f * -wi.x / to_light.length_squared();
        radiance * -wo.x * -wo.y / to_floor.length_squared()
    });
    (scene, straight, f64::from(ALBEDO) / PI * f64::from(REFLECTANCE) * seen)
}

/// Runs the sweep over the exponent.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, exponents: &[f32], samples: u32) -> Result<Sweep> {
    let mut tally = Tally::default();
    let backends = bench.backends();
    let mut shares = series(&backends);
    let mut noise = series(&backends);
    for &exponent in exponents {
        let (scene, straight, by_wall) = lobed(exponent);
        for (i, &backend) in backends.iter().enumerate() {
            let spot = Spot::new(bench, backend, &scene, without_roulette(LightSampling::Mis, 1), samples)?;
            tally.add(&spot);
            shares[i].points.push(spot.share_of(exponent.into(), by_wall, straight));
            noise[i].points.push(spot.noise_of(exponent.into(), by_wall, straight));
        }
    }
    let all = |series: &[Series]| -> Verdict {
        let noise: Vec<_> = noise.iter().collect();
        light("both (MIS)", &noise, &series.iter().collect::<Vec<_>>(), Worse::Upwards)
    };
    let verdicts = vec![all(&shares)];
    let range = stretch(exponents.iter().map(|exponent| f64::from(*exponent)), Worse::Upwards, "(exponent)");
    let summary = up_to(&verdicts, "both (MIS)", |end| {
        format!("Caustics by way of a lobe are even up to an exponent of {end}, and fireflies beyond.")
    });
    // Found for certain: with a standard error below a tenth.
    let certain = |p: &&Point| p.error.is_some_and(|error| error < 0.1);
    let last = shares[0].points.iter().take_while(certain).last().map_or(0.0, |p| p.x);
    let off = shares.iter().map(|s| off(s, 0.0..=last));
    let farthest = off.fold(0.0, f64::max);
    let sharpest = shares[0].points.last().map_or((0.0, 0.0), |p| (p.x, p.y));
    let factor = noise[0].points.iter().filter(|p| p.x <= last && p.x >= 10.0).map(|p| p.y / p.x).fold(0.0, f64::max);
    let findings = Findings {
        starts: format!(
            "The noise is at most {factor:.1} times the exponent: for {:.0} % of noise in that light a pixel takes {:.0e} samples at 100, \
             {:.0e} at 1e4, {:.0e} at 1e6. With {samples} samples the light is known to a tenth up to {last:.0e}.",
            100.0 * EVEN,
            factor * 1e2 / EVEN.powi(2),
            factor * 1e4 / EVEN.powi(2),
            factor * 1e6 / EVEN.powi(2),
        ),
        how: format!(
            "Where it is known to a tenth, the light is {}, held against the integral over the wall, on every backend. But a path finds it only if its direction, chosen for the floor, falls into the part of the wall whose lobe \
             shows the light, which shrinks as one over the exponent. At {:.0e} the share that was found is {:.2}.",
            within(farthest),
            sharpest.0,
            sharpest.1,
        ),
        mends: "Light is sampled at every bounce, so that wide lobes are no trouble; sharp ones need what mirrors need. A mirror is the \
                limit: there nothing of a point luminaire is found."
            .into(),
        sees: format!(
            "{} They fade away towards the mirror. {}",
            match safe_until(&verdicts, "both (MIS)") {
                Ok(end) => format!("Caustics of point luminaires that are even up to an exponent of {end}, and fireflies beyond."),
                Err(_) => "Caustics of point luminaires as fireflies.".into(),
            },
            tally.sentence(),
        ),
    };
    const EXPONENT: &str = "exponent of the wall";
    let share = Axis::linear("share found of the light by way of the wall");
    let charts = vec![
        chart("energy", "Light of a point luminaire by way of a glossy wall", EXPONENT, share, shares),
        chart("noise", "Noise of a floor that is lit by way of a glossy wall", EXPONENT, variance("wall"), noise),
    ];
    Ok(Sweep { charts, range, verdicts, summary, findings })
}
