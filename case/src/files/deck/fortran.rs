//! Text as Fortran's list-directed input reads it.
//!
//! Values are separated by blanks, tabs and commas, `3*0.5` is three times 0.5, a slash ends a line, exponents are written with E, D, Q or
//! with a sign alone (`1.5+3`), and a text may stand in quotes. What follows the values that are asked for is a comment; where a line has too
//! few, the next goes on.

/// The lines of a file that the case calls `name`.
pub(super) struct Text<'a> {
    pub name: &'a str,
    lines: Vec<String>,
}

/// The numbers that were asked for, the line on which they begin, and the numbers that follow them on their last line.
pub(super) struct Numbers {
    pub values: Vec<f64>,
    pub line: usize,
    pub surplus: usize,
}

/// The text of a file: UTF-8, or else Latin-1.
pub(super) fn decoded(bytes: &[u8]) -> String {
    let text = std::str::from_utf8(bytes).map_or_else(
        |_| bytes.iter().map(|byte| char::from(*byte)).collect(),
        |text| text.trim_start_matches('\u{feff}').to_owned(),
    );
    text.replace("\r\n", "\n").replace('\r', "\n")
}

impl<'a> Text<'a> {
    pub fn new(bytes: &[u8], name: &'a str) -> Text<'a> {
        Text { name, lines: decoded(bytes).lines().map(str::to_owned).collect() }
    }

    /// Number of the line and value before one of these keywords, in any case.
    pub fn keyword(&self, keys: &[&str]) -> Option<(usize, String)> {
        self.lines.iter().enumerate().find_map(|(i, line)| {
            let words = words(line);
            let word = words.get(1)?.trim_end_matches([':', '-', '=']);
            keys.iter().any(|key| word.eq_ignore_ascii_case(key)).then(|| (i + 1, words[0].clone()))
        })
    }

    /// The number before one of these keywords, with its line.
    ///
    /// # Errors
    /// Where there is no such line, or no number of that kind on it.
    pub fn count(&self, keys: &[&str], least: usize, what: &str) -> Result<(usize, usize), String> {
        let name = self.name;
        let key = keys[0];
        let Some((line, text)) = self.keyword(keys) else {
            return Err(format!(
                "{name} has no line with `{key}`, {what}: is it a file of this format, and the right one of its two?"
            ));
        };
        match number(&text) {
            Some(x) if x.fract() == 0.0 && (least as f64..=1e6).contains(&x) => Ok((x as usize, line)),
            _ => Err(format!(
                "line {line} of {name}: `{key}` is {what}, a whole number of at least {least}, and not `{text}`"
            )),
        }
    }

    /// The number of lines.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// The line of a number from 1.
    pub fn line(&self, number: usize) -> &str {
        number.checked_sub(1).and_then(|i| self.lines.get(i)).map_or("", String::as_str)
    }

    /// The next line from number `from` on whose first word is a number, if there is one.
    pub fn next_with_number(&self, from: usize) -> Option<usize> {
        (from..=self.len()).find(|i| words(self.line(*i)).first().is_some_and(|word| begins_number(word)))
    }

    /// As [`Text::numbers`], where no comment may stand before them.
    ///
    /// # Errors
    /// Where there are too few.
    pub fn row(&self, at: &mut usize, count: usize, what: &str) -> Result<Numbers, String> {
        let next = (*at..=self.len()).find(|i| !words(self.line(*i)).is_empty());
        if let Some((i, word)) = next.and_then(|i| Some((i, words(self.line(i)).into_iter().next()?)))
            && !begins_number(&word)
        {
            return Err(format!("line {i} of {}: `{word}` is not a number, where {what} begins", self.name));
        }
        self.numbers(at, count, what)
    }

    /// So many numbers from line `*at` on, which moves behind them; lines before them that begin with no number are comments.
    ///
    /// # Errors
    /// Where there are too few.
    pub fn numbers(&self, at: &mut usize, count: usize, what: &str) -> Result<Numbers, String> {
        let name = self.name;
        let Some(first) = self.next_with_number(*at) else {
            return Err(format!("line {} of {name}: the file ends before {what}", self.len()));
        };
        let (mut values, mut surplus, mut line) = (Vec::with_capacity(count), 0, first);
        while values.len() < count {
            if line > self.len() {
                return Err(format!(
                    "line {} of {name}: the file ends in {what}, which begins in line {first}",
                    self.len()
                ));
            }
            for word in words(self.line(line)) {
                match number(&word) {
                    Some(_) if values.len() == count => surplus += 1,
                    Some(value) => values.push(value),
                    None if values.len() == count => break,
                    None => {
                        return Err(format!(
                            "line {line} of {name}: `{word}` is not a number, where {what} has {} of {count}",
                            values.len()
                        ));
                    }
                }
            }
            line += 1;
        }
        if surplus > 0 && line > first + 1 {
            return Err(format!(
                "line {first} of {name} has too few numbers for {what}, which has {count}: those of the next line do not fill it up"
            ));
        }
        *at = line;
        Ok(Numbers { values, line: first, surplus })
    }
}

/// Whether a word looks like a number, right or wrong.
pub(super) fn begins_number(word: &str) -> bool {
    let rest = word.trim_start_matches(['+', '-', '.']);
    let is_name = matches!(rest.to_ascii_lowercase().as_str(), "nan" | "inf" | "infinity");
    word.len() - rest.len() <= 2 && (is_name || rest.starts_with(|c: char| c.is_ascii_digit()))
}

/// Values of a line that are looked at.
const LONGEST: usize = 1000;

/// The values of a line, as texts.
pub(super) fn words(line: &str) -> Vec<String> {
    let mut out = Vec::new();
    let mut rest = line.trim_start_matches([' ', '\t', ',']);
    while let Some(first) = rest.chars().next() {
        if first == '/' || out.len() >= LONGEST {
            break;
        }
        if let '"' | '\'' = first {
            let inside = &rest[1..];
            let end = inside.find(first).unwrap_or(inside.len());
            out.push(inside[..end].trim().to_owned());
            rest = inside.get(end + 1..).unwrap_or("");
        } else {
            let end = rest.find([' ', '\t', ',', ';']).unwrap_or(rest.len()).max(1);
            let word = &rest[..end];
            match word.split_once('*') {
                Some((times, value)) if times.parse::<usize>().is_ok_and(|n| n <= LONGEST) => {
                    let times = times.parse().unwrap_or(1);
                    out.extend(std::iter::repeat_n(value.to_owned(), times));
                }
                _ => out.push(word.to_owned()),
            }
            rest = &rest[end..];
        }
        rest = rest.trim_start_matches([' ', '\t', ',', ';']);
    }
    out
}

/// A number as Fortran writes it; one that is not finite is none.
pub(super) fn number(word: &str) -> Option<f64> {
    let plain = word.to_ascii_lowercase().replace(['d', 'q'], "e");
    let parsed = plain.parse().ok().or_else(|| {
        // An exponent without its letter.
        let at = plain.rfind(['+', '-']).filter(|at| *at > 0 && !plain.contains('e'))?;
        format!("{}e{}", &plain[..at], &plain[at..]).parse().ok()
    });
    parsed.filter(|x: &f64| x.is_finite() && !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_list_directed_input() {
        for (line, expected) in [
            ("  1.0\t2 , 3,4", &["1.0", "2", "3", "4"][..]),
            ("\"a b.dat\"  BldFile - name", &["a b.dat", "BldFile", "-", "name"]),
            ("'DEFAULT' refine", &["DEFAULT", "refine"]),
            ("3*0.5 1", &["0.5", "0.5", "0.5", "1"]),
            ("1 2 / 3", &["1", "2"]),
            ("", &[]),
        ] {
            assert_eq!(words(line), expected, "{line}");
        }
        for (word, value) in [
            ("1.5D+03", 1500.0),
            ("1.5d3", 1500.0),
            ("1.5+3", 1500.0),
            ("-2.5-1", -0.25),
            (".5", 0.5),
            ("+5.", 5.0),
            ("1Q2", 100.0),
        ] {
            assert_eq!(number(word), Some(value), "{word}");
        }
        for word in ["", "-", "1.2.3", "NaN", "inf", "1e400", "0x1", "5x"] {
            assert_eq!(number(word), None, "{word}");
        }
    }

    #[test]
    fn numbers_go_on_over_lines_and_end_before_comments() {
        let text =
            Text::new("title\r\n--- 3\n\n1 2\n3 ! three\n4 5 6 seven\n7 8\n9 10 11\nx".as_bytes(), "f");
        let mut at = 1;
        let found = text.numbers(&mut at, 3, "a row").unwrap();
        assert_eq!((found.values, found.line, found.surplus, at), (vec![1.0, 2.0, 3.0], 4, 0, 6));
        let found = text.numbers(&mut at, 2, "a row").unwrap();
        assert_eq!((found.values, found.surplus), (vec![4.0, 5.0], 1));
        let message = text.numbers(&mut at, 3, "a row").err().unwrap();
        assert!(message.contains("line 7 of f has too few numbers"), "{message}");
        let message = text.numbers(&mut 9, 1, "a row").err().unwrap();
        assert!(message.contains("ends before a row"), "{message}");
        assert_eq!(text.keyword(&["THREE"]), None);
        assert_eq!(decoded(b"\xfcber"), "über");
    }
}
