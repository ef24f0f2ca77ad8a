//! Photometric files, and the luminaires of a scene file that shine into cones, discs and by them.

use super::*;
use glam::Vec3;
use luminaire::scene::{Luminaire, Profile};

/// The numbers up to the angles, with a multiplier of 2, ballast factors and a type.
fn numbers(vertical: usize, horizontal: usize, ballast: &str, of_type: u32) -> String {
    format!("1 1000 2 {vertical} {horizontal} {of_type} 2 0.1 0.2 0\n{ballast} 60\n")
}

/// A file of the revision of 2002.
fn file(rest: &str) -> String {
    format!("IESNA:LM-63-2002\n[TEST] none\n[MANUFAC] nobody\nTILT=NONE\n{rest}")
}

/// Three vertical angles, one horizontal one.
fn plain(candela: &str) -> String {
    file(&format!("{}0 45 90\n0\n{candela}\n", numbers(3, 1, "1 1", 1)))
}

/// A scene with a lamp by this file.
fn lamp(ies: impl AsRef<[u8]>) -> Folder {
    let light = "[[luminaire]]\nkind = \"point\"\nposition = [0, 2, 0]\nprofile = \"lamp.ies\"\nup = [1, 0, 0]\n";
    let text = format!("{SENSOR}{light}[[object]]\nmesh = \"mesh.obj\"\n");
    obj(TRIANGLE).with("lamp.ies", ies).with("scene.toml", text)
}

fn profile(scene: &Scene) -> &Profile {
    match &scene.luminaires[0] {
        Luminaire::Photometric { profile, .. } => profile,
        other => panic!("{other:?}"),
    }
}

fn load_lamp(ies: &str) -> (Profile, Vec<String>) {
    let scene = lamp(ies).load("scene.toml");
    (profile(&scene).clone(), scene.warnings.clone())
}

/// An error in the file at a line.
#[track_caller]
fn lamp_fails(ies: &str, line: usize, words: &[&str]) {
    lamp(ies).fails_at("scene.toml", "lamp.ies", (line, 0), words);
}

#[test]
fn a_plain_file() {
    let folder = lamp(plain("100, 50.5,\t0"));
    let scene = folder.load("scene.toml");
    assert_eq!(scene.warnings, Vec::<String>::new());
    let expected = Luminaire::Photometric {
        position: Vec3::Y * 2.0,
        direction: Vec3::NEG_Y,
        up: Vec3::X,
        intensity: Vec3::ONE,
        profile: Profile {
            name: "lamp.ies".into(),
            vertical: vec![0.0, 45.0, 90.0],
            horizontal: vec![0.0],
            candela: vec![200.0, 101.0, 0.0],
        }
        .into(),
    };
    assert_eq!(scene.luminaires, [expected]);
    assert!(scene.files.contains(&folder.path("lamp.ies")));
}

/// As programs write it: other ends of lines, blanks, small letters, numbers over several lines, letters that are not UTF-8, text behind.
#[test]
fn odd_files_that_are_right() {
    for text in [
        plain("1 2 3").replace('\n', "\r\n"),
        plain("1 2 3").replace('\n', "\r"),
        plain("1 2 3").replace("TILT=NONE", "  tilt= none  "),
        plain("1\n\n 2\n3"),
        plain("1.0e0 2E+0 +3."),
        format!("\u{feff}{}", plain("1 2 3")),
    ] {
        let (profile, warnings) = load_lamp(&text);
        assert_eq!(profile.candela, [2.0, 4.0, 6.0], "{text}");
        assert_eq!(warnings, Vec::<String>::new(), "{text}");
    }
    let mut latin = b"IESNA:LM-63-1995\n[LAMP] Gl\xfchlampe\n".to_vec();
    latin.extend(plain("1 2 3").split_once("[MANUFAC]").expect("a keyword").1.bytes());
    assert_eq!(profile(&lamp(latin).load("scene.toml")).candela, [2.0, 4.0, 6.0]);
    let scene = lamp(plain("1 2 3 4 5")).load("scene.toml");
    warned(&scene, &["lamp.ies:9: `4`", "left out"]);
}

