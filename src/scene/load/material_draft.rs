//! A material while it is still being read: what nobody has said yet is `None`.

pub(super) use super::map_draft::MapDraft;
use super::map_file::{Channel, MapFile};
use super::mapped_number::{Mapped, Number};
use super::physical_draft::{MetalColour, PhysicalDraft, PhysicalDraftMaps, bounded};
use super::texture::{Looks, Relief, Textures};
use crate::scene::{BumpMap, Maps, Material, NormalMap};
use glam::Vec3;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// The exponent of a glossy material that states none.
pub(super) const DEFAULT_EXPONENT: f32 = 10.0;
/// The diffuse albedo of a material that states no colour at all.
pub(super) const DEFAULT_LAMBERT: Vec3 = Vec3::splat(0.8);
/// The index of refraction of glass that states none.
pub(super) const DEFAULT_ETA: f32 = 1.5;

/// Indices of refraction that are modelled. Matter has 1 to about 4; the squares of these still leave single precision room.
pub(super) const ETAS: RangeInclusive<f32> = 0.01..=100.0;
/// The largest exponent: its lobe is a hundredth of a degree wide, which in a picture looks like a mirror.
pub(super) const LARGEST_EXPONENT: f32 = 1e8;

/// The `Ks` that exporters write who mean nothing by it.
pub(super) const UNSAID_KS: Vec3 = Vec3::splat(0.5);

/// What MTL and scene file say about a material.
#[derive(Debug, Clone, Default)]
pub(super) struct Draft {
    /// Its name.
    pub name: String,
    /// `Ka`.
    pub ambient: Option<Vec3>,
    /// `Kd`.
    pub diffuse: Option<Vec3>,
    /// `Ks`.
    pub glossy: Option<Vec3>,
    /// `Ns`, at most [`LARGEST_EXPONENT`].
    pub exponent: Option<f32>,
    /// `Ke`.
    pub emission: Option<Vec3>,
    /// Whether only the outward side emits.
    pub one_sided: Option<bool>,
    /// Albedo of the impulse reflection.
    pub reflection: Option<Vec3>,
    /// Albedo of the impulse transmission.
    pub transmission: Option<Vec3>,
    /// Index of refraction, one of [`ETAS`].
    pub eta: Option<f32>,
    /// Whether it is a sheet whose two sides are one surface.
    pub thin: Option<bool>,
    /// Probability of taking an impulse.
    pub impulse_probability: Option<f32>,
    /// `d`.
    pub opacity: Option<f32>,
    /// Factor to what the normals of a map have along the surface.
    pub normal_scale: Option<f32>,
    /// Length of a height of 1.
    pub bump_scale: Option<f32>,
    /// Whether an MTL file names the map of normals.
    pub normal_word: bool,
    /// What the map of heights may be besides.
    pub bump_word: BumpWord,
    /// The maps of all these.
    pub maps: DraftMaps,
    /// Warnings that many materials of a file may share: the file, and what is said of them.
    pub shared: Vec<(String, String)>,
    /// Whether it is on meshes whose vertices have colours, which multiply the diffuse albedo.
    pub coloured: bool,
    /// What had to be guessed: warnings, if the material is in use.
    pub notes: Vec<String>,
    /// What else it is as a metallic-roughness surface, whose base colour is `diffuse`; none: it is what the lecture describes.
    pub physical: Option<Box<PhysicalDraft>>,
    /// Of a scene file: the first key that only what the lecture describes has, and where it stands.
    pub blinn_phong: Option<(&'static str, String)>,
    /// The same words of an MTL file as a surface of the other kind.
    pub otherwise: Option<Box<Draft>>,
}

/// Who names the map of heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum BumpWord {
    /// A scene file, in which it is nothing else.
    #[default]
    Key,
    /// An MTL file, whose word stands for normals, too: the image tells.
    Mtl,
    /// The same from Blender, which writes it of normals.
    Blender,
}

