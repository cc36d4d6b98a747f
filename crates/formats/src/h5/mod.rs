//! H5 morphologies of the Blue Brain Project, versions 1, 1.1 to 1.3 and 2.
//!
//! Version 1 has two tables: `points` (x, y, z, **diameter**) and `structure` (first point, type,
//! parent section), whose row 0 is the soma's outline if its type is 1; a section's points end where
//! the next one's begin, and its first repeats its parent's last. Version 2 has the same in
//! `NAME/STAGE/points`, `NAME/structure/STAGE` and `NAME/structure/sectiontype`, where NAME is usually
//! `neuron1` and STAGE is `repaired`, `unraveled` or `raw`, the best that is there (Brion and NeuroM
//! choose so too); `unraveled` may have the structure of `raw`. Perimeters and organelles are left out
//! with a warning, but for those that tell of spines (`spines.rs`). A **container** has many morphologies of version 1, each in a group, of which one is
//! named by its path: `merged.h5#cells/a`. HDF5 itself is read by a library in pure Rust.

mod soma_mesh;
mod spines;
mod write;

use std::path::Path;

use neurotess_morphology::{Morphology, NeuriteKind};

use crate::hdf5::{Store, Table};
use crate::sample::Sample;
use crate::text::stem;
use crate::traced::Tracing;
use crate::warning::Warnings;
use crate::{Fault, Format, Read, ReadError, ReadOptions, regular};
pub use soma_mesh::soma_mesh;
pub use write::write;

/// Stages of version 2, the best first.
const STAGES: [&str; 3] = ["repaired", "unraveled", "raw"];

/// Type of the soma's row in `structure`.
const SOMA: i64 = 1;

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and the dataset.
pub fn read_bytes(bytes: Vec<u8>, name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_member(bytes, name, "", options)
}

/// Reads one morphology of a container. `member`: path of its group; empty: the file is no container.
///
/// # Errors
/// [`ReadError`] with `name` and the dataset.
pub fn read_member(
    bytes: Vec<u8>,
    name: &str,
    member: &str,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::of_file(name, Fault::Empty));
    }
    read_store(Store::from_bytes(bytes), name, member, options)
}

/// Reads one morphology of a container that is a file: its own parts only, since a container may be larger than
/// memory and is read once for each of its morphologies.
pub(crate) fn read_member_of(
    file: &Path,
    name: &str,
    member: &str,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    if let Err(e) = regular(file) {
        return Err(ReadError::of_file(name, Fault::Io(e)));
    }
    read_store(Store::open(file), name, member, options)
}

fn read_store(
    store: Result<Store, Fault>,
    name: &str,
    member: &str,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    let mut warnings = Warnings::default();
    let own = match member.rsplit('/').next().unwrap_or_default() {
        "" => stem(name, Format::H5.extensions()),
        last => last,
    };
    let morphology = store.and_then(|mut store| interpret(&mut store, own, member, &mut warnings));
    let morphology = morphology.map_err(|fault| ReadError::of_file(name, fault))?;
    let mut warnings = warnings.finish(name, options)?;
    // Rows of tables are no lines.
    warnings.iter_mut().for_each(|w| w.line = None);
    Ok(Read {
        morphology,
        format: "h5",
        warnings,
    })
}

/// Whether a file is named as HDF5 is and is sound, but holds something else: a report, nodes of a circuit.
/// Only its beginning and the names in it are read.
pub fn is_other(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    if Format::of_extension(&extension) != Some(Format::H5) || regular(path).is_err() {
        return false;
    }
    Store::open(path).is_ok_and(|store| {
        !store.has("connectivity") && Layout::of(&store).is_none() && morphologies(&store).0 == 0
    })
}

fn interpret(
    store: &mut Store,
    name: &str,
    member: &str,
    warnings: &mut Warnings,
) -> Result<Morphology, Fault> {
    let group = member.trim_matches('/');
    let path = match group {
        "" => String::new(),
        group => format!("{group}/"),
    };
    if !group.is_empty() {
        store.focus(group);
    }
    let tables = match member {
        "" => Tables::find(store, warnings)?,
        member => Tables::of_member(store, member)?,
    };
    tell_what_is_left_out(store, &path, warnings);
    if soma_mesh::is_there(store, name) {
        let message = "the file has a mesh of the soma: mesh --soma-mesh file takes it";
        warnings.add(1, "soma_mesh_in_file", message);
    }
    let mut tracing = tables.tracing(warnings)?;
    tracing.spines = spines::spines(store, &path, &tables, warnings)?;
    tracing
        .build(name, warnings)
        .map_err(|(row, fault)| match fault {
            Fault::OwnAncestor | Fault::OutOfRange { .. } => Fault::Row {
                dataset: tables.points_path.clone(),
                row: row - 1,
                fault: Box::new(fault),
            },
            other => other,
        })
}

