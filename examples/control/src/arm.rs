//! A two-link arm in a plane, with limits of its joints.
//!
//! Its motors turn the joints faster or slower by up to 6 rad/s², up to 2 rad/s; a joint stops at its
//! limit. An episode starts at rest, with the tip anywhere above the edge that it must not reach over. A
//! disturbance turns the joints too.

use std::f64::consts::PI;

use tltl::env::{ContinuousEnv, Step};
use tltl::falsify::DisturbedEnv;
use tltl::network::Features;
use tltl::rand::{Rng, RngExt as _};

tltl::include_tltl!("tasks/arm.tltl");

pub use arm::{Arm, bring, bring_and_rest, shuttle};

/// The seconds of a step, as `tasks/arm.tltl` says.
pub const STEP: f64 = 0.05;

/// The middles of cup, shelf and rest, in metres.
pub const PLACES: [(f64, f64); 3] = [(0.25, 0.3), (-0.25, 0.3), (0.0, 0.15)];

/// The lengths of upper arm and forearm, in metres.
pub const LINKS: [f64; 2] = [0.3, 0.25];

/// The least and the largest angle of shoulder and elbow, in radians.
const LIMITS: [(f64, f64); 2] = [(-0.3, PI + 0.3), (-2.6, 2.6)];

/// The largest speed of a joint, in radians a second.
const FASTEST: f64 = 2.0;

/// What the motors can do, in radians a second squared.
const MOTOR: f32 = 6.0;

/// An arm on a table.
#[derive(Clone, Debug)]
pub struct Table {
    angles: [f64; 2],
    rates: [f64; 2],
}

impl Default for Table {
    fn default() -> Self {
        Self { angles: [PI / 2.0, 0.0], rates: [0.0; 2] }
    }
}

/// Where elbow and tip are.
#[must_use]
pub fn joints([shoulder, elbow]: [f64; 2]) -> [(f64, f64); 2] {
    let (x, y) = (LINKS[0] * shoulder.cos(), LINKS[0] * shoulder.sin());
    let turned = shoulder + elbow;
    [(x, y), (x + LINKS[1] * turned.cos(), y + LINKS[1] * turned.sin())]
}

impl Table {
    fn seen(&self) -> Arm {
        let [_, (x, y)] = joints(self.angles);
        let ([shoulder, elbow], [shoulder_rate, elbow_rate]) = (self.angles, self.rates);
        Arm { shoulder, elbow, shoulder_rate, elbow_rate, x, y }
    }
}

impl ContinuousEnv for Table {
    type State = Arm;

    /// What the motors do at shoulder and elbow, in radians a second squared.
    fn bounds(&self) -> Vec<(f32, f32)> {
        vec![(-MOTOR, MOTOR); 2]
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Arm {
        loop {
            let angles = LIMITS.map(|(low, high)| low + (high - low) * rng.random::<f64>());
            if let Some(s) = self.reset_at(&angles) {
                return s;
            }
        }
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<Arm> {
        self.step_disturbed(action, &[0.0; 2], rng)
    }

    fn component_name(&self, i: usize) -> String {
        ["shoulder motor", "elbow motor"][i].into()
    }
}

impl DisturbedEnv for Table {
    /// The angles of shoulder and elbow, in radians.
    fn start_bounds(&self) -> Vec<(f64, f64)> {
        LIMITS.to_vec()
    }

    fn reset_at(&mut self, start: &[f64]) -> Option<Arm> {
        *self = Self { angles: [start[0], start[1]], rates: [0.0; 2] };
        Some(self.seen()).filter(|seen| seen.y > 0.0)
    }

    /// What turns shoulder and elbow beside the motors, a tenth of theirs.
    fn disturbance_bounds(&self) -> Vec<(f64, f64)> {
        vec![(-0.1 * f64::from(MOTOR), 0.1 * f64::from(MOTOR)); 2]
    }

    fn step_disturbed<R: Rng + ?Sized>(
        &mut self,
        action: &[f32],
        push: &[f64],
        _: &mut R,
    ) -> Step<Arm> {
        for (i, (low, high)) in LIMITS.into_iter().enumerate() {
            let turn = f64::from(action[i]) + push[i];
            let rate = (self.rates[i] + turn * STEP).clamp(-FASTEST, FASTEST);
            let angle = self.angles[i] + rate * STEP;
            self.angles[i] = angle.clamp(low, high);
            self.rates[i] = if angle == self.angles[i] { rate } else { 0.0 };
        }
        Step::to(self.seen())
    }
}

/// What a network sees: the joints by sine and cosine, how fast they turn, and where the tip is.
#[derive(Clone, Copy, Debug)]
pub struct Look;

impl Features<Arm> for Look {
    fn inputs(&self) -> usize {
        8
    }

    fn write(&self, s: &Arm, inputs: &mut [f32], _: &mut [f32]) {
        let (shoulder, elbow) = (s.shoulder.sin_cos(), s.elbow.sin_cos());
        let rates = [s.shoulder_rate / FASTEST, s.elbow_rate / FASTEST];
        let reach = LINKS[0] + LINKS[1];
        let seen = [
            shoulder.0,
            shoulder.1,
            elbow.0,
            elbow.1,
            rates[0],
            rates[1],
            s.x / reach,
            s.y / reach,
        ];
        inputs.iter_mut().zip(seen).for_each(|(input, seen)| *input = seen as f32);
    }
}

/// A controller as one writes it: to the nearer of the two postures that have the tip at `goal`.
#[must_use]
pub fn steer(s: &Arm, (x, y): (f64, f64)) -> [f32; 2] {
    let [a, b] = LINKS;
    let bend = ((x * x + y * y - a * a - b * b) / (2.0 * a * b)).clamp(-1.0, 1.0).acos();
    let posture = |elbow: f64| {
        let shoulder = y.atan2(x) - (b * elbow.sin()).atan2(a + b * elbow.cos());
        [shoulder, elbow]
    };
    let allowed = |angles: &[f64; 2]| {
        angles.iter().zip(LIMITS).all(|(angle, (low, high))| (low..=high).contains(angle))
    };
    let far = |to: &[f64; 2]| (to[0] - s.shoulder).abs() + (to[1] - s.elbow).abs();
    let postures = [posture(bend), posture(-bend)];
    let nearest = postures.iter().filter(|to| allowed(to)).min_by(|a, b| far(a).total_cmp(&far(b)));
    let to = nearest.unwrap_or(&postures[0]);
    let motor = |to: f64, angle: f64, rate: f64| {
        (30.0 * (to - angle) - 10.0 * rate).clamp(-f64::from(MOTOR), f64::from(MOTOR)) as f32
    };
    [motor(to[0], s.shoulder, s.shoulder_rate), motor(to[1], s.elbow, s.elbow_rate)]
}
