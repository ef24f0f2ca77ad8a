//! Layers of metallic-roughness surfaces at their limits: coats, glass that hardly bends, indices above 3.73, metals of extreme indices.

use crate::common::directions::*;
use crate::common::scenes::*;
use crate::physical::{albedo_of, evenly};
use glam::{DVec3, Vec3};
use luminaire::reference::fresnel::fresnel_conductor;
use luminaire::reference::physical::{Lobes, PhysicalSurface};
use luminaire::reference::surfel::Surfel;
use luminaire::reference::warp::cosine_hemisphere;
use luminaire::scene::*;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Glass that is rough, but hardly bends the light: near the critical angle, too, what goes straight on and what microfacets reflect add up to all.
#[test]
fn hardly_bent_rough_glass_loses_and_makes_nothing() {
    for (roughness, ior) in [(0.012, 1.5f32), (0.014, 1.5), (0.03, 1.05), (0.5, 1.0003)] {
        let p = Physical { transmission: 1.0, roughness, ior, ..Physical::default() };
        let critical = (1.0 - 1.0 / f64::from(ior * ior)).sqrt();
        for front in [true, false] {
            let surfel = physical_surfel(&p, false, front);
            for cosine in
                [-0.03, -0.001, 0.001, 0.005, 0.03, 0.1].map(|by| critical + by).into_iter().chain([0.02, 1.0])
            {
                if !(0.01..=1.0).contains(&cosine) {
                    continue;
                }
                let albedo = albedo_of(&surfel, tilted(cosine.acos().to_degrees()), 2_000).x;
                assert!((albedo - 1.0).abs() < 5e-3, "{roughness} {ior} front {front} at {cosine}: {albedo}");
            }
        }
    }
}

/// The share of the light from one direction that is sent out in all: over even points, by the cosine.
fn sent_out(surfel: &Surfel, wi: DVec3) -> f64 {
    let n = 20_000;
    let one = |i| {
        let [u, v, _] = evenly(i);
        let wo = cosine_hemisphere(DVec3::Z, u, v);
        viewed_from(surfel, wo).bsdf(wo, wi).x * PI
    };
    (0..n).map(one).sum::<f64>() / f64::from(n)
}

/// A coat takes its share of the light that arrives, too: what is lit at grazing sends out no more than the rest.
#[test]
fn coats_take_their_share_of_what_arrives() {
    for (metallic, roughness) in [(0.0, 1.0), (1.0, 1.0), (1.0, 0.6)] {
        let coated = Physical {
            clearcoat: 1.0,
            clearcoat_roughness: 0.0,
            specular: 0.0,
            metallic,
            roughness,
            ..Physical::default()
        };
        let surfel = physical_surfel(&coated, false, true);
        for degrees in [30.0, 60.0, 75.0, 85.0] {
            let wi = tilted(degrees);
            let [coat, _] = viewed_from(&surfel, wi).lobes.expect("a surface").impulses();
            let all = coat.x + sent_out(&surfel, wi);
            // Of a rough metal the lesser of two shares comes back, never more.
            assert!((0.93..1.005).contains(&all), "metallic {metallic}, roughness {roughness}, {degrees}: {all}");
            if metallic == 0.0 {
                assert!((all - 1.0).abs() < 5e-3, "matt at {degrees}: {all}");
            }
        }
    }
    // The lecture's varnish is the same thing: a smooth coat over a matt body.
    let body = Vec3::splat(0.8);
    let coated =
        Physical { clearcoat: 1.0, clearcoat_roughness: 0.0, specular: 0.0, base_color: body, ..Physical::default() };
    let varnished = Surfel {
        reflection: DVec3::ONE,
        eta: Some(1.5),
        coat_transmittance: coat_transmittance(1.5),
        ..flat_surfel(body.as_dvec3(), DVec3::ZERO, 0.0)
    };
    let coated = physical_surfel(&coated, false, true);
    for (out, into) in [(5.0, 85.0), (60.0, 80.0), (80.0, 20.0)] {
        let (a, b) = (
            viewed_from(&coated, tilted(out)).bsdf(tilted(out), tilted(into)).x,
            varnished.bsdf(tilted(out), tilted(into)).x,
        );
        assert!((a / b - 1.0).abs() < 2e-3, "{out} {into}: {a} {b}");
    }
}

/// A dielectric below a coat is white in white light at any angle, but for what is common to both layers, which is bounded.
#[test]
fn white_plastic_below_a_coat_is_white() {
    let cases: Vec<_> = [0.0, 0.3, 1.0]
        .into_iter()
        .flat_map(|roughness| [0.0, 0.4, 1.0].map(|coat| (roughness, coat)))
        .flat_map(|(roughness, coat)| [1.2, 1.5, 2.4].map(|ior| (roughness, coat, ior)))
        .collect();
    cases.par_iter().for_each(|&(roughness, clearcoat_roughness, ior)| {
        let p = Physical { clearcoat: 1.0, clearcoat_roughness, roughness, ior, ..Physical::default() };
        for degrees in [0.0, 50.0, 80.0, 88.0] {
            let albedo = albedo_of(&physical_surfel(&p, false, true), tilted(degrees), 6_000).x;
            assert!((0.95..1.005).contains(&albedo), "{roughness} {clearcoat_roughness} {ior} at {degrees}: {albedo}");
        }
    });
}

