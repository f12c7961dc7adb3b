//! One episode as a strip of pictures (SVG).
//!
//! A picture an instant: what the agent did; the receptacle that it stands before, with its door
//! and what is seen in it; how high it looks (of four heights the filled one, with a ring at the
//! one that is needed); what is in hand; and below, the automaton state, with the reason where it
//! moved.

use std::fmt::Write as _;

use tltl_examples::svg::{Anchor, Font, INK, document, rect, text};

use crate::action::Action;
use crate::known::Known;
use crate::layout::{HORIZONS, Layout, NONE};
use crate::show::{Episode, Moment, seen};

const FAINT: &str = "#8a94a1";
const QUIET: &str = "#5b6673";
const LINE: &str = "#c3cad3";
const WRONG: &str = "#b3372a";
const CLOSED: &str = "#e3e7ec";
const OPEN: &str = "#fbf7ec";
const PLAIN: &str = "#ffffff";
/// The frame of what is not in view.
const UNSEEN: &str = "stroke-dasharray=\"4 3\" rx=\"5\"";
/// One colour a goal.
const WANTED: [&str; 4] = ["#f2b134", "#57a773", "#4c9be8", "#b07cc6"];
/// The automaton's state at first and at last, in red, green and blue.
const STATES: [[f64; 3]; 2] = [[238.0, 241.0, 245.0], [138.0, 178.0, 219.0]];

const CELL: f64 = 128.0;
const GAP: f64 = 8.0;
const PER_LINE: usize = 7;
const MARGIN: f64 = 18.0;
const HEAD: f64 = 30.0;
/// The receptacle's box: its top, left side, width and height within a cell.
const BOX: (f64, f64, f64, f64) = (40.0, 20.0, CELL - 20.0, 76.0);
/// The top of the automaton's band.
const BAND: f64 = 146.0;
const LINES: usize = 3;
const HEIGHT: f64 = BAND + 22.0 + 12.0 * LINES as f64 + 10.0;

/// The height of the key below all.
const KEY: f64 = 62.0;

/// The episode as an SVG document.
#[must_use]
pub fn svg(episode: &Episode, layout: &Layout) -> String {
    let columns = episode.moments.len().min(PER_LINE) as f64;
    let lines = episode.moments.len().div_ceil(PER_LINE) as f64;
    let bottom = MARGIN + HEAD + lines * HEIGHT;
    let mut body = String::new();
    title(&mut body, episode, layout);
    for t in 0..episode.moments.len() {
        let x = MARGIN + (t % PER_LINE) as f64 * (CELL + GAP);
        let y = MARGIN + HEAD + (t / PER_LINE) as f64 * HEIGHT;
        let _ = writeln!(body, "<g transform=\"translate({x} {y})\">");
        cell(&mut body, episode, t, layout);
        body.push_str("</g>\n");
    }
    key(&mut body, bottom);
    let size = (2.0 * MARGIN + columns * (CELL + GAP) - GAP, bottom + KEY);
    document("An episode in the kitchen, instant by instant", size, &body)
}

/// What the signs mean.
fn key(body: &mut String, top: f64) {
    let font = Font::new(10.5).fill(QUIET);
    let (left, y) = (MARGIN + 16.0, top + 8.0);
    dot(body, (MARGIN + 6.0, y), true, false);
    text(body, (left, y + 4.0), font, Anchor::Start, "how high the agent looks");
    dot(body, (MARGIN + 166.0, y), false, true);
    text(body, (left + 160.0, y + 4.0), font, Anchor::Start, "how high it must look to see into");
    let y = y + 18.0;
    rect(body, (MARGIN, y - 5.0, 12.0, 10.0), PLAIN, LINE, UNSEEN);
    text(body, (left, y + 4.0), font, Anchor::Start, "not in view");
    rect(body, (MARGIN + 160.0, y - 5.0, 12.0, 10.0), PLAIN, INK, "rx=\"3\"");
    text(body, (left + 160.0, y + 4.0), font, Anchor::Start, "in view and focused: pick takes it");
    let words =
        "✗ the action failed.  q2 → q6: the automaton moves, because of the predicates below.";
    text(body, (MARGIN, y + 22.0), font, Anchor::Start, words);
}

