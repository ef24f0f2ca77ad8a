//! Makes `src/scene/albedo_table.bin` and `brushed_table.bin` again: `cargo run --release --example albedo_table`. A minute.

use luminaire::reference::albedo::{albedo_table, brushed_table};

fn main() -> std::io::Result<()> {
    std::fs::write("src/scene/brushed_table.bin", brushed_table(128).bytes())?;
    std::fs::write("src/scene/albedo_table.bin", albedo_table(96).bytes())
}
