//! A base under a smooth dielectric: plastic, varnish. Every mean has the significance 1e-4.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::{means, preset};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::impulse::fresnel;
use luminaire::reference::surfel::Surfel;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::*;

fn coated(eta: f64, reflection: f64, base: Surfel) -> Surfel {
    let coat_transmittance = coat_transmittance(eta);
    Surfel { reflection: DVec3::splat(reflection), eta: Some(eta), coat_transmittance, ..base }
}

/// Lambert's lobe scatters `1 - F` of its albedo at every angle, and the mirror F: a white base under a clear coat is white. So it is under a
/// coat that reflects half of F, and under one of an index below 1, where beyond the critical angle all is reflected.
#[test]
fn the_base_scatters_what_the_coat_does_not_reflect() {
    let white = flat_surfel(DVec3::ONE, DVec3::ZERO, 0.0);
    for (eta, reflection, front) in [
        (1.5, 1.0, true),
        (1.5, 1.0, false),
        (1.5, 0.5, true),
        (2.4, 0.75, true),
        (1.0 / 1.5, 1.0, true),
        (1.0 / 1.5, 1.0, false),
        (1.001, 1.0, true),
    ] {
        // What transmits nothing is not seen from inside, from behind either.
        let surfel = Surfel { front, ..coated(eta, reflection, white) };
        for degrees in [0.0, 30.0, 60.0, 80.0, 89.0] {
            let wo = tilted(degrees);
            let f = fresnel(eta, wo.z);
            let found = directional_albedo(&surfel, wo);
            let expected = 1.0 - reflection * f;
            // The quadrature sees the edge of the critical cone coarsely.
            let tolerance = if eta < 1.0 { 4e-3 } else { 2e-3 };
            assert!(
                (found - expected).abs() < tolerance,
                "{eta}, {reflection}, {degrees} degrees: {found}, {expected}"
            );
            let impulses = surfel.impulses(wo);
            assert!((impulses.reflection.x - reflection * f).abs() < 1e-12);
            assert_eq!(impulses.transmission, DVec3::ZERO);
        }
    }
    // Glass, and a mirror without the index, lie beside the base.
    for front in [true, false] {
        let base = flat_surfel(DVec3::splat(0.8), DVec3::ZERO, 0.0);
        let glass = Surfel { front, transmission: DVec3::splat(0.2), ..coated(1.5, 0.2, base) };
        assert!((directional_albedo(&glass, tilted(80.0)) - 0.8).abs() < 1e-3);
    }
    let mirror = Surfel { eta: None, ..coated(1.5, 0.2, flat_surfel(DVec3::splat(0.8), DVec3::ZERO, 0.0)) };
    assert!((directional_albedo(&mirror, tilted(80.0)) - 0.8).abs() < 1e-3);
}

/// So it is where the two normals differ: neither takes its share about another normal than the other. Beyond the critical angle, where one of
/// them would transmit, too.
#[test]
fn mirror_and_base_add_up_to_no_more_than_one() {
    for eta in [0.5, 0.7, 1.5] {
        for tilt in [0.0, 15.0, 37.0] {
            let base = flat_surfel(DVec3::ONE, DVec3::ZERO, 0.0);
            let surfel = Surfel { geometric_normal: tilted(tilt), ..coated(eta, 1.0, base) };
            for degrees in [-50.0, -10.0, 20.0, 40.0, 60.0, 85.0] {
                let wo = tilted(degrees);
                let impulses = surfel.impulses(wo);
                assert!(surfel.is_above(wo) && surfel.is_above(impulses.reflected), "{tilt}, {degrees}");
                assert!((impulses.reflection.x - fresnel(eta, wo.z)).abs() < 1e-12);
                let all = directional_albedo(&surfel, wo) + impulses.reflection.x;
                assert!(all <= 1.0 + 4e-3, "{eta}, {tilt} and {degrees} degrees: {all}");
                // How much of the base's hemisphere is below the triangle.
                assert!(all >= 0.5 * (1.0 + tilt.to_radians().cos()) - 0.15, "{eta}, {tilt}, {degrees}: {all}");
            }
        }
    }
}