/// What is wanted, each in its colour.
fn title(body: &mut String, episode: &Episode, layout: &Layout) {
    let mut x = MARGIN;
    for (i, goal) in episode.goals.iter().enumerate() {
        let name =
            format!("{} into {}", words(layout, goal.object), words(layout, goal.receptacle));
        rect(body, (x, MARGIN - 2.0, 11.0, 11.0), WANTED[i % WANTED.len()], "none", "rx=\"2\"");
        text(body, (x + 16.0, MARGIN + 8.0), Font::new(13.0).bold(), Anchor::Start, &name);
        x += 16.0 + 7.2 * name.chars().count() as f64 + 20.0;
    }
    let verdict = if episode.satisfied { "satisfied" } else { "not satisfied" };
    let verdict = format!("{verdict} after {} steps", episode.steps());
    text(body, (x, MARGIN + 8.0), Font::new(13.0).fill(FAINT), Anchor::Start, &verdict);
}

fn cell(body: &mut String, episode: &Episode, t: usize, layout: &Layout) {
    let moment = &episode.moments[t];
    heading(body, moment, t, layout);
    gauge(body, &moment.known, layout);
    scene(body, episode, &moment.known, layout);
    hand(body, episode, &moment.known, layout);
    band(body, episode, t, layout);
}

/// The time and the action, which is struck out if it failed.
fn heading(body: &mut String, moment: &Moment, t: usize, layout: &Layout) {
    let (verb, object) = match moment.action {
        None => ("start".into(), String::new()),
        Some(Action::Navigate(id)) => ("go to".into(), words(layout, id)),
        Some(action) => (action.name(layout).replace('_', " "), String::new()),
    };
    let (colour, mark) = if moment.failed { (WRONG, " ✗") } else { (INK, "") };
    text(body, (0.0, 12.0), Font::new(10.0).fill(FAINT), Anchor::Start, &t.to_string());
    text(
        body,
        (BOX.1, 12.0),
        Font::new(12.5).bold().fill(colour),
        Anchor::Start,
        &format!("{verb}{mark}"),
    );
    text(body, (BOX.1, 28.0), Font::new(12.5).fill(colour), Anchor::Start, &object);
}

/// How high the agent looks.
fn gauge(body: &mut String, known: &Known, layout: &Layout) {
    let r = known.focused_receptacle(layout);
    for level in 0..HORIZONS.len() {
        let y = BOX.0 + 8.0 + 20.0 * (HORIZONS.len() - 1 - level) as f64;
        let needed = r != NONE && layout.level(r) as usize == level;
        dot(body, (6.0, y), known.level() == level, needed);
    }
}

/// A height: where the agent looks, and where it must look.
fn dot(body: &mut String, (x, y): (f64, f64), looked: bool, needed: bool) {
    if needed {
        let _ = writeln!(
            body,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"6\" fill=\"none\" stroke=\"{INK}\"/>"
        );
    }
    let fill = if looked { INK } else { PLAIN };
    let _ = writeln!(
        body,
        "<circle cx=\"{x}\" cy=\"{y}\" r=\"3.2\" fill=\"{fill}\" stroke=\"{FAINT}\"/>"
    );
}

/// The receptacle, and what is seen in it.
fn scene(body: &mut String, episode: &Episode, known: &Known, layout: &Layout) {
    let (top, left, width, height) = BOX;
    let r = known.focused_receptacle(layout);
    let visible = r != NONE && known.in_view[r as usize];
    let open = visible && known.is_open[r as usize];
    let (fill, dash) = match (visible, open) {
        (false, _) => (PLAIN, UNSEEN),
        (true, false) => (CLOSED, "rx=\"5\""),
        (true, true) => (OPEN, "rx=\"5\""),
    };
    rect(body, (left, top, width, height), fill, if visible { INK } else { LINE }, dash);
    let centre = left + width / 2.0;
    let colour = if visible { INK } else { FAINT };
    if r == NONE {
        return text(
            body,
            (centre, top + 42.0),
            Font::new(10.5).fill(FAINT),
            Anchor::Middle,
            "nowhere yet",
        );
    }
    text(
        body,
        (centre, top + 14.0),
        Font::new(11.0).bold().fill(colour),
        Anchor::Middle,
        &words(layout, r),
    );
    let note = match (visible, open) {
        (false, _) => "not in view",
        (true, false) => "closed",
        (true, true) if seen(known, layout).is_empty() => "empty",
        _ => "",
    };
    text(body, (centre, top + 42.0), Font::new(10.5).fill(FAINT), Anchor::Middle, note);
    let contents = seen(known, layout);
    // One below the other while there is room.
    let columns = if contents.len() <= 3 { 1 } else { 2 };
    let wide = (width - 4.0 * (columns + 1) as f64) / columns as f64;
    for (i, o) in contents.into_iter().enumerate() {
        let (column, row) = ((i % columns) as f64, (i / columns) as f64);
        let at = (left + 4.0 + column * (wide + 4.0), top + 21.0 + row * 18.0, wide, 15.0);
        chip(body, at, episode, o, known.focus == o, layout);
    }
}

