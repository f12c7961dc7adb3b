//! A task and its trajectories as one page for a browser: what `--format html` writes.
//!
//! The page shows the automaton, what each state still asks for, and for each trajectory the states,
//! the predicates and the robustness over time, with a slider through them. It is one file: it asks
//! no network for anything, keeps to the light or dark ground that the reader has chosen, and
//! without scripts it still shows all but the trajectories.
//!
//! The texts and the drawing are made here; `page.css` and `page.js` lay them out and draw the lines.
//! Long trajectories are thinned by the rule of [`MOST_PIECES`], of many the first
//! [`MOST_TRAJECTORIES`] are shown, and states are explained up to [`MOST_STATES`]; the page says
//! so. Names that could be read as HTML, or that change the direction of text, are shown as text.

mod record;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Serialize;
use tltl_compiler::dfa::{Dfa, Size, State};
use tltl_compiler::source::visible;
use tltl_compiler::translate::Budget;

use crate::emit::json;
use crate::emit::svg::{self, Circle, Options};
use crate::evaluate::{Columns, NotANumber, Scratch};
use crate::explain::{self, Explanation, MOST_STATES, StateExplanation};
use crate::online::Online;
use crate::task::{Running, Task, Verdict};
use crate::trace::Trace;

pub use record::{MOST_PIECES, Row, Trajectory};

/// The most trajectories of a page. A page of megabytes is slow, and nobody looks at more.
pub const MOST_TRAJECTORIES: usize = 50;

/// The most states and edges of an automaton whose picture is shown. A larger one is megabytes that
/// nobody reads.
const MOST_DRAWN: (usize, usize) = (64, 256);

const STYLE: &str = include_str!("report/page.css");
const SCRIPT: &str = include_str!("report/page.js");

/// A page about a task, without its trajectories.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::evaluate::{Columns, Scratch};
/// use tltlc::report::{Page, follow};
///
/// let task = tltlc::task::compile("(x < 1) T (x > 2)", Budget::default())?;
/// let x = Columns::of_rows(4, 1, &[3.0, 0.0, 1.5, 2.5])?;
/// let walk = follow(&task, "a walk", &x, &mut Scratch::default())?;
/// let html = Page::of_task(&task).html(&[walk]);
/// assert!(html.starts_with("<!doctype html>") && html.contains("<title>(x &lt; 1) T (x &gt; 2)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// The task as its author wrote it; the first line is the title of the page.
    pub title: String,
    /// The task in plain English, one string a line; may be empty.
    pub words: Vec<String>,
    /// The names of its propositions, in their order.
    pub propositions: Vec<String>,
    /// Its automaton, if there is one.
    pub dfa: Option<&'a Dfa>,
    /// The number of trajectories that there are, if that is more than are given.
    pub of: usize,
}

impl<'a> Page<'a> {
    /// The page about a task that runs.
    #[must_use]
    pub fn of_task(task: &'a Task) -> Self {
        let parts = task.entry().task();
        let name = parts.name.as_ref().map(|name| format!("{name} = ")).unwrap_or_default();
        // The formula of an automaton of another tool means nothing.
        let words = match task.entry().is_automaton() {
            true => Vec::new(),
            false => explain::retold(&parts.spec),
        };
        Self {
            title: format!("{name}{}", parts.text),
            words,
            propositions: names(task.dfa()),
            dfa: Some(task.dfa()),
            of: 0,
        }
    }

    /// The page with these trajectories, of which the first [`MOST_TRAJECTORIES`] are shown.
    #[must_use]
    pub fn html(&self, trajectories: &[Trajectory]) -> String {
        let shown = &trajectories[..trajectories.len().min(MOST_TRAJECTORIES)];
        let mut states: Vec<State> = shown.iter().flat_map(Trajectory::states).collect();
        let mut seen = rustc_hash::FxHashSet::default();
        states.extend(self.dfa.into_iter().flat_map(Dfa::states).take(MOST_STATES));
        states.retain(|&state| seen.insert(state));
        states.truncate(MOST_STATES);
        states.sort_unstable();
        let told = self.dfa.map(|dfa| explain::of_states(dfa, &states)).unwrap_or_default();
        self.written(shown, trajectories.len().max(self.of), &told, "")
    }

