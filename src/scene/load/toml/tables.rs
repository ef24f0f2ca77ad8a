//! The tables of a scene file, as `scenes/README.md` describes them.

use super::values::{
    Albedo, Angle, Attenuation, Blades, Bounces, Colour, ConeAngle, DiscAngle, Eta, Exact, Exponent, Exposure, FilmIor,
    FilmThickness, FilterRadius, Finite, Fov, Ior, MapOffset, MapScale, Matrix, NotNegative, Pixels, Positive,
    Probability, Samples, Shift, Transmission, Triple, Unit,
};
use crate::scene::{AreaSampling, Directions, Extinction, Filter, LightChoice, LightSampling, Sampler, Tone};
use ::toml::Spanned;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub film: Option<Spanned<FilmTable>>,
    pub sensor: Option<Spanned<Sensors>>,
    pub environment: Option<Spanned<EnvironmentTable>>,
    pub ground: Option<GroundTable>,
    pub integrator: Option<IntegratorTable>,
    #[serde(default)]
    pub render: RenderTable,
    #[serde(default)]
    pub object: Vec<Spanned<ObjectTable>>,
    #[serde(default)]
    pub material: Vec<MaterialTable>,
    #[serde(default)]
    pub luminaire: Vec<Spanned<LuminaireEntry>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FilmTable {
    pub width: Option<Pixels>,
    pub height: Option<Pixels>,
    #[serde(default)]
    pub filter: Filter,
    pub filter_radius: Option<FilterRadius>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SensorTable {
    pub name: Option<Spanned<String>>,
    #[serde(default)]
    pub kind: SensorKind,
    pub position: Triple,
    pub target: Triple,
    pub up: Option<Triple>,
    pub fov: Option<Spanned<Fov>>,
    pub height: Option<Spanned<Positive>>,
    pub aperture: Option<Spanned<NotNegative>>,
    pub focus_distance: Option<Spanned<Positive>>,
    pub blades: Option<Spanned<Blades>>,
    pub blade_rotation: Option<Spanned<Finite>>,
    pub shift: Option<Shift>,
}

/// One table or a list of them.
#[allow(clippy::large_enum_variant, reason = "there is one in a file")]
pub(super) enum Sensors {
    /// `[sensor]`.
    One(SensorTable),
    /// `[[sensor]]`, any number of times.
    Several(Vec<Spanned<SensorTable>>),
}

impl<'de> Deserialize<'de> for Sensors {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        // Not an untagged enum, which would lose the places and the words of errors within.
        struct Tables;
        impl<'de> Visitor<'de> for Tables {
            type Value = Sensors;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a table [sensor], or a list of tables [[sensor]]")
            }
            fn visit_map<A: MapAccess<'de>>(self, table: A) -> std::result::Result<Sensors, A::Error> {
                SensorTable::deserialize(MapAccessDeserializer::new(table)).map(Sensors::One)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> std::result::Result<Sensors, A::Error> {
                let mut tables = Vec::new();
                while let Some(table) = list.next_element()? {
                    tables.push(table);
                }
                Ok(Sensors::Several(tables))
            }
        }
        deserializer.deserialize_any(Tables)
    }
}

