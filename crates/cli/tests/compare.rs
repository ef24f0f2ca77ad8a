//! `luminaire compare`: figures, limits, exit codes, and files that are no pictures.

use luminaire::picture::Exr;
use std::path::Path;
use std::process::{Command, Output};

/// A folder of one test.
struct Folder(tempfile::TempDir);

impl Folder {
    /// With `reference.exr`, 8 x 4 pixels of 0.5 with a lamp of 4 in it, and `image.exr`, which has 1 % more and a firefly at 6 2.
    fn new() -> Self {
        let folder = Folder(tempfile::tempdir().unwrap());
        let mut reference = [[0.5; 3]; 32];
        reference[3] = [4.0; 3];
        let mut image = reference.map(|p: [f32; 3]| p.map(|v| v * 1.01));
        folder.exr("close.exr", &image, None);
        image[22] = [50.0, 0.5, 0.5];
        folder.exr("reference.exr", &reference, None);
        folder.exr("image.exr", &image, None);
        folder
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn exr(&self, name: &str, rgb: &[[f32; 3]], error: Option<&[[f32; 3]]>) {
        let exr = Exr { width: rgb.len() as u32 / 4, height: 4, rgb, error, more: vec![], attributes: &[], crop: None };
        std::fs::write(self.path().join(name), exr.encode().unwrap()).unwrap();
    }

    fn compare(&self, words: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
        command.current_dir(self.path()).arg("compare").args(words).output().unwrap()
    }

    /// Asserts the exit code and that stdout and stderr hold all `parts`.
    fn says(&self, words: &[&str], code: i32, parts: &[&str]) -> String {
        let output = self.compare(words);
        let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(code), "compare {words:?} said:\n{said}");
        assert_eq!(code != 0, said.contains("error: "), "{said}");
        for part in parts {
            assert!(said.contains(part), "compare {words:?} does not say {part:?}, but:\n{said}");
        }
        said
    }
}

#[test]
fn figures() {
    let folder = Folder::new();
    // The firefly is all there is: 49.5^2 / 96, and of that the root; over 0.25 and a third of 0.5588, squared, for relMSE.
    let parts =
        ["8 x 4 pixels, floats", "RMSE", "5.052", "relMSE", "89.65", "6 2  50.00 0.5000 0.5000", "FLIP", "stops"];
    folder.says(&["image.exr", "reference.exr"], 0, &parts);
    let none = folder.says(&["image.exr", "reference.exr", "--worst", "0"], 0, &[]);
    assert!(!none.contains("worst"), "{none}");
    let one = folder.says(&["image.exr", "reference.exr", "--worst", "1"], 0, &["6 2  50.00"]);
    assert_eq!(one.lines().skip_while(|line| *line != "worst pixels").count(), 3, "{one}");
    assert!(none.contains("(b^2 + (m/3)^2), m the half-power mean of b, 0.5588"), "{none}");
    let same =
        folder.says(&["close.exr", "close.exr", "--max-rmse", "0", "--max-flip", "0", "--max-bias", "0"], 0, &[]);
    assert!(same.contains("RMSE        0") && !same.contains("worst"), "{same}");
}

/// Whatever the unit of the light: relMSE and its limit. A black reference has none.
#[test]
fn units_and_black_references() {
    let folder = Folder::new();
    for (unit, name) in [(1e-6, "dim"), (1e6, "bright")] {
        let reference = [[0.5 * unit; 3], [0.0; 3], [4.0 * unit; 3], [unit; 3]];
        let image = reference.map(|rgb| rgb.map(|v| v * 1.1 + 0.01 * unit));
        folder.exr("a.exr", &image, None);
        folder.exr("b.exr", &reference, None);
        let said = folder.says(&["a.exr", "b.exr", "--max-relmse", "0.03"], 0, &["relMSE"]);
        let relmse = said.lines().find(|line| line.starts_with("relMSE")).unwrap().to_owned();
        assert!(relmse.contains("0.008425"), "{name}: {relmse}");
    }
    folder.exr("black.exr", &[[0.0; 3]; 4], None);
    let words = ["a.exr", "black.exr", "--max-relmse", "1", "--stats", "s.json"];
    let said = folder.says(&words, 1, &["warning: black.exr is black", "relMSE is inf"]);
    assert!(!said.contains("NaN"), "{said}");
    folder.says(&["black.exr", "black.exr"], 0, &["warning: black.exr is black"]);
}

