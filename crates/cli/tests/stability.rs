//! The stability map: its charts, its page and its command. What the sweeps promise is tested beside them.

use luminaire::Error;
use luminaire_measure::chart::*;
use luminaire_measure::stability::verdict::{Judgement, Verdict, Worse};
use luminaire_measure::stability::*;
use std::path::Path;
use std::process::{Command, Output};

fn point(x: f64, y: f64, error: Option<f64>) -> Point {
    Point { x, y, error }
}

fn chart(y: Axis, series: &[(&str, &[Point])]) -> Chart {
    let series = series.iter().map(|(name, points)| Series { name: (*name).into(), points: points.to_vec() }).collect();
    Chart { name: "one".into(), title: "A title".into(), x: Axis::log("samples"), y, series }
}

/// The texts of a drawing, after a check that it is well-formed and that nothing lies outside of it.
fn texts(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).expect("well-formed XML");
    let root = document.root_element();
    let side = |name: &str| root.attribute(name).unwrap().parse::<f64>().unwrap();
    let (width, height) = (side("width"), side("height"));
    for node in root.descendants().filter(roxmltree::Node::is_element) {
        for (names, limit) in [(["x", "cx", "x1", "x2"], width), (["y", "cy", "y1", "y2"], height)] {
            for value in names.iter().filter_map(|name| node.attribute(*name)) {
                let value: f64 = value.parse().unwrap();
                assert!((0.0..=limit).contains(&value), "{value} lies outside of {limit}: {node:?}");
            }
        }
        for pair in node.attribute("points").unwrap_or("").split_whitespace() {
            let (x, y) = pair.split_once(',').unwrap();
            let (x, y): (f64, f64) = (x.parse().unwrap(), y.parse().unwrap());
            assert!((0.0..=width).contains(&x) && (0.0..=height).contains(&y), "{pair}");
        }
    }
    let texts = root.descendants().filter(|node| node.has_tag_name("text"));
    texts.map(|node| node.text().unwrap_or("").trim().to_owned()).collect()
}

#[test]
fn charts_are_drawings() {
    let points = [point(1.0, 1e-3, Some(2e-4)), point(10.0, 2e-5, Some(1e-3)), point(100.0, 3e-7, None)];
    let mut plain = chart(Axis::log("error < 1 & > 0"), &[("cpu", &points), ("a \"new\" method", &points)]);
    plain.title = "What is <lost> & why".into();
    let svg = plain.svg();
    let found = texts(&svg);
    for part in ["What is <lost> & why", "error < 1 & > 0", "samples", "cpu", "a \"new\" method", "1e-5", "10"] {
        assert!(found.iter().any(|text| text == part), "no {part:?} in {found:?}");
    }
    assert!(!found.iter().any(|text| text.contains("edge")), "nothing lies on an edge: {found:?}");
    assert_eq!(svg, plain.svg(), "the same chart is the same file");
    assert!(svg.len() < 20_000, "{} bytes", svg.len());
}

