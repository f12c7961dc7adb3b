//! Drives the point with nothing but what was emitted: the actor in `generated/fetch.rs`, and the monitor
//! of the task. No learner and no tensor library; both run without the standard library.
//!
//! `cargo run --release -p tltl-control --example drive_point`

#[path = "../generated/fetch.rs"]
#[allow(dead_code, unreachable_pub, reason = "generated; this program does not use all of it")]
mod actor;

use std::hint::black_box;
use std::time::Instant;

use tltl::Acceptor as _;
use tltl::env::ContinuousEnv as _;
use tltl::network::Features as _;
use tltl::rand::{SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl_control::point::{Look, Room, STEP, fetch};

fn main() -> Result<(), tltl::task::Error> {
    let (mut room, mut rng) = (Room::default(), Xoshiro256PlusPlus::seed_from_u64(7));
    let task = fetch();
    let mut s = room.reset(&mut rng);
    let mut run = task.run();
    run.step(&s)?;
    let mut inputs = [0.0; actor::INPUTS];
    println!("{:>6}{:>8}{:>8}{:>4}", "s", "x, m", "y, m", "q");
    for step in 0..200 {
        let q = run.state();
        println!("{:>6.1}{:>8.2}{:>8.2}{q:>4}", f64::from(step) * STEP, s.x, s.y);
        if task.is_terminal(q) {
            break;
        }
        Look.write(&s, &mut inputs, &mut []);
        let push = actor::control(q as usize, &inputs, &[]);
        s = room.step(&push, &mut rng).state;
        run.step(&s)?;
    }

    // What an action takes.
    let start = Instant::now();
    let count: u32 = 100_000;
    for _ in 0..count {
        black_box(actor::control(0, black_box(&inputs), &[]));
    }
    println!("{:.2} µs an action", start.elapsed().as_secs_f64() * 1e6 / f64::from(count));
    Ok(())
}
