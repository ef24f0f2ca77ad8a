//! What the reports of this crate are written with: numbers in words, tables, Markdown, HTML, CSV, and parts chosen by their names.

pub mod choice;
pub mod csv;
pub mod html;
pub mod markdown;
pub mod table;
pub mod words;
