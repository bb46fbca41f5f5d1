//! Case files to begin with. A template gives values only: what they mean, what else could be set and the kinds
//! there are to choose from is written in from the declarations.

use super::declaration::{Bound, Entry, Key, Kinds, Presence, Type};
use super::problem::Problems;
use super::reading::parse;
use super::resolved::written;
use super::values::{Filled, Value, Values, join};
use std::fmt::Write;
use std::path::Path;

/// A case to begin with.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    /// Name.
    pub name: &'static str,
    /// One line on what it shows.
    pub summary: &'static str,
    /// The values, as a case file without comments.
    text: &'static str,
}

/// All templates.
pub static TEMPLATES: &[Template] = &[
    Template {
        name: "spin-up",
        summary: "a beam set into rotation smoothly, and its vibration afterwards",
        text: r#"
title = "Spin-up of a flexible beam"
beam = { length = "10 m" }
section = { kind = "uniform", modulus = "70 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 10 }
integrator = { kind = "radau", tolerance = 1e-6 }
run = { duration = "20 s" }
output = { step = "0.02 s" }
"#,
    },
    Template {
        name: "steady",
        summary: "a rectangular beam in steady rotation, started in its equilibrium",
        text: r#"
title = "Steady rotation"
beam = { length = "2 m" }
section = { kind = "rectangle", modulus = "210 GPa", density = "7850 kg/m^3", width = "40 mm", height = "10 mm" }
hub = { radius = "0.2 m", motion = { kind = "constant", speed = "30 rad/s" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 10 }
initial = { kind = "steady-rotation" }
integrator = { kind = "radau", tolerance = 1e-8 }
run = { duration = "1 s" }
output = { step = "5 ms", stations = ["1 m"] }
"#,
    },
    Template {
        name: "free-hub",
        summary: "an arm on a hub that a controller rotates to a target angle",
        text: r#"
title = "A flexible arm driven by a controller"
beam = { length = "1 m" }
section = { kind = "rectangle", modulus = "70 GPa", density = "2700 kg/m^3", width = "20 mm", height = "2 mm" }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 10 }
integrator = { kind = "radau", tolerance = 1e-6 }
run = { duration = "5 s" }
output = { step = "0.01 s" }
[hub]
radius = "50 mm"
inertia = "0.05 kg*m^2"
motion = { kind = "free", damping = "0.01 N*m*s/rad", controller = { kind = "pd", proportional = "2 N*m/rad", derivative = "0.6 N*m*s/rad", target = "60 deg", rate = "1 rad/s", limit = "1 N*m" } }
"#,
    },
    Template {
        name: "graded",
        summary: "a beam graded over its height from metal to ceramic, spun up on a hub",
        text: r#"
title = "Functionally graded beam"
beam = { length = "8 m" }
hub = { radius = "0.5 m", motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 12 }
integrator = { kind = "radau" }
run = { duration = "20 s" }
output = { step = "0.02 s" }
[section]
kind = "graded"
ceramic-modulus = "151 GPa"
metal-modulus = "70 GPa"
ceramic-density = "3000 kg/m^3"
metal-density = "2707 kg/m^3"
width = "20 mm"
height = "40 mm"
exponent = 2.0
"#,
    },
    Template {
        name: "exact-large-deflection",
        summary: "a soft beam with large deflections, geometrically exact",
        text: r#"
title = "Large deflection of a soft beam"
beam = { length = "8 m" }
section = { kind = "uniform", modulus = "10 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "4 s" } }
model = { coupling = "exact" }
basis = { kind = "finite-elements", elements = 16 }
integrator = { kind = "generalized-alpha", step = "2 ms", spectral-radius = 0.8 }
run = { duration = "8 s" }
output = { step = "20 ms", vtk = true }
"#,
    },
    Template {
        name: "formula",
        summary: "a hub that swings to and fro by a formula in time",
        text: r#"
title = "Swinging hub"
beam = { length = "5 m" }
section = { kind = "tube", modulus = "70 GPa", density = "2700 kg/m^3", outer-radius = "30 mm", inner-radius = "26 mm" }
hub = { motion = { kind = "expression", formula = "0.5*(1 - cos(2*t))", of = "angle" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 8 }
integrator = { kind = "radau" }
run = { duration = "10 s" }
output = { step = "10 ms" }
"#,
    },
    Template {
        name: "double-pendulum",
        summary: "two rigid bars on hinges fall in space",
        text: r#"
title = "Double pendulum"
gravity = [0, 0, "-9.81 m/s^2"]
integrator = { kind = "radau", tolerance = 1e-8 }
run = { duration = "5 s" }
output = { step = "0.01 s" }
[[body]]
name = "upper"
mass = "2 kg"
inertia = { kind = "box", size = ["1 m", "5 cm", "5 cm"] }
position = ["50 cm", 0, 0]
[[body]]
name = "lower"
mass = "1 kg"
inertia = { kind = "box", size = ["1 m", "3 cm", "3 cm"] }
position = ["150 cm", 0, 0]
[[joint]]
name = "shoulder"
kind = "revolute"
between = ["ground", "upper"]
at = [0, 0, 0]
axis = [0, -1, 0]
[[joint]]
name = "elbow"
kind = "revolute"
between = ["upper", "lower"]
at = ["1 m", 0, 0]
axis = [0, -1, 0]
"#,
    },
    Template {
        name: "robot-arm",
        summary: "a motor turns a slender beam in space that carries a mass",
        text: r#"
title = "A flexible arm in space"
gravity = [0, 0, "-9.81 m/s^2"]
integrator = { kind = "generalized-alpha", step = "1 ms" }
run = { duration = "2 s" }
output = { step = "5 ms", vtk = true }
[[body]]
name = "payload"
mass = "200 g"
inertia = { kind = "sphere", radius = "3 cm" }
position = ["1 m", 0, 0]
[[beam]]
name = "arm"
length = "1 m"
section = { kind = "rectangle", modulus = "70 GPa", density = "2700 kg/m^3", width = "20 mm", height = "5 mm" }
elements = 8
stations = ["50 cm"]
[[joint]]
name = "motor"
kind = "revolute"
between = ["ground", "arm.root"]
motion = { kind = "spin-up", speed = "1 rad/s", time = "1 s" }
[[joint]]
name = "grip"
kind = "fixed"
between = ["arm.tip", "payload"]
at = ["1 m", 0, 0]
"#,
    },
    Template {
        name: "modes",
        summary: "a beam described by a few of its vibration modes, fixed steps",
        text: r#"
title = "Assumed modes"
beam = { length = "10 m" }
section = { kind = "uniform", modulus = "70 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "modes", axial = 3, transverse = 4 }
integrator = { kind = "newmark", step = "2 ms" }
run = { duration = "20 s" }
output = { step = "0.02 s" }
"#,
    },
    Template {
        name: "radial",
        summary: "a beam described by meshfree radial point interpolation",
        text: r#"
title = "Radial point interpolation"
beam = { length = "10 m" }
section = { kind = "uniform", modulus = "70 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "radial", nodes = 13 }
integrator = { kind = "radau" }
run = { duration = "20 s" }
output = { step = "0.02 s" }
"#,
    },
];

impl Template {
    /// The case file with its comments.
    ///
    /// # Errors
    /// [`Problems`] if the template were no case.
    pub fn render(&self) -> Result<String, Problems> {
        let reading = parse(self.text.to_owned(), Path::new(self.name), &[])?;
        let mut out = format!(
            "# {}: {}.\n#\n\
             # Check this case with `flexion check`, run it with `flexion run`; `flexion list` shows all kinds.\n\
             # A quantity is a text with its unit, or a number in SI. Lines like `#key = value` show what else can\n\
             # be set: its default, or an example.\n\n",
            self.name, self.summary
        );
        let writer = Writer { text: self.text };
        writer.table(&reading.values, reading.values.keys, None, "", &mut out);
        Ok(out)
    }
}

/// Writes tables with comments.
struct Writer {
    /// What the values were read from.
    text: &'static str,
}

/// One line of a table: text, comment.
type Line = (String, String);

impl Writer {
    fn table(
        &self,
        values: &Values,
        keys: &'static [Key],
        kind: Option<(&Entry, bool)>,
        path: &str,
        out: &mut String,
    ) {
        let mut lines: Vec<Line> = Vec::new();
        if let Some((kind, given)) = kind {
            let mark = if given { "" } else { "#" };
            lines.push((format!("{mark}kind = \"{}\"", kind.name), kind.summary.to_owned()));
        }
        let filled = |key: &Key| values.entries.iter().find(|filled| filled.key.name == key.name);
        for key in keys.iter().filter(|key| !nested(key)) {
            let comment = meaning(key);
            match filled(key) {
                Some(Filled { place: Some(place), .. }) => {
                    let written = self.text.get(place.start..place.end).unwrap_or_default();
                    lines.push((format!("{} = {written}", key.name), comment));
                }
                Some(Filled { value, .. }) => {
                    lines.push((format!("#{} = {}", key.name, written(value, &key.takes, false)), comment));
                }
                None => lines.push((format!("#{} = {}", key.name, example(&key.takes)), comment)),
            }
        }
        let width = lines.iter().map(|(text, _)| text.chars().count()).max().unwrap_or(0);
        for (text, comment) in lines {
            let fill = " ".repeat(width - text.chars().count());
            let _ = writeln!(out, "{text}{fill}  # {comment}");
        }
        for key in keys.iter().filter(|key| nested(key)) {
            let Some(Filled { value, place, .. }) = filled(key) else { continue };
            let path = join(path, key.name);
            if let (Value::Tables(list), Type::Tables(keys)) = (value, key.takes) {
                for (number, values) in list.iter().enumerate() {
                    let what =
                        if number == 0 { format!("# {}\n", capitalised(key.doc)) } else { String::new() };
                    let _ = writeln!(out, "\n{what}[[{path}]]");
                    self.table(values, keys, None, &path, out);
                }
                continue;
            }
            let mark = if place.is_some() { "" } else { "#" };
            let choice = match key.takes {
                Type::Kind(choice) => format!("; its kind is one of {}", names(choice)),
                _ => String::new(),
            };
            let _ = writeln!(out, "\n# {}{choice}\n{mark}[{path}]", capitalised(key.doc));
            match (value, key.takes) {
                (Value::Table(values), Type::Table(keys)) => self.table(values, keys, None, &path, out),
                (Value::Kind(kind, values), Type::Kind(_)) => {
                    self.table(values, kind.keys, Some((kind, place.is_some())), &path, out);
                }
                _ => {}
            }
        }
    }
}

fn nested(key: &Key) -> bool {
    matches!(key.takes, Type::Table(_) | Type::Tables(_) | Type::Kind(_))
}

/// What a key means, its unit and limits, and what it can be chosen from.
fn meaning(key: &Key) -> String {
    let mut text = key.doc.to_owned();
    match key.takes {
        Type::Quantity(measure, bound) | Type::Quantities(measure, bound) => {
            let _ = write!(text, " [{}]", measure.unit);
            limits(bound, &mut text);
        }
        Type::Number(bound) => limits(bound, &mut text),
        Type::Choice(choice) => {
            let _ = write!(text, "; one of {}", names(choice));
        }
        _ => {}
    }
    if key.presence == Presence::Optional {
        text.push_str(" (optional)");
    }
    text
}

fn names(choice: &dyn Kinds) -> String {
    choice.kinds().iter().map(|kind| kind.name).collect::<Vec<_>>().join(", ")
}

fn limits(bound: Bound, text: &mut String) {
    if bound != Bound::Any {
        let _ = write!(text, ", {}", bound.words());
    }
}

/// A value of the type, for a key without default.
fn example(takes: &Type) -> String {
    match takes {
        Type::Quantity(measure, _) => {
            // The second one is small: times that can be left out are short.
            let examples: Vec<&str> = measure.examples.split(", ").collect();
            let small = examples.get(1).or(examples.first()).copied().unwrap_or_default();
            format!("\"{}\"", small.trim_matches(['`', '"']))
        }
        _ => "…".to_owned(),
    }
}

fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every value of the case, defaults included.
    fn case(text: &str) -> String {
        parse(text.to_owned(), Path::new("case.toml"), &[])
            .unwrap_or_else(|p| panic!("{}", p.render(false)))
            .resolved()
    }

    #[test]
    fn the_commented_file_is_the_same_case_as_the_template() {
        for template in TEMPLATES {
            assert_eq!(case(&template.render().unwrap()), case(template.text), "{}", template.name);
        }
    }

    #[test]
    fn the_defaults_shown_are_those_in_force() {
        for template in TEMPLATES {
            let text = template.render().unwrap();
            let uncommented: Vec<&str> = text
                .lines()
                .filter(|line| !(line.starts_with('#') && line.ends_with("(optional)")))
                .map(|line| line.strip_prefix('#').filter(|l| !l.starts_with(' ')).unwrap_or(line))
                .collect();
            assert_ne!(uncommented.join("\n"), text.trim_end());
            assert_eq!(case(&uncommented.join("\n")), case(template.text), "{}", template.name);
        }
    }

    #[test]
    fn every_line_that_sets_something_says_what_it_means() {
        for template in TEMPLATES {
            for line in template.render().unwrap().lines() {
                let prose = line.is_empty() || line.starts_with("# ") || line == "#";
                let header = line.trim_start_matches('#').starts_with('[');
                assert!(prose || header || line.contains("  # "), "{}: {line}", template.name);
                assert!(!line.contains('…') || line.contains("  # "), "{line}");
            }
        }
    }
}
