//! Charts as drawings and as numbers.

#[path = "documents/svg.rs"]
mod svg;

use luminaire_measure::chart::{Axis, Chart, Point, Series};
use svg::texts;

fn point(x: f64, y: f64, error: Option<f64>) -> Point {
    Point { x, y, error }
}

fn chart(y: Axis, series: &[(&str, &[Point])]) -> Chart {
    let series = series.iter().map(|(name, points)| Series { name: (*name).into(), points: points.to_vec() }).collect();
    Chart { name: "one".into(), title: "A title".into(), x: Axis::log("samples"), y, series }
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
