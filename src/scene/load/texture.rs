//! Textures: what the options of a map change, and the texels that both tracers see.

use super::map_file::{Channel, Identity, MapFile};
use super::texel_faults;
use crate::picture::decode::{CHUNK, ImageFile};
use crate::scene::{ChannelMap, Texture};
use glam::{DVec3, Vec3};
use half::f16;
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// What happens where the file of a map cannot be used.
const NO_MAP: &str = "there is no map then";

/// Most texels of all textures of a scene together: 2 GiB as they are kept.
const MOST_TEXELS: u64 = 1 << 28;

/// What decides whether two maps are one texture.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
struct Key {
    picture: Identity,
    clamp: bool,
    base: u32,
    gain: u32,
    kind: Kind,
    straight: bool,
}

/// What the texels of a texture are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    /// Colours, with the image's own alpha.
    Colours,
    /// The same without their curve.
    Stored,
    /// An opacity in alpha.
    Opacity(Channel),
    /// Numbers from 0 to 1, as they are stored: a number a channel.
    Shares,
    /// A number from 0 to 1 in red: the luminance of what is stored.
    Luminance,
    /// Normals in tangent space: numbers as they are stored.
    Normals,
    /// Heights; unless the image evidently holds normals, if that may be.
    Heights { channel: Channel, or_normals: bool },
}

/// What a map of heights turned out to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Relief {
    /// A texture of heights.
    Heights(u32),
    /// A texture of normals.
    Normals(u32),
}

/// What the texels of an image evidently are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Looks {
    /// Normals in tangent space.
    Normals,
    /// Shades of grey: heights, where it is a map of relief.
    Grey,
    /// Mostly no vectors of unit length.
    NoNormals,
    /// Anything, or nobody asked.
    Open,
}

/// The textures loaded so far; one picture with the same options is loaded once, wherever its maps place it.
#[derive(Debug, Default)]
pub(super) struct Textures {
    /// What was loaded.
    pub loaded: Vec<Arc<Texture>>,
    /// For each of them.
    ranges: Vec<Range>,
    /// What it looks like, if that was asked.
    looks: Vec<Looks>,
    /// Their texels.
    texels: u64,
    by_key: HashMap<Key, Option<u32>>,
    /// By another texture with the same texels, and the bits of the transform.
    by_place: HashMap<(u32, [u32; 6]), u32>,
    fallback: Option<u32>,
    said: HashSet<String>,
}

fn colours(map: &MapFile) -> Kind {
    if map.stored { Kind::Stored } else { Kind::Colours }
}

impl Textures {
    /// The texture of a map that multiplies a colour; its alpha is the image's own. If the file cannot be used, which is a
    /// warning, a checkerboard that nobody overlooks.
    pub(super) fn visible(&mut self, map: &MapFile, warnings: &mut Vec<String>) -> u32 {
        let texture = self.load(map, colours(map), "a checkerboard of magenta and black shows instead", warnings);
        match texture {
            Some(texture) => self.placed(texture, map),
            None => self.fallback(),
        }
    }

    /// The same, but none if the file cannot be used.
    pub(super) fn optional(&mut self, map: &MapFile, warnings: &mut Vec<String>) -> Option<u32> {
        self.load(map, colours(map), NO_MAP, warnings).map(|texture| self.placed(texture, map))
    }

    /// The texture of a map that multiplies a number, and its channel: the one that is asked for, or luminance, as Blender makes a number of a colour. None if
    /// the file cannot be used, which is a warning.
    pub(super) fn number(&mut self, map: &MapFile, warnings: &mut Vec<String>) -> Option<ChannelMap> {
        let (kind, channel) = match map.channel {
            Channel::One(channel) => (Kind::Shares, channel),
            Channel::Any | Channel::Luminance => (Kind::Luminance, 0),
        };
        let texture = self.load(map, kind, NO_MAP, warnings)?;
        Some(ChannelMap { texture: self.placed(texture, map), channel })
    }

