//! Pictures of automata and of policies on a grid, as in the paper's Figure 2.

use std::fmt::Write as _;

use tltl::Mismatch;
use tltl::prelude::*;
use tltl::solve::Optimum;
use tltl_compiler::dfa::{Dfa, State};
use tltlc::emit::svg::{Drawing, Options, drawing};

use crate::grid::{Cell, Grid};
use crate::svg::{Anchor, Font, INK, PALE, document, rect, text};

const LINE: &str = "#d5dae1";
/// What a cell loses by its action, up to a share of the largest value there, and its colour.
const LOSSES: [(f64, &str, &str); 3] =
    [(0.001, "#fbe4df", "up to 0.1 %"), (0.05, "#f3b3a6", "up to 5 %"), (1.0, "#df7361", "more")];
const REGIONS: [&str; 6] = ["#f2b134", "#57a773", "#4c9be8", "#b07cc6", "#e07a5f", "#8d99ae"];

/// A predicate of the task file's module.
pub type Robustness = fn(&Cell) -> f64;

/// A region of the grid: its name and its cells.
struct Region {
    name: String,
    cells: Vec<usize>,
}

/// A policy at one automaton state.
struct Panel {
    /// What stands above it.
    title: String,
    /// The action in each cell.
    actions: Vec<usize>,
    /// What it gives away in each cell: the share of the largest expected return from there.
    losses: Vec<f64>,
}

/// One row of the figure: an automaton and the policy at each of its live states.
struct Row {
    title: String,
    automaton: Drawing,
    panels: Vec<Panel>,
}

/// Automata, and policies at each of their states.
pub struct Figure {
    grid: Grid,
    regions: Vec<Region>,
    rows: Vec<Row>,
}

impl Figure {
    /// An empty figure of policies on `grid`.
    #[must_use]
    pub const fn of(grid: Grid) -> Self {
        Self { grid, regions: Vec::new(), rows: Vec::new() }
    }

    /// Colours the cells in which predicates hold, and writes their names there.
    pub fn regions(&mut self, predicates: &[(&str, Robustness)]) {
        for &(name, robustness) in predicates {
            let holds = |&s: &usize| robustness(&self.grid.state(s)) > 0.0;
            let cells = (0..self.grid.states()).filter(holds).collect();
            self.regions.push(Region { name: name.to_owned(), cells });
        }
    }

    /// Adds a row: the automaton `dfa`, and `policy` at each of its live states, marked where it
    /// departs from `optimum`. The policy may be for a larger automaton of the same task; `minimal`
    /// is the task of `dfa` on the grid.
    ///
    /// # Errors
    /// If the policy is not for the task of `optimum`.
    pub fn row(
        &mut self,
        title: &str,
        dfa: &Dfa,
        minimal: &Labelled,
        optimum: &Optimum,
        policy: &Policy,
    ) -> Result<(), Mismatch> {
        let numbers = numbers(policy.task(), minimal);
        let mistakes = optimum.mistakes(policy)?;
        let mut states: Vec<u32> = policy.task().live().collect();
        states.sort_by_key(|&q| numbers[q as usize]);
        let panel = |&q: &u32| {
            let mut losses = vec![0.0; policy.task().states()];
            for mistake in mistakes.iter().filter(|mistake| mistake.q == q) {
                losses[mistake.state] = mistake.loss / optimum.q().max(q, mistake.state);
            }
            let title = format!("q = {}", numbers[q as usize]);
            Panel { title, actions: policy.sub_policy(q).collect(), losses }
        };
        let panels = states.iter().map(panel).collect();
        let automaton = drawing(dfa, &Options::default());
        self.rows.push(Row { title: title.to_owned(), automaton, panels });
        Ok(())
    }

    /// The figure as an SVG document.
    #[must_use]
    pub fn svg(&self) -> String {
        figure(&self.grid, &self.regions, &self.rows)
    }
}

/// The minimal automaton's number for each state of a larger one: what the same cells lead to in
/// both.
fn numbers(raw: &Labelled, minimal: &Labelled) -> Vec<State> {
    let mut numbers = vec![None; raw.automaton_states() as usize];
    let mut found = vec![(0, 0)];
    while let Some((q, number)) = found.pop() {
        if numbers[q as usize].replace(number).is_none() {
            let cells = 0..raw.states();
            found.extend(cells.map(|s| (raw.next(q, s), minimal.next(number, s))));
        }
    }
    numbers.into_iter().map(Option::unwrap_or_default).collect()
}

/// The side of a cell, in pixels: an arrow, and below it a number.
const CELL: f64 = 24.0;
const GAP: f64 = 26.0;
const MARGIN: f64 = 24.0;
const PER_LINE: usize = 4;
/// What stands above the cells of a panel.
const HEAD: f64 = 31.0;

