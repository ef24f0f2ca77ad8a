//! Light that no estimator here finds, and that a picture therefore lacks: said before it is rendered.
//!
//! Points and parallel light reach a surface through shadow rays alone. Glass and mirrors stop these, so what such a luminaire sends through
//! glass or by a mirror is lost, however many samples there are. What has an area is found by paths, too, if they may be long enough. A few hundred
//! rays tell how much is lost: from the luminaires onwards, and from what the camera sees towards them.

use super::luminaire::{Unoccluded, spot_falloff};
use super::path::Vertex;
use super::prepared_scene::Reference;
use super::profile::photometric_intensity;
use super::surfel::mean;
use crate::sampling::{random4, ray_salt, uniform};
use crate::scene::{Estimator, Integrator, LightSampling, Luminaire, Material, SampledLuminaire, Scene, one_minus_cos};
use glam::{DMat3, DVec3};
use std::f64::consts::TAU;

/// Rays from each luminaire without an area.
const RAYS: u32 = 512;
/// As many luminaires are looked at, those with the most power.
const LUMINAIRES: usize = 16;
/// Paths from the camera, ...
const PATHS: u32 = 256;
/// ... and how many of their vertices count: what is lost matters most where the camera looks.
const VERTICES: usize = 4;
/// Surfaces in a row through which light is followed.
const MOST_SURFACES: u32 = 32;
/// A loss is worth a word from this share of the luminaire's own light on, ...
const LEAST_OF_ITS_OWN: f64 = 0.05;
/// ... and this share of all light. A glass on a table in the sun has less.
const LEAST_OF_ALL: f64 = 0.01;
/// Paths with fewer bounces than this may be too short for a lamp behind glass.
const ENOUGH_BOUNCES: u32 = 8;

/// Light, of which a part is found.
#[derive(Debug, Clone, Copy, Default)]
struct Light {
    found: f64,
    lost: f64,
}

impl Light {
    fn all(self) -> f64 {
        self.found + self.lost
    }

    /// The lost share of it.
    fn lost_share(self) -> f64 {
        if self.lost > 0.0 { self.lost / self.all() } else { 0.0 }
    }
}

/// Sentences for warnings, one for each luminaire of which the picture will lack much; none if all light is found, or there is none at all
/// ([`Scene::dark_because`]). Scenes without such luminaires, or without glass and mirrors, cost nothing.
pub fn lost_light(scene: &Scene) -> Vec<String> {
    lost_light_by(scene, &mut None)
}

/// The same by a tracer of the scene, which is made and left there if there is none and one is needed.
pub fn lost_light_by(scene: &Scene, tracer: &mut Option<Reference>) -> Vec<String> {
    let estimator = scene.integrator.estimator();
    if scene.dark_because().is_some() || scene.integrator.check_ends().is_err() {
        return vec![];
    }
    let by_chance = estimator.light_sampling == LightSampling::None;
    let mut sentences: Vec<String> = by_chance.then(|| never_met(scene)).flatten().into_iter().collect();
    let impulses = scene.materials.iter().any(Material::has_impulse);
    let may_be_short = estimator.max_bounces.is_some_and(|most| most < ENOUGH_BOUNCES);
    let sampled = !by_chance && !scene.luminaires.is_empty();
    if impulses && (sampled || may_be_short) {
        if tracer.is_none() && !Reference::fits(scene) {
            sentences.push(format!(
                "{}: there is too little memory to find out whether the picture lacks light that comes through glass or by mirrors",
                scene.path.display()
            ));
            return sentences;
        }
        let reference = tracer.get_or_insert_with(|| Reference::new(scene));
        // All light counts, also that of a sky which is left to chance.
        let own = reference.set_integrator(&all_sampled(scene.integrator));
        let seen = reference.light_on_what_is_seen();
        if sampled {
            sentences.extend(reference.lost_of_luminaires(&seen));
        }
        if may_be_short {
            sentences.extend(too_short(scene, &seen));
        }
        reference.scene.integrator = scene.integrator;
        if let Some(own) = own {
            reference.luminaires = own;
        }
    }
    sentences
}

