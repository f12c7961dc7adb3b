//! Line charts with bands, in rows that share their x axis and a legend, as SVG.

use kuva::plot::LinePlot;
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::Scene;

use crate::plot::{self, LINE, Panels, SAMPLE};
use crate::svg::{INK, PALE};

const COLOURS: [&str; 6] = ["#1f6fb4", "#d9622b", "#2e8b57", "#c23b60", "#8457a8", "#8c6d31"];
/// A later curve is drawn above the earlier ones, so it is thinner and has wider gaps: where curves
/// coincide, all of them show.
const DASHES: [Option<&str>; 6] =
    [None, Some("11 4"), Some("7 4"), Some("4 4"), Some("8 3 2 3"), Some("2 3")];
/// What marks the curves: where they coincide, the letters stand side by side.
const LETTERS: [&str; 6] = ["A", "B", "C", "D", "E", "F"];
/// How often each letter stands on its curve.
const MARKS: usize = 2;
const LEVELS: [&str; 2] = ["5 4", "1.5 3"];
/// The space for the names of levels beside the last chart.
const NAMES: f64 = 30.0;
const BAND: f64 = 0.16;

/// A point of a curve with its band.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Where on the x axis.
    pub x: f64,
    /// The curve.
    pub y: f64,
    /// The band's lower end.
    pub low: f64,
    /// The band's upper end.
    pub high: f64,
}

/// A curve; one without points is in the legend all the same, and keeps its colour.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What the legend calls it.
    pub name: String,
    /// Its points, from left to right.
    pub points: Vec<Point>,
}

/// What a chart's y axis measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Positive numbers between two, on a logarithmic scale; the x axis is logarithmic, too.
    Logarithmic(f64, f64),
    /// Shares, in per cent.
    Share,
    /// Numbers from 0 to this one.
    UpTo(f64),
}

/// One chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// What stands above it.
    pub title: String,
    /// Its y axis.
    pub axis: Axis,
    /// Its curves, at most six.
    pub curves: Vec<Curve>,
    /// Horizontal lines, at most two, and what the legend calls them.
    pub levels: Vec<(f64, String)>,
}

/// A row of charts, all with the same curves.
#[derive(Clone, Debug)]
pub struct Row {
    /// What stands above it.
    pub title: String,
    /// What the x axis measures.
    pub x: String,
    /// The charts.
    pub charts: Vec<Chart>,
}

/// The rows as one SVG document, with remarks below; one chart alone is drawn larger.
#[must_use]
pub fn svg(title: &str, rows: &[Row], remarks: &[String]) -> String {
    let columns = rows.iter().map(|row| row.charts.len()).max().unwrap_or(0);
    let bottom = if remarks.is_empty() { 0.0 } else { LINE * (remarks.len() as f64 + 0.5) };
    let panels = match columns {
        1 => Panels {
            frame: (480.0, 280.0),
            margins: [58.0, 20.0, 58.0, 42.0],
            legend: (230.0, bottom),
        },
        _ => Panels {
            frame: (232.0, 138.0),
            margins: [48.0, 24.0, 58.0, 42.0],
            legend: (340.0, bottom),
        },
    };
    let drawn = rows.iter().map(|row| row.charts.iter().map(|c| c.draw(&panels, &row.x)).collect());
    let mut scene = panels.scene(drawn.collect());
    for (i, row) in rows.iter().enumerate() {
        let (left, top) = panels.corner(i, 0);
        plot::text(&mut scene, (left - 42.0, top - 34.0), 15, INK, &row.title);
        for (j, chart) in row.charts.iter().enumerate() {
            let (left, top) = panels.corner(i, j);
            plot::text(&mut scene, (left, top - 8.0), 12, INK, &chart.title);
            chart.mark(&mut scene, (left, top), panels.frame);
        }
        let (right, _) = panels.corner(i, row.charts.len());
        let names = row.charts.last().is_some_and(|chart| chart.levels().count() > 0);
        let beside = if names { NAMES } else { 0.0 };
        row.legend(&mut scene, (right - panels.margins[0] + beside, top + 8.0));
    }
    let at = (panels.corner(0, 0).0, scene.height - bottom + 0.5 * LINE);
    plot::remarks(&mut scene, at, remarks);
    plot::document(title, scene)
}

impl Row {
    fn legend(&self, scene: &mut Scene, (x, mut y): (f64, f64)) {
        let (Some(first), Some(last)) = (self.charts.first(), self.charts.last()) else { return };
        for (i, curve) in first.curves.iter().enumerate() {
            plot::sample(scene, (x, y - 4.0), COLOURS[i], width(i), DASHES[i]);
            if first.curves.len() > 1 {
                plot::mark(scene, (x + SAMPLE / 2.0, y - 4.0), COLOURS[i], LETTERS[i]);
            }
            plot::text(scene, (x + SAMPLE + 8.0, y), 12, INK, &curve.name);
            y += LINE;
        }
        for (i, (_, name)) in last.levels.iter().enumerate() {
            plot::sample(scene, (x, y - 4.0), INK, 1.2, Some(LEVELS[i]));
            plot::text(scene, (x + SAMPLE + 8.0, y), 12, PALE, name);
            y += LINE;
        }
    }
}

impl Chart {
    /// The ends of the x axis and of the y axis.
    fn ends(&self) -> ((f64, f64), (f64, f64)) {
        let xs = || self.curves.iter().flat_map(|curve| &curve.points).map(|point| point.x);
        let (left, right) = (xs().fold(f64::MAX, f64::min), xs().fold(1.0, f64::max));
        match self.axis {
            Axis::Logarithmic(low, high) => ((left, right), (low, high)),
            Axis::Share => ((0.0, right), beyond(1.0)),
            Axis::UpTo(top) => ((0.0, right), beyond(top)),
        }
    }

