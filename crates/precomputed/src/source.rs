//! The cells that are written: which tracing each has, where it is, and its id.

use std::collections::BTreeSet;
use std::path::Path;

use glam::{DAffine3, DVec3};
use neurotess_batch::{Inputs, read};
use neurotess_circuit::{Circuit, Instance};
use neurotess_formats::{self as formats, ReadOptions};
use std::sync::Arc;

use crate::error::{ExportError, IdError};

/// Ids of the cells of a circuit's second population begin behind those of the first, and so on.
pub(crate) const OF_POPULATION: u64 = 1_000_000_000_000;

/// Cells of files or of a circuit.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    Files(Inputs),
    Circuit(Arc<Circuit>, Arc<Vec<Instance>>),
}

impl Source {
    /// How many cells there are.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Files(inputs) => inputs.files.len(),
            Self::Circuit(_, instances) => instances.len(),
        }
    }

    /// How many tracings they may have.
    pub(crate) fn template_count(&self) -> usize {
        match self {
            Self::Files(inputs) => inputs.files.len(),
            Self::Circuit(circuit, _) => circuit.templates.len(),
        }
    }

    /// The number of a cell's tracing.
    pub(crate) fn template(&self, cell: usize) -> usize {
        match self {
            Self::Files(_) => cell,
            Self::Circuit(_, instances) => instances[cell].template.index(),
        }
    }

    /// The file of a tracing.
    pub(crate) fn file(&self, template: usize) -> &Path {
        match self {
            Self::Files(inputs) => &inputs.files[template].path,
            Self::Circuit(circuit, _) => &circuit.templates[template].path,
        }
    }

    /// What a cell is called.
    pub(crate) fn label(&self, cell: usize) -> String {
        match self {
            Self::Files(inputs) => stem(&inputs.files[cell].relative),
            Self::Circuit(circuit, instances) => {
                let instance = &instances[cell];
                let population = &circuit.populations[instance.node.population as usize].name;
                format!("{population} {}", instance.id)
            }
        }
    }

    /// From a cell's coordinates (µm) to the world's. `soma_center`: in the tracing's coordinates.
    pub(crate) fn placement(&self, cell: usize, soma_center: DVec3) -> DAffine3 {
        match self {
            Self::Files(_) => DAffine3::IDENTITY,
            Self::Circuit(_, instances) => instances[cell].world_from_cell(soma_center),
        }
    }

    /// The segment of each cell.
    ///
    /// Of a circuit: the node's id and 1, and 10¹² more for each population before its own. Of files: their names, if all
    /// are numbers, such as those of an EM volume's segments; else 1, 2, 3 in their order.
    pub(crate) fn ids(&self) -> Result<Vec<u64>, IdError> {
        let ids = match self {
            Self::Files(inputs) => {
                let of_names = inputs.files.iter().map(|input| {
                    let id = stem(&input.relative).parse::<u64>().ok();
                    id.filter(|&id| id > 0)
                });
                let of_names: Option<Vec<u64>> = of_names.collect();
                of_names.unwrap_or_else(|| (1..=inputs.files.len() as u64).collect())
            }
            Self::Circuit(circuit, instances) => {
                let id = |instance: &Instance| {
                    let population = instance.node.population;
                    if instance.id + 1 >= OF_POPULATION {
                        let population = circuit.populations[population as usize].name.clone();
                        let id = instance.id;
                        return Err(IdError::TooLarge { id, population });
                    }
                    Ok(u64::from(population) * OF_POPULATION + instance.id + 1)
                };
                instances.iter().map(id).collect::<Result<_, _>>()?
            }
        };
        let mut order: Vec<usize> = (0..ids.len()).collect();
        order.sort_by_key(|&cell| ids[cell]);
        match order.windows(2).find(|pair| ids[pair[0]] == ids[pair[1]]) {
            None => Ok(ids),
            Some(pair) => Err(IdError::Twice {
                cells: [pair[0], pair[1]].map(|cell| self.label(cell)),
                id: ids[pair[0]],
            }),
        }
    }

    /// Refuses tracings in the folder that is written, and those of which none can be read: then nothing is to become of what
    /// is in the folder. One is read, if it is sound.
    pub(crate) fn check(&self, out: &Path) -> Result<(), ExportError> {
        if let (Self::Files(inputs), Ok(out)) = (self, out.canonicalize()) {
            let is_within = |path: &Path| path.canonicalize().is_ok_and(|p| p.starts_with(&out));
            let mut files = inputs
                .files
                .iter()
                .map(|input| formats::member(&input.path).0);
            if let Some(path) = files.find(|path| is_within(path)) {
                return Err(ExportError::Within(path.to_path_buf()));
            }
        }
        let mut first = None;
        for (template, _) in self
            .uses()
            .iter()
            .enumerate()
            .filter(|(_, uses)| **uses > 0)
        {
            match read(self.file(template), None, &ReadOptions::default()) {
                Ok(_) => return Ok(()),
                Err(error) => first = first.or(Some(error)),
            }
        }
        first.map_or(Ok(()), |error| Err(ExportError::Unreadable(error)))
    }

    /// How many cells have each tracing.
    pub(crate) fn uses(&self) -> Vec<u32> {
        let mut uses = vec![0; self.template_count()];
        for cell in 0..self.len() {
            uses[self.template(cell)] += 1;
        }
        uses
    }

    /// Words for a cell besides its types: folders of its file.
    pub(crate) fn folders(&self, cell: usize) -> Vec<String> {
        match self {
            Self::Files(inputs) => {
                let folder = inputs.files[cell].relative.parent();
                let parts = folder.into_iter().flat_map(Path::components);
                let names = parts.map(|part| part.as_os_str().to_string_lossy().into_owned());
                names.collect::<BTreeSet<_>>().into_iter().collect()
            }
            Self::Circuit(..) => Vec::new(),
        }
    }
}

/// A file's name without extensions of formats.
fn stem(path: &Path) -> String {
    let name = formats::unpacked_name(path);
    let stem = name.file_stem().unwrap_or(name.as_os_str());
    stem.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use neurotess_batch::Input;

    use super::*;

    fn files(names: &[&str]) -> Source {
        let input = |name: &&str| Input {
            path: name.into(),
            relative: name.into(),
        };
        Source::Files(Inputs {
            files: names.iter().map(input).collect(),
            ..Inputs::default()
        })
    }

    #[test]
    fn files_are_numbered_or_have_numbers_for_names() {
        let of = |names: &[&str]| files(names).ids();
        assert_eq!(of(&["b.swc", "a.swc.gz"]), Ok(vec![1, 2]));
        assert_eq!(of(&["12.swc", "a.swc"]), Ok(vec![1, 2]));
        assert_eq!(
            of(&["720575940623456789.swc", "x/4.asc"]),
            Ok(vec![720_575_940_623_456_789, 4])
        );
        // 0 is neuroglancer's background.
        assert_eq!(of(&["0.swc", "7.swc"]), Ok(vec![1, 2]));
        assert!(matches!(
            of(&["a/7.swc", "b/07.swc"]),
            Err(IdError::Twice { id: 7, .. })
        ));
    }

    #[test]
    fn folders_are_words() {
        assert_eq!(files(&["CA1/young/a.swc"]).folders(0), ["CA1", "young"]);
        assert!(files(&["a.swc"]).folders(0).is_empty());
        assert_eq!(files(&["CA1/a.CNG.swc.gz"]).label(0), "a.CNG");
    }
}