/// The integrator with which every luminaire is sampled by all of its light.
fn all_sampled(integrator: Integrator) -> Integrator {
    match integrator {
        Integrator::Path(estimator) => {
            Integrator::Path(Estimator { light_sampling: LightSampling::Direct, ..estimator })
        }
        Integrator::Simple { .. } => integrator,
    }
}

/// What is said where light is only met by chance, and some luminaires never are.
fn never_met(scene: &Scene) -> Option<String> {
    let these = match scene.luminaires.iter().filter(|luminaire| !luminaire.is_disc()).count() {
        0 => return None,
        1 => "the luminaire without an area".to_owned(),
        n => format!("the {n} luminaires without an area"),
    };
    Some(format!(
        "{}: with light sampling off (`none`) no path ever meets {these}: the picture lacks that light",
        scene.path.display()
    ))
}

/// What is said where lamps or the environment shine through glass, and paths are too short for it.
fn too_short(scene: &Scene, seen: &Seen) -> Option<String> {
    let share = seen.with_area.lost / seen.all();
    let (why, advice) = match (scene.integrator, scene.integrator.estimator().max_bounces) {
        (Integrator::Simple { .. }, _) => {
            ("the simple ray tracer has no bounces".into(), "take another estimator, such as `default`")
        }
        (_, limit) => (format!("max_bounces is {}", limit.unwrap_or(0)), "allow more bounces"),
    };
    (share >= LEAST_OF_ITS_OWN).then(|| {
        format!(
            "{}: about {} of the light of lamps and environment on what the camera sees comes through glass, for which paths are too short ({why}): the \
             picture lacks it; {advice}",
            scene.path.display(),
            percent(share)
        )
    })
}

/// What arrives, or would, where the camera looks, straight from the luminaires.
#[derive(Debug, Default)]
struct Seen {
    /// By the luminaires without an area, as they lie in the table.
    impulses: Vec<Light>,
    /// By all others.
    with_area: Light,
}

impl Seen {
    fn all(&self) -> f64 {
        self.impulses.iter().map(|light| light.all()).sum::<f64>() + self.with_area.all()
    }
}

/// Where the light of a luminaire without an area lands.
#[derive(Debug, Default)]
struct Sent {
    /// What lands on surfaces that scatter it: at once, or by way of glass and mirrors.
    landed: Light,
    /// The share that meets glass or a mirror first.
    first: f64,
}

impl Reference {
    /// The luminaires of which much is lost, in words.
    fn lost_of_luminaires(&self, seen: &Seen) -> Vec<String> {
        let table = &self.luminaires;
        let impulses = table.entries.iter().zip(&table.choice.pdf).enumerate();
        let impulses = impulses.filter_map(|(at, (entry, power))| match entry {
            SampledLuminaire::Impulse(luminaire) => Some((at, luminaire, *power)),
            _ => None,
        });
        let mut strongest: Vec<_> = impulses.collect();
        strongest.sort_by(|a, b| b.2.total_cmp(&a.2).then(a.0.cmp(&b.0)));
        strongest.truncate(LUMINAIRES);
        strongest.sort_by_key(|(at, ..)| *at);
        strongest.into_iter().filter_map(|(at, luminaire, power)| self.lost_of(at, luminaire, power, seen)).collect()
    }

