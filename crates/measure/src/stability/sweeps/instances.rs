//! Instances that are stretched, mirrored and sheared.

use crate::Workbench;
use crate::chart::{Axis, Chart, Point};
use crate::random::Random;
use crate::rays::Ray;
use crate::stability::geometry::{
    COMPUTE_BVH, RAY_QUERY, Stand, add, chart, decades, distance_error, lost, named, per_million, placed,
    rays_to_faces, rays_to_features, value,
};
use crate::stability::judge::{geometric, up_to};
use crate::stability::sweep::{Definition, Family, Findings, Sweep};
use crate::stability::verdict::{Worse, stretch};
use glam::{Affine3A, DAffine3, DMat3, Mat3, Vec3};
use luminaire::Result;
use luminaire::reference::Reference;
use luminaire::scene::Scene;
use luminaire::scene::build::icosphere;
use rayon::prelude::*;

/// The sweep.
pub const DEFINITION: Definition = Definition {
    name: "instances",
    family: Family::Geometry,
    title: "Instances stretched, mirrored and sheared by 1 to 1e6",
    run,
};

/// A way to leave surfaces that is not the kernel's.
const BY_COORDINATES: &str = "bound by coordinates";

fn run(bench: &Workbench) -> Result<Sweep> {
    sweep(bench, &decades(0, 6, bench), 30_000)
}

/// A unit ball flattened by some factor, turned before and after.
fn map(kind: &str, factor: f64) -> Affine3A {
    let before = Affine3A::from_rotation_y(0.4) * Affine3A::from_rotation_z(0.9);
    let after = Affine3A::from_translation(Vec3::new(1.6, -1.0, 0.6))
        * Affine3A::from_rotation_x(0.3)
        * Affine3A::from_rotation_z(0.7);
    let factor = factor as f32;
    let shape = match kind {
        "mirrored" => Affine3A::from_scale(Vec3::new(-1.0, 1.0 / factor, 1.0)),
        // A shear by k stretches by about k and 1 / k: the same anisotropy as that of 1 : k^2.
        "sheared" => {
            let k = factor.sqrt();
            Affine3A::from_mat3(Mat3::from_cols(Vec3::X, Vec3::new(k, 1.0, 0.0), Vec3::Z) * (1.0 / k))
        }
        _ => Affine3A::from_scale(Vec3::new(1.0, 1.0 / factor, 1.0)),
    };
    after * shape * before
}

/// The sweep over some anisotropies (longest over shortest axis) with so many rays each.
///
/// # Errors
/// If a driver fails.
pub fn sweep(bench: &Workbench, factors: &[f64], rays: usize) -> Result<Sweep> {
    let x = || Axis::log("longest over shortest axis");
    let million = "rays a million";
    let mut charts = Vec::new();
    for kind in ["stretched", "mirrored", "sheared"] {
        let mut lost_chart = chart(&format!("lost-{kind}"), &format!("Rays lost by a {kind} ball"), x(), million);
        let title = format!("99.9th percentile of the hits' error along the ray in a {kind} ball");
        let mut error = chart(&format!("error-{kind}"), &title, x(), "error in radii of the ball");
        let title = format!("Rays that meet the triangle of a {kind} ball that they leave");
        let mut self_hits = chart(&format!("self-hits-{kind}"), &title, x(), million);
        let title = format!("Rays that leave a face inwards and get out of a {kind} ball");
        let mut escapes = chart(&format!("escapes-{kind}"), &title, x(), million);
        for &factor in factors {
            let map = map(kind, factor);
            let scene = placed(icosphere(3), map);
            let mut random = Random::new(27);
            let inner = map * Affine3A::from_scale(Vec3::splat(0.4));
            let rays = rays_to_features(&scene, inner, rays, &mut random);
            let stand = Stand::new(bench, &scene)?;
            let hits = stand.hits(&rays, true)?;
            for (name, found) in &hits {
                add(&mut lost_chart, name, per_million(factor, lost(found), rays.len()));
            }
            for (name, found) in &hits[1..] {
                let y = distance_error(found, &hits[0].1);
                add(&mut error, name, Point { x: factor, y, error: None });
            }
            let inwards = rays_to_faces(&scene, inner, rays.len(), &mut random);
            let before = escapes_by_coordinates(&scene, &inwards);
            for departures in stand.leaves(&inwards, &[])? {
                let [same, out] = departures.self_hits_and_escapes();
                add(&mut self_hits, departures.name, per_million(factor, same, rays.len()));
                add(&mut escapes, departures.name, per_million(factor, out, rays.len()));
            }
            add(&mut escapes, BY_COORDINATES, per_million(factor, before, rays.len()));
        }
        charts.extend([lost_chart, error, self_hits, escapes]);
    }
    let (errors, counts): (Vec<&Chart>, Vec<_>) = charts.iter().partition(|chart| chart.name.starts_with("error"));
    let verdicts = geometric(&counts, &errors, Worse::Upwards);
    let range = stretch(factors.iter().copied(), Worse::Upwards, ": 1");
    let summary = up_to(&verdicts, COMPUTE_BVH, |end| {
        format!("Flatten a body by more than {end} in its mesh, not by its instance: its rim leaks light.")
    });
    let findings = findings(&charts);
    Ok(Sweep { charts, range, verdicts, summary, findings })
}

