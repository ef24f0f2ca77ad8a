//! One error type for the whole library.
//!
//! Every variant says which file, line, device or call failed, what was expected, and what the reader can do about it.

use std::path::{Path, PathBuf};

/// The library's result type.
pub type Result<T> = std::result::Result<T, Error>;

/// Everything that can go wrong between a scene file and a picture.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file could not be opened, read or decoded as text.
    #[error("cannot read {}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system or the decoder said.
        reason: String,
    },
    /// A file could not be written; what stood there before is intact.
    #[error("cannot write {}: {reason}", path.display())]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// What the system or the encoder said.
        reason: String,
    },
    /// A line of a scene, OBJ or MTL file is wrong. `line` and `column` count from 1; `column` is 0 where unknown.
    #[error("{}:{line}{}: {message}", path.display(), column_text(*column))]
    Parse {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1; 0 where unknown.
        column: usize,
        /// What was found, what was expected, and what to do.
        message: String,
    },
    /// The scene as a whole cannot be rendered (nothing to trace, an impossible camera, ...).
    #[error("{}: {message}", path.display())]
    Scene {
        /// The scene or OBJ file.
        path: PathBuf,
        /// What is wrong and what to do.
        message: String,
    },
    /// An option, or a combination of options, has no meaning.
    #[error("{0}")]
    Usage(String),
    /// There is no Vulkan loader, driver or device that fits the request.
    #[error("{0}")]
    NoDevice(String),
    /// A scene does not fit a limit of the device.
    #[error("{what} needs {needed}, but {device} allows {limit}: {advice}")]
    Limit {
        /// What would exceed the limit.
        what: String,
        /// How much is needed, with its unit.
        needed: String,
        /// The device's name.
        device: String,
        /// The limit, with its unit and Vulkan name.
        limit: String,
        /// What to do.
        advice: String,
    },
    /// A Vulkan call failed.
    #[error("{call} failed on {device}: {reason}")]
    Vulkan {
        /// The Vulkan or allocator call.
        call: &'static str,
        /// The device's name.
        device: String,
        /// The result code in words, with advice where there is any.
        reason: String,
    },
    /// The denoiser failed (only with the `denoise` feature).
    #[error("Open Image Denoise failed: {0}")]
    Denoise(String),
    /// A shader does not compile (only with the `shaderc` feature, which compiles at run time).
    #[error("shader {name} does not compile:\n{log}")]
    Shader {
        /// File name of the shader.
        name: String,
        /// The compiler's log.
        log: String,
    },
}

fn column_text(column: usize) -> String {
    if column == 0 { String::new() } else { format!(":{column}") }
}

impl Error {
    /// A [`Error::Read`] from an I/O error.
    pub fn read(path: &Path, reason: impl ToString) -> Self {
        Error::Read { path: path.to_owned(), reason: reason.to_string() }
    }

    /// A [`Error::Write`] from an I/O or encoder error.
    pub fn write(path: &Path, reason: impl ToString) -> Self {
        Error::Write { path: path.to_owned(), reason: reason.to_string() }
    }

    /// A [`Error::Scene`].
    pub fn scene(path: &Path, message: impl Into<String>) -> Self {
        Error::Scene { path: path.to_owned(), message: message.into() }
    }

    /// The process exit code that this error stands for: 2 for a usage error, 1 for a failure.
    pub fn exit_code(&self) -> u8 {
        if matches!(self, Error::Usage(_)) { 2 } else { 1 }
    }
}
