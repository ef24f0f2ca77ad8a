//! The physically based surface of scenes that people have: metallic-roughness, as glTF 2.0 and its material extensions describe it.

use glam::{DVec3, Vec3};

/// A metallic-roughness surface (Khronos, glTF 2.0, section 3.9 and appendix B, with the extensions `KHR_materials_*` named below). Where a material
/// has one, it is all that scatters: the Blinn-Phong numbers and impulses of [`Material`](super::Material) beside it are zero; emission, opacity, `one_sided` and
/// `thin` are the material's own.
///
/// Colours are linear. Each number is multiplied by its map, if it has one ([`PhysicalMaps`]).
#[derive(Debug, Clone, PartialEq)]
pub struct Physical {
    /// Albedo of the dielectric's inside, reflectance at normal incidence of the metal, and tint of what is transmitted; 0 to 1. Vertex colours multiply it.
    pub base_color: Vec3,
    /// How much of the surface is metal, 0 to 1.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1: `alpha = roughness^2` is the width of GGX. At 0 the surface is smooth: an impulse.
    pub roughness: f32,
    /// `KHR_materials_anisotropy`: strength, 0 to 1: along the direction below `alpha` goes from `roughness^2` to 1.
    pub anisotropy: f32,
    /// The direction in which the surface is rougher, counter-clockwise from the tangent; radians.
    pub anisotropy_rotation: f32,
    /// `KHR_materials_ior`: index of refraction of what lies behind the outward normal, at least 1, or 0: the specular reflection is all of
    /// `specular_color`, as of an infinite index.
    pub ior: f32,
    /// `KHR_materials_specular`: strength of the dielectric's reflection, 0 to 1.
    pub specular: f32,
    /// `KHR_materials_specular`: its tint at normal incidence, 0 or more; at grazing it is white.
    pub specular_color: Vec3,
    /// A metal's index of refraction and extinction coefficient (eta, k), channel by channel, in place of the base colour with Schlick's formula.
    pub conductor: Option<[Vec3; 2]>,
    /// `KHR_materials_transmission`: share of the light that enters the dielectric and goes through it instead of being scattered diffusely, 0 to 1. Of a `thin`
    /// material it goes straight on, spread by the roughness; of a body it is refracted.
    pub transmission: f32,
    /// `KHR_materials_volume`: colour that white light has behind [`Self::attenuation_distance`] of the body (Beer's law); above 0, at most 1.
    pub attenuation_color: Vec3,
    /// World length in which that happens; infinite: a clear body.
    pub attenuation_distance: f32,
    /// `KHR_materials_clearcoat`: strength of a dielectric layer of index 1.5 above all this, 0 to 1.
    pub clearcoat: f32,
    /// Its perceptual roughness, 0 to 1.
    pub clearcoat_roughness: f32,
    /// `KHR_materials_sheen`: albedo of the fibres above the base, 0 to 1.
    pub sheen_color: Vec3,
    /// Their perceptual roughness, 0 to 1.
    pub sheen_roughness: f32,
    /// `KHR_materials_iridescence`: strength of a thin film, 0 to 1.
    pub iridescence: f32,
    /// The film's index of refraction, at least 1.
    pub iridescence_ior: f32,
    /// The film's thickness in nanometres; where it has a map, from the least (texel 0) to the greatest (texel 1).
    pub iridescence_thickness: [f32; 2],
    /// `KHR_materials_dispersion`: 20 over Abbe's number; 0: all wavelengths are bent alike.
    pub dispersion: f32,
    /// The textures of all these.
    pub maps: PhysicalMaps,
}

impl Physical {
    /// Whether it scatters differently along the tangent and across it.
    pub fn needs_tangents(&self) -> bool {
        self.anisotropy != 0.0
    }
}

/// The textures of a [`Physical`] surface; each multiplies the number of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PhysicalMaps {
    /// A colour. (Its alpha is the material's opacity map.)
    pub base_color: Option<u32>,
    /// glTF has it in blue.
    pub metallic: Option<ChannelMap>,
    /// glTF has it in green.
    pub roughness: Option<ChannelMap>,
    /// Red and green: a direction, from [0, 1] to [-1, 1], by which the rotation is turned; blue: the strength.
    pub anisotropy: Option<u32>,
    /// glTF has it in alpha.
    pub specular: Option<ChannelMap>,
    /// A colour.
    pub specular_color: Option<u32>,
    /// glTF has it in red.
    pub transmission: Option<ChannelMap>,
    /// glTF has it in red.
    pub clearcoat: Option<ChannelMap>,
    /// glTF has it in green.
    pub clearcoat_roughness: Option<ChannelMap>,
    /// A colour.
    pub sheen_color: Option<u32>,
    /// glTF has it in alpha.
    pub sheen_roughness: Option<ChannelMap>,
    /// glTF has it in red.
    pub iridescence: Option<ChannelMap>,
    /// glTF has it in green.
    pub iridescence_thickness: Option<ChannelMap>,
}

impl PhysicalMaps {
    /// Whether there is one.
    pub fn any(&self) -> bool {
        *self != PhysicalMaps::default()
    }
}

