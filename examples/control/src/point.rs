//! A point with inertia in a room, with a pillar in the middle.
//!
//! It is pushed by up to 1 m/s² along each axis, moves at up to 0.8 m/s along each, and stops at walls.
//! An episode starts at rest, anywhere outside the pillar. A disturbance is a further push.

use tltl::env::{ContinuousEnv, Step};
use tltl::falsify::DisturbedEnv;
use tltl::network::Features;
use tltl::rand::{Rng, RngExt as _};

tltl::include_tltl!("tasks/point.tltl");

pub use point::{Point, fetch, hurry, park, patrol, to_a, to_b, to_c, tour};

/// The seconds of a step, as `tasks/point.tltl` says.
pub const STEP: f64 = 0.1;

/// Half the width of the room, in metres.
pub const HALF: f64 = 1.0;

/// The middles of the places a, b and c, in metres.
pub const PLACES: [(f64, f64); 3] = [(-0.6, 0.6), (0.6, 0.6), (0.6, -0.6)];

/// The largest speed along each axis, in metres a second.
const FASTEST: f64 = 0.8;

/// How near to the pillar's middle no episode starts, in metres.
const CLEAR: f64 = 0.4;

/// The room.
#[derive(Clone, Debug)]
pub struct Room {
    at: Point,
}

impl Default for Room {
    fn default() -> Self {
        Self { at: Point { x: -0.8, y: -0.8, vx: 0.0, vy: 0.0 } }
    }
}

impl Room {
    /// The room with the point somewhere.
    #[must_use]
    pub const fn with(at: Point) -> Self {
        Self { at }
    }
}

/// Along one axis: a push, then a step with the new speed; a wall stops it.
fn pushed(place: f64, speed: f64, push: f64) -> (f64, f64) {
    let speed = (speed + push * STEP).clamp(-FASTEST, FASTEST);
    let to = place + speed * STEP;
    if to.abs() > HALF { (to.clamp(-HALF, HALF), 0.0) } else { (to, speed) }
}

impl ContinuousEnv for Room {
    type State = Point;

    /// Pushes along x and y, in metres a second squared.
    fn bounds(&self) -> Vec<(f32, f32)> {
        vec![(-1.0, 1.0); 2]
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Point {
        let mut place = || HALF * (2.0 * rng.random::<f64>() - 1.0);
        loop {
            if let Some(s) = self.reset_at(&[place(), place()]) {
                return s;
            }
        }
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<Point> {
        self.step_disturbed(action, &[0.0; 2], rng)
    }

    fn component_name(&self, i: usize) -> String {
        ["push along x", "push along y"][i].into()
    }
}

impl DisturbedEnv for Room {
    /// Where the point is, along x and y, in metres.
    fn start_bounds(&self) -> Vec<(f64, f64)> {
        vec![(-HALF, HALF); 2]
    }

    fn reset_at(&mut self, start: &[f64]) -> Option<Point> {
        let (x, y) = (start[0], start[1]);
        self.at = Point { x, y, vx: 0.0, vy: 0.0 };
        (x.hypot(y) >= CLEAR).then_some(self.at)
    }

    /// Pushes along x and y, a tenth of the motor's.
    fn disturbance_bounds(&self) -> Vec<(f64, f64)> {
        vec![(-0.1, 0.1); 2]
    }

    fn step_disturbed<R: Rng + ?Sized>(
        &mut self,
        action: &[f32],
        push: &[f64],
        _: &mut R,
    ) -> Step<Point> {
        let Point { x, y, vx, vy } = self.at;
        let push = |i: usize| f64::from(action[i]) + push[i];
        let ((x, vx), (y, vy)) = (pushed(x, vx, push(0)), pushed(y, vy, push(1)));
        self.at = Point { x, y, vx, vy };
        Step::to(self.at)
    }
}

/// What a network sees: the four numbers of the state, of the size of 1, and how far the pillar is.
#[derive(Clone, Copy, Debug)]
pub struct Look;

impl Features<Point> for Look {
    fn inputs(&self) -> usize {
        5
    }

    fn write(&self, s: &Point, inputs: &mut [f32], _: &mut [f32]) {
        let seen = [s.x, s.y, s.vx / FASTEST, s.vy / FASTEST, s.x.hypot(s.y) - 0.3];
        inputs.iter_mut().zip(seen).for_each(|(input, seen)| *input = seen as f32);
    }
}

/// A controller as one writes it: towards `goal`, and round the pillar on the nearer side.
#[must_use]
pub fn steer(s: &Point, goal: (f64, f64)) -> [f32; 2] {
    let (dx, dy) = (goal.0 - s.x, goal.1 - s.y);
    let far = dx.hypot(dy).max(1e-9);
    // Is the pillar on the way? Where the way comes nearest to its middle.
    let along = (-(s.x * dx + s.y * dy) / (far * far)).clamp(0.0, 1.0);
    let (nx, ny) = (s.x + along * dx, s.y + along * dy);
    let (mut tx, mut ty) = goal;
    if nx.hypot(ny) < 0.45 && along > 0.0 && along < 1.0 {
        let size = nx.hypot(ny).max(1e-3);
        (tx, ty) = (nx / size * 0.6, ny / size * 0.6);
    }
    let push =
        |to: f64, place: f64, speed: f64| (4.0 * (to - place) - 3.0 * speed).clamp(-1.0, 1.0);
    [push(tx, s.x, s.vx) as f32, push(ty, s.y, s.vy) as f32]
}
