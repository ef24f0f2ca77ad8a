//! The loader: meshes, materials and textures that a scene has loaded so far, each file once.

use super::far::{self, FilePlace};
use super::format::Format;
use super::material_draft::Draft;
use super::model::{Model, Placed, Reading};
use super::text_file::shortened;
use super::texture::Textures;
use super::{ies, mtl, named_file, obj};
use crate::scene::{Material, Mesh, Object, Physical, Profile, Texture};
use crate::{Error, Result};
use glam::{DAffine3, DVec3};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The meshes and materials loaded so far; each file is read once.
#[derive(Debug)]
pub(super) struct Loader {
    /// Loaded meshes.
    pub meshes: Vec<Arc<Mesh>>,
    /// What was guessed, dropped or scaled.
    pub warnings: Vec<String>,
    /// What was chosen where there was a choice.
    pub notes: Vec<String>,
    /// Every file that was read or that a file names and that is there.
    pub files: Vec<PathBuf>,
    /// Materials as far as they are known; number 0 is the fallback, "default".
    pub drafts: Vec<Draft>,
    /// What the scene file says about materials, by name.
    overrides: Vec<Draft>,
    /// Materials that only the scene file defines.
    defined: HashMap<String, u32>,
    /// For each mesh, the materials of its file by name; those of an OBJ are in its MTL files.
    named: Vec<Arc<HashMap<String, u32>>>,
    /// For each mesh, where its file first uses a material without texture coordinates.
    without_uv: Vec<Vec<WithoutUv>>,
    /// Where each mesh lies in the coordinates of its file.
    places: Vec<FilePlace>,
    /// For each mesh, whether [`Reading::smooth`] made a difference.
    pub smoothed: Vec<bool>,
    /// By file and how it was read.
    models: HashMap<(PathBuf, Reading), Arc<Model>>,
    /// By material, the one that meshes with coloured vertices show instead.
    coloured: HashMap<u32, u32>,
    libraries: HashMap<PathBuf, HashMap<String, u32>>,
    profiles: HashMap<PathBuf, Arc<Profile>>,
}

/// What is known of a mesh beside its triangles.
#[derive(Debug, Default)]
pub(super) struct AboutMesh {
    /// Where it lies in the coordinates of its file.
    pub place: FilePlace,
    /// Whether [`Reading::smooth`] made a difference.
    pub smoothed: bool,
    /// The materials of its file by name; an object may ask for one of them.
    pub named: Arc<HashMap<String, u32>>,
    /// Its materials that some triangles without texture coordinates have.
    pub without_uv: Vec<WithoutUv>,
}

/// Faces of one material that lack texture coordinates.
#[derive(Debug)]
pub(super) struct WithoutUv {
    pub material: u32,
    /// `FILE:LINE` of the first of them.
    pub at: String,
}

impl Loader {
    /// Starts with the materials of a scene file.
    pub(super) fn new(overrides: Vec<Draft>) -> Self {
        Loader {
            meshes: Vec::new(),
            warnings: Vec::new(),
            notes: Vec::new(),
            files: overrides.iter().flat_map(Draft::map_files).collect(),
            drafts: vec![Draft::named("default")],
            overrides,
            defined: HashMap::new(),
            named: Vec::new(),
            without_uv: Vec::new(),
            places: Vec::new(),
            smoothed: Vec::new(),
            models: HashMap::new(),
            coloured: HashMap::new(),
            libraries: HashMap::new(),
            profiles: HashMap::new(),
        }
    }

    /// What a model file of this format has; the same file is read once.
    ///
    /// # Errors
    /// If the file cannot be read or is wrong; [`Error::Usage`] if its format is not read yet.
    pub(super) fn model(&mut self, path: &Path, format: Format, how: Reading) -> Result<Arc<Model>> {
        let identity = (identity(path), how);
        if let Some(model) = self.models.get(&identity) {
            return Ok(model.clone());
        }
        // The same file read another way has the same faults.
        let first = !self.models.keys().any(|(file, _)| *file == identity.0);
        let model = match format {
            Format::Obj => self.obj(path, how, first)?,
            Format::Gltf | Format::Glb | Format::Ply | Format::SceneFile => {
                // A file that is not there is no glTF either.
                std::fs::metadata(path).map_err(|error| Error::read(path, error))?;
                return Err(Error::Usage(format!("{}: {}", path.display(), format.not_yet())));
            }
        };
        let model = Arc::new(model);
        self.models.insert(identity, model.clone());
        Ok(model)
    }

