//! What surfaces are made of.

use super::physical::{Physical, PhysicalMaps};
use glam::{DVec3, Vec3};

/// The surface's scattering and emission: normalised Blinn-Phong (slide "Surface Element Class") and impulses (slides "Impulse
/// Reflection", "Adding Transmission").
///
/// In every channel, each times the largest texel of its map, `lambert + glossy + max(reflection, transmission) <= 1`; for a coated base
/// ([`Material::is_coated`]) `reflection <= 1` and `lambert + glossy <= 1`. The loader scales down what exceeds it and warns.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The name in the MTL or scene file.
    pub name: String,
    /// Albedo for the ambient stand-in of the simple ray tracer (`Ka`).
    pub ambient: Vec3,
    /// Diffuse albedo (`Kd`).
    pub lambert: Vec3,
    /// Glossy albedo at normal incidence (`Ks`).
    pub glossy: Vec3,
    /// Blinn-Phong exponent, 0 to 1e8 (`Ns`).
    pub exponent: f32,
    /// Emitted radiance (`Ke`).
    pub emission: Vec3,
    /// Whether only the outward side emits: the one from which the corners are seen counter-clockwise, or to which the vertex normals
    /// point.
    pub one_sided: bool,
    /// Albedo of the impulse reflection: all of it at every angle without `eta` (a mirror), times Fresnel's reflectance with it.
    pub reflection: Vec3,
    /// Albedo of the impulse transmission, times one minus Fresnel's reflectance (`Tf`); zero without `eta`.
    pub transmission: Vec3,
    /// Index of refraction of what lies behind the outward normal over that in front of it (`Ni`), 0.01 to 100; none: no
    /// Fresnel, no transmission. Where nothing is transmitted nobody is behind: it is the same from both sides.
    pub eta: Option<f32>,
    /// Whether the surface is a sheet, such as a window pane, whose two sides are one: it reflects `2 F / (1 + F)`, with `F` Fresnel's
    /// reflectance of either side, and lets the rest through without bending it. Which side is outward makes no difference.
    pub thin: bool,
    /// Probability with which a path takes an impulse where there is something else too, in (0, 1); none: the impulses' share of the
    /// albedo at that angle. It changes the noise, never the mean.
    pub impulse_probability: Option<f32>,
    /// Share of light that meets the surface at all, 0 (a hole) to 1 (`d`); the rest passes straight on.
    pub opacity: f32,
    /// Textures that multiply the numbers above.
    pub maps: Maps,
    /// A texture that bends the shading normal; none: nothing does.
    pub normal_map: Option<NormalMap>,
    /// A texture of heights, whose slopes bend it after that.
    pub bump_map: Option<BumpMap>,
    /// The metallic-roughness surface that scatters in place of all albedos above; none: what the lecture describes.
    pub physical: Option<Physical>,
}

/// Indices into [`Scene::textures`](super::Scene::textures); each texture multiplies the number of the same name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Maps {
    /// `map_Ka`.
    pub ambient: Option<u32>,
    /// `map_Kd`.
    pub lambert: Option<u32>,
    /// `map_Ks`.
    pub glossy: Option<u32>,
    /// `map_Ke`.
    pub emission: Option<u32>,
    /// `map_d`, or the alpha of `map_Kd`: the texture's alpha channel counts.
    pub opacity: Option<u32>,
}

impl Default for Material {
    /// Black and opaque.
    fn default() -> Self {
        Material {
            name: String::new(),
            ambient: Vec3::ZERO,
            lambert: Vec3::ZERO,
            glossy: Vec3::ZERO,
            exponent: 0.0,
            emission: Vec3::ZERO,
            one_sided: false,
            reflection: Vec3::ZERO,
            transmission: Vec3::ZERO,
            eta: None,
            thin: false,
            impulse_probability: None,
            opacity: 1.0,
            maps: Maps::default(),
            normal_map: None,
            bump_map: None,
            physical: None,
        }
    }
}

