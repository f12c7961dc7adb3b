//! The actions: six without an argument, then `navigate` for each id.

use crate::layout::Layout;

/// What the agent can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Takes the focused object.
    Pick,
    /// Puts what is in hand into the focused receptacle.
    Put,
    /// Opens the door of the focused receptacle.
    Open,
    /// Closes it.
    Close,
    /// Raises the view by 30°.
    LookUp,
    /// Lowers the view by 30°.
    LookDown,
    /// Goes to an object or a receptacle and focuses it.
    Navigate(u8),
}

impl Action {
    /// The actions without an argument, in the order of their numbers.
    pub const SIMPLE: [Self; 6] =
        [Self::Pick, Self::Put, Self::Open, Self::Close, Self::LookUp, Self::LookDown];

    /// The number of the action, `0..6 + ids`.
    #[must_use]
    pub const fn index(self) -> usize {
        match self {
            Self::Pick => 0,
            Self::Put => 1,
            Self::Open => 2,
            Self::Close => 3,
            Self::LookUp => 4,
            Self::LookDown => 5,
            Self::Navigate(id) => 6 + id as usize,
        }
    }

    /// The action with number `index`.
    ///
    /// # Panics
    /// If `index` is at least 6 + 256. Whether the id is one of the kitchen's is the caller's to
    /// know.
    #[inline]
    #[must_use]
    pub const fn from_index(index: usize) -> Self {
        if index < 6 {
            return Self::SIMPLE[index];
        }
        assert!(index < 6 + 256, "there is no action of this number");
        Self::Navigate((index - 6) as u8)
    }

    /// The action as it is shown: `pick`, `navigate(fridge)`.
    #[must_use]
    pub fn name(self, layout: &Layout) -> String {
        match self {
            Self::Pick => "pick".into(),
            Self::Put => "put".into(),
            Self::Open => "open".into(),
            Self::Close => "close".into(),
            Self::LookUp => "look_up".into(),
            Self::LookDown => "look_down".into(),
            Self::Navigate(id) => format!("navigate({})", layout.name(id)),
        }
    }
}