/// What has no place is drawn on an edge and said; a gap has no line through it.
#[test]
fn values_without_a_place_are_said() {
    let zero = [point(1.0, 0.0, None), point(10.0, 1e-3, None), point(100.0, -1.0, None)];
    let zero = chart(Axis::log("error"), &[("cpu", &zero)]);
    let found = texts(&zero.svg());
    assert!(found.iter().any(|text| text == "not above zero: on the lower edge"), "{found:?}");
    assert!(found.iter().any(|text| text == "error (zero is drawn on the lower edge)"), "{found:?}");

    let y = [1.0, 2.0, f64::NAN, 3.0, f64::INFINITY];
    let gap: Vec<Point> = (1..).zip(y).map(|(x, y)| point(f64::from(x), y, Some(f64::NAN))).collect();
    for axis in [Axis::linear("y"), Axis::log("y")] {
        let svg = chart(axis, &[("cpu", &gap)]).svg();
        let found = texts(&svg);
        assert!(found.iter().any(|text| text == "gave no number: on the upper edge"), "{found:?}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
    // On a linear axis zero is a value like any other.
    assert!(
        !texts(&chart(Axis::linear("y"), &[("cpu", &[point(1.0, 0.0, None)])]).svg())
            .iter()
            .any(|t| t.contains("edge"))
    );
    // Nothing at all is a chart too.
    for series in [&[][..], &[("cpu", &[][..])], &[("cpu", &[point(1.0, f64::NAN, None)])]] {
        texts(&chart(Axis::log("y"), series).svg());
    }
}

#[test]
fn numbers_are_kept() {
    let points = [point(1.0, 1.0 / 3.0, Some(1e-18)), point(1e6, f64::NAN, None), point(2.0, 0.0, None)];
    let rows = chart(Axis::log("y"), &[("sum, in f32", &points)]).csv();
    let expected = "one,\"sum, in f32\",1.0,0.3333333333333333,1e-18\none,\"sum, in f32\",1000000.0,NaN,\none,\"sum, in f32\",2.0,0.0,\n";
    assert_eq!(rows, expected);
}

#[test]
fn a_page_has_every_sweep_also_the_failed() {
    let definition =
        |name, family| Definition { name, family, title: "from 1 to 2", run: |_| Err(Error::NoDevice("none".into())) };
    let findings = Findings {
        starts: "from 1 on | at once".into(),
        how: "by rounding".into(),
        mends: "it counts".into(),
        sees: "nothing".into(),
    };
    let judged = [(1.0, Judgement::Safe), (2.0, Judgement::Wrong)];
    let verdict = |method: &str| Verdict::new(method, judged, Worse::Upwards, "at 2: 7 | 8 rays a million");
    let done = |methods: &[&str]| Sweep {
        charts: vec![chart(Axis::linear("y"), &[])],
        range: "1 to 2 sizes".into(),
        verdicts: methods.iter().copied().map(verdict).collect(),
        summary: "Stay at 1.".into(),
        findings: findings.clone(),
    };
    let head = Head {
        command: "luminaire stability".into(),
        device: "a device, a driver".into(),
        backends: "cpu".into(),
        folder: "stability".into(),
    };
    let failed = || Err(Error::NoDevice("the device is lost".into()));
    let geometry = done(&["f64 reference", "compute BVH", "f32 model"]);
    let outcomes = [
        (definition("good", Family::Geometry), Ok(geometry)),
        (definition("bad", Family::Geometry), failed()),
        (definition("bright", Family::Light), Ok(done(&["the default", "another", "a third"]))),
        (definition("dark", Family::Light), failed()),
    ];
    let text = page(&head, &outcomes);
    for part in [
        "`luminaire stability`",
        "a device, a driver",
        "| sweep | range | cpu | compute BVH | ray query | in one sentence |\n|---|---|---|---|---|---|\n",
        "| [good](#good) | 1 to 2 sizes | ● at 1, ✖ beyond | ● at 1, ✖ beyond | – | Stay at 1. |",
        "| [bad](#bad) |  |  |  |  | the sweep failed: the device is lost |",
        "| sweep | range | default | others | in one sentence |\n|---|---|---|---|---|\n",
        "| [bright](#bright) | 1 to 2 sizes | ● at 1, ✖ beyond | another: ● at 1, ✖ beyond; a third: ● at 1, ✖ beyond | Stay at 1. |",
        "| [dark](#dark) |  |  |  | the sweep failed: the device is lost |",
        "## <a id=\"dark\"></a>From 1 to 2\n\nThe sweep failed: the device is lost",
        "| f32 model | ● at 1, ✖ beyond | at 2: 7 \\| 8 rays a million |",
        "![A title](<stability/good-one.svg>)",
        "[good.csv](<stability/good.csv>)",
        "**Where it starts to fail.** From 1 on",
        "**How it fails.** By rounding",
        "**What luminaire does.** It counts",
        "**What you see.** Nothing",
    ] {
        assert!(text.contains(part), "no {part:?} in:\n{text}");
    }
    // What only explains has no place in the first table.
    assert!(!text[..text.find("How it was measured").unwrap()].contains("f32 model"), "{text}");
    let alone = page(&head, &[(definition("dark", Family::Light), failed())]);
    assert!(!alone.contains("Geometry, by backend"), "a table of no sweep:\n{alone}");
}

#[test]
fn sweeps_have_file_names_and_are_found_by_them() {
    let names: Vec<_> = SWEEPS.iter().map(|sweep| sweep.name).collect();
    for (index, name) in names.iter().enumerate() {
        assert!(
            !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'),
            "{name}"
        );
        assert!(!names[..index].contains(name), "{name} twice");
    }
    assert_eq!(named(&[]).unwrap().len(), SWEEPS.len());
    let two = named(&[names[1].into(), names[0].into()]).unwrap();
    assert_eq!(two.iter().map(|sweep| sweep.name).collect::<Vec<_>>(), &names[..2]);
    let error = named(&["nonsense".into()]).err().unwrap();
    assert_eq!(error.exit_code(), 2);
    assert!(names.iter().all(|name| error.to_string().contains(name)), "{error}");
}

fn stability(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    command.current_dir(folder).arg("stability").args(words).output().unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn wrong_commands_are_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let fails = |words: &[&str], code: i32, parts: &[&str]| {
        let output = stability(folder.path(), words);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{words:?} said:\n{said}");
        assert!(parts.iter().all(|part| said.contains(part)) && !said.contains("panicked"), "{words:?} said:\n{said}");
        assert!(!said.contains(SWEEPS[0].title), "{words:?} began to work:\n{said}");
    };
    fails(&["nonsense"], 2, &["nonsense", SWEEPS[0].name]);
    assert!(names(folder.path()).is_empty());
    std::fs::write(folder.path().join("file"), "").unwrap();
    fails(&["--out", "file"], 1, &["error: cannot write file"]);
    fails(&["--out", "file/folder"], 1, &["error: cannot write file/folder"]);
    fails(&["--out", "folder", "--page", "none/page.md"], 1, &["none/page.md", "does not exist"]);
}

#[test]
fn the_list_has_every_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let output = stability(folder.path(), &["--list"]);
    let listed = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success());
    assert!(SWEEPS.iter().all(|sweep| listed.contains(sweep.name) && listed.contains(sweep.title)), "{listed}");
    assert!(names(folder.path()).is_empty());
}

