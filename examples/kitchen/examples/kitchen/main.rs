//! The kitchen of the paper's Section 5.2.
use std::error::Error;
mod panels;
mod trial;
use trial::*;
fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let arg: Vec<u64> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let t = std::time::Instant::now();
    let trials =
        Trials::new(Budget { steps: [arg[0], arg[1]], updates: [arg[2], arg[3]], points: 10 })?;
    for curve in trials.compose(1)? {
        println!("{} last {:?} ({:.0} s)", curve.name, curve.last, t.elapsed().as_secs_f64());
        for p in curve.points {
            println!("   {p:?}");
        }
    }
    let _ = panels::svg(&[]);
    Ok(())
}