fn figure(grid: &Grid, regions: &[Region], rows: &[Row]) -> String {
    let left = rows.iter().map(|row| row.automaton.width).fold(0.0, f64::max);
    let (panel_width, panel_height) = (panel_width(grid), panel_height(grid));
    let columns = rows.iter().map(|row| row.panels.len().min(PER_LINE)).max().unwrap_or(1);
    let width = 2.0 * MARGIN + left + GAP + columns as f64 * (panel_width + GAP);
    let mut body = String::new();
    let mut y = MARGIN;
    for row in rows {
        let automaton = &row.automaton;
        let lines = row.panels.len().div_ceil(PER_LINE);
        let height = (lines as f64 * panel_height).max(automaton.height);
        text(&mut body, (MARGIN, y + 12.0), Font::new(15.0).bold(), Anchor::Start, &row.title);
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
    document("Automata and policies", (width, y + 64.0), &body)
}

fn panel_width(grid: &Grid) -> f64 {
    f64::from(grid.width) * CELL
}

fn panel_height(grid: &Grid) -> f64 {
    f64::from(grid.height) * CELL + HEAD + 12.0
}

fn draw(body: &mut String, grid: &Grid, regions: &[Region], panel: &Panel) {
    let middle = panel_width(grid) / 2.0;
    text(body, (middle, 10.0), Font::new(12.0), Anchor::Middle, &panel.title);
    text(body, (middle, 24.0), Font::new(9.5).fill(PALE), Anchor::Middle, &panel.verdict());
    let place = |s: usize| {
        let (x, y) = (s as i32 % grid.width, s as i32 / grid.width);
        (f64::from(x) * CELL, HEAD + f64::from(grid.height - 1 - y) * CELL)
    };
    for (s, &action) in panel.actions.iter().enumerate() {
        let ((x, y), loss) = (place(s), shade(panel.losses[s]));
        let region = regions.iter().position(|region| region.cells.contains(&s));
        let fill = region.map_or(loss.unwrap_or("#ffffff"), |i| REGIONS[i % REGIONS.len()]);
        rect(body, (x, y, CELL, CELL), fill, LINE, "");
        if let (Some(_), Some(loss)) = (region, loss) {
            let frame = (x + 2.0, y + 2.0, CELL - 4.0, CELL - 4.0);
            rect(body, frame, "none", loss, "stroke-width=\"3\"");
        }
        let (_, dx, dy) = Grid::ACTIONS[action];
        let middle = (x + CELL / 2.0, y + CELL / 2.0 - 2.0);
        arrow(body, middle, (f64::from(dx), -f64::from(dy)));
        // Less than 0.1 % is said by the colour alone.
        if panel.losses[s] >= LOSSES[0].0 {
            let lost = format!("{:.1}", 100.0 * panel.losses[s]);
            let below = (middle.0, y + CELL - 2.5);
            text(body, below, Font::new(6.5).bold(), Anchor::Middle, &lost);
        }
    }
    for region in regions {
        for &s in &region.cells {
            let (x, y) = place(s);
            let font = Font::new(8.0).bold();
            text(body, (x + 3.5, y + 7.5), font, Anchor::Middle, &region.name);
        }
    }
}

impl Panel {
    /// In how many cells the action is not optimal, and what the worst loses.
    fn verdict(&self) -> String {
        let lossy = self.losses.iter().filter(|&&loss| loss > 0.0).count();
        let worst = self.losses.iter().copied().fold(0.0, f64::max);
        match (lossy, worst) {
            (0, _) => "all optimal".to_owned(),
            (_, 0.001..) => format!("{lossy} not optimal, by {:.1} % at most", 100.0 * worst),
            _ => format!("{lossy} not optimal, by less than 0.1 %"),
        }
    }
}

fn shade(loss: f64) -> Option<&'static str> {
    let of = |&&(most, ..): &&(f64, &str, &str)| loss <= most;
    LOSSES.iter().find(of).filter(|_| loss > 0.0).map(|&(_, colour, _)| colour)
}

/// An arrow around a point, in a direction along an axis; a dot for staying.
pub fn arrow(body: &mut String, (x, y): (f64, f64), (dx, dy): (f64, f64)) {
    if dx == 0.0 && dy == 0.0 {
        let _ = writeln!(body, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.6\" fill=\"{INK}\"/>");
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
    let font = Font::new(11.0);
    let moves = "Arrows: moves; dots: staying. Letters: where a, b and c are positive. \
                 Numbers: the automaton's states, q.";
    text(body, (x, y + 8.0), font, Anchor::Start, moves);
    let about = "Coloured: not optimal there. The action gives away this share of the largest \
                 expected return, in the cell in per cent:";
    text(body, (x, y + 26.0), font, Anchor::Start, about);
    // On a line of their own: how long a text is depends on the letters that a reader has.
    for (i, (_, colour, most)) in LOSSES.into_iter().enumerate() {
        let x = x + 120.0 * i as f64;
        rect(body, (x, y + 34.0, 12.0, 12.0), colour, LINE, "");
        text(body, (x + 18.0, y + 44.0), font, Anchor::Start, most);
    }
}
