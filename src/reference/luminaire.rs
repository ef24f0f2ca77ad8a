//! Direct light: next-event estimation (slides "Lighting Functions", "Shadows & Attenuation", "Area Luminaires").

use super::bsdf::bsdf_and_pdf;
use super::hit::{interpolate, texture_coordinates};
use super::prepared_scene::Reference;
use super::profile::photometric_intensity;
use super::scatter::path_pdf;
use super::sun::{one_minus_cosine, sample_sun};
use super::surfel::{Surfel, offset_ray_origin, position_error};
use super::warp::{solid_angle, spherical_triangle, uniform_triangle};
use crate::film::Rays;
use crate::sampling::uniform;
use crate::scene::{AreaSampling, EmissiveTriangle, LightSampling, Luminaire, SampledLuminaire, spot_edge};
use glam::{DVec3, Vec3};

/// Where a shadow ray to a point on a surface ends, short of the point: a relative distance far above the error of `t`.
const BEFORE_TARGET: f64 = 1.0 - 1e-9;

/// A triangle is near where its area over the squared distance to its centroid is above this.
pub const NEAR: f64 = 0.05;
/// Triangles that look smaller, in steradian, are sampled by area: solid angles cancel.
pub const LEAST_SOLID_ANGLE: f64 = 1e-3;

/// Light that would arrive from a luminaire if nothing were between.
pub(super) struct Unoccluded {
    /// Unit direction to the luminaire.
    pub(super) wi: DVec3,
    /// Irradiance on a surface perpendicular to `wi`, over the probability of this sample.
    pub(super) irradiance: DVec3,
    /// Density of `wi`, per steradian, the choice of the luminaire included, as [`Reference::luminaire_pdf`] has it; none where no other ray
    /// can find the luminaire.
    pdf: Option<f64>,
    /// The shadow ray.
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    pub(super) t_max: f64,
}

impl Reference {
    /// Radiance towards `wo` from one luminaire, chosen by number 2 of `random` ([`Reference::choose_luminaire`]) and weighted by
    /// one over its probability; numbers 0 and 1 choose the point on it, or the direction to an environment. `salt` is that of the
    /// shadow ray; it is added, if there is one, to `rays`.
    ///
    /// `throughput` is the share of this radiance that reaches the camera, without `eta^2`, over the probability of the path, or what
    /// [`roulette_throughput`](super::scatter::roulette_throughput) has in its place: by it [`path_pdf`] knows how likely the path itself is to
    /// find the luminaire.
    pub fn direct_light(
        &self,
        surfel: &Surfel,
        wo: DVec3,
        throughput: DVec3,
        random: [u32; 4],
        salt: u32,
        rays: &mut Rays,
    ) -> DVec3 {
        if !surfel.scatters() {
            return DVec3::ZERO;
        }
        let Some((chosen, light)) = self.sample_luminaire(surfel, random) else { return DVec3::ZERO };
        let cosine = surfel.cosine(light.wi);
        let estimator = self.scene.integrator.estimator();
        let (weight, value) = match (light.pdf, estimator.light_sampling) {
            (Some(pdf), LightSampling::Mis) => {
                let (value, own) = bsdf_and_pdf(surfel, wo, light.wi, estimator.directions);
                let scattered = throughput * value * cosine * surfel.dilution(light.wi);
                (power_heuristic(pdf, path_pdf(own, scattered, surfel, &estimator)), value)
            }
            _ => (1.0, surfel.bsdf(wo, light.wi)),
        };
        let radiance = weight * value * cosine * light.irradiance;
        if radiance == DVec3::ZERO {
            return DVec3::ZERO;
        }
        *rays += Rays { all: 1, shadow: 1 };
        if self.occluded(light.origin, light.direction, light.t_max, salt) {
            return DVec3::ZERO;
        }
        // The inner side of a body that glows.
        let to = match &self.luminaires.entries[chosen] {
            SampledLuminaire::Area(triangle) if triangle.normal.dot(light.wi) > 0.0 => {
                self.body_absorption(triangle.material)
            }
            _ => DVec3::ZERO,
        };
        let ray = (light.origin, light.direction);
        radiance
            * self.passed_bodies(
                ray,
                light.direction.length(),
                light.t_max,
                salt,
                [surfel.inner_absorption(light.wi), to],
            )
    }

