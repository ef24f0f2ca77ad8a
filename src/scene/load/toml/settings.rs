//! The tables `[film]`, `[sensor]`, `[environment]` and `[integrator]` of a scene file.

use super::advice::name_hint;
use super::file::File;
use super::tables::{
    BuiltInSky, EnvironmentTable, FilmTable, IntegratorKind, IntegratorTable, SensorKind, SensorTable,
};
use super::values::Triple;
use crate::scene::load::near_name::instead_of;
use crate::scene::load::{bare_mesh, environment};
use crate::scene::{
    Environment, EnvironmentImage, Estimator, EstimatorChanges, FilmSettings, Integrator, Lens, Projection, Sensor,
};
use crate::{Error, Result};
use ::toml::Spanned;
use glam::{DVec3, Vec2, Vec3};
use std::ops::Range;
use std::sync::Arc;

impl File<'_> {
    /// The `[film]`.
    pub(super) fn film(&self, table: Option<Spanned<FilmTable>>) -> Result<FilmSettings> {
        let Some(table) = table else { return Ok(bare_mesh::FILM) };
        let span = table.span();
        let table = table.into_inner();
        let width = table.width.map_or(bare_mesh::FILM.width, |pixels| pixels.0);
        let height = table.height.map_or(bare_mesh::FILM.height, |pixels| pixels.0);
        if u64::from(width) * u64::from(height) > u64::from(u32::MAX) {
            return Err(self.error(span, format!("a film of {width} x {height} has more than 2^32 - 1 pixels")));
        }
        let filter_radius = table.filter_radius.map_or(table.filter.default_radius(), |radius| radius.0);
        Ok(FilmSettings { width, height, filter: table.filter, filter_radius })
    }

    /// A `[sensor]`, in a scene with this origin.
    pub(super) fn sensor(&self, table: &SensorTable, span: Range<usize>, origin: DVec3) -> Result<Sensor> {
        let of = table;
        let projection = match (of.kind, &of.fov, &of.height) {
            (SensorKind::Perspective, Some(fov), None) => Projection::Perspective { fov: fov.get_ref().0 },
            (SensorKind::Orthographic, None, Some(height)) => Projection::Orthographic { height: height.get_ref().0 },
            (SensorKind::Perspective, _, Some(height)) => {
                let message = "`height` belongs to kind = \"orthographic\"; a perspective sensor has `fov`";
                return Err(self.error(height.span(), message));
            }
            (SensorKind::Orthographic, Some(fov), _) => {
                let message = "`fov` belongs to kind = \"perspective\"; an orthographic sensor has `height`";
                return Err(self.error(fov.span(), message));
            }
            (SensorKind::Perspective, None, None) => {
                return Err(
                    self.error(span, "missing field `fov`: the vertical field of view in degrees, for example 45")
                );
            }
            (SensorKind::Orthographic, None, None) => {
                let message = "missing field `height`: how much of the scene the picture shows, from bottom to top";
                return Err(self.error(span, message));
            }
        };
        let sensor = Sensor {
            position: (of.position.0 - origin).as_vec3(),
            target: (of.target.0 - origin).as_vec3(),
            up: of.up.map_or(Vec3::Y, Triple::rounded),
            projection,
            lens: None,
            shift: of.shift.map_or(Vec2::ZERO, |shift| shift.0),
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
            let lens = self.lens(of, view.length() as f32)?;
            return Ok(Sensor { lens, ..sensor });
        };
        Err(self.error(span, wrong))
    }

    /// The sensor's lens, if its aperture is open; `to_target` is the distance at which it is in focus unless something else is said.
    fn lens(&self, table: &SensorTable, to_target: f32) -> Result<Option<Lens>> {
        let SensorTable { aperture, focus_distance, blades, blade_rotation, .. } = table;
        let Some(aperture) = aperture else {
            let needs = [
                ("focus_distance", focus_distance.as_ref().map(Spanned::span)),
                ("blades", blades.as_ref().map(Spanned::span)),
                ("blade_rotation", blade_rotation.as_ref().map(Spanned::span)),
            ];
            return match needs.into_iter().find_map(|(key, span)| Some((key, span?))) {
                None => Ok(None),
                Some((key, span)) => {
                    let message = format!("`{key}` belongs to a lens: give `aperture`, the radius of its opening, too");
                    Err(self.error(span, message))
                }
            };
        };
        let radius = aperture.get_ref().0;
        if radius == 0.0 {
            return Ok(None);
        }
        Ok(Some(Lens {
            radius,
            focus_distance: focus_distance.as_ref().map_or(to_target, |distance| distance.get_ref().0),
            blades: blades.as_ref().map_or(0, |blades| blades.get_ref().0),
            rotation: blade_rotation.as_ref().map_or(0.0, |rotation| rotation.get_ref().0),
        }))
    }

    /// The `[environment]`; none if it is black, which is a warning.
    pub(super) fn environment(
        &self,
        table: &Spanned<EnvironmentTable>,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Environment>> {
        let EnvironmentTable { radiance, image, sky, rotate } = table.get_ref();
        if let (Some(sky), Some(_)) = (sky, image) {
            return Err(self.error(sky.span(), "give either `sky`, a built-in one, or `image`"));
        }
        let radiance = match radiance {
            Some(radiance) => radiance.0,
            None if image.is_some() || sky.is_some() => Vec3::ONE,
            None => {
                let message = "an environment needs a `radiance`, an `image` or a `sky`";
                return Err(self.error(table.span(), message));
            }
        };
        if let (Some(rotate), None, None) = (rotate, image, sky) {
            let message = "`rotate` turns the `image` or the `sky` of the environment, and there is none";
            return Err(self.error(rotate.span(), message));
        }
        if radiance == Vec3::ZERO {
            warnings.push(self.warning("the environment's radiance is 0; there is none"));
            return Ok(None);
        }
        let built_in = sky.as_ref().map(|sky| match sky.get_ref() {
            BuiltInSky::Studio => EnvironmentImage::studio(),
        });
        let image = match image {
            None => built_in,
            Some(name) if name.get_ref().trim().is_empty() => {
                return Err(self.error(name.span(), "`image` names no file: name a picture, or leave it out"));
            }
            Some(name) => {
                let path = self.beside(name.get_ref());
                let read = environment::read(&path, warnings);
                match read.map_err(|reason| {
                    self.error(name.span(), Error::read(&path, reason).to_string() + &instead_of(&path))
                })? {
                    None => return Ok(None),
                    image => image,
                }
            }
        };
        let rotation = rotate.as_ref().map_or(0.0, |rotate| rotate.get_ref().0);
        Ok(Some(Environment { radiance, image: image.map(Arc::new), rotation }))
    }

    /// The `[integrator]`; what it asks for in vain is a warning.
    pub(super) fn integrator(&self, table: &IntegratorTable, warnings: &mut Vec<String>) -> Result<Integrator> {
        let preset = table.estimator.as_ref();
        let simple_preset = preset.is_some_and(|name| name.get_ref() == "simple");
        let kind = table.kind.as_ref().map(|kind| *kind.get_ref());
        if let (Some(kind), Some(preset)) = (kind, preset)
            && (kind == IntegratorKind::Simple) != simple_preset
        {
            let message = format!("estimator = \"{}\" contradicts `kind`; leave `kind` out", preset.get_ref());
            return Err(self.error(preset.span(), message));
        }
        if simple_preset || kind == Some(IntegratorKind::Simple) {
            if let Some((key, span)) = parts(table).into_iter().find_map(|(key, span)| Some((key, span?))) {
                let message = format!("`{key}` belongs to the path tracer; the simple ray tracer has no paths");
                return Err(self.error(span, message));
            }
            let ambient = table.ambient.as_ref().map_or(Vec3::ZERO, |ambient| ambient.get_ref().0);
            return Ok(Integrator::Simple { ambient });
        }
        if let Some(ambient) = &table.ambient {
            let message = "`ambient` belongs to kind = \"simple\"; the path tracer computes what it stands for";
            return Err(self.error(ambient.span(), message));
        }
        let estimator = match preset {
            None => Estimator::default(),
            Some(name) => Estimator::preset(name.get_ref()).ok_or_else(|| {
                let expected = Estimator::names_in_words();
                let names = expected.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
                let hint = name_hint(name.get_ref(), &names).map(|hint| format!("; {hint}")).unwrap_or_default();
                let message = format!("no estimator is called `{}`, expected {expected}{hint}", name.get_ref());
                self.error(name.span(), message)
            })?,
        };
        let changes = EstimatorChanges {
            light_sampling: table.light_sampling.as_ref().map(|part| *part.get_ref()),
            area_sampling: table.area_sampling.as_ref().map(|part| *part.get_ref()),
            light_choice: table.light_choice.as_ref().map(|part| *part.get_ref()),
            directions: table.directions.as_ref().map(|part| *part.get_ref()),
            extinction: table.extinction.as_ref().map(|part| *part.get_ref()),
            albedo_threshold: table.albedo_threshold.as_ref().map(|part| part.get_ref().0),
            max_bounces: table.max_bounces.as_ref().map(|part| part.get_ref().0),
            smooth_terminator: table.smooth_terminator.as_ref().map(|part| *part.get_ref()),
        };
        let estimator = changes.apply(estimator);
        for key in changes.without_effect(&estimator) {
            let why = "without effect, because this estimator does not sample luminaires";
            warnings.push(self.warning(&format!("[integrator] `{key}`: {why}")));
        }
        if !estimator.ends() {
            let span = table.extinction.as_ref().map_or(0..0, Spanned::span);
            return Err(self.error(span, "without extinction a path never ends: add `max_bounces`"));
        }
        Ok(Integrator::Path(estimator))
    }
}

/// The keys that belong to the path tracer alone.
fn parts(table: &IntegratorTable) -> [(&'static str, Option<Range<usize>>); 8] {
    [
        ("light_sampling", table.light_sampling.as_ref().map(Spanned::span)),
        ("area_sampling", table.area_sampling.as_ref().map(Spanned::span)),
        ("light_choice", table.light_choice.as_ref().map(Spanned::span)),
        ("directions", table.directions.as_ref().map(Spanned::span)),
        ("extinction", table.extinction.as_ref().map(Spanned::span)),
        ("albedo_threshold", table.albedo_threshold.as_ref().map(Spanned::span)),
        ("max_bounces", table.max_bounces.as_ref().map(Spanned::span)),
        ("smooth_terminator", table.smooth_terminator.as_ref().map(Spanned::span)),
    ]
}
