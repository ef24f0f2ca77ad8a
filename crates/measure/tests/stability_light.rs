//! The sweeps over light, a few points each: what luminaire promises there.

#[path = "../../../tests/common/mod.rs"]
mod common;

use common::bench;
use common::statistics::{Claims, Estimate, assert_plausible, two_sided};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::reference::warp::uniform_hemisphere;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::build::{add, empty, lamp, matte, quad};
use luminaire::scene::{Estimator, Integrator, LightChoice, LuminaireTable, SampledLuminaire};
use luminaire_measure::chart::{Chart, Series};
use luminaire_measure::stability::Sweep;
use luminaire_measure::stability::sweeps::{
    absorption, anisotropy, caustics, edge_on, glossy, glossy_caustics, grazing, luminaire as lamps, rough_index,
    roughness, spot,
};
use std::f64::consts::TAU;

fn chart<'a>(sweep: &'a Sweep, name: &str) -> &'a Chart {
    sweep.charts.iter().find(|chart| chart.name == name).expect("a chart of that name")
}

fn series<'a>(chart: &'a Chart, name: &str) -> &'a Series {
    chart.series.iter().find(|series| series.name == name).expect("a series of that name")
}

/// Fails unless the shares of these series may be 1, but for rounding (each number is a test), or are not known to `resolution`.
fn assert_all_found(all: &[&Series], rounding: f64, resolution: f64) {
    let mut tests = Vec::new();
    for (series, p) in all.iter().flat_map(|series| series.points.iter().map(move |p| (series, p))) {
        let what = format!("{} at {:e}: {}", series.name, p.x, p.y);
        let off = ((p.y - 1.0).abs() - rounding).max(0.0);
        let error = p.error.unwrap_or(0.0);
        assert!(error <= resolution, "{what} is only known to {error}");
        tests.push((what, if off == 0.0 { 1.0 } else { two_sided(off / error) }));
    }
    assert_plausible(&tests);
}

/// From flat to mirror-like no energy is lost or made; both ways of finding light together are nowhere noisy, and with roulette, which
/// leaves the first surface alone however dark it is, neither.
#[test]
fn glossy_plates() {
    let sweep = glossy::sweep(&bench(), &glossy::Steps { exponents: vec![3.0, 1e3, 1e5, 1e8], samples: 1 << 14 })
        .expect("the sweep runs");
    let energy = chart(&sweep, "energy");
    let blind = |s: &&Series| s.name.starts_with("cosine") || s.name.starts_with("uniform");
    let kept: Vec<_> = energy.series.iter().filter(|s| !blind(s)).collect();
    assert!(kept.len() >= 3);
    assert_all_found(&kept, 1e-4, 0.02);
    for size in ["small", "middling", "large"] {
        let noise = chart(&sweep, &format!("noise-{size}-lamp"));
        let both = series(noise, "both (MIS)");
        assert!(both.points.iter().all(|p| p.y < 0.5), "{size}: {both:?}");
        for (both, roulette) in both.points.iter().zip(&series(noise, "both, with roulette").points) {
            let x = both.x;
            assert!(roulette.y <= 1.1 * both.y, "{size} lamp, exponent {x:e}: {} with, {} without", roulette.y, both.y);
        }
    }
}

/// From rough to a mirror a white metal sends back all of an even sky, a dark plate the light of lamps that its formulas say, and the defaults are nowhere noisy.
#[test]
fn plates_of_microfacets() {
    let sweep = roughness::sweep(&bench(), &[1.0, 0.2, 0.03, 1e-3, 1e-6], 1 << 13).expect("the sweep runs");
    assert_all_found(&chart(&sweep, "energy").series.iter().collect::<Vec<_>>(), 2e-3, 0.02);
    for size in ["small", "middling", "large"] {
        let noise = series(chart(&sweep, &format!("noise-{size}-lamp")), "both, with roulette");
        assert!(noise.points.iter().all(|p| p.y < 0.5), "{size}: {noise:?}");
    }
}

/// Brushed up to 1 : 1e4 a plate gives the light of a lamp that its formulas say; a white one is within a tenth of white.
#[test]
fn brushed_plates() {
    let sweep = anisotropy::sweep(&bench(), &[1.0, 10.0, 1e4], 1 << 13).expect("the sweep runs");
    let energy = chart(&sweep, "energy");
    let (white, dark): (Vec<_>, Vec<_>) = energy.series.iter().partition(|s| s.name.starts_with("white"));
    assert_all_found(&dark, 2e-3, 0.1);
    for (series, p) in white.iter().flat_map(|series| series.points.iter().map(move |p| (series, p))) {
        let error = p.error.expect("it varies");
        assert!(error < 0.01 && (0.9 - 4.0 * error..1.03 + 4.0 * error).contains(&p.y), "{}: {p:?}", series.name);
    }
}

