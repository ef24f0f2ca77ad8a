//! The window, under a virtual X server with real keys and a real pointer: what it shows is what `luminaire render` writes.
//!
//! It wants Xvfb, xdotool and a Vulkan device that can present; what is missing is said as SKIP, and with `LUMINAIRE_REQUIRE_GPU=1` it is a failure.

mod common;
#[path = "../../../tests/common/devices.rs"]
mod devices;

use common::running::Running;
use devices::skip;
use image::{Rgb, RgbImage};
use luminaire::picture;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CORNELL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/cornell/cornell.toml");

/// Wide enough for the scale of an error map.
const SIZE: (u32, u32) = (160, 120);
const SPP: &str = "8";
/// The first row below a message, which stays for three seconds.
const BELOW: u32 = 32;

/// A virtual display; it ends with this.
struct Display {
    server: Running,
    name: String,
    folder: tempfile::TempDir,
}

impl Display {
    /// Starts Xvfb on a free display; none if Xvfb or xdotool is missing.
    fn start() -> Option<Self> {
        let there = |tool: &str| Command::new(tool).arg("-help").output().is_ok();
        if let Some(tool) = ["Xvfb", "xdotool"].into_iter().find(|tool| !there(tool)) {
            skip(&format!("{tool} is missing: the window was not tested (scripts/setup.sh test installs it)"));
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        // Without -noreset the server begins anew whenever its last client leaves, which every look by xdotool is, and refuses whoever comes meanwhile:
        // of 200 clients 26.
        let words = ["-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp", "-noreset", "-fbdir"];
        let server = Running::start(Command::new("Xvfb").args(words).arg(folder.path()));
        let number = server.until("the number of the display", || {
            let said = server.stdout();
            said.ends_with('\n').then(|| said.trim().to_owned())
        });
        Some(Display { server, name: format!(":{number}"), folder })
    }

    /// The screen's upper left corner: Xvfb keeps its memory in a file, in the format of xwd.
    fn screen(&self, size: (u32, u32)) -> RgbImage {
        let file = std::fs::read(self.folder.path().join("Xvfb_screen0")).unwrap();
        let word = |i: usize| u32::from_be_bytes(file[4 * i..4 * i + 4].try_into().unwrap()) as usize;
        // Size of the header, bits a pixel, bytes a line, colours (XWDFile.h).
        let (header, bits, line, colours) = (word(0), word(11), word(12), word(19));
        assert_eq!((bits, word(7)), (32, 0), "pixels of four bytes, blue first");
        let start = header + 12 * colours;
        RgbImage::from_fn(size.0, size.1, |x, y| {
            let at = start + line * y as usize + 4 * x as usize;
            Rgb([file[at + 2], file[at + 1], file[at]])
        })
    }

    /// What `xdotool` answers, or what it says where it fails, as where the window is not there.
    fn ask(&self, words: &[&str]) -> Result<String, String> {
        let output = Command::new("xdotool").args(words).env("DISPLAY", &self.name).output().unwrap();
        match output.status.success() {
            true => Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned()),
            false => Err(format!("xdotool {words:?}: {}", String::from_utf8_lossy(&output.stderr).trim())),
        }
    }
}

/// A `luminaire view` on a display.
struct View<'a> {
    display: &'a Display,
    program: Running,
    window: String,
    folder: &'a Path,
}

impl<'a> View<'a> {
    fn start(display: &'a Display, folder: &'a Path, words: &[&str]) -> Self {
        let program = Running::start(
            luminaire(folder, "view", words)
                .env("DISPLAY", &display.name)
                .env_remove("WAYLAND_DISPLAY")
                .env_remove("WAYLAND_SOCKET"),
        );
        // A window has its name before it is shown, and only what is shown takes the keys.
        let window = program.until("there is a window", || {
            display.ask(&["search", "--onlyvisible", "--name", "luminaire"]).ok().filter(|window| !window.is_empty())
        });
        let view = View { display, program, window, folder };
        view.xdotool(&format!("windowfocus {}", view.window));
        view
    }

    /// Waits until `happens` gives something.
    fn until<T>(&self, what: &str, happens: impl Fn() -> Option<T>) -> T {
        self.program.wait_until(happens).unwrap_or_else(|reason| {
            let title = self.display.ask(&["getwindowname", &self.window]).unwrap_or_else(|error| error);
            panic!("never came: {what}: {reason}; the title is {title:?}\n{}", self.program.state())
        })
    }

    /// Has `xdotool` do something; what it answers.
    fn xdotool(&self, words: &str) -> String {
        let words: Vec<&str> = words.split(' ').collect();
        self.display.ask(&words).unwrap_or_else(|error| {
            let server = self.display.server.ended().map_or("", |_| "; the X server ended");
            panic!("{error}{server}\n{}", self.program.state())
        })
    }

    fn title(&self) -> String {
        self.xdotool(&format!("getwindowname {}", self.window))
    }

