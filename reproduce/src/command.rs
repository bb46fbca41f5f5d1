//! The commands by which the runs of a paper are repeated.

use crate::need::{Named, plain};

/// The command that repeats a run, and what it shows of it where that is not all.
pub fn command(run: &Named, (name, place, item): (&str, &str, &str)) -> String {
    let sets: Vec<String> =
        run.key.set.iter().map(|set| format!(" --set '{}'", set.replace('\'', "\""))).collect();
    let file = quoted(&format!("{place}/cases/{}.toml", run.key.case));
    let built_in = crate::built_in_names().iter().any(|built| built == name);
    let paper = quoted(&format!("{}/{item}", if built_in { name } else { place }));
    // Speeds in units of their own, transverse frequencies and strain energies are what no command of a case asks for.
    let within = |what: String| format!("flexion reproduce {paper}\n# {what} of {file}{}", sets.concat());
    match (&run.modes, &run.energy) {
        (Some(modes), _) if modes.transverse || modes.unit.is_some() => within(format!(
            "{} {}frequencies at the speed {}",
            modes.count,
            if modes.transverse { "transverse " } else { "" },
            plain(&modes.speed)
        )),
        (Some(modes), _) => {
            let speed = plain(&modes.speed);
            format!("flexion modes {file}{} --speed '{speed}' --count {}", sets.concat(), modes.count)
        }
        (_, Some(energy)) => {
            let kind = format!("{:?}", energy.energy).to_lowercase();
            let speed = plain(&energy.speed);
            let terms: Vec<String> = energy.terms.iter().map(|term| format!("{term:?}")).collect();
            let terms = if terms.is_empty() { String::new() } else { format!(" with {}", terms.join(", ")) };
            within(format!("frequencies by the {kind} strain energy{terms} at the speed {speed}"))
        }
        _ => format!("flexion run {file}{}", sets.concat()),
    }
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-".contains(c);
    if word.chars().all(is_plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn what_a_shell_would_part_is_quoted() {
        assert_eq!(quoted("studies/bases/T1"), "studies/bases/T1");
        assert_eq!(quoted("my paper's/cases/a.toml"), "'my paper'\\''s/cases/a.toml'");
    }
}