    /// The texture of a map whose channels are three numbers. None if the file cannot be used, which is a warning.
    pub(super) fn numbers(&mut self, map: &MapFile, warnings: &mut Vec<String>) -> Option<u32> {
        self.load(map, Kind::Shares, NO_MAP, warnings).map(|texture| self.placed(texture, map))
    }

    /// The texture of a map of normals. None if the file cannot be used, which is a warning.
    pub(super) fn normals(&mut self, map: &MapFile, warnings: &mut Vec<String>) -> Option<u32> {
        self.load(map, Kind::Normals, NO_MAP, warnings).map(|texture| self.placed(texture, map))
    }

    /// The texture of a map of heights, or of normals if the image evidently holds such and `or_normals` lets it. None if the file cannot be used, which is a warning.
    pub(super) fn relief(&mut self, map: &MapFile, or_normals: bool, warnings: &mut Vec<String>) -> Option<Relief> {
        let kind = Kind::Heights { channel: map.channel, or_normals };
        let texture = self.load(map, kind, NO_MAP, warnings).map(|texture| self.placed(texture, map))?;
        let normals = or_normals && self.looks(texture) == Looks::Normals;
        Some(if normals { Relief::Normals(texture) } else { Relief::Heights(texture) })
    }

    /// What the image of a loaded map of heights or normals looks like.
    pub(super) fn looks(&self, texture: u32) -> Looks {
        self.looks[texture as usize]
    }

    /// The texture of a map whose alpha is an opacity. None if the file cannot be used, which is a warning.
    pub(super) fn opacity(&mut self, map: &MapFile, warnings: &mut Vec<String>) -> Option<u32> {
        self.load(map, Kind::Opacity(map.channel), NO_MAP, warnings).map(|texture| self.placed(texture, map))
    }

    /// A loaded texture where the map wants it: another one with the same texels, unless it is there already.
    fn placed(&mut self, texture: u32, map: &MapFile) -> u32 {
        let transform = map.placement();
        let source = self.loaded[texture as usize].clone();
        if source.transform == transform {
            return texture;
        }
        let bits = transform.to_cols_array().map(f32::to_bits);
        *self.by_place.entry((texture, bits)).or_insert_with(|| {
            self.loaded.push(Texture { transform, ..Texture::clone(&source) }.into());
            self.ranges.push(self.ranges[texture as usize]);
            self.looks.push(self.looks[texture as usize]);
            self.loaded.len() as u32 - 1
        })
    }

    /// The extremes of one of the loaded textures.
    pub(super) fn range(&self, texture: u32) -> Range {
        self.ranges[texture as usize]
    }

    fn fallback(&mut self) -> u32 {
        const SIDE: u32 = 16;
        *self.fallback.get_or_insert_with(|| {
            let (one, zero) = (f16::ONE, f16::ZERO);
            let check = |i: u32| (i % SIDE / 4 + i / SIDE / 4).is_multiple_of(2);
            let colour = |i| if check(i) { [one, zero, one, one] } else { [zero, zero, zero, one] };
            let texels: Vec<_> = (0..SIDE * SIDE).map(colour).collect();
            let name = "(missing texture)".into();
            self.ranges.push(Range::of(&texels));
            self.looks.push(Looks::Open);
            let texels = texels.into();
            self.loaded.push(Texture { name, width: SIDE, height: SIDE, texels, ..Texture::default() }.into());
            self.loaded.len() as u32 - 1
        })
    }

