//! A chart as CSV.

use super::data::{Chart, Point};
use crate::report::csv::field;

/// The first line of a CSV of charts.
pub const CSV_HEADER: &str = "chart,method,x,y,error\n";

impl Chart {
    /// The points as lines of CSV under [`CSV_HEADER`], with every digit of the numbers; `NaN` where a method gave none, and no
    /// error where it has none.
    pub fn csv(&self) -> String {
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
