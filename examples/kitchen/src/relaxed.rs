//! The relaxed kitchen in which the [planner](crate::planner) searches; what is left out there, and
//! why nothing is lost, is said there.

use std::cmp::Reverse;

use crate::action::Action;
use crate::layout::{Layout, MAX_IDS, NONE, ids_below, members};
use crate::truth::Truth;

/// A kitchen with other capacities, and the actions that a search takes in it.
pub(crate) struct Relaxed {
    /// The facts, with other capacities.
    pub(crate) layout: Layout,
    /// The start, without what is gone or fixed.
    pub(crate) truth: Truth,
    /// The ids to navigate to.
    kept: Vec<u8>,
    /// Whether all actions are taken, everywhere.
    everything: bool,
    /// For each object those of lower id that can be exchanged for it: neither is mentioned, and
    /// they may be put into the same receptacles of `kept`.
    twins: [u64; MAX_IDS],
}

impl Relaxed {
    /// The kitchen itself, with all actions.
    pub(crate) fn unchanged(layout: &Layout, truth: &Truth) -> Self {
        Self {
            layout: layout.clone(),
            truth: *truth,
            kept: (0..layout.ids() as u8).collect(),
            everything: true,
            twins: [0; MAX_IDS],
        }
    }

    /// Relaxes `truth` for a specification that mentions `objects` and `receptacles` (sets of ids),
    /// with exact room in the receptacles of `exact`.
    pub(crate) fn new(
        layout: &Layout,
        truth: &Truth,
        objects: u64,
        receptacles: u64,
        exact: u64,
    ) -> Self {
        let all = ids_below(layout.objects());
        let moved = movable(layout, truth, objects, exact);
        let mut relaxed = Self { everything: false, ..Self::unchanged(layout, truth) };
        relaxed.set_room(layout, all & !moved, exact);
        relaxed.remove(layout, all & !moved);
        let mut kept = moved | exact | receptacles;
        let places = members(moved).map(|o| truth.place(o)).chain([relaxed.truth.focus]);
        kept |= places.filter(|&id| id != NONE).fold(0, |set, id| set | 1 << id);
        kept |= spares(layout, truth, moved, kept, exact | receptacles);
        relaxed.kept = members(kept).collect();
        relaxed.find_twins(moved & !objects, kept);
        relaxed
    }

    /// Makes room without limit outside `exact`, and takes what `absent` takes up from the rest.
    fn set_room(&mut self, layout: &Layout, absent: u64, exact: u64) {
        for r in layout.receptacle_ids() {
            let taken = (self.truth.contents(layout, r) & absent).count_ones() as u8;
            let room = if exact >> r & 1 == 1 { layout.capacity(r) - taken } else { u8::MAX };
            self.layout.set_capacity(r, room);
        }
    }

    /// Takes the objects of `absent` out of the kitchen.
    fn remove(&mut self, layout: &Layout, absent: u64) {
        let focus = self.truth.focus;
        if layout.is_object(focus) && absent >> focus & 1 == 1 {
            self.truth.focus = self.truth.place(focus);
        }
        members(absent).for_each(|o| self.truth.place[o as usize] = NONE);
        self.truth.seen &= !absent;
    }

    /// Finds which of `strangers` can be exchanged.
    fn find_twins(&mut self, strangers: u64, kept: u64) {
        for o in members(strangers) {
            let places = |o: u8| self.layout.places(o) & kept;
            let before = members(strangers & ids_below(o as usize));
            let twins = before.filter(|&twin| places(twin) == places(o));
            self.twins[o as usize] = twins.fold(0, |set, twin| set | 1 << twin);
        }
    }

    /// The actions that are ever taken: the simple ones, and going to what is kept.
    pub(crate) fn actions(&self) -> impl Iterator<Item = Action> + '_ {
        Action::SIMPLE.into_iter().chain(self.kept.iter().map(|&id| Action::Navigate(id)))
    }

    /// Whether the search takes `action` at `truth`.
    #[inline]
    pub(crate) fn takes(&self, truth: &Truth, action: Action) -> bool {
        if self.everything {
            return true;
        }
        let r = truth.focused_receptacle(&self.layout);
        match action {
            Action::LookUp => r != NONE && self.layout.level(r) > truth.level,
            Action::LookDown => r != NONE && self.layout.level(r) < truth.level,
            Action::Close => false,
            Action::Navigate(id) => {
                let visible = truth.visible_receptacle(&self.layout).is_some();
                let start = (truth.focus, truth.level) == (self.truth.focus, self.truth.level);
                id != truth.focus && (visible || start) && !self.has_twin(truth, id)
            }
            _ => true,
        }
    }

    /// Whether a twin of `id` is in the same place, and seen or not seen like it.
    fn has_twin(&self, truth: &Truth, id: u8) -> bool {
        let status = |o: u8| (truth.place(o), truth.seen >> o & 1);
        members(self.twins[id as usize]).any(|twin| status(twin) == status(id))
    }
}

/// What may be moved: the objects mentioned, what is in hand, and the contents of those receptacles
/// of `exact` whose free room may fall short of all that.
fn movable(layout: &Layout, truth: &Truth, objects: u64, exact: u64) -> u64 {
    let hand = truth.hand();
    let mut moved = objects | if hand == NONE { 0 } else { 1 << hand };
    loop {
        let before = moved;
        for r in members(exact) {
            let contents = truth.contents(layout, r);
            let free = u32::from(layout.capacity(r)) - contents.count_ones();
            if free < (moved & !contents & layout.allowed(r)).count_ones() {
                moved |= contents;
            }
        }
        if moved == before {
            return moved;
        }
    }
}

/// Receptacles that stand in for all outside `kept` where something of `moved` may be put. Those
/// of `kept` can do so too, but for the ones of `special`.
fn spares(layout: &Layout, truth: &Truth, moved: u64, kept: u64, special: u64) -> u64 {
    let mut spares = kept & !special & !ids_below(layout.objects());
    let holds = |r: u8| layout.allowed(r) & moved;
    let stands_in = |y: u8, x: u8| {
        layout.level(x) == layout.level(y)
            && holds(x) & !holds(y) == 0
            && (truth.is_open(y) || !truth.is_open(x))
    };
    // Those come first that hold more, are open, and have room.
    let free = |r: u8| layout.capacity(r) - truth.contents(layout, r).count_ones() as u8;
    let rank = |&r: &u8| (Reverse((holds(r).count_ones(), truth.is_open(r), free(r).min(2))), r);
    let useful = |r: &u8| kept >> r & 1 == 0 && holds(*r) != 0;
    let mut left: Vec<u8> = layout.receptacle_ids().filter(useful).collect();
    left.sort_by_key(rank);
    for x in left {
        if !members(spares).any(|y| stands_in(y, x)) {
            spares |= 1 << x;
        }
    }
    spares
}
