//! What the camera sees first; its twin is `shaders/aov.comp`.

use super::impulse::fresnel;
use super::physical::PhysicalSurface;
use super::prepared_scene::Reference;
use crate::film::AovSum;
use crate::sampling::ray_salt;
use glam::DVec3;
use std::ops::Range;

impl Reference {
    /// What the camera rays of these samples of a pixel hit first, added up.
    pub fn first_hits(&self, pixel: u32, samples: Range<u32>) -> AovSum {
        let sensor = &self.scene.sensor;
        let position = sensor.position.as_dvec3();
        let forward = (sensor.target.as_dvec3() - position).normalize();
        let (mut albedo, mut normal, mut depth, mut hits) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0);
        for sample in samples {
            let (origin, direction) = self.sensor_ray(pixel, sample);
            let salt = ray_salt(pixel, sample, 0, self.scene.settings.seed);
            let Some(hit) = self.closest_hit(origin, direction, f64::INFINITY, salt) else { continue };
            let surfel = self.surfel(&hit, -direction);
            let base = surfel.lambert + surfel.glossy;
            let physical = surfel.physical().map(PhysicalSurface::normal_albedo);
            albedo += physical.unwrap_or_else(|| match surfel.eta {
                // As from straight above; on a black base too, which a map may have in places.
                Some(eta) if surfel.transmission == DVec3::ZERO => {
                    base + surfel.reflection * fresnel(eta, 1.0) * (DVec3::ONE - base)
                }
                // Of glass either the one or the other.
                Some(_) => base + surfel.reflection.max(surfel.transmission),
                None => base + surfel.reflection,
            });
            normal += surfel.shading_normal;
            depth += (surfel.position - surfel.lift - position).dot(forward);
            hits += 1;
        }
        let [albedo, normal] = [albedo, normal].map(|v| v.as_vec3().to_array());
        AovSum { albedo, depth: depth as f32, normal, hits }
    }
}
