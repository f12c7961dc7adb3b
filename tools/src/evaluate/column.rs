//! Borrowed columns of numbers: arrays of other programs, read without a copy.
//!
//! A column has one of eleven types and a stride, so it may be a field of an array of records, a
//! row or a column of a matrix, or run backwards. Numbers become `f64` block by block, when they
//! are read.

use std::fmt;

/// The rows of a trajectory, or of many: one column for each input of a task, in their order.
///
/// They are either separate [columns](Self::new), or one [matrix](Self::of_rows) of `f64`.
///
/// ```
/// use tltlc::evaluate::{Column, Columns, WrongLength};
///
/// let (x, counts) = ([0.5_f32, 1.5], [1_u8, 2]);
/// let separate = [Column::from(&x[..]), Column::from(&counts[..])];
/// let columns = Columns::new(2, &separate)?;
/// assert_eq!((columns.rows(), columns.width()), (2, 2));
/// let error = Columns::of_rows(2, 3, &[0.0; 5]).unwrap_err();
/// assert_eq!(error, WrongLength { expected: 6, found: 5 });
/// # Ok::<(), WrongLength>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    rows: usize,
    source: Source<'a>,
}

#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    Columns(&'a [Column<'a>]),
    Matrix { numbers: &'a [f64], width: usize },
}

/// A slice that has more or fewer numbers than the rows need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongLength {
    /// The length that the rows need.
    pub expected: usize,
    /// The length of the slice.
    pub found: usize,
}

impl fmt::Display for WrongLength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} numbers where {} belong", self.found, self.expected)
    }
}

impl std::error::Error for WrongLength {}

impl<'a> Columns<'a> {
    /// Columns of `rows` elements each. The number of rows is an argument because a task that reads
    /// nothing has no columns.
    ///
    /// # Errors
    /// If a column has another length.
    pub fn new(rows: usize, columns: &'a [Column<'a>]) -> Result<Self, WrongLength> {
        match columns.iter().find(|column| column.rows != rows) {
            Some(other) => Err(WrongLength { expected: rows, found: other.rows }),
            None => Ok(Self { rows, source: Source::Columns(columns) }),
        }
    }

    /// A matrix of shape (rows, width), row after row.
    ///
    /// # Errors
    /// If `numbers` has another length than `rows * width`.
    pub fn of_rows(rows: usize, width: usize, numbers: &'a [f64]) -> Result<Self, WrongLength> {
        match rows.saturating_mul(width) {
            expected if expected == numbers.len() => {
                Ok(Self { rows, source: Source::Matrix { numbers, width } })
            }
            expected => Err(WrongLength { expected, found: numbers.len() }),
        }
    }

    /// A single row.
    pub(super) fn of_row(numbers: &'a [f64]) -> Self {
        Self { rows: 1, source: Source::Matrix { numbers, width: numbers.len() } }
    }

    /// The number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        match self.source {
            Source::Columns(columns) => columns.len(),
            Source::Matrix { width, .. } => width,
        }
    }

    /// Copies a stretch of one column, from row `first` on, into `out`. A truth value becomes 1 or
    /// `low`.
    pub(super) fn read(&self, column: usize, first: usize, low: f64, out: &mut [f64]) {
        match self.source {
            Source::Columns(columns) => columns[column].read(first, low, out),
            Source::Matrix { numbers, width } => {
                copy(numbers, first * width + column, width as isize, out, |x| x);
            }
        }
    }
}

/// Numbers of one type, borrowed, that may lie apart or run backwards.
///
/// ```
/// use tltlc::evaluate::Column;
///
/// // The second column of three rows, from the last row to the first.
/// let rows: [[f32; 2]; 3] = [[0.0, 1.0], [0.0, 2.0], [0.0, 3.0]];
/// assert!(Column::strided(rows.as_flattened(), 5, -2, 3).is_some());
/// assert!(Column::strided(rows.as_flattened(), 5, -2, 4).is_none());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Column<'a> {
    numbers: Numbers<'a>,
    start: usize,
    stride: isize,
    rows: usize,
}

impl<'a> Column<'a> {
    /// A column of `rows` elements: the one at index `start`, and each next one `stride` indices
    /// further on. The stride counts elements, not bytes, and may be negative or 0.
    ///
    /// Returns `None` if an element would lie outside of `numbers`.
    #[must_use]
    pub fn strided(
        numbers: impl Into<Numbers<'a>>,
        start: usize,
        stride: isize,
        rows: usize,
    ) -> Option<Self> {
        let numbers = numbers.into();
        if let Some(steps) = rows.checked_sub(1) {
            let last = start.checked_add_signed(stride.checked_mul(steps.try_into().ok()?)?)?;
            if start.max(last) >= numbers.len() {
                return None;
            }
        }
        Some(Self { numbers, start, stride, rows })
    }

    /// The number of elements.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }
}

impl<'a, N: Into<Numbers<'a>>> From<N> for Column<'a> {
    fn from(numbers: N) -> Self {
        let numbers = numbers.into();
        Self { numbers, start: 0, stride: 1, rows: numbers.len() }
    }
}

/// Converts every `stride`th number, from index `start` on, into `out`.
fn copy<T: Copy>(
    numbers: &[T],
    start: usize,
    stride: isize,
    out: &mut [f64],
    number: impl Fn(T) -> f64,
) {
    // Contiguous numbers have a loop of their own, which the compiler vectorises.
    if stride == 1 {
        for (out, &value) in out.iter_mut().zip(&numbers[start..]) {
            *out = number(value);
        }
        return;
    }
    let mut at = start;
    for out in out {
        *out = number(numbers[at]);
        at = at.wrapping_add_signed(stride);
    }
}

macro_rules! numbers {
    ($($variant:ident($number:ty),)*) => {
        /// A slice of numbers of any type that a state may have, or of truth values.
        #[derive(Clone, Copy, Debug)]
        #[allow(missing_docs, reason = "each is a slice of its type")]
        pub enum Numbers<'a> {
            $($variant(&'a [$number]),)*
            Bool(&'a [bool]),
        }

        impl Numbers<'_> {
            fn len(&self) -> usize {
                match self {
                    $(Self::$variant(numbers) => numbers.len(),)*
                    Self::Bool(truths) => truths.len(),
                }
            }
        }

        impl Column<'_> {
            fn read(&self, first: usize, low: f64, out: &mut [f64]) {
                let stride = self.stride;
                let start = self.start.wrapping_add_signed(stride.wrapping_mul(first as isize));
                match self.numbers {
                    // Integers beyond 2^53 are rounded to the nearest `f64`, as by `as f64` in
                    // generated code.
                    $(Numbers::$variant(numbers) => copy(numbers, start, stride, out, |x| x as f64),)*
                    Numbers::Bool(truths) => {
                        copy(truths, start, stride, out, |x| if x { 1.0 } else { low });
                    }
                }
            }
        }

        $(impl<'a> From<&'a [$number]> for Numbers<'a> {
            fn from(numbers: &'a [$number]) -> Self {
                Self::$variant(numbers)
            }
        })*
    };
}

numbers! {
    F64(f64), F32(f32),
    I8(i8), I16(i16), I32(i32), I64(i64),
    U8(u8), U16(u16), U32(u32), U64(u64),
}

impl<'a> From<&'a [bool]> for Numbers<'a> {
    fn from(truths: &'a [bool]) -> Self {
        Self::Bool(truths)
    }
}
