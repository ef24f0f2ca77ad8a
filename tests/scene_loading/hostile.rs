//! Input that is meant to hurt: it is refused with a word that helps, in a time and a memory in proportion to its size.

use super::*;
use std::time::Instant;

/// A PNG that begins with this header and these chunks.
fn png(width: u32, height: u32, more: &[u8]) -> Vec<u8> {
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 2, 0, 0, 0]].concat();
    [b"\x89PNG\r\n\x1a\n".to_vec(), chunk(b"IHDR", &header), more.to_vec(), chunk(b"IDAT", b"")].concat()
}

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [kind, data].concat();
    [&(data.len() as u32).to_be_bytes()[..], &body, &crc32(&body).to_be_bytes()].concat()
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

/// An OpenEXR file of three float channels that ends after its header.
fn exr(width: i32, height: i32) -> Vec<u8> {
    let attribute = |name: &str, kind: &str, value: &[u8]| {
        [name.as_bytes(), b"\0", kind.as_bytes(), b"\0", &(value.len() as i32).to_le_bytes(), value].concat()
    };
    let channel = |name: &[u8]| [name, &[0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]].concat();
    let window: Vec<u8> = [0, 0, width - 1, height - 1].into_iter().flat_map(i32::to_le_bytes).collect();
    [
        vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0],
        attribute("channels", "chlist", &[channel(b"B"), channel(b"G"), channel(b"R"), vec![0]].concat()),
        attribute("compression", "compression", &[0]),
        attribute("dataWindow", "box2i", &window),
        attribute("displayWindow", "box2i", &window),
        attribute("lineOrder", "lineOrder", &[0]),
        attribute("pixelAspectRatio", "float", &1f32.to_le_bytes()),
        attribute("screenWindowCenter", "v2f", &[0; 8]),
        attribute("screenWindowWidth", "float", &1f32.to_le_bytes()),
        vec![0; 64],
    ]
    .concat()
}

/// What is said of an image as a texture (a warning), and as an environment (an error).
#[track_caller]
fn refused(name: &str, image: &[u8], words: &[&str]) {
    let folder = with_mtl(format!("newmtl m\nmap_Kd {name}\n")).with(name, image);
    warned(&folder.load("mesh.obj"), &[&[name, "cannot be used"], words].concat());
    let text = format!("[[object]]\nmesh = \"mesh.obj\"\n[environment]\nimage = \"{name}\"\n");
    folder.with("scene.toml", text).fails_at("scene.toml", "scene.toml", (4, 9), &[&[name], words].concat());
}

#[test]
fn images_that_say_they_are_enormous() {
    refused("a.png", &png(100_000, 100_000, b""), &["too large", "16384"]);
    refused("a.png", &png(u32::MAX >> 1, 1, b""), &["too large"]);
    refused("a.exr", &exr(100_000, 100_000), &["too large", "16384"]);
    refused("a.exr", &exr(i32::MAX, i32::MAX), &[]);
    refused("a.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n", &["too large", "16384"]);
    // A file that ends long before its texels do.
    refused("a.exr", &exr(8192, 8192), &[]);
    refused("a.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 8192\n", &[]);
}

/// Two megabytes that would become a quarter of a gigabyte.
#[test]
fn a_colour_profile_that_is_a_bomb() {
    let start = Instant::now();
    let profile = [b"k\0\0".to_vec(), zeros(1 << 28)].concat();
    assert!(profile.len() < 1 << 21, "{}", profile.len());
    refused("a.png", &png(1, 1, &chunk(b"iCCP", &profile)), &[]);
    assert!(start.elapsed().as_secs() < 20);
}

/// So many zeros, by zlib's fixed Huffman code: matches of 258 bytes at distance 1 are 13 bits.
fn zeros(count: usize) -> Vec<u8> {
    let (mut bytes, mut bits, mut filled) = (vec![0x78, 0x01], 0u64, 0);
    let mut put = |value: u64, width: u32| {
        bits |= value << filled;
        filled += width;
        while filled >= 8 {
            bytes.push(bits as u8);
            bits >>= 8;
            filled -= 8;
        }
    };
    put(0b011, 3);
    // The literal 0 is 00110000, length 258 is 11000101, distance 1 is 00000: most significant bit first.
    put(0b0000_1100, 8);
    for _ in 0..count / 258 {
        put(0b1010_0011, 8);
        put(0, 5);
    }
    put(0, 7);
    put(0, 8);
    bytes.extend([0; 4]);
    bytes
}

