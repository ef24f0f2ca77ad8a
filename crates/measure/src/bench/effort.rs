//! How long the benchmark may take.

use serde::{Deserialize, Serialize};

/// How long the benchmark may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// Seconds: to see that it works.
    Quick,
    /// Minutes.
    Standard,
    /// About an hour.
    Long,
}

impl Effort {
    /// Rounds, unless the user says otherwise.
    pub fn rounds(self) -> usize {
        if self == Effort::Quick { 3 } else { 5 }
    }

    /// Width of the pictures in pixels, unless the user says otherwise.
    pub fn width(self) -> u32 {
        match self {
            Effort::Quick => 64,
            Effort::Standard => 128,
            Effort::Long => 256,
        }
    }

    /// Seconds that every contender gets in a round.
    pub fn budget_seconds(self) -> f64 {
        match self {
            Effort::Quick => 0.15,
            Effort::Standard => 1.2,
            Effort::Long => 10.0,
        }
    }

    /// Seconds for the reference of a scene: enough that its own error is well below those that are measured.
    pub fn reference_seconds(self) -> f64 {
        match self {
            Effort::Quick => 1.0,
            Effort::Standard => 20.0,
            Effort::Long => 200.0,
        }
    }
}