#[test]
fn limits() {
    let folder = Folder::new();
    let close = ["close.exr", "reference.exr", "--max-relmse", "0.0001", "--max-bias", "0.0101", "--max-flip", "0.1"];
    folder.says(&close, 0, &["+1.000%"]);
    folder.says(
        &["close.exr", "reference.exr", "--max-bias", "0.005"],
        1,
        &["the bias of red", "--max-bias 0.005, 2.000 times"],
    );
    folder.says(&["image.exr", "reference.exr", "--max-rmse", "5"], 1, &["RMSE is 5.05", "--max-rmse 5, 1.010 times"]);
    let all = ["image.exr", "reference.exr", "--max-rmse", "9", "--max-relmse", "0", "--max-flip", "1e-6"];
    let said = folder.says(&all, 1, &["relMSE is 89.65", "--max-relmse 0", "FLIP is", "--max-flip 0.000001"]);
    assert!(!said.contains("--max-rmse"), "{said}");
}

#[test]
fn errors_of_the_pixels() {
    let folder = Folder::new();
    folder.exr("a.exr", &[[1.0; 3]; 16], Some(&[[0.03; 3]; 16]));
    folder.exr("b.exr", &[[1.1; 3]; 16], Some(&[[0.04; 3]; 16]));
    // Both together 0.05 a pixel, over 16 pixels.
    let parts = ["standard errors", "+- 0.01250, from the standard errors in the files", "0.05000 is expected"];
    folder.says(&["a.exr", "b.exr"], 0, &parts);
}

#[test]
fn files_are_written() {
    let folder = Folder::new();
    let words = ["image.exr", "reference.exr", "--heatmap", "map.png", "--stats", "figures.json", "--max-rmse", "5"];
    folder.says(&words, 1, &["map.png", "figures.json"]);
    let map = image::open(folder.path().join("map.png")).unwrap().into_rgb8();
    assert!(map.width() >= 8 && map.height() > 4);
    assert!(map.get_pixel(6, 2).0.iter().all(|v| *v > 180) && map.get_pixel(5, 2).0[1] < 60);
    let text = std::fs::read_to_string(folder.path().join("figures.json")).unwrap();
    let figures: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(figures["pixels"], 32);
    assert!((figures["rmse"].as_f64().unwrap() - 5.0522).abs() < 1e-3, "{text}");
    assert_eq!((&figures["worst"][0]["x"], &figures["worst"][0]["y"]), (&6.into(), &2.into()));
    assert!(figures["failures"][0].as_str().unwrap().contains("--max-rmse"), "{text}");
    assert!(figures["flip"]["count"].as_u64().unwrap() >= 2, "{text}");
}

#[test]
fn what_is_not_finite() {
    let folder = Folder::new();
    let mut odd = [[0.5f32; 3]; 32];
    odd[13][1] = f32::NAN;
    odd[30][0] = f32::INFINITY;
    folder.exr("odd.exr", &odd, None);
    let words = ["odd.exr", "reference.exr", "--heatmap", "map.png"];
    folder.says(&words, 1, &["error: odd.exr: 2 pixels are NaN or infinite, the first at 5 1"]);
    assert_eq!(image::open(folder.path().join("map.png")).unwrap().into_rgb8().get_pixel(5, 1).0, [0, 255, 0]);
    folder.says(&["reference.exr", "odd.exr"], 0, &["warning: odd.exr: 2 pixels", "the first at 5 1", "left out"]);
    folder.exr("all.exr", &[[f32::NAN; 3]; 32], None);
    let said =
        folder.says(&["all.exr", "reference.exr", "--stats", "figures.json"], 1, &["32 pixels", "nothing to compare"]);
    assert!(!said.contains("panicked"), "{said}");
}

