use std::time::Instant;
use tltl_compiler::{minimize::*, source::Span, spec::*, translate::*};
fn run(name: &str, spec: &Spec) {
    let t = Instant::now();
    let raw = translate(spec, Budget { states: 10_000_000, nodes: 100_000_000 }).unwrap();
    let a = t.elapsed();
    let min = minimize(&raw);
    println!(
        "{name}: raw {} min {:?} translate {:?} total {:?} nodes {}",
        raw.len(),
        min.len(),
        a,
        t.elapsed(),
        raw.diagram.nodes().len()
    );
}
fn names(n: usize) -> Vec<String> {
    (0..n).map(|i| format!("a{i}")).collect()
}
fn main() {
    let sp = Span::default();
    for n in [20, 40, 80, 160, 320] {
        let mut s = Spec::new(names(n));
        let mut f = s.literal(n as u32 - 1, false, sp);
        f = s.eventually(f, sp);
        for i in (0..n - 1).rev() {
            let a = s.literal(i as u32, false, sp);
            let x = s.next(f, sp);
            let x = s.and(a, x, sp);
            f = s.eventually(x, sp);
        }
        s.set_root(f);
        run(&format!("chain {n}"), &s);
        let mut s = Spec::new(names(n));
        let mut f = s.literal(n as u32 - 1, false, sp);
        for i in (0..n - 1).rev() {
            let a = s.literal(i as u32, false, sp);
            f = s.then(a, f, sp);
        }
        s.set_root(f);
        run(&format!("then {n}"), &s);
        // ordered goals: F(a1 & F(a2 & ...)) and !a2 U a1
        let mut s = Spec::new(names(n));
        let mut f = s.literal(n as u32 - 1, false, sp);
        f = s.eventually(f, sp);
        for i in (0..n - 1).rev() {
            let a = s.literal(i as u32, false, sp);
            let x = s.and(a, f, sp);
            f = s.eventually(x, sp);
        }
        s.set_root(f);
        run(&format!("nested nonstrict {n}"), &s);
        let mut s = Spec::new(names(n));
        let l = s.literal(n as u32 - 1, false, sp);
        let mut f = s.eventually(l, sp);
        for i in 0..n - 1 {
            let a = s.literal(i as u32, false, sp);
            let b = s.literal(i as u32 + 1, true, sp);
            let u = s.until(b, a, sp);
            f = s.and(f, u, sp);
        }
        s.set_root(f);
        run(&format!("ordered until {n}"), &s);
    }
    for n in [10, 12, 14, 16] {
        let mut s = Spec::new(names(n));
        let mut f = s.truth(true, sp);
        for i in 0..n {
            let a = s.literal(i as u32, false, sp);
            let a = s.eventually(a, sp);
            f = s.and(f, a, sp);
        }
        s.set_root(f);
        run(&format!("unordered {n}"), &s);
        let mut s = Spec::new(names(n + 1));
        let mut f = s.truth(true, sp);
        let h = s.literal(n as u32, true, sp);
        for i in 0..n {
            let a = s.literal(i as u32, false, sp);
            let a = s.until(h, a, sp);
            f = s.and(f, a, sp);
        }
        s.set_root(f);
        run(&format!("reach-avoid {n}"), &s);
    }
    for k in [8, 12, 16] {
        let mut s = Spec::new(names(2));
        let b = s.literal(1, false, sp);
        let mut f = b;
        for _ in 0..k {
            f = s.next(f, sp);
        }
        let a = s.literal(0, false, sp);
        let f = s.and(a, f, sp);
        let f = s.eventually(f, sp);
        s.set_root(f);
        run(&format!("shift {k}"), &s);
    }
}