    /// The whole page; `more` is HTML that stands at its end.
    fn written(
        &self,
        shown: &[Trajectory],
        of: usize,
        told: &[StateExplanation],
        more: &str,
    ) -> String {
        let (title, (automaton, circles)) = (escaped(&self.title), self.automaton());
        let first = title.lines().next().unwrap_or_default();
        let data = Data {
            propositions: self.propositions.iter().map(|name| visible(name).into_owned()).collect(),
            accepting: self.dfa.and_then(|dfa| dfa.accepting),
            trap: self.dfa.and_then(|dfa| dfa.trap),
            moves: self.moves(shown),
            circles,
            of,
            trajectories: shown.iter().map(Trajectory::columns).collect(),
        };
        // In a script no tag is read but its own end.
        let data = json::line(&data).replace('<', "\\u003c");
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; \
             style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n\
             <title>{first}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
             <header>\n<h1>{title}</h1>\n{words}</header>\n<main>\n\
             <section id=\"player\" hidden></section>\n{automaton}\
             <section id=\"tracks\" hidden></section>\n{asks}{more}</main>\n\
             <noscript><p>Trajectories are drawn by a script, and scripts are off.</p></noscript>\n\
             <script type=\"application/json\" id=\"data\">{data}</script>\n\
             <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
            words = self.words_shown(),
            asks = self.asks(told),
        )
    }

    fn words_shown(&self) -> String {
        match self.words.is_empty() {
            true => String::new(),
            false => format!("<p class=\"words\">{}</p>\n", escaped(&self.words.join("\n"))),
        }
    }

    /// The picture of the automaton beside the place for what is asked now, and its circles.
    fn automaton(&self) -> (String, Vec<(State, f64, f64, f64)>) {
        let Some(dfa) = self.dfa else {
            let note = "<p class=\"note\">Its automaton is larger than the budget allows, so there \
                        are no states here, and what is not satisfied may be lost.</p>\n";
            return (note.to_owned(), Vec::new());
        };
        let Size { states, edges, self_loops, .. } = dfa.size();
        let trap = if dfa.trap.is_some() { ", the trap among them" } else { "" };
        let sizes = format!("{states} states{trap}; {edges} edges and {self_loops} loops");
        let aside = "<aside id=\"now\" aria-live=\"polite\" hidden></aside>";
        if states > MOST_DRAWN.0 || edges > MOST_DRAWN.1 {
            let note = format!(
                "<section class=\"beside\">\n{aside}\n</section>\n\
                 <p class=\"note\">Its automaton has {sizes}, too many for a picture here.</p>\n"
            );
            return (note, Vec::new());
        }
        let (drawing, circles) = svg::placed(dfa, &Options::default());
        let [width, height] = [drawing.width, drawing.height].map(svg::number);
        let shown = format!(
            "<section class=\"beside\">\n<figure id=\"automaton\">\n<div class=\"scroll\">\
             <svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
             aria-label=\"the automaton\">\n{}<g id=\"here\"></g></svg></div>\n\
             <figcaption>{sizes}</figcaption>\n</figure>\n{aside}\n</section>\n",
            drawing.body,
        );
        let rounded = |x: f64| (x * 10.0).round() / 10.0;
        let circles = circles.iter().map(|&Circle { state, x, y, radius }| {
            (state, rounded(x), rounded(y), rounded(radius))
        });
        (shown, circles.collect())
    }

    /// For each state of the trajectories the moves to the accepting state at least.
    fn moves(&self, shown: &[Trajectory]) -> BTreeMap<State, u32> {
        let Some(dfa) = self.dfa else { return BTreeMap::new() };
        let distances = dfa.distances();
        let states = shown.iter().flat_map(Trajectory::states);
        states.filter_map(|q| Some((q, (*distances.get(q as usize)?)?))).collect()
    }

    /// What each state asks for, as a list that the script takes the entry of the cursor from.
    fn asks(&self, told: &[StateExplanation]) -> String {
        let Some(dfa) = self.dfa else { return String::new() };
        let mut items: String = told.iter().map(asked).collect();
        if dfa.len() > told.len() {
            let _ = writeln!(items, "<li>… and {} more</li>", dfa.len() - told.len());
        }
        let open = if told.len() > 12 { "" } else { " open" };
        format!(
            "<details class=\"asks\"{open}>\n<summary>What each state still asks for</summary>\n\
             <ol id=\"asks\">\n{items}</ol>\n</details>\n"
        )
    }
}

