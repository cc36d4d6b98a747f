//! Names that are possible, and the one that was likely meant.

/// Least likeness of a name that was likely meant (Jaro and Winkler, 0 to 1). At it, each option of four letters
/// and more has one near its name without any one letter but the first (a test), and `zzz` is like none.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Picture;

    #[test]
    fn a_letter_may_be_missing() {
        let all: Vec<String> = Picture::keywords()
            .into_iter()
            .map(|(name, _)| name)
            .collect();
        let found = |typed: &str| nearest(typed, all.iter().map(String::as_str));
        for name in all.iter().filter(|name| name.len() > 3) {
            for at in 1..name.len() {
                let typed = format!("{}{}", &name[..at], &name[at + 1..]);
                assert!(found(&typed).is_some(), "{typed} of {name}");
            }
        }
        assert_eq!(found("zzz"), None);
    }
}
