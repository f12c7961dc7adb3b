//! The file that describes a kitchen.
//!
//! ```toml
//! [[object]]
//! type = "container"
//! count = 2                       # container_1 and container_2; 1 if not said
//! fits = ["cabinet", "sink"]      # types of receptacles that it may be put into
//!
//! [[receptacle]]
//! type = "cabinet"
//! name = "drawer"                 # the type if not said
//! count = 3                       # drawer_1 to drawer_3; 1 if not said
//! first = 1                       # the number of the first one
//! door = true                     # false if not said
//! capacity = 1                    # how many objects it holds
//! horizon = 30                    # 60, 30, 0 or -30: where the agent must look, from down to up
//!
//! [[receptacle]]
//! type = "sink"
//! capacity = 2
//! horizon = 30
//!
//! [[receptacle]]
//! type = "stove_burner"
//! count = 4
//! capacity = 1
//! horizon = 0
//! receives = false                # nothing fits, and that is meant
//! ```
//!
//! Ids follow the order of the file: all objects, then all receptacles. What has a `count` above 1,
//! or a `first`, is numbered. Every mistake is told with its place.

use std::collections::BTreeSet;

use serde::Deserialize;
use toml::Spanned;

use crate::layout::{HORIZONS, Layout, LayoutError, MAX_IDS, Receptacle};