/// A page about what a task means, without recorded trajectories: its [`Explanation`], with a slider
/// through the shortest trajectories of each kind.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{explain, report};
///
/// let task = tltlc::task::compile("!wet U home", Budget::default())?;
/// let told = explain::explain(&task.entry().task().spec, task.dfa());
/// let html = report::explanation("!wet U home", task.dfa(), &told);
/// assert!(html.contains("a shortest that satisfies the task"));
/// assert!(html.contains("How the task is lost"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn explanation(title: &str, dfa: &Dfa, told: &Explanation) -> String {
    let page = Page {
        title: title.to_owned(),
        words: told.words.clone(),
        propositions: names(dfa),
        dfa: Some(dfa),
        of: 0,
    };
    let kinds = [
        ("a shortest that satisfies the task", &told.satisfying),
        ("a shortest that loses it for good", &told.losing),
        ("a shortest that does not satisfy it", &told.unsatisfying),
    ];
    // What loses it does not satisfy it either.
    let kinds = kinds.iter().take(if told.losing.is_some() { 2 } else { 3 });
    let walked = |(name, trace): &(&str, &Option<_>)| Some(walked(name, dfa, trace.as_ref()?));
    let traces: Vec<Trajectory> = kinds.filter_map(walked).collect();
    // An explanation has the first states; these trajectories may come through others.
    let first = told.states.len() as State;
    let mut others: Vec<State> = traces.iter().flat_map(Trajectory::states).collect();
    others.retain(|state| *state >= first);
    others.sort_unstable();
    others.dedup();
    let states = [&told.states[..], &explain::of_states(dfa, &others)].concat();
    page.written(&traces, 0, &states, &falls(told))
}

/// The edges into the trap.
fn falls(told: &Explanation) -> String {
    if told.falls.is_empty() {
        return String::new();
    }
    let rows = told.falls.iter().take(MOST_STATES).map(|(q, when)| {
        format!("<li>in <b class=\"state\">{q}</b> when <code>{}</code></li>\n", escaped(when))
    });
    let rows: String = rows.collect();
    let more = told.falls.len().saturating_sub(MOST_STATES);
    let more = if more > 0 { format!("<li>… and {more} more</li>\n") } else { String::new() };
    format!(
        "<details open>\n<summary>How the task is lost</summary>\n\
         <ul class=\"falls\">\n{rows}{more}</ul>\n</details>\n"
    )
}

/// A trace, of which only truth is known, on its way through an automaton.
fn walked(name: &str, dfa: &Dfa, trace: &Trace) -> Trajectory {
    let mut walked = Trajectory::new(name);
    let verdict = |q| match Some(q) {
        q if q == dfa.accepting => Verdict::Satisfied,
        q if q == dfa.trap => Verdict::Lost,
        _ => Verdict::Open,
    };
    let (mut q, mut since) = (0, 0);
    for (row, letter) in trace.letters.iter().enumerate() {
        let before = verdict(q);
        q = dfa.next(q, |p| letter[p as usize]);
        if verdict(q) != before {
            since = row;
        }
        let (robustness, greatest) = (None, None);
        walked.push(&Row { state: Some(q), holds: letter, rho: &[], robustness, greatest });
    }
    walked.end(Some(verdict(q)), since, None);
    walked
}

