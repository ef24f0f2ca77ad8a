//! Mirrors and glass. Every mean has the significance 1e-4.

use crate::common::scenes::*;
use crate::common::statistics::*;
use crate::transport::{means, preset};
use glam::{Affine3A, DVec3, Vec3};
use luminaire::reference::Reference;
use luminaire::reference::impulse::{fresnel, reflect, refract};
use luminaire::reference::scatter::scatter;
use luminaire::reference::surfel::Surfel;
use luminaire::sampling::{random4, uniform};
use luminaire::scene::*;

const ETAS: [f64; 5] = [1.0 / 2.4, 0.75, 1.0, 1.5, 2.4];

fn glass(eta: f32) -> Material {
    Material { reflection: Vec3::ONE, transmission: Vec3::ONE, eta: Some(eta), ..matte(Vec3::ZERO) }
}

fn white() -> Environment {
    Environment { radiance: Vec3::ONE, image: None, rotation: 0.0 }
}

#[test]
fn fresnel_at_known_angles() {
    for eta in ETAS {
        let normal = ((eta - 1.0) / (eta + 1.0)).powi(2);
        assert!((fresnel(eta, 1.0) - normal).abs() < 1e-15);
        // Brewster: tan = eta; of the parallel part nothing is left, of the other ((eta^2 - 1) / (eta^2 + 1))^2.
        let brewster = 0.5 * ((eta * eta - 1.0) / (eta * eta + 1.0)).powi(2);
        assert!((fresnel(eta, eta.atan().cos()) - brewster).abs() < 1e-14);
        let grazing = fresnel(eta, 1e-9);
        assert!(if eta == 1.0 { (0.0..=1.0).contains(&grazing) } else { grazing > 1.0 - 1e-7 });
        if eta < 1.0 {
            let critical = eta.asin();
            assert_eq!(fresnel(eta, (critical + 1e-9).cos()), 1.0);
            assert!(fresnel(eta, (critical - 1e-4).cos()) < 1.0);
        }
    }
    // Window glass at 60 degrees: Hecht, "Optics", from the equations: 0.0892.
    assert!((fresnel(1.5, 0.5) - 0.0892).abs() < 5e-5);
}

/// Reflectance is the same from both sides of the refracted ray, between 0 and 1, and what does not go on is reflected.
#[test]
fn fresnel_is_symmetric_and_conserves_energy() {
    for eta in ETAS {
        for i in 1..1000 {
            let cos = f64::from(i) / 1000.0;
            let sin = (1.0 - cos * cos).sqrt();
            let wo = DVec3::new(sin, 0.0, cos);
            let f = fresnel(eta, cos);
            assert!((0.0..=1.0).contains(&f));
            let Some(wi) = refract(wo, DVec3::Z, eta) else {
                assert!(sin >= eta && f == 1.0);
                continue;
            };
            assert!((wi.length() - 1.0).abs() < 1e-14 && wi.z < 0.0);
            assert!((sin + eta * wi.x).abs() < 1e-14, "Snell's law, in the plane of incidence");
            // The smaller cosine has lost digits.
            let there = fresnel(1.0 / eta, -wi.z);
            assert!((f - there).abs() < 1e-14 / cos.min(-wi.z), "{f} and {there} at cos = {cos}, eta = {eta}");
            let back = refract(wi, -DVec3::Z, 1.0 / eta).expect("light goes either way");
            assert!((back - wo).length() < 1e-7);
            assert!((reflect(wo, DVec3::Z) - DVec3::new(-sin, 0.0, cos)).length() < 1e-15);
        }
    }
}

/// Any closed body of glass in a uniform environment is invisible, flat or smooth, upright or mirrored, thick or thin, whatever the
/// estimator: what reflection takes, transmission gives, and the factors of `eta^2` cancel.
#[test]
fn glass_is_invisible_in_a_uniform_environment() {
    // With normals that are not the body's own, some rays are caught for thousands of reflections: one such body, of an index where they
    // are rare.
    let mut smooth = icosphere(2);
    smooth.normals = smooth.positions.clone();
    let place = Affine3A::from_translation(-Vec3::Z * 3.0);
    let mirrored = place * Affine3A::from_scale(Vec3::new(-1.0, 0.75, 1.0));
    let throughput = Estimator { extinction: Extinction::Throughput, ..Estimator::default() };
    let variants = [
        (Estimator::default(), icosphere(1), place, 1.5),
        (throughput, icosphere(1), mirrored, 2.4),
        (throughput, smooth, mirrored, 1.5),
        (throughput, cube(), place * Affine3A::from_rotation_y(0.5), 0.7),
        (
            Estimator { light_sampling: LightSampling::Direct, extinction: Extinction::Surface, ..throughput },
            icosphere(2),
            place,
            1.3,
        ),
        (Estimator { light_sampling: LightSampling::None, ..throughput }, cube(), mirrored, 1.5),
    ];
    for (index, (estimator, body, place, eta)) in variants.into_iter().enumerate() {
        let mut scene = empty(8, 8);
        scene.sensor = pinhole(Vec3::ZERO, -Vec3::Z, Vec3::Y, 30.0);
        add(&mut scene, body, glass(eta), place);
        scene.environment = Some(white());
        scene.integrator = Integrator::Path(estimator);
        for mean in means(&scene, 600) {
            assert!((mean.mean - 1.0).abs() < 0.01, "variant {index}: {mean:?}");
            mean.assert_is(1.0, 1e-3);
        }
    }
}