    /// `instead` says what happens if the file cannot be used.
    fn load(&mut self, map: &MapFile, kind: Kind, instead: &str, warnings: &mut Vec<String>) -> Option<u32> {
        let (picture, guess) = match map.find() {
            Ok(found) => found,
            Err(reason) => {
                self.refuse(&map.place(), map, &format!("{reason}; {instead}"), warnings);
                return None;
            }
        };
        let shown = picture.shown();
        if let Some(guess) = guess
            && self.said.insert(format!("{} {shown}", map.written()))
        {
            warnings.push(guess);
        }
        let key = Key {
            picture: picture.identity(),
            clamp: map.clamp,
            base: map.base.to_bits(),
            gain: map.gain.to_bits(),
            kind,
            straight: map.straight,
        };
        if let Some(texture) = self.by_key.get(&key) {
            return *texture;
        }
        // One that is there already as normals.
        if let Kind::Heights { or_normals: true, .. } = kind
            && let Some(Some(texture)) = self.by_key.get(&Key { kind: Kind::Normals, ..key.clone() })
            && self.looks(*texture) == Looks::Normals
        {
            return Some(*texture);
        }
        let too_many = |texels| {
            format!(
                "with its {texels} texels the textures of the scene would have more than {MOST_TEXELS}: make them smaller"
            )
        };
        let texture = match ImageFile::open(picture.source(), MOST_TEXELS - self.texels, too_many) {
            Ok(image) => {
                self.texels += image.len() as u64;
                let asked = matches!(kind, Kind::Normals | Kind::Heights { .. });
                let looks = if asked { looks(&image) } else { Looks::Open };
                let found = match kind {
                    Kind::Heights { or_normals: true, .. } if looks == Looks::Normals => Kind::Normals,
                    found => found,
                };
                let (texels, faults) = texels(&image, map, found);
                self.looks.push(looks);
                for fault in image.warnings.iter().cloned().chain(faults) {
                    if self.said.insert(format!("{shown} {fault}")) {
                        warnings.push(format!("{}: the texture {shown}: {fault}", map.at));
                    }
                }
                if !image.is_premultiplied() {
                    // Then there is nothing to divide, and both are one.
                    self.by_key.insert(Key { straight: !key.straight, ..key.clone() }, Some(self.loaded.len() as u32));
                }
                if found != kind {
                    self.by_key.insert(Key { kind: found, ..key.clone() }, Some(self.loaded.len() as u32));
                }
                let name = picture.short_name();
                let (width, height) = (image.width, image.height);
                self.ranges.push(Range::of(&texels));
                let (texels, clamp, transform) = (texels.into(), map.clamp, map.placement());
                self.loaded.push(Texture { name, width, height, texels, clamp, transform }.into());
                Some(self.loaded.len() as u32 - 1)
            }
            Err(reason) => {
                self.refuse(&shown, map, &format!("{reason}; {instead}"), warnings);
                None
            }
        };
        self.by_key.insert(key, texture);
        texture
    }

    /// One warning for each picture.
    fn refuse(&mut self, picture: &str, map: &MapFile, reason: &str, warnings: &mut Vec<String>) {
        if self.said.insert(picture.to_owned()) {
            warnings.push(format!("{}: the texture {picture} cannot be used: {reason}", map.at));
        }
    }
}

/// The texels as the tracers see them: options applied, finite, not negative, within half precision; and what was changed for that, in words.
fn texels(image: &ImageFile, map: &MapFile, kind: Kind) -> (Vec<[f16; 4]>, Vec<String>) {
    let kind = match kind {
        Kind::Opacity(Channel::Any) if image.has_transparency() => Kind::Opacity(Channel::One(3)),
        other => other,
    };
    let range = |value: f32| map.base + map.gain * value;
    let changed = (map.base, map.gain) != (0.0, 1.0);
    let all = |texel: &(dyn Fn(usize) -> [f16; 4] + Sync)| -> Vec<[f16; 4]> {
        (0..image.len()).into_par_iter().with_min_len(CHUNK).map(texel).collect()
    };
    match kind {
        Kind::Colours => (
            image.decode(map.straight, |value| half(range(value)), opacity),
            texel_faults::of_colours(image, map.straight, changed, range),
        ),
        Kind::Stored => {
            let colour = |texel| {
                let [r, g, b, a] = image.stored(texel);
                [half(range(r)), half(range(g)), half(range(b)), opacity(a)]
            };
            (all(&colour), texel_faults::of_colours(image, false, changed, range))
        }
        Kind::Opacity(channel) => {
            let value = |texel| range(scalar_of(image.stored(texel), channel));
            let scalar = |texel| [f16::ONE, f16::ONE, f16::ONE, opacity(value(texel))];
            (all(&scalar), texel_faults::of_opacities(image, changed, value))
        }
        Kind::Shares => {
            let numbers = |texel| image.stored(texel).map(range);
            (all(&|texel| numbers(texel).map(opacity)), texel_faults::of_numbers(image, changed, numbers))
        }
        Kind::Luminance => {
            let number = |texel| range(luminance(image.stored(texel)));
            let grey = |texel| {
                let grey = opacity(number(texel));
                [grey, grey, grey, f16::ONE]
            };
            (all(&grey), texel_faults::of_numbers(image, changed, |texel| [number(texel); 4]))
        }
        Kind::Normals => {
            let normal = |texel| {
                let [r, g, b, _] = image.stored(texel).map(|value| half(range(value)));
                [r, g, b, f16::ONE]
            };
            (all(&normal), texel_faults::of_numbers(image, changed, |texel| image.stored(texel).map(range)))
        }
        Kind::Heights { channel, .. } => heights(image, |texel| range(scalar_of(image.stored(texel), channel))),
    }
}

