//! The rules: what is true of a kitchen, and what an action makes of it.
//!
//! The preconditions are those of AI2-THOR of early 2018, except for `navigate`, which the paper
//! assumes to work and which is reconstructed:
//!
//! | action | succeeds iff |
//! | --- | --- |
//! | `pick` | an object is focused and in view, and the hand is empty |
//! | `put` | something is in hand; the focused receptacle is in view, open, has room, and may hold it |
//! | `open`, `close` | the focused receptacle is in view and has a door that is closed, open |
//! | `look_up`, `look_down` | the view is not at its end |
//! | `navigate(r)` of a receptacle | always |
//! | `navigate(o)` of an object | the agent knows where it is, it is not in hand, and no closed door is before it |
//!
//! A failed action changes nothing. Whether one fails depends only on what the agent
//! [knows](crate::Known::foresees); nothing moves unless the agent moves it.

use std::fmt;

use crate::action::Action;
use crate::layout::{HORIZONS, Layout, MAX_IDS, NONE, ids_below, members};

/// The level of the view at the start: straight ahead.
const AHEAD: u8 = 2;

/// Everything that is true at one instant, hidden or not, and which places the agent knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Truth {
    /// The object or receptacle that the agent stands before.
    pub(crate) focus: u8,
    /// The level of the view, an index in [`HORIZONS`].
    pub(crate) level: u8,
    /// The object in hand.
    pub(crate) hand: u8,
    /// The receptacles that are open; those without a door always are.
    pub(crate) open: u64,
    /// The objects whose place the agent has seen.
    pub(crate) seen: u64,
    /// The receptacle that each object is in; [`NONE`] in hand.
    pub(crate) place: [u8; MAX_IDS],
}

impl Truth {
    /// A start: object `o` is in receptacle `places[o]`, the doors of the receptacles `open` are
    /// open, and the agent focuses nothing, looks straight ahead and knows of no object.
    ///
    /// # Errors
    /// If the places are not those of all objects, or break a rule: something stands where it may
    /// not, a receptacle holds too much, a door is opened that does not exist.
    pub fn start(layout: &Layout, places: &[u8], open: &[u8]) -> Result<Self, TruthError> {
        let error = |message| Err(TruthError(message));
        if places.len() != layout.objects() {
            return error(format!("{} places for {} objects", places.len(), layout.objects()));
        }
        for (o, &r) in (0..).zip(places) {
            if !layout.is_receptacle(r) {
                return error(format!("`{}` is in {r}, which is no receptacle", layout.name(o)));
            }
            if !layout.may_hold(r, o) {
                let (object, receptacle) = (layout.name(o), layout.name(r));
                return error(format!("`{object}` may not be put into `{receptacle}`"));
            }
        }
        let mut truth = Self::at_rest(layout);
        truth.place[..places.len()].copy_from_slice(places);
        for r in layout.receptacle_ids() {
            let (holds, most) = (truth.contents(layout, r).count_ones(), layout.capacity(r));
            if holds > u32::from(most) {
                return error(format!(
                    "`{}` holds {holds}, but has room for {most}",
                    layout.name(r)
                ));
            }
        }
        for &r in open {
            if !(layout.is_receptacle(r) && layout.has_door(r)) {
                return error(format!("id {r} is no receptacle with a door"));
            }
            truth.open |= 1 << r;
        }
        Ok(truth)
    }

    /// Nothing focused, nothing seen, nothing placed, all doors closed.
    pub(crate) const fn at_rest(layout: &Layout) -> Self {
        Self {
            focus: NONE,
            level: AHEAD,
            hand: NONE,
            open: layout.doorless(),
            seen: 0,
            place: [NONE; MAX_IDS],
        }
    }

    /// The object or receptacle that is focused, or [`NONE`].
    #[must_use]
    pub const fn focus(&self) -> u8 {
        self.focus
    }

    /// Where the agent looks, in degrees: one of [`HORIZONS`].
    #[must_use]
    pub const fn horizon(&self) -> i8 {
        HORIZONS[self.level as usize]
    }

    /// The object in hand, or [`NONE`].
    #[must_use]
    pub const fn hand(&self) -> u8 {
        self.hand
    }

    /// Whether receptacle `r` is open; one without a door always is.
    #[inline]
    #[must_use]
    pub const fn is_open(&self, r: u8) -> bool {
        self.open >> r & 1 == 1
    }

    /// The receptacle that object `o` is in, or [`NONE`] in hand.
    ///
    /// # Panics
    /// If there is no such id.
    #[inline]
    #[must_use]
    pub const fn place(&self, o: u8) -> u8 {
        self.place[o as usize]
    }