    /// Waits for a title that contains all of these words.
    fn titled(&self, words: &[&str]) -> String {
        self.until(&format!("a title with {words:?}"), || {
            Some(self.title()).filter(|title| words.iter().all(|word| title.contains(word)))
        })
    }

    /// Waits until the window shows `expected` to the last bit in these rows.
    fn shows(&self, what: &str, expected: &RgbImage, rows: Range<u32>) {
        let (width, height) = (expected.width(), rows.end - rows.start);
        let crop = |picture: &RgbImage| image::imageops::crop_imm(picture, 0, rows.start, width, height).to_image();
        let expected_rows = crop(expected);
        self.until(what, || (crop(&self.display.screen(expected.dimensions())) == expected_rows).then_some(()));
    }

    fn key(&self, keys: &str) {
        self.xdotool(&format!("key {keys}"));
    }

    fn file(&self, name: &str) -> PathBuf {
        let path = self.folder.join(name);
        self.until(name, || path.exists().then_some(()));
        path
    }

    /// Ends it with Esc; what it said.
    fn quit(self) -> Output {
        self.key("Escape");
        self.program.output()
    }
}

fn luminaire(folder: &Path, command: &str, words: &[&str]) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    program.current_dir(folder).arg(command).args(words);
    program
}

/// What `luminaire render` writes.
fn rendered(folder: &Path, scene: &str, (width, height): (u32, u32), words: &[&str]) -> RgbImage {
    let size = ["--width", &width.to_string(), "--height", &height.to_string()].map(str::to_owned);
    let size: Vec<&str> = size.iter().map(String::as_str).collect();
    let path = folder.join("rendered.png");
    let own = [scene, "--spp", SPP, "-o", "rendered.png"];
    let output = luminaire(folder, "render", &[&own[..], &size, words].concat()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = image::open(&path).unwrap().to_rgb8();
    std::fs::remove_file(path).unwrap();
    picture
}

/// Whether a device of this machine can trace: then it can present, too.
fn vulkan_is_here() -> bool {
    let here = luminaire::backend::devices().is_ok_and(|devices| devices.iter().any(|device| device.backend.is_ok()));
    if !here {
        skip("no Vulkan device is usable: the window was not tested");
    }
    here
}

#[test]
fn the_window_shows_what_render_writes_and_obeys() {
    let Some(display) = Display::start().filter(|_| vulkan_is_here()) else { return };
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let bvh = ["--backend", "compute-bvh"];
    let words = [CORNELL, "--width", "160", "--height", "120", "--spp", SPP, bvh[0], bvh[1]];
    let view = View::start(&display, folder, &words);
    let start = rendered(folder, CORNELL, SIZE, &bvh);
    view.shows("the picture of `render`", &start, 0..SIZE.1);
    let title = view.titled(&["8.0 samples a pixel", "Mrays/s", "error", "compute-bvh on "]);

    // Another backend gives the same picture, but for rounding.
    view.key("b");
    view.titled(&["8.0 samples a pixel", "cpu on "]);
    view.shows("the reference's picture", &rendered(folder, CORNELL, SIZE, &["--backend", "cpu"]), BELOW..SIZE.1);
    view.key("b");
    // Ray query, or where there is none the first again.
    view.until("a backend on Vulkan", || (!view.title().contains("cpu on ")).then_some(()));
    if !title.is_empty() && !view.title().contains("compute-bvh on ") {
        view.titled(&["8.0 samples a pixel", "ray-query on "]);
        view.key("b");
    }
    view.titled(&["8.0 samples a pixel", "compute-bvh on "]);

    // Another estimator, too: this one is `render`'s, sample by sample.
    view.key("n");
    view.titled(&["8.0 samples a pixel", ", cosine"]);
    view.shows(
        "the estimator cosine",
        &rendered(folder, CORNELL, SIZE, &["--estimator", "cosine", bvh[0], bvh[1]]),
        BELOW..SIZE.1,
    );
    view.key("n");
    view.key("n");
    view.key("n");
    view.titled(&["8.0 samples a pixel", ", default"]);

    // A drag orbits; the camera that is written gives the picture that is seen.
    view.xdotool("mousemove 60 60 mousedown 1 mousemove 90 50 mousemove 100 45 mouseup 1 key c");
    let snippet = std::fs::read_to_string(view.file("cornell-camera-1.toml")).unwrap();
    assert!(snippet.starts_with("[sensor]\n") && !snippet.contains("-800.0]"), "{snippet}");
    assert!(snippet.ends_with("[render]\nexposure = 1.0\ntone = \"srgb\"\n"), "{snippet}");
    let object = "[[object]]\nmesh = \"cornell.obj\"\n";
    let object = object.replace("cornell.obj", &CORNELL.replace(".toml", ".obj"));
    std::fs::write(folder.join("turned.toml"), snippet.clone() + &object).unwrap();
    let turned = rendered(folder, "turned.toml", SIZE, &bvh);
    // Once the message at the upper edge is gone.
    view.shows("the scene from the side", &turned, 0..SIZE.1);

    // Saved pictures are what is seen, and none replaces another.
    view.key("p");
    assert_eq!(image::open(view.file("cornell-view-1.png")).unwrap().to_rgb8(), turned);
    view.key("o");
    let exr = picture::read(&view.file("cornell-view-1.exr")).unwrap();
    assert_eq!((exr.width, exr.height, exr.error.is_some()), (SIZE.0, SIZE.1, true));

    view.key("2");
    view.titled(&["error map", "8.0 samples a pixel"]);
    rendered(folder, "turned.toml", SIZE, &["--error-map", "error.png", bvh[0], bvh[1]]);
    // The scale covers the last 40 rows.
    let map = image::open(folder.join("error.png")).unwrap().to_rgb8();
    view.shows("the error map of `render`", &map, BELOW..SIZE.1 - 40);
    view.key("p");
    view.file("cornell-view-2.png");
    assert_eq!(
        std::fs::read(folder.join("cornell-view-2.png")).unwrap(),
        std::fs::read(folder.join("error.png")).unwrap()
    );

    // The camera of the scene, another window, and the first surfaces.
    view.key("1 Home");
    view.shows("the first camera", &start, BELOW..SIZE.1);
    let size = (240, 100);
    view.xdotool(&format!("windowsize {} {} {}", view.window, size.0, size.1));
    view.shows("the resized window", &rendered(folder, CORNELL, size, &bvh), BELOW..size.1);
    let middle = |expected: [u8; 3]| {
        let near = |found: &Rgb<u8>| found.0.iter().zip(expected).all(|(a, b)| a.abs_diff(b) < 6);
        view.until(&format!("{expected:?} in the middle"), || {
            near(display.screen(size).get_pixel(130, 45)).then_some(())
        })
    };
    view.key("4");
    view.titled(&["normals", "64.0 samples a pixel"]);
    // The back wall faces the camera, which looks along +z.
    middle([128, 128, 0]);
    view.key("3");
    view.titled(&["albedo", "64.0 samples a pixel"]);
    // 0.73 in sRGB.
    middle([222, 222, 222]);

    // Hidden and shown again.
    view.xdotool(&format!("windowunmap {0} windowmap {0} windowfocus {0}", view.window));
    view.key("1");
    view.shows("the picture after it was hidden", &rendered(folder, CORNELL, size, &bvh), BELOW..size.1);
    // Other curves, and another exposure.
    // An exposure that is found goes by the window's aspect ratio, or by that of the scene file.
    let text = std::fs::read_to_string(CORNELL).unwrap().replace("cornell.obj", &CORNELL.replace(".toml", ".obj"));
    let text = text.replace("width = 512", "width = 240").replace("height = 512", "height = 100");
    std::fs::write(folder.join("sized.toml"), text).unwrap();
    let shown =
        |how: &str| rendered(folder, "sized.toml", size, &[&bvh[..], &how.split(' ').collect::<Vec<_>>()].concat());
    view.key("t");
    view.shows("by the next curve", &shown("--exposure 1 --tone agx"), BELOW..size.1);
    view.key("x");
    let exposed = shown("--exposure auto --tone agx");
    view.shows("exposed by what is seen", &exposed, BELOW..size.1);
    view.key("p");
    assert_eq!(image::open(view.file("cornell-view-3.png")).unwrap().to_rgb8(), exposed);
    view.key("t t");
    view.shows("the first curve again", &shown("--exposure auto"), BELOW..size.1);
    view.key("h");
    let white = || display.screen(size).pixels().filter(|pixel| pixel.0 == [255; 3]).count();
    view.until("the help", || (white() > 1500).then_some(()));

    let output = view.quit();
    let (out, err) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(0), "{err}");
    assert!(!err.contains("Vulkan validation") && !err.contains("error"), "{err}");
    assert!(out.starts_with(&(snippet + "cornell-camera-1.toml\ncornell-view-1.png\n")), "{out}");
}

#[test]
fn without_a_display() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = luminaire(folder.path(), "view", &[CORNELL]);
    let output =
        ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().fold(&mut command, |c, v| c.env_remove(v)).output();
    let output = output.unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("error: ") && err.contains("luminaire render") && !err.contains("panicked"), "{err}");
}

#[test]
fn without_a_device_that_presents() {
    let Some(display) = Display::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let nothing = folder.path().join("no-driver.json");
    std::fs::write(&nothing, "").unwrap();
    let output = luminaire(folder.path(), "view", &[CORNELL, "--backend", "cpu"])
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .env("VK_DRIVER_FILES", &nothing)
        .env("VK_ICD_FILENAMES", &nothing)
        .output()
        .unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("error: ") && err.contains("luminaire render") && !err.contains("panicked"), "{err}");
}
