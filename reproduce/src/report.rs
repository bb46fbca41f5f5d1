//! The report: one page, and tables as CSV.

use crate::answer::Answer;
use crate::check::of_item;
use crate::command::command;
use crate::described::{As, Described, Item, ItemKind};
use crate::figure::{curves, figure, points};
use crate::html::Html;
use crate::need::{named, of_paper, runs};
use crate::rule::Ruled;
use crate::shown::{plain, shown};
use crate::table::filled;
use crate::term::{Answers, Missing};
use crate::verdict::{Verdict, judged};
use flexion_results::{Artifact, Directory, OutputError, VERSION};
use std::path::PathBuf;

/// Rows beyond which a table scrolls, and columns beyond which it lies across on paper.
const LONG: usize = 16;
const BROAD: usize = 6;
/// Widths of figures with several panels and with one [mm].
const WIDE: f64 = 240.0;
const NARROW: f64 = 150.0;
const PAGE: &str = include_str!("report.html");

/// A paper with its answers.
pub struct Reproduced<'a> {
    /// The paper.
    pub paper: &'a Described,
    /// The answers of its runs; `None` where one was not asked for.
    pub answers: &'a [Option<Answer>],
    /// The items that are reported.
    pub items: Vec<String>,
}

impl Reproduced<'_> {
    fn each(&self) -> impl Iterator<Item = (&str, &Item, Answers<'_>)> {
        let (needs, numbers) = of_paper(self.paper);
        let items = self.paper.items.iter().filter(|(id, _)| self.items.contains(id));
        items.map(move |(id, item)| (id.as_str(), item, of_item(id, item, (&needs, &numbers), self.answers)))
    }

    /// The verdicts on all claims, by item.
    pub fn verdicts(&self) -> Vec<(String, Verdict)> {
        let of = |(id, item, answers): (&str, &Item, Answers<'_>)| {
            item.claims.iter().map(|claim| (id.to_owned(), judged(claim, &answers))).collect::<Vec<_>>()
        };
        self.each().flat_map(of).collect()
    }

    /// What came out, in numbers.
    pub fn counts(&self) -> Counts {
        let mut out = Counts::default();
        for (_, item, answers) in self.each() {
            out.results += usize::from(item.kind != ItemKind::Drawing);
            for claim in &item.claims {
                let of = if claim.ours { &mut out.ours } else { &mut out.paper };
                let word = judged(claim, &answers).word();
                for (count, _) in of.iter_mut().zip(WORDS).filter(|(_, other)| *other == word) {
                    *count += 1;
                }
            }
        }
        out
    }
}

/// Verdicts in numbers, in the order of [`Counts::NAMES`]: those on the claims of papers, and those on claims of ours beside them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Figures and tables that are no drawings.
    pub results: usize,
    /// Claims of the paper.
    pub paper: [usize; 5],
    /// Claims of ours.
    pub ours: [usize; 5],
}

impl Counts {
    /// What is counted.
    pub const NAMES: [&str; 5] = ["holds", "does not hold", "not decided", "lost", "not run"];

    /// The sum of both.
    pub fn plus(self, other: Counts) -> Counts {
        let sum = |a: [usize; 5], b: [usize; 5]| std::array::from_fn(|i| a[i] + b[i]);
        Counts {
            results: self.results + other.results,
            paper: sum(self.paper, other.paper),
            ours: sum(self.ours, other.ours),
        }
    }
}

