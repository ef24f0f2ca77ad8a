//! The parts of a report that a user asks for by name.

use luminaire::{Error, Result};

/// Those of `all` that have these names, in the order of `all`; all of them for no name. `kind` is what a part is called: `sweep`.
///
/// # Errors
/// [`Error::Usage`] for a name that no part has; it lists those there are.
pub fn named<T: Copy>(kind: &str, all: &[T], name_of: fn(&T) -> &'static str, names: &[String]) -> Result<Vec<T>> {
    if let Some(unknown) = names.iter().find(|name| all.iter().all(|part| name_of(part) != **name)) {
        let known: Vec<_> = all.iter().map(name_of).collect();
        return Err(Error::Usage(format!("there is no {kind} `{unknown}`; there are: {}", known.join(", "))));
    }
    let wanted = |part: &&T| names.is_empty() || names.iter().any(|name| name == name_of(part));
    Ok(all.iter().filter(wanted).copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_chosen_in_their_own_order() {
        let choose = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| name.to_string()).collect();
            named("letter", &["a", "b", "c"], |name| name, &names)
        };
        assert_eq!(choose(&[]).unwrap(), ["a", "b", "c"]);
        assert_eq!(choose(&["c", "a", "c"]).unwrap(), ["a", "c"]);
        let error = choose(&["a", "d"]).unwrap_err();
        assert!(error.to_string().contains("there is no letter `d`; there are: a, b, c"), "{error}");
        assert_eq!(error.exit_code(), 2);
    }
}
