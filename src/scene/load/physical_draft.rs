//! What makes a metallic-roughness surface of a material, while it is still being read: what nobody has said yet is `None`.

use super::map_draft::MapDraft;
use super::map_file::MapFile;
use super::mapped_number::{Mapped, Number};
use super::texture::Textures;
use crate::scene::{ChannelMap, Physical, PhysicalMaps};
use glam::Vec3;

/// What MTL and scene file say of a [`Physical`] surface, but for its base colour. Units and ranges are those of the fields of the same name.
#[derive(Debug, Clone, Default)]
pub(super) struct PhysicalDraft {
    pub metallic: Option<f32>,
    pub roughness: Option<f32>,
    pub anisotropy: Option<f32>,
    pub anisotropy_rotation: Option<f32>,
    pub ior: Option<f32>,
    pub specular: Option<f32>,
    pub specular_color: Option<Vec3>,
    pub conductor: Option<[Vec3; 2]>,
    pub transmission: Option<f32>,
    pub attenuation_color: Option<Vec3>,
    pub attenuation_distance: Option<f32>,
    pub clearcoat: Option<f32>,
    pub clearcoat_roughness: Option<f32>,
    pub sheen_color: Option<Vec3>,
    pub sheen_roughness: Option<f32>,
    pub iridescence: Option<f32>,
    pub iridescence_ior: Option<f32>,
    pub iridescence_thickness: Option<[f32; 2]>,
    pub dispersion: Option<f32>,
    /// The maps of all these.
    pub maps: PhysicalDraftMaps,
    /// The base colour that it has if it is a metal.
    pub metal_colour: Option<MetalColour>,
}

/// What an MTL file, which gives no other colour, says of the reflection (`Ks`): so metals are written.
#[derive(Debug, Clone)]
pub(super) struct MetalColour {
    /// `Ks`.
    pub colour: Option<Vec3>,
    /// `map_Ks`.
    pub map: MapDraft,
    /// The file.
    pub file: String,
}

/// The maps of a [`PhysicalDraft`].
#[derive(Debug, Clone, Default)]
pub(super) struct PhysicalDraftMaps {
    pub metallic: MapDraft,
    pub roughness: MapDraft,
    pub anisotropy: MapDraft,
    pub specular: MapDraft,
    pub specular_color: MapDraft,
    pub transmission: MapDraft,
    pub clearcoat: MapDraft,
    pub clearcoat_roughness: MapDraft,
    pub sheen_color: MapDraft,
    pub sheen_roughness: MapDraft,
    pub iridescence: MapDraft,
    pub iridescence_thickness: MapDraft,
}

/// All fields of a [`PhysicalDraftMaps`], or of a reference to one. Does not compile where one is missing.
macro_rules! all_of {
    ($maps:expr) => {
        all_of!($maps; metallic, roughness, anisotropy, specular, specular_color, transmission, clearcoat, clearcoat_roughness,
                sheen_color, sheen_roughness, iridescence, iridescence_thickness)
    };
    ($maps:expr; $($map:ident),*) => {{
        let PhysicalDraftMaps { $($map),* } = $maps;
        [$($map),*]
    }};
}

impl PhysicalDraftMaps {
    /// All of them.
    pub(super) fn all(&self) -> [&MapDraft; 12] {
        all_of!(self)
    }

    fn all_mut(&mut self) -> [&mut MapDraft; 12] {
        all_of!(self)
    }
}

impl PhysicalDraft {
    /// Its numbers and colours that have a map.
    pub(super) fn mapped(&mut self) -> [Mapped<'_>; 11] {
        let maps = &self.maps;
        let one = |key, map_key, number, map| Mapped { key, map_key, number: Number::One(number), map };
        let colour = |key, map_key, colour, map| Mapped { key, map_key, number: Number::Colour(colour), map };
        [
            one("metallic", "metallic_map", &mut self.metallic, &maps.metallic),
            one("roughness", "roughness_map", &mut self.roughness, &maps.roughness),
            one("anisotropy", "anisotropy_map", &mut self.anisotropy, &maps.anisotropy),
            one("specular", "specular_map", &mut self.specular, &maps.specular),
            colour("specular_colour", "specular_colour_map", &mut self.specular_color, &maps.specular_color),
            one("transmission", "transmission_map", &mut self.transmission, &maps.transmission),
            one("clearcoat", "clearcoat_map", &mut self.clearcoat, &maps.clearcoat),
            one(
                "clearcoat_roughness",
                "clearcoat_roughness_map",
                &mut self.clearcoat_roughness,
                &maps.clearcoat_roughness,
            ),
            colour("sheen_colour", "sheen_colour_map", &mut self.sheen_color, &maps.sheen_color),
            one("sheen_roughness", "sheen_roughness_map", &mut self.sheen_roughness, &maps.sheen_roughness),
            one("iridescence", "iridescence_map", &mut self.iridescence, &maps.iridescence),
        ]
    }

