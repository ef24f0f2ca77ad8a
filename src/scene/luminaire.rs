//! Points and light from infinity: luminaires that are no mesh. What is one is a triangle whose material emits.

use super::profile::Profile;
use glam::Vec3;
use std::sync::Arc;

/// A luminaire that is no mesh.
#[derive(Debug, Clone, PartialEq)]
pub enum Luminaire {
    /// An impulse in space.
    Point {
        /// World position.
        position: Vec3,
        /// Radiant intensity, in radiance times length squared.
        intensity: Vec3,
    },
    /// An impulse in direction: parallel light that does not attenuate.
    Infinite {
        /// Unit vector in which the light travels.
        direction: Vec3,
        /// Irradiance on a surface perpendicular to `direction`.
        irradiance: Vec3,
    },
    /// A point that shines into a cone with a soft edge, as the spot of glTF's `KHR_lights_punctual` ([`spot_edge`]).
    Spot {
        /// World position.
        position: Vec3,
        /// Unit vector along the axis, in which the light travels.
        direction: Vec3,
        /// Radiant intensity within the inner cone.
        intensity: Vec3,
        /// Degrees from the axis up to which the intensity is whole; at most `outer`.
        inner: f32,
        /// Degrees from the axis beyond which there is no light: [`LEAST_ANGLE`] to 90.
        outer: f32,
    },
    /// A disc at infinity, of the same radiance all over, which paths can meet; where discs overlap they add up.
    Sun {
        /// Unit vector in which the light from its middle travels.
        direction: Vec3,
        /// Irradiance on a surface perpendicular to `direction`.
        irradiance: Vec3,
        /// Its diameter in degrees: 0, which is [`Luminaire::Infinite`], or [`LEAST_ANGLE`] to 180.
        angle: f32,
    },
    /// A point with the intensities of a photometric file.
    Photometric {
        /// World position.
        position: Vec3,
        /// Unit vector in which the file's vertical angle of 0 looks: down, for a lamp that hangs as it was measured.
        direction: Vec3,
        /// The file's horizontal angle of 0 looks to the side on which this direction lies; not along `direction`.
        up: Vec3,
        /// What the candelas are multiplied by.
        intensity: Vec3,
        /// The candelas.
        profile: Arc<Profile>,
    },
}

/// The narrowest cone and the smallest disc, in degrees: the directions of single precision are a hundredth of this apart.
pub const LEAST_ANGLE: f32 = 1e-4;
/// One over the width of an edge that has none.
const SHARP: f64 = 1e30;

impl Luminaire {
    /// Whether any light comes from it.
    pub fn emits(&self) -> bool {
        match self {
            Luminaire::Point { intensity, .. } | Luminaire::Spot { intensity, .. } => intensity.element_sum() > 0.0,
            Luminaire::Infinite { irradiance, .. } | Luminaire::Sun { irradiance, .. } => {
                irradiance.element_sum() > 0.0
            }
            Luminaire::Photometric { intensity, profile, .. } => intensity.element_sum() > 0.0 && profile.flux() > 0.0,
        }
    }

    /// Whether paths can meet it.
    pub fn is_disc(&self) -> bool {
        matches!(self, Luminaire::Sun { angle, .. } if *angle > 0.0)
    }
}

/// One minus the cosine of an angle in degrees, without the cancellation.
pub fn one_minus_cos(degrees: f64) -> f64 {
    2.0 * (0.5 * degrees.to_radians()).sin().powi(2)
}

/// One minus the cosine of a spot's outer angle, and one over that less the inner one's: in between the intensity falls with the square of what is left to
/// the outer edge, over the whole width, both by cosines (Khronos, glTF 2.0, `KHR_lights_punctual`, "Inner and Outer Cone Angles":
/// `saturate(cd * scale + offset)^2`, without its least width of a thousandth, which would be wider than narrow cones are).
pub fn spot_edge(inner: f32, outer: f32) -> (f64, f64) {
    let edge = one_minus_cos(outer.into());
    // A product, so that close angles do not cancel: cos a - cos b.
    let [a, b] = [f64::from(inner), f64::from(outer)].map(f64::to_radians);
    let width = 2.0 * (0.5 * (a + b)).sin() * (0.5 * (b - a)).sin();
    (edge, (1.0 / width).min(SHARP))
}

/// Two unit vectors across the axis of a photometric luminaire: its horizontal angle of 0, and that of 90 degrees, counter-clockwise as seen along
/// `direction`, from above a lamp that hangs (IES LM-63-02, "Horizontal angles").
pub fn photometric_frame(direction: Vec3, up: Vec3) -> [glam::DVec3; 2] {
    let (direction, up) = (direction.as_dvec3(), up.as_dvec3());
    let zero = (up - up.dot(direction) * direction).try_normalize();
    let zero = zero.unwrap_or_else(|| direction.any_orthonormal_vector());
    [zero, zero.cross(direction)]
}
