//! Short names in shaders: compressed, texts take a sixth less.
//!
//! A name that is declared anywhere gets one short name everywhere, whatever it means in each place. Kept are those
//! that the host uses, those that mean something to the language (attributes, address spaces, functions that are
//! called but declared nowhere), and swizzles.

use std::collections::{BTreeMap, BTreeSet};

/// A language, by what it declares names with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Language {
    /// `let name`, `fn name`, `name: type`.
    Wgsl,
    /// `type name`.
    Glsl,
}

/// Words of GLSL before names that declare nothing.
const NO_TYPES: [&str; 12] = [
    "return",
    "else",
    "case",
    "precision",
    "highp",
    "in",
    "out",
    "uniform",
    "const",
    "layout",
    "flat",
    "smooth",
];
/// Words of WGSL before names that they declare.
const DECLARING: [&str; 6] = ["fn", "let", "var", "const", "struct", "alias"];

/// The texts with short names, but for those that `keeps` is true of.
pub(crate) fn shortened(
    texts: &[String],
    language: Language,
    keeps: impl Fn(&str) -> bool,
) -> Vec<String> {
    let mut found = Names::default();
    for text in texts {
        found.read(text, language);
    }
    let short = found.short(&keeps);
    let renamed = |text: &String| {
        let parts = parts(text).into_iter();
        parts
            .map(|part| short.get(part).map_or(part, String::as_str))
            .collect()
    };
    texts.iter().map(renamed).collect()
}

/// What names are found, and what is known of them.
#[derive(Default)]
struct Names<'t> {
    uses: BTreeMap<&'t str, usize>,
    declared: BTreeSet<&'t str>,
    callable: BTreeSet<&'t str>,
    called: BTreeSet<&'t str>,
    reserved: BTreeSet<&'t str>,
}

impl<'t> Names<'t> {
    fn read(&mut self, text: &'t str, language: Language) {
        let all: Vec<&str> = parts(text)
            .into_iter()
            .filter(|part| *part != " ")
            .collect();
        let at = |k: usize| all.get(k).copied().unwrap_or("");
        let mut attribute = 0;
        for k in 0..all.len() {
            let (before, part, next) = (at(k.wrapping_sub(1)), all[k], at(k + 1));
            // Whatever is in brackets behind an attribute, or behind `var<`.
            let opens =
                (part == "(" && at(k.wrapping_sub(2)) == "@") || (part == "<" && before == "var");
            let closes = attribute > 0 && (part == ")" || part == ">");
            attribute += usize::from(opens);
            attribute -= usize::from(closes);
            if !is_name(part) {
                continue;
            }
            *self.uses.entry(part).or_default() += 1;
            if attribute > 0 || before == "@" {
                self.reserved.insert(part);
            }
            if next == "(" {
                self.called.insert(part);
            }
            let declares = match language {
                // `var<…> name` ends with the bracket.
                Language::Wgsl => {
                    DECLARING.contains(&before)
                        || next == ":"
                        || (before == ">" && after_var(&all[..k]))
                }
                Language::Glsl => {
                    (is_name(before) && !NO_TYPES.contains(&before)) || before == "struct"
                }
            };
            if declares {
                self.declared.insert(part);
            }
            let is_callable = match language {
                Language::Wgsl => ["fn", "struct", "alias"].contains(&before),
                Language::Glsl => declares && (next == "(" || before == "struct"),
            };
            if is_callable {
                self.callable.insert(part);
            }
        }
    }

    /// Short names, the shortest for those that are used most.
    fn short(&self, keeps: &impl Fn(&str) -> bool) -> BTreeMap<&'t str, String> {
        let is_swizzle =
            |name: &str| name.len() <= 4 && name.chars().all(|c| "xyzwrgba".contains(c));
        let mut renamed: Vec<&str> = self
            .declared
            .iter()
            .copied()
            .filter(|name| name.len() > 2 && !is_swizzle(name) && *name != "default")
            .filter(|name| !self.reserved.contains(name) && !keeps(name))
            .filter(|name| self.callable.contains(name) || !self.called.contains(name))
            .collect();
        renamed.sort_by_key(|name| (usize::MAX - self.uses[name], *name));
        let letters = || ('a'..='z').chain('A'..='Z');
        let ones = letters().map(String::from);
        // No word of either language ends with a capital or a digit.
        let ends = || ('A'..='Z').chain('0'..='9');
        let twos = letters().flat_map(|first| ends().map(move |end| format!("{first}{end}")));
        let free = ones
            .chain(twos)
            .filter(|name| !self.uses.contains_key(name.as_str()));
        renamed.into_iter().zip(free).collect()
    }
}

/// Whether a bracket that ends these parts is that of `var<…>`.
fn after_var(before: &[&str]) -> bool {
    let open = before.iter().rposition(|part| *part == "<");
    open.is_some_and(|open| open > 0 && before[open - 1] == "var")
}

fn is_name(part: &str) -> bool {
    part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

/// Names and numbers, and all other signs one by one.
fn parts(text: &str) -> Vec<&str> {
    let mut all = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let length = match first {
            c if is_word(c) => rest.find(|c| !is_word(c)).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        all.push(&rest[..length]);
        rest = &rest[length..];
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declared_names_are_short_and_others_stay() {
        let text = "struct Thing{@location(0) size:f32}@group(0) var<storage,read> things:array<Thing>;\
                    fn size_of(thing:Thing,distance:f32)-> f32{let length=distance(thing.size,0x1fu);return length;}";
        let short = shortened(&[text.to_owned()], Language::Wgsl, |name| name == "size_of");
        assert_eq!(
            short[0],
            "struct a{@location(0) c:f32}@group(0) var<storage,read> e:array<a>;\
             fn size_of(d:a,distance:f32)-> f32{let b=distance(d.c,0x1fu);return b;}"
        );
        let text = "struct Jet{vec3 position;};void main(){Jet jet=Jet(vec3(1.0));float size=length(jet.position);}";
        let short = shortened(&[text.to_owned()], Language::Glsl, |name| name == "main");
        assert_eq!(
            short[0],
            "struct a{vec3 c;};void main(){a b=a(vec3(1.0));float d=length(b.c);}"
        );
    }
}
