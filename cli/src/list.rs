//! `flexion list`: every kind with one line and its source.

use crate::{Outcome, screen};
use flexion_case::declaration::{Bound, Entry, Key, Kinds, Presence, Type, short};

/// What to list.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  flexion list\n  flexion list integrator")]
pub struct Arguments {
    /// Only this choice, with the keys of its kinds: e.g. section, motion, basis, initial, integrator
    #[arg(value_name = "CHOICE")]
    choice: Option<String>,
}

/// Lists all kinds, or those of one choice with their keys.
pub fn list(arguments: &Arguments) -> Outcome {
    let choices = flexion_case::choices();
    let mut out = String::new();
    let Some(name) = &arguments.choice else {
        for choice in choices {
            out.push_str(&heading(*choice));
            let row =
                |kind: &Entry| vec![kind.name.to_owned(), kind.summary.to_owned(), kind.source.to_owned()];
            out.push_str(&screen::table(&choice.kinds().iter().map(row).collect::<Vec<_>>()));
            out.push('\n');
        }
        screen::print(&out);
        return Outcome::Finished;
    };
    let Some(choice) = choices.iter().find(|choice| choice.name() == name || choice.path() == name) else {
        let names: Vec<&str> = choices.iter().map(|choice| choice.name()).collect();
        screen::report(&format!("error: there is no `{name}` to list; choose one of {}\n", names.join(", ")));
        return Outcome::Rejected;
    };
    out.push_str(&heading(*choice));
    for kind in choice.kinds() {
        out.push_str(&format!("\n{}: {}\n", kind.name, kind.summary));
        if !kind.source.is_empty() {
            out.push_str(&format!("  {}\n", kind.source));
        }
        out.push_str(&screen::table(&kind.keys.iter().map(row).collect::<Vec<_>>()));
    }
    screen::print(&out);
    Outcome::Finished
}

fn heading(choice: &dyn Kinds) -> String {
    format!("{} ({}): {}\n", choice.name(), choice.path(), choice.summary())
}

fn row(key: &Key) -> Vec<String> {
    let takes = match key.takes {
        Type::Quantity(measure, _) => measure.unit.to_owned(),
        Type::Quantities(measure, _) => format!("list, {}", measure.unit),
        Type::Number(_) => "number".to_owned(),
        Type::Integer(low, high) => format!("integer {low} … {high}"),
        Type::Boolean => "true or false".to_owned(),
        Type::Text => "text".to_owned(),
        Type::Texts => "list of texts".to_owned(),
        Type::Path => "path".to_owned(),
        Type::Choice(choice) => choice.kinds().iter().map(|kind| kind.name).collect::<Vec<_>>().join(" or "),
        Type::Table(_) => "table".to_owned(),
        Type::Tables(_) => "tables".to_owned(),
        Type::Kind(choice) => format!("table: {}", choice.name()),
    };
    let bound = match key.takes {
        Type::Quantity(_, bound) | Type::Quantities(_, bound) | Type::Number(bound)
            if bound != Bound::Any =>
        {
            format!(", {}", bound.words())
        }
        _ => String::new(),
    };
    let default = match key.presence {
        Presence::Required => "required".to_owned(),
        Presence::Optional | Presence::Empty => "optional".to_owned(),
        Presence::Number(value) => format!("default {}", short(value)),
        Presence::Integer(value) => format!("default {value}"),
        Presence::Boolean(value) => format!("default {value}"),
        Presence::Name(value) => format!("default {value}"),
    };
    vec![key.name.to_owned(), format!("{takes}{bound}"), default, key.doc.to_owned()]
}
