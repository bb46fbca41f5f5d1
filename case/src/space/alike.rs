//! What is said of several beams in the same words, once with all their names.

/// How sentences name a beam.
const NAMED: [&str; 2] = ["the blade", "beam"];

/// The sentences, in the order in which they first stand, with those that differ by the names of beams alone made one.
pub(super) fn once(sentences: Vec<String>, names: &[&str]) -> Vec<String> {
    let mut out: Vec<([String; 2], &str, Vec<&str>)> = Vec::new();
    for sentence in sentences {
        let named = names.iter().find_map(|name| {
            NAMED.iter().find_map(|word| {
                let (before, behind) = sentence.split_once(&format!("{word} `{name}`"))?;
                Some(([before.to_owned(), behind.to_owned()], *word, *name))
            })
        });
        let (parts, word, name) = named.unwrap_or(([sentence, String::new()], "", ""));
        match out
            .iter_mut()
            .find(|(other, with, all)| *other == parts && *with == word && !all.contains(&name))
        {
            Some((.., all)) if !word.is_empty() => all.push(name),
            _ => out.push((parts, word, vec![name])),
        }
    }
    let joined = |([before, behind], word, names): ([String; 2], &str, Vec<&str>)| match &names[..] {
        [_] if word.is_empty() => before,
        [name] => format!("{before}{word} `{name}`{behind}"),
        names => {
            let all: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
            format!("{before}each of the {}s {}{behind}", word.trim_start_matches("the "), all.join(", "))
        }
    };
    out.into_iter().map(joined).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_of_several_beams_are_one() {
        let of = |text: &[&str]| once(text.iter().map(|text| (*text).to_owned()).collect(), &["a", "b", "c"]);
        let found = of(&[
            "a deck, once",
            "the section of beam `a` has 1",
            "the blade `a` goes ahead",
            "the section of beam `b` has 1",
            "the section of beam `c` has 2",
            "the blade `c` goes ahead",
            "`b` and beam `d`",
        ]);
        assert_eq!(
            found,
            [
                "a deck, once",
                "the section of each of the beams `a`, `b` has 1",
                "each of the blades `a`, `c` goes ahead",
                "the section of beam `c` has 2",
                "`b` and beam `d`",
            ]
        );
    }
}
