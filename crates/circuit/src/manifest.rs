//! Variables of a configuration: `$NAME` or `${NAME}`, defined in its `manifest`, perhaps by one
//! another.
//!
//! Some have a value without being defined, as bmtk has it: `configdir`, the configuration's folder;
//! `workingdir`, taken for the same, since that is where bmtk is run as a rule; `configfname`, the file. Of `date`,
//! `time` and `datetime`, which are those of bmtk's run, nothing is known: they stay as they are.
//!
//! Relative paths are relative to the configuration's folder.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use crate::json::Json;
use crate::{CircuitError, Fault};

/// Variables whose values hold no variables any more.
#[derive(Debug)]
pub(crate) struct Manifest {
    /// The configuration's folder as it was named.
    folder: PathBuf,
    /// The same folder, absolute: a variable that stands for it may be joined to any other.
    absolute: PathBuf,
    /// The configuration as it was named.
    file: String,
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
                let bare = bare.strip_prefix('$').unwrap_or(bare);
                let text = value.text()?;
                raw.insert(bare.into(), (value, text));
            }
        }
        let mut manifest = Self {
            folder: folder.to_path_buf(),
            absolute: absolute(folder),
            file: config.file.into(),
            values: BTreeMap::new(),
        };
        let names: Vec<String> = raw.keys().cloned().collect();
        for name in names {
            manifest.resolve(&name, &raw, &mut Vec::new())?;
        }
        Ok(manifest)
    }

    /// The text of a value, its variables replaced.
    pub(crate) fn expand(&self, json: &Json) -> Result<String, CircuitError> {
        replace(json, json.text()?, |name| self.value(name))
    }

    /// The path that a value names.
    pub(crate) fn path(&self, json: &Json) -> Result<PathBuf, CircuitError> {
        Ok(self.named(&self.folder.join(self.expand(json)?)))
    }

    /// The path of a file that a value names in a folder of outputs, which `output` names in turn. bmtk takes the
    /// name of that folder away if the value begins with it, as `$OUT/spikes.h5` does; libsonata does not.
    pub(crate) fn path_in(
        &self,
        output: Option<&Json>,
        file: &str,
    ) -> Result<PathBuf, CircuitError> {
        let output = match output {
            Some(folder) => self.expand(folder)?,
            None => "output".into(),
        };
        let within = self.named(&self.folder.join(&output).join(file));
        let bare = |path: &str| -> PathBuf {
            let parts = Path::new(path).components();
            parts.filter(|part| *part != Component::CurDir).collect()
        };
        if bare(file).starts_with(bare(&output)) && !within.is_file() {
            return Ok(self.named(&self.folder.join(file)));
        }
        Ok(within)
    }

    /// A path as the user would name it: from the folder as it was given on, and `./x/./y` as `x/y`.
    fn named(&self, path: &Path) -> PathBuf {
        let within = path.strip_prefix(&self.absolute);
        let named = within.map_or_else(|_| path.to_path_buf(), |rest| self.folder.join(rest));
        named.components().collect()
    }

    /// The value of a variable, of the manifest or built in.
    fn value(&self, name: &str) -> Option<String> {
        // bmtk's own page has `${$NAME}`.
        let name = name.strip_prefix('$').unwrap_or(name);
        let known = self.values.get(name).cloned();
        known.or_else(|| match name {
            "configdir" | "workingdir" => Some(self.absolute.display().to_string()),
            "configfname" => Some(absolute(Path::new(&self.file)).display().to_string()),
            "date" | "time" | "datetime" => Some(format!("${{{name}}}")),
            _ => None,
        })
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
            self.resolve(needed.strip_prefix('$').unwrap_or(needed), raw, way)?;
        }
        way.pop();
        let value = replace(json, text, |name| self.value(name))?;
        if value.len() > MAX_VALUE {
            let way = format!("{} bytes long", value.len());
            return Err(json.fault(Fault::Cycle { way }));
        }
        self.values.insert(name.into(), value);
        Ok(())
    }
}

/// The path from the root on. Only where the system knows no current folder, it stays as it is.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
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
        path_from("/c", manifest, value)
    }

    fn path_from(folder: &str, manifest: &str, value: &str) -> Result<String, String> {
        let text = format!("{{\"manifest\": {manifest}, \"p\": {value:?}}}");
        let document = Document::parse("c.json", text.as_bytes()).map_err(|e| e.to_string())?;
        let root = document.root();
        let manifest = Manifest::read(&root, Path::new(folder)).map_err(|e| e.to_string())?;
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
    fn the_folder_is_put_before_a_path_once() {
        let own = r#"{"$BASE": "${configdir}", "$NET": "${BASE}/net", "$OUT": "${$NET}/out"}"#;
        let relative = r#"{"$BASE": ".", "$NET": "$BASE/net", "$OUT": "./${NET}/out"}"#;
        for manifest in [own, relative] {
            for folder in ["s", "../s/t", "a/b/c", "/c", "./s"] {
                let of = |value| path_from(folder, manifest, value).expect("a path");
                let folder = folder.trim_start_matches("./");
                let bare = |path: String| path.trim_start_matches("./").to_owned();
                assert_eq!(bare(of("$NET/n.h5")), format!("{folder}/net/n.h5"));
                assert_eq!(bare(of("$OUT")), format!("{folder}/net/out"));
                assert_eq!(bare(of("$BASE/../m")), format!("{folder}/../m"));
                assert_eq!(bare(of("${configdir}/x")), format!("{folder}/x"));
                assert_eq!(bare(of("${workingdir}/x")), format!("{folder}/x"));
                assert_eq!(of("/elsewhere/x"), "/elsewhere/x");
            }
        }
        let file = path("{}", "${configfname}").expect("a path");
        assert!(file.ends_with("/c.json"), "{file}");
        let dated = path(r#"{"$OUT": "out_${date}"}"#, "$OUT/x.h5");
        assert_eq!(dated.as_deref(), Ok("/c/out_${date}/x.h5"));
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
