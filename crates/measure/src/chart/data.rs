//! Charts as data: what is measured, line by line.

use super::axis::Axis;

/// A measured value.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Point {
    /// Where on the horizontal axis.
    pub x: f64,
    /// The value; NaN where the method gave none.
    pub y: f64,
    /// Its standard error, where it has one.
    pub error: Option<f64>,
}

/// The values of one method.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Series {
    /// Name of the method, as the legend and the CSV have it.
    pub name: String,
    /// In ascending order of `x`.
    pub points: Vec<Point>,
}

/// Lines of several methods over one quantity. Where all names are of the form `A on B`, the colour says A, and marker and width
/// say B.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Chart {
    /// Part of the file's name: lower-case words with hyphens.
    pub name: String,
    /// Heading.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// The lines.
    pub series: Vec<Series>,
}

/// The series of this name is the Pareto front of the others: drawn as a dashed line below them, with a ring around each of its points.
pub const FRONT: &str = "Pareto front";
