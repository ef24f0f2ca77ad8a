//! The benchmark of rays, on tiny rooms: that it times the right thing, and says what it timed.

#[path = "../../../tests/common/mod.rs"]
mod common;

use common::bench;
use luminaire::backend::Backend;
use luminaire::gpu::validation_messages;
use luminaire::reference::Reference;
use luminaire_measure::Workbench;
use luminaire_measure::bench::power_law::PowerLaw;
use luminaire_measure::bench::rays::kinds::{Kind, RaySet};
use luminaire_measure::bench::rays::{self, intersectors};
use luminaire_measure::bench::{Better, Section, growth, meshes};
use std::collections::HashSet;

fn ray_plan(backends: Vec<Backend>) -> intersectors::Plan {
    intersectors::Plan {
        backends,
        triangles: vec![1000, 3000],
        instances: vec![1, 30],
        side: 32,
        rounds: 3,
        seconds: 0.002,
    }
}

fn growth_plan(backends: Vec<Backend>) -> growth::Plan {
    growth::Plan {
        backends,
        luminaires: vec![1, 10, 40],
        sides: vec![8, 16],
        bounces: vec![0, 1, 5],
        side: 16,
        group: 1,
        rounds: 3,
        seconds: 0.002,
    }
}

/// Names, cells and numbers are what the page and the comparison of two runs need.
fn assert_sound(section: &Section) {
    let mut names = HashSet::new();
    for figure in &section.figures {
        assert!(names.insert(figure.name.clone()), "{} twice", figure.name);
        assert!(
            figure.name.starts_with(&format!("{}/", section.name)) && !figure.name.contains(' '),
            "{}",
            figure.name
        );
        let numbers = [figure.least, figure.median, figure.most];
        assert!(numbers.iter().all(|n| n.is_finite() && *n > 0.0), "{figure:?}");
        assert!(numbers.is_sorted() && figure.rounds > 0, "{figure:?}");
        assert_eq!(figure.better == Better::Higher, figure.unit == "Mrays/s", "{figure:?}");
    }
    for table in &section.tables {
        assert!(!table.rows.is_empty() && table.rows.iter().all(|row| row.len() == table.columns.len()), "{table:?}");
    }
    let charts: HashSet<&str> = section.charts.iter().map(|chart| chart.name.as_str()).collect();
    assert_eq!(charts.len(), section.charts.len());
    for chart in &section.charts {
        assert!(!chart.series.is_empty(), "{}", chart.name);
        for series in &chart.series {
            assert!(series.points.iter().all(|p| p.y.is_finite() && p.y > 0.0), "{}: {series:?}", chart.name);
            assert!(series.points.is_sorted_by(|a, b| a.x < b.x), "{}: {series:?}", chart.name);
        }
    }
    let all = section.text.join("\n");
    assert!(!all.is_empty() && !all.contains("NaN") && !all.contains("inf"), "{all}");
}

/// Figures of one intersector in one room.
fn figures(section: &Section, part: &str) -> usize {
    section.figures.iter().filter(|figure| figure.name.contains(part)).count()
}

fn check_rays(bench: &Workbench, backends: Vec<Backend>) {
    let plan = ray_plan(backends);
    let mut said = Vec::new();
    let rooms =
        intersectors::measure(bench, &plan, &mut |line| said.push(line.to_owned())).expect("the rooms are traced");
    assert_eq!(said.len(), 4);
    for room in &rooms {
        assert!(room.left_out.is_empty(), "{:?}", room.left_out);
        assert_eq!(room.intersectors.iter().map(|i| i.backend).collect::<Vec<_>>(), plan.backends);
        for i in &room.intersectors {
            println!(
                "{}, {}: {:?} Mrays/s, {:?} differ",
                room.room,
                i.backend,
                i.rates.each_ref().map(|r| r.median()),
                i.mismatches
            );
            // The driver's ray query is not ours to mend.
            assert!(i.backend == Backend::RayQuery || i.mismatches == [0; 4], "{}: {i:?}", room.room);
            assert!(i.rates.iter().all(|rates| rates.0.len() == plan.rounds));
            assert_eq!(i.bytes.is_some(), i.backend != Backend::Cpu);
            assert!(i.build.0.iter().all(|seconds| *seconds > 0.0));
        }
        // A BVH of more triangles takes more memory than the triangles alone.
        if let Some(bytes) = room.by(Backend::ComputeBvh).and_then(|i| i.bytes) {
            assert!(bytes > 48 * 972, "{bytes}");
        }
    }
    let section = rays::section(&plan, &rooms);
    assert_sound(&section);
    let gpu = plan.backends.iter().filter(|b| **b != Backend::Cpu).count();
    assert_eq!(figures(&section, "/cpu/"), 4 * 5);
    assert_eq!(section.figures.len(), 4 * (5 + 6 * gpu));
    assert_eq!(section.charts.iter().any(|chart| chart.name == "triangles-ratio"), gpu == 2);
    assert_eq!(section.text.iter().any(|t| t.contains("How many times as many rays a second")), gpu == 2);
    assert_eq!(section.text.iter().any(|t| t.contains("the reference is alone")), gpu == 0);
}