/// A real sweep, without a Vulkan device: the reference alone, and the page says so.
#[test]
fn a_sweep_without_a_device() {
    let folder = tempfile::tempdir().unwrap();
    let nothing = folder.path().join("no-driver.json");
    std::fs::write(&nothing, "").unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_luminaire"));
    command.current_dir(folder.path()).env("VK_DRIVER_FILES", &nothing).env("VK_ICD_FILENAMES", &nothing);
    let output = command.args(["stability", "samples", "--out", "out", "--page", "page.md"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("not here: compute-bvh, ray-query"), "{said}");
    assert_eq!(names(folder.path()), ["no-driver.json", "out", "page.md"]);
    let files = ["samples-constant.svg", "samples-random.svg", "samples-rendered.svg", "samples.csv"];
    assert_eq!(names(&folder.path().join("out")), files);
    let page = std::fs::read_to_string(folder.path().join("page.md")).unwrap();
    assert!(page.contains("not here: compute-bvh, ray-query"), "{page}");
    // Measured: the sums hold over the whole range, and a plain sum in single precision does not.
    assert!(page.contains("| [samples](#samples) | 1 to 1e6 samples a pixel | ● | f32 sum: ● to"), "{page}");
    let row = page.lines().find(|line| line.starts_with("| [samples]")).unwrap();
    let sentence = row.rsplit(" | ").next().unwrap().trim_end_matches(" |");
    assert!(sentence.chars().count() <= SUMMARY && sentence.ends_with('.'), "{sentence}");
    assert!(page.contains("(<out/samples-constant.svg>)"), "{page}");
    assert!(page.contains("luminaire stability samples --out out --page page.md"), "{page}");
    for svg in &files[..3] {
        texts(&std::fs::read_to_string(folder.path().join("out").join(svg)).unwrap());
    }
    let csv = std::fs::read_to_string(folder.path().join("out/samples.csv")).unwrap();
    assert!(csv.starts_with("chart,method,x,y,error\n") && csv.lines().count() > 10, "{csv}");
}