/// One channel of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChannelMap {
    /// Index into [`Scene::textures`](super::Scene::textures).
    pub texture: u32,
    /// 0: red, 1: green, 2: blue, 3: alpha.
    pub channel: u8,
}

impl Default for Physical {
    /// glTF's defaults, but a dielectric of roughness 0.5: what Blender calls Principled when nothing is set.
    fn default() -> Self {
        Physical {
            base_color: Vec3::ONE,
            metallic: 0.0,
            roughness: 0.5,
            anisotropy: 0.0,
            anisotropy_rotation: 0.0,
            ior: 1.5,
            specular: 1.0,
            specular_color: Vec3::ONE,
            conductor: None,
            transmission: 0.0,
            attenuation_color: Vec3::ONE,
            attenuation_distance: f32::INFINITY,
            clearcoat: 0.0,
            clearcoat_roughness: 0.0,
            sheen_color: Vec3::ZERO,
            sheen_roughness: 0.0,
            iridescence: 0.0,
            iridescence_ior: 1.3,
            iridescence_thickness: [100.0, 400.0],
            dispersion: 0.0,
            maps: PhysicalMaps::default(),
        }
    }
}

/// A lobe of microfacets narrower than this, in its `alpha`, is an impulse. Not 1e-4, which single precision rounds the square of a roughness of 0.01 to: what is an
/// impulse in one tracer is one in all of them.
pub const LEAST_ALPHA: f64 = 1.01e-4;

/// The index of refraction of a coat.
pub const COAT_INDEX: f64 = 1.5;

impl Physical {
    /// Absorption coefficient inside, per unit of length and channel: 0 is clear.
    pub fn absorption(&self) -> DVec3 {
        let log = -DVec3::from_array(self.attenuation_color.as_dvec3().to_array().map(f64::ln));
        if self.attenuation_distance > 0.0 && self.attenuation_distance.is_finite() {
            log / f64::from(self.attenuation_distance)
        } else {
            DVec3::ZERO
        }
    }

    /// Whether the surface may be smooth somewhere, so that there is an impulse in place of its narrowest microfacets: a map may make it so.
    pub fn may_be_smooth(&self) -> bool {
        let smooth = |roughness: f32, map: bool| map || f64::from(roughness).powi(2) < LEAST_ALPHA;
        smooth(self.roughness, self.maps.roughness.is_some())
            || (self.clearcoat > 0.0 && smooth(self.clearcoat_roughness, self.maps.clearcoat_roughness.is_some()))
            // What is hardly bent goes straight on.
            || (self.transmission > 0.0 && f64::from(self.roughness).powi(2) * f64::from(self.ior - 1.0) < LEAST_ALPHA)
    }

    /// What is asked for and not traced: names for a warning, in the words of the extensions of glTF.
    pub fn not_modelled(&self) -> Vec<&'static str> {
        let film = self.iridescence > 0.0;
        let fibres = self.sheen_color != Vec3::ZERO;
        let all = [
            ("sheen", fibres),
            ("iridescence", film),
            ("dispersion", self.dispersion > 0.0 && self.transmission > 0.0),
        ];
        all.into_iter().filter(|(_, asked)| *asked).map(|(name, _)| name).collect()
    }
}

/// Reflectance of a smooth metal for unpolarised light: Fresnel's equations for an index of refraction `eta` with the extinction coefficient `k`.
pub fn conductor_reflectance(eta: f64, k: f64, cos_i: f64) -> f64 {
    let (c2, s2) = (cos_i * cos_i, 1.0 - cos_i * cos_i);
    // eta^2 - k^2 - s2, without its cancellation.
    let t0 = (eta - 1.0) * (eta + 1.0) - k * k + c2;
    let ab = (t0 * t0 + 4.0 * eta * eta * k * k).sqrt();
    let a = (0.5 * (ab + t0)).max(0.0).sqrt();
    // No index at all, and grazing light on an index of 1, are limits.
    let over = |less: f64, sum: f64| if sum > 0.0 { less / sum } else { 1.0 };
    let s = over(ab + c2 - 2.0 * cos_i * a, ab + c2 + 2.0 * cos_i * a);
    let p = s * over(c2 * ab + s2 * s2 - 2.0 * cos_i * s2 * a, c2 * ab + s2 * s2 + 2.0 * cos_i * s2 * a);
    0.5 * (s + p)
}

/// The same, averaged over directions in proportion to their cosine: `2 int_0^1 F(cos) cos dcos`, by Simpson's rule.
pub fn conductor_average(eta: f64, k: f64) -> f64 {
    const STEPS: u32 = 64;
    let at = |step: u32| {
        let cos = f64::from(step) / f64::from(STEPS);
        2.0 * cos * conductor_reflectance(eta, k, cos)
    };
    let odd: f64 = (1..STEPS).step_by(2).map(at).sum();
    let even: f64 = (2..STEPS).step_by(2).map(at).sum();
    (at(0) + 4.0 * odd + 2.0 * even + at(STEPS)) / (3.0 * f64::from(STEPS))
}
