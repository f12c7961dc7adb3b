//! Values of the public types can be printed, and moved to and shared with other threads.

mod world;

use core::fmt::Debug;

use tltl::augmented::{Augmented, LabelError};
use tltl::automaton::{Automaton, Edge, Guard, TableError, Tables};
use tltl::compose::Stepwise;
use tltl::controller::Hierarchy;
use tltl::env::TimeLimit;
use tltl::estimate::{Estimate, Interval, Tally, Trials};
use tltl::factored::{Factored, Numbered, Part, Select, TooManyStates};
use tltl::learn::{Checkpoint, Experience, Schedule, TrainError, TrajectoryLearner};
use tltl::model::ModelError;
use tltl::network::Network;
use tltl::network::policy::NetworkPolicy;
use tltl::policy::PolicyError;
use tltl::prelude::*;
use tltl::product::Operand;
use tltl::reward::{Arrival, Arrivals, Ends};
use tltl::robustness::{Boolean, NotANumber, Op};
use tltl::shield::Shield;
use tltl::solve::{Certificate, Evaluation, Optimum, Report, Values};
use tltl::task::{Error, Parametric};
use tltl::{Formula, Mismatch, OutOfRange, Shared, Task};
use world::{A, B, Cell, both, eventually};

fn is_sent<T: Debug + Send>() {}

fn is_shared<T: Debug + Send + Sync>() {}

macro_rules! all_shared {
    ($($type:ty),* $(,)?) => {$( is_shared::<$type>(); )*};
}

/// Predicates and functions of a user's, which print nothing.
struct Silent;

#[test]
fn values_are_printed_sent_and_shared() {
    all_shared! {
        Shared<str>, Shared<[u32]>, Formula, Op, Automaton, Tables, Edge<'_>, Guard<'_>, TableError,
        Task<Silent>, Error, NotANumber, Boolean<fn(&i32) -> bool>, Parametric<Silent, Silent>,
        Factored<Silent>, Part, Select<'_, Silent>, Numbered<Silent>, TooManyStates,
        Product<'_, i32>, Product<'_, [f64]>, Labelled, LabelError, Mismatch, OutOfRange, Rewards, Ends, Arrival,
        Arrivals<'_>, Augmented<ModelEnv<()>, Task<Silent>>, TimeLimit<()>, Step<i32>, Dynamics,
        ModelError, Learner, TrajectoryLearner, Checkpoint, Experience, TrainError, Schedule,
        Settings, QTable, Policy, PolicyError, Network, NetworkPolicy, Problem, Optimum, Evaluation,
        Values, Certificate, Report, Shield, Composition<'_>, Stepwise<'_>, Estimate, Interval, Tally,
        Trials,
    }
    // Its controllers may have a memory, so that two threads cannot ask one at once.
    is_sent::<Hierarchy<'_, i32, Task<Silent>>>();
}

/// What a name stands for says so.
#[test]
fn what_is_printed_names_the_task() {
    let task = both(A, B);
    let text = format!("{task:?}");
    assert_eq!(text, r#"Task { name: "both", formula: "F p && F q", states: 4, .. }"#);
    let (first, second) = (eventually(A), eventually(B));
    let operands: [Operand<'_, Cell>; 2] = [&first, &second];
    let product = format!("{:?}", Product::conjunction(&operands));
    assert!(product.contains(r#"name: "eventually && eventually", states: 4"#), "{product}");
    assert!(format!("{:?}", Hierarchy::new(&task, |_: &Cell| 0)).contains("both"));
}

/// A task by any pointer is the task.
#[test]
fn pointers_are_the_task_that_they_point_to() {
    fn follows(task: impl Monitor<Cell>) {
        let trajectory = [Cell { x: 0, y: 0 }, A, B];
        let q = trajectory.iter().try_fold(0, |q, s| task.next(q, s)).unwrap();
        assert!(task.is_accepting(q) && task.is_terminal(q) && !task.is_trap(q));
        assert_eq!((task.states(), task.name(), task.distance(0)), (4, "both", Some(1)));
        assert_eq!(task.formula().text(), "F p && F q");
        assert_eq!(task.trajectory_robustness(&trajectory), Ok(1.0));
        assert_eq!(task.progress_robustness(0, &A), Ok(1.0));
        assert_eq!(task.trap_robustness(0, &A), Ok(f64::NEG_INFINITY));
        let mut reached = Vec::new();
        task.successors(1, &mut |q| reached.push(q));
        assert_eq!(reached, [1, 3]);
    }
    let task = both(A, B);
    follows(&task);
    follows(Box::new(task.clone()));
    follows(Box::new(task.clone()) as Box<dyn Monitor<Cell> + Send + Sync>);
    follows(std::rc::Rc::new(task.clone()));
    follows(std::sync::Arc::new(task.clone()) as std::sync::Arc<dyn Monitor<Cell>>);
    follows(task);
}