/// A file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    object: Vec<ObjectEntry>,
    #[serde(default)]
    receptacle: Vec<ReceptacleEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObjectEntry {
    r#type: Spanned<String>,
    name: Option<Spanned<String>>,
    first: Option<Spanned<i64>>,
    count: Option<Spanned<i64>>,
    fits: Spanned<Vec<Spanned<String>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReceptacleEntry {
    r#type: Spanned<String>,
    name: Option<Spanned<String>>,
    first: Option<Spanned<i64>>,
    count: Option<Spanned<i64>>,
    #[serde(default)]
    door: bool,
    capacity: Spanned<i64>,
    horizon: Spanned<i64>,
    #[serde(default = "yes")]
    receives: bool,
}

const fn yes() -> bool {
    true
}

/// A message and the byte offset that it is about.
struct Fault(String, Option<usize>);

fn mistake<T, V>(at: &Spanned<V>, message: String) -> Result<T, Fault> {
    Err(Fault(message, Some(at.span().start)))
}

/// The kitchen that `text` describes.
pub(crate) fn parse(text: &str) -> Result<Layout, LayoutError> {
    let file: File = toml::from_str(text).map_err(|error| LayoutError {
        place: error.span().map(|span| place(text, span.start)),
        ..LayoutError::new(error.message())
    })?;
    read(&file).map_err(|Fault(message, at)| LayoutError {
        place: at.map(|at| place(text, at)),
        ..LayoutError::new(message)
    })
}

/// Line and column of a byte offset, from 1.
fn place(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..offset.min(text.len())];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

fn read(file: &File) -> Result<Layout, Fault> {
    let mut names = Names::default();
    let objects = objects(file, &mut names)?;
    let receptacles = receptacles(file, &mut names, &objects)?;
    check_types(file)?;
    let objects = objects.into_iter().map(|(name, entry)| (name, entry.r#type.get_ref().clone()));
    let layout = Layout::new(objects.collect(), receptacles);
    let (all, placed) = (layout.objects(), layout.placed(&[]));
    if placed < all {
        let message = format!(
            "there is not enough room: of {all} objects only {placed} can be put somewhere at once"
        );
        return Err(Fault(message, None));
    }
    Ok(layout)
}

/// The objects by name.
fn objects<'a>(file: &'a File, names: &mut Names) -> Result<Vec<(String, &'a ObjectEntry)>, Fault> {
    let mut objects = Vec::new();
    for entry in &file.object {
        let ObjectEntry { r#type, name, first, count, .. } = entry;
        let all = names.expand(&Group { r#type, name, first, count })?;
        objects.extend(all.into_iter().map(|name| (name, entry)));
    }
    if objects.is_empty() {
        let help = "write [[object]] with `type` and `fits`";
        return Err(Fault(format!("the kitchen has no object: {help}"), None));
    }
    Ok(objects)
}

/// The receptacles, and which of `objects` may be put into them.
fn receptacles(
    file: &File,
    names: &mut Names,
    objects: &[(String, &ObjectEntry)],
) -> Result<Vec<Receptacle>, Fault> {
    let mut receptacles = Vec::new();
    for entry in &file.receptacle {
        let ReceptacleEntry { r#type, name, first, count, .. } = entry;
        let all = names.expand(&Group { r#type, name, first, count })?;
        let (level, capacity, kind) = (level(&entry.horizon)?, capacity(entry)?, r#type.get_ref());
        let fits = |entry: &ObjectEntry| entry.fits.get_ref().iter().any(|t| t.get_ref() == kind);
        let fitting = (0..).zip(objects).filter(|(_, (_, entry))| fits(entry));
        let accepts = fitting.fold(0, |set, (o, _)| set | 1u64 << o);
        let (kind, door) = (kind.clone(), entry.door);
        receptacles.extend(all.into_iter().map(|name| Receptacle {
            name,
            kind: kind.clone(),
            door,
            capacity,
            level,
            accepts,
        }));
    }
    if receptacles.is_empty() {
        let help = "write [[receptacle]] with `type`, `capacity` and `horizon`";
        return Err(Fault(format!("the kitchen has no receptacle: {help}"), None));
    }
    Ok(receptacles)
}

/// What an entry says of the names of its members.
struct Group<'a> {
    r#type: &'a Spanned<String>,
    name: &'a Option<Spanned<String>>,
    first: &'a Option<Spanned<i64>>,
    count: &'a Option<Spanned<i64>>,
}

/// The names that are taken.
#[derive(Default)]
struct Names {
    taken: BTreeSet<String>,
}

impl Names {
    /// The names of a group's members.
    fn expand(&mut self, group: &Group<'_>) -> Result<Vec<String>, Fault> {
        let base = group.name.as_ref().unwrap_or(group.r#type);
        let (word, most) = (base.get_ref(), MAX_IDS as i64);
        check_word(group.r#type)?;
        check_word(base)?;
        let count = in_range("count", group.count.as_ref(), word, 1, most)?;
        let first = in_range("first", group.first.as_ref(), word, 0, 9999)?;
        let numbered = first.is_some() || count > Some(1);
        let (first, count) = (first.unwrap_or(1), count.unwrap_or(1));
        let name = |i| if numbered { format!("{word}_{i}") } else { word.clone() };
        let names: Vec<String> = (first..first + count).map(name).collect();
        for name in &names {
            if !self.taken.insert(name.clone()) {
                return mistake(base, duplicate(name, numbered));
            }
        }
        if self.taken.len() > MAX_IDS {
            let message =
                format!("with `{word}` there are more than {MAX_IDS} objects and receptacles");
            return mistake(base, message);
        }
        Ok(names)
    }
}

/// The number that entry `word` gives for `key`, which must be from `least` to `most`.
fn in_range(
    key: &str,
    number: Option<&Spanned<i64>>,
    word: &str,
    least: i64,
    most: i64,
) -> Result<Option<i64>, Fault> {
    let Some(spanned) = number else { return Ok(None) };
    let number = *spanned.get_ref();
    if (least..=most).contains(&number) {
        return Ok(Some(number));
    }
    mistake(spanned, format!("`{key}` of `{word}` is {number}; {least} to {most} are possible"))
}

fn duplicate(name: &str, numbered: bool) -> String {
    let help =
        if numbered { "let this group count from another `first`" } else { "give it a `name`" };
    format!("there are two called `{name}`: {help}")
}

/// Names are words of lower-case letters, digits and underscores.
fn check_word(word: &Spanned<String>) -> Result<(), Fault> {
    let text = word.get_ref();
    let fine = text.starts_with(|c: char| c.is_ascii_lowercase())
        && text.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    if fine {
        return Ok(());
    }
    mistake(
        word,
        format!("`{text}` is no name: write lower-case letters, digits and `_`, a letter first"),
    )
}

fn level(horizon: &Spanned<i64>) -> Result<u8, Fault> {
    let degrees = *horizon.get_ref();
    match HORIZONS.iter().position(|&level| i64::from(level) == degrees) {
        Some(level) => Ok(level as u8),
        None => mistake(
            horizon,
            format!("the horizon {degrees} is not one of 60, 30, 0 and -30 degrees"),
        ),
    }
}

fn capacity(entry: &ReceptacleEntry) -> Result<u8, Fault> {
    let name = entry.name.as_ref().unwrap_or(&entry.r#type).get_ref();
    let capacity = in_range("capacity", Some(&entry.capacity), name, 1, MAX_IDS as i64)?;
    Ok(capacity.unwrap_or(1) as u8)
}

/// Checks what fits where: all types that are named exist, and none is left out by mistake.
fn check_types(file: &File) -> Result<(), Fault> {
    for entry in &file.object {
        let (name, fits) = (entry.r#type.get_ref(), entry.fits.get_ref());
        if fits.is_empty() {
            return mistake(
                &entry.fits,
                format!("`{name}` fits nowhere: list types of receptacles in `fits`"),
            );
        }
        for (i, kind) in fits.iter().enumerate() {
            check_fit(file, kind)?;
            if fits[..i].iter().any(|other| other.get_ref() == kind.get_ref()) {
                return mistake(kind, format!("`{name}` lists `{}` twice", kind.get_ref()));
            }
        }
    }
    let named = |kind: &str| {
        let mut all = file.object.iter().flat_map(|entry| entry.fits.get_ref());
        all.any(|other| other.get_ref() == kind)
    };
    for entry in file.receptacle.iter().filter(|entry| entry.receives) {
        let kind = entry.r#type.get_ref();
        if !named(kind) {
            let message =
                format!("no object fits `{kind}`: list it in a `fits`, or say `receives = false`");
            return mistake(&entry.r#type, message);
        }
    }
    Ok(())
}

fn check_fit(file: &File, kind: &Spanned<String>) -> Result<(), Fault> {
    let name = kind.get_ref();
    let mut of_type =
        file.receptacle.iter().filter(|entry| entry.r#type.get_ref() == name).peekable();
    if of_type.peek().is_none() {
        let known = file.receptacle.iter().map(|entry| entry.r#type.get_ref().as_str());
        let hint =
            nearest(name, known).map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        return mistake(kind, format!("there is no receptacle of type `{name}`{hint}"));
    }
    if of_type.any(|entry| !entry.receives) {
        return mistake(kind, format!("`{name}` is said to receive nothing (`receives = false`)"));
    }
    Ok(())
}

/// The one of `known` that is spelled most like `name`, if it is near enough.
fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let most = name.chars().count().max(6) / 3;
    let near = known.map(|other| (distance(name, other), other));
    near.min().filter(|&(distance, _)| distance <= most).map(|(_, other)| other)
}

/// The edit distance of two words (Levenshtein).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
