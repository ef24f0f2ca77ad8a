//! Runs of the benchmark, compared and as pages.

#[path = "documents/html.rs"]
mod html;

use html::check_page;
use luminaire_measure::bench::{
    Baseline, Better, Effort, Figure, Machine, Report, SECTIONS, Section, Settings, Verdict, html,
};

/// A run held against itself has no difference, whatever its spread.
#[test]
fn a_run_is_no_worse_than_itself() {
    let figure = |name: &str, values: &[f64]| Figure::of(name.into(), "s", Better::Lower, values).unwrap();
    let section = |factor: f64| Section {
        name: "convergence",
        title: "A <title>".into(),
        text: vec!["`code` & text".into()],
        tables: vec![],
        charts: vec![],
        figures: vec![
            figure("convergence/a/seconds", &[factor, 1.1 * factor, 1.2 * factor]),
            figure("convergence/b/relmse", &[-0.1, 0.0, 0.1]),
            figure("convergence/c/seconds", &[1.0]),
        ],
    };
    let settings = Settings {
        effort: Effort::Quick,
        rounds: 3,
        scenes: vec![],
        backends: vec![luminaire::backend::Backend::Cpu],
        estimators: vec![],
        reference: None,
    };
    let machine = Machine {
        device: "none".into(),
        processor: "one".into(),
        threads: 1,
        backends: vec!["cpu".into()],
        version: "0".into(),
    };
    let report = |factor: f64| {
        Report::new("luminaire bench".into(), &settings, machine.clone(), vec![(SECTIONS[0], Ok(section(factor)))])
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bench.json");
    std::fs::write(&file, report(1.0).json()).unwrap();
    let baseline = Baseline::read(&file).unwrap();
    let verdicts = |now: &Report| baseline.changes(now).iter().map(|change| change.verdict).collect::<Vec<_>>();
    assert!(baseline.warnings(&report(1.0)).is_empty());
    assert_eq!(verdicts(&report(1.0)), [Verdict::Same, Verdict::Same, Verdict::Unknown]);
    assert_eq!(verdicts(&report(3.0))[0], Verdict::Worse);
    assert_eq!(verdicts(&report(0.3))[0], Verdict::Better);
    assert_eq!(baseline.unmatched(&report(1.0)), [vec![], Vec::<String>::new()]);
    let page = html(&report(1.0));
    check_page(&page);
    assert!(page.contains("A &lt;title&gt;") && page.contains("<code>code</code> &amp; text"), "{page}");
    // A part that failed is said on the page, and in the JSON.
    let failed = vec![(SECTIONS[0], Err(luminaire::Error::NoDevice("the device is lost".into())))];
    let failed = Report::new("luminaire bench".into(), &settings, machine.clone(), failed);
    assert!(html(&failed).contains("the device is lost") && failed.json().contains("the device is lost"));
}
