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

use std::collections::BTreeMap;

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
    first: Option<i64>,
    count: Option<Spanned<i64>>,
    fits: Spanned<Vec<Spanned<String>>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReceptacleEntry {
    r#type: Spanned<String>,
    name: Option<Spanned<String>>,
    first: Option<i64>,
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
struct Mistake(String, Option<usize>);

fn mistake<T, V>(at: &Spanned<V>, message: String) -> Result<T, Mistake> {
    Err(Mistake(message, Some(at.span().start)))
}

/// The kitchen that `text` describes.
pub(crate) fn parse(text: &str) -> Result<Layout, LayoutError> {
    let file: File = toml::from_str(text).map_err(|error| LayoutError {
        place: error.span().map(|span| place(text, span.start)),
        ..LayoutError::new(error.message())
    })?;
    read(&file).map_err(|Mistake(message, at)| LayoutError {
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

fn read(file: &File) -> Result<Layout, Mistake> {
    let mut names = Names::default();
    let mut objects = Vec::new();
    for entry in &file.object {
        let all =
            names.expand(&entry.r#type, entry.name.as_ref(), entry.first, entry.count.as_ref())?;
        objects.extend(all.into_iter().map(|name| (name, entry)));
    }
    let mut receptacles = Vec::new();
    for entry in &file.receptacle {
        let all =
            names.expand(&entry.r#type, entry.name.as_ref(), entry.first, entry.count.as_ref())?;
        let level = level(&entry.horizon)?;
        let capacity = capacity(entry)?;
        receptacles.extend(all.into_iter().map(|name| (name, entry, level, capacity)));
    }
    let missing = |what: &str| Err(Mistake(format!("the kitchen has no {what}"), None));
    if objects.is_empty() {
        return missing("object: write [[object]] with `type` and `fits`");
    }
    if receptacles.is_empty() {
        return missing("receptacle: write [[receptacle]] with `type`, `capacity` and `horizon`");
    }
    check_types(file)?;
    let accepts = |kind: &str| {
        let fits = |entry: &ObjectEntry| entry.fits.get_ref().iter().any(|t| t.get_ref() == kind);
        (0..)
            .zip(&objects)
            .filter(|(_, (_, entry))| fits(entry))
            .fold(0, |set, (o, _)| set | 1 << o)
    };
    let receptacles = receptacles.into_iter().map(|(name, entry, level, capacity)| Receptacle {
        name,
        kind: entry.r#type.get_ref().clone(),
        door: entry.door,
        capacity,
        level,
        accepts: accepts(entry.r#type.get_ref()),
    });
    let receptacles = receptacles.collect();
    let objects: Vec<_> = objects
        .iter()
        .map(|(name, entry)| (name.clone(), entry.r#type.get_ref().clone()))
        .collect();
    let layout = Layout::new(objects, receptacles);
    let (all, placed) = (layout.objects(), layout.placed(&[]));
    if placed < all {
        let message = format!(
            "there is not enough room: of {all} objects only {placed} can be put somewhere at once"
        );
        return Err(Mistake(message, None));
    }
    Ok(layout)
}

/// The names that are taken, each with the offset of its entry.
#[derive(Default)]
struct Names {
    taken: BTreeMap<String, usize>,
}

impl Names {
    /// The names of an entry's members.
    fn expand(
        &mut self,
        kind: &Spanned<String>,
        name: Option<&Spanned<String>>,
        first: Option<i64>,
        count: Option<&Spanned<i64>>,
    ) -> Result<Vec<String>, Mistake> {
        let base = name.unwrap_or(kind);
        for word in [kind, base] {
            check_word(word)?;
        }
        let many = count.map_or(1, |count| *count.get_ref());
        if let Some(count) = count.filter(|_| !(1..=MAX_IDS as i64).contains(&many)) {
            let message =
                format!("`count` of `{}` is {many}; 1 to {MAX_IDS} are possible", base.get_ref());
            return mistake(count, message);
        }
        let numbered = first.is_some() || many > 1;
        let from = first.unwrap_or(1);
        let name = |i| {
            if numbered {
                format!("{}_{}", base.get_ref(), from + i)
            } else {
                base.get_ref().clone()
            }
        };
        let names: Vec<String> = (0..many).map(name).collect();
        for name in &names {
            if self.taken.insert(name.clone(), base.span().start).is_some() {
                return mistake(base, duplicate(name, numbered));
            }
        }
        if self.taken.len() > MAX_IDS {
            let message = format!(
                "with `{}` there are more than {MAX_IDS} objects and receptacles",
                base.get_ref()
            );
            return mistake(base, message);
        }
        Ok(names)
    }
}

fn duplicate(name: &str, numbered: bool) -> String {
    let help =
        if numbered { "let this group count from another `first`" } else { "give it a `name`" };
    format!("there are two called `{name}`: {help}")
}

/// Names are words of lower-case letters, digits and underscores.
fn check_word(word: &Spanned<String>) -> Result<(), Mistake> {
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

fn level(horizon: &Spanned<i64>) -> Result<u8, Mistake> {
    let degrees = *horizon.get_ref();
    match HORIZONS.iter().position(|&level| i64::from(level) == degrees) {
        Some(level) => Ok(level as u8),
        None => mistake(
            horizon,
            format!("the horizon {degrees} is not one of 60, 30, 0 and -30 degrees"),
        ),
    }
}

fn capacity(entry: &ReceptacleEntry) -> Result<u8, Mistake> {
    let capacity = *entry.capacity.get_ref();
    if (1..=MAX_IDS as i64).contains(&capacity) {
        return Ok(capacity as u8);
    }
    let name = entry.name.as_ref().unwrap_or(&entry.r#type).get_ref();
    mistake(
        &entry.capacity,
        format!("the capacity of `{name}` is {capacity}; 1 to {MAX_IDS} are possible"),
    )
}

/// Checks what fits where: all types that are named exist, and none is left out by mistake.
fn check_types(file: &File) -> Result<(), Mistake> {
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

fn check_fit(file: &File, kind: &Spanned<String>) -> Result<(), Mistake> {
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
    let most = name.chars().count().max(4) / 3;
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
