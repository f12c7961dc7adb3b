//! The tasks and samples of the benches of robustness and steps.

use tltl::tltl;

#[derive(Clone, Copy)]
pub(crate) struct Sample {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

pub(crate) type Eight = [f64; 8];

tltl! {
    state s: Sample;
    task both = F (s.x > 0 && s.y < 1);
    task until = s.x > 0 U s.y < 1;
    task nested = F (s.x > 0 && F s.y < 1);
    task soon = F[0,1000] s.x > 0;
    task always_soon = F (s.y < 1 && F[0,1000] s.x > 0);
    task until_soon = s.x > 0 U[0,100] s.y < 1;
    task thrice = F (s.x > 0.999 && X (s.y > 2.999 && X s.x > 0.999));
}
tltl! {
    state s: Eight;
    task chain = s[0] > 1.9 T s[1] > 1.9 T s[2] > 1.9 T s[3] > 1.9 T s[4] > 1.9 T s[5] > 1.9
        T s[6] > 1.9 T s[7] > 1.9;
}

/// Samples of a fixed generator: x from -0.5 to 1.5, y from 0 to 3.
pub(crate) fn samples(length: usize) -> Vec<Sample> {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..length).map(|_| Sample { x: random() * 2.0 - 0.5, y: random() * 3.0 }).collect()
}