/// Light of an index above 3.73, of which unpolarised light is reflected less at some angles than straight: no colour is negative, and white is white.
#[test]
fn great_indices_reflect_no_less_than_nothing() {
    for ior in [3.7, 5.0, 10.0, 100.0] {
        for roughness in [0.0, 0.3, 1.0] {
            let specular_color = Vec3::new(1.0, 0.2, 0.0);
            let p = Physical { ior, roughness, specular_color, base_color: Vec3::ZERO, ..Physical::default() };
            let surfel = physical_surfel(&p, false, true);
            for degrees in [0.0, 40.0, 65.0, 75.0, 82.0, 89.0] {
                let wo = tilted(degrees);
                let [mirrored, _] = viewed_from(&surfel, wo).lobes.expect("a surface").impulses();
                assert!(mirrored.min_element() >= 0.0, "{ior} {degrees}: {mirrored}");
                for wi in [5.0, 60.0, 80.0].map(tilted) {
                    let value = viewed_from(&surfel, wo).bsdf(wo, DVec3::new(-wi.x, 0.1, wi.z).normalize());
                    assert!(value.min_element() >= 0.0, "{ior} {roughness} {degrees}: {value}");
                }
                let white = Physical { specular_color: Vec3::ONE, base_color: Vec3::ONE, ..p.clone() };
                let albedo = albedo_of(&physical_surfel(&white, false, true), wo, 6_000).x;
                assert!((albedo - 1.0).abs() < 0.02, "{ior} {roughness} {degrees}: {albedo}");
            }
        }
    }
}

/// A metal may have any index and extinction: its reflectance has a value in the limits, and one channel spoils no other.
#[test]
fn metals_of_extreme_indices_have_a_colour() {
    for cosine in [0.0, 1e-4, 0.3, 1.0] {
        assert_eq!(conductor_reflectance(0.0, 0.0, cosine), 1.0, "no index at all reflects all");
        assert!((conductor_reflectance(0.0, 2.0, cosine) - 1.0).abs() < 1e-12);
    }
    assert_eq!([1e-4, 0.3, 1.0].map(|cosine| conductor_reflectance(1.0, 0.0, cosine)), [0.0; 3], "as the air");
    assert!((conductor_average(0.0, 0.0) - 1.0).abs() < 1e-12 && conductor_average(1.0, 0.0) < 2e-2);
    let metal = [Vec3::new(0.0, 1.0, 0.2), Vec3::new(0.0, 0.0, 3.9)];
    for roughness in [0.0, 0.3, 1.0] {
        let p = Physical { metallic: 1.0, roughness, conductor: Some(metal), ..Physical::default() };
        let albedo = albedo_of(&physical_surfel(&p, false, true), tilted(40.0), 4_000);
        let [eta, k] = metal.map(|v| v.as_dvec3());
        let smooth = fresnel_conductor([eta, k], tilted(40.0).z);
        assert!(
            (albedo - smooth).abs().max_element() < if roughness == 0.0 { 1e-9 } else { 0.08 },
            "{roughness}: {albedo} {smooth}"
        );
    }
}

/// Maps that bend the normal of the surface do not bend that of its coat (`KHR_materials_clearcoat`): it mirrors where it would without them, and is as bright.
#[test]
fn coats_are_not_bent() {
    let bent = DVec3::new(0.5, 0.0, 0.75f64.sqrt());
    for clearcoat_roughness in [0.0, 0.3] {
        let p = Physical {
            clearcoat: 1.0,
            clearcoat_roughness,
            specular: 0.0,
            base_color: Vec3::ZERO,
            ..Physical::default()
        };
        let flat = physical_surfel(&p, false, true);
        let surface = PhysicalSurface { coat_normal: DVec3::Z, ..*flat.physical().expect("a surface") };
        for wo in [tilted(0.0), tilted(20.0), tilted(-10.0)] {
            let flat = viewed_from(&flat, wo);
            let lobes = Some(Lobes::new(&surface, bent, true, wo));
            let mapped = Surfel { shading_normal: bent, lobes, ..flat };
            let (a, b) = (flat.impulses(wo), mapped.impulses(wo));
            assert!((a.reflected - b.reflected).length() < 1e-12 && (a.reflection - b.reflection).length() < 1e-12);
            for i in 0..200 {
                let [u, v, _] = evenly(i);
                let wi = cosine_hemisphere(DVec3::Z, u, v);
                if bent.dot(wi) > 0.0 {
                    let (a, b) = (flat.bsdf(wo, wi).x * wi.z, mapped.bsdf(wo, wi).x * bent.dot(wi));
                    assert!((a - b).abs() <= 1e-9 * a, "{wo} {wi}: {a} {b}");
                }
            }
        }
    }
}
