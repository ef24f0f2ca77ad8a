//! The tables `[[luminaire]]` of a scene file.

use super::file::File;
use super::radians;
use super::tables::{LuminaireEntry, LuminaireKind};
use super::values::Triple;
use crate::scene::load::loader::Loader;
use crate::scene::load::near_name::instead_of;
use crate::scene::load::text_file::line_and_column;
use crate::scene::{LEAST_ANGLE, Luminaire, SunDisc};
use crate::{Error, Result};
use ::toml::Spanned;
use ::toml::de::{DeTable, DeValue};
use glam::{DVec3, Vec3};
use std::ops::Range;

const POINT: &str = "a point luminaire has `position` and `intensity`, both and nothing else; or `position` and `profile`, the name of an IES file, with which there may be \
                     `intensity`, `direction` and `up`";
const SPOT: &str = "a spot has `position`, `direction`, `intensity` and `outer_angle`, all of them, perhaps `inner_angle`, and nothing else";
const INFINITE: &str =
    "an infinite luminaire has `direction` and `irradiance`, both, perhaps `angle`, and nothing else";
/// Directions whose squared sine is less are along each other.
const ALONG: f64 = 1e-6;

impl File<'_> {
    /// What is wrong with a `[[luminaire]]` by itself, whatever is in other files.
    pub(super) fn check_luminaire(&self, table: &Spanned<LuminaireEntry>) -> Result<()> {
        if table.get_ref().profile.is_some() {
            self.photometric(table).map(drop)
        } else {
            self.plain(table, DVec3::ZERO).map(drop)
        }
    }

    /// A `[[luminaire]]`, in a scene with this origin.
    pub(super) fn luminaire(
        &self,
        table: &Spanned<LuminaireEntry>,
        origin: DVec3,
        loader: &mut Loader,
    ) -> Result<Luminaire> {
        let (line, _) = line_and_column(self.text, table.span().start);
        let Some(name) = &table.get_ref().profile else {
            let luminaire = self.plain(table, origin)?;
            let warning = match luminaire {
                Luminaire::Spot { inner, outer, .. } => radians::cone(inner, outer),
                Luminaire::Sun { angle, .. } => radians::sun(angle),
                _ => None,
            };
            if let Some(warning) = warning {
                loader.warnings.push(format!("{}:{line}: {warning}", self.path.display()));
            }
            return Ok(luminaire);
        };
        let (position, direction, up, intensity) = self.photometric(table)?;
        let path = self.named(name, "an IES file")?;
        let profile = loader.profile(&path).map_err(|error| match error {
            Error::Read { .. } => self.error(name.span(), error.to_string() + &instead_of(&path)),
            other => other,
        })?;
        if f64::from(intensity.max_element()) * profile.largest() > f64::from(f32::MAX) {
            let message = format!(
                "an `intensity` of {} times {:.1e} candelas is above 3e38",
                intensity.max_element(),
                profile.largest()
            );
            return Err(self.error(table.span(), message));
        }
        if up.is_none() && profile.horizontal.len() > 1 {
            let guess = if is_vertical(direction) { "+x" } else { "up" };
            loader.warnings.push(format!(
                "{}:{line}: {} is not the same all around, and no `up` says to which side its horizontal angle of 0 looks: taken to be {guess}",
                self.path.display(),
                profile.name
            ));
        }
        let up = up.unwrap_or(if is_vertical(direction) { Vec3::X } else { Vec3::Y });
        Ok(Luminaire::Photometric { position: (position - origin).as_vec3(), direction, up, intensity, profile })
    }

    /// One without a profile.
    fn plain(&self, table: &Spanned<LuminaireEntry>, origin: DVec3) -> Result<Luminaire> {
        let LuminaireEntry {
            kind,
            position,
            intensity,
            profile: _,
            direction,
            up,
            inner_angle,
            outer_angle,
            irradiance,
            angle,
        } = table.get_ref();
        let of_a_spot = (inner_angle, outer_angle);
        match (kind, position, intensity, direction, irradiance) {
            (LuminaireKind::Point, Some(position), Some(intensity), None, None)
                if matches!((of_a_spot, angle, up), ((None, None), None, None)) =>
            {
                Ok(Luminaire::Point { position: (position.0 - origin).as_vec3(), intensity: intensity.0 })
            }
            (LuminaireKind::Spot, Some(position), Some(intensity), Some(direction), None)
                if matches!((outer_angle, angle, up), (Some(_), None, None)) =>
            {
                let direction = self.direction(table, direction)?;
                let outer = outer_angle.map_or(0.0, |angle| angle.0);
                let inner = inner_angle.as_ref().map_or(0.0, |angle| angle.get_ref().0);
                if outer < LEAST_ANGLE {
                    return Err(self.error(
                        table.span(),
                        format!("expected an `outer_angle` from {LEAST_ANGLE} to 90 degrees, found {outer}"),
                    ));
                }
                if let Some(angle) = inner_angle.as_ref().filter(|_| inner > outer) {
                    let message = format!(
                        "expected an `inner_angle` of at most the `outer_angle`, {outer} degrees, found {inner}"
                    );
                    return Err(self.error(angle.span(), message));
                }
                let position = (position.0 - origin).as_vec3();
                Ok(Luminaire::Spot { position, direction, intensity: intensity.0, inner, outer })
            }
            (LuminaireKind::Infinite, None, None, Some(direction), Some(irradiance))
                if matches!((of_a_spot, up), ((None, None), None)) =>
            {
                let (direction, irradiance) = (self.direction(table, direction)?, irradiance.0);
                let Some(angle) = angle.map(|angle| angle.0).filter(|angle| *angle > 0.0) else {
                    return Ok(Luminaire::Infinite { direction, irradiance });
                };
                if !SunDisc::new(direction, irradiance, angle).radiance.as_vec3().is_finite() {
                    let message =
                        "so small a disc of so much irradiance has a radiance above 3e38: give it a larger `angle`";
                    return Err(self.error(table.span(), message));
                }
                Ok(Luminaire::Sun { direction, irradiance, angle })
            }
            (LuminaireKind::Point, ..) => Err(self.misfit(table, POINT, &["position", "intensity"], &[])),
            (LuminaireKind::Spot, ..) => {
                let wanted = ["position", "direction", "intensity", "outer_angle"];
                Err(self.misfit(table, SPOT, &wanted, &["inner_angle"]))
            }
            (LuminaireKind::Infinite, ..) => {
                Err(self.misfit(table, INFINITE, &["direction", "irradiance"], &["angle"]))
            }
        }
    }

    /// A table whose keys are not those of its kind: which is too much, at its line, or missing. `sentence` is what it has.
    fn misfit(&self, table: &Spanned<LuminaireEntry>, sentence: &str, wanted: &[&str], allowed: &[&str]) -> Error {
        let LuminaireEntry {
            kind: _,
            position,
            intensity,
            profile,
            direction,
            up,
            inner_angle,
            outer_angle,
            irradiance,
            angle,
        } = table.get_ref();
        let stated: Vec<&str> = [
            ("position", position.is_some()),
            ("intensity", intensity.is_some()),
            ("profile", profile.is_some()),
            ("direction", direction.is_some()),
            ("up", up.is_some()),
            ("inner_angle", inner_angle.is_some()),
            ("outer_angle", outer_angle.is_some()),
            ("irradiance", irradiance.is_some()),
            ("angle", angle.is_some()),
        ]
        .into_iter()
        .filter_map(|(key, stated)| stated.then_some(key))
        .collect();
        let listed = |keys: Vec<&str>| keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
        let missing: Vec<&str> = wanted.iter().filter(|key| !stated.contains(key)).copied().collect();
        let foreign = |key: &&&str| !wanted.contains(*key) && !allowed.contains(*key);
        let others: Vec<&str> = stated.iter().filter(foreign).copied().collect();
        let place = others.first().and_then(|key| self.luminaire_key(table, key)).unwrap_or(table.span());
        let parts = [(missing, "missing here"), (others, "too much")].map(|(keys, what)| match keys.len() {
            0 => None,
            1 => Some(format!("{} is {what}", listed(keys))),
            _ => Some(format!("{} are {what}", listed(keys))),
        });
        let said: Vec<String> = parts.into_iter().flatten().collect();
        self.error(place, format!("{}: {sentence}", said.join(", and ")))
    }

    /// Where a key of a luminaire stands.
    fn luminaire_key(&self, table: &Spanned<LuminaireEntry>, key: &str) -> Option<Range<usize>> {
        let root = DeTable::parse(self.text).ok()?;
        let DeValue::Array(tables) = root.get_ref().get("luminaire")?.get_ref() else { return None };
        let DeValue::Table(table) = tables.iter().find(|value| value.span() == table.span())?.get_ref() else {
            return None;
        };
        table.keys().find(|name| *name.get_ref() == key).map(Spanned::span)
    }

    /// Where one with a profile is, where it looks, what is up, and its factor.
    fn photometric(&self, table: &Spanned<LuminaireEntry>) -> Result<(DVec3, Vec3, Option<Vec3>, Vec3)> {
        let LuminaireEntry { kind, position, intensity, direction, up, .. } = table.get_ref();
        let LuminaireEntry { inner_angle, outer_angle, irradiance, angle, .. } = table.get_ref();
        let nothing_else = matches!((inner_angle, outer_angle, irradiance, angle), (None, None, None, None));
        let (LuminaireKind::Point, Some(position), true) = (kind, position, nothing_else) else {
            return Err(if matches!(kind, LuminaireKind::Point) {
                self.misfit(table, POINT, &["position"], &["profile", "intensity", "direction", "up"])
            } else {
                let message = format!("a `profile` is for a luminaire of the kind \"point\": {POINT}");
                self.error(table.span(), message)
            });
        };
        let direction = direction.as_ref().map_or(Ok(Vec3::NEG_Y), |direction| self.direction(table, direction))?;
        let up = match up {
            None => None,
            Some(up) => {
                let across = up.0.try_normalize().map(|up| up.cross(direction.as_dvec3()).length_squared());
                if across.is_none_or(|sine2| sine2 < ALONG) {
                    return Err(self.error(table.span(), "expected an `up` that is not along `direction`, nor zero"));
                }
                Some(up.0.normalize().as_vec3())
            }
        };
        Ok((position.0, direction, up, intensity.map_or(Vec3::ONE, |intensity| intensity.0)))
    }

    fn direction(&self, table: &Spanned<LuminaireEntry>, direction: &Triple) -> Result<Vec3> {
        match direction.rounded().as_dvec3().try_normalize() {
            Some(direction) => Ok(direction.as_vec3()),
            None => Err(self.error(table.span(), "the direction of the luminaire is the zero vector")),
        }
    }
}

/// Whether a unit vector is along y.
fn is_vertical(direction: Vec3) -> bool {
    f64::from(direction.x).hypot(direction.z.into()).powi(2) < ALONG
}
