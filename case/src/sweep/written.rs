//! What is written of an input: `KEY=first:last:count`, `KEY=a, b, c` or `KEY=normal(mean, deviation)`.

use super::distribution;
use flexion_results::nearest;

/// The values of an input as they are written.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Written {
    /// One after another.
    Values(Vec<String>),
    /// From and to, and how many, ends included.
    Range([String; 2], Option<usize>),
    /// The name of a distribution and its parameters.
    Distribution(String, Vec<String>),
}

/// What is wrong with a text, and what to write.
pub(super) type Wrong = (String, String);

/// The key and the values of `KEY=VALUES`.
pub(super) fn read(argument: &str) -> Result<(String, Written), Wrong> {
    let (key, values) = argument.split_once('=').ok_or_else(|| {
        let help = "for example `section.modulus=60 GPa:80 GPa:21` or `model.coupling=zeroth, first`";
        ("an input is KEY=VALUES".to_owned(), help.to_owned())
    })?;
    Ok((key.trim().to_owned(), values_of(values.trim())?))
}

fn values_of(text: &str) -> Result<Written, Wrong> {
    if let Some((name, parameters)) = call(text) {
        let known = distribution::parameters(name);
        if known.is_some() {
            let parameters = split(parameters, ',').into_iter().map(str::to_owned).collect();
            return Ok(Written::Distribution(name.to_owned(), parameters));
        }
        if let Some(near) = nearest(name, distribution::names()) {
            let message = format!("unknown distribution `{name}`; did you mean `{near}`?");
            return Err((message, format!("the distributions are {}", distribution::written())));
        }
    }
    let parts = split(text, ':');
    if parts.len() > 1 && parts.iter().all(|part| number_end(part) > 0) {
        return range(&parts);
    }
    let values: Vec<String> = split(text, ',').into_iter().map(str::to_owned).collect();
    if values.iter().any(String::is_empty) {
        let message = if text.is_empty() { "there is no value" } else { "a value of the list is empty" };
        return Err((message.to_owned(), "write a range FIRST:LAST:COUNT or a list A, B, C".to_owned()));
    }
    Ok(Written::Values(values))
}

/// A range; of its ends one may stand without the unit of both.
fn range(parts: &[&str]) -> Result<Written, Wrong> {
    let help = || "write FIRST:LAST:COUNT with at least 2 values, e.g. `60 GPa:80 GPa:21`".to_owned();
    let (from, to, count) = match *parts {
        [from, to] => (from, to, None),
        [from, to, count] => {
            let whole = count.parse().ok().filter(|count| *count >= 2);
            (from, to, Some(whole.ok_or_else(|| (format!("`{count}` is no number of values"), help()))?))
        }
        _ => return Err((format!("a range has two or three parts, not {}", parts.len()), help())),
    };
    let units = [from, to].map(|end| end[number_end(end)..].trim());
    let ends = match units {
        ["", unit] if !unit.is_empty() => [format!("{from} {unit}"), to.to_owned()],
        [unit, ""] if !unit.is_empty() => [from.to_owned(), format!("{to} {unit}")],
        _ => [from.to_owned(), to.to_owned()],
    };
    Ok(Written::Range(ends, count))
}

/// The name and what is between the parentheses of `name(…)`.
fn call(text: &str) -> Option<(&str, &str)> {
    let (name, rest) = text.split_once('(')?;
    let is_name = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphabetic() || c == '-');
    Some((name, rest.strip_suffix(')')?)).filter(|_| is_name)
}

/// Where the number ends with which a text begins: 0 where there is none.
pub(super) fn number_end(text: &str) -> usize {
    let ends = (1..=text.len()).rev().filter(|end| text.is_char_boundary(*end));
    let is_number =
        |part: &str| part.ends_with(|c: char| c.is_ascii_digit() || c == '.') && part.parse::<f64>().is_ok();
    ends.into_iter().find(|end| is_number(&text[..*end])).unwrap_or(0)
}