/// The maps of a [`Draft`].
#[derive(Debug, Clone, Default)]
pub(super) struct DraftMaps {
    /// `map_Ka`.
    pub ambient: MapDraft,
    /// `map_Kd`.
    pub diffuse: MapDraft,
    /// `map_Ks`.
    pub glossy: MapDraft,
    /// `map_Ke`.
    pub emission: MapDraft,
    /// `map_d`.
    pub opacity: MapDraft,
    /// `norm`.
    pub normal: MapDraft,
    /// `map_Bump`.
    pub bump: MapDraft,
}

impl Draft {
    /// A material of which nothing but the name is known.
    pub(super) fn named(name: &str) -> Self {
        Draft { name: name.to_owned(), ..Draft::default() }
    }

    /// The files of its maps that are there.
    pub(super) fn map_files(&self) -> Vec<PathBuf> {
        let DraftMaps { ambient, diffuse, glossy, emission, opacity, normal, bump } = &self.maps;
        let physical = self.physical.iter().flat_map(|physical| physical.maps.all());
        let maps = [ambient, diffuse, glossy, emission, opacity, normal, bump].into_iter().chain(physical);
        maps.filter_map(MapDraft::file).filter_map(MapFile::path).collect()
    }

    /// The same material without any map.
    pub(super) fn without_maps(&self) -> Self {
        let mut bare = Draft { maps: DraftMaps::default(), ..self.clone() };
        if let Some(physical) = &mut bare.physical {
            physical.maps = PhysicalDraftMaps::default();
        }
        bare
    }

