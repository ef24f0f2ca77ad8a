//! A run as a page: HTML that needs nothing else, and Markdown for a repository.

use super::definition::Outcome;
use super::report::Report;
use super::section::Section;
use crate::chart::Chart;
use crate::report::html::{escaped, marked};
use crate::report::markdown::image;
use crate::report::table::Table;
use crate::report::words::bytes;

/// Light and dark after the reader's system; the charts stay on white.
const STYLE: &str = "\
:root { color-scheme: light dark; --ink: #1c1c1e; --ground: #ffffff; --line: #d4d4d8; --band: #f4f4f5; --quiet: #52525b }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e4e7; --ground: #18181b; --line: #3f3f46; --band: #27272a; --quiet: #a1a1aa } }
body { margin: 2rem auto; max-width: 100rem; padding: 0 1.5rem; font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--ground) }
p, ul { max-width: 60rem }
h2 { margin-top: 3rem; border-top: 1px solid var(--line); padding-top: 1rem }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .2rem 1.5rem; max-width: 60rem } dt { color: var(--quiet) } dd { margin: 0 }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(34rem, 100%), 1fr)); gap: 1rem; margin: 1.5rem 0 }
.charts svg { width: 100%; height: auto; background: #fff; border: 1px solid var(--line); border-radius: 6px }
.table { overflow-x: auto; margin: 1rem 0 }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums } th, td { padding: .25rem .7rem; text-align: left; white-space: nowrap }
th { border-bottom: 2px solid var(--line); white-space: normal } tbody tr:nth-child(even) { background: var(--band) }
code { background: var(--band); padding: .1rem .3rem; border-radius: 3px } .failed { color: #d00 }
";

/// What the page is and where it was measured, as names and values.
fn head(report: &Report) -> Vec<(&'static str, String)> {
    let (run, machine) = (&report.run, &report.machine);
    let scenes =
        run.scenes.iter().map(|s| format!("{} ({} x {}, {} triangles)", s.name, s.width, s.height, s.triangles));
    let mut rows = vec![
        ("Command", format!("`{}`", run.command)),
        ("Vulkan device", machine.device.clone()),
        ("Processor", format!("{}, {} threads", machine.processor, machine.threads)),
        ("Backends", machine.backends.join(", ")),
        ("Version", format!("luminaire {}", machine.version)),
        ("Rounds", run.rounds.to_string()),
    ];
    if !run.scenes.is_empty() {
        rows.push(("Scenes", scenes.collect::<Vec<_>>().join("; ")));
    }
    rows.extend(report.peak_bytes.map(|peak| ("Memory", format!("the process held at most {}", bytes(peak as f64)))));
    rows
}

/// What a reader has to know first.
const INTRODUCTION: [&str; 2] = [
    "How fast luminaire is, and how exact after how long. `cpu` is the double-precision reference on all threads of the processor; `compute-bvh` is the Vulkan \
     kernel with luminaire's own traversal of a BVH; `ray-query` is the same kernel on the driver's ray queries. On a software device both kernels \
     run on the processor, too.",
    "Absolute times are of this machine and what else it did. What was compared took turns, so that ratios hold; a value in parentheses is the least \
     and the most of the rounds.",
];

/// A whole document: style and charts are in it, there is no script, and nothing is loaded.
pub fn html(report: &Report) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>luminaire: benchmark</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>luminaire: benchmark</h1>\n"
    );
    page += &INTRODUCTION.map(|text| format!("<p>{}</p>\n", marked(text))).concat();
    page += "<dl>\n";
    page += &head(report)
        .iter()
        .map(|(name, value)| format!("<dt>{name}</dt><dd>{}</dd>\n", marked(value)))
        .collect::<String>();
    page += "</dl>\n<ul>\n";
    let link =
        |(section, _): &Outcome| format!("<li><a href=\"#{}\">{}</a></li>\n", section.name, escaped(section.title));
    page += &report.outcomes.iter().map(link).collect::<String>();
    page += "</ul>\n";
    for (definition, outcome) in &report.outcomes {
        let title = outcome.as_ref().map_or(definition.title, |section| &section.title[..]);
        page += &format!("<h2 id=\"{}\">{}</h2>\n", definition.name, escaped(title));
        match outcome {
            Ok(section) => page += &section_html(section),
            Err(error) => {
                page += &format!("<p class=\"failed\">This part failed: {}</p>\n", escaped(&error.to_string()))
            }
        }
    }
    page + "</body>\n</html>\n"
}

fn section_html(section: &Section) -> String {
    let mut text: String = section.text.iter().map(|text| format!("<p>{}</p>\n", marked(text))).collect();
    if !section.charts.is_empty() {
        let charts: String = section.charts.iter().map(inline).collect();
        text += &format!("<div class=\"charts\">\n{charts}</div>\n");
    }
    text + &section.tables.iter().map(Table::html).collect::<String>()
}

/// A chart as a part of a document, whose namespace is the document's.
fn inline(chart: &Chart) -> String {
    let svg = chart.svg().replace(" xmlns=\"http://www.w3.org/2000/svg\"", "");
    svg.replacen("<svg ", &format!("<svg role=\"img\" aria-label=\"{}\" ", escaped(&chart.title)), 1)
        .trim_end()
        .to_owned()
        + "\n"
}

/// The page as Markdown, with the charts as files in `folder`, seen from the page and without a slash at its end.
pub fn markdown(report: &Report, folder: &str) -> String {
    let mut page = format!("# Benchmark\n\n{}\n\n", INTRODUCTION.join("\n\n"));
    page += &head(report).iter().map(|(name, value)| format!("- {name}: {value}\n")).collect::<String>();
    for (definition, outcome) in &report.outcomes {
        let title = outcome.as_ref().map_or(definition.title, |section| &section.title[..]);
        page += &format!("\n## {title}\n\n");
        let section = match outcome {
            Ok(section) => section,
            Err(error) => {
                page += &format!("This part failed: {error}\n");
                continue;
            }
        };
        page += &section.text.iter().map(|text| format!("{text}\n\n")).collect::<String>();
        for chart in &section.charts {
            page += &image(&chart.title, folder, &file_name(section, chart));
        }
        let tables: Vec<String> = section.tables.iter().map(Table::markdown).collect();
        page += &tables.join("\n");
    }
    page
}

/// The file of a chart.
pub fn file_name(section: &Section, chart: &Chart) -> String {
    format!("{}-{}.svg", section.name, chart.name)
}
