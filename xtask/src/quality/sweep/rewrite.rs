//! Numbers in sources become calls of `knob`, which changes one of them while the program runs.
//!
//! Constants that are numbers become functions of their names; those of several numbers are changed as one, but for tables
//! of indices. Of code each number becomes a call: ½ and whole ones up to 8 are no choices.

use std::collections::{BTreeSet, HashMap};

use super::scan::{Line, constant, is_definition, is_plain, is_scalar, lines, number};

/// A number that can be changed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Knob {
    /// `generate/plan/zone::MAX_RATIO`, of code `generate/plan/zone:103 0.3`.
    pub(super) name: String,
    /// As it is written.
    pub(super) value: String,
}

/// What stays as it is: constants and lines of code that did not compile.
pub(super) type Excluded = BTreeSet<String>;

/// Sources of a crate while they are rewritten.
pub(super) struct Sources {
    /// Module, such as `generate/plan/zone`, and text.
    pub(super) files: Vec<(String, String)>,
}

/// Constants of a file that become functions.
fn functions(module: &str, text: &str, excluded: &Excluded) -> BTreeSet<String> {
    let constants = lines(text).filter_map(|line| match line {
        Line::Code(code, _) if !code.contains("::MAX") => constant(code),
        _ => None,
    });
    constants
        .map(|(name, _)| name.to_owned())
        .filter(|name| !excluded.contains(&format!("{module}::{name}")))
        .collect()
}

/// What was rewritten.
pub(super) struct Rewritten {
    /// In the order of the files.
    pub(super) texts: Vec<String>,
    pub(super) knobs: Vec<Knob>,
    /// For each file, what to exclude if a line does not compile.
    pub(super) at: Vec<HashMap<usize, Vec<String>>>,
}

/// Rewrites a crate's files; numbers go on from `first`.
pub(super) fn rewrite(sources: &Sources, excluded: &Excluded, first: usize) -> Rewritten {
    let own: Vec<BTreeSet<String>> = (sources.files.iter())
        .map(|(module, text)| functions(module, text, excluded))
        .collect();
    // Where a name that a file mentions is defined: there, or in another file.
    let mut homes: HashMap<&str, &str> = HashMap::new();
    for (names, (module, text)) in own.iter().zip(&sources.files) {
        for name in names
            .iter()
            .filter(|name| text.contains(&format!(") const {name}:")))
        {
            homes.insert(name, module);
        }
    }
    let mut rewritten = Rewritten {
        texts: Vec::new(),
        knobs: Vec::new(),
        at: Vec::new(),
    };
    for (names, (module, text)) in own.iter().zip(&sources.files) {
        let mut file = File {
            module,
            text,
            names,
            homes: &homes,
            excluded,
            first,
            knobs: &mut rewritten.knobs,
            at: HashMap::new(),
        };
        let text = file.rewritten();
        rewritten.at.push(file.at);
        rewritten.texts.push(text);
    }
    rewritten
}

struct File<'a> {
    module: &'a str,
    text: &'a str,
    names: &'a BTreeSet<String>,
    homes: &'a HashMap<&'a str, &'a str>,
    excluded: &'a Excluded,
    first: usize,
    knobs: &'a mut Vec<Knob>,
    at: HashMap<usize, Vec<String>>,
}

