//! The tasks of the worlds, by name.

use tltl::Task;
use tltl::falsify::DisturbedEnv;
use tltl::network::Features;
use tltl::robustness::Predicates;
#[cfg(feature = "rapier")]
use tltl_control::picture::{Block, Loose};
use tltl_control::picture::{Plane, Region};
#[cfg(feature = "rapier")]
use tltl_control::rover::{self, CRATE, STORE};
use tltl_control::{arm, point};

use crate::Failure;
use crate::case::Case;

type Place = (f64, f64);

/// What is done with a case of whatever world.
pub(crate) trait Visitor {
    /// What comes of it.
    type Output;

    /// Does it.
    fn visit<E, P, F>(self, case: &Case<E, P, F>) -> Result<Self::Output, Failure>
    where
        E: DisturbedEnv<State: Clone> + Clone,
        P: Predicates<E::State> + Sync,
        F: Features<E::State> + Copy + Sync;
}

/// The tasks of two and three steps that are soon learned.
pub(crate) const SHORT: &[&str] = &[
    "fetch",
    "tour",
    "bring",
    "bring_and_rest",
    #[cfg(feature = "rapier")]
    "push",
];

/// Those of them that take longer to learn.
pub(crate) const LONG: &[&str] = &[
    #[cfg(feature = "rapier")]
    "push_and_dock",
];

/// The others.
const OTHERS: &[&str] = &[
    "park",
    "hurry",
    "patrol",
    "shuttle",
    #[cfg(feature = "rapier")]
    "rounds",
    #[cfg(feature = "rapier")]
    "rush",
    #[cfg(feature = "rapier")]
    "settle",
];

/// Shows a visitor the case of a task.
pub(crate) fn visit<V: Visitor>(task: &str, visitor: V) -> Result<V::Output, Failure> {
    const A: Place = point::PLACES[0];
    const B: Place = point::PLACES[1];
    const C: Place = point::PLACES[2];
    const CUP: Place = arm::PLACES[0];
    const SHELF: Place = arm::PLACES[1];
    const REST: Place = arm::PLACES[2];
    #[cfg(feature = "rapier")]
    const DOCK: Place = rover::PLACES[0];
    #[cfg(feature = "rapier")]
    const GATE: Place = rover::PLACES[1];
    match task {
        "fetch" => visitor.visit(&room(point::fetch(), &[A, B])),
        "tour" => visitor.visit(&room(point::tour(), &[A, B, C])),
        "park" => visitor.visit(&room(point::park(), &[C])),
        "patrol" => visitor.visit(&room(point::patrol(), &[A, B, C, A])),
        "hurry" => visitor.visit(&room(point::hurry(), &[B])),
        "bring" => visitor.visit(&table(arm::bring(), &[CUP, SHELF])),
        "bring_and_rest" => visitor.visit(&table(arm::bring_and_rest(), &[CUP, SHELF, REST])),
        "shuttle" => visitor.visit(&table(arm::shuttle(), &[CUP, SHELF, REST, CUP])),
        #[cfg(feature = "rapier")]
        "push" => visitor.visit(&yard(rover::push(), &[CRATE, STORE])),
        #[cfg(feature = "rapier")]
        "push_and_dock" => visitor.visit(&yard(rover::push_and_dock(), &[CRATE, STORE, DOCK])),
        #[cfg(feature = "rapier")]
        "rounds" => visitor.visit(&yard(rover::rounds(), &[GATE, DOCK, CRATE, STORE, DOCK])),
        #[cfg(feature = "rapier")]
        "rush" => visitor.visit(&yard(rover::rush(), &[STORE])),
        #[cfg(feature = "rapier")]
        "settle" => visitor.visit(&yard(rover::settle(), &[STORE, DOCK])),
        _ => {
            let known = [SHORT, LONG, OTHERS].concat().join(", ");
            Err(format!("there is no task `{task}`; there are {known}").into())
        }
    }
}

fn room<P>(task: Task<P>, goals: &'static [Place]) -> Case<point::Room, P, point::Look> {
    const PLANE: Plane<'static> = Plane {
        range: (-point::HALF, point::HALF),
        regions: &[
            Region { middle: point::PLACES[0], radius: 0.25, name: "a", barred: false },
            Region { middle: point::PLACES[1], radius: 0.25, name: "b", barred: false },
            Region { middle: point::PLACES[2], radius: 0.25, name: "c", barred: false },
            Region { middle: (0.0, 0.0), radius: 0.3, name: "pillar", barred: true },
        ],
        blocks: &[],
        edge: None,
    };
    Case {
        world: point::Room::default(),
        task,
        look: point::Look,
        step: point::STEP,
        goals,
        by_hand: point::steer,
        plane: PLANE,
        at: |s| (s.x, s.y),
        loose: None,
    }
}

fn table<P>(task: Task<P>, goals: &'static [Place]) -> Case<arm::Table, P, arm::Look> {
    const PLANE: Plane<'static> = Plane {
        range: (-0.6, 0.6),
        regions: &[
            Region { middle: arm::PLACES[0], radius: 0.08, name: "cup", barred: false },
            Region { middle: arm::PLACES[1], radius: 0.08, name: "shelf", barred: false },
            Region { middle: arm::PLACES[2], radius: 0.08, name: "rest", barred: false },
        ],
        blocks: &[],
        edge: Some(-0.1),
    };
    Case {
        world: arm::Table::default(),
        task,
        look: arm::Look,
        step: arm::STEP,
        goals,
        by_hand: arm::steer,
        plane: PLANE,
        at: |s| (s.x, s.y),
        loose: None,
    }
}

#[cfg(feature = "rapier")]
fn yard<P>(task: Task<P>, goals: &'static [Place]) -> Case<rover::Yard, P, rover::Look> {
    const PLANE: Plane<'static> = Plane {
        range: (-rover::HALF, rover::HALF),
        regions: &[
            Region { middle: rover::PLACES[0], radius: 0.2, name: "dock", barred: false },
            Region { middle: rover::PLACES[1], radius: 0.2, name: "gate", barred: false },
        ],
        blocks: &[
            Block { middle: CRATE, half: rover::START, name: "crate", solid: false },
            Block { middle: STORE, half: (0.25, 0.875), name: "store", solid: false },
            Block { middle: rover::WALL.0, half: rover::WALL.1, name: "", solid: true },
        ],
        edge: Some(-0.75),
    };
    Case {
        world: rover::Yard::default(),
        task,
        look: rover::Look,
        step: rover::STEP,
        goals,
        by_hand: rover::steer,
        plane: PLANE,
        at: |s| (s.x, s.y),
        loose: Some(Loose {
            half: rover::CRATE_HALF,
            at: |s| (s.crate_x, s.crate_y, s.crate_angle),
        }),
    }
}
