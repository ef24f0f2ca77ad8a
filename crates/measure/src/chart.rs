//! Charts as data, as SVG and as CSV.

mod ruler;
mod svg;

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By powers of ten. What is not above zero is drawn on the lower edge, and counted in the CSV as it is.
    Log,
}

/// One axis of a chart.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// How it is divided.
    pub scale: Scale,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Axis { label: label.into(), scale: Scale::Linear }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Axis { label: label.into(), scale: Scale::Log }
    }
}

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

/// The first line of a CSV of charts.
pub const CSV_HEADER: &str = "chart,method,x,y,error\n";

impl Chart {
    /// The points as lines of CSV under [`CSV_HEADER`], with every digit of the numbers; `NaN` where a method gave none, and no
    /// error where it has none.
    pub fn csv(&self) -> String {
        let field = |text: &str| match text.contains([',', '"', '\n']) {
            true => format!("\"{}\"", text.replace('"', "\"\"")),
            false => text.to_owned(),
        };
        let mut rows = String::new();
        for series in &self.series {
            for Point { x, y, error } in &series.points {
                let error = error.map_or(String::new(), |error| format!("{error:?}"));
                rows += &format!("{},{},{x:?},{y:?},{error}\n", field(&self.name), field(&series.name));
            }
        }
        rows
    }
}
