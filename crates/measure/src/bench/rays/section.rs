//! The section about rays alone as tables, charts and sentences: what every intersector took.

use super::break_even::{BreakEven, Cost};
use super::intersectors::{Family, Intersector, Measured, Plan, measure};
use super::kinds::Kind;
use crate::bench::definition::Definition;
use crate::bench::figure::{Better, Figure};
use crate::bench::figure_name::FigureName;
use crate::bench::power_law::with_exponents;
use crate::bench::rounds::Rounds;
use crate::bench::section::Section;
use crate::chart::{Axis, Chart, Series};
use crate::report::table::Table;
use crate::report::words::{capital, number};
use luminaire::backend::Backend;

/// The section about rays alone: ray query against compute BVH by the kind of the rays and the size of the room, with the reference beside them.
pub(in crate::bench) const DEFINITION: Definition = Definition {
    name: "rays",
    title: "Rays alone: ray query against compute BVH",
    scenes: false,
    run: |bench, settings, progress| {
        let plan = Plan::new(bench, settings);
        Ok(section(&plan, &measure(bench, &plan, progress)?))
    },
};

/// The section of what was measured by a plan.
pub fn section(plan: &Plan, rooms: &[Measured]) -> Section {
    let mut charts = Vec::new();
    for family in [Family::Triangles, Family::Instances] {
        let of_family: Vec<&Measured> = rooms.iter().filter(|room| room.family == family).collect();
        if !of_family.is_empty() {
            charts.extend(family_charts(plan, family, &of_family));
        }
    }
    let mut text = how(plan, rooms);
    text.extend(findings(rooms));
    let tables = vec![rate_table(rooms), build_table(rooms), break_even_table(rooms)];
    Section {
        name: DEFINITION.name,
        title: DEFINITION.title.into(),
        text,
        tables: tables.into_iter().filter(|table| !table.rows.is_empty()).collect(),
        charts,
        figures: rooms.iter().flat_map(figures).collect(),
    }
}

fn how(plan: &Plan, rooms: &[Measured]) -> Vec<String> {
    let rays = rooms.first().map_or(0, |room| room.rays);
    let mut text = vec![
        format!(
            "A room is traced by every intersector with the same {rays} rays of each kind, and with nothing else: no shading, no random numbers. \
             Camera rays start at the eye, pixel by pixel in squares of 8 by 8; bounce rays where those hit, cosine-distributed; second-bounce rays \
             where the bounce rays hit; shadow rays go from the first of these places that faces the lamp to a point on it, and any hit ends them. \
             The reference makes them all before anything is timed. Rooms of one mesh hold 27 bumpy balls between bumpy walls, the same shape in ever more \
             triangles; rooms of instances hold balls of 972 triangles, which are the smaller the more there are, in a cube in a room of twelve \
             triangles. No ray escapes."
        ),
        format!(
            "Every timing is of the rays traced over and over for about {} s, by the device's clock where it has one; the intersectors take \
             turns, {} rounds of them, after a warm-up that also compiles. Tables have the median and (least to most); bars in the charts are two \
             standard errors. What so few rays touch may stay in a cache: large rooms look better here than in a picture. Building is the time from the scene in memory to its first ray, upload included, without the compilation of \
             kernels.",
            plan.seconds, plan.rounds
        ),
    ];
    for backend in plan.backends.iter().filter(|b| **b != Backend::Cpu) {
        let here = rooms.iter().filter_map(|room| Some((room.rays, room.by(*backend)?)));
        let (all, off) = here.fold((0, 0), |(all, off), (rays, i)| {
            (all + rays * Kind::ALL.len(), off + i.mismatches.iter().sum::<usize>())
        });
        text.push(format!(
            "Rays that meet something else on {backend} than in the reference (a distance that differs by more than 1e-4, or nothing): {off} of \
             {all}. At more than 1 in 1000 nothing would be timed."
        ));
    }
    text.extend(rooms.iter().flat_map(|room| room.left_out.iter().cloned()));
    if !plan.backends.contains(&Backend::ComputeBvh) {
        text.push("No Vulkan device ran: the reference is alone, and there is nothing to compare.".into());
    } else if !plan.backends.contains(&Backend::RayQuery) {
        text.push("This device has no ray queries: compute BVH and the reference are alone.".into());
    }
    text
}

