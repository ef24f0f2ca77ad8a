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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::build::{cube, pinhole};
    use crate::scene::load::loader::AboutMesh;
    use crate::scene::load::model::{Model, Placed};
    use crate::scene::{Camera, widen};
    use glam::Vec3;

    /// The objects of an `[[object]]` with these keys whose file has these, and what is said.
    fn read(keys: &str, placed: &[(DAffine3, &str)]) -> (Result<Vec<(Object, DAffine3)>>, Loader) {
        let text = format!("[[object]]\nmesh = \"a.obj\"\n{keys}\n[[material]]\nname = \"red\"\n");
        let file = File { path: Path::new("a.toml"), text: &text };
        let tables = file.parse().unwrap();
        let mut loader = Loader::new(file.materials(&tables.material).unwrap());
        let mesh = loader.add(cube(), AboutMesh::default()).unwrap();
        let placed = placed.iter().map(|(matrix, name)| Placed { mesh, matrix: *matrix, name: (*name).into() });
        let sensor = pinhole(Vec3::Z, Vec3::ZERO, Vec3::Y, 40.0);
        let cameras = vec![(Camera { name: "c".into(), sensor }, DAffine3::IDENTITY)];
        let model = Model { placed: placed.collect(), cameras, ..Model::default() };
        loader.pretend(Path::new("a.obj"), Reading::default(), model);
        (file.objects(&tables.object[0], &mut loader), loader)
    }

    #[test]
    fn an_object_moves_all_that_its_file_has() {
        let there = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
        let mirrored = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 2.0));
        let keys = "name = \"both\"\nmaterial = \"red\"\nscale = 2\ntranslate = [0, 1, 0]";
        let (objects, loader) = read(keys, &[(there(3.0), "one"), (mirrored, "two")]);
        let objects = objects.unwrap();
        let names: Vec<&str> = objects.iter().map(|(object, _)| &*object.name).collect();
        assert_eq!(names, ["both/one", "both/two"]);
        let [(one, place), (two, _)] = &objects[..] else { panic!("{objects:?}") };
        assert_eq!(place.translation, DVec3::new(6.0, 1.0, 0.0));
        assert_eq!(one.object_to_world, place.as_affine3a());
        let two_to_world = widen(two.object_to_world);
        assert_eq!(two_to_world.matrix3, DMat3::from_diagonal(DVec3::new(-2.0, 2.0, 4.0)));
        assert_eq!((one.material, two.material, one.mesh), (two.material, Some(1), two.mesh));
        assert!(loader.notes.len() == 1 && loader.notes[0].contains("1 camera(s)"), "{:?}", loader.notes);
        // One alone has the object's name.
        let (objects, _) = read("", &[(there(3.0), "one")]);
        assert_eq!(objects.unwrap()[0].0.name, "a");
    }

    #[test]
    fn what_cannot_be_shown_is_said() {
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        let (objects, loader) = read("", &[(flat, "one"), (DAffine3::IDENTITY, "two")]);
        assert_eq!(objects.unwrap().len(), 1);
        assert!(loader.warnings[0].starts_with("a.toml:1: `one` left out"), "{:?}", loader.warnings);
        for (placed, words) in [(&[(flat, "one")][..], "flattens everything"), (&[], "no mesh with triangles")] {
            let error = read("", placed).0.unwrap_err().to_string();
            assert!(error.contains(words) && error.contains("a.toml:2:8"), "{error}");
        }
    }
}