    /// What is lost of a luminaire that has this share of the power of all, in words; none if it is not much.
    fn lost_of(&self, at: usize, luminaire: &Luminaire, power: f64, seen: &Seen) -> Option<String> {
        let sent = self.sent(luminaire);
        let on_its_way = sent.landed.lost_share();
        let here = seen.impulses.get(at).copied().unwrap_or_default();
        let much_is_sent = on_its_way >= LEAST_OF_ITS_OWN && on_its_way * power >= LEAST_OF_ALL;
        let much_is_seen = here.lost_share() >= LEAST_OF_ITS_OWN && here.lost >= LEAST_OF_ALL * seen.all();
        let (share, how) = match (much_is_sent, much_is_seen) {
            (false, false) => return None,
            (_, true) if !much_is_sent || here.lost_share() > sent.first => {
                (here.lost_share(), "on what the camera sees comes through glass")
            }
            _ => (sent.first, "falls on glass or mirrors first"),
        };
        let path = &self.scene.path;
        // Of a model; a scene in code has no ending.
        let is_bare = path.extension().is_some_and(|ending| !ending.eq_ignore_ascii_case("toml"));
        let name = if is_bare && self.scene.luminaires.len() < 2 {
            "the key light".into()
        } else {
            // In the table are those that emit.
            let own = (1..).zip(&self.scene.luminaires).filter(|(_, l)| l.emits() && !l.is_disc()).nth(at);
            format!("[[luminaire]] {}", own.map_or(at + 1, |(number, _)| number))
        };
        let advice = match luminaire {
            Luminaire::Infinite { .. } | Luminaire::Sun { .. } => "a sun with an `angle`, which paths find,",
            _ => "an area luminaire (a small mesh that emits)",
        };
        let share = percent(share);
        Some(format!(
            "{}: about {share} of the light of {name} {how}; no estimator here finds light of a luminaire without an area that reaches a surface \
             through glass or by a mirror: the picture lacks it; use {advice} instead",
            path.display()
        ))
    }

    /// Follows the light of a luminaire to the surfaces that scatter it.
    fn sent(&self, luminaire: &Luminaire) -> Sent {
        let mut sent = Sent::default();
        let mut met = 0.0;
        for ray in 0..RAYS {
            let (mut origin, mut direction, weight) = self.ray_from(luminaire, ray);
            let mut light = weight;
            for surfaces in 0..MOST_SURFACES {
                let salt = ray_salt(ray, surfaces, 0, 0);
                let Some(hit) = self.closest_hit(origin, direction, f64::INFINITY, salt) else { break };
                let surfel = self.surfel(&hit, -direction);
                let impulses = surfel.impulses(-direction);
                let [reflected, transmitted] = [impulses.reflection, impulses.transmission].map(mean);
                let specular = reflected + transmitted;
                if surfaces == 0 {
                    met += weight;
                    sent.first += weight * specular;
                }
                if surfel.scatters() {
                    let landed = light * (1.0 - specular).max(0.0);
                    *(if surfaces == 0 { &mut sent.landed.found } else { &mut sent.landed.lost }) += landed;
                }
                let chance = uniform(random4(ray, surfaces, 0, 0)[0]) * specular;
                if specular == 0.0 {
                    break;
                }
                light *= specular;
                direction = if chance < reflected { impulses.reflected } else { impulses.transmitted };
                origin = surfel.offset_ray_origin(direction);
            }
        }
        sent.first /= if met > 0.0 { met } else { 1.0 };
        sent
    }

