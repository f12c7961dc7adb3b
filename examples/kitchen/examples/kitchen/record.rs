//! What the figure shows of the trials, recorded: it can be drawn again without them.

use std::collections::BTreeMap;

use crate::trial::{Curve, Failure, Worth};

/// What is measured, in the order of the columns.
const MEASURES: [fn(&Worth) -> f64; 3] =
    [|worth| worth.success, |worth| worth.actions, |worth| worth.length];

const COLUMNS: [&str; 11] = [
    "curve",
    "x",
    "success",
    "success_low",
    "success_high",
    "actions",
    "actions_low",
    "actions_high",
    "length",
    "length_low",
    "length_high",
];

/// A point of a curve over all seeds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mean {
    /// Environment steps, or updates.
    pub(crate) x: f64,
    /// Success, action success and length: the mean, and that less and plus its standard error,
    /// within the range of the seeds.
    pub(crate) of: [[f64; 3]; 3],
}

/// The curves by name.
#[derive(Debug, Default)]
pub(crate) struct Record(pub(crate) BTreeMap<String, Vec<Mean>>);

impl Record {
    /// The means of the curves, which are one for each seed.
    pub(crate) fn new(curves: &BTreeMap<&str, Vec<&Curve>>) -> Self {
        let means = |seeds: &[&Curve]| {
            let length = seeds.iter().map(|curve| curve.points.len()).min().unwrap_or(0);
            (0..length).map(|i| mean(seeds, i)).collect()
        };
        Self(curves.iter().map(|(&name, seeds)| (name.to_owned(), means(seeds))).collect())
    }

    /// How far a curve goes.
    pub(crate) fn last(&self, name: &str) -> Option<f64> {
        self.0.get(name)?.last().map(|mean| mean.x)
    }

    /// Comma-separated values, one point a line.
    pub(crate) fn csv(&self) -> Result<String, Failure> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        csv.write_record(COLUMNS)?;
        for (name, means) in &self.0 {
            for Mean { x, of } in means {
                csv.serialize((name, x, of))?;
            }
        }
        Ok(String::from_utf8(csv.into_inner()?)?)
    }

    /// Reads what [`csv`](Self::csv) wrote.
    pub(crate) fn read(csv: &str) -> Result<Self, Failure> {
        let mut record = Self::default();
        for row in csv::Reader::from_reader(csv.as_bytes()).deserialize() {
            let (name, x, of) = row?;
            record.0.entry(name).or_default().push(Mean { x, of });
        }
        Ok(record)
    }
}

fn mean(seeds: &[&Curve], i: usize) -> Mean {
    let n = seeds.len() as f64;
    let of = MEASURES.map(|measure| {
        let values = || seeds.iter().map(|curve| measure(&curve.points[i]));
        let (low, high) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
        let mean = values().sum::<f64>() / n;
        let squares = values().map(|v| (v - mean).powi(2)).sum::<f64>();
        let error = if n > 1.0 { (squares / (n - 1.0) / n).sqrt() } else { 0.0 };
        [mean, low.max(mean - error), high.min(mean + error)]
    });
    Mean { x: seeds.iter().map(|curve| curve.points[i].x as f64).sum::<f64>() / n, of }
}
