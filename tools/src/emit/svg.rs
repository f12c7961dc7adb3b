//! Automata as pictures, drawn without any other program.
//!
//! The private module `layout` chooses the positions; this one draws. The initial state has an
//! arrow from nowhere, the accepting state two circles, the trap is dashed and grey, and each edge
//! is a smooth line with its guard standing on it. Guards are wrapped; a guard that is too long
//! even so gets a name, and stands in a legend below the picture.
//!
//! Every shape carries its own attributes, without styles and ids, so that a [`Drawing`] can be put
//! into any other picture. Text is text. Colours keep their contrast in grey print.
//!
//! A picture is meant to be read up to about 40 states. Larger ones are still correct; beyond
//! [`MOST_STATES`] or [`MOST_EDGES`] the drawing only says how large the automaton is.

mod curve;
mod text;

use std::fmt::Write as _;

use crate::emit::layout::{Graph, Layout, Link, Room, layout};
use crate::emit::sum::Notation;
use tltl_compiler::dfa::{Dfa, Edge, Size, State};

use curve::Arrow;
use text::{Label, Legend};

/// A picture, or a part of one: elements of SVG in a box from (0, 0) to (width, height).
///
/// A part becomes a document by [`document`], or is placed in a larger picture with a `transform`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// The width, in pixels.
    pub width: f64,
    /// The height, in pixels.
    pub height: f64,
    /// The elements, as SVG text.
    pub body: String,
}

/// The place of a state in a drawing, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// The state.
    pub state: State,
    /// The centre, from the left.
    pub x: f64,
    /// The centre, from the top.
    pub y: f64,
    /// The radius.
    pub radius: f64,
}

/// The options of a drawing. The default has no title, mathematical notation, the trap, and numbers
/// for names.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// A title above the picture, wrapped to its width.
    pub title: Option<&'a str>,
    /// The symbols in which guards are printed.
    pub notation: Notation,
    /// Whether the trap and the edges into it are drawn. Left out, every guard that is missing
    /// leads to the trap.
    pub trap: bool,
    /// The names in the states, by number; numbers where there is none.
    pub names: Option<&'a [String]>,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { title: None, notation: Notation::Mathematical, trap: true, names: None }
    }
}

const INK: &str = "#1d2733";
const GREY: &str = "#7d858f";
const FILL: &str = "#f3f6fa";
const ACCEPTING: (&str, &str) = ("#e5f3e8", "#17653a");
const LOST: &str = "#f4f4f4";
/// The margin around the picture.
const MARGIN: f64 = 10.0;
/// The room on the left for the arrow to the initial state.
const ARROW: f64 = 26.0;
/// The height of a self-loop above its state.
const LOOP: f64 = 17.0;

/// The most states that are drawn. Nobody reads more; a table or HOA serves
/// better.
pub const MOST_STATES: usize = 1024;
/// The most edges between different states that are drawn.
pub const MOST_EDGES: usize = 4096;

/// An automaton as an SVG document with a title.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let svg = tltlc::emit::svg::automaton("order", task.dfa());
/// assert!(svg.starts_with("<svg xmlns="));
/// // Three states; the accepting one has a second circle.
/// assert_eq!(svg.matches("<circle").count(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn automaton(title: &str, dfa: &Dfa) -> String {
    document(title, &drawing(dfa, &Options { title: Some(title), ..Options::default() }))
}

/// A whole SVG document on a white ground; `title` is what screen readers read.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::emit::svg::{Drawing, Options, document, drawing};
///
/// // Two automata side by side.
/// let [a, b] = ["F a", "a T b"].map(|formula| tltlc::task::compile(formula, Budget::default()));
/// let [a, b] = [a?, b?].map(|task| drawing(task.dfa(), &Options::default()));
/// let beside = format!("{}<g transform=\"translate({} 0)\">{}</g>", a.body, a.width, b.body);
/// let both = Drawing { width: a.width + b.width, height: a.height.max(b.height), body: beside };
/// assert!(document("two tasks", &both).contains("<title>two tasks</title>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn document(title: &str, drawing: &Drawing) -> String {
    let (width, height) = (number(drawing.width), number(drawing.height));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\">\n<title>{}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
        text::escape(title),
        drawing.body
    )
}

/// An automaton as a drawing to be put into a larger picture.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::emit::svg::{Options, drawing};
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let names = ["start", "a seen", "done"].map(str::to_owned);
/// let part = drawing(task.dfa(), &Options { names: Some(&names), ..Options::default() });
/// assert!(part.width > 0.0 && part.body.contains(">a seen</text>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn drawing(dfa: &Dfa, options: &Options) -> Drawing {
    placed(dfa, options).0
}

