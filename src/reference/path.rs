//! The radiance along a camera ray: the lecture's path tracer, its recursion turned into a loop with a throughput.

use super::hit::Hit;
use super::luminaire::emission_weight;
use super::prepared_scene::Reference;
use super::scatter::{SURE_THROUGHPUT, roulette_throughput, scatter, survival};
use super::surfel::Surfel;
use crate::film::Rays;
use crate::sampling::{light_block, ray_salt, scatter_block, uniform};
use crate::scene::{Extinction, Integrator, LightSampling};
use glam::DVec3;

/// The most surfaces that a path meets; one that would go on is lost, which is counted: light that nothing absorbs would keep it for ever.
///
/// Rooms that reflect 0.999 lose less than one path in a million by it (the longest live for 916 + 1000 ln(1e6) bounces), and what a GPU does in
/// one go stays below a second. Half of the rounds after which Mesa before 23 ends a loop, with all samples that it had in hand.
pub const LONGEST_PATH: u32 = 1 << 15;

/// What happened where a ray of a path ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// What the ray met; none: it left the scene.
    pub hit: Option<Hit>,
    /// Where it came from.
    pub origin: DVec3,
    /// Its direction; of unit length.
    pub direction: DVec3,
    /// What a unit of radiance along the ray adds to the sample.
    pub throughput: DVec3,
    /// What the sample had found when the path went on from here.
    pub radiance: DVec3,
}

impl Reference {
    /// Radiance of one sample of a pixel (`y * width + x`), and the number of rays that were traced for it. It is not finite if the
    /// path's numbers were not, or if it would be longer than [`LONGEST_PATH`].
    pub fn radiance(&self, pixel: u32, sample: u32) -> (DVec3, Rays) {
        self.follow(pixel, sample, &mut |_| true)
    }

    /// The same, with every ray of the path (without those to the luminaires).
    pub fn vertices(&self, pixel: u32, sample: u32) -> (DVec3, Vec<Vertex>) {
        let mut vertices = vec![];
        let (radiance, _) = self.follow(pixel, sample, &mut |vertex| {
            vertices.push(vertex);
            true
        });
        (radiance, vertices)
    }

    /// The first rays of the path, `most` of them at most.
    pub fn first_vertices(&self, pixel: u32, sample: u32, most: usize) -> Vec<Vertex> {
        let mut vertices = vec![];
        self.follow(pixel, sample, &mut |vertex| {
            vertices.push(vertex);
            vertices.len() < most
        });
        vertices
    }

