//! Pictures of automata and of policies on a grid, as in the paper's Figure 2.

use std::fmt::Write as _;

use tltl_compiler::dfa::Dfa;
use tltlc::emit::svg::{self, Drawing, Options};

use crate::grid::Grid;
use crate::svg::{FONT, INK, escaped};

const LINE: &str = "#d5dae1";
const WRONG: &str = "#f7d4cf";
const REGIONS: [&str; 6] = ["#f2b134", "#57a773", "#4c9be8", "#b07cc6", "#e07a5f", "#8d99ae"];

/// A region of the grid: its name and its cells.
#[derive(Clone, Debug)]
pub struct Region {
    /// The letter that stands in it.
    pub name: String,
    /// The numbers of its cells.
    pub cells: Vec<usize>,
}

/// A policy at one automaton state.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// The action in each cell.
    pub actions: Vec<u32>,
    /// The cells in which that action is not optimal.
    pub wrong: Vec<usize>,
}

/// One row of the figure: an automaton and the policy at each of its live states.
pub struct Row<'a> {
    /// What stands above it.
    pub title: String,
    /// The automaton.
    pub dfa: &'a Dfa,
    /// The policies, one a live state.
    pub panels: Vec<Panel>,
}

/// The side of a cell, in pixels.
const CELL: f64 = 19.0;
const GAP: f64 = 26.0;
const MARGIN: f64 = 24.0;
const PER_LINE: usize = 4;

/// The whole figure as an SVG document.
#[must_use]
pub fn figure(grid: &Grid, regions: &[Region], rows: &[Row<'_>]) -> String {
    let automata: Vec<Drawing> =
        rows.iter().map(|row| svg::drawing(row.dfa, &Options::default())).collect();
    let left = automata.iter().map(|drawing| drawing.width).fold(0.0, f64::max);
    let (panel_width, panel_height) = (panel_width(grid), panel_height(grid));
    let columns = rows.iter().map(|row| row.panels.len().min(PER_LINE)).max().unwrap_or(1);
    let width = 2.0 * MARGIN + left + GAP + columns as f64 * (panel_width + GAP);
    let mut body = String::new();
    let mut y = MARGIN;
    for (row, automaton) in rows.iter().zip(&automata) {
        let lines = row.panels.len().div_ceil(PER_LINE);
        let height = (lines as f64 * panel_height).max(automaton.height);
        text(&mut body, MARGIN, y + 12.0, 15.0, "start", "bold", &row.title);
        y += 26.0;
        let down = y + (height - automaton.height) / 2.0;
        let across = MARGIN + (left - automaton.width) / 2.0;
        let _ = writeln!(
            body,
            "<g transform=\"translate({across:.1} {down:.1})\">{}</g>",
            automaton.body
        );
        for (i, panel) in row.panels.iter().enumerate() {
            let x = MARGIN + left + GAP + (i % PER_LINE) as f64 * (panel_width + GAP);
            let top = y + (i / PER_LINE) as f64 * panel_height;
            let _ = writeln!(body, "<g transform=\"translate({x:.1} {top:.1})\">");
            draw(&mut body, grid, regions, panel);
            body.push_str("</g>\n");
        }
        y += height + 10.0;
    }
    legend(&mut body, MARGIN, y);
    svg::document("Automata and policies", &Drawing { width, height: y + 30.0, body })
}

fn panel_width(grid: &Grid) -> f64 {
    f64::from(grid.width) * CELL
}

fn panel_height(grid: &Grid) -> f64 {
    f64::from(grid.height) * CELL + 20.0 + 12.0
}

fn draw(body: &mut String, grid: &Grid, regions: &[Region], panel: &Panel) {
    text(body, panel_width(grid) / 2.0, 12.0, 12.0, "middle", "normal", &panel.title);
    let place = |s: usize| {
        let (x, y) = (s as i32 % grid.width, s as i32 / grid.width);
        (f64::from(x) * CELL, 20.0 + f64::from(grid.height - 1 - y) * CELL)
    };
    for s in 0..panel.actions.len() {
        let (x, y) = place(s);
        let region = regions.iter().position(|region| region.cells.contains(&s));
        let fill = match region {
            Some(region) => REGIONS[region % REGIONS.len()],
            None if panel.wrong.contains(&s) => WRONG,
            None => "#ffffff",
        };
        let _ = writeln!(
            body,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{CELL}\" height=\"{CELL}\" fill=\"{fill}\" \
             stroke=\"{LINE}\"/>"
        );
    }
    for (s, &action) in panel.actions.iter().enumerate() {
        let (x, y) = place(s);
        act(body, x + CELL / 2.0, y + CELL / 2.0, action);
    }
    for region in regions {
        for &s in &region.cells {
            let (x, y) = place(s);
            text(body, x + 3.5, y + 7.5, 8.0, "middle", "bold", &region.name);
        }
    }
}

/// An arrow in the direction of the action; a dot for staying.
fn act(body: &mut String, x: f64, y: f64, action: u32) {
    let (_, dx, dy) = Grid::ACTIONS[action as usize];
    let (dx, dy) = (f64::from(dx), -f64::from(dy));
    if dx == 0.0 && dy == 0.0 {
        let _ = writeln!(body, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"#2f6fb3\"/>");
        return;
    }
    let (half, head) = (6.0, 3.2);
    let (tip_x, tip_y) = (x + dx * half, y + dy * half);
    let (base_x, base_y) = (tip_x - dx * head * 1.5, tip_y - dy * head * 1.5);
    let _ = writeln!(
        body,
        "<path d=\"M{:.1} {:.1}L{base_x:.1} {base_y:.1}\" stroke=\"{INK}\" stroke-width=\"1.3\"/>\
         <path d=\"M{tip_x:.1} {tip_y:.1}L{:.1} {:.1}L{:.1} {:.1}Z\" fill=\"{INK}\"/>",
        x - dx * half,
        y - dy * half,
        base_x - dy * head,
        base_y + dx * head,
        base_x + dy * head,
        base_y - dx * head,
    );
}

fn legend(body: &mut String, x: f64, y: f64) {
    let _ = writeln!(
        body,
        "<rect x=\"{x:.1}\" y=\"{:.1}\" width=\"12\" height=\"12\" fill=\"{WRONG}\" stroke=\"{LINE}\"/>",
        y - 2.0
    );
    let about = "the action shown is not optimal there; arrows: moves, dots: staying";
    text(body, x + 18.0, y + 8.0, 11.0, "start", "normal", about);
}

fn text(body: &mut String, x: f64, y: f64, size: f64, anchor: &str, weight: &str, content: &str) {
    let content = escaped(content);
    let _ = writeln!(
        body,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" text-anchor=\"{anchor}\" \
         font-weight=\"{weight}\" fill=\"{INK}\" {FONT}>{content}</text>"
    );
}
