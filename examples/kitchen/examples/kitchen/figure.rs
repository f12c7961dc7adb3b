//! The figure: the three rows of the paper's Figure 3 (c), (d), (e), drawn from what is recorded.

use tltl_examples::chart::{self, Axis, Chart, Curve, Point, Row};

use crate::record::{Mean, Record};
use crate::report::Reference;
use crate::trial::HORIZONS;

/// A row of the figure.
pub(crate) struct Content {
    pub(crate) title: &'static str,
    pub(crate) x: &'static str,
    /// The curves, and what the legend says of them.
    pub(crate) curves: &'static [(&'static str, &'static str)],
}

pub(crate) const ROWS: [Content; 3] = [
    Content {
        title: "(c) Task 1: the apple into the fridge",
        x: "environment steps",
        curves: &[
            ("φ1.1", "F inside"),
            ("φ1.1*", "F inside"),
            ("φ1.2", "hold T inside"),
            ("φ1.2*", "hold T inside"),
            ("φ1.3", "see T hold T open T inside"),
            ("φ1.3*", "see T hold T open T inside"),
        ],
    },
    Content {
        title: "(d) Task 2: any object into any receptacle",
        x: "environment steps",
        curves: &[
            ("φ2.1", "F inside"),
            ("φ2.1*", "F inside"),
            ("φ2.2", "hold T inside"),
            ("φ2.2*", "hold T inside"),
            ("φ2.3", "see T hold T open T inside"),
            ("φ2.3*", "see T hold T open T inside"),
        ],
    },
    Content {
        title: "(e) Composition: φ1.3* ∧ φ2.3*",
        x: "updates",
        curves: &[
            ("c1", "the skills' values, normalised sum"),
            ("max", "the skills' values, maximum"),
            ("c2", "their sum, compensated"),
            ("c3", "c2, refined"),
            ("from scratch", "no skills"),
        ],
    },
];

/// What stands below the figure.
const REMARKS: [&str; 4] = [
    "Lines: means over the seeds, of 50 greedy episodes each; bands: standard errors.",
    "*: a failed action costs 0.1. F a: a at some time; a T b: a, and b after it. inside, hold, see: the \
     object is in the receptacle, in hand, in view; open: the receptacle is open.",
    "c1 and max are not learned; c2 goes over into c3, and neither takes a step in the kitchen.",
    "An episode is cut at the highest mark of the right axis. The searcher is scripted and sees what \
     the agent sees; the planner sees everything.",
];

/// The figure as an SVG document.
pub(crate) fn svg(record: &Record, references: &[Reference; 3]) -> String {
    let rows: Vec<Row> =
        (0..3).map(|i| row(record, &ROWS[i], &references[i], HORIZONS[i])).collect();
    chart::svg("Success, action success and length of episodes", &rows, &REMARKS.map(str::to_owned))
}

fn row(record: &Record, content: &Content, reference: &Reference, horizon: u32) -> Row {
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
    Row { title: content.title.to_owned(), x: content.x.to_owned(), charts }
}

fn curve(record: &Record, (name, about): &(&str, &str), measure: usize) -> Curve {
    let means = record.0.get(*name).map_or(&[][..], Vec::as_slice);
    let point = |x: f64, of: [[f64; 3]; 3]| {
        let [y, low, high] = of[measure];
        Point { x, y, low, high }
    };
    let points = match means {
        // What is not learned is a level, as far as the longest curve of the composition goes.
        &[Mean { x, of }] => vec![point(x, of), point(record.last("c3").unwrap_or(1.0), of)],
        means => means.iter().map(|mean| point(mean.x, mean.of)).collect(),
    };
    Curve { name: format!("{name}: {about}"), points }
}
