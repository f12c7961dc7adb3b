//! Small multiples: rows of charts that share their x axis and a legend, as SVG.

use std::fmt::Write as _;

use tltl_examples::svg::{FONT, INK, text};

const COLOURS: [&str; 6] = ["#1f6fb4", "#d9622b", "#2e8b57", "#8457a8", "#8c6d31", "#c23b60"];
const PALE: &str = "#6b7684";
const GRID: &str = "#e3e7ec";
const WIDTH: f64 = 232.0;
const HEIGHT: f64 = 138.0;
const LEFT: f64 = 58.0;
const TOP: f64 = 56.0;
const ACROSS: f64 = 72.0;
const DOWN: f64 = 84.0;
const LEGEND: f64 = 150.0;

/// A point of a curve: where, the mean, the least and the largest over the seeds.
pub(crate) type Point = (f64, f64, f64, f64);

/// A curve; a curve without points is not drawn, but keeps its colour.
pub(crate) struct Curve {
    /// What the legend calls it.
    pub(crate) name: String,
    /// Its points, from left to right.
    pub(crate) points: Vec<Point>,
}

/// One chart.
pub(crate) struct Chart {
    /// What it measures.
    pub(crate) title: &'static str,
    /// The largest y; the least is 0.
    pub(crate) top: f64,
    /// Whether y is a share, to be shown in per cent.
    pub(crate) share: bool,
    /// Its curves.
    pub(crate) curves: Vec<Curve>,
    /// Horizontal lines, and what they are.
    pub(crate) lines: Vec<(f64, &'static str)>,
}

/// A row of charts.
pub(crate) struct Row {
    /// What it shows.
    pub(crate) title: String,
    /// What the x axis counts.
    pub(crate) x: &'static str,
    /// The charts; all have the same curves.
    pub(crate) charts: Vec<Chart>,
}

/// The rows as one SVG document.
pub(crate) fn svg(rows: &[Row]) -> String {
    let charts = rows.iter().map(|row| row.charts.len()).max().unwrap_or(0) as f64;
    let width = LEFT + charts * (WIDTH + ACROSS) + LEGEND;
    let height = rows.len() as f64 * (TOP + HEIGHT + DOWN - 20.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 \
         {width} {height}\" {FONT}>\n<rect width=\"{width}\" \
         height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for (i, row) in rows.iter().enumerate() {
        let _ = writeln!(
            svg,
            "<g transform=\"translate(0 {})\">",
            i as f64 * (TOP + HEIGHT + DOWN - 20.0)
        );
        row.draw(&mut svg);
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

impl Row {
    fn draw(&self, svg: &mut String) {
        text(svg, (16.0, 24.0), 15, "start", INK, &self.title);
        for (i, chart) in self.charts.iter().enumerate() {
            let left = LEFT + i as f64 * (WIDTH + ACROSS);
            let _ = writeln!(svg, "<g transform=\"translate({left} {TOP})\">");
            chart.draw(svg, self.x);
            svg.push_str("</g>\n");
        }
        let Some(first) = self.charts.first() else { return };
        let left = LEFT + self.charts.len() as f64 * (WIDTH + ACROSS) - 40.0;
        for (i, curve) in first.curves.iter().enumerate() {
            let y = TOP + 8.0 + 20.0 * i as f64;
            let colour = COLOURS[i % COLOURS.len()];
            let _ = writeln!(
                svg,
                "<rect x=\"{left}\" y=\"{}\" width=\"18\" height=\"3\" fill=\"{colour}\"/>",
                y - 5.0
            );
            text(svg, (left + 26.0, y), 12, "start", INK, &curve.name);
        }
    }
}

impl Chart {
    fn draw(&self, svg: &mut String, x_name: &str) {
        let all = self.curves.iter().flat_map(|curve| &curve.points);
        let right = all.map(|point| point.0).fold(1.0, f64::max);
        let x = |value: f64| value / right * WIDTH;
        let y = |value: f64| HEIGHT * (1.0 - value.min(self.top) / self.top);
        text(svg, (0.0, -10.0), 12, "start", INK, self.title);
        for i in 0..=4 {
            let value = self.top * f64::from(i) / 4.0;
            let at = y(value);
            let _ = writeln!(svg, "<path d=\"M0 {at:.1}h{WIDTH}\" stroke=\"{GRID}\"/>");
            let label =
                if self.share { format!("{:.0} %", 100.0 * value) } else { format!("{value:.0}") };
            text(svg, (-8.0, at + 4.0), 11, "end", INK, &label);
        }
        for i in 0..=2 {
            let value = right * f64::from(i) / 2.0;
            text(svg, (x(value), HEIGHT + 16.0), 11, "middle", INK, &thousands(value));
        }
        text(svg, (WIDTH / 2.0, HEIGHT + 32.0), 11, "middle", PALE, x_name);
        let mut free = 0.0;
        for &(value, name) in &self.lines {
            let at = y(value);
            let _ = writeln!(
                svg,
                "<path d=\"M0 {at:.1}h{WIDTH}\" stroke=\"{INK}\" stroke-dasharray=\"4 3\"/>"
            );
            let label = f64::max(at + 3.0, free);
            free = label + 11.0;
            text(svg, (WIDTH + 5.0, label), 10, "start", INK, &format!("{name} {value:.1}"));
        }
        for (i, curve) in self.curves.iter().enumerate().filter(|(_, c)| !c.points.is_empty()) {
            curve.draw(svg, COLOURS[i % COLOURS.len()], &x, &y);
        }
        let _ = writeln!(
            svg,
            "<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"{INK}\" \
             stroke-width=\"0.8\"/>"
        );
    }
}

impl Curve {
    fn draw(&self, svg: &mut String, colour: &str, x: &dyn Fn(f64) -> f64, y: &dyn Fn(f64) -> f64) {
        let path = |points: &mut dyn Iterator<Item = (f64, f64)>| {
            let mut path = String::new();
            points.for_each(|(a, b)| {
                let _ = write!(path, "{:.1},{:.1} ", x(a), y(b));
            });
            path
        };
        let band = path(
            &mut self
                .points
                .iter()
                .map(|p| (p.0, p.3))
                .chain(self.points.iter().rev().map(|p| (p.0, p.2))),
        );
        let mean = path(&mut self.points.iter().map(|p| (p.0, p.1)));
        let _ = writeln!(
            svg,
            "<polygon points=\"{band}\" fill=\"{colour}\" opacity=\"0.16\"/>\n<polyline \
             points=\"{mean}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.8\"/>"
        );
    }
}

fn thousands(value: f64) -> String {
    if value >= 1000.0 { format!("{:.0} k", value / 1000.0) } else { format!("{value}") }
}
