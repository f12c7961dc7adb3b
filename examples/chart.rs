//! Line charts with confidence bands, as SVG.

use std::fmt::Write as _;

use crate::svg::{FONT, INK, text};

const COLOURS: [&str; 6] = ["#1f6fb4", "#d9622b", "#2e8b57", "#8457a8", "#8c6d31", "#444b54"];
const GRID: &str = "#e3e7ec";
const LEFT: f64 = 64.0;
const TOP: f64 = 42.0;
const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 280.0;

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

/// A curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What the legend calls it.
    pub name: String,
    /// Its points, from left to right.
    pub points: Vec<Point>,
}

/// A chart; both axes are logarithmic, so all coordinates must be positive.
#[derive(Clone, Debug)]
pub struct Chart {
    /// What stands above it.
    pub title: String,
    /// What the x axis measures.
    pub x: String,
    /// What the y axis measures.
    pub y: String,
    /// A horizontal line, and what it is.
    pub line: Option<(f64, String)>,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// From values to pixels.
struct Scale {
    x: (f64, f64),
    y: (f64, f64),
}

impl Scale {
    fn new(chart: &Chart) -> Self {
        let points = || chart.curves.iter().flat_map(|curve| &curve.points);
        let line = chart.line.iter().map(|&(y, _)| y);
        let ys = points().flat_map(|p| [p.low, p.high]).chain(line);
        let (low, high) = range(ys);
        Self { x: range(points().map(|p| p.x)), y: (low / 1.1, high * 1.1) }
    }

    fn x(&self, x: f64) -> f64 {
        LEFT + WIDTH * (x / self.x.0).ln() / (self.x.1 / self.x.0).ln()
    }

    fn y(&self, y: f64) -> f64 {
        TOP + HEIGHT * (1.0 - (y / self.y.0).ln() / (self.y.1 / self.y.0).ln())
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, 0.0), |(low, high), v| (low.min(v), high.max(v)))
}

/// 1, 2 and 5 times the powers of ten between the ends; the powers alone if those are many.
fn ticks((low, high): (f64, f64)) -> Vec<f64> {
    let fine = high / low < 200.0;
    let steps: &[f64] = if fine { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let powers = (-9..12).map(|power| 10f64.powi(power));
    let all = powers.flat_map(|power| steps.iter().map(move |step| step * power));
    all.filter(|&tick| (low..=high).contains(&tick)).collect()
}

fn number(value: f64) -> String {
    match value {
        v if v >= 1e6 => format!("{} M", v / 1e6),
        v if v >= 1e3 => format!("{} k", v / 1e3),
        v => format!("{v}"),
    }
}

impl Chart {
    /// The chart as an SVG document.
    #[must_use]
    pub fn svg(&self) -> String {
        let scale = Scale::new(self);
        let (width, height) = (LEFT + WIDTH + 222.0, TOP + HEIGHT + 54.0);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" {FONT}>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        text(&mut svg, (LEFT, 24.0), 15, "start", INK, &self.title);
        self.axes(&mut svg, &scale);
        if let Some((y, name)) = &self.line {
            let at = scale.y(*y);
            let _ = writeln!(
                svg,
                "<path d=\"M{LEFT} {at:.1}h{WIDTH}\" stroke=\"{INK}\" stroke-dasharray=\"5 4\"/>"
            );
            text(&mut svg, (LEFT + WIDTH + 12.0, at + 4.0), 12, "start", INK, name);
        }
        for (i, curve) in self.curves.iter().enumerate() {
            let dash = ["", "6 5"][usize::from(i >= 4)];
            curve.draw(&mut svg, &scale, COLOURS[i % COLOURS.len()], dash);
            let y = TOP + 10.0 + 22.0 * i as f64;
            let _ = writeln!(
                svg,
                "<rect x=\"{}\" y=\"{}\" width=\"18\" height=\"4\" fill=\"{}\"/>",
                LEFT + WIDTH + 12.0,
                y - 6.0,
                COLOURS[i % COLOURS.len()]
            );
            text(&mut svg, (LEFT + WIDTH + 36.0, y), 12, "start", INK, &curve.name);
        }
        svg.push_str("</svg>\n");
        svg
    }

    fn axes(&self, svg: &mut String, scale: &Scale) {
        for tick in ticks(scale.x) {
            let x = scale.x(tick);
            let _ = writeln!(svg, "<path d=\"M{x:.1} {TOP}v{HEIGHT}\" stroke=\"{GRID}\"/>");
            text(svg, (x, TOP + HEIGHT + 18.0), 12, "middle", INK, &number(tick));
        }
        for tick in ticks(scale.y) {
            let y = scale.y(tick);
            let _ = writeln!(svg, "<path d=\"M{LEFT} {y:.1}h{WIDTH}\" stroke=\"{GRID}\"/>");
            text(svg, (LEFT - 8.0, y + 4.0), 12, "end", INK, &number(tick));
        }
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"none\" \
             stroke=\"{INK}\"/>"
        );
        let (x, y) = (LEFT + WIDTH / 2.0, TOP + HEIGHT + 40.0);
        text(svg, (x, y), 13, "middle", INK, &self.x);
        let middle = TOP + HEIGHT / 2.0;
        let _ = writeln!(svg, "<g transform=\"translate(18 {middle}) rotate(-90)\">");
        text(svg, (0.0, 0.0), 13, "middle", INK, &self.y);
        svg.push_str("</g>\n");
    }
}

impl Curve {
    fn draw(&self, svg: &mut String, scale: &Scale, colour: &str, dash: &str) {
        let path = |at: &dyn Fn(&Point) -> f64, points: &mut dyn Iterator<Item = &Point>| {
            let mut path = String::new();
            for p in points {
                let _ = write!(path, " {:.1},{:.1}", scale.x(p.x), scale.y(at(p)));
            }
            path
        };
        let upper = path(&|p| p.high, &mut self.points.iter());
        let lower = path(&|p| p.low, &mut self.points.iter().rev());
        let middle = path(&|p| p.y, &mut self.points.iter());
        let _ = writeln!(
            svg,
            "<polygon points=\"{upper}{lower}\" fill=\"{colour}\" opacity=\"0.2\"/>\n\
             <polyline points=\"{middle}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" \
             stroke-dasharray=\"{dash}\"/>"
        );
    }
}