    /// Every number and colour that has a map, those that both kinds of surface have first.
    fn mapped(&mut self) -> Vec<Mapped<'_>> {
        let maps = &self.maps;
        let one = |key, map_key, number, map| Mapped { key, map_key, number: Number::One(number), map };
        let colour = |key, map_key, colour, map| Mapped { key, map_key, number: Number::Colour(colour), map };
        let (base, base_map) =
            if self.physical.is_some() { ("base_colour", "base_colour_map") } else { ("diffuse", "diffuse_map") };
        let mut all = vec![
            colour(base, base_map, &mut self.diffuse, &maps.diffuse),
            colour("emission", "emission_map", &mut self.emission, &maps.emission),
            colour("ambient", "ambient_map", &mut self.ambient, &maps.ambient),
            colour("glossy", "glossy_map", &mut self.glossy, &maps.glossy),
            one("opacity", "opacity_map", &mut self.opacity, &maps.opacity),
            one("normal_scale", "normal_map", &mut self.normal_scale, &maps.normal),
            one("bump_scale", "bump_map", &mut self.bump_scale, &maps.bump),
        ];
        all.extend(self.physical.iter_mut().flat_map(|physical| physical.mapped()));
        all
    }

    /// What is to be said of maps of a scene file's table that do nothing, because the number in the same table is 0. (A scale of 0 is another word for no map.)
    pub(super) fn idle_maps(&mut self) -> Vec<String> {
        let name = self.name.clone();
        let mapped = self.mapped();
        let idle = mapped.iter().filter(|mapped| !mapped.key.ends_with("_scale")).filter_map(|mapped| {
            let Mapped { key, map_key, .. } = mapped;
            let at = &mapped.idle_map()?.at;
            Some(format!("{at}: material `{name}`: `{map_key}` does nothing where `{key}` is 0; leave `{key}` out"))
        });
        idle.collect()
    }

    /// A number of 0 over which `other` names a map is missing: exporters write 0 for everything, and the map would do nothing.
    fn wake(&mut self, other: &Draft) {
        let name = self.name.clone();
        let mut other = other.clone();
        let wake = |(own, said): (&mut Mapped, &Mapped)| {
            let map = own.wake(said)?;
            let Mapped { key, map_key, .. } = own;
            Some(format!(
                "{}: material `{name}`: the MTL file has 0 for `{key}`, with which `{map_key}` would do nothing; 1 is used, unless `{key}` says otherwise",
                map.at
            ))
        };
        let notes: Vec<String> = self.mapped().iter_mut().zip(&other.mapped()).filter_map(wake).collect();
        self.notes.extend(notes);
    }

    /// Decides what depends on all that is said: once nothing more is laid over it. A metal without another colour has that of its reflection.
    pub(super) fn settle(&mut self) {
        let Some(physical) = &mut self.physical else { return };
        let Some(MetalColour { colour, map, file }) = physical.metal_colour.take() else { return };
        let coloured = self.diffuse.is_some_and(|base| base != Vec3::ZERO) || self.maps.diffuse.file().is_some();
        if coloured || physical.conductor.is_some() {
            return;
        }
        if physical.is_metal() {
            (self.diffuse, self.maps.diffuse) = (colour, map);
            self.shared.push((file, "Kd is black, and Ks taken as the colour of the metal (base colour)".into()));
        } else if map.file().is_some() || colour.is_some_and(|ks| ks != UNSAID_KS) {
            let said = "Kd is black, and Ks ignored, which would be the colour of a metal: with Pm 1 it is one";
            self.shared.push((file, said.into()));
        }
    }

    /// Replaces what `other` states. What only one kind of surface has makes it one of that kind.
    pub(super) fn overlay(&mut self, other: &Draft) {
        match (&other.physical, &other.blinn_phong) {
            (Some(_), _) if self.physical.is_none() => match self.otherwise.take() {
                Some(otherwise) => *self = Draft { coloured: self.coloured, ..*otherwise },
                None => self.physical = Some(Box::default()),
            },
            (_, Some((key, at))) if self.physical.take().is_some() => {
                if let Some(otherwise) = self.otherwise.take() {
                    *self = Draft { coloured: self.coloured, ..*otherwise };
                }
                if *key != "model" {
                    self.notes.push(format!(
                        "{at}: `{key}` is a word of Blinn-Phong, so that of material `{}` the words of the MTL file are taken by the letter, too; as \
                         a metallic-roughness surface, which the file means, it has `base_colour`, `roughness` and others",
                        self.name
                    ));
                }
            }
            _ => {}
        }
        self.wake(other);
        self.notes.extend(other.notes.iter().cloned());
        if let (Some(physical), Some(other)) = (&mut self.physical, &other.physical) {
            physical.overlay(other);
        }
        if let Some(physical) = &mut self.physical
            && (other.diffuse.is_some() || other.maps.diffuse.file().is_some())
        {
            physical.metal_colour = None;
        }
        self.ambient = other.ambient.or(self.ambient);
        self.diffuse = other.diffuse.or(self.diffuse);
        self.glossy = other.glossy.or(self.glossy);
        self.exponent = other.exponent.or(self.exponent);
        self.emission = other.emission.or(self.emission);
        self.one_sided = other.one_sided.or(self.one_sided);
        self.reflection = other.reflection.or(self.reflection);
        self.transmission = other.transmission.or(self.transmission);
        self.eta = other.eta.or(self.eta);
        self.thin = other.thin.or(self.thin);
        self.impulse_probability = other.impulse_probability.or(self.impulse_probability);
        self.opacity = other.opacity.or(self.opacity);
        self.normal_scale = other.normal_scale.or(self.normal_scale);
        self.bump_scale = other.bump_scale.or(self.bump_scale);
        if other.maps.normal.file().is_some() {
            self.normal_word = other.normal_word;
        }
        self.maps.normal.overlay(&other.maps.normal);
        if !matches!(other.maps.bump, MapDraft::Unstated) {
            // Whoever names a map by this key means what it says.
            self.bump_word = other.bump_word;
            self.maps.bump.overlay(&other.maps.bump);
        }
        self.maps.ambient.overlay(&other.maps.ambient);
        self.maps.diffuse.overlay(&other.maps.diffuse);
        self.maps.glossy.overlay(&other.maps.glossy);
        self.maps.emission.overlay(&other.maps.emission);
        self.maps.opacity.overlay(&other.maps.opacity);
    }

    /// Fills in the defaults, loads the maps and scales down what would create energy; each such decision is a warning.
    ///
    /// A missing number whose map is given is 1, unless the map cannot be used. Without a map, a missing diffuse albedo is 0.8 (1 under the colours of vertices), but 0 where the material is
    /// described by another albedo or an emission alone; a missing ambient albedo is the diffuse one with its map.
    pub(super) fn finish(&self, textures: &mut Textures, warnings: &mut Vec<String>) -> Material {
        let name = &self.name;
        warnings.extend(self.notes.iter().cloned());
        if let Some(physical) = &self.physical {
            return self.finish_physical(physical, textures, warnings);
        }
        let one_if = |map: &MapDraft| if map.file().is_some() { Vec3::ONE } else { Vec3::ZERO };
        let glossy = self.glossy.unwrap_or(one_if(&self.maps.glossy));
        let emission = self.emission.unwrap_or(one_if(&self.maps.emission));
        let transmission = self.transmission.unwrap_or(Vec3::ZERO);
        // Light that goes through a surface is also reflected by it, unless somebody says otherwise.
        let entered = if transmission == Vec3::ZERO { Vec3::ZERO } else { Vec3::ONE };
        let reflection = self.reflection.unwrap_or(entered);
        let lambert_beside = |glossy: Vec3| {
            // A zero describes nothing: exporters write `Ks 0 0 0` and `Ke 0 0 0` for everything.
            let described = [glossy, emission, reflection, transmission].iter().any(|colour| *colour != Vec3::ZERO);
            self.diffuse.unwrap_or(match (self.maps.diffuse.file(), described) {
                (Some(_), _) => Vec3::ONE,
                (None, true) => Vec3::ZERO,
                (None, false) if self.coloured => Vec3::ONE,
                (None, false) => DEFAULT_LAMBERT,
            })
        };
        let lambert = lambert_beside(glossy);
        let impulses = reflection != Vec3::ZERO || transmission != Vec3::ZERO;
        let without = [
            ("eta", self.eta.is_some() && !impulses, "`reflection` or `transmission`"),
            ("thin", self.thin == Some(true) && transmission == Vec3::ZERO, "`transmission`"),
            ("impulse_probability", self.impulse_probability.is_some() && !impulses, "`reflection` or `transmission`"),
            ("one_sided", self.one_sided.is_some() && emission == Vec3::ZERO, "`emission`"),
        ];
        for (key, idle, other) in without {
            if idle {
                warnings.push(format!("material `{name}`: `{key}` does nothing without {other}"));
            }
        }
        let mut material = Material {
            name: name.clone(),
            ambient: match (self.ambient, self.maps.ambient.file()) {
                (Some(ambient), _) => ambient,
                (None, Some(_)) => Vec3::ONE,
                (None, None) => lambert,
            },
            lambert,
            glossy,
            exponent: self.exponent.unwrap_or(DEFAULT_EXPONENT),
            emission,
            one_sided: self.one_sided.unwrap_or(false),
            reflection,
            transmission,
            eta: self.eta,
            thin: self.thin.unwrap_or(false),
            impulse_probability: self.impulse_probability,
            opacity: self.opacity.unwrap_or(1.0),
            maps: Maps::default(),
            normal_map: None,
            bump_map: None,
            physical: None,
        };
        if material.transmission != Vec3::ZERO && material.eta.is_none() {
            material.eta = Some(DEFAULT_ETA);
            warnings.push(format!(
                "material `{name}` transmits but states no index of refraction (Ni, eta); {DEFAULT_ETA} is used"
            ));
        }
        self.load_maps(&mut material, textures, warnings);
        if self.glossy.is_none() && self.maps.glossy.file().is_some() && material.maps.glossy.is_none() {
            warnings.push(format!("material `{name}`: without the map that cannot be used it is not glossy"));
            (material.glossy, material.lambert) = (Vec3::ZERO, lambert_beside(Vec3::ZERO));
            if self.ambient.is_none() && self.maps.ambient.file().is_none() {
                material.ambient = material.lambert;
            }
        }
        if material.glossy != Vec3::ZERO && self.exponent.is_none() {
            warnings
                .push(format!("material `{name}` is glossy but states no exponent (Ns); {DEFAULT_EXPONENT} is used"));
        }
        self.load_relief(&mut material, textures, warnings);
        if material.opacity == 0.0 {
            warnings.push(format!("material `{name}` has opacity 0 (d): its surfaces cannot be seen"));
        }
        conserve_energy(&mut material, textures, warnings);
        material
    }

    /// What bends normals. A scale of 0 is no map.
    fn load_relief(&self, material: &mut Material, textures: &mut Textures, warnings: &mut Vec<String>) {
        let name = &self.name;
        for (key, stated, map) in [
            ("normal", self.normal_scale.is_some(), &self.maps.normal),
            ("bump", self.bump_scale.is_some(), &self.maps.bump),
        ] {
            if stated && map.file().is_none() {
                warnings.push(format!("material `{name}`: `{key}_scale` does nothing without `{key}_map`"));
            }
        }
        let scale = self.normal_scale.unwrap_or(1.0);
        if let Some(map) = self.maps.normal.file().filter(|_| scale != 0.0) {
            material.normal_map = textures.normals(map, warnings).map(|texture| NormalMap { texture, scale });
            let looks = material.normal_map.map(|map| textures.looks(map.texture));
            let (key, bump) = if self.normal_word { ("norm", "map_Bump") } else { ("normal_map", "bump_map") };
            let looks = match looks {
                Some(Looks::Grey) => Some(format!("is grey and looks like heights, which is `{bump}`")),
                Some(Looks::NoNormals) => Some("looks like no normals, as most of them are not of unit length".into()),
                _ => None,
            };
            if let Some(looks) = looks {
                warnings.push(format!(
                    "{}: material `{name}`: the image of `{key}` {looks}; it is taken as normals",
                    map.at
                ));
            }
        }
        let scale = self.bump_scale.unwrap_or(1.0);
        let Some(map) = self.maps.bump.file().filter(|_| scale != 0.0) else { return };
        match textures.relief(map, self.bump_word != BumpWord::Key, warnings) {
            None => {}
            Some(Relief::Heights(texture)) => {
                if textures.looks(texture) == Looks::Normals {
                    warnings.push(format!(
                        "{}: material `{name}`: the image of `bump_map` looks like a map of normals, which is `normal_map`; it is taken as heights",
                        map.at
                    ));
                }
                material.bump_map = Some(BumpMap { texture, scale });
            }
            Some(Relief::Normals(texture)) if material.normal_map.is_none() => {
                if self.bump_word == BumpWord::Mtl {
                    warnings.push(format!(
                        "{}: material `{name}`: the image of map_Bump looks like a map of normals and is taken as one, -bm as its strength; `norm` in \
                         place of map_Bump says so",
                        map.at
                    ));
                }
                material.normal_map = Some(NormalMap { texture, scale });
            }
            Some(Relief::Normals(_)) if self.maps.normal.file().is_some_and(|normals| normals.is_same_file(map)) => {}
            Some(Relief::Normals(_)) => warnings
                .push(format!("{}: material `{name}`: map_Bump holds normals too, of which `norm` counts", map.at)),
        }
    }

    /// The same of a metallic-roughness surface: a missing base colour is 0.8, but 1 with a map or under the colours of vertices. Only what no texel of its map
    /// may exceed is scaled.
    fn finish_physical(
        &self,
        physical: &PhysicalDraft,
        textures: &mut Textures,
        warnings: &mut Vec<String>,
    ) -> Material {
        let name = &self.name;
        let base = self.diffuse.unwrap_or(match self.maps.diffuse.file() {
            Some(_) => Vec3::ONE,
            None if self.coloured => Vec3::ONE,
            None => DEFAULT_LAMBERT,
        });
        let thin = self.thin.unwrap_or(false);
        let mut surface = physical.finish(name, thin, textures, warnings);
        let one_if = |map: &MapDraft| if map.file().is_some() { Vec3::ONE } else { Vec3::ZERO };
        let mut material = Material {
            name: name.clone(),
            ambient: self.ambient.unwrap_or(if self.maps.ambient.file().is_some() { Vec3::ONE } else { base }),
            lambert: base,
            emission: self.emission.unwrap_or(one_if(&self.maps.emission)),
            one_sided: self.one_sided.unwrap_or(false),
            transmission: Vec3::splat(surface.transmission),
            thin,
            opacity: self.opacity.unwrap_or(1.0),
            ..Material::default()
        };
        if self.one_sided.is_some() && material.emission == Vec3::ZERO {
            warnings.push(format!("material `{name}`: `one_sided` does nothing without `emission`"));
        }
        if material.emission != Vec3::ZERO && surface.clearcoat > 0.0 {
            warnings.push(format!("material `{name}`: its coat does not dim what it emits"));
        }
        self.load_maps(&mut material, textures, warnings);
        self.load_relief(&mut material, textures, warnings);
        if material.opacity == 0.0 {
            warnings.push(format!("material `{name}` has opacity 0 (d): its surfaces cannot be seen"));
        }
        surface.maps.base_color = material.maps.lambert.take();
        surface.base_color = bounded(base, surface.maps.base_color, "base colour", name, textures, warnings);
        if self.ambient.is_none() && self.maps.ambient.file().is_none() {
            material.ambient = surface.base_color;
        }
        Material { lambert: Vec3::ZERO, transmission: Vec3::ZERO, physical: Some(surface), ..material }
    }

    /// Maps of numbers that are zero are not even looked for.
    fn load_maps(&self, material: &mut Material, textures: &mut Textures, warnings: &mut Vec<String>) {
        // The map whose alpha is the opacity, if one is.
        let coverage = match &self.maps.opacity {
            MapDraft::File(map) => Some(map).filter(|map| matches!(map.channel, Channel::Any | Channel::One(3))),
            MapDraft::Removed => None,
            // See below.
            MapDraft::Unstated if material.transmission != Vec3::ZERO => None,
            MapDraft::Unstated => self.maps.diffuse.file(),
        };
        let wanted = |colour: Vec3, map: &MapDraft| {
            let map = map.file().filter(|_| colour != Vec3::ZERO)?;
            Some(MapFile { straight: coverage.is_some_and(|coverage| coverage.is_same_file(map)), ..map.clone() })
        };
        let mut visible = |colour: Vec3, map: &MapDraft, warnings: &mut Vec<String>| {
            wanted(colour, map).map(|map| textures.visible(&map, warnings))
        };
        material.maps.lambert = visible(material.lambert, &self.maps.diffuse, warnings);
        material.maps.emission = visible(material.emission, &self.maps.emission, warnings);
        material.maps.ambient = if self.ambient.is_none() && self.maps.ambient.file().is_none() {
            material.maps.lambert
        } else {
            visible(material.ambient, &self.maps.ambient, warnings)
        };
        let glossy = wanted(material.glossy, &self.maps.glossy);
        material.maps.glossy = glossy.and_then(|map| textures.optional(&map, warnings));
        match &self.maps.opacity {
            MapDraft::File(map) if material.opacity > 0.0 => material.maps.opacity = textures.opacity(map, warnings),
            MapDraft::File(_) | MapDraft::Removed => {}
            // Glass has its colour from transmission; alpha then is an exporter's other word for it.
            MapDraft::Unstated if material.transmission != Vec3::ZERO => {}
            MapDraft::Unstated => {
                let Some(map) = material.maps.lambert else { return };
                match textures.range(map).alpha {
                    (_, 0.0) => warnings.push(format!(
                        "the alpha of {}, a texture of material `{}`, is 0 everywhere; it is taken as opaque",
                        textures.loaded[map as usize].name, self.name
                    )),
                    (least, _) if least < 1.0 => material.maps.opacity = Some(map),
                    _ => {}
                }
            }
        }
    }
}

