//! A rover that pushes a crate about a yard: bodies and contacts by the physics library Rapier.
//!
//! Seen from above. The rover is a square plate of 24 cm and 1 kg on wheels that drive it in any
//! direction and keep its heading. It stops at the walls, and pushes the crate, a square of 20 cm and
//! 0.5 kg, which slides and turns as it is hit and is slowed by the floor. Nothing holds either of them
//! back at the edge. An episode starts at rest, with the crate in the middle of the yard and turned
//! anyhow, and the rover anywhere clear of it.
//!
//! Each step builds the bodies anew from the state. What the solver remembers of a contact is therefore
//! lost between steps, but the next state depends on nothing but the state and the action.

use std::f64::consts::TAU;

use rapier2d_f64::prelude::{
    ColliderBuilder, PhysicsWorld, RigidBody, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use tltl::env::{ContinuousEnv, Step};
use tltl::falsify::DisturbedEnv;
use tltl::network::Features;
use tltl::rand::{Rng, RngExt as _};

tltl::include_tltl!("tasks/rover.tltl");

pub use rover::{Rover, push, push_and_dock, rounds, rush, settle};

/// A place in the yard, in metres.
type Place = (f64, f64);

/// The seconds of a step, as `tasks/rover.tltl` says.
pub const STEP: f64 = 0.1;

/// Half the width of the yard, in metres.
pub const HALF: f64 = 1.0;

/// The middles of the dock and of the gate, in metres.
pub const PLACES: [Place; 2] = [(-0.6, 0.5), (0.6, 0.6)];

/// The goal that is behind the crate, wherever that is: the middle of where it starts.
pub const CRATE: Place = (0.0, 0.0);

/// The goal that is the crate in the store: the middle of the store.
pub const STORE: Place = (0.75, 0.125);

/// Half the widths of the part of the yard where the crate starts, in metres.
pub const START: Place = (0.2, 0.15);

/// The middle and half the widths of the wall in the yard, in metres.
pub const WALL: (Place, Place) = ((-0.05, 0.85), (0.05, 0.15));

/// Half the width of the rover, in metres.
const ROVER: f64 = 0.12;

/// Half the width of the crate, in metres.
pub const CRATE_HALF: f64 = 0.1;

/// The largest push along each axis, in newtons.
const PUSH: f32 = 2.0;

/// The physics library's steps in one of the world's. Its contacts are made for steps of about 1/60 s.
const SUBSTEPS: u32 = 5;

/// The largest speed of the rover, in metres a second: there the damping undoes the push.
const FASTEST: f64 = 1.0;

/// The yard.
#[derive(Clone, Debug)]
pub struct Yard {
    at: Rover,
}

impl Default for Yard {
    fn default() -> Self {
        Self::with(start((-0.7, 0.0), CRATE, 0.0))
    }
}

/// All at rest.
const fn start((x, y): Place, (crate_x, crate_y): Place, crate_angle: f64) -> Rover {
    let (vx, vy, crate_vx, crate_vy, crate_turn) = (0.0, 0.0, 0.0, 0.0, 0.0);
    Rover { x, y, vx, vy, crate_x, crate_y, crate_angle, crate_vx, crate_vy, crate_turn }
}

impl Yard {
    /// The yard in a state.
    #[must_use]
    pub const fn with(at: Rover) -> Self {
        Self { at }
    }
}

/// The bodies of a state: the library's world, the rover and the crate.
fn bodies(s: &Rover) -> (PhysicsWorld, [RigidBodyHandle; 2]) {
    let mut world = PhysicsWorld { gravity: Vector::ZERO, ..PhysicsWorld::new() };
    world.integration_parameters.dt = STEP / f64::from(SUBSTEPS);
    // The walls around the yard are 20 cm thick, so that nothing gets through in a step.
    let far = HALF + 0.1;
    let around = [((far, 0.0), (0.1, far)), ((0.0, far), (far, 0.1))];
    let walls = around.into_iter().flat_map(|((x, y), half)| [((x, y), half), ((-x, -y), half)]);
    for ((x, y), (width, height)) in walls.chain([WALL]) {
        // The friction of a contact is the mean of the two: 0.1 of a rover that slides along a wall.
        let wall = ColliderBuilder::cuboid(width, height).friction(0.0);
        let wall = wall.translation(Vector::new(x, y));
        world.insert_collider(wall, None);
    }
    let rover = RigidBodyBuilder::dynamic()
        .translation(Vector::new(s.x, s.y))
        .linvel(Vector::new(s.vx, s.vy))
        .linear_damping(f64::from(PUSH) / FASTEST)
        .lock_rotations()
        .can_sleep(false);
    let plate = ColliderBuilder::cuboid(ROVER, ROVER).mass(1.0).friction(0.2);
    let (rover, _) = world.insert(rover, plate);
    let loose = RigidBodyBuilder::dynamic()
        .translation(Vector::new(s.crate_x, s.crate_y))
        .rotation(s.crate_angle)
        .linvel(Vector::new(s.crate_vx, s.crate_vy))
        .angvel(s.crate_turn)
        .linear_damping(4.0)
        .angular_damping(4.0)
        .can_sleep(false);
    let plate = ColliderBuilder::cuboid(CRATE_HALF, CRATE_HALF).mass(0.5).friction(0.5);
    let (loose, _) = world.insert(loose, plate);
    (world, [rover, loose])
}

/// The state that two bodies are in.
fn seen(rover: &RigidBody, loose: &RigidBody) -> Rover {
    let (at, v) = (rover.translation(), rover.linvel());
    let (to, w) = (loose.translation(), loose.linvel());
    Rover {
        x: at.x,
        y: at.y,
        vx: v.x,
        vy: v.y,
        crate_x: to.x,
        crate_y: to.y,
        crate_angle: loose.rotation().angle(),
        crate_vx: w.x,
        crate_vy: w.y,
        crate_turn: loose.angvel(),
    }
}

impl ContinuousEnv for Yard {
    type State = Rover;

    /// Pushes along x and y, in newtons.
    fn bounds(&self) -> Vec<(f32, f32)> {
        vec![(-PUSH, PUSH); 2]
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Rover {
        let mut within = |half: f64| half * (2.0 * rng.random::<f64>() - 1.0);
        let to = (CRATE.0 + within(START.0), CRATE.1 + within(START.1));
        let angle = within(TAU / 2.0);
        loop {
            let (x, y) = (within(HALF - ROVER), within(HALF - ROVER));
            if let Some(s) = self.reset_at(&[x, y, to.0, to.1, angle]) {
                return s;
            }
        }
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<Rover> {
        self.step_disturbed(action, &[0.0; 2], rng)
    }

    fn component_name(&self, i: usize) -> String {
        ["push along x", "push along y"][i].into()
    }
}

impl DisturbedEnv for Yard {
    /// Where the rover and the crate are, in metres, and how the crate is turned, in radians.
    fn start_bounds(&self) -> Vec<(f64, f64)> {
        let around = |middle: f64, half: f64| (middle - half, middle + half);
        vec![
            around(0.0, HALF - ROVER),
            around(0.0, HALF - ROVER),
            around(CRATE.0, START.0),
            around(CRATE.1, START.1),
            around(0.0, TAU / 2.0),
        ]
    }

    fn reset_at(&mut self, numbers: &[f64]) -> Option<Rover> {
        let &[x, y, crate_x, crate_y, angle] = numbers else { return None };
        let clear = (x - crate_x).hypot(y - crate_y) > 0.35;
        let ((wx, wy), (width, height)) = WALL;
        let walled = (x - wx).abs() < width + ROVER && (y - wy).abs() < height + ROVER;
        self.at = start((x, y), (crate_x, crate_y), angle);
        (clear && !walled && y > -0.6).then_some(self.at)
    }

    /// What pushes the rover beside its wheels, a tenth of theirs, in newtons.
    fn disturbance_bounds(&self) -> Vec<(f64, f64)> {
        vec![(-0.1 * f64::from(PUSH), 0.1 * f64::from(PUSH)); 2]
    }

    fn step_disturbed<R: Rng + ?Sized>(
        &mut self,
        action: &[f32],
        wind: &[f64],
        _: &mut R,
    ) -> Step<Rover> {
        let (mut world, [rover, loose]) = bodies(&self.at);
        let push = [0, 1].map(|i| f64::from(action[i]) + wind[i]);
        world.bodies[rover].add_force(Vector::new(push[0], push[1]), true);
        for _ in 0..SUBSTEPS {
            world.step();
        }
        self.at = seen(&world.bodies[rover], &world.bodies[loose]);
        Step::to(self.at)
    }
}

/// What a network sees: places and speeds of the size of 1, the crate's from the rover too, and how the
/// crate is turned, which looks the same after each quarter.
#[derive(Clone, Copy, Debug)]
pub struct Look;

impl Features<Rover> for Look {
    fn inputs(&self) -> usize {
        13
    }

    fn write(&self, s: &Rover, inputs: &mut [f32], _: &mut [f32]) {
        let turned = (4.0 * s.crate_angle).sin_cos();
        let seen = [
            s.x,
            s.y,
            s.vx / FASTEST,
            s.vy / FASTEST,
            s.crate_x,
            s.crate_y,
            s.crate_x - s.x,
            s.crate_y - s.y,
            s.crate_vx / FASTEST,
            s.crate_vy / FASTEST,
            turned.0,
            turned.1,
            s.crate_turn / 4.0,
        ];
        inputs.iter_mut().zip(seen).for_each(|(input, seen)| *input = seen as f32);
    }
}

/// A controller as one writes it: to `goal`, round the crate and the wall. [`CRATE`] is behind the crate,
/// [`STORE`] pushes it, after it has lined up.
#[must_use]
pub fn steer(s: &Rover, goal: Place) -> [f32; 2] {
    let behind = (s.crate_x - 0.3, s.crate_y);
    let (near, aside) = (s.crate_x - s.x, (s.crate_y - s.y).abs());
    let to = match goal {
        STORE if near > 0.18 && aside < 0.1 => (s.x + 1.0, s.crate_y),
        CRATE | STORE => round_wall(s, round_crate(s, behind)),
        place => round_wall(s, round_crate(s, place)),
    };
    let push = |to: f64, place: f64, speed: f64| {
        (8.0 * (to - place) - 4.0 * speed).clamp(-f64::from(PUSH), f64::from(PUSH)) as f32
    };
    [push(to.0, s.x, s.vx), push(to.1, s.y, s.vy)]
}

/// Where to go first on the way to `goal`: past the crate, on the side of it where the rover is.
fn round_crate(s: &Rover, goal: Place) -> Place {
    let (x, y) = (s.x - s.crate_x, s.y - s.crate_y);
    let (dx, dy) = (goal.0 - s.x, goal.1 - s.y);
    let far = dx.hypot(dy).max(1e-9);
    let along = (-(x * dx + y * dy) / (far * far)).clamp(0.0, 1.0);
    let (nx, ny) = (x + along * dx, y + along * dy);
    if nx.hypot(ny) > 0.29 || along == 0.0 {
        return goal;
    }
    let side = 0.38_f64.copysign(if y.abs() > 0.05 { y } else { 1.0 });
    let corner =
        if y.abs() < 0.3 { 0.38_f64.copysign(x) } else { 0.3_f64.copysign(goal.0 - s.crate_x) };
    (s.crate_x + corner, s.crate_y + side)
}

/// Where to go first on the way to `goal`: below the wall.
fn round_wall(s: &Rover, goal: Place) -> Place {
    let ((wx, wy), (_, height)) = WALL;
    let below = wy - height - ROVER - 0.1;
    let across = (s.x - wx) * (goal.0 - wx) < 0.0;
    let crossing = s.y + (goal.1 - s.y) * (wx - s.x) / (goal.0 - s.x);
    if across && crossing > below + 0.02 { (wx, below) } else { goal }
}
