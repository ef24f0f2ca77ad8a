//! The physically based surface of scenes that people have: metallic-roughness, as glTF 2.0 and its material extensions describe it.

use glam::Vec3;

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
