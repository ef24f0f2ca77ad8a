//! Where the picture of a material's map is, and how it is to be read.

use super::named_file;
use crate::picture::source::Source;
use glam::{Affine2, Vec2};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where a material's map is and how it is to be read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MapFile {
    /// The picture.
    pub source: MapSource,
    /// `FILE:LINE` of the statement, for warnings.
    pub at: String,
    /// `-clamp on`.
    pub clamp: bool,
    /// `-mm`: a texel `t` counts as `base + gain * t`.
    pub base: f32,
    /// See `base`.
    pub gain: f32,
    /// `-imfchan`, for scalars.
    pub channel: Channel,
    /// The image's alpha is the opacity: colours that are multiplied by it already are divided by it.
    pub straight: bool,
    /// Its colours are numbers as they are stored, whatever curve the picture has.
    pub stored: bool,
    /// From the mesh's texture coordinates to the picture's, whose origin is its lower left corner.
    pub transform: Affine2,
}

/// Where a picture is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum MapSource {
    /// In a file of its own.
    File {
        /// The name as it is written, and where that does not exist, what else it may mean.
        names: Vec<String>,
        /// The folder that the names are relative to.
        folder: PathBuf,
    },
    /// Within another file.
    #[cfg_attr(not(test), expect(dead_code, reason = "OBJ, MTL and TOML have no pictures within them"))]
    Bytes {
        /// The picture as a file would hold it. Where two are the same, they are one.
        bytes: Arc<[u8]>,
        /// What messages call it; a name of its own among the pictures of a scene.
        name: String,
    },
}

/// Largest scale and offset of a map, up or down: with more, single precision does not know which texel is meant.
pub(super) const LARGEST_TRANSFORM: f32 = 1e6;

/// Which channel of an image is a scalar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(super) enum Channel {
    /// Alpha, if some of it is not opaque, else luminance.
    #[default]
    Any,
    /// Red, green, blue or alpha, by index.
    One(u8),
    /// Luminance.
    Luminance,
}

/// A picture that is there.
#[derive(Debug)]
pub(super) enum Found<'a> {
    File(PathBuf),
    Bytes(&'a Arc<[u8]>, &'a str),
}

/// What decides whether two pictures that are there are one.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Identity {
    /// The whole path, without links.
    File(PathBuf),
    Bytes(Arc<[u8]>),
}

/// What `-s` and `-o` of an MTL file and `scale` and `offset` of a scene file mean: how often the picture is there between the coordinates 0 and 1, each way, and the place
/// in it, as a share of its size, that the coordinates (0, 0) show. First the scale, then the offset: so Blender and three.js read and write them.
pub(super) fn scaled_and_moved(scale: Vec2, offset: Vec2) -> Affine2 {
    Affine2::from_scale_angle_translation(scale, 0.0, offset)
}

impl MapFile {
    /// A map in a file, without options.
    pub(super) fn plain(names: Vec<String>, folder: &Path, at: String) -> Self {
        MapFile::of(MapSource::File { names, folder: folder.to_owned() }, at)
    }

    /// A map without options.
    pub(super) fn of(source: MapSource, at: String) -> Self {
        MapFile {
            source,
            at,
            clamp: false,
            base: 0.0,
            gain: 1.0,
            channel: Channel::Any,
            transform: scaled_and_moved(Vec2::ONE, Vec2::ZERO),
            straight: false,
            stored: false,
        }
    }

    /// Whether two maps are in one picture.
    pub(super) fn is_same_file(&self, other: &MapFile) -> bool {
        let file = |map: &MapFile| map.path().and_then(|path| path.canonicalize().ok());
        self.source == other.source || file(self).is_some_and(|path| Some(path) == file(other))
    }

    /// The file, if it has one and that is there.
    pub(super) fn path(&self) -> Option<PathBuf> {
        match self.find().ok()?.0 {
            Found::File(path) => Some(path),
            Found::Bytes(..) => None,
        }
    }

    /// What the picture is called where the map is stated.
    pub(super) fn written(&self) -> &str {
        match &self.source {
            MapSource::File { names, .. } => names.first().map_or("", String::as_str),
            MapSource::Bytes { name, .. } => name,
        }
    }

    /// Where the picture would be, for a message that it is not there.
    pub(super) fn place(&self) -> String {
        match &self.source {
            MapSource::File { folder, .. } => folder.join(self.written()).display().to_string(),
            MapSource::Bytes { name, .. } => name.clone(),
        }
    }

    /// The transform as the tracers have it.
    pub(super) fn placement(&self) -> Affine2 {
        let Affine2 { matrix2, translation } = self.transform;
        // Where the picture repeats, whole turns say nothing, but cost digits.
        let translation = if self.clamp { translation } else { translation - translation.trunc() };
        Affine2 { matrix2, translation }
    }

    /// The transform as [`scaled_and_moved`] has it; none if it turns or shears, too.
    pub(super) fn scale_and_offset(&self) -> Option<(Vec2, Vec2)> {
        let [x, y] = [self.transform.matrix2.x_axis, self.transform.matrix2.y_axis];
        (x.y == 0.0 && y.x == 0.0).then_some((Vec2::new(x.x, y.y), self.transform.translation))
    }

    /// The picture, and a warning if it is not quite the one that is named.
    ///
    /// # Errors
    /// In words, if it is not there.
    pub(super) fn find(&self) -> Result<(Found<'_>, Option<String>), String> {
        let (names, folder) = match &self.source {
            MapSource::File { names, folder } => (names, folder),
            MapSource::Bytes { bytes, name } => return Ok((Found::Bytes(bytes, name), None)),
        };
        let file = |path| Found::File(path);
        if let Some(path) = names.iter().find_map(|name| named_file::exactly(folder, name)) {
            return Ok((file(path), None));
        }
        if let Some(path) = names.iter().find_map(|name| named_file::nearly(folder, name)) {
            let warning = format!("{}: {}", self.at, named_file::instead(folder, self.written(), &path));
            return Ok((file(path), Some(warning)));
        }
        // A name that exists but is no file deserves a better word than that it is missing.
        let path = folder.join(self.written());
        if path.exists() { Ok((file(path), None)) } else { Err("there is no such file".into()) }
    }
}

impl Found<'_> {
    /// What messages call it.
    pub(super) fn shown(&self) -> String {
        match self {
            Found::File(path) => path.display().to_string(),
            Found::Bytes(_, name) => (*name).to_owned(),
        }
    }

    /// The last part of its name.
    pub(super) fn short_name(&self) -> String {
        match self {
            Found::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
            Found::Bytes(_, name) => (*name).to_owned(),
        }
    }

    /// What decides whether another one is the same.
    pub(super) fn identity(&self) -> Identity {
        match self {
            Found::File(path) => Identity::File(path.canonicalize().unwrap_or_else(|_| path.clone())),
            Found::Bytes(bytes, _) => Identity::Bytes(Arc::clone(bytes)),
        }
    }

    /// What is decoded.
    pub(super) fn source(&self) -> Source<'_> {
        match self {
            Found::File(path) => Source::File(path),
            Found::Bytes(bytes, name) => Source::Bytes { bytes, name },
        }
    }
}