#[test]
fn every_intersector_traces_the_same_rays() {
    let bench = bench();
    check_rays(&bench, bench.backends());
    assert_eq!(validation_messages(), 0, "the validation layer complained; see above");
}

/// Where there is no device, and where it has no ray queries.
#[test]
fn fewer_intersectors_are_said() {
    let bench = bench();
    check_rays(&bench, vec![Backend::Cpu]);
    if bench.backends().contains(&Backend::ComputeBvh) {
        check_rays(&bench, vec![Backend::Cpu, Backend::ComputeBvh]);
    }
    assert_eq!(validation_messages(), 0, "the validation layer complained; see above");
}

/// A room is not the same as another: an intersector that traces in the wrong one is found out.
#[test]
fn wrong_hits_are_counted() {
    let bench = bench();
    let room = |n| {
        let mut room = meshes::one_mesh(n);
        (room.scene.film.width, room.scene.film.height) = (32, 32);
        room
    };
    let (right, wrong) = (room(1000), room(2000));
    let set = RaySet::new(&right, &Reference::new(&right.scene), 32);
    let calls: Vec<_> = set.rays.iter().flatten().map(|ray| ray.call()).collect();
    for backend in bench.backends().into_iter().filter(|b| *b != Backend::Cpu) {
        let tracer = bench.ray_tracer(&wrong.scene, backend, &calls).expect("a tracer");
        let error = intersectors::check(&right, backend, &tracer, &set).expect_err("hits of another room");
        let said = error.to_string();
        assert!(said.contains("mesh-1e3") && said.contains("camera rays") && error.exit_code() == 1, "{said}");
    }
}

/// Rays are of their kind: those of the camera start at the eye, bounces on a surface, shadow rays end at the lamp, and none escapes.
#[test]
fn rays_are_of_their_kind() {
    for mut room in [meshes::one_mesh(3000), meshes::instances(30)] {
        (room.scene.film.width, room.scene.film.height) = (64, 64);
        let set = RaySet::new(&room, &Reference::new(&room.scene), 64);
        let by = |kind: Kind| (&set.rays[kind as usize], &set.expected[kind as usize]);
        for kind in [Kind::Camera, Kind::Bounce, Kind::SecondBounce] {
            assert!(
                by(kind).1.iter().all(|t| t.is_finite() && *t > 0.0),
                "a {} ray of {} escapes",
                kind.name(),
                room.name
            );
        }
        let end = |kind: Kind, i: usize| {
            let (rays, t) = by(kind);
            rays[i].origin.as_dvec3() + t[i] * rays[i].direction.as_dvec3()
        };
        let [corner, a, b] = room.lamp;
        let mut up = 0;
        for i in 0..set.len() {
            assert_eq!(by(Kind::Camera).0[i].origin, room.scene.sensor.position);
            for (kind, before) in [(Kind::Bounce, Kind::Camera), (Kind::SecondBounce, Kind::Bounce)] {
                let off = by(kind).0[i].origin.as_dvec3().distance(end(before, i));
                assert!(off < 2e-5, "{} ray {i} starts {off} off", kind.name());
            }
            let shadow = by(Kind::Shadow).0[i];
            let target = shadow.origin + shadow.direction - corner;
            assert!((-1e-5..=a.x + 1e-5).contains(&target.x) && (-1e-5..=b.z + 1e-5).contains(&target.z), "{target}");
            assert!((target.y + 1e-3).abs() < 1e-5 && shadow.t_max == 1.0);
            up += usize::from(shadow.direction.y > 0.0);
        }
        // A ray that left its surface on the wrong side would meet it at once.
        for kind in [Kind::Bounce, Kind::SecondBounce] {
            let at_once = by(kind).1.iter().filter(|t| **t < 1e-4).count();
            assert!(at_once * 100 < set.len(), "{at_once} of {} {} rays go nowhere", set.len(), kind.name());
        }
        // The lamp shines down.
        assert_eq!(up, set.len());
        let lit = by(Kind::Shadow).1.iter().filter(|blocked| **blocked == 0.0).count() as f64 / set.len() as f64;
        assert!((0.05..0.95).contains(&lit), "{lit} of the shadow rays of {} are free", room.name);
    }
}

