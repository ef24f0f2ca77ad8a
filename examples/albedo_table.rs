//! Makes `src/scene/albedo_table.bin` again: `cargo run --release --example albedo_table`. Half a minute.

fn main() -> std::io::Result<()> {
    let table = luminaire::reference::albedo::albedo_table(96);
    std::fs::write("src/scene/albedo_table.bin", table.bytes())
}