/// The parts between separators that stand in no string of TOML and no brackets.
fn split(text: &str, separator: char) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut at) = (Vec::new(), 0, 0usize, 0);
    while let Some(c) = text[at..].chars().next() {
        let mut next = at + c.len_utf8();
        match c {
            '"' | '\'' => next = string_end(text, at),
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            c if c == separator && depth == 0 => {
                parts.push(text[start..at].trim());
                start = next;
            }
            _ => {}
        }
        at = next;
    }
    parts.push(text[start..].trim());
    parts
}

/// Where the string of TOML ends that begins with a mark at `start`: one of a line or of several, with escapes where the mark is `"`.
fn string_end(text: &str, start: usize) -> usize {
    let mark = &text[start..=start];
    let of_lines = text[start..].starts_with(&mark.repeat(3));
    let close = if of_lines { mark.repeat(3) } else { mark.to_owned() };
    let mut at = start + close.len();
    while let Some(c) = text[at..].chars().next() {
        if text[at..].starts_with(&close) {
            at += close.len();
            // Up to two marks may stand before the three that close.
            let further = text[at..].chars().take(2).take_while(|c| of_lines && mark.starts_with(*c));
            return at + further.count();
        }
        at += c.len_utf8();
        if c == '\\' && mark == "\"" {
            at += text[at..].chars().next().map_or(0, char::len_utf8);
        }
    }
    text.len()
}

/// A text without the quotes of TOML.
pub(super) fn bare(text: &str) -> String {
    let quoted =
        text.starts_with(['"', '\'']).then(|| toml::from_str::<toml::Table>(&format!("text = {text}")).ok());
    let read = quoted.flatten().and_then(|table| table.get("text")?.as_str().map(str::to_owned));
    read.unwrap_or_else(|| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Written {
        read(&format!("key={text}")).unwrap().1
    }

    #[test]
    fn ranges_lists_and_distributions_are_told_apart() {
        let range = |from: &str, to: &str, count| Written::Range([from.to_owned(), to.to_owned()], count);
        assert_eq!(values("60 GPa:80 GPa:21"), range("60 GPa", "80 GPa", Some(21)));
        assert_eq!(values("60:80 GPa:21"), range("60 GPa", "80 GPa", Some(21)));
        assert_eq!(values("0 rpm:20:3"), range("0 rpm", "20 rpm", Some(3)));
        assert_eq!(values("-1e-3:.5"), range("-1e-3", ".5", None));
        let list = |of: &[&str]| Written::Values(of.iter().map(|s| (*s).to_owned()).collect());
        assert_eq!(values("zeroth, first"), list(&["zeroth", "first"]));
        assert_eq!(
            values("{kind='constant', speed=2}, {kind='free'}"),
            list(&["{kind='constant', speed=2}", "{kind='free'}"])
        );
        for text in [
            r#""a, b""#,
            r#""a\", b""#,
            r"'a\'",
            r#""""a", 'b"""""#,
            r#""""#,
            "'''it's, \"a'''",
            "\"\"\"\na\nb\"\"\"",
        ] {
            assert_eq!(values(&format!("{text}, c")), list(&[text, "c"]));
        }
        assert_eq!(values("sin(t)"), list(&["sin(t)"]));
        let normal =
            Written::Distribution("normal".to_owned(), vec!["70 GPa".to_owned(), "1 GPa".to_owned()]);
        assert_eq!(values("normal(70 GPa, 1 GPa)"), normal);
    }

    #[test]
    fn what_is_none_of_them_is_refused() {
        let refused = |text: &str| read(text).unwrap_err().0;
        assert!(refused("key").contains("KEY=VALUES"));
        assert!(refused("key=").contains("no value"));
        assert!(refused("key=1,,2").contains("empty"));
        assert!(refused("key=1:2:1").contains("`1` is no number of values"));
        assert!(refused("key=1:2:3:4").contains("two or three parts, not 4"));
        assert!(refused("key=norml(1, 2)").contains("did you mean `normal`?"));
    }
}
