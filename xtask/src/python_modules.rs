//! What the modules of the Python package import as they are imported themselves. Imports within functions are later:
//! methods of cells and meshes draw them by modules that know cells and meshes.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::Context;

use crate::modules::Imports;

/// The imports of all modules in a folder.
pub(crate) fn read(folder: &Path) -> anyhow::Result<Imports> {
    let mut imports = Imports::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if path.extension().is_some_and(|extension| extension == "py") {
            let text = std::fs::read_to_string(&path)?;
            imports.insert(vec![name.into_owned()], of_text(&text));
        }
    }
    Ok(imports)
}

fn of_text(text: &str) -> BTreeSet<Vec<String>> {
    let mut found = BTreeSet::new();
    for line in text.lines() {
        let Some((from, names)) = line
            .strip_prefix("from .")
            .and_then(|rest| rest.split_once(" import "))
        else {
            continue;
        };
        let names = match from {
            "" => names.split(',').map(str::trim).collect(),
            module => vec![module],
        };
        // Others are names of the package itself.
        let modules = names.into_iter().filter(|name| name.starts_with('_'));
        found.extend(modules.map(|name| vec![name.to_owned()]));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn imports_at_the_beginning_of_lines_count() {
        let text = "from . import _neurotess, quiet\nfrom ._cells import cell_of\n    from ._late import x\nimport os\n";
        let names: Vec<String> = of_text(text).into_iter().flatten().collect();
        assert_eq!(names, ["_cells", "_neurotess"]);
    }
}
