//! What the agent has observed: the state that predicates and learners read.

use serde::{Deserialize, Serialize};

use crate::action::Action;
use crate::layout::{Goal, HORIZONS, Layout, MAX_IDS, NONE, ids_below, members};
use crate::truth::Truth;

/// What the agent knows. Arrays are indexed by id; what stands at ids of another sort (a door flag
/// of an object, the place of a receptacle) or beyond the kitchen's is `false`, 0 or [`NONE`].
///
/// Nothing moves unless the agent moves it, so what was seen is still so. What was never in view
/// is not in here, in no form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// The object or receptacle that is focused; [`NONE`] at the start.
    pub focus: u8,
    /// Where the agent looks, in degrees: 60 (down), 30, 0 or -30 (up). See [`Self::level`].
    pub horizon: i8,
    /// The object in hand, or [`NONE`].
    pub hand: u8,
    /// Whether each receptacle is open; one without a door always is.
    #[serde(with = "by_id")]
    pub is_open: [bool; MAX_IDS],
    /// Whether each object and receptacle is in view. What is in hand is not.
    #[serde(with = "by_id")]
    pub in_view: [bool; MAX_IDS],
    /// Where each object was last seen; [`NONE`]: never. Unchanged while it is in hand.
    #[serde(with = "by_id")]
    pub seen_in: [u8; MAX_IDS],
    /// Whether the contents of each receptacle have been in view.
    #[serde(with = "by_id")]
    pub inspected: [bool; MAX_IDS],
    /// How many objects each receptacle held when it was last inspected.
    #[serde(with = "by_id")]
    pub fullness: [u8; MAX_IDS],
    /// The object that is wanted, of the episode's [goal](Self::goal).
    pub wanted: u8,
    /// The receptacle that it is wanted in.
    pub target: u8,
}

impl Known {
    /// What the agent knows before it has seen anything: the doors, and what is wanted.
    pub(crate) fn at_start(layout: &Layout, truth: &Truth, goal: Goal) -> Self {
        let mut known = Self {
            focus: NONE,
            horizon: 0,
            hand: NONE,
            is_open: [false; MAX_IDS],
            in_view: [false; MAX_IDS],
            seen_in: [NONE; MAX_IDS],
            inspected: [false; MAX_IDS],
            fullness: [0; MAX_IDS],
            wanted: goal.object,
            target: goal.receptacle,
        };
        for r in layout.receptacle_ids() {
            known.is_open[r as usize] = truth.is_open(r);
        }
        known.observe(layout, truth, 0);
        known
    }

    /// Takes in what has come about: `before` is what was in view until now. Returns what is in
    /// view now.
    #[inline]
    pub(crate) fn observe(&mut self, layout: &Layout, truth: &Truth, before: u64) -> u64 {
        let view = truth.view(layout);
        self.focus = truth.focus;
        self.horizon = truth.horizon();
        self.hand = truth.hand;
        for id in members(before ^ view) {
            self.in_view[id as usize] = view >> id & 1 == 1;
        }
        if let Some(r) = truth.visible_receptacle(layout) {
            self.is_open[r as usize] = truth.is_open(r);
            if truth.is_open(r) {
                let contents = view & ids_below(layout.objects());
                self.inspected[r as usize] = true;
                self.fullness[r as usize] = contents.count_ones() as u8;
                members(contents).for_each(|o| self.seen_in[o as usize] = r);
            }
        }
        view
    }

    /// The same knowledge under another goal, as relabelling of experience needs it. Which goals
    /// make sense is [`Layout::feasible`]'s to say.
    #[must_use]
    pub const fn with_goal(self, object: u8, receptacle: u8) -> Self {
        Self { wanted: object, target: receptacle, ..self }
    }

    /// What is wanted in this episode.
    #[must_use]
    pub const fn goal(&self) -> Goal {
        Goal { object: self.wanted, receptacle: self.target }
    }

    /// The level of the view, from down to up: an index in [`HORIZONS`].
    ///
    /// # Panics
    /// If the horizon is none of them.
    #[must_use]
    pub fn level(&self) -> usize {
        HORIZONS.iter().position(|&level| level == self.horizon).expect("one of the four levels")
    }

    /// Predicate `see(o)`: `o` is in view, or in hand.
    ///
    /// # Panics
    /// If `o` is not below [`MAX_IDS`]; so with the other predicates.
    #[inline]
    #[must_use]
    pub const fn sees(&self, o: u8) -> bool {
        self.in_view[o as usize] || self.hand == o
    }

    /// Predicate `hold(o)`: `o` is in hand.
    #[inline]
    #[must_use]
    pub const fn holds(&self, o: u8) -> bool {
        self.hand == o
    }

    /// Predicate `open(r)`: `r` is open, or has no door.
    #[inline]
    #[must_use]
    pub const fn opened(&self, r: u8) -> bool {
        self.is_open[r as usize]
    }

    /// Predicate `inside(o, r)`: `o` was last seen in `r`, and is not in hand.
    #[inline]
    #[must_use]
    pub const fn inside(&self, o: u8, r: u8) -> bool {
        self.seen_in[o as usize] == r && self.hand != o
    }

    /// The receptacle that is focused, by itself or with an object in it; [`NONE`] if there is none.
    #[must_use]
    pub const fn focused_receptacle(&self, layout: &Layout) -> u8 {
        if layout.is_object(self.focus) { self.seen_in[self.focus as usize] } else { self.focus }
    }

    /// Whether `action` will succeed. The agent can always tell: the rules are public, and ask
    /// for nothing that is hidden.
    #[must_use]
    pub fn foresees(&self, layout: &Layout, action: Action) -> bool {
        let r = self.focused_receptacle(layout) as usize;
        let visible = r < MAX_IDS && self.in_view[r];
        match action {
            Action::Pick => {
                layout.is_object(self.focus)
                    && self.in_view[self.focus as usize]
                    && self.hand == NONE
            }
            Action::Put => {
                visible
                    && self.is_open[r]
                    && self.hand != NONE
                    && layout.may_hold(r as u8, self.hand)
                    && self.fullness[r] < layout.capacity(r as u8)
            }
            Action::Open => visible && !self.is_open[r],
            Action::Close => visible && layout.has_door(r as u8) && self.is_open[r],
            Action::LookUp => self.horizon > -30,
            Action::LookDown => self.horizon < 60,
            Action::Navigate(id) => {
                let place = self.seen_in[id as usize];
                layout.is_receptacle(id)
                    || place != NONE && self.hand != id && self.is_open[place as usize]
            }
        }
    }
}

/// Arrays by id as sequences.
mod by_id {
    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::layout::MAX_IDS;

    pub(super) fn serialize<T: Serialize, S: Serializer>(
        array: &[T; MAX_IDS],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        array.as_slice().serialize(serializer)
    }

    pub(super) fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<[T; MAX_IDS], D::Error> {
        let items = Vec::deserialize(deserializer)?;
        let wrong = |items: Vec<T>| D::Error::custom(format!("{} ids, not {MAX_IDS}", items.len()));
        items.try_into().map_err(wrong)
    }
}
