//! How the files of a crate import one another: read from their text, for `architecture.rs`.
//!
//! A file's imports are its `use` trees and the paths that begin with `crate`, `super` or `self`. A name
//! that a module re-exports counts as an import of the file that defines it. Tests are left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::Context;

/// The path of a module from the crate's root: empty for `lib.rs` and `main.rs`.
pub(crate) type Module = Vec<String>;

/// The modules of a crate that are files, and what each imports.
pub(crate) type Imports = BTreeMap<Module, BTreeSet<Module>>;

/// Reads all files below a crate's `src`.
pub(crate) fn read(src: &Path) -> anyhow::Result<Imports> {
    let mut files = BTreeMap::new();
    find(src, &mut Vec::new(), &mut files)?;
    Ok(resolve(&files))
}

/// What one file says of modules.
#[derive(Default)]
struct File {
    /// Absolute paths that it imports or names.
    paths: Vec<Module>,
    /// By the name that it re-exports: the absolute path.
    exports: BTreeMap<String, Module>,
    /// Child modules that only tests have.
    tests: BTreeSet<String>,
}

fn find(
    folder: &Path,
    module: &mut Module,
    files: &mut BTreeMap<Module, File>,
) -> anyhow::Result<()> {
    let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    for entry in entries {
        let path = entry?.path();
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            module.push(
                path.file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into(),
            );
            find(&path, module, files)?;
            module.pop();
        } else if path.extension().is_some_and(|e| e == "rs") {
            let mut name = module.clone();
            if !["mod", "lib", "main"].contains(&&*stem) {
                name.push(stem.into());
            }
            let text = fs::read_to_string(&path)?;
            files.insert(name.clone(), scan(&text, &name));
        }
    }
    Ok(())
}

/// Every path becomes the file that it leads to.
fn resolve(files: &BTreeMap<Module, File>) -> Imports {
    let is_test = |module: &Module| {
        (1..=module.len()).any(|n| {
            let parent = files.get(&module[..n - 1]);
            parent.is_some_and(|file| file.tests.contains(&module[n - 1]))
        })
    };
    let of_file = |(module, file): (&Module, &File)| {
        let targets = file.paths.iter().filter_map(|path| target(files, path));
        let others = targets.filter(|other| other != module);
        (module.clone(), others.collect())
    };
    let tested = files.iter().filter(|(module, _)| !is_test(module));
    tested.map(of_file).collect()
}

/// The file of the longest module that a path begins with, or that it is re-exported from.
fn target(files: &BTreeMap<Module, File>, path: &[String]) -> Option<Module> {
    let mut path = path.to_vec();
    // A re-export of a re-export, and so on.
    for _ in 0..8 {
        let longest = (0..=path.len())
            .rev()
            .find(|&n| files.contains_key(&path[..n]))?;
        let exported = path
            .get(longest)
            .and_then(|name| files[&path[..longest]].exports.get(name));
        match exported {
            Some(origin) if *origin != path => path.clone_from(origin),
            _ => return Some(path[..longest].to_vec()),
        }
    }
    None
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Name(String),
    Sign(char),
    PathSeparator,
}

/// Names, signs and `::`; comments and literals are dropped.
fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let bytes: Vec<char> = text.chars().collect();
    let mut i = 0;
    while i < bytes.len() {
        let (c, next) = (bytes[i], bytes.get(i + 1).copied());
        i = match c {
            '/' if next == Some('/') => position(&bytes, i, |c| c == '\n'),
            '/' if next == Some('*') => after_comment(&bytes, i),
            '"' => after_string(&bytes, i),
            'r' if next == Some('#') && bytes.get(i + 2) == Some(&'"') => {
                after_raw_string(&bytes, i + 2)
            }
            '\'' if bytes.get(i + 2) == Some(&'\'') => i + 3,
            '\'' if next == Some('\\') => position(&bytes, i + 3, |c| c == '\'') + 1,
            ':' if next == Some(':') => {
                tokens.push(Token::PathSeparator);
                i + 2
            }
            c if c.is_alphanumeric() || c == '_' => {
                let end = position(&bytes, i, |c| !(c.is_alphanumeric() || c == '_'));
                tokens.push(Token::Name(bytes[i..end].iter().collect()));
                end
            }
            c => {
                if !c.is_whitespace() {
                    tokens.push(Token::Sign(c));
                }
                i + 1
            }
        };
    }
    tokens
}

