//! Scene files in TOML; `scenes/README.md` describes the format.

use super::load::Loader;
use super::material::Draft;
use super::text::line_and_column;
use super::toml_values::{Colour, Exponent, Exposure, Finite, Fov, Pixels, Samples, Triple};
use super::{
    Estimator, FilmSettings, Filter, Integrator, Luminaire, Object, Projection, RenderSettings, Scene, Sensor, obj,
    preview,
};
use crate::{Error, Result};
use ::toml::Spanned;
use glam::{Affine3A, DAffine3, DMat3, DQuat, DVec3, Vec3};
use serde::Deserialize;
use std::collections::HashSet;
use std::ops::Range;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneFile {
    film: Option<Spanned<FilmTable>>,
    sensor: Option<Spanned<SensorTable>>,
    integrator: Option<IntegratorTable>,
    #[serde(default)]
    render: RenderTable,
    #[serde(default)]
    object: Vec<Spanned<ObjectTable>>,
    #[serde(default)]
    material: Vec<MaterialTable>,
    #[serde(default)]
    luminaire: Vec<Spanned<LuminaireTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FilmTable {
    width: Option<Pixels>,
    height: Option<Pixels>,
    #[serde(default)]
    filter: Filter,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SensorTable {
    position: Triple,
    target: Triple,
    up: Option<Triple>,
    fov: Fov,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct IntegratorTable {
    kind: IntegratorKind,
    max_bounces: Option<Spanned<u32>>,
    ambient: Option<Spanned<Colour>>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
enum IntegratorKind {
    Path,
    Simple,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct RenderTable {
    spp: Option<Samples>,
    seed: Option<u32>,
    exposure: Option<Exposure>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObjectTable {
    mesh: Spanned<String>,
    name: Option<String>,
    material: Option<Spanned<String>>,
    translate: Option<Triple>,
    rotate: Option<Triple>,
    scale: Option<Scale>,
    matrix: Option<[[Finite; 4]; 3]>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a number or three numbers [x, y, z], all finite")]
enum Scale {
    Even(Finite),
    Uneven(Triple),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialTable {
    name: Spanned<String>,
    ambient: Option<Colour>,
    diffuse: Option<Colour>,
    glossy: Option<Colour>,
    exponent: Option<Exponent>,
    emission: Option<Colour>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LuminaireTable {
    kind: LuminaireKind,
    position: Option<Triple>,
    intensity: Option<Colour>,
    direction: Option<Triple>,
    irradiance: Option<Colour>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
enum LuminaireKind {
    Point,
    Infinite,
}

/// Loads a scene file.
pub(super) fn load(path: &Path) -> Result<Scene> {
    let bytes = std::fs::read(path).map_err(|error| Error::read(path, error))?;
    let text = std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes)).map_err(|error| {
        let line = 1 + bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count();
        Error::Parse { path: path.to_owned(), line, column: 0, message: "a scene file has to be UTF-8 text".into() }
    })?;
    let file = File { path, text };
    let scene: SceneFile = ::toml::from_str(text)
        .map_err(|error| file.error(error.span().unwrap_or(0..0), in_plain_words(error.message().trim())))?;
    file.build(scene)
}

/// A scene file being turned into a [`Scene`].
struct File<'a> {
    path: &'a Path,
    text: &'a str,
}

impl File<'_> {
    fn error(&self, span: Range<usize>, message: impl Into<String>) -> Error {
        let (line, column) = line_and_column(self.text, span.start);
        Error::Parse { path: self.path.to_owned(), line, column, message: message.into() }
    }

    fn warning(&self, message: &str) -> String {
        format!("{}: {message}", self.path.display())
    }

    fn build(&self, file: SceneFile) -> Result<Scene> {
        let film = self.film(file.film)?;
        let integrator = self.integrator(file.integrator)?;
        let mut luminaires = Vec::new();
        for table in file.luminaire {
            luminaires.push(self.luminaire(&table)?);
        }
        let sensor = file.sensor.map(|table| self.sensor(&table)).transpose()?;
        let mut loader = Loader::new(self.materials(&file.material)?);
        let mut objects = Vec::new();
        for table in &file.object {
            objects.push(self.object(table, &mut loader)?);
        }
        if objects.is_empty() {
            return Err(Error::scene(self.path, "nothing to trace: the scene file has no [[object]]"));
        }
        let defaults = RenderSettings::default();
        let settings = RenderSettings {
            spp: file.render.spp.map_or(defaults.spp, |spp| spp.0),
            seed: file.render.seed.unwrap_or(defaults.seed),
            exposure: file.render.exposure.map_or(defaults.exposure, |exposure| exposure.0),
            sampler: defaults.sampler,
        };
        let mut scene = Scene {
            textures: Vec::new(),
            environment: None,
            path: self.path.to_owned(),
            materials: loader.finish_materials(&objects),
            meshes: loader.meshes,
            objects,
            luminaires,
            sensor: Sensor {
                position: Vec3::Z,
                target: Vec3::ZERO,
                up: Vec3::Y,
                projection: Projection::Perspective { fov: 40.0 },
                lens: None,
            },
            film,
            integrator,
            settings,
            warnings: loader.warnings,
        };
        scene.sensor = sensor.unwrap_or_else(|| {
            let sensor = preview::framing_sensor(&scene);
            scene.warnings.push(self.warning("no [sensor]; the camera is placed to frame the scene"));
            sensor
        });
        let lit = matches!(integrator, Integrator::Simple { ambient } if ambient != Vec3::ZERO);
        if !lit && scene.luminaires.is_empty() && !preview::emits(&scene) {
            scene.warnings.push(self.warning("no [[luminaire]] and no material emits; the picture will be black"));
        }
        Ok(scene)
    }

    fn film(&self, table: Option<Spanned<FilmTable>>) -> Result<FilmSettings> {
        let Some(table) = table else { return Ok(preview::FILM) };
        let span = table.span();
        let table = table.into_inner();
        let width = table.width.map_or(preview::FILM.width, |pixels| pixels.0);
        let height = table.height.map_or(preview::FILM.height, |pixels| pixels.0);
        if u64::from(width) * u64::from(height) > u64::from(u32::MAX) {
            return Err(self.error(span, format!("a film of {width} x {height} has more than 2^32 - 1 pixels")));
        }
        Ok(FilmSettings { width, height, filter: table.filter, filter_radius: table.filter.default_radius() })
    }

    fn sensor(&self, table: &Spanned<SensorTable>) -> Result<Sensor> {
        let SensorTable { position, target, up, fov } = table.get_ref();
        let sensor = Sensor {
            position: position.0,
            target: target.0,
            up: up.map_or(Vec3::Y, |up| up.0),
            projection: Projection::Perspective { fov: fov.0 },
            lens: None,
        };
        let view = sensor.target.as_dvec3() - sensor.position.as_dvec3();
        let up = sensor.up.as_dvec3();
        let wrong = if view == DVec3::ZERO {
            "position and target of the sensor are the same point"
        } else if up == DVec3::ZERO {
            "the sensor's up is the zero vector"
        } else if up.normalize().cross(view.normalize()).length() < 1e-6 {
            "the sensor's up is parallel to its line of sight; choose another up"
        } else {
            return Ok(sensor);
        };
        Err(self.error(table.span(), wrong))
    }

    fn integrator(&self, table: Option<IntegratorTable>) -> Result<Integrator> {
        let Some(IntegratorTable { kind, max_bounces, ambient }) = table else {
            return Ok(Integrator::Path(Estimator::default()));
        };
        match (kind, max_bounces, ambient) {
            (IntegratorKind::Path, _, Some(ambient)) => {
                Err(self.error(ambient.span(), "`ambient` belongs to kind = \"simple\"; the path integrator has none"))
            }
            (IntegratorKind::Simple, Some(bounces), _) => Err(self.error(
                bounces.span(),
                "`max_bounces` belongs to kind = \"path\"; the simple ray tracer does not bounce",
            )),
            (IntegratorKind::Path, bounces, None) => Ok(Integrator::Path(Estimator {
                max_bounces: bounces.map(Spanned::into_inner),
                ..Estimator::default()
            })),
            (IntegratorKind::Simple, None, ambient) => {
                Ok(Integrator::Simple { ambient: ambient.map_or(Vec3::ZERO, |ambient| ambient.into_inner().0) })
            }
        }
    }

    fn luminaire(&self, table: &Spanned<LuminaireTable>) -> Result<Luminaire> {
        let LuminaireTable { kind, position, intensity, direction, irradiance } = table.get_ref();
        match (kind, position, intensity, direction, irradiance) {
            (LuminaireKind::Point, Some(position), Some(intensity), None, None) => {
                Ok(Luminaire::Point { position: position.0, intensity: intensity.0 })
            }
            (LuminaireKind::Infinite, None, None, Some(direction), Some(irradiance)) => {
                let Some(direction) = direction.0.as_dvec3().try_normalize() else {
                    return Err(self.error(table.span(), "the direction of the luminaire is the zero vector"));
                };
                Ok(Luminaire::Infinite { direction: direction.as_vec3(), irradiance: irradiance.0 })
            }
            (LuminaireKind::Point, ..) => {
                Err(self.error(table.span(), "a point luminaire has `position` and `intensity`, both and nothing else"))
            }
            (LuminaireKind::Infinite, ..) => Err(self
                .error(table.span(), "an infinite luminaire has `direction` and `irradiance`, both and nothing else")),
        }
    }

    fn materials(&self, tables: &[MaterialTable]) -> Result<Vec<Draft>> {
        let mut names = HashSet::new();
        let draft = |table: &MaterialTable| {
            let name = table.name.get_ref();
            if !names.insert(name.clone()) {
                return Err(self.error(table.name.span(), format!("a second [[material]] named `{name}`")));
            }
            Ok(Draft {
                name: name.clone(),
                ambient: table.ambient.map(|colour| colour.0),
                diffuse: table.diffuse.map(|colour| colour.0),
                glossy: table.glossy.map(|colour| colour.0),
                exponent: table.exponent.map(|exponent| exponent.0),
                emission: table.emission.map(|colour| colour.0),
                not_modelled: None,
            })
        };
        tables.iter().map(draft).collect()
    }

    fn object(&self, table: &Spanned<ObjectTable>, loader: &mut Loader) -> Result<Object> {
        let object = table.get_ref();
        let object_to_world = self.transform(table)?;
        let mesh_path = self.path.parent().unwrap_or(Path::new("")).join(object.mesh.get_ref());
        if !mesh_path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj")) {
            let message = format!("`{}`: a mesh has to be an .obj file", object.mesh.get_ref());
            return Err(self.error(object.mesh.span(), message));
        }
        let mesh = loader.mesh(&mesh_path).map_err(|error| match error {
            // Where the file is named helps more than where it is not.
            Error::Read { .. } => self.error(object.mesh.span(), error.to_string()),
            other => other,
        })?;
        let material = match &object.material {
            None => None,
            Some(name) => Some(loader.material(mesh, name.get_ref()).ok_or_else(|| {
                let message = format!(
                    "there is no material `{}`: neither an MTL file nor a [[material]] defines it",
                    name.get_ref()
                );
                self.error(name.span(), message)
            })?),
        };
        let stem = || obj::file_name(Path::new(mesh_path.file_stem().unwrap_or_default()));
        Ok(Object { name: object.name.clone().unwrap_or_else(stem), mesh, object_to_world, material })
    }

    fn transform(&self, table: &Spanned<ObjectTable>) -> Result<Affine3A> {
        let ObjectTable { translate, rotate, scale, matrix, .. } = table.get_ref();
        if matrix.is_some() && (translate.is_some() || rotate.is_some() || scale.is_some()) {
            return Err(self.error(table.span(), "give either `matrix`, or `translate`, `rotate` and `scale`"));
        }
        let zero = Triple(Vec3::ZERO);
        let to_world = match matrix {
            Some(rows) => {
                let column = |c: usize| DVec3::new(rows[0][c].0.into(), rows[1][c].0.into(), rows[2][c].0.into());
                DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
            }
            None => {
                let angles = rotate.unwrap_or(zero).0.as_dvec3();
                let [x, y, z] = angles.to_array().map(f64::to_radians);
                let rotation = DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
                let scale = match scale {
                    None => DVec3::ONE,
                    Some(Scale::Even(scale)) => DVec3::splat(scale.0.into()),
                    Some(Scale::Uneven(scale)) => scale.0.as_dvec3(),
                };
                let translation = translate.unwrap_or(zero).0.as_dvec3();
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
        };
        let rounded = to_world.as_affine3a();
        let m = to_world.matrix3;
        let edges = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        // The volume of the transformed unit cube against the box of the same edges: 1e-6 is where f32 loses all of it.
        let flat = m.determinant().abs() <= 1e-6 * edges;
        if flat || !rounded.is_finite() || !rounded.inverse().is_finite() {
            return Err(self.error(table.span(), "the transform cannot be inverted: it flattens the object"));
        }
        Ok(rounded)
    }
}

/// The parser's words for types, as TOML users know them.
fn in_plain_words(message: &str) -> String {
    let words = [
        ("invalid type: map, expected a sequence", "one table, expected a list of them: write [[ ]] around its name"),
        ("invalid type: map, expected", "a table (or a list of tables), expected"),
        ("expected f64", "expected a number"),
        ("expected f32", "expected a number"),
        ("expected i64", "expected a whole number"),
        ("expected u32", "expected a whole number from 0 to 4294967295"),
        ("expected an array of length 3", "expected three numbers"),
    ];
    words.iter().fold(message.to_owned(), |text, (from, to)| text.replace(from, to))
}
