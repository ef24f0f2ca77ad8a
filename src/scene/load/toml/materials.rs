//! The tables `[[material]]` of a scene file.

use super::advice::name_hint;
use super::file::File;
use super::radians;
use super::tables::{ConductorEntry, MapChannel, MapEntry, MaterialTable, Model, PlacedMap};
use super::values::Transmission;
use crate::scene::load::map_file::{Channel, MapFile, scaled_and_moved};
use crate::scene::load::material_draft::{Draft, DraftMaps, MapDraft};
use crate::scene::load::metals;
use crate::scene::load::near_name::instead_of;
use crate::scene::load::physical_draft::{PhysicalDraft, PhysicalDraftMaps};
use crate::scene::load::text_file::{line_and_column, shortened};
use crate::{Error, Result};
use ::toml::Spanned;
use ::toml::de::{DeTable, DeValue};
use glam::{Vec2, Vec3};
use std::collections::HashSet;
use std::ops::Range;

/// What the texels of a map are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum MapOf {
    Colours,
    /// Of which one channel counts.
    Number,
    /// Of which all channels count.
    Numbers,
}

impl File<'_> {
    /// What the tables say, in their order.
    pub(super) fn materials(&self, tables: &[MaterialTable]) -> Result<Vec<Draft>> {
        let mut names = HashSet::new();
        for table in tables {
            let name = table.name.get_ref();
            if !names.insert(name) {
                return Err(self.error(table.name.span(), format!("a second [[material]] named `{name}`")));
            }
        }
        (0..).zip(tables).map(|(number, table)| self.material(number, table)).collect()
    }

    /// The table of this number.
    fn material(&self, number: usize, table: &MaterialTable) -> Result<Draft> {
        let of_blinn_phong = blinn_phong_keys(table);
        let physical = self.physical(table)?;
        let of_physical = physical_keys(table);
        let stated = |model: Model| (table.model == Some(model)).then_some("model");
        // What says so outright before what means so.
        let blinn_phong = stated(Model::BlinnPhong).or(of_blinn_phong.first().copied());
        let metallic_roughness = stated(Model::MetallicRoughness).or(of_physical.first().copied());
        if let (Some(one), Some(other)) = (blinn_phong, metallic_roughness) {
            return Err(self.two_models(number, one, other));
        }
        let at = blinn_phong.map(|key| {
            let (line, _) = line_and_column(self.text, self.key(number, key).start);
            (key, format!("{}:{line}", self.path.display()))
        });
        let transmission = table.transmission.and_then(|transmission| match transmission {
            Transmission::Albedo(colour) => Some(colour),
            Transmission::Share(_) => None,
        });
        let diffuse = table.diffuse.map(|colour| colour.0);
        let base_map = if table.base_colour_map.is_some() { &table.base_colour_map } else { &table.diffuse_map };
        let mut draft = Draft {
            name: table.name.get_ref().clone(),
            ambient: table.ambient.map(|colour| colour.0),
            diffuse: diffuse.or(table.base_colour.map(|colour| colour.0)),
            glossy: table.glossy.map(|colour| colour.0),
            exponent: table.exponent.map(|exponent| exponent.0),
            emission: table.emission.map(|colour| colour.0),
            one_sided: table.one_sided,
            reflection: table.reflection.map(|colour| colour.0),
            transmission,
            eta: table.eta.map(|eta| eta.0),
            thin: table.thin,
            impulse_probability: table.impulse_probability.map(|probability| probability.0),
            opacity: table.opacity.map(|opacity| opacity.0),
            normal_scale: table.normal_scale.as_ref().map(|scale| scale.get_ref().0),
            bump_scale: table.bump_scale.as_ref().map(|scale| scale.get_ref().0),
            maps: DraftMaps {
                ambient: self.map(&table.ambient_map, MapOf::Colours)?,
                diffuse: self.map(base_map, MapOf::Colours)?,
                glossy: self.map(&table.glossy_map, MapOf::Colours)?,
                emission: self.map(&table.emission_map, MapOf::Colours)?,
                opacity: self.map(&table.opacity_map, MapOf::Number)?,
                normal: self.map(&table.normal_map, MapOf::Numbers)?,
                bump: self.map(&table.bump_map, MapOf::Number)?,
            },
            physical: metallic_roughness.map(|_| Box::new(physical)),
            blinn_phong: at,
            ..Draft::default()
        };
        draft.notes = draft.idle_maps();
        let turned = table.anisotropy_rotation.and_then(|turn| radians::turn("anisotropy_rotation", turn.0 as f32));
        draft.notes.extend(turned.map(|warning| {
            let (line, _) = line_and_column(self.text, self.key(number, "anisotropy_rotation").start);
            format!("{}:{line}: {warning}", self.path.display())
        }));
        Ok(draft)
    }

    /// What only a metallic-roughness surface has, but for its base colour.
    fn physical(&self, table: &MaterialTable) -> Result<PhysicalDraft> {
        let share = table.transmission.and_then(|transmission| match transmission {
            Transmission::Share(share) => Some(share),
            Transmission::Albedo(_) => None,
        });
        Ok(PhysicalDraft {
            metallic: table.metallic.map(|metallic| metallic.0),
            roughness: table.roughness.map(|roughness| roughness.0),
            anisotropy: table.anisotropy.map(|strength| strength.0),
            anisotropy_rotation: table.anisotropy_rotation.map(|degrees| degrees.0.to_radians() as f32),
            ior: table.ior.map(|ior| ior.0),
            specular: table.specular.map(|specular| specular.0),
            specular_color: table.specular_colour.map(|colour| colour.0),
            conductor: table.conductor.as_ref().map(|entry| self.conductor(entry)).transpose()?,
            transmission: share,
            attenuation_color: table.attenuation_colour.map(|colour| colour.0),
            attenuation_distance: table.attenuation_distance.map(|distance| distance.0),
            clearcoat: table.clearcoat.map(|coat| coat.0),
            clearcoat_roughness: table.clearcoat_roughness.map(|roughness| roughness.0),
            sheen_color: table.sheen_colour.map(|colour| colour.0),
            sheen_roughness: table.sheen_roughness.map(|roughness| roughness.0),
            iridescence: table.iridescence.map(|strength| strength.0),
            iridescence_ior: table.iridescence_ior.map(|ior| ior.0),
            iridescence_thickness: table.iridescence_thickness.map(|thickness| thickness.0),
            dispersion: table.dispersion.map(|dispersion| dispersion.0),
            metal_colour: None,
            maps: PhysicalDraftMaps {
                metallic: self.map(&table.metallic_map, MapOf::Number)?,
                roughness: self.map(&table.roughness_map, MapOf::Number)?,
                anisotropy: self.map(&table.anisotropy_map, MapOf::Numbers)?,
                specular: self.map(&table.specular_map, MapOf::Number)?,
                specular_color: self.map(&table.specular_colour_map, MapOf::Colours)?,
                transmission: self.map(&table.transmission_map, MapOf::Number)?,
                clearcoat: self.map(&table.clearcoat_map, MapOf::Number)?,
                clearcoat_roughness: self.map(&table.clearcoat_roughness_map, MapOf::Number)?,
                sheen_color: self.map(&table.sheen_colour_map, MapOf::Colours)?,
                sheen_roughness: self.map(&table.sheen_roughness_map, MapOf::Number)?,
                iridescence: self.map(&table.iridescence_map, MapOf::Number)?,
                iridescence_thickness: self.map(&table.iridescence_thickness_map, MapOf::Number)?,
            },
        })
    }

    /// A metal by its name, or by its numbers.
    fn conductor(&self, entry: &Spanned<ConductorEntry>) -> Result<[Vec3; 2]> {
        let name = match entry.get_ref() {
            ConductorEntry::Numbers(table) => return Ok([table.eta.0, table.k.0]),
            ConductorEntry::Metal(name) => name,
        };
        metals::by_name(name).ok_or_else(|| {
            let names: Vec<String> = metals::names().map(str::to_owned).collect();
            let hint = name_hint(name, &names).map(|hint| format!("{hint}; ")).unwrap_or_default();
            let list = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
            let message = format!(
                "no metal is called \"{}\": {hint}there are {list}, and others by {{ eta = [r, g, b], k = [r, g, b] }}",
                shortened(name)
            );
            self.error(entry.span(), message)
        })
    }

    /// A table with keys of two kinds of surface.
    fn two_models(&self, number: usize, blinn_phong: &str, metallic_roughness: &str) -> Error {
        let [one, other] = [blinn_phong, metallic_roughness].map(|key| self.key(number, key));
        let line = |place: &Range<usize>| line_and_column(self.text, place.start).0;
        let message = format!(
            "a material is either Blinn-Phong, as `{blinn_phong}` in line {} says, or a metallic-roughness surface, as `{metallic_roughness}` in line {} says: \
             leave one of them out{}",
            line(&one),
            line(&other),
            counterpart(blinn_phong)
        );
        self.error(if one.start < other.start { other } else { one }, message)
    }

    /// Where a key of the material of this number stands.
    fn key(&self, number: usize, key: &str) -> Range<usize> {
        let place = || {
            let root = DeTable::parse(self.text).ok()?;
            let DeValue::Array(tables) = root.get_ref().get("material")?.get_ref() else { return None };
            let DeValue::Table(table) = tables.get(number)?.get_ref() else { return None };
            table.keys().find(|name| *name.get_ref() == key).map(Spanned::span)
        };
        place().unwrap_or_default()
    }

    /// A map; the empty name removes what an MTL file says.
    fn map(&self, entry: &Option<Spanned<MapEntry>>, of: MapOf) -> Result<MapDraft> {
        let Some(entry) = entry else { return Ok(MapDraft::Unstated) };
        let (name, scale, offset, channel) = match entry.get_ref() {
            MapEntry::Image(name) => (name, None, None, None),
            MapEntry::Placed(PlacedMap { image, scale, offset, channel }) => (image, *scale, *offset, *channel),
        };
        if channel.is_some() && of != MapOf::Number {
            let message = "`channel` belongs to the map of one number, and of this one all channels count";
            return Err(self.error(entry.span(), message));
        }
        if name.is_empty() {
            return Ok(MapDraft::Removed);
        }
        let path = self.beside(name);
        // What is wrong with the image itself is a warning, as it is in an MTL file.
        std::fs::metadata(&path)
            .map_err(|error| self.error(entry.span(), Error::read(&path, error).to_string() + &instead_of(&path)))?;
        let at = format!("{}:{}", self.path.display(), line_and_column(self.text, entry.span().start).0);
        let plain = MapFile::plain(vec![name.clone()], self.folder(), at);
        let scale = scale.map_or(Vec2::ONE, |scale| scale.0);
        let offset = offset.map_or(Vec2::ZERO, |offset| offset.0);
        let channel = channel.map_or(plain.channel, |channel| match channel {
            MapChannel::R => Channel::One(0),
            MapChannel::G => Channel::One(1),
            MapChannel::B => Channel::One(2),
            MapChannel::A => Channel::One(3),
            MapChannel::Luminance => Channel::Luminance,
        });
        Ok(MapDraft::File(MapFile { transform: scaled_and_moved(scale, offset), channel, ..plain }))
    }
}

