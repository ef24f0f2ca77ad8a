//! The built-in sky, under which a model without a light of its own is looked at.

use super::EnvironmentImage;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

const WIDTH: u32 = 256;
const HEIGHT: u32 = 128;
/// Radiance at the horizon, and of all that is below it: a calm light grey, before which white still stands out.
const HORIZON: f64 = 0.4;
/// The albedo of level ground that is as bright as the horizon under this sky. White is then just not clipped.
pub(crate) const GROUND_ALBEDO: f64 = 0.45;
/// By how much brighter the zenith is, without the key light, as a share of the horizon's radiance. An overcast sky has 2.
const RISE: f64 = 0.25;
/// Towards the middle of the key light, of any length: up, from the left, and from behind a camera that looks along -z.
const KEY: DVec3 = DVec3::new(-0.3, 0.8, 0.7);
/// The angle from the middle of the key light at which it ends, in degrees: well above the horizon.
const KEY_EDGE: f64 = 32.0;
/// Radiances are multiples of this, so that the last bits of a sine, which differ between machines, do not show.
const STEP: f64 = 1.0 / 65536.0;

impl EnvironmentImage {
    /// The studio sky: grey, and the same at every place and on every machine.
    ///
    /// Radiance in a direction that is elevated by `e` above the horizon and `a` away from the middle of the key light:
    ///
    /// ```text
    /// 0.4 + 0.1 max(0, sin e) + k max(0, (cos a - cos 32°) / (1 - cos 32°))²
    /// ```
    ///
    /// The first two terms are the overcast sky of Moon and Spencer ("Illumination from a non-uniform sky", 1942), whose luminance is linear in the sine of
    /// the elevation, but flatter, and with a lower half as bright as the horizon. The key light comes from (-0.3, 0.8, 0.7). Its `k`, 5.982, is such that level
    /// ground of albedo 0.45 has the radiance of the horizon and cannot be told from the sky.
    pub fn studio() -> Self {
        let key = KEY.normalize();
        // The integrals over the key light of its radiance times the cosine to its middle, and of a level surface's cosine; k is 1.
        let edge = KEY_EDGE.to_radians().cos();
        let width = 1.0 - edge;
        let facing = 2.0 * PI * width * (edge / 3.0 + width / 4.0);
        let overcast = PI * HORIZON * (1.0 + 2.0 / 3.0 * RISE);
        let k = (PI * HORIZON / GROUND_ALBEDO - overcast) / (facing * key.y);
        let radiance = |direction: DVec3| {
            let lobe = ((direction.dot(key) - edge) / width).max(0.0);
            let radiance = HORIZON * (1.0 + RISE * direction.y.max(0.0)) + k * lobe * lobe;
            (radiance / STEP).round() * STEP
        };
        let direction = |x: u32, y: u32| {
            let theta = PI * (f64::from(y) + 0.5) / f64::from(HEIGHT);
            let phi = 2.0 * PI * (f64::from(x) + 0.5) / f64::from(WIDTH);
            // The middle of the image is -z, its right half +x.
            DVec3::new(-theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos())
        };
        let texels = (0..WIDTH * HEIGHT).map(|i| Vec3::splat(radiance(direction(i % WIDTH, i / WIDTH)) as f32));
        EnvironmentImage { name: "studio".into(), width: WIDTH, height: HEIGHT, texels: texels.collect() }
    }
}