fn scalar_of(stored: [f32; 4], channel: Channel) -> f32 {
    match channel {
        Channel::One(index) => stored[usize::from(index)],
        Channel::Any | Channel::Luminance => luminance(stored),
    }
}

/// Heights as the sum of two half floats, which have 22 bits between them: slopes are differences of neighbours. Only differences count, so that the least one becomes 0
/// where it is negative.
fn heights(image: &ImageFile, value: impl Fn(usize) -> f32 + Send + Sync) -> (Vec<[f16; 4]>, Vec<String>) {
    let finite = |texel| Some(value(texel)).filter(|height| height.is_finite()).unwrap_or(0.0);
    let all = || (0..image.len()).into_par_iter().with_min_len(CHUNK);
    let least = all().map(finite).reduce(|| 0.0, f32::min);
    let texel = |texel| {
        let height = finite(texel) - least;
        let upper = half(height);
        // Rounded down, so that the rest is not negative.
        let upper = if upper.to_f32() > height { f16::from_bits(upper.to_bits() - 1) } else { upper };
        [upper, half(height - upper.to_f32()), f16::ZERO, f16::ONE]
    };
    let texels = all().map(texel).collect();
    (texels, texel_faults::of_heights(image, |texel| value(texel) - least))
}

/// What an image looks like. Normals in tangent space on the whole point upwards, which is light blue, and nearly all are of unit length.
fn looks(image: &ImageFile) -> Looks {
    let all = (0..image.len()).into_par_iter().with_min_len(CHUNK).map(|texel| {
        let [r, g, b, _] = image.stored(texel);
        let stored = Vec3::new(r, g, b);
        let unit = (2.0 * stored - 1.0).length();
        (stored.as_dvec3(), u64::from((0.85..=1.15).contains(&unit)), r == g && g == b)
    });
    let (sum, unit, grey) = all.reduce(|| (DVec3::ZERO, 0, true), |a, b| (a.0 + b.0, a.1 + b.1, a.2 && b.2));
    let (count, [r, g, b]) = (image.len() as u64, (sum / image.len() as f64).to_array());
    let level = |x: f64| (0.4..=0.6).contains(&x);
    match () {
        () if grey => Looks::Grey,
        () if level(r) && level(g) && b >= 0.75 && unit * 10 >= 9 * count => Looks::Normals,
        () if unit * 2 < count => Looks::NoNormals,
        () => Looks::Open,
    }
}

/// The luminance of linear sRGB primaries (ITU-R BT.709); the weights' sum is 1 even in single precision, so white is 1.
fn luminance([r, g, b, _]: [f32; 4]) -> f32 {
    (f64::from(r) * 0.2126 + f64::from(g) * 0.7152 + f64::from(b) * 0.0722) as f32
}

/// NaN and what is negative become 0.
fn half(value: f32) -> f16 {
    f16::from_f32(value.max(0.0).min(f16::MAX.to_f32()))
}

/// In [0, 1]; NaN becomes 0.
fn opacity(value: f32) -> f16 {
    f16::from_f32(value.max(0.0).clamp(0.0, 1.0))
}