/// The keys that only Blinn-Phong's materials have, as far as they are stated.
fn blinn_phong_keys(table: &MaterialTable) -> Vec<&'static str> {
    let colour = matches!(table.transmission, Some(Transmission::Albedo(_)));
    stated([
        ("diffuse", table.diffuse.is_some()),
        ("glossy", table.glossy.is_some()),
        ("exponent", table.exponent.is_some()),
        ("reflection", table.reflection.is_some()),
        ("transmission", colour),
        ("eta", table.eta.is_some()),
        ("impulse_probability", table.impulse_probability.is_some()),
        ("diffuse_map", table.diffuse_map.is_some()),
        ("glossy_map", table.glossy_map.is_some()),
    ])
}

/// The keys that only metallic-roughness surfaces have, as far as they are stated.
fn physical_keys(table: &MaterialTable) -> Vec<&'static str> {
    let share = matches!(table.transmission, Some(Transmission::Share(_)));
    stated([
        ("base_colour", table.base_colour.is_some()),
        ("metallic", table.metallic.is_some()),
        ("roughness", table.roughness.is_some()),
        ("ior", table.ior.is_some()),
        ("specular", table.specular.is_some()),
        ("specular_colour", table.specular_colour.is_some()),
        ("conductor", table.conductor.is_some()),
        ("transmission", share),
        ("attenuation_colour", table.attenuation_colour.is_some()),
        ("attenuation_distance", table.attenuation_distance.is_some()),
        ("clearcoat", table.clearcoat.is_some()),
        ("clearcoat_roughness", table.clearcoat_roughness.is_some()),
        ("sheen_colour", table.sheen_colour.is_some()),
        ("sheen_roughness", table.sheen_roughness.is_some()),
        ("anisotropy", table.anisotropy.is_some()),
        ("anisotropy_rotation", table.anisotropy_rotation.is_some()),
        ("iridescence", table.iridescence.is_some()),
        ("iridescence_ior", table.iridescence_ior.is_some()),
        ("iridescence_thickness", table.iridescence_thickness.is_some()),
        ("dispersion", table.dispersion.is_some()),
        ("base_colour_map", table.base_colour_map.is_some()),
        ("metallic_map", table.metallic_map.is_some()),
        ("roughness_map", table.roughness_map.is_some()),
        ("specular_map", table.specular_map.is_some()),
        ("specular_colour_map", table.specular_colour_map.is_some()),
        ("transmission_map", table.transmission_map.is_some()),
        ("clearcoat_map", table.clearcoat_map.is_some()),
        ("clearcoat_roughness_map", table.clearcoat_roughness_map.is_some()),
        ("sheen_colour_map", table.sheen_colour_map.is_some()),
        ("sheen_roughness_map", table.sheen_roughness_map.is_some()),
        ("anisotropy_map", table.anisotropy_map.is_some()),
        ("iridescence_map", table.iridescence_map.is_some()),
        ("iridescence_thickness_map", table.iridescence_thickness_map.is_some()),
    ])
}

fn stated<const N: usize>(keys: [(&'static str, bool); N]) -> Vec<&'static str> {
    keys.into_iter().filter(|(_, stated)| *stated).map(|(key, _)| key).collect()
}

/// What says on a metallic-roughness surface what a key of Blinn-Phong's says.
fn counterpart(key: &str) -> &'static str {
    match key {
        "diffuse" => " (there the colour is `base_colour`)",
        "diffuse_map" => " (there the map of the colour is `base_colour_map`)",
        "eta" => " (there the index is `ior`)",
        "exponent" | "glossy" | "glossy_map" => " (there a highlight is as narrow as `roughness` says)",
        "reflection" => " (there a mirror is `metallic = 1` with `roughness = 0`)",
        "transmission" => " (there `transmission` is one number, and the colour is `base_colour`)",
        _ => "",
    }
}
