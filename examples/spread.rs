//! How values spread, group by group, as SVG: a row for each group, side by side in panels.
//!
//! A bar from the 5th to the 95th percentile, a tick at the median, a dot at the worst with its
//! number. Axes are logarithmic; what is below the floor is drawn on it.

use std::fmt::Write as _;

use crate::study::quantile;
use crate::svg::{FONT, INK, text};

const GRID: &str = "#e3e7ec";
const BAR: &str = "#9cc3e6";
const GOOD: &str = "#2e8b57";
const WORST: &str = "#d9622b";
const LEFT: f64 = 196.0;
const TOP: f64 = 66.0;
const ROW: f64 = 25.0;
const WIDTH: f64 = 270.0;
const GAP: f64 = 84.0;

/// One panel.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it, in two lines.
    pub title: [String; 2],
    /// What its axis measures.
    pub axis: String,
    /// The ends of its axis, both positive.
    pub range: (f64, f64),
    /// A value that is asked for, drawn as a line.
    pub bound: Option<f64>,
    /// The values of each group; infinite ones never come to an end.
    pub groups: Vec<Vec<f64>>,
}

/// Groups in panels side by side.
#[derive(Clone, Debug)]
pub struct Spread {
    /// The groups, from top to bottom.
    pub names: Vec<String>,
    /// The panels.
    pub panels: Vec<Panel>,
}

impl Spread {
    /// The figure as an SVG document.
    #[must_use]
    pub fn svg(&self) -> String {
        let panels = self.panels.len() as f64;
        let width = LEFT + panels * WIDTH + panels * GAP;
        let (bottom, height) = (self.bottom(), self.bottom() + 74.0);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" {FONT}>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        for (i, name) in self.names.iter().enumerate() {
            text(&mut svg, (LEFT - 12.0, middle(i) + 4.0), 13, "end", INK, name);
        }
        for (i, panel) in self.panels.iter().enumerate() {
            panel.draw(&mut svg, LEFT + i as f64 * (WIDTH + GAP), bottom);
        }
        legend(&mut svg, bottom + 62.0);
        svg.push_str("</svg>\n");
        svg
    }

    fn bottom(&self) -> f64 {
        TOP + ROW * self.names.len() as f64
    }
}

impl Panel {
    fn x(&self, left: f64, value: f64) -> f64 {
        let (low, high) = self.range;
        left + WIDTH * (value.clamp(low, high) / low).ln() / (high / low).ln()
    }

    fn draw(&self, svg: &mut String, left: f64, bottom: f64) {
        for (i, title) in self.title.iter().enumerate() {
            let size = if i == 0 { 14 } else { 12 };
            text(svg, (left, 24.0 + 18.0 * i as f64), size, "start", INK, title);
        }
        self.axes(svg, left, bottom);
        for (i, values) in self.groups.iter().enumerate() {
            self.group(svg, left, middle(i), values);
        }
    }

    fn axes(&self, svg: &mut String, left: f64, bottom: f64) {
        let height = bottom - TOP;
        let powers = (-9..9).map(|power| 10f64.powi(power));
        for tick in powers.filter(|tick| (self.range.0..=self.range.1 * 1.01).contains(tick)) {
            let x = self.x(left, tick);
            let _ = writeln!(svg, "<path d=\"M{x:.1} {TOP}v{height}\" stroke=\"{GRID}\"/>");
            let floor = if tick <= self.range.0 * 1.01 { "≤ " } else { "" };
            text(svg, (x, bottom + 17.0), 12, "middle", INK, &format!("{floor}{tick}"));
        }
        if let Some(bound) = self.bound {
            let x = self.x(left, bound);
            let _ = writeln!(
                svg,
                "<path d=\"M{x:.1} {TOP}v{height}\" stroke=\"{GOOD}\" stroke-width=\"1.5\" \
                 stroke-dasharray=\"5 4\"/>"
            );
        }
        let _ = writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{TOP}\" width=\"{WIDTH}\" height=\"{height}\" fill=\"none\" \
             stroke=\"{INK}\"/>"
        );
        text(svg, (left + WIDTH / 2.0, bottom + 36.0), 13, "middle", INK, &self.axis);
    }

    fn group(&self, svg: &mut String, left: f64, y: f64, values: &[f64]) {
        let at = |share| self.x(left, quantile(values, share));
        let (low, median, high) = (at(0.05), at(0.5), at(0.95));
        let worst = quantile(values, 1.0);
        let end = self.x(left, worst);
        let _ = writeln!(
            svg,
            "<path d=\"M{low:.1} {y}H{end:.1}\" stroke=\"{BAR}\" stroke-width=\"2\"/>\n\
             <rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"10\" rx=\"2\" fill=\"{BAR}\"/>\n\
             <path d=\"M{median:.1} {:.1}v14\" stroke=\"{INK}\" stroke-width=\"2\"/>\n\
             <circle cx=\"{end:.1}\" cy=\"{y}\" r=\"3.5\" fill=\"{WORST}\"/>",
            low - 1.0,
            y - 5.0,
            high - low + 2.0,
            y - 7.0
        );
        text(svg, (left + WIDTH + 8.0, y + 4.0), 12, "start", WORST, &worst_of(worst));
    }
}

/// Three figures of the worst value.
fn worst_of(value: f64) -> String {
    match value {
        v if v.is_infinite() => "never".to_owned(),
        v if v < 0.0005 => "0".to_owned(),
        v if v < 1.0 => format!("{v:.3}"),
        v if v < 100.0 => format!("{v:.1}"),
        v => format!("{v:.0}"),
    }
}

fn middle(row: usize) -> f64 {
    TOP + ROW * (row as f64 + 0.5)
}

fn legend(svg: &mut String, y: f64) {
    let _ = writeln!(
        svg,
        "<rect x=\"{LEFT}\" y=\"{}\" width=\"26\" height=\"10\" rx=\"2\" fill=\"{BAR}\"/>\n\
         <path d=\"M{} {}v14\" stroke=\"{INK}\" stroke-width=\"2\"/>\n\
         <circle cx=\"{}\" cy=\"{}\" r=\"3.5\" fill=\"{WORST}\"/>",
        y - 9.0,
        LEFT + 192.0,
        y - 11.0,
        LEFT + 272.0,
        y - 4.0
    );
    text(svg, (LEFT + 33.0, y), 12, "start", INK, "5th to 95th percentile");
    text(svg, (LEFT + 201.0, y), 12, "start", INK, "median");
    text(svg, (LEFT + 282.0, y), 12, "start", INK, "worst (number at the right)");
}
