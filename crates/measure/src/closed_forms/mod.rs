//! Closed forms and published cases against every backend, in one table.
//!
//! A case is a scene of which a mean is known: by a formula, or by quadrature of one. Two kinds of answers are compared with it:
//!
//! - what chance estimates: `z`, the deviation over the standard error, and for all cases and backends together the probability that a right
//!   program gives a largest `z` at least as far off (Sidak). Every case and backend has its own random numbers, so that this is exact;
//! - what chance does not enter: the relative deviation, against a bound on the rounding.
//!
//! "CIE 171" is CIE 171:2006, "Test Cases to Assess the Accuracy of Lighting Computer Programs": those of its analytical cases (5.2 to 5.11) that need no
//! measured luminaire. Their formulas are computed here, not copied from the report's tables, of which some are wrong (I. Ashdown, "CIE 171:2006 -
//! Errata": tables of 5.7, 5.8 and others).
//!
//! Where curved shapes are made of triangles, the expectation is that of the triangles, unless a case has a `slack`.

mod case;
mod daylight;
mod dielectrics;
mod directed;
mod form_factors;
pub mod formulas;
mod lens;
mod luminaires;
mod measure;
mod rooms;
mod table;
mod views;

pub use case::{Case, Measured, View};
pub use measure::measure;
pub use table::{Row, Table, Verdict};
pub use views::SIDE;

/// Every case, in the order of the table.
pub fn cases() -> Vec<Case> {
    [
        luminaires::cases(),
        directed::cases(),
        form_factors::cases(),
        rooms::cases(),
        daylight::cases(),
        dielectrics::cases(),
        lens::cases(),
    ]
    .concat()
}
