//! Comma-separated values.

use std::borrow::Cow;

/// A text as one field: in quotes where it has a comma, a quote or a line break.
pub fn field(text: &str) -> Cow<'_, str> {
    match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")).into(),
        false => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_stay_one_field() {
        assert_eq!(["a b", "a,b", "a\"b", "a\nb"].map(field), ["a b", "\"a,b\"", "\"a\"\"b\"", "\"a\nb\""]);
    }
}
