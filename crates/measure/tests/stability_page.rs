//! The page of the stability map, and the names of its sweeps.

use luminaire::Error;
use luminaire_measure::chart::{Axis, Chart};
use luminaire_measure::stability::verdict::{Judgement, Verdict, Worse};
use luminaire_measure::stability::{Definition, Family, Findings, Head, SWEEPS, Sweep, named, page};

/// A chart without points.
fn chart() -> Chart {
    Chart { name: "one".into(), title: "A title".into(), x: Axis::log("samples"), y: Axis::linear("y"), series: vec![] }
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
        charts: vec![chart()],
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
        "5 % of noise take more than 40000 samples a pixel",
        "| ? not known | – | no bias is proved, but one of 10 % of the light would not be seen in these samples |",
        "Two errors are charted that no verdict goes by",
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