/// A glossy base keeps `1 - F` of what it scatters at most; a narrow lobe, nearly that.
#[test]
fn a_glossy_base_keeps_no_more_than_enters() {
    for m in EXPONENTS {
        let bare = flat_surfel(DVec3::ZERO, DVec3::ONE, m);
        for degrees in [0.0, 45.0, 80.0] {
            let wo = tilted(degrees);
            let (f, alone) = (fresnel(1.5, wo.z), directional_albedo(&bare, wo));
            let found = directional_albedo(&coated(1.5, 1.0, bare), wo);
            assert!(found <= alone * (1.0 - f) + 1e-9, "m = {m}, {degrees} degrees: {found}");
            // A narrow lobe is nearly all at one angle.
            if m > 900.0 {
                assert!(found >= 0.94 * alone * (1.0 - f), "m = {m}, {degrees} degrees: {found} of {alone}");
            }
        }
    }
}

/// Light may go either way, with two normals and a tint too.
#[test]
fn coats_are_reciprocal() {
    let base = flat_surfel(DVec3::new(0.8, 0.5, 0.2), DVec3::splat(0.2), 20.0);
    let mut compared = 0;
    for i in 0..4000 {
        let [a, b, c, d] = random4(i, 0, 0, 33).map(uniform);
        let surfel = Surfel {
            reflection: DVec3::new(1.0, 0.5, 0.1),
            shading_normal: tilted(20.0 * f64::from(i % 2)),
            front: i % 5 < 2,
            ..coated([1.5, 0.7, 2.4][i as usize % 3], 1.0, base)
        };
        let direction = |u, v| luminaire::reference::warp::uniform_hemisphere(DVec3::Z, u, v);
        let (wo, wi) = (direction(a, b), direction(c, d));
        if surfel.is_above(wo) && surfel.is_above(wi) {
            let (there, back) = (surfel.bsdf(wo, wi), surfel.bsdf(wi, wo));
            assert!((there - back).length() <= 1e-12 * there.length(), "{wo} {wi}: {there} {back}");
            compared += 1;
        }
    }
    assert!(compared > 3000);
}

/// Plastic in a uniform environment: `F + (1 - F) Kd` at the angle at which it is seen, from either side, whatever the estimator.
#[test]
fn plastic_in_a_uniform_environment() {
    let plastic = Material { reflection: Vec3::ONE, eta: Some(1.5), ..matte(Vec3::new(0.8, 0.25, 1.0)) };
    let throughput = Estimator { extinction: Extinction::Throughput, ..Estimator::default() };
    let direct = Estimator { light_sampling: LightSampling::Direct, extinction: Extinction::Surface, ..throughput };
    for (degrees, integrator) in [
        (0.0f64, Integrator::Path(throughput)),
        (50.0, preset("cosine")),
        (75.0, Integrator::Path(direct)),
        (110.0, preset("no-light-sampling")),
        (150.0, Integrator::Path(throughput)),
    ] {
        let mut scene = empty(4, 4);
        scene.integrator = integrator;
        let (sin, cos) = degrees.to_radians().sin_cos();
        scene.sensor = pinhole(Vec3::new(sin as f32, 0.0, cos as f32) * 4.0, Vec3::ZERO, Vec3::Y, 1e-3);
        let sheet = quad(Vec3::new(-9.0, -9.0, 0.0), Vec3::X * 18.0, Vec3::Y * 18.0);
        add(&mut scene, sheet, plastic.clone(), Affine3A::IDENTITY);
        scene.environment = Some(Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 });
        let f = fresnel(1.5, cos.abs());
        for (found, albedo) in means(&scene, 4000).into_iter().zip([f64::from(0.8f32), 0.25, 1.0]) {
            found.assert_is(f + (1.0 - f) * albedo, 1e-2);
        }
    }
}
