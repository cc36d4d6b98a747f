//! Variables of a configuration: `$NAME` or `${NAME}`, defined in its `manifest`, perhaps by one
//! another.
//!
//! `${configdir}` is the configuration's folder without being defined, as bmtk has it. Relative paths
//! are relative to that folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::json::Json;
use crate::{CircuitError, Fault};

/// Variables whose values hold no variables any more.
#[derive(Debug)]
pub(crate) struct Manifest {
    folder: PathBuf,
    values: BTreeMap<String, String>,
}

impl Manifest {
    /// Reads the `manifest` of a configuration that lies in `folder`.
    pub(crate) fn read(config: &Json, folder: &Path) -> Result<Self, CircuitError> {
        let mut raw: BTreeMap<String, (Json, &str)> = BTreeMap::new();
        if let Some(manifest) = config.get("manifest") {
            for (name, value) in manifest.entries()? {
                let bare = name.strip_prefix('$').unwrap_or(name);
                let bare = bare.strip_prefix('{').unwrap_or(bare);
                let bare = bare.strip_suffix('}').unwrap_or(bare);
                let text = value.text()?;
                raw.insert(bare.into(), (value, text));
            }
        }
        let mut manifest = Self {
            folder: folder.to_path_buf(),
            values: BTreeMap::new(),
        };
        let names: Vec<String> = raw.keys().cloned().collect();
        for name in names {
            manifest.resolve(&name, &raw, &mut Vec::new())?;
        }
        let configdir = folder.display().to_string();
        let values = &mut manifest.values;
        values.entry("configdir".into()).or_insert(configdir);
        Ok(manifest)
    }

    /// The text of a value, its variables replaced.
    pub(crate) fn expand(&self, json: &Json) -> Result<String, CircuitError> {
        replace(json, json.text()?, |name| self.values.get(name).cloned())
    }

    /// The path that a value names.
    pub(crate) fn path(&self, json: &Json) -> Result<PathBuf, CircuitError> {
        // Components, so that `./x/./y` is told as `x/y`.
        let path = self.folder.join(self.expand(json)?);
        Ok(path.components().collect())
    }

    /// Finds the value of one variable, and of those it needs. The depth is that of the manifest's
    /// longest chain, which its number of variables bounds.
    fn resolve(
        &mut self,
        name: &str,
        raw: &BTreeMap<String, (Json, &str)>,
        way: &mut Vec<String>,
    ) -> Result<(), CircuitError> {
        if self.values.contains_key(name) {
            return Ok(());
        }
        let Some((json, text)) = raw.get(name) else {
            return Ok(());
        };
        if way.iter().any(|passed| passed == name) || way.len() > MAX_CHAIN {
            way.push(name.into());
            let way = way.join(" → ");
            return Err(json.fault(Fault::Cycle { way }));
        }
        way.push(name.into());
        for needed in variables(text) {
            self.resolve(needed, raw, way)?;
        }
        way.pop();
        let configdir = self.folder.display().to_string();
        let value = replace(json, text, |name| {
            let known = self.values.get(name).cloned();
            known.or_else(|| (name == "configdir").then(|| configdir.clone()))
        })?;
        if value.len() > MAX_VALUE {
            let way = format!("{} bytes long", value.len());
            return Err(json.fault(Fault::Cycle { way }));
        }
        self.values.insert(name.into(), value);
        Ok(())
    }
}

/// Greatest chain of variables; real ones have three links.
const MAX_CHAIN: usize = 100;
/// Greatest length of a value: `$A$A`, `$B$B`, … doubles with every link.
const MAX_VALUE: usize = 1 << 16;

/// Pieces of a text: plain, or the name of a variable.
enum Piece<'a> {
    Plain(&'a str),
    Variable(&'a str),
}

fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some(dollar) = rest.find('$') {
        pieces.push(Piece::Plain(&rest[..dollar]));
        let after = &rest[dollar + 1..];
        let braced = after.strip_prefix('{').and_then(|a| a.split_once('}'));
        (rest, _) = if let Some((name, tail)) = braced {
            (tail, pieces.push(Piece::Variable(name)))
        } else {
            let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let end = after.find(|c| !is_name(c)).unwrap_or(after.len());
            (&after[end..], pieces.push(Piece::Variable(&after[..end])))
        };
    }
    pieces.push(Piece::Plain(rest));
    pieces
}

fn variables(text: &str) -> Vec<&str> {
    let name = |piece| match piece {
        Piece::Variable(name) => Some(name),
        Piece::Plain(_) => None,
    };
    pieces(text).into_iter().filter_map(name).collect()
}

fn replace(
    json: &Json,
    text: &str,
    value: impl Fn(&str) -> Option<String>,
) -> Result<String, CircuitError> {
    let mut replaced = String::new();
    for piece in pieces(text) {
        match piece {
            Piece::Plain(plain) => replaced.push_str(plain),
            Piece::Variable(name) => {
                let unknown = || json.fault(Fault::UnknownVariable { name: name.into() });
                replaced.push_str(&value(name).ok_or_else(unknown)?);
            }
        }
    }
    Ok(replaced)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json::Document;

    fn path(manifest: &str, value: &str) -> Result<String, String> {
        let text = format!("{{\"manifest\": {manifest}, \"p\": {value:?}}}");
        let document = Document::parse("c.json", text.as_bytes()).map_err(|e| e.to_string())?;
        let root = document.root();
        let manifest = Manifest::read(&root, Path::new("/c")).map_err(|e| e.to_string())?;
        let path = manifest.path(&root.need("p").expect("there"));
        path.map(|p| p.display().to_string().replace('\\', "/"))
            .map_err(|e| e.to_string())
    }

    #[test]
    fn variables_may_need_one_another() {
        let manifest = r#"{"$NET": "$BASE/net", "$BASE": "${configdir}", "PLAIN": "x"}"#;
        assert_eq!(path(manifest, "$NET/n.h5").as_deref(), Ok("/c/net/n.h5"));
        assert_eq!(path(manifest, "${PLAIN}_1").as_deref(), Ok("/c/x_1"));
        assert_eq!(path(manifest, "/abs").as_deref(), Ok("/abs"));
    }

    #[test]
    fn cycles_and_unknown_variables_name_file_and_key() {
        let cycle = path(r#"{"$A": "$B", "$B": "x/${A}"}"#, "$A");
        let expected = "c.json: 'manifest.$A': is defined by itself (A → B → A): break the cycle";
        assert_eq!(cycle, Err(expected.into()));
        let unknown = path(r#"{"$A": "."}"#, "$AB/x").expect_err("unknown");
        assert!(
            unknown.starts_with("c.json: 'p': variable $AB"),
            "{unknown}"
        );
        let mistyped = path(r#"{"$A": 3}"#, "$A").expect_err("a number");
        assert!(mistyped.contains("'manifest.$A'"), "{mistyped}");
    }

    #[test]
    fn doubling_values_stop() {
        let links: Vec<String> = (0..60)
            .map(|i| format!("\"$V{i}\": \"$V{0}$V{0}\"", i + 1))
            .collect();
        let manifest = format!("{{{}, \"$V60\": \"ab\"}}", links.join(", "));
        assert!(path(&manifest, "$V0").is_err());
    }
}