    /// The objects in receptacle `r`, as a set of ids (bit `o` for object `o`).
    #[inline]
    #[must_use]
    pub fn contents(&self, layout: &Layout, r: u8) -> u64 {
        let places = self.place[..layout.objects()].iter().enumerate();
        places.fold(0, |set, (o, &place)| set | u64::from(place == r) << o)
    }

    /// The receptacle that is focused, by itself or with an object in it; [`NONE`] if there is
    /// none.
    #[inline]
    #[must_use]
    pub const fn focused_receptacle(&self, layout: &Layout) -> u8 {
        if layout.is_object(self.focus) { self.place[self.focus as usize] } else { self.focus }
    }

    /// The focused receptacle, if it is in view: if the agent looks at the height that it needs.
    #[inline]
    pub(crate) const fn visible_receptacle(&self, layout: &Layout) -> Option<u8> {
        let r = self.focused_receptacle(layout);
        if r != NONE && layout.level(r) == self.level { Some(r) } else { None }
    }

    /// What is in view, as a set of ids: the focused receptacle, and what is in it if it is open.
    #[inline]
    #[must_use]
    pub fn view(&self, layout: &Layout) -> u64 {
        match self.visible_receptacle(layout) {
            Some(r) if self.is_open(r) => 1 << r | self.contents(layout, r),
            Some(r) => 1 << r,
            None => 0,
        }
    }

    /// Takes `action` and returns whether it succeeded; if not, nothing has changed.
    ///
    /// # Panics
    /// If there is no such id.
    #[inline]
    pub fn apply(&mut self, layout: &Layout, action: Action) -> bool {
        let done = match action {
            Action::Pick => self.pick(layout),
            Action::Put => self.put(layout),
            Action::Open => self.set_door(layout, true),
            Action::Close => self.set_door(layout, false),
            Action::LookUp => self.look(self.level + 1),
            Action::LookDown => self.look(self.level.wrapping_sub(1)),
            Action::Navigate(id) => self.navigate(layout, id),
        };
        if done {
            self.seen |= self.view(layout) & ids_below(layout.objects());
        }
        done
    }

    fn pick(&mut self, layout: &Layout) -> bool {
        let o = self.focus;
        let can = layout.is_object(o)
            && self.hand == NONE
            && self.visible_receptacle(layout).is_some_and(|r| self.is_open(r));
        if can {
            self.focus = self.place[o as usize];
            self.place[o as usize] = NONE;
            self.hand = o;
        }
        can
    }

    fn put(&mut self, layout: &Layout) -> bool {
        let (o, r) = (self.hand, self.visible_receptacle(layout));
        let Some(r) = r.filter(|_| o != NONE) else { return false };
        let room = || self.contents(layout, r).count_ones() < u32::from(layout.capacity(r));
        let can = self.is_open(r) && layout.may_hold(r, o) && room();
        if can {
            self.place[o as usize] = r;
            self.hand = NONE;
        }
        can
    }

    fn set_door(&mut self, layout: &Layout, open: bool) -> bool {
        let Some(r) = self.visible_receptacle(layout) else { return false };
        let can = layout.has_door(r) && self.is_open(r) != open;
        if can {
            self.open ^= 1 << r;
        }
        can
    }

    const fn look(&mut self, level: u8) -> bool {
        let can = (level as usize) < HORIZONS.len();
        if can {
            self.level = level;
        }
        can
    }

    fn navigate(&mut self, layout: &Layout, id: u8) -> bool {
        let behind_door = || !self.is_open(self.place[id as usize]);
        let can = if layout.is_object(id) {
            self.seen >> id & 1 == 1 && self.hand != id && !behind_door()
        } else {
            assert!(layout.is_receptacle(id), "there is no id {id}");
            true
        };
        if can {
            self.focus = id;
        }
        can
    }

    /// The situation as text, for messages of tests: what is where, and which doors are open.
    #[must_use]
    pub fn describe(&self, layout: &Layout) -> String {
        let mut text = String::new();
        for r in layout.receptacle_ids() {
            let contents: Vec<&str> =
                members(self.contents(layout, r)).map(|o| layout.name(o)).collect();
            let open = layout.has_door(r) && self.is_open(r);
            if open || !contents.is_empty() {
                let door = if open { " (open)" } else { "" };
                text.push_str(&format!("{}{door}: {}\n", layout.name(r), contents.join(" ")));
            }
        }
        text
    }
}

/// Why a situation is impossible.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TruthError(String);

impl fmt::Display for TruthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for TruthError {}
