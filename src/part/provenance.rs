//! What was rendered: all that samples depend on, so that samples of two pictures are never added up.

use crate::picture::{Crop, Development, Tone};
use crate::scene::{
    Environment, EnvironmentImage, FilmSettings, Luminaire, Mesh, Object, Profile, RenderSettings, Scene, Texture,
    Triangle,
};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

/// What was rendered: everything on which the samples depend. Two files of the same provenance hold samples of the same picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The program's version.
    pub version: String,
    /// The scene file as it was named. Another name for the same scene makes no difference.
    pub scene: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Where the random numbers come from.
    pub sampler: String,
    /// The estimator with its parameters.
    pub integrator: String,
    /// Digests of the rest of the scene, by name.
    pub digests: BTreeMap<String, String>,
    /// Exposure of a PNG in stops; 0 where it was still to be found ([`Exposure::Auto`](crate::scene::Exposure::Auto)). Another one makes no difference.
    pub exposure: f32,
    /// Tone curve of a PNG. Another one makes no difference.
    #[serde(default)]
    pub tone: Tone,
    /// Whether the picture has alpha.
    #[serde(default)]
    pub transparent: bool,
    /// Which part of the picture it is, if it is not the whole.
    #[serde(default)]
    pub crop: Option<Crop>,
}

impl Provenance {
    /// That of a render of `scene`.
    pub fn of(scene: &Scene) -> Self {
        // Every structure is taken apart by name here and below: what is new in one does not compile until somebody has decided whether samples depend on it.
        let Scene {
            path,
            // Whatever it is, the same samples come from the same numbers.
            origin: _,
            meshes,
            objects,
            materials,
            textures,
            luminaires,
            environment,
            sensor,
            // Only the one that is rendered counts.
            cameras: _,
            film,
            integrator,
            settings,
            warnings: _,
            notes: _,
            // Its triangles are among the others.
            ground: _,
            files: _,
        } = scene;
        let FilmSettings { width, height, filter, filter_radius } = *film;
        let RenderSettings { spp: _, seed, exposure, tone, sampler, transparent } = *settings;
        let digests = [
            ("geometry", geometry(meshes, objects)),
            (
                "materials",
                digest(|hash| {
                    write(hash, materials);
                    for texture in textures {
                        let Texture { name: _, width, height, texels, clamp, transform } = &**texture;
                        write(hash, &(width, height, clamp, transform));
                        hash.update(bytemuck::cast_slice(&texels[..]));
                    }
                }),
            ),
            (
                "luminaires",
                digest(|hash| {
                    luminaires.iter().for_each(|luminaire| self::luminaire(hash, luminaire));
                    if let Some(Environment { radiance, image, rotation }) = environment {
                        write(hash, &(radiance, rotation));
                        if let Some(image) = image {
                            let EnvironmentImage { name: _, width, height, texels } = &**image;
                            write(hash, &(width, height));
                            texels.iter().for_each(|texel| floats(hash, &texel.to_array()));
                        }
                    }
                }),
            ),
            ("camera", digest(|hash| write(hash, sensor))),
            ("pixel filter", digest(|hash| write(hash, &(filter, filter_radius)))),
        ];
        Provenance {
            version: env!("CARGO_PKG_VERSION").into(),
            scene: path.display().to_string(),
            width,
            height,
            seed,
            sampler: format!("{sampler:?}"),
            integrator: format!("{integrator:?}"),
            digests: digests.map(|(name, value)| (name.to_owned(), value)).into(),
            exposure: exposure.stops().unwrap_or(0.0),
            tone,
            transparent,
            crop: None,
        }
    }

    /// That of a render of a part of the picture.
    pub fn cropped(self, crop: Option<Crop>) -> Self {
        Provenance { crop, ..self }
    }

    /// How its pictures are developed, unless somebody wants it otherwise.
    pub fn development(&self) -> Development {
        Development { exposure: self.exposure, tone: self.tone }
    }

    /// A digest of all that the samples depend on, and of `more`.
    pub fn digest(&self, more: &str) -> String {
        let Provenance {
            version,
            scene: _,
            width,
            height,
            seed,
            sampler,
            integrator,
            digests,
            exposure: _,
            tone: _,
            transparent,
            crop,
        } = self;
        digest(|hash| {
            write(hash, &(version, width, height, seed, sampler, integrator, digests, transparent, crop, more))
        })
    }

    /// Width and height of the film.
    pub(super) fn film_size(&self) -> (u32, u32) {
        self.crop.map_or((self.width, self.height), |crop| (crop.width, crop.height))
    }