/// Rays that leave a face inwards and get out if they start beyond a bound of their rounding in each coordinate, carried through the transform and back by
/// absolute values (as in Pharr, Jakob and Humphreys, "Physically Based Rendering", section 6.8): single-precision bounds, all else in double precision.
fn escapes_by_coordinates(scene: &Scene, rays: &[Ray]) -> usize {
    let reference = Reference::new(scene);
    let unit = 0.5 * f64::from(f32::EPSILON);
    let to_world = DAffine3 {
        matrix3: scene.objects[0].object_to_world.matrix3.as_dmat3(),
        translation: scene.objects[0].object_to_world.translation.as_dvec3(),
    };
    let to_object = to_world.inverse();
    let absolute = |m: DMat3| DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    let escapes = |ray: &&Ray| {
        let direction = ray.direction.as_dvec3().normalize();
        let Some(hit) = reference.closest_hit(ray.origin.as_dvec3(), direction, f64::INFINITY, 0) else { return false };
        let surfel = reference.surfel(&hit, -direction);
        let position = surfel.position;
        let local = to_object.transform_point3(position).abs();
        let back = absolute(to_object.matrix3) * position.abs() + to_object.translation.abs();
        let forth = absolute(to_world.matrix3) * local + to_world.translation.abs();
        let error = absolute(to_world.matrix3) * (7.0 * unit * local + 4.0 * unit * back) + 4.0 * unit * forth;
        let normal = surfel.geometric_normal;
        let wi = direction - 2.0 * direction.dot(normal) * normal;
        let origin = position + normal * normal.abs().dot(error);
        reference.closest_hit(origin, wi, f64::INFINITY, 0).is_none()
    };
    rays.par_iter().filter(escapes).count()
}

fn findings(charts: &[Chart]) -> Findings {
    let escapes = |method: &str, x: f64| value(named(charts, "escapes-stretched"), method, x);
    let errors = named(charts, "error-stretched");
    Findings {
        starts: format!(
            "Error along the ray, compute BVH: {} at 1 : 100, {} at 1 : 1e4. The first failures:",
            value(errors, COMPUTE_BVH, 100.0),
            value(errors, COMPUTE_BVH, 1e4)
        ),
        how: format!(
            "A ray is taken into the object's space, where the short axis is long: its rounding is multiplied by the anisotropy. No ray is lost by \
             that, because all triangles see the same ray. Where a ray leaves, its rounding has to be bounded; bounds of the single coordinates, carried \
             through the transform and back by absolute values, multiply by the anisotropy once more, and are soon thicker than the body ({} a million get \
             out at 1 : 1000). Mirrored and sheared bodies do as stretched ones.",
            escapes(BY_COORDINATES, 1e3)
        ),
        mends: format!(
            "Only the bound across the surface counts, and it is taken from space to space by the length of the transformed normal, so that it does not grow with the body's \
             breadth ({} a million at 1 : 1000, aimed at all its triangles evenly, also those of the rim). The compute BVH takes rays into the object's space relative to the \
             object's origin.",
            escapes(COMPUTE_BVH, 1e3)
        ),
        sees: format!(
            "Light leaks along the rim of a flattened body, where it is thinner than the rounding: {} of a million rays that leave its triangles get out at 1 : 100, {} at \
             1 : 1000, {} at 1 : 1e4 (the ray query: {}). Flatten the mesh itself instead of the instance.",
            escapes(COMPUTE_BVH, 100.0),
            escapes(COMPUTE_BVH, 1e3),
            escapes(COMPUTE_BVH, 1e4),
            escapes(RAY_QUERY, 1e4)
        ),
    }
}
