//! Light that reaches a floor by way of a mirror: what a path tracer without photons misses.

use crate::Workbench;
use crate::chart::{Axis, Point, Series};
use crate::report::words::share;
use crate::stability::judge::{certain_bias, light};
use crate::stability::light::{Spot, Tally, chart, irradiance_of_mesh, series, without_roulette};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{EVEN, Judgement, Verdict, Worse, stretch};
use crate::stability::wall::{ALBEDO, IMAGE, LIGHT, REFLECTANCE, room, variance};
use glam::{Affine3A, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::scene::build::{add, lamp, quad};
use luminaire::scene::{LightSampling, Luminaire, Material, Mesh, Scene};
use std::f64::consts::PI;

/// The sweep over the lamp's size, in a mirror.
pub const DEFINITION: Definition = Definition {
    name: "caustics",
    family: Family::Light,
    title: "a floor lit by way of a mirror: side of the lamp, 1 to a point",
    run: |bench| {
        let sides = match bench.long {
            false => vec![0.0, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3],
            true => vec![0.0, 1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3],
        };
        sweep(bench, &sides, if bench.long { 1 << 20 } else { 1 << 17 })
    },
};

/// A lamp that faces the floor; of unit power, whatever its side.
fn square(middle: Vec3, side: f32) -> (Mesh, f32) {
    let corner = middle - 0.5 * side * (Vec3::X + Vec3::Z);
    (quad(corner, Vec3::X * side, Vec3::Z * side), 1.0 / (side * side))
}

/// The light that comes straight, and by way of the mirror, as radiance of the floor.
fn mirrored(side: f32) -> (Scene, f64, f64) {
    let mut scene =
        room(Material { name: "mirror".into(), reflection: Vec3::splat(REFLECTANCE), ..Material::default() });
    let floor = f64::from(ALBEDO) / PI;
    if side == 0.0 {
        scene.luminaires.push(Luminaire::Point { position: LIGHT, intensity: Vec3::ONE });
        let from = |p: Vec3| floor * f64::from(p.y) / p.as_dvec3().length().powi(3);
        return (scene, from(LIGHT), f64::from(REFLECTANCE) * from(IMAGE));
    }
    let (shape, radiance) = square(LIGHT, side);
    let light = |shape: &Mesh| floor * f64::from(radiance) * irradiance_of_mesh(shape);
    let (straight, by_mirror) = (light(&shape), f64::from(REFLECTANCE) * light(&square(IMAGE, side).0));
    add(&mut scene, shape, lamp(Vec3::splat(radiance)), Affine3A::IDENTITY);
    (scene, straight, by_mirror)
}

/// Runs the sweep over the lamp's side; 0 is a point luminaire. Sides up to 0.5: the mirror must show all of the image.
///
/// # Errors
/// If a device fails.
pub fn sweep(bench: &Workbench, sides: &[f32], samples: u32) -> Result<Sweep> {
    let mut tally = Tally::default();
    let methods = [("light sampling", LightSampling::Direct), ("both (MIS)", LightSampling::Mis)];
    let mut shares = series(methods.map(|(name, _)| format!("{name}, cpu")));
    let mut noise = series(methods.map(|(name, _)| name));
    let gpu: Vec<Backend> = bench.backends().into_iter().skip(1).collect();
    let mut on_gpu = series(gpu.iter().map(|backend| format!("both (MIS), {backend}")));
    let mut missing = 0.0;
    for &side in sides {
        let (scene, straight, by_mirror) = mirrored(side);
        let x = f64::from(side);
        let mut measure = |backend, light_sampling| -> Result<Spot> {
            let spot = Spot::new(bench, backend, &scene, without_roulette(light_sampling, 1), samples)?;
            tally.add(&spot);
            Ok(spot)
        };
        if side == 0.0 {
            missing = by_mirror / (straight + by_mirror);
        }
        for (i, (_, light_sampling)) in methods.iter().enumerate() {
            let spot = measure(Backend::Cpu, *light_sampling)?;
            shares[i].points.push(spot.share_of(x, by_mirror, straight));
            noise[i].points.push(spot.noise_of(x, by_mirror, straight));
        }
        for (series, backend) in on_gpu.iter_mut().zip(&gpu) {
            series.points.push(measure(*backend, LightSampling::Mis)?.share_of(x, by_mirror, straight));
        }
    }
    // A point is never met, and the samples do not show it: nothing varies.
    let judge = |method: usize| {
        let point = |p: &Point| (p.x, Judgement::of_share(certain_bias(p.y, p.error.unwrap_or(0.0))));
        let of_point = shares[method].points.iter().filter(|p| p.x == 0.0).map(point);
        let sized = |s: &Series| Series {
            name: s.name.clone(),
            points: s.points.iter().filter(|p| p.x > 0.0).copied().collect(),
        };
        let gpu = on_gpu.iter().filter(|_| method == 1).map(sized);
        let found: Vec<Series> = std::iter::once(sized(&shares[method])).chain(gpu).collect();
        let verdict =
            light(methods[method].0, &[&sized(&noise[method])], &found.iter().collect::<Vec<_>>(), Worse::Downwards);
        let ranges =
            verdict.ranges.iter().flat_map(|range| [(range.from, range.judgement), (range.to, range.judgement)]);
        Verdict::new(verdict.method.clone(), ranges.chain(of_point), Worse::Downwards, verdict.evidence.clone())
    };
    let verdicts = vec![judge(1), judge(0)];
    let range = stretch(sides.iter().map(|side| f64::from(*side)), Worse::Downwards, "of the distance");
    // In proportion to one over the area: as a number that does not depend on the side.
    let of_area = noise[1].points.iter().filter(|p| p.x > 0.0 && !p.y.is_nan()).map(|p| p.y * p.x * p.x);
    let factor = of_area.fold(0.0, f64::max);
    let needs = |side: f64| factor / (side * side) / EVEN.powi(2);
    let point = shares.iter().chain(&on_gpu).flat_map(|s| s.points.iter().filter(|p| p.x == 0.0));
    let found_of_point = point.map(|p| p.y.abs()).fold(0.0, f64::max);
    let findings = Findings {
        starts: format!(
            "With a lamp of any size the noise of the mirrored light is {factor:.1} over the squared side: for {:.0} % a pixel takes {:.0e} \
             samples where the side is a tenth of the distance, {:.0e} where it is a hundredth, {:.0e} where it is a thousandth. From a point luminaire \
             no estimator finds the way.",
            100.0 * EVEN,
            needs(0.1),
            needs(0.01),
            needs(1e-3),
        ),
        how: format!(
            "Light sampling cannot aim by way of a mirror, so that only chance meets the lamp in it: fireflies, as bright as they are rare. \
             A point cannot be met: what the mirror throws on the floor is missing, a bias that no number of samples mends. Here it is {} \
             of all light, by the image behind the mirror; found of it: {}.",
            share(missing),
            share(found_of_point),
        ),
        mends: "Nothing: that takes photon maps, bidirectional paths or manifold walks, which luminaire does not have. A point luminaire, \
                and one at infinity, lights what it sees straight and no more; give such a light a size, the larger the better."
            .into(),
        sees: format!(
            "No caustics of point luminaires and of the sun. Bright dots in those of small lamps; a picture of few samples is too dark \
             there. {}",
            tally.sentence(),
        ),
    };
    shares.extend(on_gpu);
    const SIDE: &str = "side of the lamp (0: point luminaire)";
    let axis = Axis::linear("share found of the mirrored light");
    let charts = vec![
        chart("energy", "Light by way of a mirror", SIDE, axis, shares),
        chart("noise", "Noise of a floor that is lit by way of a mirror, too", SIDE, variance("mirror"), noise),
    ];
    let summary = "Give every light a size, the larger the better: no estimator finds a point in a mirror.".into();
    Ok(Sweep { charts, range, verdicts, summary, findings })
}
