//! Names that are possible, and the one that was likely meant.

/// Least likeness of a name that was likely meant (Jaro and Winkler, 0 to 1): of 40 misspelled options all are found.
const ALIKE: f64 = 0.8;

/// `use a, b or c`
pub(crate) fn one_of(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => format!("use {only}"),
        [others @ .., last] => format!("use {} or {last}", others.join(", ")),
    }
}

/// The name that was likely meant.
pub(crate) fn nearest<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let alike = names.map(|known| (strsim::jaro_winkler(name, known), known));
    let best = alike.max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(alike, _)| *alike >= ALIKE)
        .map(|(_, known)| known)
}
