//! What all figures have in common: their ink, their letters.

use std::fmt::Write as _;

/// The colour of text and lines.
pub const INK: &str = "#1d2733";

/// The letters, as an attribute.
pub const FONT: &str = "font-family=\"Helvetica, Arial, sans-serif\"";

/// Writes a line of text of `size` pixels at a point, which is its `anchor`: `start`, `middle` or `end`.
pub fn text(
    svg: &mut String,
    (x, y): (f64, f64),
    size: u32,
    anchor: &str,
    fill: &str,
    content: &str,
) {
    let content = escaped(content);
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
         fill=\"{fill}\">{content}</text>"
    );
}

/// A text with what XML takes for its own written as it wants it.
#[must_use]
pub fn escaped(content: &str) -> String {
    content.replace('&', "&amp;").replace('<', "&lt;")
}