    /// Whether some of it is said to be nothing but metal.
    pub(super) fn is_metal(&self) -> bool {
        // A map that is not there says nothing.
        let map = self.maps.metallic.file().is_some_and(|map| map.path().is_some());
        let missing = if map || self.conductor.is_some() { 1.0 } else { 0.0 };
        let metallic = self.metallic.unwrap_or(missing);
        metallic == 1.0 || map && metallic > 0.0
    }

    /// Replaces what `other` states. What it makes a metal, or gives a colour of its reflection, is not left without either by a number of before.
    pub(super) fn overlay(&mut self, other: &PhysicalDraft) {
        if other.conductor.is_some() {
            // A map goes on saying where.
            self.metallic = None;
        }
        let tinted = other.specular_color.is_some_and(|colour| colour != Vec3::ZERO);
        if self.specular == Some(0.0) && (tinted || other.maps.specular_color.file().is_some()) {
            self.specular = None;
        }
        self.metallic = other.metallic.or(self.metallic);
        self.roughness = other.roughness.or(self.roughness);
        self.anisotropy = other.anisotropy.or(self.anisotropy);
        self.anisotropy_rotation = other.anisotropy_rotation.or(self.anisotropy_rotation);
        self.ior = other.ior.or(self.ior);
        self.specular = other.specular.or(self.specular);
        self.specular_color = other.specular_color.or(self.specular_color);
        self.conductor = other.conductor.or(self.conductor);
        self.transmission = other.transmission.or(self.transmission);
        self.attenuation_color = other.attenuation_color.or(self.attenuation_color);
        self.attenuation_distance = other.attenuation_distance.or(self.attenuation_distance);
        self.clearcoat = other.clearcoat.or(self.clearcoat);
        self.clearcoat_roughness = other.clearcoat_roughness.or(self.clearcoat_roughness);
        self.sheen_color = other.sheen_color.or(self.sheen_color);
        self.sheen_roughness = other.sheen_roughness.or(self.sheen_roughness);
        self.iridescence = other.iridescence.or(self.iridescence);
        self.iridescence_ior = other.iridescence_ior.or(self.iridescence_ior);
        self.iridescence_thickness = other.iridescence_thickness.or(self.iridescence_thickness);
        self.dispersion = other.dispersion.or(self.dispersion);
        self.maps.all_mut().into_iter().zip(other.maps.all()).for_each(|(map, other)| map.overlay(other));
    }

    /// Fills in the defaults and loads the maps; what is guessed, does nothing or is not modelled is a warning. The base colour is left white, without a map.
    ///
    /// A missing number whose map is given is 1, unless the map cannot be used. A `conductor` is a metal unless `metallic` says otherwise.
    pub(super) fn finish(
        &self,
        name: &str,
        thin: bool,
        textures: &mut Textures,
        warnings: &mut Vec<String>,
    ) -> Physical {
        let default = Physical::default();
        let or_one = |number: Option<f32>, map: &MapDraft, default: f32| {
            number.unwrap_or(if map.file().is_some() { 1.0 } else { default })
        };
        let maps = &self.maps;
        let metal = if self.conductor.is_some() { 1.0 } else { default.metallic };
        let white_if = |map: &MapDraft| if map.file().is_some() { Vec3::ONE } else { Vec3::ZERO };
        let mut surface = Physical {
            metallic: or_one(self.metallic, &maps.metallic, metal),
            roughness: or_one(self.roughness, &maps.roughness, default.roughness),
            anisotropy: or_one(self.anisotropy, &maps.anisotropy, default.anisotropy),
            anisotropy_rotation: self.anisotropy_rotation.unwrap_or(default.anisotropy_rotation),
            ior: self.ior.unwrap_or(default.ior),
            specular: self.specular.unwrap_or(default.specular),
            specular_color: self.specular_color.unwrap_or(default.specular_color),
            conductor: self.conductor,
            transmission: or_one(self.transmission, &maps.transmission, default.transmission),
            attenuation_color: self.attenuation_color.unwrap_or(default.attenuation_color),
            attenuation_distance: self.attenuation_distance.unwrap_or(default.attenuation_distance),
            clearcoat: or_one(self.clearcoat, &maps.clearcoat, default.clearcoat),
            clearcoat_roughness: or_one(
                self.clearcoat_roughness,
                &maps.clearcoat_roughness,
                default.clearcoat_roughness,
            ),
            sheen_color: self.sheen_color.unwrap_or(white_if(&maps.sheen_color)),
            sheen_roughness: or_one(self.sheen_roughness, &maps.sheen_roughness, default.sheen_roughness),
            iridescence: or_one(self.iridescence, &maps.iridescence, default.iridescence),
            iridescence_ior: self.iridescence_ior.unwrap_or(default.iridescence_ior),
            iridescence_thickness: self.iridescence_thickness.unwrap_or(default.iridescence_thickness),
            dispersion: self.dispersion.unwrap_or(default.dispersion),
            ..default
        };
        surface.maps = self.load_maps(&surface, textures, warnings);
        self.without_lost_maps(name, metal, &mut surface, warnings);
        if surface.ior == 0.0 && surface.transmission > 0.0 {
            surface.transmission = 0.0;
            warnings.push(format!(
                "material `{name}`: `ior = 0` stands for a surface that only reflects, so that nothing is transmitted; give it an index of at least 1"
            ));
        }
        self.warn_of_idle(name, thin, &surface, warnings);
        surface.sheen_color =
            bounded(surface.sheen_color, surface.maps.sheen_color, "sheen colour", name, textures, warnings);
        let missing = surface.not_modelled();
        if !missing.is_empty() {
            warnings.push(format!("material `{name}`: not modelled, ignored: {}", missing.join(", ")));
        }
        surface
    }

