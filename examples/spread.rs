//! How values spread, group by group, as SVG: a row for each group, side by side in panels.
//!
//! A bar from the 5th to the 95th percentile, a tick at the median, a dot at the worst with its
//! number. Axes are logarithmic; what is below the floor is drawn on it.

use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::Scene;

use crate::plot::{self, LINE, Panels, SAMPLE};
use crate::study::quantile;
use crate::svg::{INK, PALE};

const BAR: &str = "#9cc3e6";
const GOOD: &str = "#2e8b57";
const WORST: &str = "#d9622b";
const DASHES: &str = "5 4";
const ROW: f64 = 25.0;

/// One panel.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it, in two lines.
    pub title: [String; 2],
    /// What its axis measures.
    pub axis: String,
    /// The ends of its axis, both positive.
    pub range: (f64, f64),
    /// A value that is asked for, drawn as a line, and what the legend calls it.
    pub bound: Option<(f64, String)>,
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
    pub fn svg(&self, title: &str) -> String {
        let height = ROW * self.names.len() as f64;
        let panels = Panels {
            frame: (270.0, height),
            margins: [150.0, 60.0, 44.0, 44.0],
            legend: (0.0, 1.5 * LINE),
        };
        let row = self.panels.iter().map(|panel| panel.draw(&panels, &self.names)).collect();
        let mut scene = panels.scene(vec![row]);
        for (i, panel) in self.panels.iter().enumerate() {
            panel.label(&mut scene, panels.corner(0, i), panels.frame.0);
        }
        let (left, top) = panels.corner(0, 0);
        self.legend(&mut scene, (left, top + height + panels.margins[3] + LINE));
        plot::document(title, scene)
    }

    fn legend(&self, scene: &mut Scene, (x, y): (f64, f64)) {
        let bound = self.panels.iter().find_map(|panel| panel.bound.as_ref());
        let bound = bound.map(|(_, name)| (GOOD, 1.5, Some(DASHES), name.as_str()));
        let bar = (BAR, 10.0, None, "5th to 95th percentile");
        let median = (INK, 12.0, Some("0 14 2 14"), "median");
        let worst = (BAR, 2.0, None, "up to the worst: a dot, and its number");
        let mut x = x;
        for (colour, width, dashes, name) in [bar, median, worst].into_iter().chain(bound) {
            plot::sample(scene, (x, y - 4.0), colour, width, dashes);
            plot::text(scene, (x + SAMPLE + 6.0, y), 12, INK, name);
            x += SAMPLE + 30.0 + 6.0 * name.chars().count() as f64;
        }
    }
}

impl Panel {
    fn draw(&self, panels: &Panels, names: &[String]) -> (Layout, Vec<Plot>) {
        let count = names.len() as f64;
        let mut layout = panels.layout(self.range, (0.5, count + 0.5)).with_log_x();
        let floor = self.range.0;
        layout = layout.with_y_categories(names.iter().rev().cloned().collect());
        layout = layout.with_x_label(&*self.axis).with_x_tick_format(plot::format(move |tick| {
            if tick <= floor { format!("≤ {tick}") } else { format!("{tick}") }
        }));
        let bound = self
            .bound
            .iter()
            .map(|&(x, _)| line([(x, 0.5), (x, count + 0.5)], GOOD, 1.5, Some(DASHES)));
        let groups = self.groups.iter().enumerate();
        let groups = groups.flat_map(|(i, values)| self.group(count - i as f64, values));
        (layout, groups.chain(bound).collect())
    }

    fn group(&self, y: f64, values: &[f64]) -> [Plot; 4] {
        let (low, high) = self.range;
        let at = |share| quantile(values, share).clamp(low, high);
        let worst = ScatterPlot::new().with_data([(at(1.0), y)]).with_color(WORST);
        [
            line([(at(0.05), y), (at(1.0), y)], BAR, 2.0, None),
            line([(at(0.05), y), (at(0.95), y)], BAR, 10.0, None),
            line([(at(0.5), y - 0.28), (at(0.5), y + 0.28)], INK, 2.0, None),
            Plot::Scatter(worst.with_size(3.5)),
        ]
    }

    fn label(&self, scene: &mut Scene, (left, top): (f64, f64), width: f64) {
        for (i, title) in self.title.iter().enumerate() {
            let (size, colour) = if i == 0 { (14, INK) } else { (12, PALE) };
            plot::text(scene, (left, top - 26.0 + 17.0 * i as f64), size, colour, title);
        }
        for (i, values) in self.groups.iter().enumerate() {
            let at = (left + width + 8.0, top + ROW * (i as f64 + 0.5) + 4.0);
            plot::text(scene, at, 12, WORST, &worst_of(quantile(values, 1.0)));
        }
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

fn line(points: [(f64, f64); 2], colour: &str, width: f64, dashes: Option<&str>) -> Plot {
    let line = LinePlot::new().with_data(points).with_color(colour).with_stroke_width(width);
    Plot::Line(line.with_line_style(plot::dashes(dashes)))
}
