//! Arrays: every one that enters is read here, by its strides.
//!
//! An array of any number type, or of truth values, is borrowed where it lies, in C order, Fortran
//! order or any other order of its axes. It is copied where it has gaps or runs backwards, and where
//! its numbers are of another byte order or of a type that Rust does not have (`float16`). What is no
//! array becomes one by `numpy.asarray`.

use std::borrow::Cow;

use numpy::ndarray::ArrayViewD;
use numpy::{
    Element, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use tltlc::evaluate::{Column, Numbers};

macro_rules! array {
    ($($variant:ident($number:ty),)*) => {
        /// An array that has come in.
        pub(crate) enum Array<'py> {
            $(
                /// Of this type.
                $variant(PyReadonlyArrayDyn<'py, $number>),
            )*
        }

        impl<'py> Array<'py> {
            fn of(array: &Bound<'py, PyUntypedArray>) -> Option<Self> {
                let dtype = array.dtype();
                let found = (dtype.kind(), dtype.itemsize());
                // What is not of this kind and size is not asked whether it is of this type.
                $(if found == (<$number as Reads>::KIND, size_of::<$number>())
                    && let Ok(array) = array.cast::<PyArrayDyn<$number>>()
                {
                    return array.try_readonly().ok().map(Self::$variant);
                })*
                None
            }

            /// The numbers in the order of the memory, and the shape and strides to find them by.
            pub(crate) fn view(&self) -> View<'_> {
                match self {
                    $(Self::$variant(array) => View::new(array.as_array()),)*
                }
            }

            /// Which numbers are positive, or true, in C order; or the first that is not a number.
            fn own_truths(&self) -> Result<Vec<bool>, usize> {
                match self {
                    $(Self::$variant(array) => truths(&in_order(&array.as_array())),)*
                }
            }

            /// The numbers in C order as robustness: 1 or -1 for a truth value.
            pub(crate) fn robustness(&self) -> Vec<f64> {
                match self {
                    $(Self::$variant(array) => {
                        in_order(&array.as_array()).iter().map(|number| number.robustness()).collect()
                    })*
                }
            }

            /// The numbers in C order, if they are whole and not negative.
            fn own_naturals(&self) -> Option<Vec<u64>> {
                match self {
                    $(Self::$variant(array) => naturals(&in_order(&array.as_array())),)*
                }
            }

            /// The shape.
            pub(crate) fn shape(&self) -> &[usize] {
                match self {
                    $(Self::$variant(array) => array.shape(),)*
                }
            }
        }
    };
}

array! {
    F64(f64), F32(f32), Bool(bool), I64(i64), I32(i32), I16(i16), I8(i8),
    U64(u64), U32(u32), U16(u16), U8(u8),
}

/// The numbers in C order: those of the array itself, where it has that order. A slice is walked ten
/// times as fast as an array of any number of axes.
fn in_order<'a, T: Copy>(array: &'a ArrayViewD<'_, T>) -> Cow<'a, [T]> {
    array.as_slice().map_or_else(|| array.iter().copied().collect(), Cow::Borrowed)
}

/// Searched first and then made: neither loop has a branch that the other's result decides.
fn truths<T: Reads>(numbers: &[T]) -> Result<Vec<bool>, usize> {
    match numbers.iter().position(|number| number.truth().is_none()) {
        Some(at) => Err(at),
        None => Ok(numbers.iter().map(|number| number.truth() == Some(true)).collect()),
    }
}

fn naturals<T: Reads>(numbers: &[T]) -> Option<Vec<u64>> {
    let all = numbers.iter().all(|number| number.natural().is_some());
    all.then(|| numbers.iter().map(|number| number.natural().unwrap_or_default()).collect())
}

/// A number as a truth value, and as an index.
trait Reads: Copy {
    /// What NumPy calls this kind of numbers.
    const KIND: u8;
    /// Whether it is positive; `None` if it is not a number.
    fn truth(self) -> Option<bool>;
    /// Itself, if it is of a whole type and not negative.
    fn natural(self) -> Option<u64>;
    /// Itself, or 1 or -1 for a truth value.
    fn robustness(self) -> f64;
}

macro_rules! reads {
    ($($float:ty)*; $($whole:ty: $kind:literal)*) => {
        $(impl Reads for $float {
            const KIND: u8 = b'f';

            fn truth(self) -> Option<bool> {
                (!self.is_nan()).then_some(self > 0.0)
            }

            fn natural(self) -> Option<u64> {
                None
            }

            fn robustness(self) -> f64 {
                self.into()
            }
        })*
        $(impl Reads for $whole {
            const KIND: u8 = $kind;

            fn truth(self) -> Option<bool> {
                Some(self > 0)
            }

            fn natural(self) -> Option<u64> {
                self.try_into().ok()
            }

            fn robustness(self) -> f64 {
                self as f64
            }
        })*
    };
}

reads! { f64 f32; i64: b'i' i32: b'i' i16: b'i' i8: b'i' u64: b'u' u32: b'u' u16: b'u' u8: b'u' }

impl Reads for bool {
    const KIND: u8 = b'b';

    fn truth(self) -> Option<bool> {
        Some(self)
    }

    fn natural(self) -> Option<u64> {
        None
    }

    fn robustness(self) -> f64 {
        if self { 1.0 } else { -1.0 }
    }
}

/// An array as a slice with strides, in elements.
pub(crate) struct View<'a> {
    numbers: Numbers<'a>,
    pub(crate) shape: Vec<usize>,
    strides: Vec<isize>,
}

