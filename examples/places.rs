//! Small worlds of places, for the study of tasks: maps, a line, and one that is no grid.

use tltl::model::FiniteModel;
use tltl::rand::{RngExt as _, SeedableRng, rngs::Xoshiro256PlusPlus};

/// What is at a place: three goals, and what must not be touched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The first goal.
    pub a: bool,
    /// The second goal.
    pub b: bool,
    /// The third goal.
    pub c: bool,
    /// What must not be touched.
    pub d: bool,
}

impl Place {
    /// The place that a map shows as `mark`.
    const fn of(mark: u8) -> Self {
        Self { a: mark == b'a', b: mark == b'b', c: mark == b'c', d: mark == b'd' }
    }
}

/// A finite world of places; an episode starts at any of them, unless [one](World::from_the_last) is chosen.
#[derive(Clone, Debug)]
pub struct World {
    /// What it is called.
    pub name: &'static str,
    places: Vec<Place>,
    actions: usize,
    /// The outcomes of each `place * actions + action`.
    outcomes: Vec<Vec<(usize, f64)>>,
    /// Where all episodes start, if at one place.
    start: Option<usize>,
}

impl World {
    /// The same, all episodes starting at the last empty place.
    #[must_use]
    pub fn from_the_last(&self) -> Self {
        let start = self.places.iter().rposition(|place| *place == Place::default());
        Self { start, ..self.clone() }
    }

    /// A map, row by row: `#` is a wall, `.` an empty place, a letter what is there. The actions are
    /// up, down, left, right and stay; one time in `1 / slip` a random one of the five is taken.
    fn map(name: &'static str, slip: f64, rows: &[&str]) -> Self {
        let mark = |x: i32, y: i32| {
            let row = usize::try_from(y).ok().and_then(|y| rows.get(y))?;
            row.as_bytes().get(usize::try_from(x).ok()?).copied().filter(|&mark| mark != b'#')
        };
        let cells =
            (0..rows.len() as i32).flat_map(|y| (0..rows[0].len() as i32).map(move |x| (x, y)));
        let cells: Vec<(i32, i32)> = cells.filter(|&(x, y)| mark(x, y).is_some()).collect();
        let moved = |(x, y): (i32, i32), (dx, dy): (i32, i32)| {
            let to = (x + dx, y + dy);
            let to = if mark(to.0, to.1).is_some() { to } else { (x, y) };
            cells.iter().position(|&cell| cell == to).expect("a place of the map")
        };
        let outcomes = |&cell: &(i32, i32)| {
            let to = MOVES.map(|by| moved(cell, by));
            let by = |to: usize| to;
            MOVES
                .iter()
                .enumerate()
                .map(move |(action, _)| {
                    let slips = to.iter().map(|&to| (by(to), slip / 5.0));
                    slips.chain([(to[action], 1.0 - slip)]).collect()
                })
                .collect::<Vec<_>>()
        };
        Self {
            name,
            places: cells.iter().map(|&(x, y)| Place::of(mark(x, y).unwrap_or(b'.'))).collect(),
            actions: MOVES.len(),
            outcomes: cells.iter().flat_map(outcomes).collect(),
            start: None,
        }
    }

    /// Places in a row: left, stay, right, of which the commanded one happens with probability 0.8 and
    /// each other with 0.1.
    fn line(name: &'static str, row: &str) -> Self {
        let places: Vec<Place> = row.bytes().map(Place::of).collect();
        let last = places.len() - 1;
        let outcomes = (0..places.len() * 3).map(|cell| {
            let to = |by: usize| (cell / 3 + by).saturating_sub(1).min(last);
            (0..3).map(|by| (to(by), if by == cell % 3 { 0.8 } else { 0.1 })).collect()
        });
        Self { name, actions: 3, outcomes: outcomes.collect(), places, start: None }
    }

    /// A world without geometry: each action of each place leads to three places by chance.
    fn random(name: &'static str, seed: u64, marks: &str) -> Self {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let places: Vec<Place> = marks.bytes().map(Place::of).collect();
        let mut outcome =
            |_| [0.7, 0.2, 0.1].map(|p| (rng.random_range(0..places.len()), p)).into();
        Self {
            name,
            actions: 4,
            outcomes: (0..places.len() * 4).map(&mut outcome).collect(),
            places,
            start: None,
        }
    }
}

/// The moves of a map: up, down, left, right, stay.
const MOVES: [(i32, i32); 5] = [(0, -1), (0, 1), (-1, 0), (1, 0), (0, 0)];

impl FiniteModel for World {
    type State = Place;

    fn states(&self) -> usize {
        self.places.len()
    }

    fn actions(&self) -> usize {
        self.actions
    }

    fn state(&self, s: usize) -> Place {
        self.places[s]
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        self.outcomes[s * self.actions + a].iter().for_each(|&(to, p)| outcome(to, p));
    }

    fn start(&self, s: usize) -> f64 {
        f64::from(u8::from(self.start.is_none_or(|start| s == start)))
    }
}

/// The worlds of the study.
#[must_use]
pub fn worlds() -> Vec<World> {
    let rooms = [
        "a...#....",
        "....#....",
        ".........",
        "....#..b.",
        "##.###.##",
        "....#....",
        "..d......",
        "....#....",
        "c...#....",
    ];
    let maze = [
        "a.#...#..",
        "..#.#.#.#",
        "#.#.#.#..",
        "..#.#...#",
        ".##.###..",
        "....#.b#.",
        ".##.#.##.",
        ".c#...d..",
    ];
    let large = [
        "................",
        "..a.............",
        "................",
        ".........d......",
        "................",
        "......#####.....",
        "..........#..b..",
        "...d......#.....",
        "..........#.....",
        "................",
        "..c.............",
        "..........d.....",
    ];
    vec![
        World::map(
            "the paper's grid, with a trap",
            0.2,
            &[
                "........", "........", "..c.....", "........", ".....b..", "....d...", "........",
                "..a.....", "........", "........",
            ],
        ),
        World::map("5 × 5", 0.1, &["a...c", ".....", "..d..", ".....", "....b"]),
        World::map("5 × 5, nothing slips", 0.0, &["a.d.b", "..d..", ".....", "..#..", "c...."]),
        World::map("4 × 4, slippery", 0.3, &["a..b", "....", ".d..", "...c"]),
        World::map(
            "10 × 10",
            0.2,
            &[
                "..........",
                ".a......b.",
                "..........",
                "...d......",
                "..........",
                "......d...",
                "..........",
                "..........",
                ".......c..",
                "..........",
            ],
        ),
        World::map(
            "a wall with a door",
            0.2,
            &[
                "a....#....b.",
                ".....#......",
                "............",
                ".....#..d...",
                ".....#......",
                ".c...#......",
            ],
        ),
        World::map("four rooms", 0.1, &rooms),
        World::map("a maze", 0.1, &maze),
        World::map("along a cliff", 0.2, &["...c......", "a........b", "..........", "dddddddddd"]),
        World::map("a bridge", 0.1, &["..ddd..", "..ddd..", "a.....b", "..ddd..", "c.ddd.."]),
        World::map(
            "two ways, the short one beside traps",
            0.2,
            &["a.ddd.b", ".......", "..ddd..", "..###..", ".......", "..c...."],
        ),
        World::map(
            "15 × 4, slippery",
            0.4,
            &["a......d.......", "...............", ".......d.....b.", "..c............"],
        ),
        World::map("16 × 12", 0.1, &large),
        World::line("a line", "d..a...b..c."),
        World::random("no grid", 5, "abcdd.......................d.........."),
    ]
}
