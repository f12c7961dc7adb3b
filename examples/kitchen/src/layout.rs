//! The static facts of a kitchen: what there is, what fits where, and what must be done to see it.
//!
//! Ids number the objects first, `0..n`, and then the receptacles, `n..n + m`; at most [`MAX_IDS`]
//! in all, so that a set of ids is a `u64`. A layout comes from a [file](crate::format) only, and
//! is checked there: every object fits somewhere, and there is room for all of them at once.

use std::fmt;
use std::ops::Range;
use std::path::Path;

use crate::format;

/// The largest number of objects and receptacles together.
pub const MAX_IDS: usize = 64;

/// No object and no receptacle.
pub const NONE: u8 = u8::MAX;

/// The four levels of the view in degrees, from down to up; `look_up` goes to the next.
pub const HORIZONS: [i8; 4] = [60, 30, 0, -30];

/// What a task asks for: an object in a receptacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Goal {
    /// The id of the object.
    pub object: u8,
    /// The id of the receptacle that it is to be put into.
    pub receptacle: u8,
}

/// The static facts of a kitchen.
///
/// ```
/// use tltl_kitchen::Layout;
///
/// let layout = Layout::floorplan24();
/// assert_eq!((layout.objects(), layout.receptacles(), layout.actions()), (17, 39, 62));
/// let (apple, fridge) = (layout.id("apple").unwrap(), layout.id("fridge").unwrap());
/// assert!(layout.feasible(apple, fridge));
/// assert!(!layout.feasible(apple, layout.id("cabinet_3").unwrap()));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The number of objects.
    objects: u8,
    /// The name of each id.
    names: Vec<String>,
    /// The type of each id, as the file calls it.
    types: Vec<String>,
    /// For each receptacle the set of objects that may be put into it.
    accepts: [u64; MAX_IDS],
    /// For each object the set of receptacles that it may be put into.
    places: [u64; MAX_IDS],
    /// The receptacles with a door.
    doors: u64,
    /// How many objects each receptacle holds.
    capacity: [u8; MAX_IDS],
    /// The index in [`HORIZONS`] at which each receptacle is seen.
    level: [u8; MAX_IDS],
    /// For each object the set of receptacles that it can be wanted in.
    goals: [u64; MAX_IDS],
}

/// What the file says of one receptacle.
pub(crate) struct Receptacle {
    pub(crate) name: String,
    pub(crate) kind: String,
    pub(crate) door: bool,
    pub(crate) capacity: u8,
    pub(crate) level: u8,
    /// The set of objects that may be put into it.
    pub(crate) accepts: u64,
}

impl Layout {
    /// The paper's kitchen: 17 objects and 39 receptacles (`kitchens/floorplan24.toml`).
    ///
    /// # Panics
    /// Never: the file is part of the crate and tested.
    #[must_use]
    pub fn floorplan24() -> Self {
        let text = include_str!("../kitchens/floorplan24.toml");
        Self::parse(text).expect("the committed file is a kitchen")
    }

    /// A kitchen of 4 objects and 6 receptacles, for tests and quick runs (`kitchens/small.toml`).
    ///
    /// # Panics
    /// Never: the file is part of the crate and tested.
    #[must_use]
    pub fn small() -> Self {
        let text = include_str!("../kitchens/small.toml");
        Self::parse(text).expect("the committed file is a kitchen")
    }

    /// The kitchen that a [file's text](crate::format) describes.
    ///
    /// # Errors
    /// If the text is no TOML, or no kitchen: where, and what is wrong.
    pub fn parse(text: &str) -> Result<Self, LayoutError> {
        format::parse(text)
    }