/// The tables of a morphology, whatever the version.
struct Tables {
    points_path: String,
    structure_path: String,
    points: Table<f64>,
    /// First point, type, parent.
    sections: Vec<[i64; 3]>,
}

/// Where the tables of a file's only morphology are.
enum Layout {
    /// Version 1: `points`, `structure`.
    One,
    /// Version 2: the group, and stages from the best on.
    Two(String, Vec<&'static str>),
}

impl Layout {
    fn of(store: &Store) -> Option<Self> {
        if store.has("points") && store.has("structure") {
            return Some(Self::One);
        }
        store.groups("").into_iter().find_map(|group| {
            let has = |stage: &&str| store.has(&format!("{group}/{stage}/points"));
            let stages: Vec<&str> = STAGES.into_iter().filter(has).collect();
            let types = store.has(&format!("{group}/structure/sectiontype"));
            (types && !stages.is_empty()).then_some(Self::Two(group, stages))
        })
    }
}

impl Tables {
    fn find(store: &Store, warnings: &mut Warnings) -> Result<Self, Fault> {
        if store.has("connectivity") {
            return Err(Fault::Vasculature);
        }
        match Layout::of(store) {
            Some(Layout::One) => Self::version_1(store, ""),
            Some(Layout::Two(group, stages)) => {
                if stages.len() > 1 {
                    let message = format!("stages {}: the first is read", stages.join(", "));
                    warnings.add(1, "stages", &message);
                }
                Self::version_2(store, &group, stages[0])
            }
            None => match morphologies(store) {
                (0, _) => Err(Fault::NoTables),
                (count, first) => Err(Fault::Container { count, first }),
            },
        }
    }

    fn of_member(store: &Store, member: &str) -> Result<Self, Fault> {
        let path = format!("{}/", member.trim_matches('/'));
        if store.has(&format!("{path}points")) && store.has(&format!("{path}structure")) {
            return Self::version_1(store, &path);
        }
        let (count, first) = morphologies(store);
        let member = member.to_owned();
        Err(Fault::NoMember {
            member,
            count,
            first,
        })
    }

    /// `path`: of the group with a slash at its end; empty for the root.
    fn version_1(store: &Store, path: &str) -> Result<Self, Fault> {
        let points_path = format!("{path}points");
        let structure_path = format!("{path}structure");
        let structure = store.wholes(&structure_path, 3)?;
        let row = |r: usize| {
            let row = structure.row(r);
            [row[0], row[1], row[2]]
        };
        Ok(Self {
            points: store.reals(&points_path, 4)?,
            sections: (0..structure.rows).map(row).collect(),
            points_path,
            structure_path,
        })
    }

    fn version_2(store: &Store, group: &str, stage: &str) -> Result<Self, Fault> {
        let points_path = format!("{group}/{stage}/points");
        let mut structure_path = format!("{group}/structure/{stage}");
        if stage == "unraveled" && !store.has(&structure_path) {
            structure_path = format!("{group}/structure/raw");
        }
        let types_path = format!("{group}/structure/sectiontype");
        let structure = store.wholes(&structure_path, 2)?;
        let types = store.wholes(&types_path, 1)?;
        if types.rows != structure.rows {
            return Err(Fault::Shape {
                dataset: types_path,
                found: vec![types.rows as u64],
                columns: 1,
            });
        }
        let row = |r: usize| [structure.row(r)[0], types.row(r)[0], structure.row(r)[1]];
        Ok(Self {
            points: store.reals(&points_path, 4)?,
            sections: (0..structure.rows).map(row).collect(),
            points_path,
            structure_path,
        })
    }