/// A trajectory, one state a row, on its way through a task.
///
/// # Errors
/// The first predicate that is not a number, in the first row in which there is one.
///
/// # Panics
/// If the number of columns is not the number of inputs.
#[track_caller]
pub fn follow(
    task: &Task,
    name: &str,
    columns: &Columns<'_>,
    scratch: &mut Scratch,
) -> Result<Trajectory, NotANumber> {
    let (evaluator, rows) = (task.evaluator(), columns.rows());
    let width = evaluator.propositions();
    let (mut labels, mut rho) = (vec![false; rows * width], vec![0.0; rows * width]);
    evaluator.labels(columns, scratch, &mut labels)?;
    evaluator.rho(columns, scratch, &mut rho)?;
    let mut running = Running::new(task.automaton());
    let mut online = match task.entry().is_automaton() {
        true => Online::of_automaton(task.automaton()),
        false => Online::new(&task.entry().task().spec, Budget::EMITTED),
    };
    let mut followed = Trajectory::new(name);
    for row in 0..rows {
        let (from, to) = (row * width, (row + 1) * width);
        let (holds, rho) = (&labels[from..to], &rho[from..to]);
        running.step(holds, rho);
        online.step(rho);
        let (state, greatest) = (Some(running.state()), online.greatest());
        followed.push(&Row { state, holds, rho, robustness: online.at_hand(), greatest });
    }
    let since = running.since().unwrap_or_default();
    followed.end(Some(running.verdict()), since, Some(online.robustness() + 0.0));
    Ok(followed)
}

/// What the script of the page reads.
#[derive(Serialize)]
struct Data {
    propositions: Vec<String>,
    accepting: Option<State>,
    trap: Option<State>,
    moves: BTreeMap<State, u32>,
    circles: Vec<(State, f64, f64, f64)>,
    /// The number of trajectories that there are.
    of: usize,
    trajectories: Vec<record::Columns>,
}

/// What a state asks for.
fn asked(told: &StateExplanation) -> String {
    let StateExplanation { state, verdict, moves, needs, way, avoid } = told;
    let codes = |texts: &[String], between: &str| {
        let codes = texts.iter().map(|text| format!("<code>{}</code>", escaped(text)));
        codes.collect::<Vec<_>>().join(between)
    };
    let mut rows = String::new();
    let mut row = |name: &str, shown: String| {
        let _ = write!(rows, "<dt>{name}</dt><dd>{shown}</dd>");
    };
    match (verdict, moves) {
        (Verdict::Satisfied, _) => row("asks for", "nothing: the task is satisfied".into()),
        (Verdict::Lost, _) => row("asks for", "nothing: the task is lost".into()),
        (Verdict::Open, None) => row("asks for", "what can no longer be had".into()),
        (Verdict::Open, Some(_)) => {
            let more = told.untold();
            let more = if more > 0 { format!(", and {more} moves more") } else { String::new() };
            row("quickest", codes(way, ", then ") + &more);
        }
    }
    if !needs.is_empty() {
        row("cannot do without", codes(needs, ", "));
    }
    if let Some(guard) = avoid {
        row("lost by", codes(std::slice::from_ref(guard), ""));
    }
    format!(
        "<li data-state=\"{state}\"><b class=\"state {verdict}\">{state}</b><dl>{rows}</dl></li>\n"
    )
}

fn names(dfa: &Dfa) -> Vec<String> {
    dfa.propositions.iter().map(|one| one.name.clone()).collect()
}

/// A text of several lines as HTML shows it. What changes its direction is shown as `\u{…}`.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for (i, line) in text.lines().enumerate() {
        if i > 0 {
            escaped.push('\n');
        }
        for c in visible(line).chars() {
            match c {
                '&' => escaped.push_str("&amp;"),
                '<' => escaped.push_str("&lt;"),
                '>' => escaped.push_str("&gt;"),
                '"' => escaped.push_str("&quot;"),
                '\'' => escaped.push_str("&#39;"),
                c => escaped.push(c),
            }
        }
    }
    escaped
}
