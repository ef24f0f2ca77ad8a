//! The radiance along a camera ray: the lecture's path tracer, its recursion turned into a loop with a throughput.

use super::Reference;
use super::scatter::{scatter, survival};
use crate::sampling::{light_block, random4, scatter_block, uniform};
use crate::scene::Integrator;
use glam::DVec3;

impl Reference {
    /// Radiance of one sample of a pixel (`y * width + x`), and the number of rays that were traced for it.
    pub fn radiance(&self, pixel: u32, sample: u32) -> (DVec3, u32) {
        let seed = self.scene.settings.seed;
        let (mut origin, mut direction) = self.sensor_ray(pixel, sample);
        let mut radiance = DVec3::ZERO;
        let mut throughput = DVec3::ONE;
        let mut rays = 0;
        for bounce in 0.. {
            rays += 1;
            let Some(hit) = self.closest_hit(origin, direction, f64::INFINITY) else {
                break; // Escaping light disappears.
            };
            let wo = -direction;
            let surfel = self.surfel(&hit, wo);

            // Emission that an indirect ray finds is already in the direct light of the bounce before.
            if bounce == 0 {
                radiance += surfel.emission;
            }
            let random = random4(pixel, sample, light_block(bounce), seed);
            radiance += throughput * self.direct_light(&surfel, wo, random, &mut rays);

            match self.scene.integrator {
                Integrator::Simple { ambient } => {
                    radiance += ambient.as_dvec3() * surfel.ambient;
                    break;
                }
                Integrator::Path(e) if Some(bounce) == e.max_bounces => break,
                Integrator::Path(_) => {}
            }

            // Extinction: the survivors stand for those that ended.
            let survival = survival(&surfel);
            if uniform(random[3]) >= survival {
                break;
            }
            throughput /= survival;

            let random = random4(pixel, sample, scatter_block(bounce), seed);
            let (wi, weight) = scatter(&surfel, wo, uniform(random[0]), uniform(random[1]));
            throughput *= weight;
            if throughput == DVec3::ZERO {
                break;
            }
            origin = surfel.offset_ray_origin(wi);
            direction = wi;
        }
        (radiance, rays)
    }
}