impl File<'_> {
    fn rewritten(&mut self) -> String {
        let mut rewritten = String::new();
        // The constant whose value is being read, with its type; none of one that stays as it is.
        let mut within: Option<Option<(String, String)>> = None;
        for (at, line) in lines(self.text).enumerate() {
            match line {
                Line::Other(line) => rewritten += line,
                Line::Code(code, comment) => {
                    let begins = within.is_none() && is_definition(code);
                    if begins {
                        let named = constant(code).filter(|(name, _)| self.names.contains(*name));
                        within = Some(named.map(|(name, kind)| (name.into(), kind.into())));
                    }
                    rewritten += &match within.clone() {
                        Some(None) => code.to_owned(),
                        Some(Some((name, kind))) => {
                            self.of_constant(at, code, &name, &kind, begins)
                        }
                        None => self.of_code(at, code, None),
                    };
                    if within.is_some() && code.trim_end().ends_with(';') {
                        within = None;
                    }
                    rewritten += comment;
                }
            }
            rewritten.push('\n');
        }
        rewritten
    }

    fn of_constant(
        &mut self,
        at: usize,
        code: &str,
        name: &str,
        kind: &str,
        begins: bool,
    ) -> String {
        let ends = code.trim_end().ends_with(';');
        let full = format!("{}::{name}", self.module);
        self.at.entry(at).or_default().push(full.clone());
        let (head, value) = match begins {
            true => code.split_once(" =").unwrap_or((code, "")),
            false => ("", code),
        };
        let mut text = String::new();
        if begins {
            let (before, rest) = head.split_once("const ").unwrap_or(("", head));
            let kind = rest.split_once(": ").map_or(kind, |(_, kind)| kind);
            let indent = before.len() - before.trim_start().len();
            text += &before[..indent];
            text += "#[allow(non_snake_case)] ";
            text += before.trim_start();
            text += &format!("fn {name}() -> {kind} {{ ");
        }
        let value = match ends {
            true => value.trim_end().trim_end_matches(';'),
            false => value,
        };
        if is_scalar(kind) {
            if begins {
                text += &format!("crate::knob::knob({}, ", self.next(full, value.trim()));
            }
            text += &self.of_code(at, value, Some(None));
        } else {
            text += &self.of_code(at, value, Some(Some(&full)));
        }
        if ends {
            text += match is_scalar(kind) {
                true => ") }",
                false => " }",
            };
        }
        text
    }

    fn next(&mut self, name: String, value: &str) -> usize {
        if self.knobs.last().is_some_and(|last| last.name == name) {
            return self.first + self.knobs.len() - 1;
        }
        self.knobs.push(Knob {
            name,
            value: value.to_owned(),
        });
        self.first + self.knobs.len() - 1
    }

    /// Code with calls for names and numbers. `of`: of a constant, which has one number or several.
    fn of_code(&mut self, at: usize, code: &str, of: Option<Option<&str>>) -> String {
        let line = format!("{}:{}", self.module, at + 1);
        let mut text = String::new();
        let mut rest = code;
        let mut in_string = false;
        while let Some(c) = rest.chars().next() {
            let word = rest.len()
                - rest
                    .trim_start_matches(|c: char| c.is_alphanumeric() || c == '_')
                    .len();
            if in_string || word == 0 {
                in_string ^= c == '"' && !text.ends_with('\\') && !text.ends_with('\'');
                text.push(c);
                rest = &rest[c.len_utf8()..];
                continue;
            }
            if c.is_ascii_digit() && !text.ends_with('.') {
                let length = number(rest);
                let (digits, after) = rest.split_at(length);
                let is_float = digits.contains(['.', 'e', 'f']) && !digits.starts_with("0x");
                let called = match of {
                    Some(None) => None,
                    Some(Some(name)) => Some(name.to_owned()),
                    None if !is_float || is_plain(digits) || self.excluded.contains(&line) => None,
                    None => Some(format!("{line} {digits}")),
                };
                match called {
                    Some(name) => {
                        if of.is_none() {
                            self.at.entry(at).or_default().push(line.clone());
                        }
                        let digits_of = self.next(name, digits);
                        text += &format!("crate::knob::knob({digits_of}, {digits})");
                    }
                    None => text += digits,
                }
                rest = after;
                continue;
            }
            let (name, after) = rest.split_at(word);
            text += name;
            rest = after;
            if let Some(home) = self.home(name, &text) {
                self.at
                    .entry(at)
                    .or_default()
                    .push(format!("{home}::{name}"));
                text += "()";
            }
        }
        text
    }

    /// Where a name's constant is, if it became a function. `before` ends with the name.
    fn home(&self, name: &str, before: &str) -> Option<String> {
        let before = before.strip_suffix(name)?;
        if let Some(path) = before.strip_suffix("::") {
            let start = path
                .rfind(|c: char| !c.is_alphanumeric() && c != '_')
                .map_or(0, |at| at + 1);
            if path[start..].starts_with(char::is_uppercase) {
                return None; // of a type
            }
        } else if self.names.contains(name) {
            return Some(self.module.to_owned());
        } else if self.text.contains(&format!("const {name}:")) {
            return None; // its own, which stays
        }
        if before.ends_with('\'') || before.ends_with('.') && !before.ends_with("..") {
            return None;
        }
        self.homes.get(name).map(|home| (*home).to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(text: &str) -> (String, Vec<String>) {
        let sources = Sources {
            files: vec![("a/b".into(), text.into())],
        };
        let rewritten = rewrite(&sources, &Excluded::new(), 7);
        let names = rewritten
            .knobs
            .into_iter()
            .map(|knob| format!("{} {}", knob.name, knob.value));
        (rewritten.texts.concat(), names.collect())
    }

    #[test]
    fn constants_become_functions_and_numbers_in_code_calls() {
        let (text, names) = one(
            "const A: f64 = 0.3;\npub(super) const B: [f64; 2] = [0.7, A];\nfn f(x: f64) -> f64 { A * x.max(1.5) + 2.0 * B[0] }\n",
        );
        assert_eq!(
            text,
            "#[allow(non_snake_case)] fn A() -> f64 { crate::knob::knob(7,  0.3) }\n\
             #[allow(non_snake_case)] pub(super) fn B() -> [f64; 2] {  [crate::knob::knob(8, 0.7), A()] }\n\
             fn f(x: f64) -> f64 { A() * x.max(crate::knob::knob(9, 1.5)) + 2.0 * B()[0] }\n"
        );
        assert_eq!(names, ["a/b::A 0.3", "a/b::B 0.7", "a/b:3 1.5 1.5"]);
    }

    #[test]
    fn imports_tests_and_constants_of_types_stay() {
        let text = "use a::A;\nconst A: u32 = u32::MAX;\nimpl S {\n    const B: Self = Self { x: 0.3 };\n}\nmod tests {\n    let x = 0.3;\n}\n";
        assert_eq!(one(text).0, text);
    }
}
