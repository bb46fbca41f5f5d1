//! Rules: what decides a claim.

use crate::described::{As, OfRun, Rule, Term};
use crate::need::placeholders;
use crate::shown::{plain, shown};
use crate::term::{Answers, Missing, Number, answer, number, of_run};

/// What a rule gives.
#[derive(Clone, Debug, PartialEq)]
pub enum Ruled {
    /// It holds for all values within the errors.
    Holds,
    /// It fails for all.
    Fails,
    /// Neither, and why.
    Undecided(String),
    /// The paper's value is lost, or cannot be repeated.
    Lost(String),
    /// Runs that take so long \[s\] together were not asked for.
    NotRun(f64),
}

/// The values of a rule, by the names under which sentences have them.
pub type Words = Vec<(String, String)>;

/// The terms of a rule over several runs.
pub fn terms(rule: &Rule) -> Vec<OfRun> {
    match rule {
        Rule::Agree { runs, quantity, curves, .. } => {
            let Some(first) = runs.first() else { return Vec::new() };
            let compared = if *curves { As::CurveDifference } else { As::RelativeDifference };
            runs[1..].iter().map(|run| of(run, quantity, Some((first, compared)))).collect()
        }
        Rule::Grows { runs, quantity } | Rule::Falls { runs, quantity } => {
            runs.iter().map(|run| of(run, quantity, None)).collect()
        }
        _ => Vec::new(),
    }
}

fn of(run: &str, quantity: &str, to: Option<(&String, As)>) -> OfRun {
    OfRun {
        run: run.to_owned(),
        quantity: quantity.to_owned(),
        to: to.map(|(to, _)| to.clone()),
        compared: to.map(|(_, compared)| compared),
    }
}

/// What a rule gives, and the words of its sentences.
pub fn ruled(rule: &Rule, answers: &Answers<'_>) -> (Ruled, Words) {
    let mut words = Words::new();
    let ruled = decide(rule, answers, &mut words).unwrap_or_else(|missing| match missing {
        Missing::Long(seconds) => Ruled::NotRun(seconds),
        Missing::Because(why) => Ruled::Undecided(why),
    });
    // What is missing has no value to be said.
    for word in placeholders(rule).into_iter().map(|word| format!("{{{word}}}")) {
        if words.iter().all(|(known, _)| *known != word) {
            words.push((word, UNKNOWN.to_owned()));
        }
    }
    (ruled, words)
}

/// What stands for a value that is missing.
const UNKNOWN: &str = "an unknown value";

fn decide(rule: &Rule, answers: &Answers<'_>, words: &mut Words) -> Result<Ruled, Missing> {
    match rule {
        Rule::Lost { because } => Ok(Ruled::Lost(because.clone())),
        Rule::Less { left, right, times } => {
            let (left_is, right_is) = (number(left, answers)?, number(right, answers)?);
            words.push(("{left}".to_owned(), said(left, &left_is)));
            words.push(("{right}".to_owned(), said(right, &right_is)));
            let times = times.unwrap_or(1.0);
            let error = left_is.error.map(|error| times * error);
            Ok(less(&Number { value: times * left_is.value, error, ..left_is }, &right_is))
        }
        Rule::Within { of, low, high } => {
            let value = number(of, answers)?;
            words.push(("{of}".to_owned(), shown(&value)));
            let bound = |value: f64| Number {
                value,
                error: Some(0.0),
                unit: String::new(),
                part: false,
                varies: false,
            };
            words.push(("{low}".to_owned(), plain(*low)));
            words.push(("{high}".to_owned(), plain(*high)));
            // A difference as a part of a value is never below zero.
            let is_part = matches!(
                of,
                Term::Of(OfRun { compared: Some(As::RelativeDifference | As::CurveDifference), .. })
            );
            let least = if *low <= 0.0 && is_part { Ruled::Holds } else { at_most(&bound(*low), &value) };
            Ok(both([least, at_most(&value, &bound(*high))]))
        }
        Rule::Agree { within, .. } => {
            let found = numbers(rule, answers)?;
            extremes(&found, words);
            let bound =
                Number { value: *within, error: Some(0.0), unit: String::new(), part: true, varies: false };
            Ok(both(found.iter().map(|value| at_most(value, &bound))))
        }
        Rule::Grows { .. } | Rule::Falls { .. } => {
            let found = numbers(rule, answers)?;
            extremes(&found, words);
            let grows = matches!(rule, Rule::Grows { .. });
            let pairs = found.iter().zip(found.iter().skip(1));
            Ok(both(pairs.map(|(a, b)| if grows { less(a, b) } else { less(b, a) })))
        }
        Rule::EndsEarly { runs } | Rule::Finishes { runs } => {
            let wanted = matches!(rule, Rule::Finishes { .. });
            for run in runs {
                if answer(answers, run)?.finished() != wanted {
                    return Ok(Ruled::Fails);
                }
            }
            Ok(Ruled::Holds)
        }
        Rule::All { rules } => {
            let each = decide_each(rules, answers, words);
            // One that fails decides, whatever is missing of the others.
            if each.contains(&Ok(Ruled::Fails)) {
                return Ok(Ruled::Fails);
            }
            Ok(both(each.into_iter().collect::<Result<Vec<_>, _>>()?))
        }
        Rule::Any { rules } => {
            let each = decide_each(rules, answers, words);
            if each.contains(&Ok(Ruled::Holds)) {
                return Ok(Ruled::Holds);
            }
            let each = each.into_iter().collect::<Result<Vec<_>, _>>()?;
            Ok(each.into_iter().find(|ruled| *ruled != Ruled::Fails).unwrap_or(Ruled::Fails))
        }
    }
}

