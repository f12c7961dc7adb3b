//! Sliding windows over a stream of numbers, in memory that the caller lends.
//!
//! The greatest or least of the last w numbers, at three comparisons a number whatever w is (van
//! Herk, "A Fast Algorithm for Local Minimum and Maximum Filters on Rectangular and Octagonal
//! Kernels", 1992; Gil and Werman, "Computing 2-D Min, Median, and Max Filters", 1993). The stream is
//! cut into blocks of w numbers. A window is the end of one block and the beginning of the next: the
//! best of every end is computed once, when its block is full, and the best of the beginning is
//! carried along.
//!
//! A monotone queue (Lemire, "Streaming Maximum-Minimum Filter Using No More than Three Comparisons
//! per Element", 2006) makes as many comparisons, but has to keep the place of each number with it.
//! Here w + 1 numbers are all there is.

use super::{max, min};

/// An operator with a bound, on the stream of its operand's values from the last instant of a
/// trajectory to the first.
///
/// ```
/// use tltl::robustness::Window;
///
/// // G[0,2] φ, where φ has the values 4, 1, 5, 3.
/// let window = Window::Least(2);
/// let mut cells = [f64::NEG_INFINITY; 4];
/// assert_eq!(window.cells(4), 4);
/// let values = [3.0, 5.0, 1.0, 4.0].into_iter().enumerate();
/// let least = values.map(|(pushed, value)| window.push(&mut cells, pushed, value));
/// // At the last two instants the window passes the end.
/// assert!(least.eq([f64::NEG_INFINITY, f64::NEG_INFINITY, 1.0, 1.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// The value so many instants later.
    Later(u32),
    /// The greatest value of now and so many later instants.
    Greatest(u32),
    /// The least value of now and so many later instants; -∞ where these are not all there.
    Least(u32),
}

impl Window {
    /// The number of cells that it needs on a trajectory of so many states. It never exceeds the
    /// bound plus 2, nor the length plus 2.
    #[must_use]
    pub fn cells(self, length: usize) -> usize {
        match self {
            Self::Later(n) => length.min(n as usize).max(1),
            Self::Greatest(n) | Self::Least(n) => length.min(n as usize).saturating_add(2),
        }
    }

    /// Takes the next number of the stream and gives the value of the operator there. `pushed`
    /// counts the numbers before it. `cells` were all -∞ at first, and are its memory.
    ///
    /// # Panics
    /// If there are no cells.
    #[inline]
    pub fn push(self, cells: &mut [f64], pushed: usize, value: f64) -> f64 {
        match self {
            Self::Later(0) => value,
            Self::Later(_) => core::mem::replace(&mut cells[pushed % cells.len()], value),
            Self::Greatest(_) => slide(cells, pushed, value, max),
            Self::Least(_) => slide(cells, pushed, value, min),
        }
    }
}

/// The best of the last w numbers, where w is one less than the number of cells. The first cells
/// hold the block that is being filled, and in the places that are not filled yet the best of the
/// block before from there to its end. The last cell is the best of the block that is being filled.
///
/// Before the first number all are -∞: that is the value past the end of a trajectory.
#[inline]
fn slide(cells: &mut [f64], pushed: usize, value: f64, best: impl Fn(f64, f64) -> f64) -> f64 {
    let Some((carried, block)) = cells.split_last_mut() else { return value };
    let place = pushed % block.len();
    *carried = if place == 0 { value } else { best(*carried, value) };
    block[place] = value;
    let Some(&end) = block.get(place + 1) else {
        for place in (1..block.len()).rev() {
            block[place - 1] = best(block[place - 1], block[place]);
        }
        return *carried;
    };
    best(*carried, end)
}
