//! The table `[[object]]` of a scene file.

use super::file::File;
use super::radians;
use super::tables::{ObjectTable, Scale};
use super::values::{Matrix, Triple};
use crate::scene::Object;
use crate::scene::load::format::Format;
use crate::scene::load::loader::{Loader, listed};
use crate::scene::load::model::{Reading, can_be_inverted};
use crate::scene::load::near_name::instead_of;
use crate::scene::load::obj;
use crate::scene::load::other_formats;
use crate::scene::load::text_file::{line_and_column, shortened};
use crate::{Error, Result};
use ::toml::Spanned;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::path::Path;

impl File<'_> {
    /// The objects of an `[[object]]`, and where they stand to every digit: as many as its model has.
    pub(super) fn objects(&self, table: &Spanned<ObjectTable>, loader: &mut Loader) -> Result<Vec<(Object, DAffine3)>> {
        let object = table.get_ref();
        let to_world = self.transform(table)?;
        let turned = object.rotate.and_then(|rotate| radians::rotation(rotate.rounded()));
        let smooth = object.smooth.and_then(|smooth| radians::smooth(smooth.0));
        for warning in turned.into_iter().chain(smooth) {
            let (line, _) = line_and_column(self.text, table.span().start);
            loader.warnings.push(format!("{}:{line}: {warning}", self.path.display()));
        }
        let mesh_path = self.named(&object.mesh, "an OBJ file")?;
        let Some(format) = Format::of(&mesh_path).filter(|format| *format != Format::SceneFile) else {
            let what = other_formats::named(&mesh_path).map(|what| format!(" ({what})")).unwrap_or_default();
            let message = format!("`{}`: a mesh has to be an .obj file{what}", object.mesh.get_ref());
            return Err(self.error(object.mesh.span(), message));
        };
        let how = Reading {
            smooth: object.smooth.map(|smooth| smooth.0.to_bits()),
            smooth_if_unsaid: false,
            without_colours: object.vertex_colours == Some(false),
        };
        let model = loader.model(&mesh_path, format, how).map_err(|error| match error {
            Error::Usage(message) => self.error(object.mesh.span(), message),
            // Where the file is named helps more than where it is not.
            Error::Read { .. } => self.error(object.mesh.span(), error.to_string() + &instead_of(&mesh_path)),
            other => other,
        })?;
        let (standing, flat) = model.standing(to_world);
        if standing.is_empty() {
            let message = match flat.len() {
                0 => "nothing of it can be shown: no mesh with triangles stands anywhere in it",
                _ => "the transform cannot be inverted: with those within the file it flattens everything",
            };
            return Err(self.error(object.mesh.span(), message));
        }
        if !flat.is_empty() {
            let (line, _) = line_and_column(self.text, table.span().start);
            let names = listed(flat.iter().map(|placed| &*placed.name));
            let why = "with the transform of this [[object]] theirs cannot be inverted";
            loader.warnings.push(format!("{}:{line}: {names} left out: {why}", self.path.display()));
        }
        let others = [("camera", model.cameras.len()), ("luminaire", model.luminaires.len())];
        let others: Vec<String> =
            others.iter().filter(|(_, count)| *count > 0).map(|(what, count)| format!("{count} {what}(s)")).collect();
        if !others.is_empty() {
            loader.notes.push(format!(
                "{}: of its {} none counts here: a scene file has its own, which `luminaire scene` writes for the model",
                mesh_path.display(),
                others.join(" and ")
            ));
        }
        let stem = || obj::file_name(Path::new(mesh_path.file_stem().unwrap_or_default()));
        let name = object.name.clone().unwrap_or_else(stem);
        let is_one = model.placed.len() == 1;
        let mut objects = Vec::new();
        for (placed, place) in standing {
            let mesh = placed.mesh;
            let material = match &object.material {
                None => None,
                Some(name) => Some(loader.material(mesh, name.get_ref()).ok_or_else(|| {
                    let message = format!(
                        "there is no material `{}`: neither an MTL file nor a [[material]] defines it; there are {}",
                        shortened(name.get_ref()),
                        loader.material_names()
                    );
                    self.error(name.span(), message)
                })?),
            };
            let name = if is_one { name.clone() } else { format!("{name}/{}", placed.name) };
            objects.push((Object { name, mesh, object_to_world: place.as_affine3a(), material }, place));
        }
        Ok(objects)
    }

    fn transform(&self, table: &Spanned<ObjectTable>) -> Result<DAffine3> {
        let ObjectTable { translate, rotate, scale, matrix, .. } = table.get_ref();
        if matrix.is_some() && (translate.is_some() || rotate.is_some() || scale.is_some()) {
            return Err(self.error(table.span(), "give either `matrix`, or `translate`, `rotate` and `scale`"));
        }
        let zero = Triple(DVec3::ZERO);
        let to_world = match matrix {
            Some(Matrix(rows)) => {
                let column = |c: usize| DVec3::new(rows[0][c].0, rows[1][c].0, rows[2][c].0);
                DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
            }
            None => {
                // Far from the origin every digit of a turn and of a factor counts, not of the place alone.
                let angles = rotate.unwrap_or(zero).0;
                let [x, y, z] = angles.to_array().map(f64::to_radians);
                let rotation = DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
                let scale = match scale {
                    None => DVec3::ONE,
                    Some(Scale::Even(scale)) => DVec3::splat(scale.0),
                    Some(Scale::Uneven(scale)) => scale.0,
                };
                let translation = translate.unwrap_or(zero).0;
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
        };
        if !can_be_inverted(&to_world) {
            return Err(self.error(table.span(), "the transform cannot be inverted: it flattens the object"));
        }
        Ok(to_world)
    }
}
