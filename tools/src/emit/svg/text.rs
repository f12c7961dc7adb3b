//! Texts of a picture: their widths, their lines, and the legend for those that are too long.
//!
//! Widths are estimated, since no font is read: a table of the advances of Helvetica, and 4 % more
//! for the fonts that stand in for it. Layout needs widths before anything is drawn, and the same
//! ones on every machine.

use std::fmt::Write as _;

use super::number;
use crate::emit::sum::{Notation, Sum};
use tltl_compiler::dfa::{Dfa, Edge};

/// The size and the weight of a text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font {
    pub(super) size: f64,
    weight: &'static str,
}

/// Guards and the legend.
pub(super) const SMALL: Font = Font { size: 11.0, weight: "normal" };
/// Names of states.
pub(super) const STATE: Font = Font { size: 13.0, weight: "normal" };
/// The line above the picture.
pub(super) const TITLE: Font = Font { size: 14.0, weight: "bold" };
/// The distance between two lines of a guard.
pub(super) const LINE: f64 = 13.0;
/// The width to which a guard is wrapped, if it can be broken.
const WRAP: f64 = 118.0;
/// The most lines of a guard on an edge; a longer one goes to the legend.
const LINES: usize = 3;
/// The least width of the legend.
const LEGEND: f64 = 360.0;
/// The least room between two words of a line.
const SPACE: f64 = 4.0;
/// Helvetica and the free fonts of the same widths, since [`width`] knows no others.
const FAMILY: &str = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

/// A guard as it stands on an edge: its lines from top to bottom.
#[derive(Clone, Debug)]
pub(super) struct Label {
    lines: Vec<String>,
    pub(super) width: f64,
}

impl Label {
    fn new(lines: Vec<String>) -> Self {
        let width = lines.iter().map(|line| width(line, SMALL)).fold(0.0, f64::max);
        Self { lines, width }
    }

    /// The height of all lines.
    pub(super) fn height(&self) -> f64 {
        LINE * self.lines.len() as f64
    }

    /// Draws the label, its last line standing at `bottom`.
    pub(super) fn draw(&self, x: f64, bottom: f64, colour: &str) -> String {
        let mut drawn = String::new();
        for (i, line) in self.lines.iter().rev().enumerate() {
            drawn.push_str(&centred(x, bottom - LINE * i as f64, line, &SMALL, colour));
        }
        drawn
    }
}

/// The guards that are too long to stand on an edge, numbered in order of appearance.
pub(super) struct Legend {
    guards: Vec<Vec<String>>,
    notation: Notation,
}

impl Legend {
    /// A legend without guards.
    pub(super) fn new(notation: Notation) -> Self {
        Self { guards: Vec::new(), notation }
    }

    /// The label of an edge. A guard that is too long becomes a name, and equal guards the same
    /// name.
    pub(super) fn label(&mut self, dfa: &Dfa, edge: &Edge) -> Label {
        let sum = Sum::new(&dfa.propositions, &edge.guard).notation(self.notation);
        let products: Vec<String> = sum.products().collect();
        let lines = wrap(&products, self.notation.or(), WRAP);
        if lines.len() <= LINES && lines.iter().all(|line| width(line, SMALL) <= 2.0 * WRAP) {
            return Label::new(lines);
        }
        let known = self.guards.iter().position(|guard| *guard == products);
        let place = known.unwrap_or(self.guards.len());
        if known.is_none() {
            self.guards.push(products);
        }
        Label::new(vec![format!("g{}", subscript(place + 1))])
    }

    /// Draws the legend; returns its height, and the width that the picture needs for it.
    pub(super) fn draw(&self, x: f64, top: f64, room: f64, body: &mut String) -> (f64, f64) {
        if self.guards.is_empty() {
            return (0.0, room);
        }
        let (mut y, mut widest) = (top + LINE, room);
        for (i, guard) in self.guards.iter().enumerate() {
            let name = format!("g{} = ", subscript(i + 1));
            let indent = width(&name, SMALL) + 2.0;
            body.push_str(&line(x, y, &name, &SMALL));
            for text in wrap(guard, self.notation.or(), room.max(LEGEND) - 2.0 * x - indent) {
                body.push_str(&line(x + indent, y, &text, &SMALL));
                widest = widest.max(2.0 * x + indent + width(&text, SMALL));
                y += LINE + 1.0;
            }
            y += 3.0;
        }
        (y - top, widest)
    }
}