/// The extremes of a texture's texels. Materials share textures, so these are worth keeping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    /// The largest colour, channel by channel.
    pub largest: Vec3,
    /// The least and the greatest alpha.
    pub alpha: (f32, f32),
}

impl Range {
    fn of(texels: &[[f16; 4]]) -> Self {
        // Half floats that are not negative are in the order of their bits as whole numbers (and -0 comes before all others).
        let bits = |texel: &[f16; 4]| texel.map(|channel| channel.to_bits() as i16);
        let larger = |a: [i16; 4], b: [i16; 4]| std::array::from_fn(|channel| a[channel].max(b[channel]));
        let (least, largest) = texels
            .par_chunks(CHUNK)
            .map(|texels| {
                texels.iter().map(bits).fold((i16::MAX, [0; 4]), |(least, largest): (i16, [i16; 4]), texel| {
                    (least.min(texel[3]), larger(largest, texel))
                })
            })
            .reduce(|| (i16::MAX, [0; 4]), |a, b| (a.0.min(b.0), larger(a.1, b.1)));
        let number = |bits: i16| f16::from_bits(bits as u16).to_f32();
        let [r, g, b, a] = largest.map(number);
        Range { largest: Vec3::new(r, g, b), alpha: (number(least), a) }
    }
}

impl Texture {
    /// The largest colour of all texels, channel by channel.
    pub fn largest(&self) -> Vec3 {
        Range::of(&self.texels).largest
    }