    /// Follows a path for as long as `met` says, which is given every ray of it.
    pub(super) fn follow(&self, pixel: u32, sample: u32, met: &mut impl FnMut(Vertex) -> bool) -> (DVec3, Rays) {
        let settings = &self.scene.settings;
        let numbers = |block: u32| settings.sampler.numbers(pixel, sample, block, settings.seed);
        let salt = |ray: u32| ray_salt(pixel, sample, ray, settings.seed);
        let estimator = self.scene.integrator.estimator();

        let (mut origin, mut direction) = self.sensor_ray(pixel, sample);
        let mut radiance = DVec3::ZERO;
        // Share of the light along the ray that reaches the camera, over the probability of the path.
        let mut throughput = DVec3::ONE;
        // Product of eta^2 over all transmissions: what extinction must not see.
        let mut eta_scale = 1.0;
        // Throughput without eta^2 and without extinction: the slides' `combinedAlbedo`.
        let mut combined_albedo = DVec3::ONE;
        // Whether a lobe has scattered the path at a surface before.
        let mut scattered_before = false;
        // The surface that the ray comes from, and the density with which the path went there; none for the camera and impulses.
        let mut from: Option<Surfel> = None;
        let mut pdf = None;
        let mut rays = Rays::default();
        for bounce in 0.. {
            rays.all += 1;
            let leaving =
                |from: &Option<Surfel>| from.as_ref().map_or(DVec3::ZERO, |from| from.inner_absorption(direction));
            let Some(hit) = self.closest_hit(origin, direction, f64::INFINITY, salt(2 * bounce)) else {
                // Hidden from the camera itself.
                let ray = (origin, direction);
                throughput *=
                    self.passed_bodies(ray, 1.0, f64::INFINITY, salt(2 * bounce), [leaving(&from), DVec3::ZERO]);
                if bounce > 0 || !settings.transparent {
                    let weight = emission_weight(estimator.light_sampling, pdf, self.environment_pdf(direction));
                    radiance += throughput * weight * self.environment_radiance(direction);
                    radiance += throughput * self.sunlight(direction, pdf);
                }
                met(Vertex { hit: None, origin, direction, throughput, radiance });
                break;
            };
            let wo = -direction;
            let surfel = self.surfel(&hit, wo);
            let (ray, coming) = ((origin, direction), surfel.inner_absorption(wo));
            throughput *= self.passed_bodies(ray, 1.0, hit.t, salt(2 * bounce), [leaving(&from), coming]);
            if surfel.emission != DVec3::ZERO {
                let light_pdf =
                    from.as_ref().filter(|_| pdf.is_some()).map_or(0.0, |from| self.luminaire_pdf(from, &surfel));
                let weight = emission_weight(estimator.light_sampling, pdf, light_pdf);
                radiance += throughput * weight * surfel.emission;
            }
            if estimator.max_bounces.is_some_and(|max| bounce > max) {
                met(Vertex { hit: Some(hit), origin, direction, throughput, radiance });
                break;
            }
            if estimator.light_sampling != LightSampling::None {
                let shadow = salt(2 * bounce + 1);
                let random = numbers(light_block(bounce));
                let seen = roulette_throughput(throughput * eta_scale, bounce, scattered_before);
                radiance += throughput * self.direct_light(&surfel, wo, seen, random, shadow, &mut rays);
            }
            if let Integrator::Simple { ambient } = self.scene.integrator {
                radiance += ambient.as_dvec3() * surfel.ambient;
            }
            let go_on = met(Vertex { hit: Some(hit), origin, direction, throughput, radiance });
            if !go_on || matches!(self.scene.integrator, Integrator::Simple { .. }) {
                break;
            }

            // Extinction by the surface. The survivors stand for those that ended, unless the slide is taken at its word.
            let random = numbers(scatter_block(bounce)).map(uniform);
            let mut reweighted = 1.0;
            if matches!(estimator.extinction, Extinction::Literal | Extinction::Surface) {
                let alive = survival(&surfel);
                if random[3] >= alive {
                    break;
                }
                if estimator.extinction == Extinction::Surface {
                    reweighted = alive;
                    throughput /= alive;
                }
            }

            let scattered = scatter(&surfel, wo, estimator.directions, [random[0], random[1], random[2]]);
            // What the last bounce finds is direct light; light sampling has it already, but for what an impulse shows.
            let last = estimator.max_bounces == Some(bounce);
            if last && estimator.light_sampling == LightSampling::Direct && scattered.pdf.is_some() {
                break;
            }
            throughput *= scattered.weight;
            if throughput == DVec3::ZERO {
                break;
            }
            // A path that overflowed: not black but lost, and it has to be counted.
            if !throughput.is_finite() || !scattered.wi.is_finite() {
                radiance = DVec3::NAN;
                break;
            }
            eta_scale *= scattered.eta2;

            // Slide "Albedo Termination": a bias.
            combined_albedo *= scattered.weight * scattered.eta2;
            if estimator.albedo_threshold.is_some_and(|least| combined_albedo.max_element() < f64::from(least)) {
                break;
            }
            // Russian roulette by what is left of the whole path.
            if estimator.extinction == Extinction::Throughput {
                let seen = roulette_throughput(throughput * eta_scale, bounce, scattered_before);
                let alive = (seen.max_element() / SURE_THROUGHPUT).min(1.0);
                if random[3] >= alive {
                    break;
                }
                reweighted = alive;
                throughput /= alive;
            }
            scattered_before |= scattered.pdf.is_some();
            from = Some(surfel);
            pdf = scattered.pdf.map(|pdf| pdf * reweighted);
            origin = surfel.offset_ray_origin(scattered.wi);
            direction = scattered.wi;
            if bounce + 1 == LONGEST_PATH {
                radiance = DVec3::NAN;
                break;
            }
        }
        (radiance, rays)
    }
}