/// A map of normals in tangent space, as glTF has it: red, green and blue from [0, 1] to [-1, 1] are the parts of the normal along the tangent (u), the bitangent
/// (v, which points up in the image) and the surface's own normal. The numbers are linear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalMap {
    /// Index into [`Scene::textures`](super::Scene::textures).
    pub texture: u32,
    /// Factor to the parts along tangent and bitangent.
    pub scale: f32,
}

/// A map of heights above the surface, which change nothing but its shading normal (Blinn, "Simulation of Wrinkled Surfaces", 1978).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BumpMap {
    /// Index into [`Scene::textures`](super::Scene::textures); a height is the sum of red and green, which hold its upper and its lower digits.
    pub texture: u32,
    /// World length of a height of 1, whatever the instance's scale.
    pub scale: f32,
}

impl Material {
    /// Whether light goes through the surface, beside what its opacity lets pass.
    pub fn transmits(&self) -> bool {
        let physical = self.physical.as_ref();
        physical.is_some_and(|physical| physical.transmission > 0.0 && physical.metallic < 1.0 && physical.ior != 0.0)
            || (self.transmission != Vec3::ZERO && self.eta.is_some())
    }

    /// Whether anything is mirrored or refracted, unscattered.
    pub fn has_impulse(&self) -> bool {
        match &self.physical {
            Some(physical) => physical.may_be_smooth(),
            None => self.reflection != Vec3::ZERO || self.transmits(),
        }
    }

    /// The index of refraction of what lies behind the outward normal over that in front of it; none: there is no Fresnel, or it is infinite.
    pub fn index_of_refraction(&self) -> Option<f32> {
        self.physical.as_ref().map_or(self.eta, |physical| Some(physical.ior).filter(|ior| *ior > 0.0))
    }

    /// Whether light that passes is bent, so that the surface has to be that of a closed body.
    pub fn bends(&self) -> bool {
        self.transmits() && self.index_of_refraction() != Some(1.0) && !self.thin
    }

    /// Whether the surface is that of a body that light goes through, which its faces have to enclose.
    pub fn is_body(&self) -> bool {
        self.transmits() && !self.thin
    }

    /// Whether the surface is that of a body that absorbs what goes through it.
    pub fn absorbs(&self) -> bool {
        self.is_body() && self.physical.as_ref().is_some_and(|physical| physical.absorption() != DVec3::ZERO)
    }

    /// Whether the surface is a sheet that lets light through: [`Material::thin`] says nothing of what transmits nothing.
    pub fn is_sheet(&self) -> bool {
        self.thin && self.transmits()
    }

    /// Whether what is diffuse and glossy lies under a smooth dielectric: then it gets, and gives away, what Fresnel does not reflect. A
    /// mirror without `eta`, and what transmits, lie beside it instead.
    pub fn is_coated(&self) -> bool {
        let base = self.lambert != Vec3::ZERO || self.glossy != Vec3::ZERO;
        base && self.reflection != Vec3::ZERO && self.eta.is_some() && self.transmission == Vec3::ZERO
    }

    /// Whether a texture bends the shading normal.
    pub fn bends_normal(&self) -> bool {
        self.normal_map.is_some() || self.bump_map.is_some()
    }

    /// Whether what it does depends on the direction in which the texture's u grows.
    pub fn needs_tangents(&self) -> bool {
        self.normal_map.is_some() || self.physical.as_ref().is_some_and(Physical::needs_tangents)
    }

    /// Whether any of its numbers has a texture, or its normal.
    pub fn has_maps(&self) -> bool {
        let physical = self.physical.as_ref().is_some_and(|physical| physical.maps != PhysicalMaps::default());
        physical || self.maps != Maps::default() || self.bends_normal()
    }

    /// Whether nothing is scattered, so that which way the surface faces makes no difference.
    pub fn is_black(&self) -> bool {
        self.physical.is_none() && self.lambert == Vec3::ZERO && self.glossy == Vec3::ZERO && !self.has_impulse()
    }

    /// Whether a ray may pass the surface as if it were not there.
    pub fn has_holes(&self) -> bool {
        self.opacity < 1.0 || self.maps.opacity.is_some()
    }
}
