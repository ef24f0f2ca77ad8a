//! White furnaces over a grid.

use crate::tables::Folder;
use crate::{Effort, Texts};
use luminaire_measure::Workbench;
use luminaire_measure::furnaces::{Furnace, KINDS, ROUGHNESSES, measure as balls, white_metal};
use luminaire_measure::report::table as report;
use luminaire_measure::report::words::{deviation, with_error};
use std::error::Error;

/// Samples for each of 16 pixels of a ball.
const SAMPLES: u32 = 4096;
/// How far a white metal may be from white.
const WITHIN: f64 = 5e-3;

/// Measures the grid; the page has the largest deviation of each row, a table all of them.
pub fn measure(bench: &Workbench, effort: Effort, tables: &Folder, texts: &mut Texts) -> Result<(), Box<dyn Error>> {
    eprintln!("white furnaces");
    let samples = effort.of([64, SAMPLES, 10 * SAMPLES]);
    let all = balls(bench, samples)?;
    let backends = bench.backends();
    let names = || backends.iter().map(|backend| backend.to_string());
    let number = |number: f32| number.to_string();
    let columns = ["metallic", "transmission", "roughness"].map(String::from).into_iter().chain(names());
    let cells = |ball: &Furnace| {
        let what = [ball.metallic, ball.transmission, ball.roughness].map(number);
        what.into_iter().chain(ball.found.iter().map(|found| with_error(*found))).collect::<Vec<_>>()
    };
    tables.save("furnaces", &report::Table::new(columns).with_rows(all.iter().map(cells)))?;
    let columns = ["metallic", "transmission"].map(String::from).into_iter().chain(names());
    let row = |(kind, balls): (&[f32; 2], &[Furnace])| {
        let farthest = |backend: usize| {
            let off = |ball: &&Furnace| (ball.found[backend].mean - 1.0).abs();
            let ball = balls.iter().max_by(|a, b| off(a).total_cmp(&off(b))).expect("a row of balls");
            format!(
                "{} (roughness {})",
                deviation(ball.found[backend].mean - 1.0, ball.found[backend].error),
                ball.roughness
            )
        };
        kind.map(number).into_iter().chain((0..backends.len()).map(farthest)).collect::<Vec<_>>()
    };
    let rows = KINDS.iter().zip(all.chunks(ROUGHNESSES.len())).map(row);
    texts.insert("furnaces", report::Table::new(columns).with_rows(rows).markdown());
    let metals = white_metal(bench, 16 * samples)?;
    let holds = metals.iter().all(|metal| (metal.found - 1.0).abs() <= WITHIN);
    let each = metals.iter().map(|metal| {
        let off = format!("{:+.2} %", 100.0 * (metal.found - 1.0));
        format!("{} {off} (roughness {}, {} degrees)", metal.backend, metal.roughness, metal.degrees)
    });
    let promise = if holds { "within 0.5 % of 1 everywhere" } else { "**not within 0.5 % of 1**" };
    texts.insert("furnaces-metal", format!("{promise}; farthest: {}", each.collect::<Vec<_>>().join(", ")));
    texts.insert("furnaces-samples", (16 * samples).to_string());
    Ok(())
}
