//! Names that were nearly right.

/// The candidate that differs least from `name`, if it is near enough to be meant.
pub(super) fn nearest<'a>(
    name: &str,
    candidates: &mut dyn Iterator<Item = &'a str>,
) -> Option<&'a str> {
    let limit = (name.chars().count() / 3).max(1);
    let mut nearest = None;
    for candidate in candidates {
        let distance = distance(name, candidate);
        if distance <= limit && nearest.is_none_or(|(known, _)| distance < known) {
            nearest = Some((distance, candidate));
        }
    }
    nearest.map(|(_, candidate)| candidate)
}

/// The number of letters to add, drop, change or swap with their neighbour (optimal string
/// alignment), case aside.
fn distance(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|text| text.to_lowercase().chars().collect::<Vec<_>>());
    if a.len().abs_diff(b.len()) > 8 || a.len() > 64 {
        return usize::MAX;
    }
    let mut rows = vec![(0..=b.len()).collect::<Vec<_>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let change = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = change.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

/// Whether Rust has taken a word, and a name of the same letters is written with `r#`.
pub(super) fn is_rust_word(word: &str) -> bool {
    crate::reserved::is_keyword(word) && !matches!(word, "true" | "false")
}