#[test]
fn the_path_tracer_s_growth_is_measured() {
    let bench = bench();
    let plan = growth_plan(bench.backends());
    let costs = growth::measure(&bench, &plan, &mut |_| {}).expect("the scenes are rendered");
    assert_eq!(costs.len(), 8 * plan.backends.len());
    for cost in &costs {
        // A ray from the camera; at most surfaces a shadow ray, and one that goes on, after the last of them only to a lamp.
        let surfaces = if cost.quantity == growth::Quantity::Bounces { cost.x } else { 3.0 };
        let rays = cost.rays_a_sample;
        assert!(rays > surfaces && rays <= 2.0 * surfaces + 1.0, "{rays} rays a sample: {cost:?}");
        let product = cost.rate().median() * cost.ray().median();
        assert!((product - 1e3).abs() < 1e-6, "{product}");
    }
    let section = growth::section(&plan, &costs);
    assert_sound(&section);
    assert_eq!(section.charts.len(), 3);
    assert!(section.charts.iter().all(|chart| chart.series.iter().all(|s| s.name.contains(": exponent "))));
    let alone = growth::Plan { backends: vec![Backend::Cpu], ..plan };
    let costs = growth::measure(&bench, &alone, &mut |_| {}).expect("the reference renders");
    assert_sound(&growth::section(&alone, &costs));
    assert_eq!(validation_messages(), 0, "the validation layer complained; see above");
}

#[test]
fn exponents_are_found() {
    let law = |points: &[(f64, f64)]| PowerLaw::fit(points.iter().copied());
    let exact: Vec<(f64, f64)> = (0..6).map(|i| 10f64.powi(i)).map(|x| (x, 3.0 * x.powf(0.75))).collect();
    let found = law(&exact).unwrap();
    assert!((found.exponent - 0.75).abs() < 1e-12 && (found.factor - 3.0).abs() < 1e-9, "{found:?}");
    assert!(found.error.unwrap() < 1e-6);
    // Off the line up and down by a factor of two: the error says so, and the truth is within it.
    let rough: Vec<_> = exact.iter().enumerate().map(|(i, (x, y))| (*x, y * [2.0, 0.5][i % 2])).collect();
    let found = law(&rough).unwrap();
    let error = found.error.unwrap();
    assert!((0.05..0.2).contains(&error) && (found.exponent - 0.75).abs() < 2.0 * error, "{found:?}");
    assert_eq!(found.to_string(), format!("{:.2} +- {error:.2}", found.exponent));
    // What has no logarithm does not count; two points have no error, one has no law.
    let some = law(&[(1.0, 2.0), (0.0, 5.0), (4.0, f64::NAN), (10.0, 20.0), (3.0, -1.0)]).unwrap();
    assert!((some.exponent - 1.0).abs() < 1e-12 && some.error.is_none());
    assert_eq!(some.to_string(), "1.00");
    assert!(law(&[(2.0, 1.0), (2.0, 3.0)]).is_none() && law(&[]).is_none());
    assert_eq!(law(&[(1.0, 1.0), (10.0, 0.9999)]).unwrap().to_string(), "0.00");
}
