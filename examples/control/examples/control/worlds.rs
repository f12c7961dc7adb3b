//! The tasks of the worlds, by name.

use tltl::Task;
use tltl::falsify::DisturbedEnv;
use tltl::network::Features;
use tltl::robustness::Predicates;
use tltl_control::picture::{Plane, Region};
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

/// The tasks of two and three steps.
pub(crate) const SHORT: [&str; 4] = ["fetch", "tour", "bring", "bring_and_rest"];

/// The others.
const OTHERS: [&str; 2] = ["park", "hurry"];

/// Shows a visitor the case of a task.
pub(crate) fn visit<V: Visitor>(task: &str, visitor: V) -> Result<V::Output, Failure> {
    const A: Place = point::PLACES[0];
    const B: Place = point::PLACES[1];
    const C: Place = point::PLACES[2];
    const CUP: Place = arm::PLACES[0];
    const SHELF: Place = arm::PLACES[1];
    const REST: Place = arm::PLACES[2];
    match task {
        "fetch" => visitor.visit(&room(point::fetch(), &[A, B])),
        "tour" => visitor.visit(&room(point::tour(), &[A, B, C])),
        "park" => visitor.visit(&room(point::park(), &[C])),
        "hurry" => visitor.visit(&room(point::hurry(), &[B])),
        "bring" => visitor.visit(&table(arm::bring(), &[CUP, SHELF])),
        "bring_and_rest" => visitor.visit(&table(arm::bring_and_rest(), &[CUP, SHELF, REST])),
        _ => {
            let known = [&SHORT[..], &OTHERS].concat().join(", ");
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
    }
}