    /// Numbers that would be 1 beside a map which cannot be used are what they are without one; `metal` is the share of metal then.
    fn without_lost_maps(&self, name: &str, metal: f32, surface: &mut Physical, warnings: &mut Vec<String>) {
        let (default, maps, loaded) = (Physical::default(), &self.maps, surface.maps);
        let (coat, sheen) = (surface.clearcoat > 0.0, surface.sheen_color != Vec3::ZERO);
        let lost =
            |stated: Option<f32>, map: &MapDraft, there: bool| stated.is_none() && map.file().is_some() && !there;
        let coat_roughness =
            lost(self.clearcoat_roughness, &maps.clearcoat_roughness, loaded.clearcoat_roughness.is_some());
        let sheen_roughness = lost(self.sheen_roughness, &maps.sheen_roughness, loaded.sheen_roughness.is_some());
        let numbers = [
            ("metallic", lost(self.metallic, &maps.metallic, loaded.metallic.is_some())),
            ("roughness", lost(self.roughness, &maps.roughness, loaded.roughness.is_some())),
            ("anisotropy", lost(self.anisotropy, &maps.anisotropy, loaded.anisotropy.is_some())),
            ("transmission", lost(self.transmission, &maps.transmission, loaded.transmission.is_some())),
            ("clearcoat", lost(self.clearcoat, &maps.clearcoat, loaded.clearcoat.is_some())),
            ("clearcoat_roughness", coat && coat_roughness),
            ("sheen_roughness", sheen && sheen_roughness),
            ("iridescence", lost(self.iridescence, &maps.iridescence, loaded.iridescence.is_some())),
        ];
        let places = [
            (&mut surface.metallic, metal),
            (&mut surface.roughness, default.roughness),
            (&mut surface.anisotropy, default.anisotropy),
            (&mut surface.transmission, default.transmission),
            (&mut surface.clearcoat, default.clearcoat),
            (&mut surface.clearcoat_roughness, default.clearcoat_roughness),
            (&mut surface.sheen_roughness, default.sheen_roughness),
            (&mut surface.iridescence, default.iridescence),
        ];
        let mut said = Vec::new();
        for ((key, lost), (number, default)) in numbers.into_iter().zip(places) {
            if lost {
                *number = default;
                said.push(format!("`{key}` is {default}"));
            }
        }
        if lost(self.sheen_color.map(|colour| colour.x), &maps.sheen_color, loaded.sheen_color.is_some()) {
            surface.sheen_color = default.sheen_color;
            said.push("`sheen_colour` is black".into());
        }
        if !said.is_empty() {
            let said = said.join(", ");
            warnings
                .push(format!("material `{name}`: without the map that cannot be used {said}, as if none was named"));
        }
    }

