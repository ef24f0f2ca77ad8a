//! What several subcommands share: options, their values, and what they print.

pub mod backend_name;
pub mod camera;
pub mod counts;
pub mod error_line;
pub mod estimator;
pub mod exit_codes;
pub mod film_size;
pub mod foreseen;
pub mod interrupts;
pub mod outputs;
pub mod printing;
pub mod relative_path;
pub mod scene_options;
pub mod table;
pub mod tone_name;
pub mod units;
pub mod values;
