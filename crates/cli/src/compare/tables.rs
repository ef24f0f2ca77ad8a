//! The tables of `luminaire compare`.

use super::flip::{Exposures, Flip};
use crate::shared::table::table;
use luminaire::film::REL_MSE;
use luminaire::picture::Picture;
use luminaire_measure::metrics::{Comparison, ErrorSource};
use std::path::Path;

/// A picture and its file.
pub struct Source<'a> {
    /// The file.
    pub path: &'a Path,
    /// What it holds.
    pub picture: &'a Picture,
}

/// The pictures, the measures of their difference, and the worst pixels.
pub fn describe(image: Source, reference: Source, comparison: &Comparison, flip: Option<&Flip>) -> String {
    let about = |name: &str, Source { path, picture }: Source| {
        let kind = if picture.clamped { "whole numbers, decoded as sRGB" } else { "floats" };
        let errors = if picture.error.is_some() { ", standard errors" } else { "" };
        let size = format!("{} x {} pixels, {kind}{errors}", picture.width, picture.height);
        vec![name.into(), path.display().to_string(), size]
    };
    let mut text = table(0, &[about("image", image), about("reference", reference)]) + "\n";

    let expected = comparison.expected_rmse.map_or(String::new(), |expected| {
        format!("{} is expected of the standard errors of the pixels", number(expected))
    });
    let mut rows = vec![
        vec!["RMSE".into(), number(comparison.rmse), expected],
        vec!["relMSE".into(), number(comparison.relmse), format!("{REL_MSE}, {}", number(comparison.half_power_mean))],
    ];
    let source = match comparison.error_source {
        ErrorSource::Pictures => "the standard errors in the files",
        ErrorSource::Spread => "how much the differences vary over the pixels",
    };
    for (i, (channel, bias)) in ["red", "green", "blue"].iter().zip(comparison.bias).enumerate() {
        let source = if i == 0 { format!(", from {source}") } else { String::new() };
        rows.push(vec![
            format!("bias {channel}"),
            format!("{:+.3}%", 100.0 * bias.ratio),
            format!("{} +- {}{source}", signed(bias.difference), number(bias.error)),
        ]);
    }
    if let Some(flip) = flip {
        let Exposures { first, last } = flip.exposures;
        let how = match flip.count {
            1 => format!("as PNGs of exposure {first}"),
            count => format!("over {count} exposures from {first:+.1} to {last:+.1} stops"),
        };
        rows.push(vec!["FLIP".into(), number(flip.mean), format!("{how}; largest {:.3}", flip.largest)]);
    }
    text += &table(0, &rows);

    if !comparison.worst.is_empty() {
        let three = |rgb: [f32; 3]| rgb.map(|v| number(f64::from(v))).join(" ");
        let mut rows = vec![["x y", "image", "reference", "part of relMSE"].map(String::from).to_vec()];
        rows.extend(comparison.worst.iter().map(|pixel| {
            let place = format!("{} {}", pixel.x, pixel.y);
            vec![place, three(pixel.image), three(pixel.reference), format!("{}%", number(100.0 * pixel.share))]
        }));
        text += &format!("\nworst pixels\n{}", table(2, &rows));
    }
    text
}

/// Four digits, with an exponent where there would be many zeros.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-4..1e6).contains(&size) => format!("{value:.3e}"),
        size => format!("{value:.*}", (3 - size.log10().floor() as i32).max(0) as usize),
    }
}

fn signed(value: f64) -> String {
    format!("{}{}", if value < 0.0 { "" } else { "+" }, number(value))
}