fn position(text: &[char], from: usize, test: impl Fn(char) -> bool) -> usize {
    let rest = text.iter().skip(from);
    from + rest.take_while(|&&c| !test(c)).count()
}

fn after_comment(text: &[char], start: usize) -> usize {
    let (mut depth, mut i) = (0, start);
    while i < text.len() {
        match (text[i], text.get(i + 1)) {
            ('/', Some('*')) => (depth, i) = (depth + 1, i + 2),
            ('*', Some('/')) => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            break;
        }
    }
    i
}

fn after_string(text: &[char], start: usize) -> usize {
    let mut i = start + 1;
    while i < text.len() && text[i] != '"' {
        i += if text[i] == '\\' { 2 } else { 1 };
    }
    i + 1
}

/// `quote`: place of the opening quotation mark of `r#"…"#`.
fn after_raw_string(text: &[char], quote: usize) -> usize {
    let mut i = quote + 1;
    while i < text.len() && !(text[i] == '"' && text.get(i + 1) == Some(&'#')) {
        i += 1;
    }
    i + 2
}

/// Reads a file's tokens as module `name`.
fn scan(text: &str, name: &[String]) -> File {
    let tokens = tokens(text);
    let mut file = File::default();
    let mut i = 0;
    while i < tokens.len() {
        if is_test(&tokens[i..]) {
            i = after_test_item(&tokens, i + 7, &mut file);
        } else if is_name(tokens.get(i), "use") {
            let public = is_public(&tokens[..i]);
            let mut prefix = Vec::new();
            i = use_tree(&tokens, i + 1, &mut prefix, &mut |path, exported| {
                if let Some(path) = absolute(path, name) {
                    if public {
                        file.exports.insert(exported.to_owned(), path.clone());
                    }
                    file.paths.push(path);
                }
            });
        } else if let Some((path, end)) = plain_path(&tokens, i) {
            file.paths.extend(absolute(&path, name));
            i = end;
        } else {
            i += 1;
        }
    }
    file
}

fn is_name(token: Option<&Token>, name: &str) -> bool {
    matches!(token, Some(Token::Name(n)) if n == name)
}

fn is_sign(token: Option<&Token>, sign: char) -> bool {
    token == Some(&Token::Sign(sign))
}

/// `#[cfg(test)]`
fn is_test(tokens: &[Token]) -> bool {
    is_sign(tokens.first(), '#')
        && is_sign(tokens.get(1), '[')
        && is_name(tokens.get(2), "cfg")
        && is_sign(tokens.get(3), '(')
        && is_name(tokens.get(4), "test")
        && is_sign(tokens.get(5), ')')
        && is_sign(tokens.get(6), ']')
}

/// Past the item that only tests have; remembers it if it is a module in a file of its own.
fn after_test_item(tokens: &[Token], start: usize, file: &mut File) -> usize {
    let mut i = start;
    while i < tokens.len() && !is_sign(tokens.get(i), '{') {
        if is_name(tokens.get(i), "mod")
            && let Some(Token::Name(name)) = tokens.get(i + 1)
            && is_sign(tokens.get(i + 2), ';')
        {
            file.tests.insert(name.clone());
        }
        if is_sign(tokens.get(i), ';') {
            return i + 1;
        }
        i += 1;
    }
    let mut depth = 0;
    while i < tokens.len() {
        depth += i32::from(is_sign(tokens.get(i), '{')) - i32::from(is_sign(tokens.get(i), '}'));
        i += 1;
        if depth == 0 {
            break;
        }
    }
    i
}

/// Whether what comes next is `pub` or `pub(…)`.
fn is_public(before: &[Token]) -> bool {
    let open = before.iter().rposition(|token| *token == Token::Sign('('));
    let end = match open {
        Some(open) if is_sign(before.last(), ')') => open,
        _ => before.len(),
    };
    is_name(before[..end].last(), "pub")
}