/// What the second number behind the angles' counts means depends on the revision, and so does what the first line is.
#[test]
fn revisions() {
    let of = |first: &str, ballast: &str| {
        let text = format!("{first}TILT=NONE\n{}0 90\n0\n3 1\n", numbers(2, 1, ballast, 1));
        let (profile, warnings) = load_lamp(&text);
        (profile.candela[0], warnings.len())
    };
    assert_eq!(of("", "0.5 0.5"), (1.5, 0));
    assert_eq!(of("A lamp of 1985\n", "0.5 0.5"), (1.5, 0));
    assert_eq!(of("IESNA91\n", "0.5 0.5"), (1.5, 0));
    assert_eq!(of("IESNA:LM-63-1995\n", "0.5 1"), (3.0, 0));
    assert_eq!(of("IESNA:LM-63-2002\n", "0.5 0.5"), (3.0, 1));
    // There it says how the file was made.
    assert_eq!(of("IES:LM-63-2019\n", "0.5 1.10001"), (3.0, 0));
}

#[test]
fn tilt_is_read_and_left_out() {
    let tilted = plain("1 2 3").replace("TILT=NONE", "TILT=INCLUDE\n1\n3\n0 45\n90\n1 .9 .8");
    let (profile, warnings) = load_lamp(&tilted);
    assert_eq!(profile.candela, [2.0, 4.0, 6.0]);
    assert!(warnings[0].contains("lamp.ies:4: TILT=INCLUDE"), "{warnings:?}");
    let (profile, warnings) = load_lamp(&plain("1 2 3").replace("TILT=NONE", "TILT=tilt.dat"));
    assert_eq!(profile.candela, [2.0, 4.0, 6.0]);
    assert!(warnings[0].contains("`TILT=tilt.dat`"), "{warnings:?}");
}

/// Whatever part of the turn a file has, the profile has all of it.
#[test]
fn symmetries() {
    let of = |angles: &str, candela: &str| {
        let (vertical, count) = ("0 90", angles.split(' ').count());
        let text = file(&format!("{}{vertical}\n{angles}\n{candela}\n", numbers(2, count, "1 1", 1)));
        let (profile, warnings) = load_lamp(&text);
        let mut at_90 = vec![];
        for (row, angle) in profile.horizontal.iter().enumerate() {
            assert_eq!(profile.candela[2 * row], 2.0);
            at_90.push((*angle, profile.candela[2 * row + 1] / 2.0));
        }
        (at_90, warnings.len())
    };
    let even = vec![(0.0, 5.0)];
    assert_eq!(of("0", "1 5"), (even.clone(), 0));
    assert_eq!(of("45", "1 5"), (even, 0));
    let quadrant = vec![
        (0.0, 5.0),
        (45.0, 6.0),
        (90.0, 7.0),
        (135.0, 6.0),
        (180.0, 5.0),
        (225.0, 6.0),
        (270.0, 7.0),
        (315.0, 6.0),
        (360.0, 5.0),
    ];
    assert_eq!(of("0 45 90", "1 5 1 6 1 7"), (quadrant, 0));
    let half = vec![(0.0, 5.0), (45.0, 6.0), (180.0, 7.0), (315.0, 6.0), (360.0, 5.0)];
    assert_eq!(of("0 45 180", "1 5 1 6 1 7"), (half, 0));
    let turned = vec![(0.0, 6.0), (90.0, 5.0), (180.0, 6.0), (270.0, 7.0), (360.0, 6.0)];
    assert_eq!(of("90 180 270", "1 5 1 6 1 7"), (turned, 0));
    let whole = vec![(0.0, 5.0), (180.0, 6.0), (360.0, 7.0)];
    assert_eq!(of("0 180 360", "1 5 1 6 1 7"), (whole, 0));
    let closed = vec![(0.0, 5.0), (120.0, 6.0), (240.0, 7.0), (360.0, 5.0)];
    assert_eq!(of("0 120 240", "1 5 1 6 1 7"), (closed, 1));
}

