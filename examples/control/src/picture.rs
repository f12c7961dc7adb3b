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

/// A rectangle of the world, its sides along the axes: its middle, half its widths, what it is called, and
/// whether it is solid.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// In metres.
    pub middle: (f64, f64),
    /// Half the width and half the height, in metres.
    pub half: (f64, f64),
    /// What it is called.
    pub name: &'static str,
    /// Whether it is a wall, and not a place.
    pub solid: bool,
}

/// A square that is moved about, as a state has it.
#[derive(Debug)]
pub struct Loose<S> {
    /// Half its width, in metres.
    pub half: f64,
    /// Its middle, in metres, and how it is turned, in radians.
    pub at: fn(&S) -> (f64, f64, f64),
}

/// A square part of a plane, drawn from above.
#[derive(Clone, Copy, Debug)]
pub struct Plane<'a> {
    /// Its least and largest coordinates, in metres, the same for both axes.
    pub range: (f64, f64),
    /// What is in it.
    pub regions: &'a [Region],
    /// The rectangles in it.
    pub blocks: &'a [Block],
    /// What is below this coordinate must not be entered.
    pub edge: Option<f64>,
}

/// One colour for each automaton state, told apart without colour vision by lightness too.
const COLOURS: [&str; 7] =
    ["#1b6ca8", "#d1790f", "#2c8c4a", "#8a3fa0", "#b3303a", "#5c6470", "#12a5a0"];

/// Automaton states, and what they mean.
type Meanings<'a> = [(u32, &'a str)];

/// The colour of what must not be entered.
const BARRED: &str = "#c9ced6";

/// The colour of a place that may be entered.
const PLACE: &str = "#eef3d2";

/// The colour of walls.
const WALL: &str = "#8d96a3";

/// The colour of what is loose.
const LOOSE: &str = "#b08d57";

/// The width of the plane in the picture, in pixels.
const SIDE: f64 = 480.0;

/// The margin around it.
const MARGIN: f64 = 20.0;