#[derive(Deserialize, Clone, Copy, Default, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(super) enum SensorKind {
    #[default]
    Perspective,
    Orthographic,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentTable {
    pub radiance: Option<Colour>,
    pub image: Option<Spanned<String>>,
    pub sky: Option<Spanned<BuiltInSky>>,
    pub rotate: Option<Spanned<Finite>>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
pub(super) enum BuiltInSky {
    Studio,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct GroundTable {
    pub height: Option<Exact>,
    pub diffuse: Option<Albedo>,
    pub size: Option<Positive>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct IntegratorTable {
    pub kind: Option<Spanned<IntegratorKind>>,
    pub ambient: Option<Spanned<Colour>>,
    pub estimator: Option<Spanned<String>>,
    pub light_sampling: Option<Spanned<LightSampling>>,
    pub area_sampling: Option<Spanned<AreaSampling>>,
    pub light_choice: Option<Spanned<LightChoice>>,
    pub directions: Option<Spanned<Directions>>,
    pub extinction: Option<Spanned<Extinction>>,
    pub albedo_threshold: Option<Spanned<Unit>>,
    pub max_bounces: Option<Spanned<Bounces>>,
    pub smooth_terminator: Option<Spanned<bool>>,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(super) enum IntegratorKind {
    Path,
    Simple,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct RenderTable {
    pub spp: Option<Samples>,
    pub seed: Option<u32>,
    pub exposure: Option<Exposure>,
    pub tone: Option<Tone>,
    pub sampler: Option<Sampler>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectTable {
    pub mesh: Spanned<String>,
    pub name: Option<String>,
    pub material: Option<Spanned<String>>,
    pub smooth: Option<Angle>,
    pub vertex_colours: Option<bool>,
    pub translate: Option<Triple>,
    pub rotate: Option<Triple>,
    pub scale: Option<Scale>,
    pub matrix: Option<Matrix>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number or three numbers [x, y, z], all finite")]
pub(super) enum Scale {
    Even(Exact),
    Uneven(Triple),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    pub name: Spanned<String>,
    pub ambient: Option<Colour>,
    pub diffuse: Option<Colour>,
    pub glossy: Option<Colour>,
    pub exponent: Option<Exponent>,
    pub emission: Option<Colour>,
    pub one_sided: Option<bool>,
    pub reflection: Option<Colour>,
    pub transmission: Option<Transmission>,
    pub eta: Option<Eta>,
    pub thin: Option<bool>,
    pub impulse_probability: Option<Probability>,
    pub opacity: Option<Unit>,
    pub normal_scale: Option<Spanned<Finite>>,
    pub bump_scale: Option<Spanned<Finite>>,
    pub ambient_map: Option<Spanned<MapEntry>>,
    pub diffuse_map: Option<Spanned<MapEntry>>,
    pub glossy_map: Option<Spanned<MapEntry>>,
    pub emission_map: Option<Spanned<MapEntry>>,
    pub opacity_map: Option<Spanned<MapEntry>>,
    pub normal_map: Option<Spanned<MapEntry>>,
    pub bump_map: Option<Spanned<MapEntry>>,
    pub model: Option<Model>,
    pub base_colour: Option<Albedo>,
    pub metallic: Option<Unit>,
    pub roughness: Option<Unit>,
    pub ior: Option<Ior>,
    pub specular: Option<Unit>,
    pub specular_colour: Option<Colour>,
    pub conductor: Option<Spanned<ConductorEntry>>,
    pub attenuation_colour: Option<Attenuation>,
    pub attenuation_distance: Option<Positive>,
    pub clearcoat: Option<Unit>,
    pub clearcoat_roughness: Option<Unit>,
    pub sheen_colour: Option<Albedo>,
    pub sheen_roughness: Option<Unit>,
    pub anisotropy: Option<Unit>,
    pub anisotropy_rotation: Option<Exact>,
    pub iridescence: Option<Unit>,
    pub iridescence_ior: Option<FilmIor>,
    pub iridescence_thickness: Option<FilmThickness>,
    pub dispersion: Option<NotNegative>,
    pub base_colour_map: Option<Spanned<MapEntry>>,
    pub metallic_map: Option<Spanned<MapEntry>>,
    pub roughness_map: Option<Spanned<MapEntry>>,
    pub specular_map: Option<Spanned<MapEntry>>,
    pub specular_colour_map: Option<Spanned<MapEntry>>,
    pub transmission_map: Option<Spanned<MapEntry>>,
    pub clearcoat_map: Option<Spanned<MapEntry>>,
    pub clearcoat_roughness_map: Option<Spanned<MapEntry>>,
    pub sheen_colour_map: Option<Spanned<MapEntry>>,
    pub sheen_roughness_map: Option<Spanned<MapEntry>>,
    pub anisotropy_map: Option<Spanned<MapEntry>>,
    pub iridescence_map: Option<Spanned<MapEntry>>,
    pub iridescence_thickness_map: Option<Spanned<MapEntry>>,
}

/// What a surface is.
#[derive(Deserialize, Clone, Copy, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Model {
    BlinnPhong,
    MetallicRoughness,
}

/// A metal.
pub(super) enum ConductorEntry {
    Metal(String),
    Numbers(ConductorTable),
}

impl<'de> Deserialize<'de> for ConductorEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        // Not an untagged enum, which would lose the places and the words of errors within.
        struct NameOrNumbers;
        impl<'de> Visitor<'de> for NameOrNumbers {
            type Value = ConductorEntry;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(
                    "the name of a metal, or { eta = [r, g, b], k = [r, g, b] }, its index of refraction and its extinction coefficient",
                )
            }
            fn visit_str<E: Error>(self, name: &str) -> std::result::Result<ConductorEntry, E> {
                Ok(ConductorEntry::Metal(name.to_owned()))
            }
            fn visit_map<A: MapAccess<'de>>(self, table: A) -> std::result::Result<ConductorEntry, A::Error> {
                ConductorTable::deserialize(MapAccessDeserializer::new(table)).map(ConductorEntry::Numbers)
            }
        }
        deserializer.deserialize_any(NameOrNumbers)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ConductorTable {
    pub eta: Colour,
    pub k: Colour,
}

/// A map.
pub(super) enum MapEntry {
    Image(String),
    Placed(PlacedMap),
}

impl<'de> Deserialize<'de> for MapEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        // Not an untagged enum either.
        struct NameOrTable;
        impl<'de> Visitor<'de> for NameOrTable {
            type Value = MapEntry;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(
                    "the name of an image, or { image = \"NAME\" } with `scale`, `offset` or `channel` beside it",
                )
            }
            fn visit_str<E: Error>(self, name: &str) -> std::result::Result<MapEntry, E> {
                Ok(MapEntry::Image(name.to_owned()))
            }
            fn visit_map<A: MapAccess<'de>>(self, table: A) -> std::result::Result<MapEntry, A::Error> {
                PlacedMap::deserialize(MapAccessDeserializer::new(table)).map(MapEntry::Placed)
            }
        }
        deserializer.deserialize_any(NameOrTable)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlacedMap {
    pub image: String,
    pub scale: Option<MapScale>,
    pub offset: Option<MapOffset>,
    pub channel: Option<MapChannel>,
}

/// The channel of an image that is a number.
#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
pub(super) enum MapChannel {
    R,
    G,
    B,
    A,
    Luminance,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LuminaireEntry {
    pub kind: LuminaireKind,
    pub position: Option<Triple>,
    pub intensity: Option<Colour>,
    pub profile: Option<Spanned<String>>,
    pub direction: Option<Triple>,
    pub up: Option<Triple>,
    pub inner_angle: Option<Spanned<ConeAngle>>,
    pub outer_angle: Option<ConeAngle>,
    pub irradiance: Option<Colour>,
    pub angle: Option<DiscAngle>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
pub(super) enum LuminaireKind {
    Point,
    Spot,
    Infinite,
}