/// Both GPU intersectors of a room, compute BVH first.
fn pair(room: &Measured) -> Option<[&Intersector; 2]> {
    Some([room.by(Backend::ComputeBvh)?, room.by(Backend::RayQuery)?])
}

/// Rates of compute BVH over those of ray query, by kind.
fn ratios(room: &Measured) -> Option<[Rounds; 4]> {
    let [bvh, query] = pair(room)?;
    Some([0, 1, 2, 3].map(|k| bvh.rates[k].over(&query.rates[k])))
}

fn break_even(room: &Measured, kind: usize) -> Option<BreakEven> {
    let cost = |i: &Intersector| Cost { build: i.build.median(), ray: 1e-6 / i.rates[kind].median() };
    let [bvh, query] = pair(room)?;
    Some(BreakEven::of(cost(bvh), cost(query)))
}

/// The sentences about ray query against compute BVH.
fn findings(rooms: &[Measured]) -> Vec<String> {
    let mut text = Vec::new();
    for (family, thing) in [(Family::Triangles, "triangles in one mesh"), (Family::Instances, "instances")] {
        let both: Vec<_> =
            rooms.iter().filter(|r| r.family == family).filter_map(|room| Some((room, ratios(room)?))).collect();
        let (Some((small, first)), Some((large, last))) = (both.first(), both.last()) else { continue };
        let of_kinds = |ratios: &[Rounds; 4]| {
            let words =
                Kind::ALL.iter().zip(ratios).map(|(kind, r)| format!("{} ({})", number(r.median()), kind.words()));
            words.collect::<Vec<_>>().join(", ")
        };
        text.push(format!(
            "How many times as many rays a second compute BVH traces as ray query, by the number of {thing}: {} at {}; {} at {}.",
            of_kinds(first),
            small.count,
            of_kinds(last),
            large.count
        ));
        let bounce = Kind::Bounce as usize;
        let verdicts: Vec<_> = both.iter().filter_map(|(room, _)| Some((room, break_even(room, bounce)?))).collect();
        let always = |which: BreakEven| verdicts.iter().all(|(_, verdict)| *verdict == which);
        text.push(if always(BreakEven::First) {
            format!("Building and tracing bounce rays together, ray query never catches up here, whatever the number of {thing} and of rays.")
        } else if always(BreakEven::Second) {
            format!("Building and tracing bounce rays together, compute BVH never catches up here, whatever the number of {thing} and of rays.")
        } else {
            let each = verdicts.iter().map(|(room, verdict)| {
                let words = verdict.words("compute BVH", "ray query");
                format!("{words} at {}", room.count)
            });
            format!(
                "Building and tracing bounce rays together, this one is done first, by the number of {thing}: {}.",
                each.collect::<Vec<_>>().join("; ")
            )
        });
    }
    text
}

/// A family's part of names, of titles, and its axis.
fn words_of(family: Family) -> (&'static str, &'static str, &'static str) {
    match family {
        Family::Triangles => ("triangles", "over the triangles of one mesh", "triangles"),
        Family::Instances => ("instances", "over instances of 972 triangles", "instances"),
    }
}

fn family_charts(plan: &Plan, family: Family, rooms: &[&Measured]) -> Vec<Chart> {
    let (name, title, x) = words_of(family);
    // A line for every backend, over the rooms where it ran.
    let lines = |value: &dyn Fn(&Intersector) -> Option<Rounds>| -> Vec<Series> {
        let line = |backend: &Backend| {
            let point = |room: &&Measured| Some(value(room.by(*backend)?)?.point(room.count as f64));
            Series { name: backend.to_string(), points: rooms.iter().filter_map(point).collect() }
        };
        plan.backends.iter().map(line).filter(|series| !series.points.is_empty()).collect()
    };
    let chart = |part: &str, title: String, y: &str, series: Vec<Series>| Chart {
        name: format!("{name}-{part}"),
        title,
        x: Axis::log(x),
        y: Axis::log(y),
        series,
    };
    let mut charts = Vec::new();
    for (k, kind) in Kind::ALL.into_iter().enumerate() {
        let series = lines(&|i| Some(i.rates[k].clone()));
        charts.push(chart(
            kind.name(),
            format!("{} rays a second {title}", capital(kind.words())),
            "million rays a second",
            series,
        ));
    }
    let ratio = |(k, kind): (usize, Kind)| {
        let point = |room: &&Measured| Some(ratios(room)?[k].point(room.count as f64));
        Series { name: kind.words().into(), points: rooms.iter().filter_map(point).collect() }
    };
    let series: Vec<Series> = Kind::ALL.into_iter().enumerate().map(ratio).collect();
    if series.iter().any(|s| !s.points.is_empty()) {
        let title = format!("Compute BVH against ray query {title}: above 1 compute BVH is faster");
        charts.push(chart("ratio", title, "rays a second of compute BVH / those of ray query", series));
    }
    let bounce = Kind::Bounce as usize;
    let cost = with_exponents(lines(&|i| Some(i.rates[bounce].map(|rate| 1e3 / rate))));
    charts.push(chart(
        "cost",
        format!("What a bounce ray costs {title}, with the exponent of growth"),
        "ns a ray",
        cost,
    ));
    let series = with_exponents(lines(&|i| Some(i.build.clone())));
    charts.push(chart(
        "build",
        format!("Building and uploading {title}, with the exponent of growth"),
        "seconds",
        series,
    ));
    charts
}