    /// Warns of what is stated and does nothing.
    fn warn_of_idle(&self, name: &str, thin: bool, surface: &Physical, warnings: &mut Vec<String>) {
        let metal = surface.metallic == 1.0 && surface.maps.metallic.is_none();
        let transmits = surface.transmission > 0.0 && !metal;
        let film = self.iridescence_ior.is_some()
            || self.iridescence_thickness.is_some()
            || self.maps.iridescence_thickness.file().is_some();
        let coat_roughness = self.clearcoat_roughness.is_some() || self.maps.clearcoat_roughness.file().is_some();
        let sheen_roughness = self.sheen_roughness.is_some() || self.maps.sheen_roughness.file().is_some();
        let depth = self.attenuation_distance.is_some() || self.attenuation_color.is_some();
        let tinted_reflection = self.specular_color.is_some() || self.maps.specular_color.file().is_some();
        let tinted = self.attenuation_color.is_some_and(|colour| colour != Vec3::ONE);
        // Of a map that cannot be used enough is said.
        let none = |number: f32, map: &MapDraft| number == 0.0 && map.file().is_none();
        let idle = [
            (surface.transmission > 0.0 && metal, "`transmission`", "where `metallic` is 1"),
            (thin && !transmits, "`thin`", "without `transmission`"),
            (depth && !transmits, "attenuation", "without `transmission`"),
            (depth && transmits && thin, "attenuation", "where `thin` says that there is no inside"),
            (tinted && self.attenuation_distance.is_none(), "`attenuation_colour`", "without `attenuation_distance`"),
            (surface.dispersion > 0.0 && (!transmits || thin), "`dispersion`", "without a body that transmits"),
            (surface.conductor.is_some() && surface.metallic == 0.0, "`conductor`", "where `metallic` is 0"),
            (tinted_reflection && surface.specular == 0.0, "`specular_colour`", "where `specular` is 0"),
            (
                coat_roughness && none(surface.clearcoat, &self.maps.clearcoat),
                "`clearcoat_roughness`",
                "without `clearcoat`",
            ),
            (
                sheen_roughness && none(surface.sheen_color.max_element(), &self.maps.sheen_color),
                "`sheen_roughness`",
                "without `sheen_colour`",
            ),
            (
                film && none(surface.iridescence, &self.maps.iridescence),
                "the film of `iridescence`",
                "without `iridescence`",
            ),
            (
                self.anisotropy_rotation.is_some() && surface.anisotropy == 0.0,
                "`anisotropy_rotation`",
                "without `anisotropy`",
            ),
        ];
        for (_, key, why) in idle.iter().filter(|(idle, ..)| *idle) {
            warnings.push(format!("material `{name}`: {key} does nothing {why}"));
        }
    }

    /// Maps of numbers that are zero are not even looked for.
    fn load_maps(&self, surface: &Physical, textures: &mut Textures, warnings: &mut Vec<String>) -> PhysicalMaps {
        let maps = &self.maps;
        let mut number = |map: &MapDraft, wanted: bool| -> Option<ChannelMap> {
            textures.number(map.file().filter(|_| wanted)?, warnings)
        };
        let metallic = number(&maps.metallic, surface.metallic > 0.0);
        let roughness = number(&maps.roughness, surface.roughness > 0.0);
        let specular = number(&maps.specular, surface.specular > 0.0);
        let transmission = number(&maps.transmission, surface.transmission > 0.0);
        let clearcoat = number(&maps.clearcoat, surface.clearcoat > 0.0);
        let clearcoat_roughness =
            number(&maps.clearcoat_roughness, surface.clearcoat > 0.0 && surface.clearcoat_roughness > 0.0);
        let has_sheen = surface.sheen_color != Vec3::ZERO;
        let sheen_roughness = number(&maps.sheen_roughness, has_sheen && surface.sheen_roughness > 0.0);
        let iridescence = number(&maps.iridescence, surface.iridescence > 0.0);
        let iridescence_thickness = number(&maps.iridescence_thickness, surface.iridescence > 0.0);
        let mut colour = |map: &MapDraft, colour: Vec3| -> Option<u32> {
            let map: &MapFile = map.file().filter(|_| colour != Vec3::ZERO)?;
            textures.optional(map, warnings)
        };
        let specular_color = colour(&maps.specular_color, surface.specular * surface.specular_color);
        let sheen_color = colour(&maps.sheen_color, surface.sheen_color);
        let anisotropy = maps.anisotropy.file().filter(|_| surface.anisotropy > 0.0);
        PhysicalMaps {
            base_color: None,
            metallic,
            roughness,
            anisotropy: anisotropy.and_then(|map| textures.numbers(map, warnings)),
            specular,
            specular_color,
            transmission,
            clearcoat,
            clearcoat_roughness,
            sheen_color,
            sheen_roughness,
            iridescence,
            iridescence_thickness,
        }
    }
}

/// A colour that exceeds 1 neither by itself nor anywhere on its map, which would create energy: it is scaled down, with a warning.
pub(super) fn bounded(
    colour: Vec3,
    map: Option<u32>,
    what: &str,
    name: &str,
    textures: &Textures,
    warnings: &mut Vec<String>,
) -> Vec3 {
    let largest = map.map_or(Vec3::ONE, |map| textures.range(map).largest.max(Vec3::ONE));
    let before = (colour * largest).max_element();
    if before <= 1.0 {
        return colour;
    }
    let mut factor = 1.0 / before;
    while (colour * factor * largest).max_element() > 1.0 {
        factor *= 1.0 - f32::EPSILON;
    }
    // Below that it is rounding.
    if before > 1.000_01 {
        warnings.push(format!(
            "material `{name}` would create energy: its {what} reaches {before}; it is scaled by {factor:.4}"
        ));
    }
    colour * factor
}