#[test]
fn wrong_files_are_found_with_their_line() {
    lamp_fails("nothing\n", 1, &["TILT=", "LM-63", "EULUMDAT"]);
    lamp_fails("", 1, &["TILT="]);
    lamp_fails(&plain("1 2 3").replace("TILT=NONE", "TILT="), 4, &["TILT=NONE"]);
    lamp_fails(&plain("1 2"), 9, &["a candela value", "the file ends"]);
    lamp_fails(&plain("1 two 3"), 9, &["a candela value", "`two`"]);
    lamp_fails(&plain("1 nan 3"), 9, &["a candela value", "`nan`"]);
    lamp_fails(&plain("1 -2 3"), 9, &["at least 0", "-2"]);
    lamp_fails(&plain("1 1e39 3"), 9, &["1e39 candelas, times", "too many"]);
    let with = |from: &str, to: &str| plain("1 2 3").replace(from, to);
    lamp_fails(&with("1 1000 2 3", "1 1000 0 3"), 5, &["candela multiplier", "above 0", "found 0"]);
    lamp_fails(&with("1 1 60", "-1 1 60"), 6, &["ballast factor", "above 0"]);
    lamp_fails(&with("2 3 1 1 2", "2 1 1 1 2"), 5, &["vertical angles", "at least 2"]);
    lamp_fails(&with("2 3 1 1 2", "2 3.5 1 1 2"), 5, &["vertical angles", "3.5"]);
    lamp_fails(&with("2 3 1 1 2", "2 4000000000 1 1 2"), 5, &["vertical angles"]);
    lamp_fails(&with("2 3 1 1 2", "2 100000000 1 1 2"), 8, &["a vertical angle above 90, found 0"]);
    lamp_fails(&with("2 3 1 1 2", "2 3 0 1 2"), 5, &["horizontal angles", "at least 1"]);
    lamp_fails(&with("2 3 1 1 2", "2 3 1 2 2"), 5, &["type B", "not read"]);
    lamp_fails(&with("2 3 1 1 2", "2 3 1 3 2"), 5, &["type A", "not read"]);
    lamp_fails(&with("2 3 1 1 2", "2 3 1 4 2"), 5, &["photometric type", "found 4"]);
    lamp_fails(&with("0 45 90", "0 90 45"), 7, &["above 90, found 45", "rise"]);
    lamp_fails(&with("0 45 90", "-90 0 90"), 7, &["0 to 180", "-90"]);
    lamp_fails(&with("0 45 90", "0 45 200"), 7, &["0 to 180", "200"]);
    let sides = |angles: &str| file(&format!("{}0 90\n{angles}\n1 2 3 4\n", numbers(2, 2, "1 1", 1)));
    lamp_fails(&sides("0 45"), 8, &["from 0 to 45", "expected 0 alone"]);
    lamp_fails(&sides("0 361"), 8, &["0 to 360", "361"]);
    lamp_fails(&plain("1 2 3").replace("TILT=NONE", "TILT=INCLUDE\n1\n-3\n"), 6, &["tilt angles"]);
    let error = lamp([0xff, 0xfe, 0x54, 0]).error("scene.toml").to_string();
    assert!(error.contains("UTF-16") && error.contains("scene.toml:8"), "{error}");
}

#[test]
fn what_is_guessed_is_said() {
    let (_, warnings) = load_lamp(&plain("0 0 0"));
    assert!(warnings[0].contains("dark"), "{warnings:?}");
    let (_, warnings) = load_lamp(&plain("1 2 3").replace("0 45 90", "0 45 80"));
    assert!(warnings[0].contains("from 0 to 80") && warnings[0].contains("no light"), "{warnings:?}");
    let sides = file(&format!("{}0 90\n0 90\n1 2 3 4\n", numbers(2, 2, "1 1", 1)));
    let luminaire = "[[luminaire]]\nkind = \"point\"\nposition = [0, 2, 0]\nprofile = \"lamp.ies\"\n";
    let folder = scene(luminaire).with("lamp.ies", &sides);
    warned(&folder.load("scene.toml"), &["scene.toml:11: lamp.ies", "`up`", "+x"]);
    // One that is the same all around has no sides.
    let folder = scene(luminaire).with("lamp.ies", plain("1 2 3"));
    assert_eq!(folder.load("scene.toml").warnings, Vec::<String>::new());
}