/// Rough glass of every index from both sides, and metals whose index goes through 1, are what they are expected to be.
#[test]
fn indices_through_one() {
    let steps = rough_index::Steps { glass: vec![1.5, 1.03, 1.0], metal: vec![2.0, 1.001, 1.0, 0.2], samples: 1 << 13 };
    let sweep = rough_index::sweep(&bench(), &steps).expect("the sweep runs");
    assert_all_found(&chart(&sweep, "energy").series.iter().collect::<Vec<_>>(), 3e-3, 0.03);
    for line in &chart(&sweep, "metal").series {
        assert!(line.points.iter().all(|p| (p.y - 1.0).abs() < 1e-6), "{line:?}");
    }
}

/// Bodies absorb by their length, from a millionth of their thickness to a million of it, seen from outside and from inside.
#[test]
fn bodies_from_black_to_clear() {
    let sweep = absorption::sweep(&bench(), &[1e-6, 0.1, 1.0, 1e6], 1 << 13).expect("the sweep runs");
    assert_all_found(&chart(&sweep, "energy").series.iter().collect::<Vec<_>>(), 2e-6, 0.02);
}

/// However flat one looks at bent normals, a mirror shows the whole sky, a diffuse plate what its lobe has above the surface, and no metal sends back more than
/// it gets, or nothing.
#[test]
fn bent_normals_seen_at_grazing_angles() {
    let sweep = grazing::sweep(&bench(), &[45.0, 1.0, 1e-2, 1e-4], 1 << 13).expect("the sweep runs");
    let all: Vec<_> = chart(&sweep, "energy").series.iter().collect();
    assert!(all.len() >= 9);
    assert_all_found(&all, 2e-4, 0.02);
    for series in &chart(&sweep, "albedo").series {
        assert!(
            series.points.iter().all(|p| p.y > 0.3 && p.y < 1.0 + 1e-5 + 4.0 * p.error.unwrap_or(0.0)),
            "{series:?}"
        );
    }
    assert!(chart(&sweep, "noise").series.iter().all(|series| series.points.iter().all(|p| p.y < 2.0)));
}

/// Lambert's formula holds from a ten-thousandth of a lamp's side to a million of them, and the default estimator is never noisy; by area
/// alone is.
#[test]
fn near_and_far_lamps() {
    let sweep = lamps::sweep(&bench(), &[1e-4, 1e-2, 1.0, 1e6], 1 << 14).expect("the sweep runs");
    let energy = chart(&sweep, "energy");
    let default: Vec<_> = energy.series.iter().filter(|s| s.name.starts_with("by solid angle")).collect();
    assert!(default.len() >= 2);
    assert_all_found(&default, 1e-5, 0.02);
    let noise = chart(&sweep, "noise");
    let default = series(noise, "by solid angle, MIS");
    assert!(default.points.iter().all(|p| p.y < 0.2), "{default:?}");
    // A variance of 500 times the squared mean at a hundredth, or so little of the light was found that it is not known.
    let by_area = series(noise, "by area").points[1].y;
    assert!(by_area.is_nan() || by_area > 100.0, "{by_area}");
}

/// So near that the rounding of the floor counts, what light sampling and paths find still adds up: the two see the lamp from the same
/// point.
#[test]
fn lamps_within_rounding() {
    let sweep = lamps::sweep(&bench(), &[5e-6, 7e-6, 1e-5, 2e-5], 1 << 14).expect("the sweep runs");
    let all: Vec<_> =
        chart(&sweep, "energy").series.iter().filter(|s| s.name.starts_with("by solid angle, MIS")).collect();
    assert_all_found(&all, 2e-4, 0.02);
}

/// A lamp that is seen from its edge gives what Lambert's formula says, to the rounding of its corners.
#[test]
fn lamps_seen_edge_on() {
    let sweep = edge_on::sweep(&bench(), &[1e-4, 1e-2, 1.0], 1 << 14).expect("the sweep runs");
    let sampled: Vec<_> = chart(&sweep, "energy").series.iter().filter(|s| s.name.starts_with("by ")).collect();
    assert_all_found(&sampled, 2e-3, 0.02);
}