#[test]
fn whole_numbers_against_floats() {
    let folder = Folder::new();
    let grey = image::RgbImage::from_pixel(8, 4, image::Rgb([188; 3]));
    grey.save(folder.path().join("grey.png")).unwrap();
    // sRGB 188 is 0.5029 in linear light; FLIP is taken of what a display shows, where the lamp of 4 is white.
    folder.says(&["grey.png", "reference.exr"], 0, &["warning: grey.png holds whole numbers", "as PNGs of exposure 0"]);
    folder.says(&["reference.exr", "grey.png", "--exposure", "-2"], 0, &["as PNGs of exposure -2"]);
    folder.says(&["image.exr", "reference.exr", "--exposure", "1"], 0, &["as PNGs of exposure 1"]);
    folder.says(&["grey.png", "grey.png"], 0, &["RMSE        0", "whole numbers"]);
}

#[test]
fn wrong_usage() {
    let folder = Folder::new();
    folder.exr("small.exr", &[[0.5; 3]; 16], None);
    folder.says(&["small.exr", "reference.exr"], 2, &["4 x 4 and 8 x 4 pixels"]);
    folder.says(&["image.exr"], 2, &["<REFERENCE>"]);
    for (option, value) in [
        ("--max-rmse", "-1"),
        ("--max-relmse", "nan"),
        ("--max-bias", "inf"),
        ("--max-flip", "much"),
        ("--worst", "-1"),
        ("--exposure", "nan"),
        ("--heatmap", "map.jpg"),
        ("--heatmap", "map"),
        ("--stats", "figures.txt"),
    ] {
        folder.says(&["image.exr", "reference.exr", option, value], 2, &[option, value]);
    }
    std::fs::copy(folder.path().join("image.exr"), folder.path().join("picture.png")).unwrap();
    folder.says(&["picture.png", "reference.exr", "--heatmap", "picture.png"], 2, &["one of the pictures"]);
    folder.says(&["image.exr", "reference.exr", "--heatmap", "gone/map.png"], 1, &["gone", "does not exist"]);
}

#[test]
fn files_that_are_no_pictures() {
    let folder = Folder::new();
    let whole = std::fs::read(folder.path().join("image.exr")).unwrap();
    std::fs::write(folder.path().join("short.exr"), &whole[..whole.len() / 2]).unwrap();
    std::fs::write(folder.path().join("text.png"), "hello").unwrap();
    std::fs::write(folder.path().join("empty.hdr"), "").unwrap();
    std::fs::write(folder.path().join("short.pfm"), "PF\n8 4\n-1\n1234").unwrap();
    for name in ["text.exr", "text.hdr", "text.bin", "text"] {
        std::fs::write(folder.path().join(name), "hello").unwrap();
    }
    std::fs::write(
        folder.path().join("short.hdr"),
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n0123456789abcdefghi",
    )
    .unwrap();
    let path = folder.path().join("short.png");
    image::RgbImage::from_fn(8, 4, |x, y| image::Rgb([x as u8 * 30, y as u8 * 50, 7])).save(&path).unwrap();
    let mut png = std::fs::read(&path).unwrap();
    std::fs::write(&path, &png[..png.len() / 2]).unwrap();
    // The sum of the first chunk does not fit.
    png[20] ^= 1;
    std::fs::write(folder.path().join("flipped.png"), png).unwrap();
    for (name, part) in [
        ("text.exr", "it is no OpenEXR picture"),
        ("text.hdr", "it is no Radiance picture"),
        ("text.bin", "it is no picture"),
        ("text", "it is no picture"),
        ("short.hdr", "it is damaged or cut off"),
        ("short.png", "it is damaged or cut off"),
        ("flipped.png", "it is damaged or cut off\n"),
        ("none.exr", "No such file"),
        (".", "folder"),
        ("short.exr", "damaged or truncated"),
        ("text.png", "text.png"),
        ("empty.hdr", "it is empty"),
        ("short.pfm", "truncated: 8 x 4 pixels take 384 bytes, and 4 are there"),
    ] {
        folder.says(&[name, "reference.exr"], 1, &["cannot read", name, part]);
        folder.says(&["reference.exr", name], 1, &["cannot read", name, part]);
    }
}