/// The same file is read once, and a missing one is named where it is named, with what is there instead.
#[test]
fn profiles_are_files() {
    let luminaire = |name: &str, more: &str| {
        format!("[[luminaire]]\nkind = \"point\"\nposition = [0, 2, 0]\nprofile = \"{name}\"\n{more}")
    };
    let twice = luminaire("lamp.ies", "") + &luminaire("./lamp.ies", "direction = [1, 0, 0]\nintensity = [1, 2, 3]\n");
    let loaded = scene(&twice).with("lamp.ies", plain("1 2 3")).load("scene.toml");
    let [
        _,
        Luminaire::Photometric { profile: a, up, .. },
        Luminaire::Photometric { profile: b, direction, intensity, .. },
    ] = &loaded.luminaires[..]
    else {
        panic!("{:?}", loaded.luminaires)
    };
    assert!(std::sync::Arc::ptr_eq(a, b));
    assert_eq!((*up, *direction, *intensity), (Vec3::X, Vec3::X, Vec3::new(1.0, 2.0, 3.0)));
    let error = scene(&luminaire("lampe.ies", "")).with("lamp.ies", plain("1 2 3")).error("scene.toml").to_string();
    assert!(error.contains("scene.toml:14:11") && error.contains("there is lamp.ies"), "{error}");
    let bright = scene(&luminaire("lamp.ies", "intensity = [1e38, 0, 0]\n")).with("lamp.ies", plain("1 20 3"));
    bright.fails_at("scene.toml", "scene.toml", (11, 1), &["4.0e1 candelas"]);
    // Before it is looked for, what is wrong in the scene file itself.
    let of = |more: &str| scene(&luminaire("none.ies", more)).error("scene.toml").to_string();
    for (more, words) in [
        ("up = [0, 3, 0]\n", "not along `direction`"),
        ("up = [0, 0, 0]\n", "not along `direction`"),
        ("direction = [0, 0, 0]\n", "zero vector"),
    ] {
        let error = of(more);
        assert!(error.contains("scene.toml:11:1") && error.contains(words), "{error}");
    }
    for (more, words) in
        [("outer_angle = 3\n", "`outer_angle` is too much"), ("irradiance = [1, 1, 1]\n", "`irradiance` is too much")]
    {
        let error = of(more);
        assert!(error.contains("scene.toml:15:1") && error.contains(words) && error.contains("`profile`"), "{error}");
    }
    scene(&luminaire("", "")).fails_at("scene.toml", "scene.toml", (14, 11), &["empty name", "an IES file"]);
    let spot = "[[luminaire]]\nkind = \"spot\"\nposition = [0, 1, 0]\nprofile = \"lamp.ies\"\n";
    toml_fails(spot, (1, 1), &["`profile` is for a luminaire of the kind \"point\""]);
}

