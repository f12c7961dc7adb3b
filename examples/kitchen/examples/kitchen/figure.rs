//! The figure: the three rows of the paper's Figure 3 (c), (d), (e), drawn from what is recorded.

use tltl_examples::chart::{self, Axis, Chart, Curve, Point, Row};

use crate::record::{Mean, Record};
use crate::report::Reference;
use crate::trial::HORIZONS;

/// A row of the figure.
pub(crate) struct Content {
    /// What stands above it; of task 1, what it asks for is added.
    pub(crate) title: &'static str,
    pub(crate) x: &'static str,
    /// The curves, and what the legend says of them.
    pub(crate) curves: &'static [(&'static str, &'static str)],
}

pub(crate) const ROWS: [Content; 3] = [
    Content {
        title: "(c) Task 1: ",
        x: "environment steps",
        curves: &[
            ("φ1.1", "F inside"),
            ("φ1.1*", "φ1.1, a failed action costs 0.1"),
            ("φ1.2", "hold T inside"),
            ("φ1.2*", "φ1.2, a failed action costs 0.1"),
            ("φ1.3", "see T hold T open T inside"),
            ("φ1.3*", "φ1.3, a failed action costs 0.1"),
        ],
    },
    Content {
        title: "(d) Task 2: any object into any receptacle",
        x: "environment steps",
        curves: &[
            ("φ2.1", "F inside"),
            ("φ2.1*", "φ2.1, a failed action costs 0.1"),
            ("φ2.2", "hold T inside"),
            ("φ2.2*", "φ2.2, a failed action costs 0.1"),
            ("φ2.3", "see T hold T open T inside"),
            ("φ2.3*", "φ2.3, a failed action costs 0.1"),
        ],
    },
    Content {
        title: "(e) Composition: φ1.3* ∧ φ2.3*",
        x: "updates",
        curves: &[
            ("c1", "the skills' normalised sum"),
            ("max", "maximum of the skills' values"),
            ("c2", "their plain sum, compensated"),
            ("c3", "c2, refined"),
            ("from scratch", "both at once, no skills"),
        ],
    },
];

/// What stands below the figure.
const REMARKS: [&str; 7] = [
    "Lines: means over the seeds, of 50 greedy episodes each; bands: standard errors. Letters: which curve it is, \
     each at places of its own.",
    "φ1.j and φ2.j: specification j of task 1 and of task 2. F a: a at some time; a T b: a, and b after it.",
    "inside: the object is in the receptacle; hold: in hand; see: in view; open: the receptacle is open.",
    "Composition: of the skills of φ1.3* and φ2.3*. c1 and max are not learned. c2 and c3 learn from the skills' \
     experience,",
    "without a step in the kitchen: c2 evaluates the sum's greedy policy, c3 goes on from there to the optimum. \
     From scratch learns in the kitchen.",
    "Dashed and dotted line: mean steps of the searcher, a script that sees what the agent sees, and of the planner, \
     which sees everything.",
    "An episode is cut at the highest mark of the right axis, and counts with that length.",
];

/// The figure as an SVG document.
pub(crate) fn svg(record: &Record, references: &[Reference; 3], first: &str) -> String {
    let rows: Vec<Row> =
        (0..3).map(|i| row(record, (i, first), &references[i], HORIZONS[i])).collect();
    chart::svg("Success, action success and length of episodes", &rows, &REMARKS.map(str::to_owned))
}

/// What stands above a row, where task 1 asks for `first`.
pub(crate) fn title(i: usize, first: &str) -> String {
    format!("{}{}", ROWS[i].title, if i == 0 { first } else { "" })
}

fn row(record: &Record, (i, first): (usize, &str), reference: &Reference, horizon: u32) -> Row {
    let content = &ROWS[i];
    let chart = |title: &str, measure: usize, axis, levels| Chart {
        title: title.to_owned(),
        axis,
        curves: content.curves.iter().map(|of| curve(record, of, measure)).collect(),
        levels,
    };
    let level = |name, steps| (steps, format!("{name}: {steps:.1} steps"));
    let levels = vec![level("searcher", reference.searcher), level("planner", reference.planner)];
    let charts = vec![
        chart("task success rate", 0, Axis::Share, Vec::new()),
        chart("action success rate", 1, Axis::Share, Vec::new()),
        chart("mean episode length", 2, Axis::UpTo(f64::from(horizon)), levels),
    ];
    Row { title: title(i, first), x: content.x.to_owned(), charts }
}

fn curve(record: &Record, (name, about): &(&str, &str), measure: usize) -> Curve {
    let run = record.0.get(*name);
    let means = run.map_or(&[][..], Vec::as_slice);
    let point = |x: f64, of: [[f64; 3]; 3]| {
        let [y, low, high] = of[measure];
        Point { x, y, low, high }
    };
    let points = match means {
        // What is not learned is a level, as far as the longest curve of the composition goes.
        &[Mean { x, of }] => vec![point(x, of), point(record.last("c3").unwrap_or(1.0), of)],
        means => means.iter().map(|mean| point(mean.x, mean.of)).collect(),
    };
    let not_run = if run.is_none() { " (not run)" } else { "" };
    Curve { name: format!("{name}: {about}{not_run}"), points }
}
