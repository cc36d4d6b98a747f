//! One script of the host's modules, so that a page is one file.
//!
//! A module becomes a function that returns what it exports, and an import takes names out of that. Why not a
//! bundler: `cargo install` has none, and these modules need no more than forty lines.

use crate::minified;

/// A module of a folder.
macro_rules! module {
    ($name:literal) => {
        module!("host", $name)
    };
    ($folder:literal, $name:literal) => {
        (
            $name,
            include_str!(concat!("../", $folder, "/", $name, ".js")),
        )
    };
}

/// The modules, each after those that it imports from.
const MODULES: [(&str, &str); 23] = [
    module!("vectors"),
    module!("bytes"),
    module!("scene"),
    module!("camera"),
    module!("colors"),
    module!("shaders"),
    module!("selection"),
    module!("finishing"),
    module!("ranges"),
    module!("markers"),
    module!("webgpu"),
    module!("shadows"),
    module!("webgl"),
    module!("saving"),
    module!("files"),
    module!("link"),
    module!("measuring"),
    module!("legend"),
    module!("picture"),
    module!("loop"),
    module!("panel"),
    module!("pointer"),
    module!("app"),
];

/// Those of the page that takes tracings.
const DROPPING: [(&str, &str); 5] = [
    module!("files"),
    module!("drop", "core"),
    module!("drop", "processor"),
    module!("drop", "frame"),
    module!("drop", "page"),
];

/// The script of all modules of the host.
pub(crate) fn host_script() -> String {
    script(&MODULES)
}

/// The script of the page that takes tracings.
pub(crate) fn dropping_script() -> String {
    script(&DROPPING)
}

/// A module for anywidget, which joins the page in a frame of a notebook with the kernel.
pub fn widget_script() -> String {
    minified::javascript(include_str!("../host/widget.js"))
}

fn script(modules: &[(&str, &str)]) -> String {
    let modules = modules.iter();
    modules.map(|(name, text)| module(name, text)).collect()
}

/// A module as a function.
fn module(name: &str, text: &str) -> String {
    let mut exports = Vec::new();
    let mut body = String::new();
    let text = minified::javascript(text);
    for line in text.lines() {
        if let Some(import) = line.strip_prefix("import") {
            body.push_str(&imported(import));
        } else if let Some(export) = line.strip_prefix("export ") {
            exports.push(exported(export));
            body.push_str(export);
        } else {
            body.push_str(line);
        }
        body.push('\n');
    }
    let exports = exports.join(",");
    format!("const module_{name}=(()=>{{\n{body}return{{{exports}}};\n}})();\n")
}

/// `{a,b} from'./x.js';` as a statement.
fn imported(import: &str) -> String {
    let parts = import.strip_suffix(".js';");
    let (names, from) = parts
        .and_then(|parts| parts.split_once("from '"))
        .expect("an import of the host is one line, of names in one of its modules");
    let (_, from) = from.rsplit_once('/').unwrap_or(("", from));
    format!("const{names}=module_{from};")
}

/// The name that a declaration gives.
fn exported(declaration: &str) -> &str {
    let mut words = declaration.split(|c: char| !c.is_alphanumeric() && c != '_');
    let name = words.find(|word| !["", "async", "function", "class", "const"].contains(word));
    name.expect("an export of the host is a declaration")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_functions() {
        let text = "// x\nimport { a, b } from './other.js';\nexport async function f() {\n  a();\n}\nexport const g = b;\n";
        assert_eq!(
            module("one", text),
            "const module_one=(()=>{\nconst{a,b}=module_other;\nasync function f(){\na();\n}\n\
             const g=b;\nreturn{f,g};\n})();\n"
        );
    }

    #[test]
    fn modules_come_after_those_that_they_import() {
        for modules in [&MODULES[..], &DROPPING] {
            for (place, (name, text)) in modules.iter().enumerate() {
                for line in text.lines().filter(|line| line.starts_with("import ")) {
                    let from = modules
                        .iter()
                        .position(|(other, _)| line.contains(&format!("/{other}.js'")));
                    assert!(from.is_some_and(|from| from < place), "{name}: {line}");
                }
            }
        }
    }
}
