//! Shaders from files that import one another.
//!
//! **Theory.** WGSL has no modules and no preprocessor. Here a file may begin with `#import
//! other.wgsl`, which adds that file once, before it; and lines between `#ifdef NAME`, `#else` and
//! `#endif` are kept or left out by the flags in [`Constants`]. Numbers that Rust knows are defined
//! there too, so that none is written twice.
//!
//! **Practice.** [`compose`] makes one text of all files that a shader needs, with blank lines in
//! place of directives, and keeps the file and line that each line comes from: in a compiler's
//! message, [`Shader::explain`] replaces `wgsl:1234:5` by them.
//!
//! Why not naga_oil? It mangles names and parses each module by itself: a file that calls functions
//! which another one defines, as the shading calls those of a vertex source, would need stand-ins
//! for them.

use std::collections::BTreeSet;
use std::fmt::{self, Write};

/// A file of WGSL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WgslFile {
    /// The name that it is imported by, such as `evaluate.wgsl`.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// Names that Rust defines for shaders: constants, and flags for `#ifdef`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Constants {
    text: String,
    flags: BTreeSet<&'static str>,
}

impl Constants {
    /// `const name: u32 = value;`
    pub fn u32(&mut self, name: &str, value: u32) {
        self.line(format_args!("const {name}: u32 = {value}u;"));
    }

    /// `const name: i32 = value;`
    pub fn i32(&mut self, name: &str, value: i32) {
        self.line(format_args!("const {name}: i32 = {value};"));
    }

    /// `const name: f32 = value;`
    pub fn f32(&mut self, name: &str, value: f32) {
        self.line(format_args!("const {name}: f32 = {value:?};"));
    }

    /// `const name: bool = value;`
    pub fn bool(&mut self, name: &str, value: bool) {
        self.line(format_args!("const {name}: bool = {value};"));
    }

    /// `const name = array<u32, n>(…);`
    pub fn u32s(&mut self, name: &str, values: &[u32]) {
        let list: Vec<String> = values.iter().map(|value| format!("{value}u")).collect();
        let (count, list) = (values.len(), list.join(", "));
        self.line(format_args!("const {name} = array<u32, {count}>({list});"));
    }

    /// Keeps the lines between `#ifdef name` and `#endif`.
    pub fn flag(&mut self, name: &'static str) {
        self.flags.insert(name);
    }

    /// The names and values of all that are single numbers: for hosts that are not in Rust.
    pub fn numbers(&self) -> Vec<(String, f64)> {
        let number = |line: &str| {
            let (name, value) = line.strip_prefix("const ")?.split_once(" = ")?;
            let value = value.trim_end_matches(';').trim_end_matches('u');
            Some((name.split(':').next()?.to_owned(), value.parse().ok()?))
        };
        self.text.lines().filter_map(number).collect()
    }

    /// Adds the constants and flags of another.
    pub fn extend(&mut self, other: &Self) {
        self.text.push_str(&other.text);
        self.flags.extend(&other.flags);
    }

    /// Whether all constants and flags of another are among these.
    pub fn contains(&self, other: &Self) -> bool {
        let mut lines = other.text.lines();
        lines.all(|line| self.text.lines().any(|ours| ours == line))
            && other.flags.is_subset(&self.flags)
    }

    fn line(&mut self, line: fmt::Arguments<'_>) {
        // Writing to a String does not fail.
        let _ = writeln!(self.text, "{line}");
    }
}

/// What a shader is composed of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShaderParts {
    /// Files in their order, without those that they import.
    pub files: Vec<WgslFile>,
    /// Constants and flags that Rust defines.
    pub constants: Constants,
}

impl ShaderParts {
    /// These files, without constants.
    pub fn new(files: &[WgslFile]) -> Self {
        Self {
            files: files.to_vec(),
            constants: Constants::default(),
        }
    }
}

/// A composed shader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shader {
    /// Its name in errors.
    pub name: &'static str,
    /// The composed WGSL.
    pub text: String,
    /// Files, each with its first line in the text, from 0 on.
    starts: Vec<(&'static str, usize)>,
}

/// Name of the constants in errors, in place of a file's.
const CONSTANTS: &str = "constants";

/// Composes a shader of parts and all that they import, each file once. Imports are looked up in
/// `libraries` and among the parts themselves.
///
/// # Panics
/// If an imported file does not exist, or an `#ifdef` is not closed: bugs in our shaders.
pub fn compose(name: &'static str, parts: &ShaderParts, libraries: &[&[WgslFile]]) -> Shader {
    let mut shader = Shader {
        name,
        text: parts.constants.text.clone(),
        starts: vec![(CONSTANTS, 0)],
    };
    let known = |name: &str| {
        let all = libraries.iter().copied().flatten().chain(&parts.files);
        all.copied().find(|file| file.name == name)
    };
    let mut done = BTreeSet::new();
    for &file in &parts.files {
        add(&mut shader, file, &known, &parts.constants.flags, &mut done);
    }
    shader
}