#[test]
fn names_in_any_alphabet() {
    let folder = obj(format!("\u{feff}mtllib матеріали.mtl\nusemtl 木目 ✓\n{TRIANGLE}"))
        .with("матеріали.mtl", "\u{feff}newmtl 木目 ✓\nKd 0.1 0.2 0.3\nmap_Ke größe ü.ppm\n")
        .with("größe ü.ppm", b"P6 1 1 255\n\xff\xff\xff");
    let scene = folder.load("mesh.obj");
    assert_eq!((first_material(&scene).name.as_str(), first_material(&scene).lambert.x), ("木目 ✓", 0.1));
    assert_eq!(scene.textures[0].name, "größe ü.ppm");
    let text = "[[object]]\nmesh = \"mesh.obj\"\nmaterial = \"木目 ✓\"\n";
    assert_eq!(folder.with("szene.toml", text).load("szene.toml").materials.len(), scene.materials.len());
}

#[test]
fn long_words_and_names_are_shortened_in_messages() {
    let long = "x".repeat(1 << 20);
    for text in
        [format!("v 0 0 {long}\n"), format!("{TRIANGLE}f 1 2 {long}\n"), format!("{TRIANGLE}f 1/{long}/2/3 2 3\n")]
    {
        let message = obj(text).error("mesh.obj").to_string();
        assert!(message.len() < 1000 && message.contains("(1048"), "{} bytes", message.len());
    }
    let scene = obj(format!("usemtl {long}\n{long}\n{TRIANGLE}")).load("mesh.obj");
    assert!(scene.warnings.iter().all(|warning| warning.len() < 1000));
    warned(&scene, &["no MTL file defines `xxx", "(1048576 bytes)"]);
    let scene = with_mtl(format!("newmtl m\nKd {long}\n{long} 1\nmap_{long} x\n")).load("mesh.obj");
    assert!(scene.warnings.iter().all(|warning| warning.len() < 1000));
}

#[test]
fn warnings_carry_no_control_characters() {
    let scene = obj(format!("usemtl \x1b[31mred\x07\n{TRIANGLE}")).load("mesh.obj");
    warned(&scene, &["`\u{fffd}[31mred\u{fffd}`"]);
}

#[test]
fn a_bad_file_has_only_so_many_warnings() {
    let scene = with_mtl(format!("newmtl m\n{}", "Kd x\n".repeat(10_000))).load("mesh.obj");
    assert!(scene.warnings.len() < 110, "{}", scene.warnings.len());
    warned(&scene, &["mesh.mtl", "9900 more warnings"]);
    let ignored: String = (0..10_000).map(|k| format!("map_{k} x\n")).collect();
    let scene = with_mtl(format!("newmtl m\n{ignored}")).load("mesh.obj");
    assert!(scene.warnings.iter().all(|warning| warning.len() < 1000));
}