/// The same with the circles of the states, in the coordinates of the drawing, for whoever marks
/// some of them. There are none where the automaton is too large to be drawn.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::emit::svg::{Options, placed};
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let (drawing, circles) = placed(task.dfa(), &Options::default());
/// assert_eq!(circles.iter().map(|circle| circle.state).collect::<Vec<_>>(), [0, 1, 2]);
/// assert!(circles.iter().all(|circle| circle.x + circle.radius < drawing.width));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn placed(dfa: &Dfa, options: &Options) -> (Drawing, Vec<Circle>) {
    let size = dfa.size();
    if size.states > MOST_STATES || size.edges > MOST_EDGES {
        return (too_large(size), Vec::new());
    }
    let picture = Picture::new(dfa, options);
    let layout = layout(&picture.graph());
    picture.draw(&layout)
}

/// The drawing in place of an automaton that is too large: one line with its sizes.
fn too_large(size: Size) -> Drawing {
    let message = format!("{} states and {} edges: too many to draw", size.states, size.edges);
    let width = text::width(&message, text::STATE) + 2.0 * MARGIN;
    let body = text::line(MARGIN, 24.0, &message, &text::STATE);
    Drawing { width, height: 24.0 + 2.0 * MARGIN, body }
}

/// The elements of a picture before they have positions: states in order, self-loops by state,
/// other edges with their labels.
struct Picture<'a> {
    dfa: &'a Dfa,
    options: &'a Options<'a>,
    states: Vec<State>,
    loops: Vec<Option<Label>>,
    links: Vec<(Edge, Label)>,
    legend: Legend,
    radius: f64,
}

impl<'a> Picture<'a> {
    /// Collects the elements, and moves long guards to the legend.
    fn new(dfa: &'a Dfa, options: &'a Options<'a>) -> Self {
        let drawn = |q: State| options.trap || dfa.trap != Some(q) || q == 0;
        let states: Vec<_> = dfa.states().filter(|&q| drawn(q)).collect();
        let mut legend = Legend::new(options.notation);
        let mut loops = vec![None; states.len()];
        let mut links = Vec::new();
        for edge in dfa.edges().into_iter().filter(|edge| drawn(edge.to) && drawn(edge.from)) {
            let label = legend.label(dfa, &edge);
            if edge.is_loop() {
                let place = states.binary_search(&edge.from).unwrap_or(0);
                loops[place] = Some(label);
            } else {
                links.push((edge, label));
            }
        }
        let mut picture = Self { dfa, options, states, loops, links, legend, radius: 0.0 };
        picture.radius = picture.radius();
        picture
    }

    /// The radius of all states: large enough for the longest name, and for the arrowheads at the
    /// busiest state.
    fn radius(&self) -> f64 {
        let mut arrows = vec![0; self.dfa.len()];
        self.links.iter().for_each(|(edge, _)| arrows[edge.to as usize] += 1);
        let busiest = arrows.into_iter().max().unwrap_or(0);
        let names = self.states.iter().map(|&q| text::width(&self.name(q), text::STATE));
        let longest = names.fold(0.0, f64::max);
        (longest / 2.0 + 6.0).max(2.2 * f64::from(busiest)).clamp(16.0, 40.0)
    }

    /// The text in a state.
    fn name(&self, q: State) -> String {
        let given = self.options.names.and_then(|names| names.get(q as usize));
        given.cloned().unwrap_or_else(|| q.to_string())
    }

    /// The index of a state among those that are drawn.
    fn place(&self, q: State) -> usize {
        self.states.binary_search(&q).unwrap_or(0)
    }

    /// The graph to be laid out. Edges into the trap pull weakly, so that they do not bend the
    /// others.
    fn graph(&self) -> Graph {
        let links = self.links.iter().map(|(edge, label)| Link {
            from: self.place(edge.from),
            to: self.place(edge.to),
            label: Room { width: label.width + 8.0, up: label.height() + 2.0, down: 3.0 },
            weight: if self.dfa.trap == Some(edge.to) { 0.03 } else { 1.0 },
        });
        let shown = |q: Option<State>| q.and_then(|q| self.states.binary_search(&q).ok());
        Graph {
            nodes: self.loops.iter().map(|label| self.room(label.as_ref())).collect(),
            links: links.collect(),
            radius: self.radius,
            last: shown(self.dfa.accepting),
            lowest: shown(self.dfa.trap),
        }
    }

    /// The room of a state with its self-loop above it.
    fn room(&self, label: Option<&Label>) -> Room {
        let above = label.map_or(0.0, |label| LOOP + label.height() + 3.0);
        let width = label.map_or(0.0, |label| label.width).max(2.0 * self.radius);
        Room { width: width + 4.0, up: self.radius + above + 2.0, down: self.radius + 3.0 }
    }