/// Puts products on lines; a line ends with the operator that goes on in the next.
fn wrap(products: &[String], or: &str, limit: f64) -> Vec<String> {
    let joined = products.iter().enumerate().map(|(i, product)| {
        let more = if i + 1 < products.len() { or.trim_end() } else { "" };
        format!("{product}{more}")
    });
    fill(joined, SMALL, limit)
}

/// A title on as few lines as the width allows, and at least 320 pixels wide.
pub(super) fn wrap_title(title: &str, limit: f64) -> Vec<String> {
    fill(title.split_whitespace().map(str::to_owned), TITLE, limit.max(320.0))
}

/// Puts each word on the current line if it fits, else on a new one; a word that is wider than the
/// limit has a line of its own.
fn fill(words: impl Iterator<Item = String>, font: Font, limit: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        match lines.last_mut() {
            Some(last) if width(last, font) + width(&word, font) + SPACE <= limit => {
                last.push(' ');
                last.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// A number in subscript digits.
fn subscript(number: usize) -> String {
    let digit = |c: char| char::from_u32(0x2080 + c.to_digit(10).unwrap_or(0)).unwrap_or(c);
    number.to_string().chars().map(digit).collect()
}

/// The width of a text, estimated for the widest of the fonts.
pub(super) fn width(text: &str, font: Font) -> f64 {
    let bold = if font.weight == "bold" { 1.06 } else { 1.0 };
    text.chars().map(advance).sum::<f64>() * font.size * 1.04 * bold
}

/// The advance of a character in Helvetica, over the size of the font; similar characters are
/// grouped, and rounded up.
fn advance(c: char) -> f64 {
    match c {
        'i' | 'j' | 'l' | '\'' => 0.22,
        ' ' | '!' | ',' | '.' | ':' | ';' | '/' | '\\' | '|' | '[' | ']' | 'I' | 'f' | 't' => 0.28,
        '(' | ')' | '{' | '}' | '-' | 'r' | '"' | '`' => 0.35,
        '₀'..='₉' => 0.37,
        'c' | 'k' | 's' | 'v' | 'x' | 'y' | 'z' | 'J' => 0.5,
        '<' | '>' | '=' | '+' | '~' | '¬' | '≤' | '≥' | '≠' => 0.6,
        '∧' | '∨' => 0.66,
        'w' => 0.72,
        'm' | 'M' => 0.84,
        'W' | '@' | '%' => 0.98,
        '&' | 'A'..='Z' => 0.7,
        '\u{1100}'.. => 1.0,
        _ => 0.56,
    }
}

/// A text that begins at `x`.
pub(super) fn line(x: f64, y: f64, text: &str, font: &Font) -> String {
    element(x, y, text, font, "start", super::INK)
}

/// A text around `x`.
pub(super) fn centred(x: f64, y: f64, text: &str, font: &Font, colour: &str) -> String {
    element(x, y, text, font, "middle", colour)
}

/// A text element.
fn element(x: f64, y: f64, text: &str, font: &Font, anchor: &str, colour: &str) -> String {
    let mut element = format!("<text x=\"{}\" y=\"{}\"", number(x), number(y));
    let _ = write!(element, " font-family=\"{FAMILY}\" font-size=\"{}\"", number(font.size));
    if font.weight != "normal" {
        let _ = write!(element, " font-weight=\"{}\"", font.weight);
    }
    let _ =
        writeln!(element, " text-anchor=\"{anchor}\" fill=\"{colour}\">{}</text>", escape(text));
    element
}

/// Escapes text for XML. Control characters, which XML cannot express, are left out.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' | '\r' => escaped.push(' '),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => {}
            c => escaped.push(c),
        }
    }
    escaped
}
