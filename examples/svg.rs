//! The elements of the pictures that are drawn by hand, and the inks of all.
//!
//! All pictures have a light ground of their own, so that they are read on dark pages, too, and text
//! is text: it can be searched, and is read aloud.

use std::fmt::Write as _;

/// The colour of text and lines.
pub const INK: &str = "#1d2733";

/// The colour of what is said beside.
pub const PALE: &str = "#6b7684";

/// The colour of lines that guide the eye.
pub const GRID: &str = "#e3e7ec";

/// The letters.
pub const FAMILY: &str = "Helvetica, Arial, sans-serif";

/// How a text looks.
#[derive(Clone, Copy, Debug)]
pub struct Font {
    /// The height of a line, in pixels.
    pub size: f64,
    /// Whether it is bold.
    pub weight: Weight,
    /// Its colour.
    pub fill: &'static str,
}

/// How thick letters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// As usual.
    Normal,
    /// Thicker.
    Bold,
}

impl Font {
    /// Letters of a size, in ink.
    #[must_use]
    pub const fn new(size: f64) -> Self {
        Self { size, weight: Weight::Normal, fill: INK }
    }

    /// The same, bold.
    #[must_use]
    pub const fn bold(self) -> Self {
        Self { weight: Weight::Bold, ..self }
    }

    /// The same in another colour.
    #[must_use]
    pub const fn fill(self, fill: &'static str) -> Self {
        Self { fill, ..self }
    }
}

/// Where a text's point is in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Where it begins.
    Start,
    /// In its middle.
    Middle,
}

/// Writes a line of text at a point.
pub fn text(svg: &mut String, (x, y): (f64, f64), font: Font, anchor: Anchor, content: &str) {
    let Font { size, weight, fill } = font;
    let _ = write!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size:.1}\" fill=\"{fill}\"");
    if anchor == Anchor::Middle {
        svg.push_str(" text-anchor=\"middle\"");
    }
    if weight == Weight::Bold {
        svg.push_str(" font-weight=\"bold\"");
    }
    let _ = writeln!(svg, ">{}</text>", escaped(content));
}

/// Writes a rectangle: its left, top, width and height. `more` are further attributes.
pub fn rect(
    svg: &mut String,
    (x, y, width, height): (f64, f64, f64, f64),
    fill: &str,
    stroke: &str,
    more: &str,
) {
    let _ = writeln!(
        svg,
        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
         fill=\"{fill}\" stroke=\"{stroke}\" {more}/>"
    );
}

/// A whole document of a width and a height; `title` is what screen readers read.
#[must_use]
pub fn document(title: &str, (width, height): (f64, f64), body: &str) -> String {
    let title = escaped(title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-label=\"{title}\" \
         font-family=\"{FAMILY}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n\
         {body}</svg>\n"
    )
}

/// A text as XML has it, in an element or in an attribute.
#[must_use]
pub fn escaped(content: &str) -> String {
    content.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
