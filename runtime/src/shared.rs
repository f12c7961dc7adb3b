//! Data that is `static`, or owned by everything that refers to it.
//!
//! Generated code holds its tables in statics; a task that is compiled while a program runs owns
//! them. [`Shared`] is one type for both, so an automaton, a formula and a task are one type each
//! and carry no lifetime. Without the feature `alloc` only statics remain: the type is then a plain
//! reference and costs nothing.

#[cfg(feature = "alloc")]
use alloc::{string::String, sync::Arc, vec::Vec};
use core::fmt;
use core::ops::Deref;

/// A value that is either `static` or shared by reference count.
///
/// A clone copies a pointer. Two values are equal if what they refer to is.
///
/// ```
/// use tltl::Shared;
///
/// static PRIMES: Shared<[u32]> = Shared::from_static(&[2, 3, 5]);
/// assert_eq!(PRIMES.len(), 3);
/// # #[cfg(feature = "alloc")] {
/// let primes: Shared<[u32]> = Shared::from(vec![2, 3, 5]);
/// assert_eq!(primes, PRIMES);
/// # }
/// ```
pub struct Shared<T: ?Sized + 'static>(Place<T>);

enum Place<T: ?Sized + 'static> {
    Static(&'static T),
    #[cfg(feature = "alloc")]
    Counted(Arc<T>),
}

impl<T: ?Sized> Shared<T> {
    /// Refers to a static value. Generated code calls this in constants.
    ///
    /// ```
    /// const NAME: tltl::Shared<str> = tltl::Shared::from_static("deliver");
    /// assert_eq!(&*NAME, "deliver");
    /// ```
    #[must_use]
    pub const fn from_static(value: &'static T) -> Self {
        Self(Place::Static(value))
    }

    /// A part of the value: a reference into it if it is static, otherwise a copy of that part.
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

impl<T: ?Sized> From<&'static T> for Shared<T> {
    fn from(value: &'static T) -> Self {
        Self::from_static(value)
    }
}

#[cfg(feature = "alloc")]
impl<T> From<T> for Shared<T> {
    fn from(value: T) -> Self {
        Self(Place::Counted(Arc::new(value)))
    }
}

#[cfg(feature = "alloc")]
impl<T> From<Vec<T>> for Shared<[T]> {
    fn from(values: Vec<T>) -> Self {
        Self(Place::Counted(values.into()))
    }
}

#[cfg(feature = "alloc")]
impl<T> FromIterator<T> for Shared<[T]> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(Place::Counted(values.into_iter().collect()))
    }
}

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