    /// Draws everything at its place, title above and legend below.
    fn draw(&self, layout: &Layout) -> (Drawing, Vec<Circle>) {
        let title = self.options.title.map(|title| text::wrap_title(title, layout.width + ARROW));
        let top = MARGIN + title.as_ref().map_or(0.0, |lines| 18.0 * lines.len() as f64 + 8.0);
        let mut body = String::new();
        let mut width = layout.width + ARROW + 2.0 * MARGIN;
        for (i, line) in title.iter().flatten().enumerate() {
            let y = MARGIN + 13.0 + 18.0 * i as f64;
            body.push_str(&text::line(MARGIN, y, line, &text::TITLE));
            width = width.max(text::width(line, text::TITLE) + 2.0 * MARGIN);
        }
        let shift = format!("translate({} {})", number(MARGIN + ARROW), number(top));
        let _ = writeln!(body, "<g transform=\"{shift}\">");
        self.draw_links(layout, &mut body);
        self.draw_states(layout, &mut body);
        body.push_str("</g>\n");
        let bottom = top + layout.height + MARGIN;
        let (below, legend_width) = self.legend.draw(MARGIN, bottom, width, &mut body);
        let (left, radius) = (MARGIN + ARROW, self.radius);
        let circle =
            |(&state, &(x, y)): (&State, &_)| Circle { state, x: x + left, y: y + top, radius };
        let circles = self.states.iter().zip(&layout.nodes).map(circle).collect();
        (Drawing { width: width.max(legend_width), height: bottom + below, body }, circles)
    }

    fn draw_states(&self, layout: &Layout, body: &mut String) {
        for (i, &q) in self.states.iter().enumerate() {
            let (x, y) = layout.nodes[i];
            if q == 0 {
                let tip = x - self.radius - 0.5;
                let arrow = Arrow::line((tip - ARROW + 4.0, y), (tip, y));
                body.push_str(&arrow.draw(INK));
            }
            if let Some(label) = &self.loops[i] {
                let colour = self.colour(q);
                body.push_str(&Arrow::loop_above((x, y), self.radius, LOOP).draw(colour));
                body.push_str(&label.draw(x, y - self.radius - LOOP - 4.0, colour));
            }
            self.draw_state(q, (x, y), body);
        }
    }

    /// A state: one circle, or two if it accepts.
    fn draw_state(&self, q: State, (x, y): (f64, f64), body: &mut String) {
        let accepting = self.dfa.accepting == Some(q);
        let lost = self.dfa.trap == Some(q);
        let (fill, stroke) = match (accepting, lost) {
            (true, _) => ACCEPTING,
            (_, true) => (LOST, GREY),
            _ => (FILL, INK),
        };
        let dashes = if lost { " stroke-dasharray=\"3.5 2.5\"" } else { "" };
        let mut circle = |radius: f64, fill: &str| {
            let _ = writeln!(
                body,
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{fill}\" stroke=\"{stroke}\" \
                 stroke-width=\"1.2\"{dashes}/>",
                number(x),
                number(y),
                number(radius)
            );
        };
        circle(self.radius, fill);
        if accepting {
            circle(self.radius - 3.0, "none");
        }
        let ink = if lost { GREY } else { INK };
        body.push_str(&text::centred(x, y + 4.5, &self.name(q), &text::STATE, ink));
    }

    /// Draws the edges. Those into the trap are grey and lie below the others.
    fn draw_links(&self, layout: &Layout, body: &mut String) {
        let mut drawn: Vec<(bool, String)> = Vec::new();
        for (i, (edge, label)) in self.links.iter().enumerate() {
            let colour = self.colour(edge.to);
            let route = &layout.routes[i];
            let arrow = Arrow::route(route);
            let (x, y) = route.label;
            let label = label.draw(x, y - 4.0, colour);
            drawn.push((colour == INK, format!("{}{label}", arrow.draw(colour))));
        }
        drawn.sort_by_key(|&(dark, _)| dark);
        drawn.iter().for_each(|(_, elements)| body.push_str(elements));
    }

    /// The colour of an edge, by the state that it enters.
    fn colour(&self, to: State) -> &'static str {
        if self.dfa.trap == Some(to) { GREY } else { INK }
    }
}

/// A coordinate to a tenth of a pixel, without trailing zeros: files stay small, and equal on every
/// machine.
pub(crate) fn number(value: f64) -> String {
    let tenths = (value * 10.0).round() as i64;
    let sign = if tenths < 0 { "-" } else { "" };
    let (whole, part) = (tenths.abs() / 10, tenths.abs() % 10);
    if part == 0 { format!("{sign}{whole}") } else { format!("{sign}{whole}.{part}") }
}