    fn tracing(&self, warnings: &mut Warnings) -> Result<Tracing, Fault> {
        let mut tracing = Tracing {
            empty_sections_count: true,
            ..Tracing::default()
        };
        // Of each section the last point, among those traced; none for a soma or an empty one.
        let mut lasts: Vec<Option<u32>> = vec![None; self.sections.len()];
        let mut starts: Vec<(u32, usize)> = Vec::new();
        for (s, &[_, kind, _]) in self.sections.iter().enumerate() {
            let range = self.range(s)?;
            if kind == SOMA {
                if s > 0 {
                    let row = s as u64 + 1;
                    warnings.add(
                        row,
                        "soma_not_first",
                        "a soma that is not the first section",
                    );
                }
                let outline: Vec<Sample> =
                    range.map(|p| self.sample(p)).collect::<Result<_, _>>()?;
                if !outline.is_empty() {
                    tracing.outlines.push(outline);
                }
                continue;
            }
            let kind = i32::try_from(kind).ok().filter(|&k| k >= 0);
            let kind = NeuriteKind(kind.ok_or_else(|| self.at(s, "type"))?);
            for point in range {
                let begins = lasts[s].is_none();
                let sample = self.sample(point)?;
                let index = tracing.push(sample, kind, lasts[s], begins);
                if begins {
                    starts.push((index, s));
                }
                lasts[s] = Some(index);
            }
        }
        for (index, s) in starts {
            let fork = self.fork_of(s, &lasts)?;
            tracing.points[index as usize].parent = fork;
            let section = tracing.points[index as usize].section as usize;
            let parent = fork.map(|fork| tracing.points[fork as usize].section);
            tracing.sections[section].parent = parent;
        }
        Ok(tracing)
    }

    /// The point that a section hangs on: the last of its parent.
    fn fork_of(&self, section: usize, lasts: &[Option<u32>]) -> Result<Option<u32>, Fault> {
        let parent = self.sections[section][2];
        if parent == -1 {
            return Ok(None);
        }
        let known = usize::try_from(parent).ok().filter(|&p| p != section);
        let parent = known.and_then(|p| self.sections.get(p).map(|row| (p, row)));
        match parent {
            Some((_, [_, SOMA, _])) => Ok(None),
            Some((p, _)) => Ok(lasts[p]),
            None => Err(self.at(section, "parent")),
        }
    }

    fn range(&self, section: usize) -> Result<std::ops::Range<usize>, Fault> {
        let end = match self.sections.get(section + 1) {
            Some(&[next, ..]) => next,
            None => self.points.rows as i64,
        };
        let first = self.sections[section][0];
        // Files without a soma may have an empty row for it.
        let empty = first == end && self.sections[section][1] != SOMA;
        if first < 0 || end < first || empty || end > self.points.rows as i64 {
            return Err(self.at(section, "first point"));
        }
        Ok(first as usize..end as usize)
    }

    fn sample(&self, point: usize) -> Result<Sample, Fault> {
        let row = self.points.row(point);
        // Of a diameter the half is kept.
        let kept = [row[0], row[1], row[2], row[3] / 2.0];
        if let Some(column) = kept
            .iter()
            .position(|x| x.is_nan() || x.abs() > Morphology::MAX_COORDINATE)
        {
            return Err(Fault::Row {
                dataset: self.points_path.clone(),
                row: point as u64,
                fault: Box::new(Fault::OutOfRange {
                    column: ["x", "y", "z", "the diameter"][column],
                    text: row[column].to_string(),
                }),
            });
        }
        Ok(Sample {
            position: glam::DVec3::new(row[0], row[1], row[2]),
            radius: row[3] / 2.0,
            line: point as u64 + 1,
        })
    }

    fn at(&self, section: usize, column: &'static str) -> Fault {
        Fault::Row {
            dataset: self.structure_path.clone(),
            row: section as u64,
            fault: Box::new(Fault::Reference { column }),
        }
    }
}

/// How many morphologies there are in groups up to three deep, and the first one's path.
fn morphologies(store: &Store) -> (usize, String) {
    let (mut count, mut first) = (0, String::new());
    let mut paths: Vec<(String, u32)> = vec![(String::new(), 0)];
    while let Some((path, depth)) = paths.pop() {
        if store.has(&format!("{path}points")) && store.has(&format!("{path}structure")) {
            count += 1;
            if first.is_empty() || path < first {
                first.clone_from(&path);
            }
        } else if depth < 3 {
            let inner = store.groups(path.trim_end_matches('/'));
            paths.extend(inner.iter().map(|g| (format!("{path}{g}/"), depth + 1)));
        }
    }
    (count, first.trim_end_matches('/').to_owned())
}

/// `path`: of the cell's group with a slash at its end; empty for the root.
fn tell_what_is_left_out(store: &Store, path: &str, warnings: &mut Warnings) {
    if spines::has_other_organelles(store, path) {
        warnings.add(1, "organelles_left_out", "organelles: left out");
    }
    if store.has(&format!("{path}perimeters")) {
        warnings.add(1, "perimeters_left_out", "perimeters: left out");
    }
    let family = store.whole_attribute(&format!("{path}metadata"), "cell_family");
    match family.first() {
        Some(1) => warnings.add(
            1,
            "glia",
            "the cell is glia: types 2 and 3 are perivascular and other processes",
        ),
        Some(2) => warnings.add(
            1,
            "spine",
            "the file is a spine: types 2 and 3 are neck and head",
        ),
        _ => {}
    }
}
