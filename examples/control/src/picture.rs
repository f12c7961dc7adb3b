//! Trajectories over the regions of a world, coloured by the automaton state.

use std::fmt::Write as _;

use tltl::estimate::Played;
use tltl_examples::svg::{self, Anchor, Font, INK, PALE};

/// A disc of the world: its middle, its radius, what it is called, and whether it must not be entered.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    /// In metres.
    pub middle: (f64, f64),
    /// In metres.
    pub radius: f64,
    /// What it is called.
    pub name: &'static str,
    /// Whether it must not be entered.
    pub barred: bool,
}

/// A square part of a plane, drawn from above.
#[derive(Clone, Copy, Debug)]
pub struct Plane<'a> {
    /// Its least and largest coordinates, in metres, the same for both axes.
    pub range: (f64, f64),
    /// What is in it.
    pub regions: &'a [Region],
    /// What is below this coordinate must not be entered.
    pub edge: Option<f64>,
}

/// One colour for each automaton state, told apart without colour vision by lightness too.
const COLOURS: [&str; 6] = ["#1b6ca8", "#d1790f", "#2c8c4a", "#8a3fa0", "#b3303a", "#5c6470"];

/// The colour of what must not be entered.
const BARRED: &str = "#c9ced6";

/// The width of the plane in the picture, in pixels.
const SIDE: f64 = 480.0;

/// The margin around it.
const MARGIN: f64 = 20.0;

impl Plane<'_> {
    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (low, high) = self.range;
        let scale = SIDE / (high - low);
        (MARGIN + (x - low) * scale, MARGIN + (high - y) * scale)
    }

    fn ground(&self, body: &mut String) {
        svg::rect(body, (MARGIN, MARGIN, SIDE, SIDE), "#fbfcfd", PALE, "");
        let (low, high) = self.range;
        if let Some(edge) = self.edge {
            let (_, top) = self.place((low, edge));
            let height = MARGIN + SIDE - top;
            svg::rect(body, (MARGIN, top, SIDE, height), BARRED, PALE, "");
        }
        for region in self.regions {
            let (x, y) = self.place(region.middle);
            let radius = region.radius * SIDE / (high - low);
            let fill = if region.barred { BARRED } else { "#eef3d2" };
            let _ = writeln!(
                body,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{fill}\" stroke=\"{PALE}\"/>"
            );
            svg::text(body, (x, y + 5.0), Font::new(15.0).bold(), Anchor::Middle, region.name);
        }
    }

    fn legend(&self, body: &mut String, states: &[(u32, &str)]) {
        let mut y = MARGIN + SIDE + 24.0;
        for &(q, meaning) in states {
            let colour = colour(q);
            let _ = writeln!(
                body,
                "<path d=\"M {MARGIN} {:.1} h 30\" stroke=\"{colour}\" stroke-width=\"3\"/>",
                y - 4.0
            );
            svg::text(body, (MARGIN + 40.0, y), Font::new(13.0), Anchor::Start, meaning);
            y += 20.0;
        }
    }

    /// Some episodes: a dot where each starts, and its way in the colour of the automaton state.
    /// `states` says what the automaton states mean.
    #[must_use]
    pub fn trajectories<S>(
        &self,
        title: &str,
        episodes: &[Played<S>],
        at: impl Fn(&S) -> (f64, f64),
        states: &[(u32, &str)],
    ) -> String {
        let mut body = String::new();
        self.ground(&mut body);
        for Played { states, q } in episodes {
            // A path for each stretch of one automaton state, which begins where the last one ends.
            let mut start = 0;
            while start + 1 < states.len() {
                let end = (start + 1..q.len()).find(|&i| q[i] != q[start]).unwrap_or(q.len() - 1);
                let points: Vec<String> = states[start..=end]
                    .iter()
                    .map(|s| self.place(at(s)))
                    .map(|(x, y)| format!("{x:.1},{y:.1}"))
                    .collect();
                let _ = writeln!(
                    body,
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" opacity=\"0.8\"/>",
                    points.join(" "),
                    colour(q[start])
                );
                start = end;
            }
            let (x, y) = self.place(at(&states[0]));
            let _ = writeln!(body, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{INK}\"/>");
        }
        self.legend(&mut body, states);
        svg::document(title, self.size(states.len()), &body)
    }

    /// One episode that moves, over and over: a dot in the colour of the automaton state.
    /// `step` is how long a step lasts, in seconds.
    #[must_use]
    pub fn moving<S>(
        &self,
        title: &str,
        episode: &Played<S>,
        at: impl Fn(&S) -> (f64, f64),
        step: f64,
        states: &[(u32, &str)],
    ) -> String {
        let mut body = String::new();
        self.ground(&mut body);
        let places: Vec<(f64, f64)> = episode.states.iter().map(|s| self.place(at(s))).collect();
        let column =
            |of: &dyn Fn(usize) -> String| (0..places.len()).map(of).collect::<Vec<_>>().join(";");
        let seconds = step * places.len() as f64;
        let animate = |attribute: &str, values: String, mode: &str| {
            format!(
                "<animate attributeName=\"{attribute}\" values=\"{values}\" dur=\"{seconds:.1}s\" \
                 calcMode=\"{mode}\" repeatCount=\"indefinite\"/>"
            )
        };
        let (x, y) = places[0];
        let _ = writeln!(
            body,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"8\" fill=\"{}\" stroke=\"{INK}\">{}{}{}</circle>",
            colour(episode.q[0]),
            animate("cx", column(&|i| format!("{:.1}", places[i].0)), "linear"),
            animate("cy", column(&|i| format!("{:.1}", places[i].1)), "linear"),
            animate("fill", column(&|i| colour(episode.q[i]).into()), "discrete"),
        );
        self.legend(&mut body, states);
        svg::document(title, self.size(states.len()), &body)
    }

    fn size(&self, lines: usize) -> (f64, f64) {
        (SIDE + 2.0 * MARGIN, SIDE + 2.0 * MARGIN + 20.0 * lines as f64 + 4.0)
    }
}

fn colour(q: u32) -> &'static str {
    COLOURS[q as usize % COLOURS.len()]
}