/// Inside is where the corners run clockwise, in a mirrored instance too; vertex normals outvote the winding.
#[test]
fn the_outward_side() {
    let mut inverted = cube();
    inverted.normals = inverted.positions.iter().map(|p| -p.normalize()).collect();
    for (body, outward) in [(cube(), true), (inverted, false)] {
        for place in [Affine3A::IDENTITY, Affine3A::from_scale(Vec3::new(-1.0, 2.0, 1.0))] {
            let mut scene = empty(1, 1);
            add(&mut scene, body.clone(), matte(Vec3::ONE), place);
            let tracer = Reference::new(&scene);
            let target = DVec3::new(0.2, 0.3, 0.25);
            for axis in DVec3::AXES.into_iter().flat_map(|a| [a, -a]) {
                for from in [target + 5.0 * axis, target] {
                    let direction = if from == target { axis } else { -axis };
                    let hit = tracer.closest_hit(from, direction, f64::INFINITY, 0).expect("a hit");
                    assert_eq!(tracer.surfel(&hit, -direction).front, (from != target) == outward);
                }
            }
        }
    }
}

/// A mirrored glass body under a varied sky gives the picture of the body that has the mirrored shape, sample by sample.
#[test]
fn mirrored_glass_is_glass() {
    let mut body = cube();
    for p in &mut body.positions {
        *p += Vec3::new(0.25 * p.y, 0.0, 0.5 * p.x);
    }
    let mut reflected = body.clone();
    for p in &mut reflected.positions {
        p.x = -p.x;
    }
    for triangle in &mut reflected.triangles {
        triangle.vertices.swap(1, 2);
    }
    let texels = (0..8).map(|i| Vec3::new(i as f32, (i % 3) as f32, 1.0)).collect();
    let image = EnvironmentImage { name: "sky".into(), width: 4, height: 2, texels };
    let scene = |body: Mesh, place: Affine3A| {
        let mut scene = empty(16, 16);
        add(&mut scene, body, glass(1.5), Affine3A::from_translation(-Vec3::Z * 5.0) * place);
        scene.environment = Some(Environment { image: Some(image.clone().into()), ..white() });
        Reference::new(&scene)
    };
    let a = scene(body, Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
    let b = scene(reflected, Affine3A::IDENTITY);
    let (mut different, mut bent) = (0, 0);
    for i in 0..256 * 16 {
        let ((left, rays), (right, _)) = (a.radiance(i % 256, i / 256), b.radiance(i % 256, i / 256));
        different += u32::from((left - right).length() > 1e-9 * left.length());
        bent += u32::from(rays.all > 2);
    }
    // A ray through an edge may go either way.
    assert!(different <= 2 && bent > 500, "{different} different of {bent}");
}

/// A ray leaves a plane-parallel plate of thickness `d` in its old direction, displaced by `d sin t (1 - cos t / (eta cos t'))`.
#[test]
fn a_plate_displaces_rays() {
    for eta in [1.5f32, 0.9] {
        let mut scene = empty(1, 1);
        add(&mut scene, cube(), glass(eta), Affine3A::from_scale(Vec3::new(50.0, 50.0, 0.5)));
        let tracer = Reference::new(&scene);
        let eta = f64::from(eta);
        for degrees in [0.0f64, 20.0, 55.0, 60.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (start, old) = (DVec3::new(0.3, 0.2, 3.0), DVec3::new(sin, 0.0, -cos));
            let (mut origin, mut direction) = (start, old);
            let mut eta2 = 1.0;
            for _ in 0..2 {
                let hit = tracer.closest_hit(origin, direction, f64::INFINITY, 0).expect("the plate");
                let surfel = tracer.surfel(&hit, -direction);
                let impulses = surfel.impulses(-direction);
                direction = impulses.transmitted;
                origin = surfel.offset_ray_origin(direction);
                eta2 *= impulses.eta * impulses.eta;
            }
            assert!((direction - old).length() < 1e-12 && (eta2 - 1.0).abs() < 1e-12);
            let inside = (1.0 - sin * sin / (eta * eta)).sqrt();
            let expected = sin * (1.0 - cos / (eta * inside));
            // Towards the normal: to the left of a ray that goes right and down.
            let found = (origin - start).dot(DVec3::new(-cos, 0.0, -sin));
            assert!((found - expected).abs() < 1e-9, "{found} instead of {expected}");
        }
    }
}

/// 60 % mirror, 40 % Lambert (slide "Impulse Reflection"): that is how the energy goes, whatever the probability of the choice, and a
/// uniform environment sees a white surface.
#[test]
fn sixty_forty() {
    let wo = DVec3::new(0.6, 0.0, 0.8);
    for (index, probability) in [None, Some(0.1), Some(0.6), Some(0.95)].into_iter().enumerate() {
        let surfel = Surfel {
            reflection: DVec3::splat(0.6),
            impulse_probability: probability,
            ..flat_surfel(DVec3::splat(0.4), DVec3::ZERO, 0.0)
        };
        let weights = |impulse: bool| {
            Estimate::new((0..100_000).map(|i| {
                let [u, v, lobe, _] = random4(i, 0, index as u32, 9).map(uniform);
                let scattered = scatter(&surfel, wo, Directions::Bsdf, [u, v, lobe]);
                assert!(scattered.pdf.is_some() || scattered.wi == DVec3::new(-0.6, 0.0, 0.8));
                if scattered.pdf.is_none() == impulse { scattered.weight.x } else { 0.0 }
            }))
        };
        weights(true).assert_is(0.6, 2e-2);
        weights(false).assert_is(0.4, 2e-2);

        let mut scene = empty(8, 8);
        let material = Material {
            reflection: Vec3::splat(0.6),
            impulse_probability: probability.map(|p| p as f32),
            ..matte(Vec3::splat(0.4))
        };
        add(
            &mut scene,
            quad(Vec3::new(-9.0, -9.0, -2.0), Vec3::X * 18.0, Vec3::Y * 18.0),
            material,
            Affine3A::IDENTITY,
        );
        scene.environment = Some(white());
        // In f32; without direct light no sample differs from it.
        let all = f64::from(0.6f32) + f64::from(0.4f32);
        for integrator in [Integrator::Path(Estimator::default()), preset("cosine"), preset("no-light-sampling")] {
            scene.integrator = integrator;
            means(&scene, 1000)[1].assert_within(all - 1e-9, all + 1e-9, 1.5e-2);
            // Direct light and what the mirror shows are there without any bounce too.
            estimator(&mut scene).max_bounces = Some(0);
            means(&scene, 1000)[1].assert_within(all - 1e-9, all + 1e-9, 1.5e-2);
        }
    }
}

/// Where the shading normal would send light through the triangle, the geometric normal takes over, for both impulses.
#[test]
fn impulses_stay_on_their_side() {
    let mut gave_way = 0;
    for i in 0..2000 {
        let [a, b, c, d] = random4(i, 0, 0, 21).map(uniform);
        let n = luminaire::reference::warp::uniform_hemisphere(DVec3::Z, 0.7 * a, b);
        let wo = luminaire::reference::warp::uniform_hemisphere(DVec3::Z, c, d);
        if wo.dot(n) <= 0.0 {
            continue;
        }
        let surfel = Surfel {
            shading_normal: n,
            reflection: DVec3::ONE,
            transmission: DVec3::ONE,
            eta: Some(1.5),
            front: i % 2 == 0,
            ..flat_surfel(DVec3::ZERO, DVec3::ZERO, 0.0)
        };
        let impulses = surfel.impulses(wo);
        assert!(impulses.reflected.z > 0.0 && impulses.transmitted.z <= 0.0);
        assert_eq!(impulses.eta, if i % 2 == 0 { 1.5 } else { 1.0 / 1.5 });
        assert!((impulses.reflection + impulses.transmission - DVec3::ONE).length() < 1e-15);
        gave_way += u32::from((impulses.reflected - reflect(wo, DVec3::Z)).length() < 1e-12);
    }
    assert!((50..1900).contains(&gave_way), "{gave_way}");
}

/// A sheet between two parallel surfaces: the sum over all that goes to and fro, from either side, straight through.
#[test]
fn a_thin_sheet_is_two_surfaces() {
    for eta in [1.0 / 1.5, 1.0, 1.33, 1.5, 2.4] {
        for cos in [1.0, 0.9, 0.5, 0.2] {
            let f = fresnel(eta, cos);
            let (mut reflected, mut inside) = (f, 1.0 - f);
            for _ in 0..4000 {
                reflected += inside * f * (1.0 - f);
                inside *= f * f;
            }
            let wo = DVec3::new((1.0f64 - cos * cos).sqrt(), 0.0, cos);
            for front in [true, false] {
                let tint = DVec3::new(1.0, 0.5, 0.25);
                let sheet = Surfel {
                    reflection: DVec3::ONE,
                    transmission: tint,
                    eta: Some(eta),
                    thin: true,
                    front,
                    ..flat_surfel(DVec3::ZERO, DVec3::ZERO, 0.0)
                };
                let found = sheet.impulses(wo);
                assert!((found.reflection - DVec3::splat(reflected)).abs().max_element() < 1e-12, "{eta} {cos}");
                assert!((found.transmission - tint * (1.0 - reflected)).abs().max_element() < 1e-12);
                assert_eq!((found.transmitted, found.eta), (-wo, 1.0));
            }
        }
    }
    // 0.04 at normal incidence: 0.0769 back, 0.9231 through.
    assert!((luminaire::reference::impulse::thin_reflectance(0.04) - 0.08 / 1.04).abs() < 1e-15);
}