    /// The kitchen that the file at `path` describes.
    ///
    /// # Errors
    /// As [`Self::parse`], and if the file cannot be read.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, LayoutError> {
        let path = path.as_ref();
        let of_file = |error: LayoutError| LayoutError { file: Some(path.into()), ..error };
        let text = std::fs::read_to_string(path)
            .map_err(|error| of_file(LayoutError::new(format!("cannot be read: {error}"))))?;
        Self::parse(&text).map_err(of_file)
    }

    /// Puts the facts together; `objects` are (name, type).
    pub(crate) fn new(objects: Vec<(String, String)>, receptacles: Vec<Receptacle>) -> Self {
        let n = objects.len();
        let (mut names, mut types): (Vec<_>, Vec<_>) = objects.into_iter().unzip();
        let mut layout = Self {
            objects: n as u8,
            names: Vec::new(),
            types: Vec::new(),
            accepts: [0; MAX_IDS],
            places: [0; MAX_IDS],
            doors: 0,
            capacity: [0; MAX_IDS],
            level: [0; MAX_IDS],
            goals: [0; MAX_IDS],
        };
        for (r, receptacle) in (n..).zip(receptacles) {
            names.push(receptacle.name);
            types.push(receptacle.kind);
            layout.accepts[r] = receptacle.accepts;
            members(receptacle.accepts).for_each(|o| layout.places[o as usize] |= 1 << r);
            layout.doors |= u64::from(receptacle.door) << r;
            layout.capacity[r] = receptacle.capacity;
            layout.level[r] = receptacle.level;
        }
        (layout.names, layout.types) = (names, types);
        layout.find_goals();
        layout
    }

    /// Finds what can be wanted: what may be put there, and need not stand there at the start.
    fn find_goals(&mut self) {
        for object in self.object_ids() {
            for receptacle in self.receptacle_ids() {
                let goal = Goal { object, receptacle };
                let can = self.may_hold(receptacle, object) && self.has_start(&[goal]);
                self.goals[object as usize] |= u64::from(can) << receptacle;
            }
        }
    }

    /// The number of objects.
    #[must_use]
    pub const fn objects(&self) -> usize {
        self.objects as usize
    }

    /// The number of receptacles.
    #[must_use]
    pub const fn receptacles(&self) -> usize {
        self.ids() - self.objects()
    }

    /// The number of objects and receptacles.
    #[must_use]
    pub const fn ids(&self) -> usize {
        self.names.len()
    }

    /// The number of actions, `6 + ids`; see [`Action`](crate::Action).
    #[must_use]
    pub const fn actions(&self) -> usize {
        6 + self.ids()
    }

    /// The ids of the objects.
    #[must_use]
    pub const fn object_ids(&self) -> Range<u8> {
        0..self.objects
    }

    /// The ids of the receptacles.
    #[must_use]
    pub const fn receptacle_ids(&self) -> Range<u8> {
        self.objects..self.ids() as u8
    }

    /// Whether `id` is an object.
    #[inline]
    #[must_use]
    pub const fn is_object(&self, id: u8) -> bool {
        id < self.objects
    }

    /// Whether `id` is a receptacle.
    #[inline]
    #[must_use]
    pub const fn is_receptacle(&self, id: u8) -> bool {
        id >= self.objects && (id as usize) < self.ids()
    }

    /// The id of what is called `name`: `fridge`, `cabinet_3`.
    #[must_use]
    pub fn id(&self, name: &str) -> Option<u8> {
        self.names.iter().position(|other| other == name).map(|id| id as u8)
    }

    /// The name of `id`; `nothing` for [`NONE`].
    ///
    /// # Panics
    /// If there is no such id.
    #[must_use]
    pub fn name(&self, id: u8) -> &str {
        if id == NONE { "nothing" } else { &self.names[id as usize] }
    }

    /// The type of `id`, as its file calls it: `cabinet` for `drawer_2`.
    ///
    /// # Panics
    /// If there is no such id.
    #[must_use]
    pub fn type_name(&self, id: u8) -> &str {
        &self.types[id as usize]
    }

    /// Whether receptacle `r` has a door. What has none is always open.
    #[inline]
    #[must_use]
    pub const fn has_door(&self, r: u8) -> bool {
        self.doors >> r & 1 == 1
    }

    /// The receptacles with a door, as a set of ids.
    pub(crate) const fn doors(&self) -> u64 {
        self.doors
    }

    /// The receptacles that object `o` may be put into, as a set of ids.
    pub(crate) const fn places(&self, o: u8) -> u64 {
        self.places[o as usize]
    }

    /// The receptacles without a door, as a set of ids.
    pub(crate) const fn doorless(&self) -> u64 {
        !self.doors & ids_below(self.ids()) & !ids_below(self.objects())
    }

    /// How many objects receptacle `r` holds.
    #[inline]
    #[must_use]
    pub const fn capacity(&self, r: u8) -> u8 {
        self.capacity[r as usize]
    }

    /// The level of the view at which receptacle `r` is seen, an index in [`HORIZONS`].
    #[inline]
    #[must_use]
    pub const fn level(&self, r: u8) -> u8 {
        self.level[r as usize]
    }

    /// Whether the type of object `o` is allowed in receptacle `r`.
    #[inline]
    #[must_use]
    pub const fn may_hold(&self, r: u8, o: u8) -> bool {
        self.accepts[r as usize] >> o & 1 == 1
    }

    /// The objects that may be put into receptacle `r`, as a set of ids.
    pub(crate) const fn allowed(&self, r: u8) -> u64 {
        self.accepts[r as usize]
    }

    /// Sets how many objects receptacle `r` holds.
    pub(crate) const fn set_capacity(&mut self, r: u8, capacity: u8) {
        self.capacity[r as usize] = capacity;
    }

    /// Whether `object` can be wanted in `receptacle`: its type is allowed there, and there are
    /// starts in which it stands elsewhere.
    #[inline]
    #[must_use]
    pub const fn feasible(&self, object: u8, receptacle: u8) -> bool {
        self.is_object(object)
            && self.is_receptacle(receptacle)
            && self.goals[object as usize] >> receptacle & 1 == 1
    }

    /// All [feasible](Self::feasible) goals, in ascending order.
    pub fn feasible_goals(&self) -> impl Iterator<Item = Goal> + '_ {
        let pairs = self.object_ids().flat_map(|object| {
            self.receptacle_ids().map(move |receptacle| Goal { object, receptacle })
        });
        pairs.filter(|goal| self.feasible(goal.object, goal.receptacle))
    }

    /// Whether all objects can be put somewhere at once, none of them where one of `unwanted`
    /// has it.
    pub(crate) fn has_start(&self, unwanted: &[Goal]) -> bool {
        self.placed(unwanted) == self.objects()
    }

    /// How many objects can be put somewhere at once: a maximum matching of objects and places,
    /// by augmenting paths.
    pub(crate) fn placed(&self, unwanted: &[Goal]) -> usize {
        let mut holds = vec![Vec::new(); self.ids()];
        let place = |&object: &u8| {
            let mut tried = 0;
            self.place(object, unwanted, &mut holds, &mut tried)
        };
        self.object_ids().filter(place).count()
    }

    /// Finds a place for `object`, moving others if need be.
    fn place(&self, object: u8, unwanted: &[Goal], holds: &mut [Vec<u8>], tried: &mut u64) -> bool {
        for receptacle in self.receptacle_ids() {
            let allowed = self.may_hold(receptacle, object)
                && !unwanted.contains(&Goal { object, receptacle });
            if !allowed || *tried >> receptacle & 1 == 1 {
                continue;
            }
            *tried |= 1 << receptacle;
            let r = receptacle as usize;
            if holds[r].len() < self.capacity[r] as usize {
                holds[r].push(object);
                return true;
            }
            for i in 0..holds[r].len() {
                if self.place(holds[r][i], unwanted, holds, tried) {
                    holds[r][i] = object;
                    return true;
                }
            }
        }
        false
    }
}

/// The set of ids below `n`.
pub(crate) const fn ids_below(n: usize) -> u64 {
    if n >= 64 { u64::MAX } else { (1 << n) - 1 }
}

/// The ids of a set, ascending.
pub(crate) fn members(mut set: u64) -> impl Iterator<Item = u8> {
    std::iter::from_fn(move || {
        let id = (set != 0).then(|| set.trailing_zeros() as u8)?;
        set &= set - 1;
        Some(id)
    })
}

/// What is wrong with the description of a kitchen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayoutError {
    pub(crate) message: String,
    /// Line and column, from 1.
    pub(crate) place: Option<(usize, usize)>,
    pub(crate) file: Option<std::path::PathBuf>,
}

impl LayoutError {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), place: None, file: None }
    }

    /// The line and the column of the mistake, from 1; `None` if it has no single place.
    #[must_use]
    pub fn place(&self) -> Option<(usize, usize)> {
        self.place
    }
}

impl fmt::Display for LayoutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}: ", file.display())?;
        }
        if let Some((line, column)) = self.place {
            write!(f, "line {line}, column {column}: ")?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for LayoutError {}
