//! Verdicts on the claims of a paper.

use crate::described::Claim;
use crate::rule::{Ruled, Words, ruled};
use crate::term::Answers;

/// A verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What came out.
    pub ruled: Ruled,
    /// A sentence about it, with values and their errors.
    pub sentence: String,
}

impl Verdict {
    /// Its name: `holds`, `does not hold`, …
    pub fn name(&self) -> &'static str {
        match self.ruled {
            Ruled::Holds => "holds",
            Ruled::Fails => "does not hold",
            Ruled::Undecided(_) => "cannot be decided at this error",
            Ruled::Lost(_) => "the paper's value is lost or cannot be repeated here",
            Ruled::NotRun(_) => "not run",
        }
    }

    /// A word for it without blanks.
    pub fn word(&self) -> &'static str {
        match self.ruled {
            Ruled::Holds => "holds",
            Ruled::Fails => "fails",
            Ruled::Undecided(_) => "undecided",
            Ruled::Lost(_) => "lost",
            Ruled::NotRun(_) => "not-run",
        }
    }
}

/// What was found, where a claim has no sentence for it: `left 1.2 ± 0.1 m, right 2 m`.
fn listed(words: &Words) -> String {
    let all = words.iter().map(|(name, value)| format!("{} {value}", name.trim_matches(['{', '}'])));
    all.collect::<Vec<_>>().join(", ")
}

/// The verdict on a claim.
pub fn judged(claim: &Claim, answers: &Answers<'_>) -> Verdict {
    let (ruled, words) = ruled(&claim.rule, answers);
    let filled =
        |text: &str| words.iter().fold(text.to_owned(), |text, (name, value)| text.replace(name, value));
    let mut sentence = match &ruled {
        Ruled::Holds => claim.holds.as_deref().map_or_else(|| listed(&words), filled),
        Ruled::Fails => claim.fails.as_deref().map_or_else(|| listed(&words), filled),
        Ruled::Undecided(why) => {
            let own = claim.undecided.as_deref().map(filled);
            own.map_or_else(|| format!("Not decided: {why}."), |own| format!("{own} ({why})"))
        }
        Ruled::Lost(because) => because.clone(),
        Ruled::NotRun(seconds) => format!("Not run: {seconds:.0} s, `--long`."),
    };
    if let (Some(because), Ruled::Holds | Ruled::Fails | Ruled::Undecided(_)) = (&claim.because, &ruled) {
        sentence = format!("{sentence} {because}").trim().to_owned();
    }
    Verdict { ruled, sentence }
}