/// Writes `report.html` and the tables into a directory of [`Artifact::REPORT`], whole or not at all, and returns the files.
///
/// # Errors
/// [`OutputError`]
pub fn write(papers: &[Reproduced<'_>], directory: &Directory) -> Result<Vec<PathBuf>, OutputError> {
    let mut files = Vec::new();
    let mut put = |name: &str, bytes: &[u8]| {
        directory.write_named(name, |file| file.write_all(bytes))?;
        files.push(directory.path().join(name));
        Ok::<(), OutputError>(())
    };
    put(&Artifact::Claims.file_name(), claims_table(papers).as_bytes())?;
    for paper in papers {
        for (id, item, answers) in paper.each() {
            for (name, text) in tables(item, &answers) {
                put(&format!("{}_{id}{name}.csv", paper.paper.name), text.as_bytes())?;
            }
        }
    }
    put(&Artifact::Report.file_name(), page(papers).as_bytes())?;
    directory.publish()?;
    Ok(files)
}

fn csv(rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut out = csv::Writer::from_writer(Vec::new());
    for row in rows {
        // Memory does not refuse, and rows may differ in length only by a fault of ours.
        let _ = out.write_record(&row);
    }
    out.into_inner().ok().and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_default()
}

fn claims_table(papers: &[Reproduced<'_>]) -> String {
    let head = ["paper", "item", "whose", "claim", "place", "printed", "verdict", "found"]
        .map(String::from)
        .to_vec();
    let mut rows = vec![head];
    for paper in papers {
        for (id, item, answers) in paper.each() {
            for claim in &item.claims {
                let verdict = judged(claim, &answers);
                rows.push(vec![
                    paper.paper.name.clone(),
                    id.to_owned(),
                    if claim.ours { "ours" } else { "the paper's" }.to_owned(),
                    claim.text.clone(),
                    claim.place.clone().unwrap_or_default(),
                    claim.value.clone().unwrap_or_default(),
                    verdict.name().to_owned(),
                    verdict.sentence,
                ]);
            }
        }
    }
    csv(rows.into_iter())
}

/// The tables of an item: what is added to its name, and the text.
fn tables(item: &Item, answers: &Answers<'_>) -> Vec<(String, String)> {
    let mut out = Vec::new();
    let number = |number: &f64| format!("{number:?}");
    let known = |error: Option<f64>| error.map(|error| number(&error)).unwrap_or_default();
    let drawn = curves(item, answers);
    if !drawn.is_empty() {
        let head = ["run", "column", "unit", "time [s]", "value", "±"].map(String::from).to_vec();
        let rows = drawn.iter().flat_map(|drawn| {
            let curve = drawn.curve;
            (0..curve.t.len()).map(move |i| {
                let off = curve.off.get(i).copied().filter(|off| off.is_finite());
                let unit = curve.unit.clone();
                vec![
                    drawn.run.clone(),
                    drawn.column.to_owned(),
                    unit,
                    number(&curve.t[i]),
                    number(&curve.y[i]),
                    known(off),
                ]
            })
        });
        out.push(("_curves".to_owned(), csv(std::iter::once(head).chain(rows))));
    }
    let over: Vec<Vec<String>> = item
        .plots
        .iter()
        .filter_map(|plot| Some((plot, plot.x.as_ref()?)))
        .flat_map(|(plot, x)| {
            points(item, plot, answers).into_iter().map(move |(run, found)| {
                let at = run.of.get(x).map(crate::need::plain).unwrap_or_default();
                let (value, error, unit) = found.map_or_else(
                    |_| Default::default(),
                    |found| (number(&found.value), known(found.error), found.unit),
                );
                vec![run.name, x.clone(), at, plot.y.clone(), value, error, unit]
            })
        })
        .collect();
    if !over.is_empty() {
        let head = ["run", "over", "at", "quantity", "value", "±", "unit"].map(String::from).to_vec();
        out.push(("_points".to_owned(), csv(std::iter::once(head).chain(over))));
    }
    if let Some(table) = filled(item, answers) {
        let titles = table.titles.iter().flat_map(|title| [title.clone(), format!("± {title}")]);
        let head: Vec<String> = std::iter::once("run".to_owned()).chain(titles).collect();
        let rows = table.rows.iter().map(|(run, cells)| {
            let cells = cells.iter().flat_map(|cell| match cell {
                Ok(of) => {
                    let factor = if of.part { 100.0 } else { 1.0 };
                    [number(&(factor * of.value)), known(of.error.map(|error| factor * error))]
                }
                Err(_) => [String::new(), String::new()],
            });
            std::iter::once(run.clone()).chain(cells).collect()
        });
        out.push(("_table".to_owned(), csv(std::iter::once(head).chain(rows))));
    }
    out
}

fn page(papers: &[Reproduced<'_>]) -> String {
    let mut out = Html::default();
    contents(papers, &mut out);
    for paper in papers {
        let Described { name, paper: of, .. } = paper.paper;
        out.raw(&format!("<section class=paper data-paper=\"{}\">", anchor(name)))
            .element(&format!("h2 id=\"{}\"", anchor(name)), &format!("{name}. {}", of.title));
        out.raw("<p class=source>").text(&format!("{}. {}.", of.authors, of.source));
        if let Some(doi) = &of.doi {
            out.raw(" ").element(
                &format!("a href=\"https://doi.org/{}\"", crate::html::escaped(doi)),
                &format!("doi:{doi}"),
            );
        }
        out.raw("</p>").element("p", &of.about);
        if !of.notes.is_empty() {
            out.raw("<details><summary>Errata, and what the paper leaves open</summary><ul>");
            for note in &of.notes {
                out.element("li", note);
            }
            out.raw("</ul></details>");
        }
        for (id, item, answers) in paper.each() {
            item_section(name, id, item, &answers, paper, &mut out);
        }
        out.raw("</section>");
    }
    PAGE.replace("{{version}}", VERSION).replace("{{body}}", &out.0)
}

fn anchor(text: &str) -> String {
    text.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '-' }).collect()
}

const WORDS: [&str; 5] = ["holds", "fails", "undecided", "lost", "not-run"];

/// What came out, paper by paper, what may be shown of it, and where everything stands.
fn contents(papers: &[Reproduced<'_>], out: &mut Html) {
    out.raw("<section id=summary><h2>What came out</h2><div class=wide><table><thead><tr><th rowspan=2>Paper<th rowspan=2>Results<th colspan=5>Claims of the paper<th colspan=5>Claims of ours, beside it</tr><tr>");
    for name in Counts::NAMES.iter().chain(&Counts::NAMES) {
        out.element("th class=count", name);
    }
    out.raw("</tr></thead><tbody>");
    let mut all = Counts::default();
    let row = |of: &Counts, out: &mut Html| {
        out.element("td class=number", &of.results.to_string());
        for count in of.paper.iter().chain(&of.ours) {
            out.element(
                if *count == 0 { "td class=\"number none\"" } else { "td class=number" },
                &count.to_string(),
            );
        }
        out.raw("</tr>");
    };
    for paper in papers {
        let counts = paper.counts();
        all = all.plus(counts);
        let Described { name, paper: of, .. } = paper.paper;
        out.raw("<tr><td>")
            .element(&format!("a href=\"#{}\"", anchor(name)), name)
            .raw(" <span class=title>")
            .text(&of.title)
            .raw("</span></td>");
        row(&counts, out);
    }
    if papers.len() > 1 {
        out.raw("<tr class=sum><td>All</td>");
        row(&all, out);
    }
    out.raw("</tbody></table></div></section>");
    filters(papers, out);
    out.raw("<nav id=contents aria-label=Contents><h2>Contents</h2>");
    for paper in papers {
        out.raw(&format!("<div class=of data-paper=\"{}\"><h3>", anchor(&paper.paper.name)))
            .element(&format!("a href=\"#{}\"", anchor(&paper.paper.name)), &paper.paper.name)
            .raw("</h3><ul>");
        for (id, item, answers) in paper.each() {
            let name = format!("{} {id}", paper.paper.name);
            out.raw(&format!("<li data-of=\"{}\">", anchor(&name)))
                .element(&format!("a href=\"#{}\"", anchor(&name)), &format!("{id} {}", item.title));
            for (i, claim) in item.claims.iter().enumerate() {
                let verdict = judged(claim, &answers);
                out.raw(&format!(
                    " <a class=\"dot {}\" href=\"#{}-{}\" title=\"{}: {}\">{}</a>",
                    verdict.word(),
                    anchor(&name),
                    i + 1,
                    crate::html::escaped(verdict.name()),
                    crate::html::escaped(&claim.text),
                    sign(&verdict)
                ));
            }
            out.raw("</li>");
        }
        out.raw("</ul></div>");
    }
    out.raw("</nav><section id=claims><h2>All claims</h2><div class=\"wide long\"><table class=sortable><thead><tr><th>Item<th>Whose<th>Claim<th>Printed<th>Verdict<th>Found</tr></thead><tbody>");
    for paper in papers {
        for (id, item, answers) in paper.each() {
            for (i, claim) in item.claims.iter().enumerate() {
                let verdict = judged(claim, &answers);
                let name = format!("{} {id}", paper.paper.name);
                out.raw(&format!("<tr{}><td>", marks(&paper.paper.name, claim, &verdict)))
                    .element(&format!("a href=\"#{}-{}\"", anchor(&name), i + 1), &name)
                    .raw("</td>");
                out.element("td", if claim.ours { "ours" } else { "the paper’s" });
                out.element("td", &claim.text).element("td", claim.value.as_deref().unwrap_or(""));
                badge(&verdict, "td", out);
                out.element("td", &verdict.sentence).raw("</tr>");
            }
        }
    }
    out.raw("</tbody></table></div></section>");
}

/// Boxes that say which claims are shown.
fn filters(papers: &[Reproduced<'_>], out: &mut Html) {
    let boxes = |title: &str, kind: &str, all: &[(String, String)], out: &mut Html| {
        out.raw(&format!("<fieldset><legend>{title}</legend>"));
        for (value, name) in all {
            out.raw(&format!("<label><input type=checkbox checked data-{kind}=\"{value}\"> "))
                .text(name)
                .raw("</label>");
        }
        out.raw("</fieldset>");
    };
    let words: Vec<(String, String)> =
        WORDS.iter().zip(Counts::NAMES).map(|(word, name)| ((*word).to_owned(), name.to_owned())).collect();
    let of: Vec<(String, String)> =
        papers.iter().map(|paper| (anchor(&paper.paper.name), paper.paper.name.clone())).collect();
    let whose = [("paper".to_owned(), "the paper’s".to_owned()), ("ours".to_owned(), "ours".to_owned())];
    out.raw("<form id=filter hidden><span>Show</span>");
    boxes("Verdict", "verdict", &words, out);
    boxes("Claims", "whose", &whose, out);
    boxes("Paper", "paper", &of, out);
    out.raw("<output id=shown></output></form>");
}

/// What the filter asks of a claim.
fn marks(paper: &str, claim: &crate::described::Claim, verdict: &Verdict) -> String {
    let whose = if claim.ours { "ours" } else { "paper" };
    format!(" data-paper=\"{}\" data-verdict=\"{}\" data-whose={whose}", anchor(paper), verdict.word())
}

/// A sign for a verdict, which says it without colour.
fn sign(verdict: &Verdict) -> &'static str {
    match verdict.ruled {
        Ruled::Holds => "✓",
        Ruled::Fails => "✗",
        Ruled::Undecided(_) => "?",
        Ruled::Lost(_) => "–",
        Ruled::NotRun(_) => "…",
    }
}

fn badge(verdict: &Verdict, element: &str, out: &mut Html) {
    out.raw(&format!("<{element}><span class=\"verdict {}\">", verdict.word()))
        .text(verdict.name())
        .raw(&format!("</span></{element}>"));
}

fn item_section(
    paper: &str,
    id: &str,
    item: &Item,
    answers: &Answers<'_>,
    of: &Reproduced<'_>,
    out: &mut Html,
) {
    let name = format!("{paper} {id}");
    let number = id.trim_start_matches(|letter: char| letter.is_alphabetic());
    let kind = if item.kind == ItemKind::Table { "Table" } else { "Figure" };
    out.raw(&format!("<article id=\"{}\" data-paper=\"{}\"><h3>", anchor(&name), anchor(paper)))
        .text(&format!("{paper}, {} {number}: {}", kind.to_lowercase(), item.title))
        .raw(" <a class=up href=\"#contents\" title=\"Contents\">↑</a></h3>");
    for (what, text) in [("Of the paper: ", &item.survives), ("Chosen: ", &item.chosen)] {
        if let Some(text) = text {
            out.raw("<p class=note><strong>").text(what).raw("</strong>").text(text).raw("</p>");
        }
    }
    if let Some(drawing) = item.drawing.as_ref().and_then(|file| of.paper.drawings.get(file)) {
        out.raw("<figure class=drawing>")
            .raw(&picture(drawing))
            .element("figcaption", "Our drawing.")
            .raw("</figure>");
    }
    if let Some(figure) = figure(item, answers) {
        out.raw("<figure class=plot>")
            .raw(&figure.draw_in(if figure.columns > 1 { WIDE } else { NARROW }).svg());
        let banded = figure
            .panels
            .iter()
            .flat_map(|panel| &panel.series)
            .any(|series| series.band.iter().any(|half| half.is_finite()));
        let caption = if banded {
            "Bands are the errors of the curves; where none is seen, it is thinner than the line."
        } else {
            ""
        };
        out.element("figcaption", caption).raw("</figure>");
    }
    table(item, answers, &name, out);
    if !item.claims.is_empty() {
        out.raw("<div class=claims>");
        for (i, claim) in item.claims.iter().enumerate() {
            let verdict = judged(claim, answers);
            let whose = if claim.ours { " ours" } else { "" };
            let marks = marks(paper, claim, &verdict);
            out.raw(&format!("<div class=\"claim{whose}\" id=\"{}-{}\"{marks}><p>", anchor(&name), i + 1));
            badge(&verdict, "span", out);
            out.raw(if claim.ours { " <span class=whose>Ours, beside the paper:</span> " } else { " " });
            out.text(&claim.text);
            let place = [claim.place.clone(), claim.value.as_ref().map(|value| format!("printed: {value}"))];
            let place: Vec<String> = place.into_iter().flatten().collect();
            if !place.is_empty() {
                out.raw(" ").element("span class=place", &format!("({})", place.join("; ")));
            }
            out.raw("</p>").element("p class=found", &verdict.sentence);
            if let Ruled::Undecided(why) = &verdict.ruled
                && !verdict.sentence.to_lowercase().contains(&why.to_lowercase())
            {
                out.element("p class=note", why);
            }
            out.raw("</div>");
        }
        out.raw("</div>");
    }
    run_details((id, item), answers, of, &name, out);
    out.raw("</article>");
}

/// A drawing as a picture, in which no script runs and which asks for nothing.
fn picture(svg: &str) -> String {
    use base64::Engine as _;
    format!(
        "<img alt=\"drawing\" src=\"data:image/svg+xml;base64,{}\">",
        base64::prelude::BASE64_STANDARD.encode(svg)
    )
}

fn table(item: &Item, answers: &Answers<'_>, name: &str, out: &mut Html) {
    let Some(table) = filled(item, answers) else { return };
    // A long table scrolls, a broad one lies across on paper.
    let size = [(table.rows.len() > LONG, " long"), (table.titles.len() > BROAD, " broad")];
    let size: String = size.into_iter().filter(|(is, _)| *is).map(|(_, word)| word).collect();
    out.raw(&format!("<div class=\"wide{size}\"><table class=sortable><thead><tr><th>Run"));
    for title in &table.titles {
        out.raw("<th class=number>").text(title);
    }
    out.raw("</tr></thead><tbody>");
    for (run, cells) in &table.rows {
        out.raw("<tr><td>").element(&format!("a href=\"#{}\"", run_anchor(name, run)), run).raw("</td>");
        for cell in cells {
            match cell {
                Ok(number) => {
                    let sorted = format!(
                        "td class=\"number{}\" data-value=\"{:e}\"",
                        if number.varies { " varies" } else { "" },
                        number.value
                    );
                    let text = shown(number);
                    // The unit stands in the head.
                    let unit = if number.part { "%" } else { &number.unit };
                    let text = text
                        .strip_suffix(&crate::shown::unit_shown(unit))
                        .unwrap_or(&text)
                        .trim_end()
                        .to_owned();
                    out.element(&sorted, &text);
                }
                Err(Missing::Long(seconds)) => {
                    out.element("td class=missing", &format!("not run: {seconds:.0} s, --long"));
                }
                Err(Missing::Because(why)) => {
                    out.element("td class=missing", why);
                }
            }
        }
        out.raw("</tr>");
    }
    out.raw("</tbody></table></div>");
    if item.table.iter().flat_map(|table| &table.columns).any(|column| column.quantity == "work.seconds") {
        out.element("p class=note", "Seconds are those of this machine, and differ from run to run; they decide beyond a factor of 2 only.");
    }
    let compared = item
        .table
        .iter()
        .flat_map(|table| &table.columns)
        .any(|column| column.compared == Some(As::RelativeDifference));
    if compared {
        out.element("p class=note", "A relative difference is |a/b − 1|.");
    }
}

fn run_anchor(name: &str, run: &str) -> String {
    format!("{}-run-{}", anchor(name), anchor(run))
}

/// Every run of an item: its command, its case, its errors and its warnings.
fn run_details(
    (id, item): (&str, &Item),
    answers: &Answers<'_>,
    of: &Reproduced<'_>,
    name: &str,
    out: &mut Html,
) {
    let all = runs(item);
    if all.is_empty() {
        return;
    }
    out.raw("<details class=runs><summary>")
        .text(&format!("Runs ({}): case, command, errors, warnings", named(item, None).len()));
    out.raw("</summary>");
    for run in &all {
        out.raw(&format!("<details id=\"{}\"><summary>", run_anchor(name, &run.name)))
            .text(&run.name)
            .raw("</summary>");
        out.element("pre class=command", &command(run, (&of.paper.name, &of.paper.place, id)));
        match answers.get(&run.name) {
            Some((Some(answer), _)) => {
                let mut said = answer.status.clone();
                if !answer.errors.is_empty() {
                    said = format!("{said}; errors: {}", answer.errors);
                }
                if let Some(message) = &answer.message {
                    said = format!("{said}. {message}");
                }
                out.element("p", &said);
                for (quantity, value) in &answer.values {
                    let text = match value {
                        Ok(value) => {
                            let number = crate::term::Number {
                                value: value.value,
                                error: value.error,
                                unit: value.unit.clone(),
                                part: false,
                                varies: value.varies,
                            };
                            shown(&number)
                        }
                        Err(why) => why.clone(),
                    };
                    out.raw("<p class=value><code>").text(quantity).raw("</code> ").text(&text).raw("</p>");
                }
                for warning in &answer.warnings {
                    out.element("p class=note", &format!("Warning: {warning}"));
                }
                out.raw("<details><summary>The case</summary>")
                    .element("pre", &answer.stated)
                    .raw("</details>");
                out.element(
                    "p class=\"note varies\"",
                    &if answer.seconds < 0.05 {
                        "less than 0.1 s here, errors included".to_owned()
                    } else {
                        format!("{} s here, errors included", plain((10.0 * answer.seconds).round() / 10.0))
                    },
                );
            }
            Some((None, seconds)) => {
                out.element("p", &format!("Not run: {:.0} s; --long runs it.", seconds.unwrap_or(0.0)));
            }
            None => {}
        }
        out.raw("</details>");
    }
    out.raw("</details>");
}
