//! Comparisons as cuts of linear forms, in exact rational arithmetic.
//!
//! A comparison `2*x + 1 < y` becomes a *form* (`2x - y`, coefficients without a common divisor,
//! the first positive) and a *cut* of the number line at -1. Comparisons of multiples of one form
//! are cuts of the same form, so `x < 1` and `3 > 3*x` are one.
//!
//! All numbers are fractions of `i128` with a power of two below: a double is such a fraction
//! exactly. Whatever grows beyond 62 bits is given up (`None`), and the comparison counts as
//! opaque.
//!
//! ```
//! use tltl_compiler::{arithmetic, check, source::Source};
//!
//! // Whole numbers have none between 1 and 2; real numbers do.
//! let gap = |ty: &str| {
//!     let text = format!("state S {{ x: {ty} }}\ntask t = F (x > 1) && F (x < 2)");
//!     let module = check::file(&Source::new("s.tltl", text)).unwrap();
//!     arithmetic::possible(&module, &module.tasks[0]).excludes(&[(0, true), (1, true)])
//! };
//! assert_eq!((gap("i32"), gap("f64")), (true, false));
//! ```

use crate::ast::{Arithmetic, Comparison};
use crate::linear::{Form, Inequality, combined, divisor};
use crate::predicate::{Module, ParameterType, Scalar, Term, TermId};

/// A rational number. The denominator is positive; the fraction need not be reduced.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rational {
    numerator: i128,
    denominator: i128,
}

impl PartialEq for Rational {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Rational {}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let left = self.numerator.div_euclid(self.denominator);
        let right = other.numerator.div_euclid(other.denominator);
        left.cmp(&right).then_with(|| {
            // The remainders are below their denominators, which are below 2^63.
            let left = self.numerator.rem_euclid(self.denominator) * other.denominator;
            left.cmp(&(other.numerator.rem_euclid(other.denominator) * self.denominator))
        })
    }
}

/// A cut of the number line: `(c, false)` is `form < c`, `(c, true)` is `form <= c`. Cuts are
/// ordered as they lie on the line.
pub(super) type Cut = (Rational, bool);

/// A comparison as a condition on cuts.
#[derive(Clone, Debug)]
pub(super) enum Atom {
    /// The form is below the cut.
    Below(Form, Cut),
    /// The form is not below the cut.
    Above(Form, Cut),
    /// The form is equal to the number.
    At(Form, Rational),
    /// The form is not equal to the number.
    Off(Form, Rational),
    /// It always holds, or never.
    Constant(bool),
    /// Nothing is known about it but its name.
    Opaque,
}

/// The values that a form can take: reals or integers, and their least and greatest if the form is
/// one variable of a bounded type.
pub(super) struct Range {
    integer: bool,
    least: Option<i128>,
    greatest: Option<i128>,
}

impl Range {
    /// The range of a form. A sum of integers is an integer, but its bounds are left to [`bounds`].
    pub(super) fn of(module: &Module, form: &Form) -> Self {
        let scalar = |term: &TermId| integer_range(module, *term);
        let integer = form.iter().all(|(term, _)| scalar(term).is_some());
        match form.as_slice() {
            [(term, 1)] if integer => {
                let (least, greatest) = scalar(term).unwrap_or((i128::MIN, i128::MAX));
                Self { integer, least: Some(least), greatest: Some(greatest) }
            }
            _ => Self { integer, least: None, greatest: None },
        }
    }

    /// Whether there is a value that is not below `after` and is below `until`. Between two cuts of
    /// the reals there always is one: cuts are distinct.
    pub(super) fn is_inhabited(&self, after: Option<Cut>, until: Option<Cut>) -> bool {
        if !self.integer {
            return true;
        }
        // The least integer that is not below a cut.
        let first = |(at, inclusive): Cut| {
            let floor = at.numerator.div_euclid(at.denominator);
            let whole = floor * at.denominator == at.numerator;
            if whole && !inclusive { floor } else { floor + 1 }
        };
        let least = after.map(first).into_iter().chain(self.least).max();
        let end = until.map(first).into_iter().chain(self.greatest.map(|last| last + 1)).min();
        least.zip(end).is_none_or(|(least, end)| least < end)
    }
}