    fn draw(&self, panels: &Panels, x_name: &str) -> (Layout, Vec<Plot>) {
        let (x, y) = self.ends();
        let levels = self.levels.iter().zip(LEVELS).map(|(&(at, _), dashes)| {
            let line = LinePlot::new().with_data([(x.0, at), (x.1, at)]).with_color(INK);
            Plot::Line(line.with_stroke_width(1.2).with_line_style(plot::dashes(Some(dashes))))
        });
        let curves = self.curves.iter().enumerate().map(|(i, curve)| curve.draw(i, y));
        let layout = panels.layout(x, y).with_x_label(x_name);
        (self.ticks(layout, x.1), levels.chain(curves).collect())
    }

    /// Writes the letters of the curves on them, and the names of the levels beside them, in a frame of
    /// a corner and a size.
    ///
    /// Each curve has its letters at places of its own, so that those of curves that coincide do not.
    fn mark(&self, scene: &mut Scene, (left, top): (f64, f64), (width, height): (f64, f64)) {
        let (x, y) = self.ends();
        let scale = |value: f64| match self.axis {
            Axis::Logarithmic(..) => value.log10(),
            _ => value,
        };
        let share = |value: f64, (from, to): (f64, f64)| {
            (scale(value) - scale(from)) / (scale(to) - scale(from))
        };
        let across = |value| left + share(value, x) * width;
        let down = |value: f64| top + (1.0 - share(value.clamp(y.0, y.1), y)) * height;
        let count = self.curves.len();
        for (i, curve) in self.curves.iter().enumerate().filter(|_| count > 1) {
            let line: Vec<(f64, f64)> =
                curve.points.iter().map(|point| (across(point.x), down(point.y))).collect();
            let places = (0..MARKS).map(|j| {
                left + (j as f64 + (i as f64 + 0.5) / count as f64) / MARKS as f64 * width
            });
            for at in on(&line, places) {
                plot::mark(scene, at, COLOURS[i], LETTERS[i]);
            }
        }
        for (i, (at, name)) in self.levels().enumerate() {
            // The second one, which is the lower one, a bit lower, so that names do not meet.
            let (x, y) = (left + width + 4.0, down(at) + 7.0 * i as f64);
            plot::text(scene, (x, y), 9, INK, name);
        }
    }

    /// The levels whose names say what they are before how high: those stand beside them.
    fn levels(&self) -> impl Iterator<Item = (f64, &str)> {
        self.levels.iter().filter_map(|(at, name)| Some((*at, name.split_once(':')?.0)))
    }

    fn ticks(&self, layout: Layout, right: f64) -> Layout {
        let layout = layout.with_x_tick_format(plot::format(number));
        match self.axis {
            Axis::Logarithmic(..) => {
                layout.with_log_scale().with_y_tick_format(plot::format(number))
            }
            Axis::Share => {
                let layout = layout.with_x_tick_step(right / 2.0).with_y_tick_step(0.25);
                layout.with_y_tick_format(plot::format(|value| format!("{:.0} %", 100.0 * value)))
            }
            Axis::UpTo(top) => layout.with_x_tick_step(right / 2.0).with_y_tick_step(top / 4.0),
        }
    }
}

impl Curve {
    /// As the `i`th of its chart; what is beyond the ends of the y axis is drawn on them.
    fn draw(&self, i: usize, (low, high): (f64, f64)) -> Plot {
        let within =
            |of: fn(&Point) -> f64| self.points.iter().map(move |point| of(point).clamp(low, high));
        let line = LinePlot::new()
            .with_data(self.points.iter().map(|point| point.x).zip(within(|point| point.y)))
            .with_color(COLOURS[i])
            .with_stroke_width(width(i))
            .with_line_style(plot::dashes(DASHES[i]));
        let mut line = line.with_band(within(|point| point.low), within(|point| point.high));
        line.band.iter_mut().for_each(|band| band.opacity = BAND);
        Plot::Line(line)
    }
}

/// The points of a line at some places across, as far as it goes; a line that has none of them gets its
/// middle.
fn on(line: &[(f64, f64)], places: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    let (Some(&(first, _)), Some(&(last, _))) = (line.first(), line.last()) else {
        return Vec::new();
    };
    let mut places: Vec<f64> = places.filter(|at| (first..=last).contains(at)).collect();
    if places.is_empty() {
        places.push(0.5 * (first + last));
    }
    let point = |at: f64| {
        let i = line.partition_point(|(x, _)| *x < at).clamp(1, line.len().max(2) - 1);
        let (&(x, y), &(to, height)) = (line.get(i - 1)?, line.get(i).or(line.last())?);
        let share = if to > x { (at - x) / (to - x) } else { 0.0 };
        Some((at, y + share * (height - y)))
    };
    places.into_iter().filter_map(point).collect()
}

/// From 0 to `top`, and a bit more at both ends: else curves at the ends would lie on the frame.
fn beyond(top: f64) -> (f64, f64) {
    (-0.03 * top, 1.03 * top)
}

fn width(i: usize) -> f64 {
    3.2 - 0.3 * i as f64
}

/// To three digits: the last episode of a run may end some steps beyond a round number.
fn number(value: f64) -> String {
    match format!("{value:.2e}").parse().unwrap_or(value) {
        v if v >= 1e6 => format!("{} M", v / 1e6),
        v if v >= 1e3 => format!("{} k", v / 1e3),
        v => format!("{v}"),
    }
}