/// Adds a file after those that it imports.
fn add(
    shader: &mut Shader,
    file: WgslFile,
    known: &dyn Fn(&str) -> Option<WgslFile>,
    flags: &BTreeSet<&'static str>,
    done: &mut BTreeSet<&'static str>,
) {
    if !done.insert(file.name) {
        return;
    }
    for line in file.text.lines() {
        if let Some(import) = line.strip_prefix("#import ") {
            let name = import.trim();
            let imported = known(name);
            let imported = imported.unwrap_or_else(|| panic!("{}: no {name}", file.name));
            add(shader, imported, known, flags, done);
        }
    }
    shader.starts.push((file.name, shader.text.lines().count()));
    // For each #ifdef that is open: whether its lines are kept.
    let mut kept: Vec<bool> = Vec::new();
    for line in file.text.lines() {
        let directive = match line.split_once(' ') {
            Some(("#ifdef", flag)) => {
                kept.push(flags.contains(flag.trim()));
                true
            }
            Some(("#import", _)) => true,
            _ if line == "#else" => {
                let last = kept.last_mut();
                let last = last.unwrap_or_else(|| panic!("{}: #else of nothing", file.name));
                *last = !*last;
                true
            }
            _ if line == "#endif" => {
                assert!(kept.pop().is_some(), "{}: #endif of nothing", file.name);
                true
            }
            _ => false,
        };
        if !directive && !kept.contains(&false) {
            shader.text.push_str(line);
        }
        shader.text.push('\n');
    }
    assert!(kept.is_empty(), "{}: #ifdef without #endif", file.name);
}

impl Shader {
    /// The text in pieces, in their order: one for each file, the constants first.
    pub fn pieces(&self) -> Vec<String> {
        let ends = self.starts.iter().skip(1).map(|&(_, start)| start);
        let lines: Vec<&str> = self.text.lines().collect();
        let all = self.starts.iter().zip(ends.chain([lines.len()]));
        all.map(|(&(_, start), end)| lines[start..end].join("\n") + "\n")
            .collect()
    }

    /// File and line (from 1 on) that a line of the text (from 1 on) comes from.
    pub fn origin(&self, line: usize) -> (&'static str, usize) {
        let at = line.saturating_sub(1);
        let next = self.starts.partition_point(|&(_, start)| start <= at);
        let (file, start) = self.starts[next.max(1) - 1];
        (file, at - start + 1)
    }

    /// A compiler's message with `FILE:LINE:COLUMN` in place of `wgsl:LINE:COLUMN`.
    pub fn explain(&self, message: &str) -> String {
        let mut parts = message.split("wgsl:");
        let mut explained = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let digits = part
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(part.len());
            // `other.wgsl:3` names its file already.
            let named = explained.ends_with(|c: char| c.is_alphanumeric() || c == '.');
            match part[..digits].parse() {
                Ok(line) if !named => {
                    let (file, line) = self.origin(line);
                    let _ = write!(explained, "{file}:{line}{}", &part[digits..]);
                }
                _ => {
                    let _ = write!(explained, "wgsl:{part}");
                }
            }
        }
        explained
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: WgslFile = WgslFile {
        name: "a.wgsl",
        text: "#import b.wgsl\nfn a() {}\n#ifdef MANY\nfn many() {}\n#else\nfn one() {}\n#endif\nfn z() {}\n",
    };
    const B: WgslFile = WgslFile {
        name: "b.wgsl",
        text: "// b\nfn b() {}\n",
    };

    #[test]
    fn imports_come_once_and_before_and_flags_choose() {
        let mut parts = ShaderParts::new(&[A, B]);
        parts.constants.u32("N", 3);
        let one = compose("one", &parts, &[&[B]]);
        assert_eq!(
            one.text,
            "const N: u32 = 3u;\n// b\nfn b() {}\n\nfn a() {}\n\n\n\nfn one() {}\n\nfn z() {}\n"
        );
        assert_eq!(parts.constants.numbers(), [("N".to_owned(), 3.0)]);
        parts.constants.flag("MANY");
        let many = compose("many", &parts, &[&[B]]);
        assert!(many.text.contains("fn many") && !many.text.contains("fn one"));
    }

    #[test]
    fn lines_are_told_by_their_file() {
        let mut parts = ShaderParts::new(&[A]);
        parts.constants.u32("N", 3);
        let shader = compose("one", &parts, &[&[B]]);
        let line = |part: &str| 1 + shader.text.lines().position(|l| l == part).expect("there");
        assert_eq!(shader.origin(line("fn b() {}")), ("b.wgsl", 2));
        assert_eq!(shader.origin(line("fn z() {}")), ("a.wgsl", 8));
        assert_eq!(shader.origin(1), ("constants", 1));
        let said = format!("oh: wgsl:{}:4 and wgsl:x", line("fn z() {}"));
        let explained = shader.explain(&said);
        assert_eq!(shader.pieces().concat(), shader.text);
        assert_eq!(explained, "oh: a.wgsl:8:4 and wgsl:x");
        assert_eq!(shader.explain(&explained), explained, "once is enough");
    }

    #[test]
    #[should_panic(expected = "a.wgsl: no b.wgsl")]
    fn an_import_that_is_nowhere_is_a_bug() {
        compose("a", &ShaderParts::new(&[A]), &[]);
    }
}