impl Plane<'_> {
    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (low, high) = self.range;
        (MARGIN + self.scaled(x - low), MARGIN + self.scaled(high - y))
    }

    /// A length, in pixels.
    fn scaled(&self, length: f64) -> f64 {
        let (low, high) = self.range;
        length * SIDE / (high - low)
    }

    fn ground(&self, body: &mut String) {
        svg::rect(body, (MARGIN, MARGIN, SIDE, SIDE), "#fbfcfd", PALE, "");
        if let Some(edge) = self.edge {
            let (_, top) = self.place((0.0, edge));
            let height = MARGIN + SIDE - top;
            svg::rect(body, (MARGIN, top, SIDE, height), BARRED, PALE, "");
        }
        for Block { middle: (x, y), half: (width, height), name, solid } in self.blocks {
            let (left, top) = self.place((x - width, y + height));
            let fill = if *solid { WALL } else { PLACE };
            let sides = (left, top, self.scaled(2.0 * width), self.scaled(2.0 * height));
            svg::rect(body, sides, fill, PALE, "");
            let (x, y) = self.place((*x, *y));
            svg::text(body, (x, y + 5.0), Font::new(15.0).bold(), Anchor::Middle, name);
        }
        for region in self.regions {
            let (x, y) = self.place(region.middle);
            let radius = self.scaled(region.radius);
            let fill = if region.barred { BARRED } else { PLACE };
            let _ = writeln!(
                body,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{fill}\" stroke=\"{PALE}\"/>"
            );
            svg::text(body, (x, y + 5.0), Font::new(15.0).bold(), Anchor::Middle, region.name);
        }
    }

    /// Points as a line has them.
    fn points(&self, places: impl Iterator<Item = (f64, f64)>) -> String {
        let shown = places.map(|place| self.place(place)).map(|(x, y)| format!("{x:.1},{y:.1}"));
        shown.collect::<Vec<_>>().join(" ")
    }

    /// The way of what is loose, and itself where it ends.
    fn moved<S>(&self, body: &mut String, states: &[S], loose: &Loose<S>) {
        let points = self.points(states.iter().map(|s| {
            let (x, y, _) = (loose.at)(s);
            (x, y)
        }));
        let _ = writeln!(
            body,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{LOOSE}\" stroke-dasharray=\"3 3\"/>"
        );
        let Some((x, y, angle)) = states.last().map(loose.at) else { return };
        let (x, y) = self.place((x, y));
        let (half, degrees) = (self.scaled(loose.half), -angle.to_degrees());
        let turned = format!("opacity=\"0.5\" transform=\"rotate({degrees:.1} {x:.1} {y:.1})\"");
        svg::rect(body, (x - half, y - half, 2.0 * half, 2.0 * half), "none", LOOSE, &turned);
    }

    /// What is loose, as it moves.
    fn moves<S>(&self, body: &mut String, states: &[S], loose: &Loose<S>, seconds: f64) {
        let half = self.scaled(loose.half);
        let (mut places, mut turns) = (Vec::new(), Vec::new());
        for (x, y, angle) in states.iter().map(loose.at) {
            let (x, y) = self.place((x, y));
            places.push(format!("{x:.1},{y:.1}"));
            turns.push(format!("{:.1}", -angle.to_degrees()));
        }
        // Turned at once in each step: between -180 and 180 degrees there is no way.
        let _ = writeln!(
            body,
            "<g transform=\"translate({})\"><animateTransform attributeName=\"transform\" \
             type=\"translate\" values=\"{}\" dur=\"{seconds:.1}s\" repeatCount=\"indefinite\"/>\
             <rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{LOOSE}\" \
             transform=\"rotate({})\"><animateTransform attributeName=\"transform\" type=\"rotate\" \
             values=\"{}\" dur=\"{seconds:.1}s\" calcMode=\"discrete\" repeatCount=\"indefinite\"/>\
             </rect></g>",
            places[0],
            places.join(";"),
            -half,
            -half,
            2.0 * half,
            2.0 * half,
            turns[0],
            turns.join(";"),
        );
    }

    fn legend(&self, body: &mut String, meanings: &Meanings<'_>) {
        let mut y = MARGIN + SIDE + 24.0;
        for &(q, meaning) in runs(meanings).map(|run| &run[0]) {
            let colour = colour(q, meanings);
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
    /// What is loose has a dashed way, and is drawn where it ends. States in a row that mean the
    /// same, as the instants of a dwell do, share a colour.
    #[must_use]
    pub fn trajectories<S>(
        &self,
        title: &str,
        episodes: &[Played<S>],
        at: impl Fn(&S) -> (f64, f64),
        loose: Option<&Loose<S>>,
        meanings: &Meanings<'_>,
    ) -> String {
        let mut body = String::new();
        self.ground(&mut body);
        if let Some(loose) = loose {
            episodes.iter().for_each(|episode| self.moved(&mut body, &episode.states, loose));
        }
        for Played { states, q } in episodes {
            // A path for each stretch of one automaton state, which begins where the last one ends.
            let mut start = 0;
            while start + 1 < states.len() {
                let end = (start + 1..q.len()).find(|&i| q[i] != q[start]).unwrap_or(q.len() - 1);
                let points = self.points(states[start..=end].iter().map(&at));
                let _ = writeln!(
                    body,
                    "<polyline points=\"{points}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" opacity=\"0.8\"/>",
                    colour(q[start], meanings)
                );
                start = end;
            }
            let (x, y) = self.place(at(&states[0]));
            let _ = writeln!(body, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{INK}\"/>");
        }
        self.legend(&mut body, meanings);
        svg::document(title, self.size(runs(meanings).count()), &body)
    }

    /// One episode that moves, over and over: a dot in the colour of the automaton state.
    /// What is loose moves too. `step` is how long a step lasts, in seconds.
    #[must_use]
    pub fn moving<S>(
        &self,
        title: &str,
        episode: &Played<S>,
        at: impl Fn(&S) -> (f64, f64),
        loose: Option<&Loose<S>>,
        step: f64,
        meanings: &Meanings<'_>,
    ) -> String {
        let mut body = String::new();
        self.ground(&mut body);
        let places: Vec<(f64, f64)> = episode.states.iter().map(|s| self.place(at(s))).collect();
        let column =
            |of: &dyn Fn(usize) -> String| (0..places.len()).map(of).collect::<Vec<_>>().join(";");
        let seconds = step * places.len() as f64;
        if let Some(loose) = loose {
            self.moves(&mut body, &episode.states, loose, seconds);
        }
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
            colour(episode.q[0], meanings),
            animate("cx", column(&|i| format!("{:.1}", places[i].0)), "linear"),
            animate("cy", column(&|i| format!("{:.1}", places[i].1)), "linear"),
            animate("fill", column(&|i| colour(episode.q[i], meanings).into()), "discrete"),
        );
        self.legend(&mut body, meanings);
        svg::document(title, self.size(runs(meanings).count()), &body)
    }

    fn size(&self, lines: usize) -> (f64, f64) {
        (SIDE + 2.0 * MARGIN, SIDE + 2.0 * MARGIN + 20.0 * lines as f64 + 4.0)
    }
}

/// States in a row that mean the same.
fn runs<'a>(meanings: &'a Meanings<'_>) -> impl Iterator<Item = &'a [(u32, &'a str)]> {
    meanings.chunk_by(|(_, one), (_, next)| one == next)
}

/// The colour of an automaton state, that of the first of its run.
fn colour(q: u32, meanings: &Meanings<'_>) -> &'static str {
    let run = runs(meanings).find(|run| run.iter().any(|(own, _)| *own == q));
    let first = run.map_or(q, |run| run[0].0);
    COLOURS[first as usize % COLOURS.len()]
}
