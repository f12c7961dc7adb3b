//! Data that is `static`, or owned by everything that refers to it.
//!
//! Generated code holds its tables in statics; a task that is compiled while a program runs owns
//! its tables. [`Shared`] is one type for both, so an automaton, a formula and a task are one type
//! each, carry no lifetime, and are dropped when nobody uses them any more.
//!
//! `Cow<'static, T>` would also do, but its clones copy what is owned, and it needs an allocator.
//! Without the feature `alloc` a [`Shared`] is a plain reference. With it, reading costs an addition
//! to the address (which is the same for both kinds but for the counters in front of owned data):
//! the step of a task in a static is at most 3 % slower than by a reference.

#[cfg(feature = "alloc")]
use alloc::{string::String, sync::Arc, vec::Vec};
use core::fmt;
use core::ops::Deref;

/// A value that is either `static` or shared by reference count.
///
/// It reads as what it refers to (`Deref`), cannot be changed, and is `Send` and `Sync` if that is.
/// A clone copies a pointer, whatever the size of the value. Two are equal if the values are,
/// wherever these are.
///
/// What takes `impl Into<Shared<…>>` takes a `&'static` reference, an owned value (`String`, `Vec`,
/// any `T`), or another `Shared`.
///
/// ```
/// use tltl::Shared;
///
/// static PRIMES: Shared<[u32]> = Shared::from_static(&[2, 3, 5]);
/// assert_eq!(PRIMES.len(), 3);
/// # #[cfg(feature = "alloc")] {
/// let primes: Shared<[u32]> = Shared::from(vec![2, 3, 5]);
/// assert_eq!(primes, PRIMES);
///
/// let name: Shared<str> = Shared::from(format!("task {}", 1));
/// let again = name.clone();
/// assert!(core::ptr::eq(&*name, &*again), "the text is there once");
/// # }
/// ```
pub struct Shared<T: ?Sized + 'static>(Place<T>);

enum Place<T: ?Sized + 'static> {
    Static(&'static T),
    #[cfg(feature = "alloc")]
    Counted(Arc<T>),
}

impl<T: ?Sized> Shared<T> {
    /// Refers to a static value, also in a constant: this is how generated code makes its tables.
    ///
    /// ```
    /// const NAME: tltl::Shared<str> = tltl::Shared::from_static("deliver");
    /// assert_eq!(&*NAME, "deliver");
    /// ```
    #[must_use]
    pub const fn from_static(value: &'static T) -> Self {
        Self(Place::Static(value))
    }

    /// The value if it is static, also in a constant.
    pub(crate) const fn in_static(&self) -> Option<&'static T> {
        match &self.0 {
            Place::Static(value) => Some(value),
            #[cfg(feature = "alloc")]
            Place::Counted(_) => None,
        }
    }

    /// A part of the value: a reference into it if it is static, otherwise a copy of that part,
    /// because a counted pointer cannot point into the middle of what it counts.
    pub(crate) fn project<U: Clone>(&self, part: impl FnOnce(&T) -> &U) -> Shared<U> {
        match &self.0 {
            Place::Static(value) => Shared(Place::Static(part(value))),
            #[cfg(feature = "alloc")]
            Place::Counted(value) => part(value).clone().into(),
        }
    }
}

impl<T: ?Sized> Deref for Shared<T> {
    type Target = T;

    #[inline]
    fn deref(&self) -> &T {
        match &self.0 {
            Place::Static(value) => value,
            #[cfg(feature = "alloc")]
            Place::Counted(value) => value,
        }
    }
}

impl<T: ?Sized> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(match &self.0 {
            Place::Static(value) => Place::Static(value),
            #[cfg(feature = "alloc")]
            Place::Counted(value) => Place::Counted(value.clone()),
        })
    }
}

/// A static value.
impl<T: ?Sized> From<&'static T> for Shared<T> {
    fn from(value: &'static T) -> Self {
        Self::from_static(value)
    }
}

/// An owned value.
#[cfg(feature = "alloc")]
impl<T> From<T> for Shared<T> {
    fn from(value: T) -> Self {
        Self(Place::Counted(Arc::new(value)))
    }
}

/// An owned slice.
#[cfg(feature = "alloc")]
impl<T> From<Vec<T>> for Shared<[T]> {
    fn from(values: Vec<T>) -> Self {
        Self(Place::Counted(values.into()))
    }
}

/// An owned slice of what the iterator gives.
#[cfg(feature = "alloc")]
impl<T> FromIterator<T> for Shared<[T]> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(Place::Counted(values.into_iter().collect()))
    }
}

/// An owned text.
#[cfg(feature = "alloc")]
impl From<String> for Shared<str> {
    fn from(text: String) -> Self {
        Self(Place::Counted(text.into()))
    }
}

impl<T: ?Sized + PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: ?Sized + Eq> Eq for Shared<T> {}

impl<T: ?Sized + fmt::Debug> fmt::Debug for Shared<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

impl<T: ?Sized + fmt::Display> fmt::Display for Shared<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}