    /// The mesh of an OBJ file with its MTL files.
    ///
    /// # Errors
    /// If the OBJ cannot be read or is wrong. A missing or wrong MTL file is a warning.
    fn obj(&mut self, path: &Path, how: Reading, first: bool) -> Result<Model> {
        let obj::Obj { mut mesh, place, materials, libraries, without_uv, smoothed, warnings } = obj::read(path, how)?;
        self.files.push(path.to_owned());
        self.warnings.extend(warnings.into_iter().filter(|warning| first || warning.contains("`smooth`")));
        let mut named = HashMap::new();
        for (names, line) in &libraries {
            self.library_line((path, *line), names, first, &mut named);
        }
        let mut missing = Vec::new();
        let coloured = !mesh.colours.is_empty();
        let fallback = if coloured { self.coloured(0) } else { 0 };
        // Entry 0 is for triangles before the first usemtl.
        let mut material_of = vec![fallback];
        for (name, line) in &materials {
            let index = named.get(name).copied().or_else(|| self.define(name));
            if index.is_none() {
                missing.push((name, *line));
            }
            material_of.push(index.unwrap_or(fallback));
        }
        if coloured {
            material_of.iter_mut().for_each(|index| *index = self.coloured(*index));
        }
        if let Some((_, line)) = missing.first().filter(|_| first) {
            let names = listed(missing.iter().map(|(name, _)| name.as_str()));
            let path = path.display();
            self.warnings.push(format!("{path}:{line}: no MTL file defines {names}; the material `default` is used"));
        }
        for triangle in &mut mesh.triangles {
            triangle.material = material_of[triangle.material as usize];
        }
        let at = |line| format!("{}:{line}", path.display());
        let without_uv =
            without_uv.iter().map(|(slot, line)| WithoutUv { material: material_of[*slot], at: at(*line) }).collect();
        let about = AboutMesh { place, smoothed, named: named.into(), without_uv };
        let mesh = self.add(mesh, about);
        let placed = mesh.map(|mesh| Placed { mesh, matrix: DAffine3::IDENTITY, name: obj::file_name(path) });
        Ok(Model { placed: placed.into_iter().collect(), ..Model::default() })
    }

    /// Keeps a mesh, whose triangles have the loader's materials, and gives its number; one without triangles is none.
    pub(super) fn add(&mut self, mesh: Mesh, about: AboutMesh) -> Option<u32> {
        if mesh.triangles.is_empty() {
            return None;
        }
        let AboutMesh { place, smoothed, named, without_uv } = about;
        self.meshes.push(mesh.into());
        self.places.push(place);
        self.smoothed.push(smoothed);
        self.named.push(named);
        self.without_uv.push(without_uv);
        Some(self.meshes.len() as u32 - 1)
    }

    /// The profile of a photometric file; the same file is read once.
    ///
    /// # Errors
    /// If it cannot be read or is wrong.
    pub(super) fn profile(&mut self, path: &Path) -> Result<Arc<Profile>> {
        let identity = identity(path);
        if let Some(profile) = self.profiles.get(&identity) {
            return Ok(profile.clone());
        }
        let profile = Arc::new(ies::read(path, &mut self.warnings)?);
        self.files.push(path.to_owned());
        self.profiles.insert(identity, profile.clone());
        Ok(profile)
    }

    /// The material that an object of `mesh` means by `name`: one of its own MTL files, else of any, else of the scene file.
    pub(super) fn material(&mut self, mesh: u32, name: &str) -> Option<u32> {
        let own = self.named[mesh as usize].get(name).copied();
        let any = || self.drafts.iter().position(|draft| draft.name == name).map(|index| index as u32);
        let index = own.or_else(any).or_else(|| self.define(name))?;
        Some(if self.meshes[mesh as usize].colours.is_empty() { index } else { self.coloured(index) })
    }