impl<'a> View<'a> {
    fn new<T: Element>(view: ArrayViewD<'a, T>) -> Self
    where
        &'a [T]: Into<Numbers<'a>>,
    {
        let numbers = view.to_slice_memory_order().unwrap_or_default().into();
        Self { numbers, shape: view.shape().to_vec(), strides: view.strides().to_vec() }
    }

    /// The column along axis `along`, at index `at` of each other axis before and after it; it is
    /// within the array.
    pub(crate) fn column(&self, along: usize, at: &[usize]) -> Column<'a> {
        let start: isize =
            at.iter().zip(&self.strides).map(|(&i, stride)| i as isize * stride).sum();
        let rows = self.shape[along];
        let column = Column::strided(self.numbers, start as usize, self.strides[along], rows);
        column.expect("an index within the shape is an element of the array")
    }
}

impl<'py> Array<'py> {
    /// The numbers as automaton states, if they are stored as those are and less than `count`.
    pub(crate) fn states(&self, count: u32) -> Option<Cow<'_, [u32]>> {
        let Self::U32(array) = self else { return None };
        let states = match array.as_array().to_slice() {
            Some(slice) => Cow::Borrowed(slice),
            None => Cow::Owned(array.as_array().iter().copied().collect()),
        };
        // A loop without an exit is one of vectors.
        (states.iter().fold(0, |most, &q| most.max(q)) < count || states.is_empty())
            .then_some(states)
    }

    /// Which numbers are positive, or true, in C order; or the first that is not a number.
    pub(crate) fn truths(&self) -> Result<Cow<'_, [bool]>, usize> {
        if let Self::Bool(array) = self
            && let Some(slice) = array.as_array().to_slice()
        {
            return Ok(Cow::Borrowed(slice));
        }
        self.own_truths().map(Cow::Owned)
    }

    /// The numbers in C order, if they are whole and not negative.
    pub(crate) fn naturals(&self) -> Option<Cow<'_, [u64]>> {
        if let Self::U64(array) = self
            && let Some(slice) = array.as_array().to_slice()
        {
            return Some(Cow::Borrowed(slice));
        }
        self.own_naturals().map(Cow::Owned)
    }

    /// The array `object`, which messages call `what`.
    pub(crate) fn new(object: &Bound<'py, PyAny>, what: &str) -> PyResult<Self> {
        let array = match object.cast_exact::<PyUntypedArray>() {
            // Most are arrays already: to ask NumPy would take microseconds.
            Ok(array) => array.clone(),
            Err(_) => {
                let numpy = object.py().import("numpy")?;
                if object.is_instance(&numpy.getattr("ma")?.getattr("MaskedArray")?)? {
                    let message = format!("{what}: a masked array; fill it first");
                    return Err(PyTypeError::new_err(message));
                }
                numpy.call_method1("asarray", (object,))?.cast_into::<PyUntypedArray>()?
            }
        };
        let kind = array.dtype().kind();
        if !b"fiub".contains(&kind) {
            let found = array.dtype();
            let message =
                format!("{what}: numbers or truth values are wanted, and this is {found}");
            return Err(PyTypeError::new_err(message));
        }
        let array = readable(array)?;
        let found = || PyTypeError::new_err(format!("{what}: the array cannot be borrowed"));
        Self::of(&array).ok_or_else(found)
    }
}

/// The array itself, or a copy that a slice and strides from its start describe.
fn readable(array: Bound<'_, PyUntypedArray>) -> PyResult<Bound<'_, PyUntypedArray>> {
    let dtype = array.dtype();
    let (kind, size) = (dtype.kind(), dtype.itemsize());
    let wanted = match (kind, size) {
        (b'f', 4 | 8) if dtype.is_native_byteorder() != Some(false) => None,
        (b'f', _) => Some("f8".to_owned()),
        (b'i' | b'u', _) if dtype.is_native_byteorder() == Some(false) => {
            Some(format!("={}{size}", char::from(kind)))
        }
        _ => None,
    };
    let array = match wanted {
        Some(wanted) => array.call_method1("astype", (wanted,))?.cast_into()?,
        None => array,
    };
    let ordered = array.is_contiguous() || is_dense(&array);
    if ordered {
        return Ok(array);
    }
    Ok(array.py().import("numpy")?.call_method1("ascontiguousarray", (array,))?.cast_into()?)
}

/// Whether the axes, in some order, leave no gaps and run forwards.
fn is_dense(array: &Bound<'_, PyUntypedArray>) -> bool {
    let mut axes: Vec<(isize, usize)> =
        array.strides().iter().copied().zip(array.shape().iter().copied()).collect();
    axes.sort_unstable();
    let mut next = array.dtype().itemsize() as isize;
    axes.iter().all(|&(stride, length)| {
        let is_next = stride == next;
        next *= length as isize;
        is_next
    })
}

/// An array of `shape` for Python, of numbers in C order.
pub(crate) fn shaped<'py, T: Element>(
    py: Python<'py>,
    numbers: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArrayDyn::from_owned_array(
        py,
        numpy::ndarray::ArrayD::from_shape_vec(shape, numbers)
            .map_err(|error| super::error::wrong(error.to_string()))?,
    )
    .into_any())
}

/// The same, read-only: what many callers share.
pub(crate) fn frozen<'py, T: Element>(
    py: Python<'py>,
    numbers: Vec<T>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyAny>> {
    let array = shaped(py, numbers, shape)?;
    array.getattr("flags")?.setattr("writeable", false)?;
    Ok(array)
}
