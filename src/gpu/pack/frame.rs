//! Sensor and estimator, as the kernel has them.

use super::environment::search_tree_size;
use crate::gpu::layout;
use crate::scene::{FilmSettings, Integrator, LuminaireTable, Projection, Scene, Sensor};
use bytemuck::Zeroable;
use glam::{DVec3, Vec3};

/// Sensor, film, integrator and environment of a scene.
pub(in crate::gpu) fn frame(scene: &Scene, table: &LuminaireTable) -> layout::Frame {
    let (radiance, rotation) = scene.environment.as_ref().map_or((Vec3::ZERO, 0.0), |e| (e.radiance, e.rotation));
    let image = scene.environment.as_ref().and_then(|environment| environment.image.as_ref());
    let (environment_width, environment_height) = image.map_or((1, 1), |image| (image.width, image.height));
    let mut frame = layout::Frame {
        environment: radiance.to_array(),
        seed: scene.settings.seed,
        environment_width,
        environment_height,
        environment_rotation: turns(rotation),
        environment_rows: search_tree_size(environment_height),
        environment_row: search_tree_size(environment_width),
        ..Zeroable::zeroed()
    };
    light(&mut frame, table);
    aim(&mut frame, &scene.sensor, &scene.film, scene.world_bounds());
    estimate(&mut frame, &scene.integrator);
    frame
}

/// Puts what is known of the luminaires as a whole into a frame.
pub(in crate::gpu) fn light(frame: &mut layout::Frame, table: &LuminaireTable) {
    frame.luminaire_count = table.entries.len() as u32;
    frame.environment_probability = table.environment_probability() as f32;
    (frame.first_sun, frame.sun_count) =
        (table.suns().next().map_or(0, |(index, _)| index as u32), table.suns().count() as u32);
    frame.least_probability = table.least_probability as f32;
}

/// Puts the integrator's numbers into a frame.
pub(in crate::gpu) fn estimate(frame: &mut layout::Frame, integrator: &Integrator) {
    let (ambient, max_bounces, albedo_threshold) = match *integrator {
        Integrator::Simple { ambient } => (ambient, 0, 0.0),
        Integrator::Path(estimator) => {
            (Vec3::ZERO, estimator.max_bounces.unwrap_or(u32::MAX), estimator.albedo_threshold.unwrap_or(0.0))
        }
    };
    frame.ambient = vec4(ambient);
    (frame.max_bounces, frame.albedo_threshold) = (max_bounces, albedo_threshold);
}

/// Puts the camera and the film into a frame, for a scene of these bounds.
pub(in crate::gpu) fn aim(frame: &mut layout::Frame, sensor: &Sensor, film: &FilmSettings, bounds: (DVec3, DVec3)) {
    let Sensor { position, target, up, projection, lens, shift } = *sensor;
    // In f64 like the reference: these are rounded once.
    let forward = (target.as_dvec3() - position.as_dvec3()).normalize();
    let right = forward.cross(up.as_dvec3()).normalize();
    let true_up = right.cross(forward);
    let aspect = f64::from(film.width) / f64::from(film.height);
    let half = match projection {
        Projection::Perspective { fov } => (f64::from(fov).to_radians() / 2.0).tan(),
        Projection::Orthographic { height } => f64::from(height) / 2.0,
    };
    let start = sensor.start(film, bounds);
    let (to_right, to_top) = (right * half * aspect, true_up * half);
    // To the middle of the picture, from that of the unshifted one.
    let shift = 2.0 * (f64::from(shift.x) * to_right + f64::from(shift.y) * to_top);
    let (begin, middle) = match projection {
        Projection::Perspective { .. } => (start * (forward + shift), forward + shift),
        Projection::Orthographic { .. } => (start * forward + shift, forward),
    };
    frame.position = vec4((position.as_dvec3() + begin).as_vec3());
    frame.start = start as f32;
    frame.forward = vec4(middle.as_vec3());
    frame.axis = vec4(forward.as_vec3());
    frame.right = vec4(to_right.as_vec3());
    frame.up = vec4(to_top.as_vec3());
    (frame.lens_radius, frame.focus_distance) = lens.map_or((0.0, 1.0), |lens| (lens.radius, lens.focus_distance));
    frame.lens_at_start = lens.map_or(1.0, |lens| (1.0 - start / f64::from(lens.focus_distance)) as f32);
    frame.lens_blades = lens.map_or(0.0, |lens| lens.blades as f32);
    frame.lens_rotation = lens.map_or(0.0, |lens| turns(lens.rotation));
    (frame.width, frame.height) = (film.width, film.height);
    for (knot, offset) in film.filter.inverse_cdf(film.filter_radius).into_iter().enumerate() {
        frame.filter_table[knot / 4][knot % 4] = offset;
    }
}

/// `v` with a fourth component that says nothing.
fn vec4(v: Vec3) -> [f32; 4] {
    v.extend(0.0).to_array()
}

/// Degrees as a part of a turn, in [0, 1).
fn turns(degrees: f32) -> f32 {
    (f64::from(degrees) / 360.0).rem_euclid(1.0) as f32
}