    /// The direction in which light sampling looks from a surfel with these numbers, and the density that the power heuristic is given for
    /// it; none where no other ray can find the luminaire.
    pub fn sampled_direction(&self, surfel: &Surfel, random: [u32; 4]) -> Option<(DVec3, f64)> {
        self.sample_luminaire(surfel, random).and_then(|(_, light)| Some((light.wi, light.pdf?)))
    }

    /// Chooses a luminaire, by its index into the table, and a point on it.
    pub(super) fn sample_luminaire(&self, surfel: &Surfel, random: [u32; 4]) -> Option<(usize, Unoccluded)> {
        let (chosen, probability, ideal) = self.choose_luminaire(surfel, random)?;
        let light = match &self.luminaires.entries[chosen] {
            SampledLuminaire::Impulse(luminaire) => impulse(surfel, luminaire, probability),
            SampledLuminaire::Area(triangle) => {
                self.point_on_triangle(surfel, triangle, [probability, ideal], uniform(random[0]), uniform(random[1]))
            }
            SampledLuminaire::Sun(sun) => {
                let wi = sample_sun(sun, uniform(random[0]), uniform(random[1]));
                let irradiance = sun.radiance / (sun.density() * probability);
                let (pdf, origin) = (Some(ideal * sun.density()), surfel.offset_ray_origin(wi));
                Some(Unoccluded { wi, irradiance, pdf, origin, direction: wi, t_max: f64::INFINITY })
            }
            SampledLuminaire::Environment => {
                let (wi, density) = self.sample_environment([random[0], random[1]])?;
                let pdf = probability * density;
                let irradiance = self.environment_radiance(wi) / pdf;
                let origin = surfel.offset_ray_origin(wi);
                Some(Unoccluded { wi, irradiance, pdf: Some(pdf), origin, direction: wi, t_max: f64::INFINITY })
            }
        };
        light.map(|light| (chosen, light))
    }

    /// A point on an emissive triangle, which was chosen with a probability, and another one for the power heuristic: radiance over the density of
    /// its direction.
    fn point_on_triangle(
        &self,
        surfel: &Surfel,
        triangle: &EmissiveTriangle,
        [probability, ideal]: [f64; 2],
        u: f64,
        v: f64,
    ) -> Option<Unoccluded> {
        // It sees itself from the edge. Rounding would make that half of all directions.
        if surfel.owner == [triangle.object, triangle.triangle] {
            return None;
        }
        let weights = match self.near_solid_angle(surfel.position, triangle.vertices) {
            Some(_) => {
                let wi = spherical_triangle(seen_from(surfel.position, triangle.vertices), u, v);
                weights_along(surfel.position, wi, triangle.vertices)
            }
            None => uniform_triangle(u, v),
        };
        let point = interpolate(weights, triangle.vertices);
        let wi = (point - surfel.position).try_normalize()?;
        if self.scene.materials[triangle.material as usize].one_sided && triangle.normal.dot(wi) > 0.0 {
            return None;
        }
        let density = self.triangle_density(surfel.position, triangle.vertices, point);
        // Both ends are inexact.
        let origin = surfel.offset_ray_origin(wi);
        let target = offset_ray_origin(point, position_error(triangle.vertices), triangle.normal, -wi);
        Some(Unoccluded {
            wi,
            irradiance: self.emission_at(triangle, weights) / (probability * density),
            pdf: Some(ideal * density),
            origin,
            direction: target - origin,
            t_max: BEFORE_TARGET,
        })
    }