/// What each of several rules gives, and their words, with the number of the rule and, of the first that has one, without.
fn decide_each(rules: &[Rule], answers: &Answers<'_>, words: &mut Words) -> Vec<Result<Ruled, Missing>> {
    let mut each = Vec::new();
    for (i, rule) in rules.iter().enumerate() {
        let mut own = Words::new();
        each.push(decide(rule, answers, &mut own));
        // Another rule may decide where this one has no values.
        for word in placeholders(rule).into_iter().map(|word| format!("{{{word}}}")) {
            if own.iter().all(|(known, _)| *known != word) {
                own.push((word, UNKNOWN.to_owned()));
            }
        }
        for (name, value) in own {
            // The word of a rule among those of this one has a number already.
            let first = is_plain(&name) && words.iter().all(|(known, _)| *known != name);
            words.push((name.replace('}', &format!("{}}}", i + 1)), value.clone()));
            if first {
                words.push((name, value));
            }
        }
    }
    each
}

/// Whether a word has no number: `{left}`.
fn is_plain(word: &str) -> bool {
    !word.trim_end_matches('}').ends_with(|c: char| c.is_ascii_digit())
}

fn numbers(rule: &Rule, answers: &Answers<'_>) -> Result<Vec<Number>, Missing> {
    terms(rule).iter().map(|of| of_run(of, answers)).collect()
}

/// The values of several runs as words.
fn extremes(found: &[Number], words: &mut Words) {
    let order = |a: &&Number, b: &&Number| a.value.total_cmp(&b.value);
    let of = |number: Option<&Number>| number.map_or(String::new(), shown);
    words.push(("{least}".to_owned(), of(found.iter().min_by(order))));
    words.push(("{most}".to_owned(), of(found.iter().max_by(order))));
    words.push(("{first}".to_owned(), of(found.first())));
    words.push(("{last}".to_owned(), of(found.last())));
}

/// A number as it was written, or as it was found.
fn said(term: &Term, number: &Number) -> String {
    if let Term::Number(value) = term { plain(*value) } else { shown(number) }
}

/// Whether a < b for all values within their errors, or for none.
fn less(a: &Number, b: &Number) -> Ruled {
    compared(a, b, |a, b| a < b)
}

/// Whether a ≤ b for all values within their errors, or for none.
fn at_most(a: &Number, b: &Number) -> Ruled {
    compared(a, b, |a, b| a <= b)
}

fn compared(a: &Number, b: &Number, in_order: impl Fn(f64, f64) -> bool) -> Ruled {
    let (Some(e), Some(f)) = (a.error, b.error) else {
        let which = if a.error.is_none() { a } else { b };
        return Ruled::Undecided(format!("the error of {} is not known", shown(which)));
    };
    if in_order(a.value + e, b.value - f) {
        Ruled::Holds
    } else if !in_order(a.value - e, b.value + f) {
        Ruled::Fails
    } else {
        Ruled::Undecided(format!("{} and {} cannot be told apart", shown(a), shown(b)))
    }
}

