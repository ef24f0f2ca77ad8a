//! The map of CONTRIBUTING.md, held against the code's own imports: an arrow that the map does not have fails, one that the code does not
//! have fails, and so does a circle of files.

mod imports;
mod pages;

use imports::House;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A row of the map: what lies at a path, and on what it stands.
struct Room {
    path: String,
    /// As other rows name it: `scene` for `src/scene/`, `crates/view` for `crates/view/src/`, `error` for `src/error.rs`.
    name: String,
    stands_on: BTreeSet<String>,
}

/// The rooms of the table in CONTRIBUTING.md: rows of `| path | what | stands on |`, paths in backticks.
fn rooms(root: &Path) -> Vec<Room> {
    let text = std::fs::read_to_string(root.join("CONTRIBUTING.md")).expect("the map");
    let quoted = |cell: &str| -> Vec<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let mut rooms = Vec::new();
    for line in text.lines().filter(|line| line.starts_with("| `src/") || line.starts_with("| `crates/")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').collect();
        let [paths, _, stands_on] = cells[..] else { panic!("a row of the map has not three cells: {line}") };
        for path in quoted(paths) {
            let name = path.trim_end_matches(".rs").trim_end_matches('/').trim_end_matches("/src");
            let name = name.strip_prefix("src/").unwrap_or(name).to_owned();
            rooms.push(Room { path, name, stands_on: quoted(stands_on).into_iter().collect() });
        }
    }
    assert!(rooms.len() > 8, "the table of CONTRIBUTING.md has only {} rooms", rooms.len());
    rooms
}

/// Rooms that share the longest beginning with a file's path.
fn room_of<'a>(rooms: &'a [Room], file: &str) -> Option<&'a Room> {
    rooms.iter().filter(|room| file.starts_with(&room.path)).max_by_key(|room| room.path.len())
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_map_has_every_arrow_and_no_other() {
    let (house, rooms) = (House::new(&root()), rooms(&root()));
    let mut wrong = Vec::new();
    let mut used: BTreeSet<(&str, &str)> = BTreeSet::new();
    for (file, arrows) in house.files.iter().zip(house.arrows()) {
        let Some(room) = room_of(&rooms, &file.path) else {
            wrong.push(format!("{} lies in no room of the map", file.path));
            continue;
        };
        for to in arrows.into_iter().map(|to| &house.files[to].path) {
            let Some(other) = room_of(&rooms, to).filter(|other| other.path != room.path) else { continue };
            // `src` is the whole library.
            let named =
                room.stands_on.iter().find(|on| **on == other.name || *on == "src" && other.path.starts_with("src/"));
            match named {
                Some(named) => drop(used.insert((&room.path, named))),
                None => wrong.push(format!(
                    "{} imports from {to}, but {} does not stand on {}",
                    file.path, room.name, other.name
                )),
            }
        }
    }
    for room in &rooms {
        assert!(root().join(&room.path).exists(), "the map names {}, which is not there", room.path);
        let unused = room.stands_on.iter().filter(|on| !used.contains(&(room.path.as_str(), on.as_str())));
        wrong.extend(
            unused.map(|on| format!("the map says that {} stands on {on}, but nothing there imports it", room.path)),
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_files_import_each_other() {
    let house = House::new(&root());
    let arrows = house.arrows();
    let reaches = |from: usize| {
        let mut seen = BTreeSet::new();
        let mut open: Vec<usize> = arrows[from].iter().copied().collect();
        while let Some(next) = open.pop() {
            if seen.insert(next) {
                open.extend(&arrows[next]);
            }
        }
        seen
    };
    let reached: Vec<BTreeSet<usize>> = (0..arrows.len()).map(reaches).collect();
    let mut circles = Vec::new();
    for (from, to) in arrows.iter().enumerate().flat_map(|(from, to)| to.iter().map(move |to| (from, *to))) {
        if reached[to].contains(&from) {
            circles.push(format!("{} -> {}", house.files[from].path, house.files[to].path));
        }
    }
    assert!(circles.is_empty(), "these imports lie on circles:\n{}", circles.join("\n"));
}