/// Every intersector of every room.
fn everyone(rooms: &[Measured]) -> impl Iterator<Item = (&Measured, &Intersector)> {
    rooms.iter().flat_map(|room| room.intersectors.iter().map(move |i| (room, i)))
}

fn rate_table(rooms: &[Measured]) -> Table {
    let row = |(room, i): (&Measured, &Intersector)| {
        let mut row = vec![room.room.clone(), room.count.to_string(), i.backend.to_string()];
        row.extend(i.rates.iter().map(|rate| rate.spread().to_string()));
        row
    };
    let mut columns = ["room", "triangles or instances", "intersector"].map(String::from).to_vec();
    columns.extend(Kind::ALL.iter().map(|kind| format!("{}, Mrays/s", kind.words())));
    Table::new(columns).with_rows(everyone(rooms).map(row))
}

fn build_table(rooms: &[Measured]) -> Table {
    let row = |(room, i): (&Measured, &Intersector)| {
        let host = match i.backend {
            Backend::ComputeBvh => format!("{} building the BVH", number(i.host.median())),
            Backend::RayQuery => format!("{} sorting", number(i.host.median())),
            Backend::Cpu => "all".into(),
        };
        let bytes = |scale: f64| i.bytes.map_or("-".into(), |bytes| number(bytes as f64 / scale));
        vec![
            room.room.clone(),
            i.backend.to_string(),
            i.build.spread().to_string(),
            host,
            bytes(f64::from(1 << 20)),
            bytes(room.count as f64),
        ]
    };
    let columns = [
        "room",
        "intersector",
        "build, s",
        "of that on the host, s",
        "device memory, MiB",
        "bytes a triangle or instance",
    ];
    Table::new(columns).with_rows(everyone(rooms).map(row))
}

/// Which of the two GPU intersectors is done first.
fn break_even_table(rooms: &[Measured]) -> Table {
    let row = |room: &Measured| {
        let verdict = |kind: usize| Some(break_even(room, kind)?.words("compute BVH", "ray query"));
        let verdicts: Option<Vec<String>> = (0..Kind::ALL.len()).map(verdict).collect();
        Some(std::iter::once(room.room.clone()).chain(verdicts?).collect())
    };
    let mut columns = vec!["done first, building and tracing together".to_owned()];
    columns.extend(Kind::ALL.iter().map(|kind| format!("{} rays", kind.words())));
    Table::new(columns).with_rows(rooms.iter().filter_map(row))
}

fn figures(room: &Measured) -> Vec<Figure> {
    let mut figures = Vec::new();
    for i in &room.intersectors {
        let of = format!("{}/{}", room.room, i.backend);
        let mut add = |quantity: &str, unit: &str, better: Better, values: &[f64]| {
            let name = FigureName { section: DEFINITION.name, of: &of, quantity };
            figures.extend(Figure::of(name.to_string(), unit, better, values));
        };
        for (kind, rate) in Kind::ALL.into_iter().zip(&i.rates) {
            add(kind.name(), "Mrays/s", Better::Higher, &rate.0);
        }
        add("build", "s", Better::Lower, &i.build.0);
        if let Some(bytes) = i.bytes {
            let thing = if room.family == Family::Triangles { "triangle" } else { "instance" };
            add(&format!("bytes-per-{thing}"), "bytes", Better::Lower, &[bytes as f64 / room.count as f64]);
        }
    }
    figures
}