    /// A ray of a luminaire towards the sphere that holds the scene, or into its cone, and how much light is along it; together the rays are evenly
    /// distributed.
    fn ray_from(&self, luminaire: &Luminaire, ray: u32) -> (DVec3, DVec3, f64) {
        let (low, high) = self.scene.model_bounds();
        let (center, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        // Points of a spiral: evenly along one axis, around the other by the golden ratio.
        let u = (f64::from(ray) + 0.5) / f64::from(RAYS);
        let (sin, cos) = (TAU * (f64::from(ray) * 0.618_033_988_749_895).fract()).sin_cos();
        // About an axis, up to one minus the cosine of an angle.
        let about = |axis: DVec3, whole: f64| {
            let down = u * whole;
            let side = (down * (2.0 - down)).max(0.0).sqrt();
            frame(axis) * DVec3::new(side * cos, side * sin, 1.0 - down)
        };
        match luminaire {
            Luminaire::Spot { position, direction, inner, outer, .. } => {
                let out = about(direction.as_dvec3(), one_minus_cos(f64::from(*outer)));
                (position.as_dvec3(), out, spot_falloff(*direction, *inner, *outer, out))
            }
            Luminaire::Point { position, .. } | Luminaire::Photometric { position, .. } => {
                let position = position.as_dvec3();
                let sine2 = radius * radius / position.distance_squared(center);
                let whole = if sine2 < 1.0 { sine2 / (1.0 + (1.0 - sine2).sqrt()) } else { 2.0 };
                let out = about((center - position).try_normalize().unwrap_or(DVec3::Z), whole);
                let light = match luminaire {
                    Luminaire::Photometric { direction, up, profile, .. } => {
                        photometric_intensity(profile, *direction, *up, out)
                    }
                    _ => 1.0,
                };
                (position, out, light)
            }
            Luminaire::Infinite { direction, .. } | Luminaire::Sun { direction, .. } => {
                let direction = direction.as_dvec3();
                let on_disc = radius * u.sqrt() * DVec3::new(cos, sin, 0.0);
                (center - 2.0 * radius * direction + frame(direction) * on_disc, direction, 1.0)
            }
        }
    }

    /// What the luminaires send, straight, to what the camera sees, and how much of that is lost on the way.
    fn light_on_what_is_seen(&self) -> Seen {
        let film = &self.scene.film;
        let pixels = u64::from(film.width) * u64::from(film.height);
        let max_bounces = self.scene.integrator.estimator().max_bounces;
        let mut seen = Seen { impulses: vec![Light::default(); self.scene.luminaires.len()], ..Seen::default() };
        for path in 0..PATHS {
            // Evenly over the film.
            let pixel = (f64::from(path) * 0.618_033_988_749_895).fract() * pixels as f64;
            let vertices = self.first_vertices(pixel as u32, path, VERTICES);
            for (bounce, vertex) in (0..).zip(&vertices) {
                let random = random4(path, bounce, 1, 0);
                let Some((radiance, at, light)) = self.unoccluded_light(vertex, random) else { continue };
                let Some((surfaces, passed)) = self.straight_through(&light, random[3]) else { continue };
                let (side, lost) = match &self.luminaires.entries[at] {
                    SampledLuminaire::Impulse(_) => (&mut seen.impulses[at], surfaces > 0),
                    _ => {
                        (&mut seen.with_area, surfaces > 0 && max_bounces.is_some_and(|most| bounce + surfaces > most))
                    }
                };
                *(if lost { &mut side.lost } else { &mut side.found }) += radiance * passed;
            }
        }
        seen
    }

    /// The light of a luminaire that a vertex would send on to the camera if nothing were between, averaged over the channels, and its index into the table;
    /// none if there is none.
    fn unoccluded_light(&self, vertex: &Vertex, random: [u32; 4]) -> Option<(f64, usize, Unoccluded)> {
        let wo = -vertex.direction;
        let surfel = self.surfel(vertex.hit.as_ref()?, wo);
        if !surfel.scatters() {
            return None;
        }
        let (at, light) = self.sample_luminaire(&surfel, random)?;
        let cosine = surfel.cosine(light.wi);
        let radiance = mean(vertex.throughput * surfel.bsdf(wo, light.wi) * cosine * light.irradiance);
        (radiance > 0.0 && radiance.is_finite()).then_some((radiance, at, light))
    }

    /// How many surfaces of glass are between, and about how much of the light they let through; none if something else is in the way.
    /// Refraction is left out: a pane does not turn light, and from a lamp in a ball it goes straight.
    fn straight_through(&self, light: &Unoccluded, salt: u32) -> Option<(u32, f64)> {
        let (mut origin, mut left, mut passed) = (light.origin, light.t_max, 1.0);
        for surfaces in 0..MOST_SURFACES {
            let Some(hit) = self.closest_hit(origin, light.direction, left, salt.wrapping_add(surfaces)) else {
                return Some((surfaces, passed));
            };
            let surfel = self.surfel(&hit, -light.direction.normalize());
            // Rough glass scatters what it lets through: that is found from there.
            passed *= mean(surfel.lobes.map_or(surfel.transmission, |lobes| lobes.impulses()[1]));
            if passed == 0.0 {
                return None;
            }
            origin = surfel.offset_ray_origin(light.direction);
            left -= hit.t;
        }
        None
    }
}

/// Two directions across a unit vector, and itself.
fn frame(axis: DVec3) -> DMat3 {
    let (a, b) = axis.any_orthonormal_pair();
    DMat3::from_cols(a, b, axis)
}

/// A share in per cent.
fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}