/// None of these may take a time that grows with the square of the size: at this size that would be minutes.
#[test]
fn many_of_anything_take_time_in_proportion() {
    let start = Instant::now();
    let count = 200_000;
    let lines = |line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    let materials = lines(&|k| format!("newmtl m{k}\nmap_{} x\n", k % 1000));
    let uses = lines(&|k| format!("usemtl m{k}\nf 1 2 3\n"));
    let folder = obj(format!("mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{uses}")).with("mesh.mtl", materials);
    assert_eq!(folder.load("mesh.obj").materials.len(), count + 2, "the default and the ground");
    // A smoothing group for each face, all at one point.
    let groups = lines(&|k| format!("s {}\nf 1 2 3\n", k + 1));
    let scene = obj(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{groups}")).load("mesh.obj");
    assert_eq!(scene.meshes[0].triangles.len(), count);
    // Normals by angle compare each face with each at a point: as many at each of fifty points as are compared.
    let fan = 4000;
    let corners = lines(&|k| {
        let (sin, cos) = (k as f64).sin_cos();
        format!("v {cos} 0 {sin}\n")
    });
    let faces = lines(&|k| format!("f {} {} {}\n", count + 1 + k / fan, 1 + k, 1 + (k + 1) % count));
    let tips: String = (0..count / fan).map(|k| format!("v {} 1 0\n", 1e-3 * k as f64)).collect();
    assert_eq!(obj(format!("{corners}{tips}{faces}")).load("mesh.obj").meshes[0].triangles.len(), count);
    // One mesh, many times.
    let objects = "[[object]]\nmesh = \"mesh.obj\"\n".repeat(300);
    let scene = folder.with("scene.toml", objects).load("scene.toml");
    assert_eq!(scene.objects.len(), 300);
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn a_scene_file_that_is_nested_deeply() {
    let text = format!("[[object]]\nmesh = {}1{}\n", "[".repeat(100_000), "]".repeat(100_000));
    toml_fails(&text, (2, 88), &["recursion"]);
    let folder = Folder::new().with("scene.toml", format!("{} = 1\n", vec!["a"; 100_000].join(".")));
    assert_eq!(folder.error("scene.toml").exit_code(), 1);
}

/// From a point of one of them the other fills half of all directions, or none.
#[test]
fn luminaires_that_lie_in_each_other() {
    let text = format!("mtllib mesh.mtl\nusemtl m\n{TRIANGLE}f 1 2 3\nv 1 1 0\nf 2 4 3\nf 3 2 1\n");
    let folder = obj(text).with("mesh.mtl", "newmtl m\nKd 0.5 0.5 0.5\nKe 1 1 1\n");
    let film = format!("{SENSOR}[film]\nwidth = 64\nheight = 64\n[[object]]\nmesh = \"mesh.obj\"\n");
    let scene = folder.with("scene.toml", film).load("scene.toml");
    let tracer = luminaire::reference::Reference::new(&scene);
    for sample in 0..16 {
        assert!((0..64 * 64).all(|pixel| tracer.radiance(pixel, sample).0.is_finite()));
    }
}

#[test]
fn files_may_lie_anywhere_and_be_found_by_any_path() {
    let folder = scene("").with("deep/er/scene.toml", "[[object]]\nmesh = \"../../mesh.obj\"\n");
    assert_eq!(folder.load("deep/er/scene.toml").triangle_count(), 1);
    let absolute = format!("[[object]]\nmesh = {:?}\n", folder.path("mesh.obj").display().to_string());
    assert_eq!(folder.with("other/scene.toml", absolute).load("other/scene.toml").triangle_count(), 1);
}

#[cfg(unix)]
mod links {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_that_go_round_in_circles() {
        let folder = with_mtl("newmtl m\nmap_Kd a.png\n");
        for (from, to) in [("a.png", "b.png"), ("b.png", "a.png"), ("round.mtl", "round.mtl"), ("x.obj", "x.obj")] {
            symlink(folder.path(to), folder.path(from)).expect("a link");
        }
        let scene = folder.load("mesh.obj");
        warned(&scene, &["mesh.mtl:2", "a.png", "cannot be used"]);
        assert!(folder.error("x.obj").to_string().contains("symbolic links"));
        let folder = folder.with("y.obj", format!("mtllib round.mtl\n{TRIANGLE}"));
        warned(&folder.load("y.obj"), &["y.obj:1", "round.mtl", "symbolic links"]);
        // A folder that contains itself.
        std::fs::create_dir(folder.path("loop")).expect("a folder");
        symlink(folder.path("loop"), folder.path("loop/loop")).expect("a link");
        let deep = format!("{}no.obj", "loop/".repeat(30));
        folder.with("scene.toml", format!("[[object]]\nmesh = \"{deep}\"\n")).fails_at(
            "scene.toml",
            "scene.toml",
            (2, 8),
            &["no.obj", "No such file"],
        );
    }

    /// Each of them would never end, or wait for ever.
    #[test]
    fn devices_and_folders_are_no_files() {
        let folder = scene("");
        for (name, target) in [
            ("zero.obj", "/dev/zero"),
            ("zero.toml", "/dev/zero"),
            ("zero.mtl", "/dev/zero"),
            ("zero.png", "/dev/zero"),
        ] {
            symlink(target, folder.path(name)).expect("a link");
        }
        std::fs::create_dir(folder.path("folder.obj")).expect("a folder");
        std::fs::create_dir(folder.path("folder.toml")).expect("a folder");
        assert!(folder.error("zero.obj").to_string().contains("not a regular file"));
        assert!(folder.error("zero.toml").to_string().contains("not a regular file"));
        assert!(folder.error("folder.obj").to_string().contains("it is a folder"));
        assert!(folder.error("folder.toml").to_string().contains("it is a folder"));
        let text = "[[object]]\nmesh = \"zero.obj\"\n";
        let folder = folder.with("a.toml", text);
        folder.fails_at("a.toml", "a.toml", (2, 8), &["zero.obj", "not a regular file"]);
        let folder = folder.with("b.toml", "[[object]]\nmesh = \"mesh.obj\"\n[environment]\nimage = \"/dev/zero\"\n");
        folder.fails_at("b.toml", "b.toml", (4, 9), &["/dev/zero", "not a regular file"]);
        let folder = folder.with("c.obj", format!("mtllib zero.mtl\nmtllib c.mtl\nusemtl m\n{TRIANGLE}"));
        let scene = folder.with("c.mtl", "newmtl m\nmap_Kd zero.png\n").load("c.obj");
        warned(&scene, &["c.obj:1", "zero.mtl", "not a regular file"]);
        warned(&scene, &["c.mtl:2", "zero.png", "not a regular file"]);
    }
}