#[test]
fn spots_and_suns() {
    let spot = "[[luminaire]]\nkind = \"spot\"\nposition = [0, 1, 0]\ndirection = [0, -2, 0]\nintensity = [1, 2, 3]\n";
    let sun = "[[luminaire]]\nkind = \"infinite\"\ndirection = [0, -2, 0]\nirradiance = [1, 2, 3]\n";
    let of = |text: String| scene(&text).load("scene.toml").luminaires[1].clone();
    let (position, direction, colour) = (Vec3::Y, Vec3::NEG_Y, Vec3::new(1.0, 2.0, 3.0));
    for (more, inner, outer) in
        [("outer_angle = 30\n", 0.0, 30.0), ("outer_angle = 90\ninner_angle = 90\n", 90.0, 90.0)]
    {
        let expected = Luminaire::Spot { position, direction, intensity: colour, inner, outer };
        assert_eq!(of(format!("{spot}{more}")), expected);
    }
    assert_eq!(of(format!("{sun}angle = 0.53\n")), Luminaire::Sun { direction, irradiance: colour, angle: 0.53 });
    // No disc is what it always was.
    let parallel = Luminaire::Infinite { direction, irradiance: colour };
    assert_eq!(of(sun.into()), parallel);
    assert_eq!(of(format!("{sun}angle = 0\n")), parallel);

    for (more, at, words) in [
        ("outer_angle = 91\n", (6, 15), "0 to 90"),
        ("outer_angle = -1\n", (6, 15), "0 to 90"),
        ("outer_angle = nan\n", (6, 15), "0 to 90"),
        ("outer_angle = 0\n", (1, 1), "from 0.0001 to 90"),
        ("outer_angle = 20\ninner_angle = 21\n", (7, 15), "at most the `outer_angle`, 20 degrees, found 21"),
        ("inner_angle = 20\n", (1, 1), "`outer_angle` is missing here: a spot has"),
        ("angle = 20\n", (6, 1), "`outer_angle` is missing here, and `angle` is too much: a spot has"),
        ("outer_angle = 20\nangle = 3\n", (7, 1), "`angle` is too much: a spot has"),
        ("outer_angle = 20\nangle = 3\nup = [1, 0, 0]\n", (8, 1), "`up`, `angle` are too much: a spot has"),
        ("outerConeAngle = 0.5\n", (6, 1), "`outer_angle`"),
        ("cone = 0.5\n", (6, 1), "in degrees from its axis"),
    ] {
        toml_fails(&format!("{spot}{more}"), at, &[words]);
    }
    for (more, at, words) in [
        ("angle = 181\n", (5, 9), "0.0001 to 180"),
        ("angle = 1e-5\n", (5, 9), "0 for parallel light"),
        ("angle = -0.5\n", (5, 9), "0.0001 to 180"),
        ("outer_angle = 5\n", (5, 1), "`outer_angle` is too much: an infinite luminaire has"),
        ("diameter = 5\n", (5, 1), "`angle`"),
    ] {
        toml_fails(&format!("{sun}{more}"), at, &[words]);
    }
    let bright = sun.replace("[1, 2, 3]", "[1e36, 1, 1]");
    toml_fails(&format!("{bright}angle = 1e-4\n"), (1, 1), &["a larger `angle`"]);
    toml_fails("[[luminaire]]\nkind = \"spotlight\"\n", (2, 8), &["\"spot\""]);
    toml_fails("[[luminaire]]\nkind = \"ies\"\n", (2, 8), &["`profile`"]);
    warned(&scene(&format!("{spot}outer_angle = 0.785\n")).load("scene.toml"), &["scene.toml:11", "radians", "45.0"]);
    let point = "[[luminaire]]\nkind = \"point\"\nposition = [0, 1, 0]\nintensity = [1, 1, 1]\n";
    for more in ["direction = [0, 1, 0]\n", "outer_angle = 3\n", "angle = 3\n", "up = [0, 1, 0]\n"] {
        let key = format!("`{}` is too much", more.split(' ').next().expect("a key"));
        toml_fails(&format!("{point}{more}"), (5, 1), &[&key, "a point luminaire", "nothing else"]);
    }
    toml_fails(
        "[[luminaire]]\nkind = \"point\"\nposition = [0, 1, 0]\n",
        (1, 1),
        &["`intensity` is missing here: a point luminaire"],
    );
    warned(
        &scene(&format!("{spot}outer_angle = 20\ninner_angle = 0.35\n")).load("scene.toml"),
        &["inner_angle", "20.1"],
    );
    warned(&scene(&format!("{sun}angle = 0.00925\n")).load("scene.toml"), &["scene.toml:11", "radians", "0.53"]);
}