    /// The least and the greatest alpha of all texels.
    pub fn alpha_range(&self) -> (f32, f32) {
        Range::of(&self.texels).alpha
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load::map_file::MapSource;

    /// A map of a picture within another file.
    fn within(bytes: &[u8], name: &str) -> MapFile {
        MapFile::of(MapSource::Bytes { bytes: bytes.into(), name: name.into() }, "a.glb: materials[0]".into())
    }

    /// What a picture says in memory is what it says in a file.
    #[test]
    fn bytes_are_read_as_files_are() {
        let folder = tempfile::tempdir().unwrap();
        let encoded = |format, sixteen: bool| {
            let mut bytes = std::io::Cursor::new(Vec::new());
            let image = image::RgbaImage::from_fn(5, 3, |x, y| image::Rgba([50 * x as u8, 80 * y as u8, 7, 200]));
            let image = match (format, sixteen) {
                (image::ImageFormat::Hdr, _) => image::DynamicImage::from(image).into_rgb32f().into(),
                (image::ImageFormat::Jpeg, _) => image::DynamicImage::from(image).into_rgb8().into(),
                (_, true) => image::DynamicImage::from(image).into_rgba16().into(),
                _ => image::DynamicImage::from(image),
            };
            image.write_to(&mut bytes, format).unwrap();
            bytes.into_inner()
        };
        let png = encoded(image::ImageFormat::Png, false);
        // After the signature and the 25 bytes of IHDR: a gamma of 1.
        let gamma = [&png[..33], b"\0\0\0\x04gAMA\0\x01\x86\xa0\x31\xe8\x96\x5f", &png[33..]].concat();
        for (name, bytes) in [
            ("a.png", png.clone()),
            ("b.png", encoded(image::ImageFormat::Png, true)),
            ("gamma.png", gamma),
            ("a.jpg", encoded(image::ImageFormat::Jpeg, false)),
            ("a.webp", encoded(image::ImageFormat::WebP, false)),
            ("a.hdr", encoded(image::ImageFormat::Hdr, false)),
            // Only the ending says what it is.
            ("a.tga", encoded(image::ImageFormat::Tga, false)),
            // Only the content does.
            ("wrong.jpg", png.clone()),
            ("none", png.clone()),
            // And what is wrong.
            ("empty.png", vec![]),
            ("cut.png", png[..60].to_vec()),
            ("short.hdr", b"#?RADIANCE\n\n-Y 9 +X 9\n\x02".to_vec()),
            ("cut.exr", b"\x76\x2f\x31\x01".to_vec()),
            ("text.png", b"hello".to_vec()),
            ("a.ktx2", b"\xabKTX 20\xbb\r\n\x1a\n".to_vec()),
        ] {
            std::fs::write(folder.path().join(name), &bytes).unwrap();
            let file = MapFile::plain(vec![name.into()], folder.path(), "a.glb: materials[0]".into());
            let read = |map: &MapFile| {
                let mut textures = Textures::default();
                let mut warnings = Vec::new();
                let texture = textures.optional(map, &mut warnings);
                let shown = folder.path().join(name).display().to_string();
                let warnings: Vec<_> = warnings.iter().map(|warning| warning.replace(&shown, name)).collect();
                (texture.map(|texture| textures.loaded[texture as usize].clone()), warnings)
            };
            let (from_file, from_bytes) = (read(&file), read(&within(&bytes, name)));
            assert_eq!(from_file, from_bytes, "{name}");
            let is_wrong = ["empty", "cut", "short", "text", "ktx2"].iter().any(|part| name.contains(part));
            assert_eq!((from_bytes.0.is_none(), from_bytes.1.len()), (is_wrong, is_wrong.into()), "{from_bytes:?}");
        }
    }

    #[test]
    fn the_same_bytes_are_one_texture() {
        let png = |colour| {
            let mut bytes = std::io::Cursor::new(Vec::new());
            image::RgbImage::from_pixel(1, 1, image::Rgb(colour))
                .write_to(&mut bytes, image::ImageFormat::Png)
                .unwrap();
            bytes.into_inner()
        };
        let (red, green) = (png([255, 0, 0]), png([0, 255, 0]));
        let mut textures = Textures::default();
        let mut load = |map: &MapFile| textures.optional(map, &mut Vec::new()).unwrap();
        let maps = [within(&red, "0"), within(&red, "0"), within(&red, "1"), within(&green, "2")];
        assert_eq!(maps.each_ref().map(&mut load), [0, 0, 0, 1]);
        assert!(maps[0].is_same_file(&maps[1]) && !maps[0].is_same_file(&maps[3]));
        // Turned by a quarter, it is another texture of the same texels.
        let turn = glam::Affine2::from_angle(std::f32::consts::FRAC_PI_2);
        let turned = MapFile { transform: turn, ..maps[0].clone() };
        assert_eq!(load(&turned), 2);
        assert!(Arc::ptr_eq(&textures.loaded[0].texels, &textures.loaded[2].texels));
        assert_eq!((textures.loaded[2].transform, turned.scale_and_offset()), (turn, None));
    }

    #[test]
    fn a_scene_has_only_so_many_texels() {
        let folder = tempfile::tempdir().unwrap();
        let image = |side: u32| {
            let name = format!("{side}.png");
            image::RgbImage::new(side, side).save(folder.path().join(&name)).unwrap();
            MapFile::plain(vec![name], folder.path(), "a.mtl:1".into())
        };
        let [three, four] = [image(3), image(4)];
        let mut textures = Textures { texels: MOST_TEXELS - 24, ..Textures::default() };
        let mut warnings = Vec::new();
        assert!(textures.optional(&four, &mut warnings).is_some() && warnings.is_empty());
        assert_eq!(textures.optional(&three, &mut warnings), None);
        assert!(warnings.len() == 1 && warnings[0].contains("3.png") && warnings[0].contains("its 9 texels"));
        assert_eq!(textures.optional(&four, &mut warnings), Some(0), "what is there already costs nothing");
    }

    #[test]
    fn the_range_is_that_of_the_numbers() {
        let half = |numbers: [f32; 4]| numbers.map(f16::from_f32);
        let mut texels = vec![half([0.0, -0.0, 0.25, 0.5]); 3 * CHUNK];
        texels[0] = half([65504.0, 0.0, 0.0, 0.75]);
        texels[CHUNK + 1] = half([1.0, 6e-8, 0.5, 0.125]);
        let range = Range::of(&texels);
        let tiny = f16::from_f32(6e-8).to_f32();
        assert_eq!(range, Range { largest: Vec3::new(65504.0, tiny, 0.5), alpha: (0.125, 0.75) });
        assert!(tiny > 0.0);
    }
}
