//! Drives the grid world with nothing but the policy that `gridworld` emitted: no parser, no
//! learner, no automaton library, only `generated/visit_all.rs`.

#[path = "generated/visit_all.rs"]
#[allow(dead_code, unreachable_pub, reason = "generated; this program does not use all of it")]
mod visit_all;

use tltl_examples::grid::{Cell, Grid};

fn main() {
    use tltl::model::FiniteModel as _;
    let grid = Grid::PAPER;
    let mut random: u64 = std::env::args().nth(1).and_then(|seed| seed.parse().ok()).unwrap_or(7);
    let mut s = grid.index(Cell { x: 0, y: 0 });
    let mut q = visit_all::reset(s);
    println!("step  cell    q  action");
    for step in 0.. {
        let Cell { x, y } = grid.state(s);
        if visit_all::is_done(q) {
            println!("{step:>4}  ({x}, {y})  {q}  accomplished");
            break;
        }
        let action = visit_all::act(q, s);
        println!("{step:>4}  ({x}, {y})  {q}  {}", visit_all::ACTIONS[action]);
        let mut chance = uniform(&mut random);
        let mut next = s;
        grid.transitions(s, action, |to, p| {
            if chance >= 0.0 {
                next = to;
            }
            chance -= p;
        });
        s = next;
        q = visit_all::next(q, s);
    }
}

/// A number in [0, 1): a linear congruential generator (Knuth's MMIX) is chance enough here.
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}
