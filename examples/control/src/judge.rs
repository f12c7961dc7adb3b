//! What a controller is worth: trials from starts that nobody learned from.

use tltl::env::ContinuousEnv;
use tltl::estimate::{Estimate, Played, Tally, Trials, play};
use tltl::rand::{SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl::reward::End;
use tltl::robustness::Predicates;
use tltl::task::{Error, Task};
use tltl::{Acceptor as _, OutOfRange};

/// Steps after which a trial is cut.
pub const HORIZON: u64 = 200;

/// The seed of the starts of all trials; learners draw theirs from others.
pub const STARTS: u64 = 1_000_000;

/// Some trials of a controller.
#[derive(Clone, Debug)]
pub struct Trialled<S> {
    /// How often the task was satisfied and lost, and the steps it took.
    pub estimate: Estimate,
    /// The episodes.
    pub episodes: Vec<Played<S>>,
    /// Their robustness, in the units of the predicates: by how much each satisfied the task, or
    /// missed it.
    pub robustness: Vec<f64>,
}

/// Tries a controller, `act(q, s)`, from `count` starts.
///
/// # Errors
/// If the count is 0, a predicate is not a number, or as `act` says.
pub fn trials<E, P, F>(
    world: &mut E,
    task: &Task<P>,
    count: u64,
    mut act: impl FnMut(u32, &E::State) -> Result<Vec<f32>, F>,
) -> Result<Trialled<E::State>, F>
where
    E: ContinuousEnv,
    P: Predicates<E::State>,
    F: From<Error> + From<OutOfRange>,
{
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(STARTS);
    let mut tally = Tally::new(Trials::default().with_episodes(count)?.with_horizon(HORIZON)?);
    let (mut episodes, mut robustness) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let played = play(world, task, HORIZON, &mut rng, &mut act)?;
        let end = match played.last() {
            q if task.is_accepting(q) => Some(End::Accepted),
            q if task.is_trap(q) => Some(End::Lost),
            _ => None,
        };
        tally.count(end, played.steps());
        robustness.push(task.robustness(&played.states)?);
        episodes.push(played);
    }
    Ok(Trialled { estimate: tally.fixed(), episodes, robustness })
}
