//! What luminaire promises on the geometric sweeps of the stability map, at a few points of each. No chance is in them: rays and seeds are fixed, and a
//! promise of none is of none of these rays.
//!
//! Without a Vulkan device only the reference and the models are held to theirs, and SKIP is said; `LUMINAIRE_REQUIRE_GPU=1` makes that a failure.

#[path = "../../../tests/common/mod.rs"]
mod common;

use common::bench;
use glam::{Affine3A, Vec3};
use luminaire::reference::Reference;
use luminaire::scene::build::{add, empty, icosphere, matte};
use luminaire_measure::chart::Chart;
use luminaire_measure::intersect_f32::{Test, Triangles};
use luminaire_measure::random::Random;
use luminaire_measure::rays::{Ray, reference_hits};
use luminaire_measure::stability::sweeps::{distance, edges, eta, gaps, instances, scale, slivers, touching_glass};

const REFERENCE: &str = "f64 reference";
const COMPUTE_BVH: &str = "compute BVH";
const RAY_QUERY: &str = "ray query";

fn chart<'a>(charts: &'a [Chart], name: &str) -> &'a Chart {
    charts.iter().find(|chart| chart.name == name).unwrap_or_else(|| panic!("no chart {name}"))
}

/// The values of a method; none if it did not run.
fn values(chart: &Chart, method: &str) -> Vec<f64> {
    let series = chart.series.iter().find(|series| series.name.starts_with(method));
    series.map(|series| series.points.iter().map(|point| point.y).collect()).unwrap_or_default()
}

/// A method stays at or below some value at every point.
fn assert_most(chart: &Chart, method: &str, most: f64) {
    for (i, value) in values(chart, method).into_iter().enumerate() {
        assert!(value <= most, "{}, {method}, point {i}: {value}, at most {most} is promised", chart.title);
    }
}

#[test]
fn nothing_is_lost_up_to_10_000_sizes_from_the_origin() {
    let sweep = distance::sweep(&bench(), &[1.0, 1e3, 1e4], 10_000).expect("the sweep runs");
    for way in ["vertices", "instance"] {
        for quantity in ["lost", "self-hits", "escapes"] {
            let chart = chart(&sweep.charts, &format!("{quantity}-{way}"));
            assert_most(chart, REFERENCE, 0.0);
            assert_most(chart, COMPUTE_BVH, 0.0);
        }
        // The driver's ray query may lose some at vertices, but meets nothing again.
        assert_most(chart(&sweep.charts, &format!("self-hits-{way}")), RAY_QUERY, 0.0);
    }
    // What has no such care fails, and the sweep shows it.
    assert!(values(chart(&sweep.charts, "lost-vertices"), "f32 Möller-Trumbore").iter().all(|lost| *lost > 1e3));
    assert!(values(chart(&sweep.charts, "self-hits-vertices"), "f32 watertight, t_min")[2] > 1e3);
}

#[test]
fn the_scale_of_a_scene_changes_nothing() {
    let sweep = scale::sweep(&bench(), &[1e-8, 1e-4, 1.0, 1e4, 1e8], 5_000).expect("the sweep runs");
    for method in [REFERENCE, COMPUTE_BVH] {
        assert_most(chart(&sweep.charts, "lost"), method, 0.0);
        assert_most(chart(&sweep.charts, "self-hits"), method, 0.0);
        assert_most(chart(&sweep.charts, "escapes"), method, 500.0);
        assert_most(chart(&sweep.charts, "picture"), method, 1e-4);
    }
    assert!(values(chart(&sweep.charts, "escapes"), "f32 watertight, t_min 1e-4")[0] > 9e5);
}

#[test]
fn grazing_rays_at_edges_and_vertices_are_not_lost() {
    let sweep = edges::sweep(&bench(), &[1e-4, 1e-2, 1.0, 90.0], 10_000).expect("the sweep runs");
    for placed in ["aligned", "turned"] {
        let lost = chart(&sweep.charts, &format!("lost-{placed}"));
        assert_most(lost, COMPUTE_BVH, 0.0);
        assert!(values(lost, "f32 Möller-Trumbore")[1] > 1e4);
    }
}

