//! Suggestions for an unknown key: where else in a case a key of its name belongs.

use super::declaration::{Entry, Key, Kinds, Presence, Type};
use super::layout;
use super::values::join;

/// Most places that are named.
const MOST: usize = 4;

/// Tables within tables that are looked into.
const DEEPEST: usize = 5;

/// Words for keys that other programs, and people, use in their place.
const SYNONYMS: &[(&str, &str)] = &[
    ("force", "load"),
    ("forces", "load"),
    ("couple", "load"),
    ("moment", "couple"),
    ("torque", "couple"),
    ("distributed-load", "load"),
    ("station", "on"),
    ("stations", "on"),
    ("location", "on"),
    ("frame", "axes"),
    ("anchor", "to"),
    ("mass-proportional", "mass"),
    ("stiffness-proportional", "stiffness"),
    ("mass-damping", "damping"),
    ("stiffness-damping", "damping"),
    ("acceleration", "gravity"),
    ("rigid-body", "body"),
    ("constraint", "joint"),
    ("obstacles", "contact"),
    ("strain-gauge", "fibre"),
];

/// The key among `keys` for which `name` is another word.
pub(super) fn synonym<'k>(name: &str, keys: impl Iterator<Item = &'k str>) -> Option<&'k str> {
    let meant: Vec<&str> = SYNONYMS
        .iter()
        .filter(|(word, _)| word.chars().eq(name.chars().map(dash)))
        .map(|(_, key)| *key)
        .collect();
    let mut keys = keys;
    keys.find(|key| meant.contains(key))
}

/// What to write instead of `name`, a key that does not belong in the table `path`: the places at which a key of this
/// name does.
pub(super) fn advice(name: &str, path: &str) -> Option<String> {
    let mut places = Vec::new();
    search(name, layout::keys(), "", 0, &mut places);
    if places.is_empty() {
        search(name, layout::spatial_keys(), "", 0, &mut places);
    }
    places.retain(|place| *place != join(path, name));
    places.dedup();
    if places.is_empty() || places.len() > MOST {
        return None;
    }
    let places: Vec<String> = places.iter().map(|place| format!("`{place}`")).collect();
    Some(format!("perhaps {} is meant", places.join(" or ")))
}

/// Collects the dotted paths of the keys that are called `name`, or whose whole path is `name` with other dashes.
fn search(name: &str, keys: &[Key], path: &str, depth: usize, places: &mut Vec<String>) {
    if depth > DEEPEST {
        return;
    }
    for key in keys {
        let place = join(path, key.name);
        let same = || place.chars().map(dash).eq(name.chars().map(dash));
        if (key.name == name || (!path.is_empty() && same())) && !places.contains(&place) {
            places.push(place.clone());
        }
        match &key.takes {
            Type::Table(keys) | Type::Tables(keys) => search(name, keys, &place, depth + 1, places),
            Type::Kind(choice) => {
                for kind in choice.kinds() {
                    search(name, kind.keys, &place, depth + 1, places);
                }
            }
            _ => {}
        }
    }
}

/// Dots, dashes and underscores are all written between words.
fn dash(c: char) -> char {
    if matches!(c, '.' | '-' | '_' | ' ') { '-' } else { c.to_ascii_lowercase() }
}

/// What to write instead of a kind that was chosen on the command line, where a key of the file belongs to the kind before.
pub(super) fn replacement(choice: &dyn Kinds, kind: Entry, path: &str, of: &str) -> String {
    let mut table = format!("kind='{}'", kind.name);
    for key in kind.keys.iter().filter(|key| key.presence == Presence::Required) {
        table += &format!(", {}=…", key.name);
    }
    format!(
        "`{}` was chosen on the command line, and `{of}` in the file belongs to another {}: replace the whole table, \
         `--set \"{path}={{{table}}}\"`",
        kind.name,
        choice.name()
    )
}