    /// Moves the scene to where single precision can hold it; see [`far::settle`].
    pub(super) fn settle(&mut self, objects: &mut [Object], to_world: &[DAffine3]) -> DVec3 {
        far::settle(&mut self.meshes, &mut self.places, objects, to_world, &mut self.warnings)
    }

    /// A material as meshes with coloured vertices show it: where nobody states a diffuse albedo it is white, not grey.
    fn coloured(&mut self, index: u32) -> u32 {
        let draft = &self.drafts[index as usize];
        if draft.coloured || draft.diffuse.is_some() {
            return index;
        }
        let number = self.drafts.len() as u32;
        let coloured = Draft { coloured: true, ..draft.clone() };
        *self.coloured.entry(index).or_insert_with(|| {
            self.drafts.push(coloured);
            number
        })
    }

    /// The names that [`Loader::material`] knows, for a message.
    pub(super) fn material_names(&self) -> String {
        let mut said = HashSet::new();
        let names = self.drafts.iter().chain(&self.overrides).map(|draft| draft.name.as_str());
        let names: Vec<_> = names.filter(|name| said.insert(*name)).collect();
        listed(names.into_iter())
    }

    /// Applies the scene file's materials, fills in every default and loads the textures. Only materials that some triangle of
    /// `objects` shows are worth a warning or a texture.
    pub(super) fn finish_materials(&mut self, objects: &[Object]) -> (Vec<Material>, Vec<Arc<Texture>>) {
        let shown = self.shown(objects);
        let changes: HashMap<&str, usize> = (0..).zip(&self.overrides).map(|(i, change)| (&*change.name, i)).collect();
        let mut known = vec![false; self.overrides.len()];
        let fallbacks = [Some(0), self.coloured.get(&0).copied()];
        for (index, draft) in self.drafts.iter_mut().enumerate() {
            if let Some(&change) = changes.get(&*draft.name) {
                draft.overlay(&self.overrides[change]);
                // The fallback is always there: what changes it changes something only where it is seen.
                known[change] |= !fallbacks.contains(&Some(index as u32)) || shown[index];
            }
            draft.settle();
        }
        for (change, known) in self.overrides.iter().zip(known) {
            if !known {
                self.warnings.push(format!("the material `{}` of the scene file is not used by anything", change.name));
            }
        }
        self.warn_of_shared(&shown);
        let mut textures = Textures::default();
        let mut materials = Vec::new();
        for (draft, shown) in self.drafts.iter().zip(shown) {
            if shown {
                materials.push(draft.finish(&mut textures, &mut self.warnings));
            } else {
                materials.push(draft.without_maps().finish(&mut textures, &mut Vec::new()));
            }
        }
        self.warn_of_missing_uvs(objects, &materials);
        (materials, textures.loaded)
    }

    /// For each material, whether some triangle of `objects` shows it.
    fn shown(&self, objects: &[Object]) -> Vec<bool> {
        let mut shown = vec![false; self.drafts.len()];
        let mut seen = vec![false; self.meshes.len()];
        for object in objects {
            match object.material {
                Some(material) => shown[material as usize] = true,
                None if std::mem::replace(&mut seen[object.mesh as usize], true) => {}
                None => {
                    let triangles = &self.meshes[object.mesh as usize].triangles;
                    triangles.iter().for_each(|triangle| shown[triangle.material as usize] = true);
                }
            }
        }
        shown
    }

    /// One warning for all materials of a file of which the same is to be said.
    fn warn_of_shared(&mut self, shown: &[bool]) {
        let mut groups: Vec<(&(String, String), Vec<&str>)> = Vec::new();
        let mut group_of: HashMap<&(String, String), usize> = HashMap::new();
        for (draft, _) in self.drafts.iter().zip(shown).filter(|(_, shown)| **shown) {
            for said in &draft.shared {
                let group = *group_of.entry(said).or_insert(groups.len());
                if group == groups.len() {
                    groups.push((said, Vec::new()));
                }
                groups[group].1.push(&draft.name);
            }
        }
        for ((file, what), names) in groups {
            let noun = if names.len() == 1 { "material" } else { "materials" };
            let names = listed(names.into_iter());
            self.warnings.push(format!("{file}: {noun} {names}: {what}"));
        }
    }

