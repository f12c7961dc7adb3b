//! The functions that intervals are made of: logarithms of Γ and B, and the distribution of a
//! Beta variable.

use core::f64::consts::PI;

/// ln Γ(x) for x > 0, to 15 digits: Stirling's series (Abramowitz and Stegun 6.1.41) from 10 on, where
/// its seventh term is below 1e-16, and the recurrence Γ(x) = Γ(x + 1) / x below.
#[inline]
fn ln_gamma(x: f64) -> f64 {
    const SERIES: [f64; 7] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
    ];
    let (mut x, mut product) = (x, 1.0);
    while x < 10.0 {
        product *= x;
        x += 1.0;
    }
    let correction = SERIES.iter().rev().fold(0.0, |sum, term| term + sum / (x * x)) / x;
    (x - 0.5) * x.ln() - x + 0.5 * (2.0 * PI).ln() + correction - product.ln()
}

/// ln B(a, b) for a, b > 0.
#[inline]
pub(super) fn ln_beta(a: f64, b: f64) -> f64 {
    ln_gamma(a) + ln_gamma(b) - ln_gamma(a + b)
}

/// P(X < x) for X ~ Beta(a, b), the regularized incomplete beta function I_x(a, b), for x in [0, 1].
///
/// P(at least k hits in n trials) is I_p(k, n - k + 1). By the continued fraction (Abramowitz and
/// Stegun 26.5.8), which converges in about √(a + b) steps on the side of the mean that it is
/// used on; on the other, I_x(a, b) = 1 - I_{1-x}(b, a).
#[inline]
pub(super) fn beta_below(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 || x >= 1.0 {
        return if x <= 0.0 { 0.0 } else { 1.0 };
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - beta_below(1.0 - x, b, a);
    }
    (a * x.ln() + b * (-x).ln_1p() - ln_beta(a, b)).exp() / (a * fraction(x, a, b))
}

/// 1 + d₁ / (1 + d₂ / (1 + …)), by the method of Lentz (1976), which goes forward and ends where a
/// step changes nothing. A denominator of 0 is moved off it.
#[inline]
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    let off = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
    let (mut value, mut above, mut below) = (1.0, 1.0, 0.0);
    for step in 1..10_000_000_u32 {
        let m = f64::from(step / 2);
        let at = a + 2.0 * m;
        let d = if step % 2 == 0 {
            m * (b - m) * x / ((at - 1.0) * at)
        } else {
            -(a + m) * (a + b + m) * x / (at * (at + 1.0))
        };
        below = 1.0 / off(1.0 + d * below);
        above = off(1.0 + d / above);
        value *= above * below;
        if (above * below - 1.0).abs() < 4.0 * f64::EPSILON {
            break;
        }
    }
    value
}