/// Suns of every size give their irradiance, by light sampling and with both, without noise; and spots what their formula says, to the rounding of their axis.
#[test]
fn suns_and_spots_wide_and_narrow() {
    let sweep = spot::sweep(&bench(), &[1e-4, 1e-2, 0.265, 10.0, 90.0], 1 << 14).expect("the sweep runs");
    let energy = chart(&sweep, "energy");
    let of = |start: &str| energy.series.iter().filter(|s| s.name.starts_with(start)).collect::<Vec<_>>();
    assert_all_found(&[of("sun, both"), of("sun, light")].concat(), 1e-5, 0.02);
    let noise = chart(&sweep, "noise");
    assert!(series(noise, "sun, both (MIS)").points.iter().all(|p| p.y < 0.2), "{noise:?}");
    for series in of("spot") {
        for p in &series.points {
            let rounding = if p.x < 1e-3 { 0.3 } else { 1e-5 + 4e-5 / p.x };
            assert!((p.y - 1.0).abs() < rounding, "{} at {}: {}", series.name, p.x, p.y);
        }
    }
}

/// Of a point luminaire's light a mirror gives nothing, and the straight light exactly; of a lamp's it gives all.
#[test]
fn light_by_way_of_a_mirror() {
    let sweep = caustics::sweep(&bench(), &[0.0, 0.3], 1 << 17).expect("the sweep runs");
    for series in &chart(&sweep, "energy").series {
        let [point, lamp] = series.points[..] else { panic!("two points") };
        assert!(point.y.abs() < 1e-5, "{}: {}", series.name, point.y);
        let z = (lamp.y - 1.0) / lamp.error.expect("it varies");
        assert!(lamp.error.expect("it varies") < 0.1 && two_sided(z) >= 1e-4, "{}: {lamp:?}", series.name);
    }
}

/// By way of a glossy wall all of it is found, as long as the lobe is wide.
#[test]
fn light_by_way_of_a_lobe() {
    let sweep = glossy_caustics::sweep(&bench(), &[1.0, 100.0], 1 << 15).expect("the sweep runs");
    assert_all_found(&chart(&sweep, "energy").series.iter().collect::<Vec<_>>(), 1e-5, 0.1);
}

/// The density of light sampling, integrated over the directions to each of several lamps, is the probability of choosing that lamp: one
/// is near, one far, one faint.
#[test]
fn densities_of_several_lamps() {
    let mut scene = empty(1, 1);
    add(
        &mut scene,
        quad(Vec3::new(-9.0, 0.0, -9.0), Vec3::Z * 18.0, Vec3::X * 18.0),
        matte(Vec3::ONE),
        Affine3A::IDENTITY,
    );
    for (corner, side, radiance) in [
        (Vec3::new(-1.0, 0.5, -0.5), 0.6, 1.0),
        (Vec3::new(0.5, 1.0, 0.5), 1.5, 0.1),
        (Vec3::new(0.5, 4.0, -4.0), 3.0, 3.0),
    ] {
        let tilted = Vec3::new(1.0, 0.2, 0.0) * side;
        add(&mut scene, quad(corner, tilted, Vec3::Z * side), lamp(Vec3::splat(radiance)), Affine3A::IDENTITY);
    }
    let light_choice = LightChoice::Power;
    scene.integrator = Integrator::Path(Estimator { light_choice, ..Estimator::default() });
    let table = LuminaireTable::new(&scene);
    let tracer = Reference::new(&scene);
    let below = tracer.closest_hit(DVec3::Y * 0.1, -DVec3::Y, f64::INFINITY, 0).expect("the floor");
    let floor = tracer.surfel(&below, DVec3::Y);
    let from = floor.position;
    const N: u32 = 200_000;
    let found: Vec<Option<(u32, f64)>> = (0..N)
        .map(|i| {
            let [u, v, ..] = random4(i, 0, 0, 7).map(uniform);
            let wi = uniform_hemisphere(DVec3::Y, u, v);
            let hit = tracer.closest_hit(from + 1e-9 * DVec3::Y, wi, f64::INFINITY, 0)?;
            Some((hit.object, TAU * tracer.luminaire_pdf(&floor, &tracer.surfel(&hit, -wi))))
        })
        .collect();
    for object in 1..=3 {
        let entries = table.entries.iter().zip(&table.choice.pdf);
        let of_lamp = |e: &SampledLuminaire| matches!(e, SampledLuminaire::Area(t) if t.object == object);
        let chosen: f64 = entries.filter(|(e, _)| of_lamp(e)).map(|(_, pdf)| pdf).sum();
        let densities = found.iter().map(|f| f.filter(|(o, _)| *o == object).map_or(0.0, |(_, density)| density));
        Estimate::new(densities).assert_is(chosen, 0.03);
    }
}