    /// Mean radiance that leaves a point of an emissive triangle: where there is a hole, nothing is emitted.
    fn emission_at(&self, triangle: &EmissiveTriangle, weights: [f64; 3]) -> DVec3 {
        let mesh = &self.scene.meshes[self.scene.objects[triangle.object as usize].mesh as usize];
        let uv = texture_coordinates(mesh, &mesh.triangles[triangle.triangle as usize], weights);
        let material = &self.scene.materials[triangle.material as usize];
        let emission = material.emission.as_dvec3() * self.map(material.maps.emission, uv).truncate();
        emission * self.opacity(material, uv)
    }

    /// The solid angle of a triangle that is sampled by its solid angle from here; none if it is sampled by its area.
    fn near_solid_angle(&self, from: DVec3, corners: [DVec3; 3]) -> Option<f64> {
        let [a, b, c] = corners;
        let area = 0.5 * (b - a).cross(c - a).length();
        let distance2 = ((a + b + c) / 3.0).distance_squared(from);
        if self.scene.integrator.estimator().area_sampling == AreaSampling::Area || area / distance2 <= NEAR {
            return None;
        }
        Some(solid_angle(seen_from(from, corners))).filter(|omega| *omega > LEAST_SOLID_ANGLE)
    }

    /// The density with which light sampling at `from` chooses the direction to a point of an emissive triangle, once the triangle
    /// is chosen; per steradian. Infinite for a triangle seen from the edge.
    pub fn triangle_density(&self, from: DVec3, corners: [DVec3; 3], point: DVec3) -> f64 {
        if let Some(omega) = self.near_solid_angle(from, corners) {
            return 1.0 / omega;
        }
        let [a, b, c] = corners;
        // Twice the area times the cosine at the luminaire.
        let projected = (b - a).cross(c - a).dot((point - from).normalize_or_zero()).abs();
        point.distance_squared(from) / (0.5 * projected)
    }

    /// The density with which light sampling at a surface chooses the direction to a point of an emissive one; per steradian, the choice
    /// of the luminaire included.
    pub fn luminaire_pdf(&self, from: &Surfel, surfel: &Surfel) -> f64 {
        let [object, triangle] = surfel.owner;
        let corners = self.corners(object, triangle);
        let density = self.triangle_density(from.position, corners, surfel.position);
        if let Some(tree) = self.light_tree() {
            // One that is never chosen may be seen from the edge, where the density would be infinite.
            let probability = self.tree_probability(tree, from, object, triangle);
            return if probability == 0.0 { 0.0 } else { probability * density };
        }
        let [a, b, c] = corners;
        let area = 0.5 * (b - a).cross(c - a).length();
        let object = &self.scene.objects[object as usize];
        let mesh = &self.scene.meshes[object.mesh as usize];
        let material = object.material.unwrap_or(mesh.triangles[triangle as usize].material);
        self.luminaires.area_probability(material, area) * density
    }

    /// What a path that escapes in this direction finds of the discs at infinity, each with its weight; `pdf` is the density with which the path went
    /// there, none if it comes from the camera or an impulse.
    pub fn sunlight(&self, direction: DVec3, pdf: Option<f64>) -> DVec3 {
        let light_sampling = self.scene.integrator.estimator().light_sampling;
        let mut radiance = DVec3::ZERO;
        for (entry, sun) in self.luminaires.suns() {
            if one_minus_cosine(direction, sun.towards.as_dvec3()) <= sun.extent {
                let light_pdf = self.sun_probability(entry) * sun.density();
                radiance += emission_weight(light_sampling, pdf, light_pdf) * sun.radiance;
            }
        }
        radiance
    }

    /// The density of light sampling for a direction to the environment, per steradian, the choice of the luminaire included.
    pub fn environment_pdf(&self, direction: DVec3) -> f64 {
        let tree = self.light_tree().map(|tree| tree.environment_probability);
        tree.unwrap_or_else(|| self.luminaires.environment_probability()) * self.environment_density(direction)
    }
}

