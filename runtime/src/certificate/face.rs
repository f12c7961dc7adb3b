//! What certificates and estimates look like: a few aligned lines, the same words for both.
//!
//! No number has more digits than its error supports: computed ones have at most [`DIGITS`] behind the
//! point, and of an estimate as many as make its interval two digits wide.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use super::{Certificate, NOTHING, Report, Start, Within};

/// How many digits behind the point of a probability are shown: a millionth of all episodes is less
/// than anybody runs, and regrets below it are shown as powers of ten.
const DIGITS: usize = 6;

/// The same of a number of steps.
const STEP_DIGITS: usize = 4;

/// Fewer steps than this are shown as 0.
const LEAST_STEPS: f64 = 5e-5;

/// How many starts are listed: those below lose less.
const LISTED: usize = 5;

/// Rows of cells, the first of each to the left and the others to the right, and what is to be said
/// below them.
pub(crate) struct Face {
    rows: Vec<Vec<String>>,
    pub(crate) below: String,
}

impl Face {
    #[inline]
    pub(crate) fn new(head: &[&str]) -> Self {
        Self { rows: [head.iter().map(ToString::to_string).collect()].into(), below: String::new() }
    }

    /// Of a certificate.
    #[inline]
    pub(super) fn of(certificate: &Certificate) -> Self {
        let Certificate { satisfied, steps, optimal_satisfied, optimal_steps, .. } = *certificate;
        let Certificate { satisfied_error, steps_error, .. } = *certificate;
        let mut face = Self::new(&["", "this policy", "best possible", "regret"]);
        face.compare("P(satisfied)".to_string(), satisfied, optimal_satisfied, satisfied_error);
        if let Some(Within { steps, satisfied, optimal_satisfied }) = certificate.within {
            face.compare(satisfied_in(steps), satisfied, optimal_satisfied, None);
        }
        // Where P is smaller than possible, fewer steps are no merit.
        let comparable = certificate.regret_satisfied <= NOTHING;
        let regret = certificate.regret_steps.filter(|_| comparable);
        let regret = regret.map(|part| format!("{} %", small(part, 100.0, 2)));
        let [own, best] = [steps, optimal_steps].map(|steps| duration(steps, steps_error));
        face.row(STEPS, [own, best, or_none(regret)]);
        let within = |error: f64| format!("{:.0e}", 1.5 * error).replace("0e0", "0");
        let errors = match (satisfied_error.map(within), steps_error.map(within)) {
            (Some(p), Some(steps)) => format!(": P to within {p}, steps to within {steps}"),
            (Some(p), None) => format!(": P to within {p}"),
            (None, _) => String::new(),
        };
        face.below = format!(
            "Computed from the model, mean over the starts{errors}.\n{:.2} % of the actions are best for \
             the reward, to within 1e-6 of it.",
            100.0 * certificate.fraction_optimal
        );
        face
    }

    #[inline]
    pub(crate) fn row<const N: usize>(&mut self, label: &str, cells: [String; N]) {
        self.rows.push([label.to_string()].into_iter().chain(cells).collect());
    }

    /// A row of two probabilities and their difference.
    #[inline]
    fn compare(&mut self, label: String, own: f64, best: f64, error: Option<f64>) {
        let regret = small(best - own, 1.0, DIGITS);
        self.row(&label, [probability(own, error), probability(best, error), regret]);
    }
}

impl fmt::Display for Face {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = |column: usize| {
            let cells = self.rows.iter().map(|row| row[column].len());
            cells.max().unwrap_or(0)
        };
        for row in &self.rows {
            write!(f, "{:<1$}", row[0], width(0))?;
            for (column, cell) in row.iter().enumerate().skip(1) {
                write!(f, "  {cell:>0$}", width(column))?;
            }
            writeln!(f)?;
        }
        f.write_str(&self.below)
    }
}

/// The worst of the starts, which are sorted so, if there are any that lose something.
#[inline]
pub(super) fn starts(report: &Report, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let Report { certificate: Certificate { satisfied_error, steps_error, .. }, starts } = report;
    let loses = |start: &&Start| {
        let (satisfied, steps) = start.losses();
        satisfied > NOTHING || steps > LEAST_STEPS
    };
    let worse = starts.iter().filter(loses).count();
    if worse == 0 {
        return f.write_str("From every start it is as good as can be.");
    }
    let best = "best possible";
    let mut face = Face::new(&["worst starts", "P(satisfied)", best, STEPS, best]);
    for start in starts.iter().filter(loses).take(LISTED) {
        let [own, optimal] =
            [start.satisfied, start.optimal_satisfied].map(|p| probability(p, *satisfied_error));
        let [steps, fewest] =
            [start.steps, start.optimal_steps].map(|steps| duration(steps, *steps_error));
        face.row(&format!("state {}", start.state), [own, optimal, steps, fewest]);
    }
    // The starts that lose most of P come first; where none does, all lose steps alone.
    let (satisfied, _) = starts[0].losses();
    let most = if satisfied > NOTHING {
        format!("{} of P(satisfied)", small(satisfied, 1.0, DIGITS))
    } else {
        let part = |start: &Start| {
            Some(start.losses().1 / start.optimal_steps.filter(|steps| *steps > 0.0)?)
        };
        let largest = starts.iter().filter_map(part).fold(0.0, f64::max);
        format!("{} % of the steps", small(largest, 100.0, 2))
    };
    face.below = format!("{worse} of {} starts lose something: at most {most}.", starts.len());
    write!(f, "{face}")
}

/// What the row of steps is called.
pub(crate) const STEPS: &str = "E[steps | satisfied]";

/// What the row of a horizon is called.
#[inline]
pub(crate) fn satisfied_in(steps: u64) -> String {
    format!("P(satisfied in {steps} steps)")
}

#[inline]
fn probability(p: f64, error: Option<f64>) -> String {
    format!("{p:.0$}", supported(DIGITS, error))
}

#[inline]
fn duration(steps: Option<f64>, error: Option<f64>) -> String {
    or_none(steps.map(|steps| format!("{steps:.0$}", supported(STEP_DIGITS, error))))
}

/// How many digits behind the point a number has that may be off by `error`, `most` at most.
#[inline]
fn supported(most: usize, error: Option<f64>) -> usize {
    let (error, mut unit, mut digits) = (error.unwrap_or(0.0), 1.0, 0);
    while digits < most && error <= 0.05 * unit {
        (unit, digits) = (0.1 * unit, digits + 1);
    }
    digits
}

/// A dash where there is no number.
#[inline]
pub(crate) fn or_none(cell: Option<String>) -> String {
    cell.unwrap_or_else(|| "-".to_string())
}

/// A difference that may be far smaller than what it is the difference of: it is not rounded to 0
/// unless it is below the error. It is shown `scale` times as large.
#[inline]
fn small(value: f64, scale: f64, digits: usize) -> String {
    if value.abs() <= NOTHING {
        return "0".to_string();
    }
    let value = scale * value;
    let text = format!("{value:.digits$}");
    if text.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) {
        text
    } else {
        format!("{value:.0e}")
    }
}