    /// In what a render differs from another, of which this is the provenance; empty if their samples belong to one picture.
    pub fn differences(&self, other: &Provenance) -> Vec<String> {
        let mut found = Vec::new();
        let mut compare = |what: &str, own: &dyn std::fmt::Display, others: &dyn std::fmt::Display| {
            let (own, others) = (own.to_string(), others.to_string());
            if own != others {
                let (own, others) = apart(&own, &others);
                found.push(format!("{what} ({own} there, {others} here)"));
            }
        };
        compare("version", &self.version, &other.version);
        let size = |p: &Provenance| format!("{} x {}", p.width, p.height);
        compare("size", &size(self), &size(other));
        let crop = |p: &Provenance| p.crop.map_or("all of it".into(), |crop| crop.to_string());
        compare("crop", &crop(self), &crop(other));
        let background = |p: &Provenance| if p.transparent { "transparent" } else { "opaque" };
        compare("background", &background(self), &background(other));
        compare("seed", &self.seed, &other.seed);
        compare("sampler", &self.sampler, &other.sampler);
        compare("integrator", &self.integrator, &other.integrator);
        let names = self.digests.keys().chain(other.digests.keys().filter(|name| !self.digests.contains_key(*name)));
        found.extend(names.filter(|name| self.digests.get(*name) != other.digests.get(*name)).cloned());
        found
    }
}

/// What differs between two values with named parts, as `Debug` shows them: those parts alone; else the values.
fn apart(own: &str, others: &str) -> (String, String) {
    let parts = |text: &str| -> Option<Vec<String>> {
        let (_, inner) = text.split_once("{ ")?;
        let (inner, _) = inner.rsplit_once(" }")?;
        // Within brackets a comma parts nothing.
        let mut depth = 0i32;
        let apart = |c: char| {
            depth += i32::from("([{".contains(c)) - i32::from(")]}".contains(c));
            c == ',' && depth == 0
        };
        Some(inner.split(apart).map(|part| part.trim().to_owned()).collect())
    };
    match (parts(own), parts(others)) {
        (Some(a), Some(b)) if a.len() == b.len() => {
            let (a, b): (Vec<_>, Vec<_>) = a.into_iter().zip(b).filter(|(a, b)| a != b).unzip();
            (a.join(", "), b.join(", "))
        }
        _ => (own.to_owned(), others.to_owned()),
    }
}

/// The digest of whatever `feed` feeds, as hexadecimal digits.
fn digest(feed: impl FnOnce(&mut Sha256)) -> String {
    let mut hash = Sha256::new();
    feed(&mut hash);
    hash.finalize().iter().take(16).map(|byte| format!("{byte:02x}")).collect()
}

/// Feeds a value as Rust shows it, with every digit of its numbers.
fn write(hash: &mut Sha256, value: &impl Debug) {
    hash.update(format!("{value:?}\n"));
}

fn floats(hash: &mut Sha256, values: &[f32]) {
    values.iter().for_each(|value| hash.update(value.to_le_bytes()));
}

/// Feeds a luminaire; the name of its profile makes no difference.
fn luminaire(hash: &mut Sha256, luminaire: &Luminaire) {
    let Luminaire::Photometric { position, direction, up, intensity, profile } = luminaire else {
        return write(hash, luminaire);
    };
    let Profile { name: _, vertical, horizontal, candela } = &**profile;
    write(hash, &(position, direction, up, intensity, vertical.len(), horizontal.len()));
    [vertical, horizontal, candela].into_iter().for_each(|numbers| floats(hash, numbers));
}

fn geometry(meshes: &[Arc<Mesh>], objects: &[Object]) -> String {
    digest(|hash| {
        for mesh in meshes {
            let Mesh { name: _, positions, normals, uvs, colours, tangents, triangles } = &**mesh;
            write(hash, &(positions.len(), normals.len(), uvs.len(), colours.len(), tangents.len(), triangles.len()));
            positions.iter().chain(normals).chain(colours).for_each(|v| floats(hash, &v.to_array()));
            uvs.iter().for_each(|v| floats(hash, &v.to_array()));
            tangents.iter().for_each(|v| floats(hash, &v.to_array()));
            for Triangle { vertices, material } in triangles {
                vertices.iter().chain([material]).for_each(|i| hash.update(i.to_le_bytes()));
            }
        }
        for Object { name: _, mesh, object_to_world, material } in objects {
            write(hash, &(mesh, object_to_world, material));
        }
    })
}

#[cfg(test)]
mod tests {
    use super::apart;

    #[test]
    fn only_what_differs_is_said() {
        let told = |own: &str, others: &str| apart(own, others);
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(
            told("P(E { a: X, b: Some(1), c: Y })", "P(E { a: X, b: None, c: Z })"),
            pair("b: Some(1), c: Y", "b: None, c: Z")
        );
        assert_eq!(told("S { at: V(0, 1) }", "S { at: V(0, 2) }"), pair("at: V(0, 1)", "at: V(0, 2)"));
        assert_eq!(told("S { at: 0 }", "P(E { a: X, b: Y })"), pair("S { at: 0 }", "P(E { a: X, b: Y })"));
        assert_eq!(told("Sobol", "Independent"), pair("Sobol", "Independent"));
    }
}