/// Reads a tree such as `a::{b, c as d}` and hands over each path with the name that it gets.
fn use_tree(
    tokens: &[Token],
    start: usize,
    prefix: &mut Module,
    found: &mut dyn FnMut(&[String], &str),
) -> usize {
    let depth = prefix.len();
    let mut i = start;
    let end = |prefix: &mut Module, i| {
        prefix.truncate(depth);
        i
    };
    loop {
        match tokens.get(i) {
            Some(Token::Name(name)) => {
                prefix.push(name.clone());
                i += 1;
                if tokens.get(i) == Some(&Token::PathSeparator) {
                    i += 1;
                    continue;
                }
                let mut given = name.clone();
                if is_name(tokens.get(i), "as") {
                    if let Some(Token::Name(other)) = tokens.get(i + 1) {
                        given.clone_from(other);
                    }
                    i += 2;
                }
                if given == "self" {
                    prefix.pop();
                }
                found(prefix, &given);
                return end(prefix, i);
            }
            Some(Token::Sign('{')) => {
                i += 1;
                while i < tokens.len() && !is_sign(tokens.get(i), '}') {
                    i = use_tree(tokens, i, prefix, found);
                    i += usize::from(is_sign(tokens.get(i), ','));
                }
                return end(prefix, i + 1);
            }
            Some(Token::Sign('*')) => {
                found(prefix, "*");
                return end(prefix, i + 1);
            }
            _ => return end(prefix, i + 1),
        }
    }
}

/// A path in code that begins with `crate`, `super` or `self`, and where it ends.
fn plain_path(tokens: &[Token], start: usize) -> Option<(Module, usize)> {
    let roots = ["crate", "super", "self"];
    if !roots.iter().any(|root| is_name(tokens.get(start), root))
        || tokens.get(start + 1) != Some(&Token::PathSeparator)
    {
        return None;
    }
    let mut path = Vec::new();
    let mut i = start;
    while let Some(Token::Name(name)) = tokens.get(i) {
        path.push(name.clone());
        i += 1;
        if tokens.get(i) != Some(&Token::PathSeparator) {
            break;
        }
        i += 1;
    }
    Some((path, i))
}

/// The path from the crate's root, seen from module `name`; none if it leads out of the crate. A path
/// without `crate`, `super` or `self` may be that of a child.
fn absolute(path: &[String], name: &[String]) -> Option<Module> {
    let (first, rest) = path.split_first()?;
    let mut base = match first.as_str() {
        "crate" => Vec::new(),
        "self" => name.to_vec(),
        "super" => {
            let mut parent = name.to_vec();
            parent.pop()?;
            parent
        }
        _ => return Some(name.iter().chain(path).cloned().collect()),
    };
    for part in rest {
        if part == "super" {
            base.pop()?;
        } else {
            base.push(part.clone());
        }
    }
    Some(base)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module(path: &str) -> Module {
        path.split("::")
            .filter(|p| !p.is_empty())
            .map(str::to_owned)
            .collect()
    }

    fn imports(files: &[(&str, &str)]) -> Imports {
        let scanned = files
            .iter()
            .map(|(name, text)| (module(name), scan(text, &module(name))));
        resolve(&scanned.collect())
    }

    #[test]
    fn trees_paths_and_re_exports_lead_to_files() {
        let found = imports(&[
            (
                "",
                "mod a; mod b; pub use a::inner::Thing; // use crate::b;",
            ),
            ("a", "pub(crate) mod inner; let s = \"crate::b::x\";"),
            (
                "a::inner",
                "use super::super::b::{self, other as x, deep::{One, Two}};",
            ),
            ("b", "fn f() { crate::Thing::new(); let c = '\"'; }"),
        ]);
        let of = |name: &str| -> Vec<String> {
            found[&module(name)].iter().map(|m| m.join("::")).collect()
        };
        assert_eq!(of("a::inner"), ["b"]);
        assert_eq!(of("b"), ["a::inner"]);
        assert_eq!(of("a"), Vec::<String>::new());
    }

    #[test]
    fn tests_are_left_out() {
        let found = imports(&[
            ("", "mod a; #[cfg(test)] mod only_tests;"),
            (
                "a",
                "#[cfg(test)]\nmod tests { use crate::b::X; fn f() {} } use crate::c::Y;",
            ),
            ("b", ""),
            ("c", ""),
            ("only_tests", "use crate::a;"),
        ]);
        assert_eq!(found[&module("a")], BTreeSet::from([module("c")]));
        assert!(!found.contains_key(&module("only_tests")));
    }
}
