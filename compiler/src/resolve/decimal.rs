//! Numbers as they are written, for times: 0.1 is no double, and three times it would not be 0.3.

/// A fraction of whole numbers, the second of them positive.
#[derive(Clone, Copy)]
pub(crate) struct Fraction(pub(crate) u128, pub(crate) u128);

/// A number in decimal notation: digits times a power of ten.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decimal {
    digits: u128,
    exponent: i32,
}

impl Fraction {
    /// The whole numbers next to it, below and above; itself twice if it is whole.
    pub(crate) fn around(self) -> (u128, u128) {
        (self.0 / self.1, self.0.div_ceil(self.1))
    }
}

impl Decimal {
    pub(crate) const ONE: Self = Self { digits: 1, exponent: 0 };

    pub(crate) fn is_zero(self) -> bool {
        self.digits == 0
    }

    /// Reads `12`, `1_000`, `0.5` or `1.5e-3`; `None` if it has more digits than are kept apart.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let text = text.replace('_', "");
        let (digits, power) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let fraction = fraction.trim_end_matches('0');
        let power: i32 = power.parse().ok()?;
        let digits = format!("0{whole}{fraction}").parse().ok()?;
        Some(Self { digits, exponent: power.checked_sub(fraction.len() as i32)? })
    }

    /// Its quotient by another; `None` if it is too large or too long to be exact.
    pub(crate) fn over(self, other: Self) -> Option<Fraction> {
        let shift = self.exponent.checked_sub(other.exponent)?;
        if self.digits == 0 {
            return Some(Fraction(0, 1));
        }
        let power = 10_u128.checked_pow(shift.unsigned_abs())?;
        Some(if shift < 0 {
            Fraction(self.digits, other.digits.checked_mul(power)?)
        } else {
            Fraction(self.digits.checked_mul(power)?, other.digits)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_exact() {
        for (time, step, around) in [
            ("0.3", "0.1", (3, 3)),
            ("0.35", "0.1", (3, 4)),
            ("1e2", "0.25", (400, 400)),
            ("2.50", "5e-1", (5, 5)),
            ("0", "0.1", (0, 0)),
            ("0.04", "0.1", (0, 1)),
            ("1_000", "1", (1_000, 1_000)),
        ] {
            let [time, step] = [time, step].map(|text| Decimal::read(text).unwrap());
            assert_eq!(time.over(step).unwrap().around(), around);
        }
        assert!(Decimal::read(&"9".repeat(50)).is_none());
        let [huge, tiny] = ["1e30", "1e-30"].map(|text| Decimal::read(text).unwrap());
        assert!(huge.over(tiny).is_none());
    }
}