/// All of them.
fn both(each: impl IntoIterator<Item = Ruled>) -> Ruled {
    let mut out = Ruled::Holds;
    for ruled in each {
        out = match (out, ruled) {
            (Ruled::Fails, _) | (_, Ruled::Fails) => Ruled::Fails,
            (Ruled::Holds, other) => other,
            (kept, _) => kept,
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::Answer;

    fn is_within(value: f64, error: f64, low: f64, high: f64) -> Ruled {
        let number =
            |value| Number { value, error: Some(error), unit: String::new(), part: false, varies: false };
        let bound = |value| Number { error: Some(0.0), ..number(value) };
        both([at_most(&bound(low), &number(value)), at_most(&number(value), &bound(high))])
    }

    #[test]
    fn bounds_belong_to_what_is_between_them() {
        assert_eq!(is_within(152.0, 0.0, 152.0, 152.0), Ruled::Holds);
        assert_eq!(is_within(152.0, 0.0, 152.0, 153.0), Ruled::Holds);
        assert_eq!(is_within(153.5, 0.1, 152.0, 153.0), Ruled::Fails);
        assert!(matches!(is_within(153.0, 0.1, 152.0, 153.0), Ruled::Undecided(_)));
    }

    /// One value of 1 ± 0.2, and a run that has no value.
    fn one_value(rule: &str) -> Ruled {
        let valued =
            crate::answer::Valued { value: 1.0, error: Some(0.2), unit: "m".to_owned(), varies: false };
        let mut answer = Answer { status: "finished".to_owned(), ..Answer::default() };
        answer.values.insert("x".to_owned(), Ok(valued));
        let answers: Answers<'_> = [("one".to_owned(), (Some(&answer), None))].into_iter().collect();
        ruled(&toml::from_str(rule).unwrap(), &answers).0
    }

    #[test]
    fn a_factor_multiplies_a_value_and_its_error() {
        let less = |times: f64, right: f64| {
            one_value(&format!(
                "kind = 'less'\nleft = {{ run = 'one', quantity = 'x' }}\nright = {right}\ntimes = {times}"
            ))
        };
        // 10 ± 2 and 0.5 ± 0.1.
        assert_eq!(less(10.0, 12.1), Ruled::Holds);
        assert!(matches!(less(10.0, 11.9), Ruled::Undecided(_)));
        assert_eq!(less(10.0, 7.9), Ruled::Fails);
        assert_eq!(less(0.5, 0.61), Ruled::Holds);
        assert!(matches!(less(0.5, 0.59), Ruled::Undecided(_)));
    }

    #[test]
    fn one_of_several_is_enough_and_all_must_fail() {
        let part = |run: &str, right: f64| {
            format!("{{ kind = 'less', left = {{ run = '{run}', quantity = 'x' }}, right = {right} }}")
        };
        let any = |parts: [String; 2]| one_value(&format!("kind = 'any'\nrules = [{}]", parts.join(", ")));
        let (holds, fails, open) = (part("one", 2.0), part("one", 0.5), part("one", 1.1));
        let missing = part("two", 2.0);
        assert_eq!(any([fails.clone(), holds.clone()]), Ruled::Holds);
        assert_eq!(any([missing.clone(), holds]), Ruled::Holds);
        assert_eq!(any([fails.clone(), fails.clone()]), Ruled::Fails);
        assert!(matches!(any([open, fails.clone()]), Ruled::Undecided(_)));
        assert!(matches!(any([fails, missing]), Ruled::Undecided(_)));
    }

    /// Rules within rules: {left2} is of the second rule, {left21} of the second within the first.
    #[test]
    fn a_word_is_of_the_rule_of_its_number() {
        let part = |right: f64| format!("{{ kind = 'less', left = 0, right = {right} }}");
        let inner = format!("{{ kind = 'any', rules = [{}, {}] }}", part(1.0), part(2.0));
        let rule: Rule = toml::from_str(&format!("kind = 'all'\nrules = [{inner}, {}]", part(3.0))).unwrap();
        let (_, words) = ruled(&rule, &Answers::new());
        let of = |name: &str| words.iter().find(|(word, _)| word == name).unwrap().1.clone();
        assert_eq!(
            ["{right}", "{right1}", "{right2}", "{right11}", "{right21}"].map(of),
            ["1", "1", "3", "1", "2"]
        );
        let mut named: Vec<String> = words.iter().map(|(word, _)| word.clone()).collect();
        named.sort();
        named.dedup();
        let known = placeholders(&rule).into_iter().map(|word| format!("{{{word}}}"));
        assert_eq!(known.collect::<std::collections::BTreeSet<_>>(), named.into_iter().collect());
    }

    #[test]
    fn a_part_of_a_value_is_not_below_zero() {
        let valued =
            |value| crate::answer::Valued { value, error: Some(3e-4), unit: "m".to_owned(), varies: false };
        let of = |value: f64| {
            let mut answer = Answer { status: "finished".to_owned(), ..Answer::default() };
            answer.values.insert("x".to_owned(), Ok(valued(value)));
            answer
        };
        let (one, other) = (of(1.0), of(1.0001));
        let answers: Answers<'_> =
            [("one".to_owned(), (Some(&one), None)), ("other".to_owned(), (Some(&other), None))]
                .into_iter()
                .collect();
        let rule: Rule = toml::from_str(
            "kind = 'within'\nof = { run = 'one', quantity = 'x', to = 'other', as = 'relative-difference' }\nlow = 0\nhigh = 0.01",
        )
        .unwrap();
        assert_eq!(ruled(&rule, &answers).0, Ruled::Holds);
    }
}
