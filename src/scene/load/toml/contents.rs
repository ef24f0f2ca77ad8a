//! The table `[[object]]` of a scene file.

use super::file::File;
use super::radians;
use super::tables::{ObjectTable, Scale};
use super::values::{Matrix, Triple};
use crate::scene::Object;
use crate::scene::load::loader::Loader;
use crate::scene::load::near_name::instead_of;
use crate::scene::load::obj;
use crate::scene::load::other_formats;
use crate::scene::load::text_file::{line_and_column, shortened};
use crate::{Error, Result};
use ::toml::Spanned;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use std::path::Path;

impl File<'_> {
    /// An `[[object]]`, and where it stands to every digit.
    pub(super) fn object(&self, table: &Spanned<ObjectTable>, loader: &mut Loader) -> Result<(Object, DAffine3)> {
        let object = table.get_ref();
        let to_world = self.transform(table)?;
        let turned = object.rotate.and_then(|rotate| radians::rotation(rotate.rounded()));
        let smooth = object.smooth.and_then(|smooth| radians::smooth(smooth.0));
        for warning in turned.into_iter().chain(smooth) {
            let (line, _) = line_and_column(self.text, table.span().start);
            loader.warnings.push(format!("{}:{line}: {warning}", self.path.display()));
        }
        let mesh_path = self.named(&object.mesh, "an OBJ file")?;
        if !mesh_path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj")) {
            let what = other_formats::named(&mesh_path).map(|what| format!(" ({what})")).unwrap_or_default();
            let message = format!("`{}`: a mesh has to be an .obj file{what}", object.mesh.get_ref());
            return Err(self.error(object.mesh.span(), message));
        }
        let how = obj::Reading {
            smooth: object.smooth.map(|smooth| smooth.0.to_bits()),
            smooth_if_unsaid: false,
            without_colours: object.vertex_colours == Some(false),
        };
        let mesh = loader.mesh(&mesh_path, how).map_err(|error| match error {
            // Where the file is named helps more than where it is not.
            Error::Read { .. } => self.error(object.mesh.span(), error.to_string() + &instead_of(&mesh_path)),
            other => other,
        })?;
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
        let stem = || obj::file_name(Path::new(mesh_path.file_stem().unwrap_or_default()));
        let name = object.name.clone().unwrap_or_else(stem);
        Ok((Object { name, mesh, object_to_world: to_world.as_affine3a(), material }, to_world))
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
        let rounded = to_world.as_affine3a();
        let m = to_world.matrix3;
        let edges = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
        // The volume of the transformed unit cube against the box of the same edges: 1e-6 is where f32 loses all of it.
        let flat = m.determinant().abs() <= 1e-6 * edges;
        if flat || !rounded.is_finite() || !rounded.inverse().is_finite() {
            return Err(self.error(table.span(), "the transform cannot be inverted: it flattens the object"));
        }
        Ok(to_world)
    }
}