/// Scales the albedos so that no channel reflects and transmits more than it receives. A coat, which reflects the share F, passes the share
/// 1 - F on to the base: there reflection and base have each a bound of their own.
fn conserve_energy(material: &mut Material, textures: &Textures, warnings: &mut Vec<String>) {
    let largest = |map: Option<u32>| map.map_or(Vec3::ONE, |map| textures.range(map).largest);
    let (lambert_map, glossy_map) = (largest(material.maps.lambert), largest(material.maps.glossy));
    let base = |m: &Material| m.lambert * lambert_map + m.glossy * glossy_map;
    if material.is_coated() {
        limit(material, [false, true], |m| m.reflection.max_element(), warnings);
        limit(material, [true, false], |m| base(m).max_element(), warnings);
    } else {
        limit(material, [true; 2], |m| (base(m) + m.reflection.max(m.transmission)).max_element(), warnings);
    }
}

/// Scales some of the albedos (lambert and glossy; reflection and transmission) so that `sum`, which is linear in them, is at most 1.
fn limit(material: &mut Material, scaled: [bool; 2], sum: impl Fn(&Material) -> f32, warnings: &mut Vec<String>) {
    let before = sum(material);
    if before <= 1.0 {
        return;
    }
    let original = material.clone();
    let mut factor = 1.0 / before;
    let [base, impulses] = scaled;
    let scale = |material: &mut Material, factor: f32| {
        let by = |scaled: bool| if scaled { factor } else { 1.0 };
        material.lambert = original.lambert * by(base);
        material.glossy = original.glossy * by(base);
        material.reflection = original.reflection * by(impulses);
        material.transmission = original.transmission * by(impulses);
    };
    scale(material, factor);
    while sum(material) > 1.0 {
        factor *= 1.0 - f32::EPSILON;
        scale(material, factor);
    }
    // Below that it is the rounding of the sum, which nobody needs to hear about.
    if before > 1.000_01 {
        let part = |scaled: bool, albedo: Vec3| if scaled { albedo.max_element() } else { 0.0 };
        let (reflection, transmission) = (part(impulses, original.reflection), part(impulses, original.transmission));
        let parts = [
            (part(base, original.lambert), "diffuse"),
            (part(base, original.glossy), "glossy"),
            (reflection.max(transmission), if transmission > reflection { "transmission" } else { "reflection" }),
        ];
        let parts: Vec<_> = parts.iter().filter(|(albedo, _)| *albedo > 0.0).map(|(_, name)| *name).collect();
        let (verb, all) = if parts.len() == 1 { ("reaches", "it is") } else { ("reach", "all are") };
        warnings.push(format!(
            "material `{}` would create energy: {} albedo {verb} {before}; {all} scaled by {factor:.4}",
            original.name,
            parts.join(" + ")
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finish(draft: &Draft, warnings: &mut Vec<String>) -> Material {
        draft.finish(&mut Textures::default(), warnings)
    }

    #[test]
    fn albedos_never_exceed_one_after_scaling() {
        for i in 0..2000 {
            let x = 0.5 + i as f32 * 0.001_37;
            let draft = Draft {
                diffuse: Some(Vec3::new(x, 0.3, x * 0.7)),
                glossy: Some(Vec3::new(0.9, x * 1.9, 0.1)),
                reflection: Some(Vec3::new(0.1, 0.0, x)),
                transmission: Some(Vec3::new(0.2, x, 0.0)),
                ..Draft::named("m")
            };
            let m = finish(&draft, &mut Vec::new());
            assert!(!m.is_coated(), "glass lies beside its base: {m:?}");
            assert!((m.lambert + m.glossy + m.reflection.max(m.transmission)).max_element() <= 1.0, "{m:?}");
            let ratio = m.lambert.x / x;
            assert!((m.transmission.y - ratio * x).abs() < 1e-6, "all by the same factor: {m:?}");
            let plastic = finish(&Draft { transmission: None, eta: Some(1.5), ..draft.clone() }, &mut Vec::new());
            assert!(plastic.is_coated() && (plastic.lambert + plastic.glossy).max_element() <= 1.0, "{plastic:?}");
            assert!((plastic.reflection.z - x.min(1.0)).abs() < 1e-6, "not scaled below what it may be: {plastic:?}");
            let mirror = finish(&Draft { transmission: None, ..draft }, &mut Vec::new());
            assert!((mirror.lambert + mirror.glossy + mirror.reflection).max_element() <= 1.0, "{mirror:?}");
            let ratio = mirror.lambert.x / x;
            assert!((mirror.reflection.z - ratio * x).abs() < 1e-6, "all by the same factor: {mirror:?}");
        }
    }

    /// A Fresnel mirror over a base is no more than white where base and mirror are; what exceeds that is said of the part that does.
    #[test]
    fn a_coated_base_is_scaled_only_where_it_exceeds_white() {
        let plastic = Draft {
            diffuse: Some(Vec3::splat(0.8)),
            reflection: Some(Vec3::ONE),
            eta: Some(1.5),
            ..Draft::named("plastic")
        };
        let mut warnings = Vec::new();
        let m = finish(&plastic, &mut warnings);
        assert_eq!((m.lambert, m.reflection), (Vec3::splat(0.8), Vec3::ONE));
        assert!(warnings.is_empty(), "{warnings:?}");

        let bright = Draft { diffuse: Some(Vec3::splat(2.0)), ..plastic.clone() };
        assert_eq!(finish(&bright, &mut warnings).lambert, Vec3::ONE);
        assert!(warnings.len() == 1 && warnings[0].contains("energy: diffuse albedo reaches 2"), "{warnings:?}");
        let coat = Draft { reflection: Some(Vec3::splat(4.0)), ..plastic.clone() };
        let m = finish(&coat, &mut warnings);
        assert_eq!((m.lambert, m.reflection), (Vec3::splat(0.8), Vec3::ONE));
        assert!(warnings.len() == 2 && warnings[1].contains("energy: reflection albedo reaches 4"), "{warnings:?}");
        let mirror = finish(&Draft { eta: None, ..plastic.clone() }, &mut warnings);
        assert!(warnings.len() == 3 && (mirror.reflection.x - 1.0 / 1.8).abs() < 1e-6, "beside each other: {mirror:?}");
        let glassy = finish(&Draft { transmission: Some(Vec3::splat(0.2)), ..plastic }, &mut warnings);
        assert!(warnings.len() == 4 && (glassy.transmission.x - 0.2 / 1.8).abs() < 1e-6, "so does glass: {glassy:?}");
    }

    #[test]
    fn a_lamp_without_kd_is_black_and_an_empty_material_is_grey() {
        let mut warnings = Vec::new();
        assert_eq!(finish(&Draft::named("m"), &mut warnings).lambert, DEFAULT_LAMBERT);
        let lamp = Draft { emission: Some(Vec3::ONE), ..Draft::named("lamp") };
        assert_eq!(finish(&lamp, &mut warnings).lambert, Vec3::ZERO);
        assert!(warnings.is_empty());
    }

    #[test]
    fn keys_that_do_nothing_are_warned_about() {
        let draft =
            Draft { eta: Some(1.5), impulse_probability: Some(0.5), one_sided: Some(true), ..Draft::named("glass") };
        let mut warnings = Vec::new();
        draft.finish(&mut Textures::default(), &mut warnings);
        assert_eq!(warnings.len(), 3, "{warnings:?}");
        assert!(warnings[0].contains("`eta` does nothing without"), "{warnings:?}");
    }

    #[test]
    fn what_transmits_also_reflects_and_has_an_index_of_refraction() {
        let mut warnings = Vec::new();
        let glass = finish(&Draft { transmission: Some(Vec3::ONE), ..Draft::named("g") }, &mut warnings);
        assert_eq!((glass.reflection, glass.eta, glass.lambert), (Vec3::ONE, Some(DEFAULT_ETA), Vec3::ZERO));
        assert_eq!(warnings.len(), 1, "{warnings:?}");
    }
}