/// The inequalities of a cell of a form: not below `after`, and below `until`.
pub(super) fn inequalities(form: &Form, after: Option<Cut>, until: Option<Cut>) -> Vec<Inequality> {
    let row = |(at, inclusive): Cut, sign: i128| Inequality {
        form: form.iter().map(|&(term, c)| (term, sign * c * at.denominator)).collect(),
        bound: sign * at.numerator,
        // Below `<= c` includes c; not below it excludes c.
        strict: inclusive != (sign > 0),
    };
    let above = after.map(|cut| row(cut, -1));
    above.into_iter().chain(until.map(|cut| row(cut, 1))).collect()
}

/// The inequalities that the type of a variable gives.
pub(super) fn bounds(module: &Module, variable: TermId) -> Option<[Inequality; 2]> {
    let (least, greatest) = integer_range(module, variable)?;
    let row = |sign, bound| Inequality { form: vec![(variable, sign)], bound, strict: false };
    Some([row(-1, -least), row(1, greatest)])
}

/// The least and the greatest value of a term with an integer type; `None` for other terms. The
/// values of an enumeration are numbered in order from 0, and `none` is -1.
fn integer_range(module: &Module, term: TermId) -> Option<(i128, i128)> {
    let (Term::Place { scalar, .. } | Term::Parameter { ty: ParameterType::Scalar(scalar), .. }) =
        module.arena.term(term)
    else {
        return None;
    };
    match *scalar {
        Scalar::Enum { of, optional } => {
            let values = module.enums[of as usize].variants.len() as i128;
            Some((-i128::from(optional), values - 1))
        }
        scalar => scalar.whole(),
    }
}

/// A sum of variables with coefficients, and a constant, all over one denominator. Variables are
/// terms that are not sums themselves.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    form: Form,
    constant: i128,
    /// The common denominator, positive.
    denominator: i128,
}

/// A sum of more variables than this is a variable of its own: adding n terms one by one would take
/// quadratic time.
const MOST_VARIABLES: usize = 64;

/// Numbers stay below this, so that a product of two of them fits into an `i128`.
const SMALL: i128 = 1 << 62;

impl Linear {
    /// A double as an exact fraction; `None` if it is too large or too fine. Infinite and undefined
    /// numbers are neither: the parser and constant folding leave none.
    fn number(value: f64) -> Option<Self> {
        let mut denominator = 1_i128;
        let mut scaled = value;
        while scaled.fract() != 0.0 {
            scaled *= 2.0;
            denominator *= 2;
            if denominator >= SMALL {
                return None;
            }
        }
        // 2^62 is exact in both types.
        (scaled.abs() < SMALL as f64).then(|| Self {
            form: Form::new(),
            constant: scaled as i128,
            denominator,
        })
    }

    /// A term as a variable of its own.
    fn variable(term: TermId) -> Self {
        Self { form: vec![(term, 1)], constant: 0, denominator: 1 }
    }

    /// The sum `self + factor × other`; `None` if it is too large or has too many variables.
    fn plus(&self, factor: i128, other: &Self) -> Option<Self> {
        let sum = |a: i128, b: i128| -> Option<i128> {
            let a = a.checked_mul(other.denominator)?;
            small(a.checked_add(factor.checked_mul(b)?.checked_mul(self.denominator)?)?)
        };
        let form = combined(&self.form, &other.form, &sum)?;
        Some(Self {
            form: (form.len() <= MOST_VARIABLES).then_some(form)?,
            constant: sum(self.constant, other.constant)?,
            denominator: small(self.denominator.checked_mul(other.denominator)?)?,
        })
    }

    /// The product; `None` unless one of the two is a number.
    fn times(&self, other: &Self) -> Option<Self> {
        let (linear, factor) = match (self.form.is_empty(), other.form.is_empty()) {
            (_, true) => (self, other),
            (true, _) => (other, self),
            _ => return None,
        };
        let scale = |value: i128| small(value.checked_mul(factor.constant)?);
        Some(Self {
            form: combined(&linear.form, &Form::new(), &|coefficient, _| scale(coefficient))?,
            constant: scale(linear.constant)?,
            denominator: small(linear.denominator.checked_mul(factor.denominator)?)?,
        })
    }

