//! What has to be computed for a paper: its runs, each with all that its items ask of it.

use crate::described::{As, Described, Item, OfEnergy, OfModes, OfRun, Rule, Template, Term};
use std::collections::{BTreeMap, BTreeSet};

/// Most runs of an item.
const MOST_RUNS: f64 = 10_000.0;

/// A run, by all that its numbers depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Name of the case.
    pub case: String,
    /// Changes of it.
    pub set: Vec<String>,
    /// Changes that make the run that it is compared with; without, its companion with a finer mesh.
    pub against: Option<Vec<String>>,
    /// Frequencies in place of a run in time.
    pub asks: Asks,
}

/// What is computed of a case.
#[derive(Clone, Debug, PartialEq)]
pub enum Asks {
    /// A run in time.
    Run,
    /// Frequencies in steady rotation.
    Modes(String),
    /// Frequencies by a strain energy.
    Energy(String),
}

/// A run of an item.
#[derive(Clone, Debug)]
pub struct Named {
    /// Its name in the item.
    pub name: String,
    /// The same with `{key}` where values of `each` stand.
    pub pattern: String,
    /// What it is.
    pub key: Key,
    /// The values of `each` that it is of.
    pub of: BTreeMap<String, toml::Value>,
    /// Its number among the runs as they are written.
    pub template: usize,
    /// Whether its case may be refused.
    pub refused: bool,
    /// How long it takes, where that is long \[s\].
    pub seconds: Option<f64>,
    /// Its frequencies.
    pub modes: Option<OfModes>,
    /// Its strain energy.
    pub energy: Option<OfEnergy>,
}

/// What is needed of a run.
#[derive(Clone, Debug)]
pub struct Need {
    /// The first item that needs it.
    pub item: String,
    /// The run.
    pub run: Named,
    /// Its quantities.
    pub quantities: BTreeSet<String>,
    /// Its columns over time.
    pub columns: BTreeSet<String>,
}

/// All that these items of a paper need, each run once; its number for every run of every item.
pub fn needs<'a>(
    items: impl Iterator<Item = &'a (String, Item)>,
) -> (Vec<Need>, BTreeMap<(String, String), usize>) {
    let mut needs: Vec<Need> = Vec::new();
    let mut numbers = BTreeMap::new();
    for (id, item) in items {
        let (quantities, columns) = asked(item);
        for run in runs(item) {
            let of = |asked: &BTreeSet<(String, String)>| -> BTreeSet<String> {
                asked.iter().filter(|(name, _)| *name == run.name).map(|(_, what)| what.clone()).collect()
            };
            let (quantities, columns) = (of(&quantities), of(&columns));
            let number = needs.iter().position(|need| need.run.key == run.key);
            let number = number.unwrap_or_else(|| {
                let (quantities, columns) = (BTreeSet::new(), BTreeSet::new());
                needs.push(Need { item: id.clone(), run: run.clone(), quantities, columns });
                needs.len() - 1
            });
            let need = &mut needs[number];
            need.quantities.extend(quantities);
            need.columns.extend(columns);
            need.run.seconds = need.run.seconds.or(run.seconds);
            need.run.refused |= run.refused;
            numbers.insert((id.clone(), run.name), number);
        }
    }
    (needs, numbers)
}

/// The runs of an item.
pub fn runs(item: &Item) -> Vec<Named> {
    item.runs.iter().enumerate().flat_map(|(number, template)| expanded(number, template)).collect()
}

/// The names of the runs that are meant: all where none are named.
pub fn named(item: &Item, names: Option<&Vec<String>>) -> Vec<String> {
    names.cloned().unwrap_or_else(|| runs(item).into_iter().map(|run| run.name).collect())
}

fn expanded(number: usize, template: &Template) -> Vec<Named> {
    let mut all: Vec<BTreeMap<String, toml::Value>> = vec![BTreeMap::new()];
    for (key, values) in &template.each {
        all = all
            .into_iter()
            .flat_map(|of| {
                values.iter().map(move |value| {
                    let mut of = of.clone();
                    of.insert(key.clone(), value.clone());
                    of
                })
            })
            .collect();
    }
    all.into_iter()
        .map(|of| {
            let fill = |text: &String| filled(text, &of);
            let fill_value = |value: &toml::Value| match value {
                toml::Value::String(text) => toml::Value::String(fill(text)),
                other => other.clone(),
            };
            let mut modes = template.modes.clone();
            if let Some(modes) = &mut modes {
                modes.speed = fill_value(&modes.speed);
            }
            let mut energy = template.strain_energy.clone();
            if let Some(energy) = &mut energy {
                energy.speed = fill_value(&energy.speed);
            }
            let asks = match (&modes, &energy) {
                (Some(modes), _) => Asks::Modes(format!("{modes:?}")),
                (_, Some(energy)) => Asks::Energy(format!("{energy:?}")),
                _ => Asks::Run,
            };
            let key = Key {
                case: fill(&template.case),
                set: template.set.iter().map(fill).collect(),
                against: template.against.as_ref().map(|against| against.iter().map(fill).collect()),
                asks,
            };
            Named {
                name: fill(&template.name),
                pattern: template.name.clone(),
                key,
                template: number,
                refused: template.refused,
                seconds: template.seconds,
                modes,
                energy,
                of,
            }
        })
        .collect()
}

