//! Light that reaches a floor by way of a mirror or a sharp lobe: what a path tracer without photons misses.

use super::judge::{certain_bias, light, up_to};
use super::spot::{
    Spot, Tally, chart, irradiance_of_mesh, looking_from, off, over_parallelogram, percent, series, without_roulette,
};
use super::sweep::{Definition, Family, Findings, Sweep};
use super::verdict::{Judgement, Verdict, Worse, stretch};
use crate::Workbench;
use crate::chart::{Axis, Point, Series};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::Result;
use luminaire::backend::Backend;
use luminaire::reference::bsdf::glossy_normalization;
use luminaire::scene::build::{add, lamp, matte, quad};
use luminaire::scene::{LightSampling, Luminaire, Material, Mesh, Scene};
use std::f64::consts::PI;

/// The sweep over the lamp's size, in a mirror.
pub const MIRROR: Definition = Definition {
    name: "caustics",
    family: Family::Light,
    title: "a floor lit by way of a mirror: side of the lamp, 1 to a point",
    run: |bench| {
        let sides = match bench.long {
            false => vec![0.0, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3],
            true => vec![0.0, 1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3],
        };
        mirror(bench, &sides, if bench.long { 1 << 20 } else { 1 << 17 })
    },
};

/// The sweep over the exponent of the lobe in the mirror's place.
pub const LOBE: Definition = Definition {
    name: "glossy-caustics",
    family: Family::Light,
    title: "a floor lit by a point luminaire by way of a glossy wall: exponent, 1 to 1e8",
    run: |bench| {
        let steps = if bench.long { 2 } else { 1 };
        let exponents: Vec<f32> = (0..=8 * steps).map(|i| 10f32.powf(i as f32 / steps as f32)).collect();
        lobe(bench, &exponents, if bench.long { 1 << 20 } else { 1 << 17 })
    },
};

const ALBEDO: f32 = 0.5;
/// The wall's.
const REFLECTANCE: f32 = 0.9;
/// Where the light is, one unit above the floor, and its image behind the wall.
const LIGHT: Vec3 = Vec3::new(0.25, 1.0, 0.0);
const IMAGE: Vec3 = Vec3::new(1.75, 1.0, 0.0);

fn variance(of: &str) -> Axis {
    Axis::log(format!("variance of a sample / (light by way of the {of})²"))
}

/// A floor, on which the camera looks, and a wall at x = 1.
fn room(wall: Material) -> Scene {
    let mut scene = looking_from(Vec3::new(-0.5, 1.0, 0.8));
    let floor = quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0);
    add(&mut scene, floor, matte(Vec3::splat(ALBEDO)), Affine3A::IDENTITY);
    let [corner, up, along] = WALL;
    add(&mut scene, quad(corner, up, along), wall, Affine3A::IDENTITY);
    scene
}

/// A corner and two edges.
const WALL: [Vec3; 3] = [Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.0, 0.0, 2.0)];

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
pub fn mirror(bench: &Workbench, sides: &[f32], samples: u32) -> Result<Sweep> {
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
    // A point is never met, which no number of samples tells: nothing varies.
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
    let needs = |side: f64| factor / (side * side) / 0.05f64.powi(2);
    let point = shares.iter().chain(&on_gpu).flat_map(|s| s.points.iter().filter(|p| p.x == 0.0));
    let found_of_point = point.map(|p| p.y.abs()).fold(0.0, f64::max);
    let findings = Findings {
        starts: format!(
            "With a lamp of any size the noise of the mirrored light is {factor:.1} over the squared side: for 5 % a pixel takes {:.0e} \
             samples where the side is a tenth of the distance, {:.0e} where it is a hundredth, {:.0e} where it is a thousandth. From a point luminaire \
             no estimator finds the way.",
            needs(0.1),
            needs(0.01),
            needs(1e-3),
        ),
        how: format!(
            "Light sampling cannot aim by way of a mirror, so that only chance meets the lamp in it: fireflies, as bright as they are rare. \
             A point cannot be met: what the mirror throws on the floor is missing, a bias that no number of samples mends. Here it is {} \
             of all light, by the image behind the mirror; found of it: {}.",
            percent(missing),
            percent(found_of_point),
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
    let share = Axis::linear("share found of the mirrored light");
    let charts = vec![
        chart("energy", "Light by way of a mirror", SIDE, share, shares),
        chart("noise", "Noise of a floor that is lit by way of a mirror, too", SIDE, variance("mirror"), noise),
    ];
    let summary = "Give every light a size, the larger the better: no estimator finds a point in a mirror.".into();
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

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
pub fn lobe(bench: &Workbench, exponents: &[f32], samples: u32) -> Result<Sweep> {
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
            "The noise is at most {factor:.1} times the exponent: for 5 % of noise in that light a pixel takes {:.0e} samples at 100, \
             {:.0e} at 1e4, {:.0e} at 1e6. With {samples} samples the light is known to a tenth up to {last:.0e}.",
            factor * 1e2 / 0.0025,
            factor * 1e4 / 0.0025,
            factor * 1e6 / 0.0025,
        ),
        how: format!(
            "No bias: where it is known to a tenth, the light is that of the integral over the wall to {}, beyond three standard errors, on \
             every backend. But a path finds it only if its direction, chosen for the floor, falls into the part of the wall whose lobe \
             shows the light, which shrinks as one over the exponent. At {:.0e} the share that was found is {:.2}.",
            percent(farthest),
            sharpest.0,
            sharpest.1,
        ),
        mends: "Light is sampled at every bounce, so that wide lobes are no trouble; sharp ones need what mirrors need. A mirror is the \
                limit: there nothing of a point luminaire is found."
            .into(),
        sees: format!(
            "Caustics of point luminaires that are even below an exponent of about 100, fireflies above it, and that fade away towards the \
             mirror. {}",
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