    /// The quotient by a number; `None` for other divisors and for zero.
    fn over(&self, other: &Self) -> Option<Self> {
        if !other.form.is_empty() || other.constant == 0 {
            return None;
        }
        let sign = other.constant.signum();
        let inverse = Self {
            form: Form::new(),
            constant: sign * other.denominator,
            denominator: other.constant.abs(),
        };
        self.times(&inverse)
    }
}

/// The value, if it is small enough to go on with.
fn small(value: i128) -> Option<i128> {
    (value.abs() < SMALL).then_some(value)
}

/// Some terms as linear combinations of terms that are not linear themselves.
pub(super) struct LinearTerms {
    /// The terms, rising.
    terms: Vec<TermId>,
    /// Each of them as a combination.
    linear: Vec<Linear>,
}

impl LinearTerms {
    /// These terms, rising, with the operands of each among them: one pass, operands first.
    pub(super) fn new(module: &Module, terms: Vec<TermId>) -> Self {
        let mut known = Self { linear: Vec::with_capacity(terms.len()), terms };
        for place in 0..known.terms.len() {
            let id = known.terms[place];
            let combined = known.combined(module.arena.term(id));
            known.linear.push(combined.unwrap_or_else(|| Linear::variable(id)));
        }
        known
    }

    /// A term as a combination, those of its operands known; `None` if it is a variable.
    fn combined(&self, term: &Term) -> Option<Linear> {
        match term {
            Term::Number(number) => Linear::number(number.0),
            Term::Variant { number, .. } => Linear::number(f64::from(*number)),
            Term::Absent => Linear::number(-1.0),
            Term::Negate(a) => Linear::number(0.0)?.plus(-1, self.of(*a)),
            Term::Calculate(Arithmetic::Add, a, b) => self.of(*a).plus(1, self.of(*b)),
            Term::Calculate(Arithmetic::Subtract, a, b) => self.of(*a).plus(-1, self.of(*b)),
            Term::Calculate(Arithmetic::Multiply, a, b) => self.of(*a).times(self.of(*b)),
            Term::Calculate(Arithmetic::Divide, a, b) => self.of(*a).over(self.of(*b)),
            _ => None,
        }
    }

    /// The combination that a term is.
    pub(super) fn of(&self, term: TermId) -> &Linear {
        &self.linear[self.terms.binary_search(&term).expect("a term that is needed")]
    }
}

/// A comparison of two linear terms as an atom; `None` if its numbers are too large for exact
/// arithmetic.
pub(super) fn atom(
    module: &Module,
    comparison: Comparison,
    a: &Linear,
    b: &Linear,
) -> Option<Atom> {
    let difference = a.plus(-1, b)?;
    if difference.form.is_empty() {
        return Some(Atom::Constant(comparison.holds(difference.constant as f64, 0.0)));
    }
    if difference.form.iter().any(|(term, _)| module.arena.constant(*term).is_some()) {
        // A number too large or too fine for exact arithmetic.
        return None;
    }
    // Comparisons of multiples of one form become cuts of the same form: its coefficients have no
    // common divisor, and the first is positive.
    let divisor = divisor(&difference.form, 0) * difference.form[0].1.signum();
    let form: Form = difference.form.iter().map(|&(term, c)| (term, c / divisor)).collect();
    let sign = divisor.signum();
    let at = Rational { numerator: -difference.constant * sign, denominator: divisor.abs() };
    let comparison = if sign < 0 { comparison.mirrored() } else { comparison };
    Some(match comparison {
        Comparison::Less => Atom::Below(form, (at, false)),
        Comparison::AtMost => Atom::Below(form, (at, true)),
        Comparison::Greater => Atom::Above(form, (at, true)),
        Comparison::AtLeast => Atom::Above(form, (at, false)),
        Comparison::Equal => Atom::At(form, at),
        Comparison::Unequal => Atom::Off(form, at),
    })
}