/// A text with `{key}` replaced by its value.
pub fn filled(text: &str, of: &BTreeMap<String, toml::Value>) -> String {
    of.iter().fold(text.to_owned(), |text, (key, value)| text.replace(&format!("{{{key}}}"), &plain(value)))
}

/// A value as it stands in a name.
pub fn plain(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

type Asked = BTreeSet<(String, String)>;

/// The quantities and the columns that an item asks of its runs.
pub fn asked(item: &Item) -> (Asked, Asked) {
    let (mut quantities, mut columns) = (Asked::new(), Asked::new());
    for plot in item.plots.iter().filter(|plot| plot.x.is_none()) {
        columns.extend(named(item, plot.runs.as_ref()).into_iter().map(|run| (run, plot.y.clone())));
    }
    for OfRun { run, quantity, to, compared } in terms(item) {
        let curve = compared == Some(As::CurveDifference);
        let list = if curve { &mut columns } else { &mut quantities };
        let what = if curve { crate::term::column(&quantity) } else { &quantity };
        list.extend(std::iter::once(run).chain(to).map(|run| (run, what.to_owned())));
    }
    (quantities, columns)
}

/// The quantities of runs in the plots over what is varied, in the table and in the claims of an item, with what they are compared with.
pub fn terms(item: &Item) -> Vec<OfRun> {
    let all: BTreeMap<String, BTreeMap<String, toml::Value>> =
        runs(item).into_iter().map(|run| (run.name, run.of)).collect();
    let none = BTreeMap::new();
    // The run that one is compared with may be named by what the one is of.
    let term = |run: String, to: Option<String>, quantity: &String, compared: Option<As>| {
        let to = to.map(|to| filled(&to, all.get(&run).unwrap_or(&none)));
        OfRun { run, quantity: quantity.clone(), to, compared }
    };
    let mut out = Vec::new();
    for plot in item.plots.iter().filter(|plot| plot.x.is_some()) {
        let to = || plot.to.as_ref().filter(|_| plot.compared.is_some()).map(plain);
        out.extend(
            named(item, plot.runs.as_ref()).into_iter().map(|run| term(run, to(), &plot.y, plot.compared)),
        );
    }
    if let Some(table) = &item.table {
        for run in named(item, table.runs.as_ref()) {
            let columns = table.columns.iter();
            out.extend(columns.map(|of| term(run.clone(), of.to.clone(), &of.quantity, of.compared)));
        }
    }
    for claim in &item.claims {
        of_rule(&claim.rule, &mut |of: &OfRun| out.push(of.clone()));
    }
    out
}

/// Whether what a rule gives may differ from run to run, as times of computing do.
pub fn varies(rule: &Rule) -> bool {
    let mut varies = false;
    of_rule(rule, &mut |of| varies |= of.quantity == "work.seconds");
    varies
}

/// Shows all terms of a rule.
pub fn of_rule(rule: &Rule, see: &mut dyn FnMut(&OfRun)) {
    let mut term = |term: &Term| {
        if let Term::Of(of) = term {
            see(of)
        }
    };
    match rule {
        Rule::Less { left, right, .. } => {
            term(left);
            term(right);
        }
        Rule::Within { of, .. } => term(of),
        Rule::Agree { .. } | Rule::Grows { .. } | Rule::Falls { .. } => {
            crate::rule::terms(rule).iter().for_each(see);
        }
        Rule::EndsEarly { .. } | Rule::Finishes { .. } | Rule::Lost { .. } => {}
        Rule::All { rules } | Rule::Any { rules } => rules.iter().for_each(|rule| of_rule(rule, see)),
    }
}

/// The runs that a rule names besides those of its terms.
pub fn named_by(rule: &Rule) -> Vec<&String> {
    match rule {
        Rule::EndsEarly { runs } | Rule::Finishes { runs } => runs.iter().collect(),
        Rule::All { rules } | Rule::Any { rules } => rules.iter().flat_map(named_by).collect(),
        _ => Vec::new(),
    }
}

/// What is wrong with an item by itself.
pub fn problems(item: &Item) -> Vec<String> {
    let mut out = Vec::new();
    let count =
        |template: &Template| template.each.values().map(|values| values.len() as f64).product::<f64>();
    let all: f64 = item.runs.iter().map(count).sum();
    if all > MOST_RUNS {
        return vec![format!("it has {all:.0} runs, and at most {MOST_RUNS:.0} are taken")];
    }
    for template in &item.runs {
        out.extend(contradictions(template).map(|problem| format!("run `{}`: {problem}", template.name)));
    }
    let names: Vec<String> = runs(item).into_iter().map(|run| run.name).collect();
    for template in &item.runs {
        for key in
            template.name.split('{').skip(1).filter_map(|rest| rest.split_once('}')).map(|(key, _)| key)
        {
            if !template.each.contains_key(key) {
                out.push(format!("run `{}`: `{{{key}}}` is no key of its `each`", template.name));
            }
        }
    }
    for (i, name) in names.iter().enumerate() {
        if names[..i].contains(name) {
            out.push(format!(
                "two runs are called `{name}`: give them two names, and with `each` its values in them"
            ));
        }
    }
    let (quantities, columns) = asked(item);
    let ends = item.claims.iter().flat_map(|claim| named_by(&claim.rule));
    let mut unknown: Vec<&String> =
        quantities.iter().chain(&columns).map(|(run, _)| run).chain(ends).collect();
    unknown.sort();
    unknown.dedup();
    for run in unknown.into_iter().filter(|run| !names.contains(run)) {
        let nearest = flexion_results::nearest(run, names.iter().map(String::as_str));
        let nearest = nearest.map_or(String::new(), |name| format!("; perhaps `{name}`"));
        out.push(format!("no run is called `{run}`{nearest}"));
    }
    for of in item.plots.iter().filter_map(|plot| plot.x.as_ref()) {
        if !item.runs.iter().any(|run| run.each.contains_key(of)) {
            out.push(format!("a plot over `{of}` needs runs with `each = {{ {of} = [...] }}`"));
        }
    }
    let both = |to: bool, compared: bool, what: &str| {
        (to != compared).then(|| format!("{what}: `to` and `as` belong together"))
    };
    for column in item.table.iter().flat_map(|table| &table.columns) {
        out.extend(both(column.to.is_some(), column.compared.is_some(), &column.title));
    }
    for claim in &item.claims {
        of_rule(&claim.rule, &mut |of| out.extend(both(of.to.is_some(), of.compared.is_some(), &claim.text)));
        out.extend(empty(&claim.rule).map(|problem| format!("{}: {problem}", claim.text)));
    }
    out
}

/// What of a run contradicts itself or says nothing.
fn contradictions(template: &Template) -> impl Iterator<Item = String> {
    let both = template.modes.is_some() && template.strain_energy.is_some();
    let both = both
        .then(|| "`modes` and `strain-energy` ask for different frequencies: make it two runs".to_owned());
    let none = template.each.iter().filter(|(_, values)| values.is_empty());
    let none = none
        .map(|(key, _)| format!("`each` has no value of `{key}`, and so there is no run"))
        .collect::<Vec<_>>();
    let seconds = template.seconds.filter(|seconds| !(*seconds > 0.0 && seconds.is_finite()));
    let seconds = seconds.map(|seconds| format!("`seconds` is {seconds}: a positive time is asked"));
    both.into_iter().chain(none).chain(seconds)
}

/// What is wrong with a rule that says nothing.
fn empty(rule: &Rule) -> Option<String> {
    match rule {
        Rule::Agree { runs, .. } | Rule::Grows { runs, .. } | Rule::Falls { runs, .. } if runs.len() < 2 => {
            Some("its rule compares runs, and needs two of them".to_owned())
        }
        Rule::EndsEarly { runs } | Rule::Finishes { runs } if runs.is_empty() => {
            Some("its rule needs a run".to_owned())
        }
        Rule::All { rules } | Rule::Any { rules } if rules.is_empty() => {
            Some("`all` and `any` need a rule".to_owned())
        }
        Rule::All { rules } | Rule::Any { rules } => rules.iter().find_map(empty),
        Rule::Within { low, high, .. } if !(low <= high) => Some(format!("{low} to {high} is no interval")),
        Rule::Agree { within, .. } if !(*within > 0.0) => Some(format!("nothing agrees within {within}")),
        Rule::Less { times: Some(times), .. } if !(*times > 0.0 && times.is_finite()) => {
            Some(format!("`times` is {times}: a positive factor is asked"))
        }
        Rule::Less { left, right, .. } => {
            let nan =
                [left, right].into_iter().any(|term| matches!(term, Term::Number(number) if number.is_nan()));
            nan.then(|| "NaN is compared with nothing".to_owned())
        }
        _ => None,
    }
}

/// What a rule gives for sentences; of several rules the first that has a word, and of each the word with its number.
pub fn placeholders(rule: &Rule) -> Vec<String> {
    let words: &[&str] = match rule {
        Rule::Less { .. } => &["left", "right"],
        Rule::Within { .. } => &["of", "low", "high"],
        Rule::Agree { .. } | Rule::Grows { .. } | Rule::Falls { .. } => &["least", "most", "first", "last"],
        Rule::EndsEarly { .. } | Rule::Finishes { .. } | Rule::Lost { .. } => &[],
        Rule::All { rules } | Rule::Any { rules } => {
            let each = rules.iter().enumerate().flat_map(|(i, rule)| {
                placeholders(rule).into_iter().flat_map(move |word| {
                    let numbered = format!("{word}{}", i + 1);
                    let plain = !word.ends_with(|c: char| c.is_ascii_digit());
                    plain.then_some(word).into_iter().chain([numbered])
                })
            });
            let mut all: Vec<String> = each.collect();
            all.sort();
            all.dedup();
            return all;
        }
    };
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// All runs of a paper.
pub fn of_paper(described: &Described) -> (Vec<Need>, BTreeMap<(String, String), usize>) {
    needs(described.items.iter())
}