/// The share of a spot's intensity that it sends along `out`, a unit vector.
pub fn spot_falloff(direction: Vec3, inner: f32, outer: f32, out: DVec3) -> f64 {
    let (edge, scale) = spot_edge(inner, outer);
    ((edge - one_minus_cosine(out, direction.as_dvec3())) * scale).clamp(0.0, 1.0).powi(2)
}

/// A luminaire without an area: inverse-square law, or no attenuation at infinity.
fn impulse(surfel: &Surfel, luminaire: &Luminaire, probability: f64) -> Option<Unoccluded> {
    let point = |position: &Vec3, intensity: &Vec3, towards: &dyn Fn(DVec3) -> f64| {
        let position = position.as_dvec3();
        let to_light = position - surfel.position;
        let wi = to_light.try_normalize()?;
        let irradiance = intensity.as_dvec3() * towards(-wi) / to_light.length_squared() / probability;
        let origin = surfel.offset_ray_origin(wi);
        Some(Unoccluded { wi, irradiance, pdf: None, origin, direction: position - origin, t_max: 1.0 })
    };
    match luminaire {
        Luminaire::Point { position, intensity } => point(position, intensity, &|_| 1.0),
        Luminaire::Spot { position, direction, intensity, inner, outer } => {
            point(position, intensity, &|out| spot_falloff(*direction, *inner, *outer, out))
        }
        Luminaire::Photometric { position, direction, up, intensity, profile } => {
            point(position, intensity, &|out| photometric_intensity(profile, *direction, *up, out))
        }
        // One with an extent is no impulse: `LuminaireTable` has it as a disc.
        Luminaire::Infinite { direction, irradiance } | Luminaire::Sun { direction, irradiance, .. } => {
            let wi = -direction.as_dvec3();
            let irradiance = irradiance.as_dvec3() / probability;
            let origin = surfel.offset_ray_origin(wi);
            Some(Unoccluded { wi, irradiance, pdf: None, origin, direction: wi, t_max: f64::INFINITY })
        }
    }
}

/// Weight of emission that a ray finds: all of it if nothing else could have found it, that is if the ray comes from the camera or
/// an impulse (`pdf` is none) or no light is sampled; none if light sampling has already counted it.
///
/// `pdf` is the density with which the ray goes there ([`path_pdf`]), `light_pdf` that with which light sampling would have.
pub fn emission_weight(light_sampling: LightSampling, pdf: Option<f64>, light_pdf: f64) -> f64 {
    match (pdf, light_sampling) {
        (None, _) | (_, LightSampling::None) => 1.0,
        (Some(_), LightSampling::Direct) => 0.0,
        (Some(pdf), LightSampling::Mis) => power_heuristic(pdf, light_pdf),
    }
}

/// Weight of a sample that was chosen with density `a` where another way to choose it has density `b`: `a^2 / (a^2 + b^2)` (Veach and
/// Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995). `a` is not zero; either may be infinite.
pub fn power_heuristic(a: f64, b: f64) -> f64 {
    if a.is_infinite() {
        return 1.0;
    }
    1.0 / (1.0 + (b / a).powi(2))
}

/// Unit vectors to the corners.
fn seen_from(from: DVec3, corners: [DVec3; 3]) -> [DVec3; 3] {
    corners.map(|corner| (corner - from).normalize_or_zero())
}

/// Weights of a triangle's corners where a ray, which is known to hit it, does (Cramer's rule: Moeller and Trumbore, "Fast, Minimum Storage
/// Ray/Triangle Intersection", 1997). A point made from them is on the plane as well as any other of the triangle.
fn weights_along(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac, to_origin) = (b - a, c - a, origin - a);
    let determinant = direction.cross(ac).dot(ab);
    // `max` makes 0 of 0 / 0, a ray within the plane of the triangle.
    let b1 = (to_origin.dot(direction.cross(ac)) / determinant).clamp(0.0, 1.0).max(0.0);
    let b2 = (direction.dot(to_origin.cross(ab)) / determinant).clamp(0.0, 1.0 - b1).max(0.0);
    [1.0 - b1 - b2, b1, b2]
}
