//! What the charts have in common that `kuva` draws: inks, letters, the frame of a panel, the legend,
//! and a document whose bytes depend on nothing but what is drawn.

use std::sync::Arc;

use kuva::backend::svg::SvgBackend;
use kuva::plot::line::LineStyle;
use kuva::render::color::Color;
use kuva::render::figure::Figure;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene, TextAnchor};
use kuva::render::theme::Theme;

use crate::svg::{FAMILY, GRID, INK, PALE, escaped};

/// The space around the panels.
const PADDING: f64 = 10.0;
/// From one line of a legend to the next.
pub(crate) const LINE: f64 = 20.0;
/// How wide a sample of a line is in a legend: two periods of the longest dash pattern.
pub(crate) const SAMPLE: f64 = 30.0;

/// Panels in rows and columns, all of one size, with space for legends at the right and at the bottom.
///
/// Margins are fixed, not fitted to labels, so that panels stand exactly below each other and a
/// caller knows where in the scene each one is.
pub(crate) struct Panels {
    /// The width and the height of a panel's frame.
    pub(crate) frame: (f64, f64),
    /// The space at the left, at the right, above and below the frame.
    pub(crate) margins: [f64; 4],
    /// The space at the right of each row, and below all.
    pub(crate) legend: (f64, f64),
}

impl Panels {
    /// The upper left corner of a panel's frame.
    pub(crate) fn corner(&self, row: usize, column: usize) -> (f64, f64) {
        let [left, _, above, _] = self.margins;
        let (width, height) = self.cell();
        (PADDING + column as f64 * width + left, PADDING + row as f64 * height + above)
    }

    fn cell(&self) -> (f64, f64) {
        let [left, right, above, below] = self.margins;
        (left + self.frame.0 + right, above + self.frame.1 + below)
    }

    /// A layout in the house's style, its axes from and to the ends of `x` and `y`.
    pub(crate) fn layout(&self, x: (f64, f64), y: (f64, f64)) -> Layout {
        let theme = Theme {
            axis_color: INK.into(),
            grid_color: GRID.into(),
            tick_color: INK.into(),
            text_color: INK.into(),
            ..Theme::light()
        };
        let [left, right, above, below] = self.margins;
        let layout = Layout::new(x, y).with_theme(theme).with_font_family(FAMILY).with_box_axes();
        let layout = layout.with_x_axis_min(x.0).with_x_axis_max(x.1);
        let layout = layout.with_y_axis_min(y.0).with_y_axis_max(y.1);
        let layout = layout.with_force_margins(left, right).with_force_margins_y(above, below);
        layout.with_label_size(12).with_tick_size(11)
    }

    /// The rows of panels, drawn; a row may have fewer panels than others.
    pub(crate) fn scene(&self, rows: Vec<Vec<(Layout, Vec<Plot>)>>) -> Scene {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let ((width, height), count) = (self.cell(), rows.len());
        let empty = || (self.layout((0.0, 1.0), (0.0, 1.0)), Vec::new());
        let cells = rows.into_iter().flat_map(|mut row| {
            row.resize_with(columns, empty);
            row
        });
        let (layouts, plots) = cells.unzip();
        let figure = Figure::new(count, columns).with_plots(plots).with_layouts(layouts);
        let figure = figure.with_cell_size(width, height).with_spacing(0.0).with_padding(PADDING);
        let mut scene = figure.render();
        scene.width += self.legend.0;
        scene.height += self.legend.1;
        scene
    }
}

/// A line of text that begins at a point.
pub(crate) fn text(scene: &mut Scene, (x, y): (f64, f64), size: u32, colour: &str, text: &str) {
    scene.add(Primitive::Text {
        x,
        y,
        content: text.to_owned(),
        size,
        anchor: TextAnchor::Start,
        rotate: None,
        bold: false,
        color: Some(Color::from(colour)),
    });
}

/// A horizontal line from a point to the right.
pub(crate) fn sample(
    scene: &mut Scene,
    (x, y): (f64, f64),
    colour: &str,
    stroke_width: f64,
    dashes: Option<&str>,
) {
    let (x2, stroke) = (x + SAMPLE, Color::from(colour));
    let stroke_dasharray = dashes.map(str::to_owned);
    scene.add(Primitive::Line { x1: x, y1: y, x2, y2: y, stroke, stroke_width, stroke_dasharray });
}

/// A letter on a disc, around a point.
pub(crate) fn mark(scene: &mut Scene, (x, y): (f64, f64), colour: &str, letter: &str) {
    scene.add(Primitive::Circle {
        cx: x,
        cy: y,
        r: 5.2,
        fill: Color::from("#ffffff"),
        fill_opacity: None,
        stroke: Some(Color::from(colour)),
        stroke_width: Some(1.1),
    });
    scene.add(Primitive::Text {
        x,
        y: y + 2.9,
        content: letter.to_owned(),
        size: 8,
        anchor: TextAnchor::Middle,
        rotate: None,
        bold: true,
        color: Some(Color::from(colour)),
    });
}

/// A line's dashes, as SVG has them; none for a solid line.
pub(crate) fn dashes(dashes: Option<&str>) -> LineStyle {
    dashes.map_or(LineStyle::Solid, |dashes| LineStyle::Custom(dashes.to_owned()))
}

/// How the numbers at an axis are written.
pub(crate) fn format(text: impl Fn(f64) -> String + Send + Sync + 'static) -> TickFormat {
    TickFormat::Custom(Arc::new(text))
}

/// Remarks below a figure, one a line.
pub(crate) fn remarks(scene: &mut Scene, (x, y): (f64, f64), remarks: &[String]) {
    for (i, remark) in remarks.iter().enumerate() {
        text(scene, (x, y + (LINE - 4.0) * i as f64), 11, PALE, remark);
    }
}

/// The scene as an SVG document; `title` is what screen readers read.
pub(crate) fn document(title: &str, mut scene: Scene) -> String {
    // Panels are clipped by paths that kuva numbers by a counter of the process: the bytes of a figure
    // would depend on which others were drawn before. Nothing here leaves its panel.
    let clip = |e: &Primitive| matches!(e, Primitive::ClipStart { .. } | Primitive::ClipEnd);
    scene.elements.retain(|element| !clip(element));
    scene.defs.clear();
    let svg = SvgBackend::new().with_pretty(true).render_scene(&scene);
    // Without a `viewBox`, a page that makes the picture smaller cuts it off.
    let (width, height, title) = (scene.width, scene.height, escaped(title));
    let root =
        format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\" ");
    svg.replacen("<svg ", &root, 1)
}
