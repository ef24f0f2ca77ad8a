//! Direct light: next-event estimation.

use super::surfel::{Surfel, interpolate, offset_ray_origin, position_error};
use super::{Reference, warp::uniform_triangle};
use crate::sampling::uniform;
use crate::scene::{EmissiveTriangle, Luminaire, SampledLuminaire};
use glam::DVec3;

/// Where a shadow ray to a point on a surface ends, short of the point: a relative distance far above the error of `t`.
const BEFORE_TARGET: f64 = 1.0 - 1e-9;

/// Light that would arrive from a luminaire if nothing were between.
struct Unoccluded {
    /// Scattered radiance.
    radiance: DVec3,
    /// The shadow ray.
    origin: DVec3,
    direction: DVec3,
    t_max: f64,
}

impl Reference {
    /// Radiance towards `wo` from one luminaire, chosen by number 0 of `random` in proportion to its power and weighted by
    /// one over its probability; numbers 1 and 2 choose the point on it. Adds the shadow ray, if any, to `rays`.
    pub fn direct_light(&self, surfel: &Surfel, wo: DVec3, random: [u32; 4], rays: &mut u32) -> DVec3 {
        if self.luminaires.entries.is_empty() {
            return DVec3::ZERO;
        }
        let chosen = self.luminaires.choice.choose(random[0]);
        let light = match &self.luminaires.entries[chosen] {
            SampledLuminaire::Impulse(luminaire) => from_impulse(surfel, wo, luminaire),
            SampledLuminaire::Environment => return DVec3::ZERO,
            SampledLuminaire::Area(triangle) => {
                let emission = self.scene.materials[triangle.material as usize].emission.as_dvec3();
                from_triangle(surfel, wo, triangle, emission, uniform(random[1]), uniform(random[2]))
            }
        };
        if light.radiance == DVec3::ZERO {
            return DVec3::ZERO;
        }
        *rays += 1;
        if self.occluded(light.origin, light.direction, light.t_max) {
            return DVec3::ZERO;
        }
        light.radiance / self.luminaires.choice.pdf[chosen]
    }
}

/// A luminaire without an area: inverse-square law, or no attenuation at infinity.
fn from_impulse(surfel: &Surfel, wo: DVec3, luminaire: &Luminaire) -> Unoccluded {
    match luminaire {
        Luminaire::Point { position, intensity } => {
            let position = position.as_dvec3();
            let to_light = position - surfel.position;
            let wi = to_light.normalize_or_zero();
            let irradiance = cosine(surfel, wi) * intensity.as_dvec3() / to_light.length_squared();
            let origin = surfel.offset_ray_origin(wi);
            Unoccluded {
                radiance: reflect(surfel, wo, wi, irradiance),
                origin,
                direction: position - origin,
                t_max: 1.0,
            }
        }
        Luminaire::Infinite { direction, irradiance } => {
            let wi = -direction.as_dvec3();
            let irradiance = cosine(surfel, wi) * irradiance.as_dvec3();
            let origin = surfel.offset_ray_origin(wi);
            Unoccluded { radiance: reflect(surfel, wo, wi, irradiance), origin, direction: wi, t_max: f64::INFINITY }
        }
    }
}

/// A point on an emissive triangle, chosen evenly by area: `Le cos cos' area / d^2`.
fn from_triangle(
    surfel: &Surfel,
    wo: DVec3,
    triangle: &EmissiveTriangle,
    emission: DVec3,
    u: f64,
    v: f64,
) -> Unoccluded {
    let [a, b, c] = triangle.vertices;
    let point = interpolate(uniform_triangle(u, v), triangle.vertices);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let to_light = point - surfel.position;
    let wi = to_light.normalize_or_zero();
    let irradiance = cosine(surfel, wi) * normal.dot(wi).abs() * triangle.area() / to_light.length_squared() * emission;
    // Both ends are inexact.
    let origin = surfel.offset_ray_origin(wi);
    let target = offset_ray_origin(point, position_error(triangle.vertices), normal, -wi);
    let radiance = reflect(surfel, wo, wi, irradiance);
    Unoccluded { radiance, origin, direction: target - origin, t_max: BEFORE_TARGET }
}

/// Cosine of the angle of incidence; zero from behind.
fn cosine(surfel: &Surfel, wi: DVec3) -> f64 {
    surfel.shading_normal.dot(wi).max(0.0)
}

/// Radiance towards `wo` for `irradiance` from `wi`.
fn reflect(surfel: &Surfel, wo: DVec3, wi: DVec3, irradiance: DVec3) -> DVec3 {
    // Zero distance gives zero times infinity; such a point has no measure.
    if wi == DVec3::ZERO { DVec3::ZERO } else { surfel.bsdf(wo, wi) * irradiance }
}