/// An object: in the colour of its goal, framed if it is focused.
fn chip(
    body: &mut String,
    (x, y, width, height): (f64, f64, f64, f64),
    episode: &Episode,
    o: u8,
    focused: bool,
    layout: &Layout,
) {
    let goal = episode.goals.iter().position(|goal| goal.object == o);
    let fill = goal.map_or(PLAIN, |i| WANTED[i % WANTED.len()]);
    let stroke = if focused { INK } else { LINE };
    rect(body, (x, y, width, height), fill, stroke, "rx=\"3\"");
    let name = words(layout, o);
    let size = (width / name.chars().count() as f64 / 0.56).min(9.5);
    text(body, (x + width / 2.0, y + 11.0), Font::new(size), Anchor::Middle, &name);
}

fn hand(body: &mut String, episode: &Episode, known: &Known, layout: &Layout) {
    let y = BOX.0 + BOX.3 + 8.0;
    text(body, (BOX.1, y + 11.0), Font::new(10.0).fill(FAINT), Anchor::Start, "hand");
    if known.hand == NONE {
        return text(
            body,
            (BOX.1 + 30.0, y + 11.0),
            Font::new(10.0).fill(FAINT),
            Anchor::Start,
            "empty",
        );
    }
    chip(body, (BOX.1 + 30.0, y, 64.0, 15.0), episode, known.hand, false, layout);
}

/// The automaton state, and why it moved.
fn band(body: &mut String, episode: &Episode, t: usize, layout: &Layout) {
    let q = episode.moments[t].q;
    let moves =
        |until: usize| (0..until).filter(|&t| episode.moved_from(t).is_some()).count() as f64;
    let progress = moves(t + 1) / moves(episode.moments.len()).max(1.0);
    let last = t + 1 == episode.moments.len() || t % PER_LINE == PER_LINE - 1;
    let width = if last { CELL } else { CELL + GAP + 0.6 };
    rect(body, (0.0, BAND, width, 16.0), &shade(progress), "none", "");
    let Some(before) = episode.moved_from(t) else {
        let label = format!("q{q}");
        return text(body, (6.0, BAND + 12.0), Font::new(10.5).fill(QUIET), Anchor::Start, &label);
    };
    let _ = writeln!(body, "<path d=\"M0.75 {BAND}v16\" stroke=\"{INK}\" stroke-width=\"1.5\"/>");
    let label = format!("q{before} → q{q}");
    text(body, (6.0, BAND + 12.0), Font::new(10.5).bold(), Anchor::Start, &label);
    let reasons: Vec<String> = episode.moments[t].reasons.iter().map(|p| p.name(layout)).collect();
    for (i, line) in wrapped(&reasons, 25).iter().take(LINES).enumerate() {
        let y = BAND + 28.0 + 12.0 * i as f64;
        text(body, (0.0, y), Font::new(9.5), Anchor::Start, line);
    }
}

/// The colour of an automaton state, by how far the episode has come: 0 to 1.
fn shade(progress: f64) -> String {
    let mix = |i: usize| STATES[0][i] + progress * (STATES[1][i] - STATES[0][i]);
    format!("rgb({:.0},{:.0},{:.0})", mix(0), mix(1), mix(2))
}

/// The reasons, as many on a line as have room, longer ones broken at their comma.
fn wrapped(reasons: &[String], most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for reason in reasons {
        let parts: Vec<&str> = if reason.chars().count() > most {
            reason.split_inclusive(", ").collect()
        } else {
            vec![reason]
        };
        for part in parts {
            match lines.last_mut() {
                Some(line) if line.chars().count() + 1 + part.chars().count() <= most => {
                    line.push(' ');
                    line.push_str(part);
                }
                _ => lines.push(part.to_string()),
            }
        }
    }
    lines
}

/// A name to be read: `butter knife`.
fn words(layout: &Layout, id: u8) -> String {
    layout.name(id).replace('_', " ")
}