    /// Maps and brushing need texture coordinates.
    fn warn_of_missing_uvs(&mut self, objects: &[Object], materials: &[Material]) {
        let mut said = HashSet::new();
        let mut seen = HashSet::new();
        for object in objects.iter().filter(|object| seen.insert((object.mesh, object.material))) {
            for WithoutUv { material, at } in &self.without_uv[object.mesh as usize] {
                let material = &materials[object.material.unwrap_or(*material) as usize];
                let brushed = material.physical.as_ref().is_some_and(Physical::needs_tangents);
                if !(material.has_maps() || brushed) || !said.insert((&material.name, at)) {
                    continue;
                }
                let maps = "has maps; (0, 0) is used";
                let relief = ", and no normal is bent";
                let grain = "is anisotropic: its grain lies anyhow, as no tangent says which way";
                let said: String = match (material.has_maps(), material.bends_normal(), brushed) {
                    (false, ..) => grain.into(),
                    (true, bent, false) => format!("{maps}{}", if bent { relief } else { "" }),
                    (true, bent, true) => format!("{maps}{}; it {grain}", if bent { relief } else { "" }),
                };
                let name = &material.name;
                self.warnings.push(format!("{at}: faces without texture coordinates, but material `{name}` {said}"));
            }
        }
    }

    /// A new material, if the scene file has one of this name; the same one the next time.
    fn define(&mut self, name: &str) -> Option<u32> {
        if let Some(index) = self.defined.get(name) {
            return Some(*index);
        }
        self.overrides.iter().any(|draft| draft.name == name).then(|| {
            let index = self.drafts.len() as u32;
            self.drafts.push(Draft::named(name));
            self.defined.insert(name.to_owned(), index);
            index
        })
    }

    /// Reads what one `mtllib` line names. What is wrong with it is said where the OBJ is read for the `first` time.
    fn library_line(
        &mut self,
        (obj, line): (&Path, usize),
        names: &str,
        first: bool,
        named: &mut HashMap<String, u32>,
    ) {
        let folder = obj.parent().unwrap_or(Path::new(""));
        if names.is_empty() && first {
            self.warnings.push(format!("{}:{line}: mtllib names no file; ignored", obj.display()));
        }
        for (library, guess) in named_file::libraries(folder, names) {
            let mut said = guess.into_iter().collect::<Vec<_>>();
            match self.library(&library) {
                Ok(materials) => named.extend(materials),
                Err(error) => said.push(error.to_string()),
            }
            let said = said.into_iter().filter(|_| first);
            self.warnings.extend(said.map(|said| format!("{}:{line}: {said}", obj.display())));
        }
    }

    /// Name and index of each material of an MTL file.
    fn library(&mut self, path: &Path) -> Result<HashMap<String, u32>> {
        let identity = identity(path);
        if let Some(materials) = self.libraries.get(&identity) {
            return Ok(materials.clone());
        }
        if path.is_file() {
            self.files.push(path.to_owned());
            self.files.extend(mtl::named_files(path));
        }
        let mut materials = HashMap::new();
        let mtl::Library { drafts, note } = mtl::read(path, &mut self.warnings)?;
        self.notes.extend(note);
        for draft in drafts {
            materials.insert(draft.name.clone(), self.drafts.len() as u32);
            self.drafts.push(draft);
        }
        self.libraries.insert(identity, materials.clone());
        Ok(materials)
    }
}

#[cfg(test)]
impl Loader {
    /// Takes this for what a model file of this name has.
    pub(super) fn pretend(&mut self, path: &Path, how: Reading, model: Model) {
        self.models.insert((identity(path), how), Arc::new(model));
    }
}

/// A list of names in a warning, not too long.
pub(super) fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const MOST: usize = 8;
    let more = names.len().saturating_sub(MOST);
    let text = names.take(MOST).map(|name| format!("`{}`", shortened(name))).collect::<Vec<_>>().join(", ");
    if more > 0 { format!("{text} and {more} more") } else { text }
}

/// One name for one file, however the path is spelled.
fn identity(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}