#[test]
fn slivers_are_met_where_they_are_and_not_met_again() {
    let sweep = slivers::sweep(&bench(), &[1.0, 1e4, 1e6], 10_000).expect("the sweep runs");
    for placed in ["level", "turned"] {
        for quantity in ["lost", "wrong", "self-hits"] {
            assert_most(chart(&sweep.charts, &format!("{quantity}-{placed}")), COMPUTE_BVH, 0.0);
        }
        let by_areas = values(chart(&sweep.charts, &format!("wrong-{placed}")), "f32 watertight");
        assert!(by_areas[2] > 1e4, "distances by areas: {by_areas:?}");
    }
}

#[test]
fn light_does_not_pass_walls_that_are_close_together() {
    let sweep = gaps::sweep(&bench(), &[1e-5, 1e-4, 1e-2], 10_000).expect("the sweep runs");
    for way in ["vertices", "instance"] {
        for quantity in ["leaks", "self-hits", "order"] {
            for method in [COMPUTE_BVH, RAY_QUERY] {
                assert_most(chart(&sweep.charts, &format!("{quantity}-{way}")), method, 0.0);
            }
        }
    }
    assert!(values(chart(&sweep.charts, "leaks-vertices"), "f32 watertight, t_min")[0] > 9e5);
}

#[test]
fn flattened_instances_stay_closed() {
    let sweep = instances::sweep(&bench(), &[1.0, 100.0, 1000.0], 10_000).expect("the sweep runs");
    for kind in ["stretched", "mirrored", "sheared"] {
        assert_most(chart(&sweep.charts, &format!("lost-{kind}")), COMPUTE_BVH, 0.0);
        let escapes = chart(&sweep.charts, &format!("escapes-{kind}"));
        for method in [COMPUTE_BVH, RAY_QUERY] {
            assert_most(chart(&sweep.charts, &format!("self-hits-{kind}")), method, 0.0);
            // Along the rim the body is thinner than the rounding.
            assert_most(escapes, method, 2e4);
        }
        assert!(values(escapes, "bound by coordinates")[2] > 1e5);
    }
}

#[test]
fn glass_of_any_index_keeps_the_energy() {
    let sweep = eta::sweep(&bench(), &[1.0001, 1.5, 4.0], 20_000, 4).expect("the sweep runs");
    for method in [REFERENCE, COMPUTE_BVH, RAY_QUERY] {
        assert_most(chart(&sweep.charts, "furnace"), method, 1e-5);
    }
    let reflectance = chart(&sweep.charts, "reflectance");
    assert_most(reflectance, COMPUTE_BVH, 1e-3);
    let by_sine = reflectance.series.iter().find(|series| series.name == "f32 by the sine, from inside");
    assert!(by_sine.is_none_or(|series| series.points[0].y > 1e-2));
}

#[test]
fn bodies_of_glass_near_each_other_keep_the_energy() {
    let sweep = touching_glass::sweep(&bench(), &[1e-5, 1e-3], 4).expect("the sweep runs");
    for name in ["side-by-side", "nested"] {
        for method in [REFERENCE, COMPUTE_BVH, RAY_QUERY] {
            // A path or two of 4096 may be cut off after 1000 bounces.
            assert_most(chart(&sweep.charts, name), method, 6e-4);
        }
    }
}

/// The models find what the reference finds, where nothing is hard.
#[test]
fn models_agree_with_the_reference() {
    let mut scene = empty(1, 1);
    let map = Affine3A::from_rotation_x(0.3) * Affine3A::from_scale(Vec3::new(1.0, 0.5, 2.0));
    add(&mut scene, icosphere(2), matte(Vec3::ZERO), map);
    let mut random = Random::new(1);
    let rays: Vec<Ray> = (0..20_000).map(|_| Ray::through(random.in_cube() * 3.0, random.in_cube())).collect();
    let expected = reference_hits(&Reference::new(&scene), &rays);
    let met = expected.iter().flatten().count();
    assert!((5_000..19_000).contains(&met), "{met}");
    for test in [Test::MoellerTrumbore { epsilon: 0.0 }, Test::Watertight] {
        for padded in [false, true] {
            let found = Triangles::new(&scene, test, padded).hits(&rays, 0.0);
            let differ = found.iter().zip(&expected).filter(|(f, e)| match (f, e) {
                (Some(f), Some(e)) => (f.t - e.t).abs() > 1e-5,
                (f, e) => f.is_some() != e.is_some(),
            });
            let count = differ.count();
            assert!(count <= 2, "{test:?}, padded {padded}: {count} of {} rays differ", rays.len());
        }
    }
}
