//! Tracings that are open: read, meshed, measured. They stay while an undo could want them.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use glam::DVec3;
use neurotess::circuit::{Circuit, is_circuit, is_recording, soma_center};
use neurotess::formats::{self, ReadOptions};
use neurotess::generate::{Generated, generate};
use neurotess::mesh::CoarseMesh;
use neurotess::morphology::{Measures, Morphology, shape};
use neurotess::render::{BoundingSphere, Placement, bounds, merged};
use neurotess::synth::{self, Kind};
use walkdir::WalkDir;

use crate::model::circuits::Opened;
use crate::model::document::{SomaEdit, SourceId};

/// Balls of a neuron in scenes of many: 1,000 neurons of 1,000 balls would take every frame 10 ms.
const FEW_BALLS: usize = 48;

/// Before the name of a built-in sample.
const SAMPLE: &str = "sample:";

/// An open tracing.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its file, or `sample:KIND`.
    pub file: PathBuf,
    /// Name for people.
    pub name: String,
    /// The tracing.
    pub morphology: Arc<Morphology>,
    /// Its coarse mesh with the soma's figures.
    pub generated: Arc<Generated>,
    /// What the mesh was made with.
    pub soma: SomaEdit,
    /// Morphometrics.
    pub measures: Arc<Measures>,
    /// What was odd in the file, and what was mended in the mesh.
    pub warnings: Vec<Remark>,
    /// When the file was written last; none: a sample.
    pub written: Option<SystemTime>,
    /// Bounding spheres around the mesh (µm).
    pub balls: Vec<BoundingSphere>,
    /// A few that hold them, for scenes of many neurons.
    pub few_balls: Vec<BoundingSphere>,
    /// Its file has changed since, or is gone.
    pub stale: Option<Stale>,
    /// By section: length (µm) and branch order.
    pub sections: Arc<Vec<SectionFacts>>,
}

/// Something that was odd or was mended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// For people, with its line if it has one.
    pub text: String,
    /// Whether somebody should look into it: something is missing or was guessed.
    pub concerns: bool,
}

impl Remark {
    fn new(code: &str, text: String) -> Self {
        let concerns = CONCERNS.contains(&code);
        Self { text, concerns }
    }
}

/// Names of what somebody should look into. What else readers and the generator tell of is the daily work of
/// making a mesh: points closer together than they are thick, say, of which nearly every tracing has some.
const CONCERNS: [&str; 18] = [
    "disconnected",
    "far_from_soma",
    "negative_radius",
    "no_seat",
    "one_point_tree",
    "other_cells_left_out",
    "radius_mended",
    "ring_unused",
    "rings_cross",
    "several_somata",
    "soma_folded",
    "soma_inside_neurite",
    "soma_of_one_point",
    "soma_radius_mended",
    "soma_zero_radius",
    "unknown_expression",
    "untyped_tree",
    "zero_radius",
];

/// What a file has become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stale {
    /// Something else is in it.
    Changed,
    /// It is gone.
    Gone,
}

/// Figures of a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionFacts {
    /// Length (µm).
    pub length: f64,
    /// Forks between the neurite's start and it.
    pub order: u32,
    /// Distance along the path (µm) from the neurite's start to its end.
    pub path: f64,
    /// Number of the neurite, from 0.
    pub neurite: u32,
}

/// All tracings that are open or were.
#[derive(Clone, Debug, Default)]
pub struct Sources(Vec<Source>);

impl Source {
    /// Another mesh.
    pub fn set_generated(&mut self, generated: Generated) {
        (self.balls, self.few_balls) = balls(&generated.mesh);
        self.generated = Arc::new(generated);
    }
}

/// All balls around a mesh, and a few that hold them.
fn balls(mesh: &CoarseMesh) -> (Vec<BoundingSphere>, Vec<BoundingSphere>) {
    let all = bounds(mesh);
    let few = merged(&all, FEW_BALLS);
    (all, few)
}

impl Sources {
    /// Adds a tracing.
    pub fn add(&mut self, source: Source) -> SourceId {
        self.0.push(source);
        SourceId(self.0.len() as u32 - 1)
    }

    /// A tracing.
    pub fn get(&self, id: SourceId) -> Option<&Source> {
        self.0.get(id.0 as usize)
    }

    /// A tracing, to be changed.
    pub fn get_mut(&mut self, id: SourceId) -> Option<&mut Source> {
        self.0.get_mut(id.0 as usize)
    }

    /// All with their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (SourceId, &Source)> {
        (0..).map(SourceId).zip(&self.0)
    }
}

/// A cell of a circuit: which of its files, where it stands, its number.
#[derive(Clone, Debug)]
pub struct Standing {
    /// Among the files that were found.
    pub file: usize,
    /// Among the circuits that were found.
    pub circuit: usize,
    /// Where.
    pub position: DVec3,
    /// The instance, for its place once the soma is known.
    pub instance: neurotess::circuit::Instance,
}

/// What is asked for.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Files, folders, circuits with their cells.
    pub paths: Vec<PathBuf>,
    /// Circuits whose cells are among the files.
    pub circuits: Vec<PathBuf>,
    /// How somata are made of files where it is not as usual.
    pub somata: Vec<(PathBuf, SomaEdit)>,
    /// How those of the others are made.
    pub usual: SomaEdit,
}

/// What is to be read.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Files, each once.
    pub files: Vec<PathBuf>,
    /// Circuits.
    pub circuits: Vec<Opened>,
    /// Reports and spikes.
    pub reports: Vec<PathBuf>,
    /// Cells of circuits; files that no cell stands for are shown where they were traced.
    pub standing: Vec<Standing>,
    /// What could not be searched or opened: file and reason.
    pub failures: Vec<(PathBuf, String)>,
}

/// Files below folders, cells of circuits.
pub fn find(wanted: &Wanted) -> Found {
    let mut found = Found::default();
    for path in &wanted.circuits {
        match Circuit::open(path) {
            Ok(circuit) => found.circuits.push((path.clone(), Arc::new(circuit))),
            Err(e) => found.failures.push((path.clone(), e.to_string())),
        }
    }
    for path in &wanted.paths {
        if is_sample(path) {
            found.files.push(path.clone());
        } else if is_circuit(path) {
            find_circuit(path, &mut found);
        } else if path.is_dir() {
            find_folder(path, &mut found);
        } else if is_hdf5(path) && is_recording(path) {
            found.reports.push(path.clone());
        } else {
            found.files.push(path.clone());
        }
    }
    found
}

fn find_folder(folder: &Path, found: &mut Found) {
    let before = found.files.len();
    for entry in WalkDir::new(folder).follow_links(true).sort_by_file_name() {
        match entry {
            Ok(entry) if entry.file_type().is_file() && is_readable(entry.path()) => {
                // Reports and tables of nodes are HDF5 too.
                if !formats::h5::is_other(entry.path()) {
                    found.files.push(entry.into_path());
                }
            }
            Ok(_) => {}
            Err(e) => {
                let at = e.path().unwrap_or(folder).to_path_buf();
                let why = "cannot be searched: check links and permissions";
                found.failures.push((at, why.into()));
            }
        }
    }
    if found.files.len() == before {
        let known = formats::EXTENSIONS.join(", .");
        let why = format!("no tracing in this folder: it needs files named .{known}");
        found.failures.push((folder.to_path_buf(), why));
    }
}

/// Whether a file is named as a tracing is.
pub fn is_readable(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let mut known = formats::EXTENSIONS.iter();
    !name.as_encoded_bytes().starts_with(b".") && known.any(|k| extension.eq_ignore_ascii_case(k))
}

/// Whether a file is named as HDF5 is: a morphology, a report, spikes.
pub fn is_hdf5(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    extension.eq_ignore_ascii_case("h5") || extension.eq_ignore_ascii_case("hdf5")
}

fn find_circuit(path: &Path, found: &mut Found) {
    let circuit = match Circuit::open(path) {
        Ok(circuit) => circuit,
        Err(e) => {
            found.failures.push((path.to_path_buf(), e.to_string()));
            return;
        }
    };
    for failure in &circuit.failures {
        found
            .failures
            .push((path.to_path_buf(), failure.to_string()));
    }
    let nodes: Vec<_> = circuit.nodes().collect();
    let instances = circuit.instances(&nodes, None);
    if instances.len() < nodes.len() {
        let left_out = nodes.len() - instances.len();
        let why = format!(
            "{left_out} of {} cells have no morphology: not shown",
            nodes.len()
        );
        found.failures.push((path.to_path_buf(), why));
    }
    let mut files = std::collections::BTreeMap::new();
    let number = found.circuits.len();
    for instance in instances {
        let template = &circuit.templates[instance.template.index()].path;
        let next = found.files.len();
        let file = *files.entry(template.clone()).or_insert_with(|| {
            found.files.push(template.clone());
            next
        });
        found.standing.push(Standing {
            file,
            circuit: number,
            position: instance.position,
            instance,
        });
    }
    found.circuits.push((path.to_path_buf(), Arc::new(circuit)));
}

impl Standing {
    /// Name and place of the cell, once its tracing is read.
    pub fn place(&self, source: &Source) -> (String, Placement) {
        let instance = &self.instance;
        let center = soma_center(&source.morphology);
        let placement = Placement {
            rotation: instance.rotation,
            scale: instance.scale,
            translation: instance.world_from_cell(center).translation,
        };
        (format!("{} {}", instance.id, source.name), placement)
    }
}

/// Path of a built-in sample.
pub fn sample(kind: Kind) -> PathBuf {
    PathBuf::from(format!("{SAMPLE}{kind}"))
}

fn is_sample(path: &Path) -> bool {
    path.to_string_lossy().starts_with(SAMPLE)
}

/// Reads a file, or grows a sample, and meshes it.
///
/// # Errors
/// What is wrong and what to do.
pub fn load(file: &Path, soma: SomaEdit) -> Result<Source, String> {
    let name = file.to_string_lossy();
    if let Some(kind) = name.strip_prefix(SAMPLE) {
        let kind: Kind = kind.parse().map_err(|e| format!("{e}"))?;
        let morphology = synth::grow(&synth::Options::sample(kind));
        return source(file, kind.to_string(), morphology, soma, Vec::new(), None);
    }
    let written = fs::metadata(file).and_then(|m| m.modified()).ok();
    let read = formats::read(file, &ReadOptions::default()).map_err(|e| reason(&name, &e))?;
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let warnings = read.warnings.iter().map(|w| {
        let line = w
            .line
            .map_or(String::new(), |line| format!("line {line}: "));
        Remark::new(w.code, format!("{line}{}", w.message))
    });
    let warnings = warnings.collect();
    let made = source(
        file,
        stem.into_owned(),
        read.morphology,
        soma,
        warnings,
        written,
    )?;
    if made.generated.mesh.patches.is_empty() {
        return Err("nothing in it to mesh: check the file".into());
    }
    Ok(made)
}

/// The reason without the file's name, which stands beside it.
fn reason(file: &str, error: &formats::ReadError) -> String {
    let text = error.to_string();
    let rest = text.strip_prefix(file).unwrap_or(&text);
    rest.trim_start_matches([':', ' ']).to_owned()
}

fn source(
    file: &Path,
    name: String,
    morphology: Morphology,
    soma: SomaEdit,
    mut warnings: Vec<Remark>,
    written: Option<SystemTime>,
) -> Result<Source, String> {
    let generated = generate(&morphology, &soma.options()).map_err(|e| e.to_string())?;
    let made = generated.warnings.iter();
    warnings.extend(made.map(|w| Remark::new(w.code, w.to_string())));
    let (all, few_balls) = balls(&generated.mesh);
    Ok(Source {
        file: file.to_path_buf(),
        name,
        measures: Arc::new(Measures::of(&morphology)),
        sections: Arc::new(section_facts(&morphology)),
        balls: all,
        few_balls,
        morphology: Arc::new(morphology),
        generated: Arc::new(generated),
        soma,
        warnings,
        written,
        stale: None,
    })
}

fn section_facts(morphology: &Morphology) -> Vec<SectionFacts> {
    let lengths = shape::section_lengths(morphology);
    let orders = shape::branch_orders(morphology);
    let paths = shape::path_lengths(morphology);
    let neurites = shape::neurites(morphology);
    let facts = |i: usize| SectionFacts {
        length: lengths[i],
        order: orders[i],
        path: paths[i],
        neurite: neurites[i],
    };
    (0..neurites.len()).map(facts).collect()
}

/// What has become of a source's file.
pub fn stale(file: &Path, written: Option<SystemTime>) -> Option<Stale> {
    let written = written?;
    match fs::metadata(file).and_then(|m| m.modified()) {
        Ok(now) if now == written => None,
        Ok(_) => Some(Stale::Changed),
        Err(_) => Some(Stale::Gone),
    }
}

/// Corners of the box (µm) around balls.
pub fn extent(balls: &[BoundingSphere]) -> (DVec3, DVec3) {
    let corners = balls.iter().map(|&(c, r)| (c - r, c + r));
    corners
        .reduce(|(low, high), (a, b)| (low.min(a), high.max(b)))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_grown_and_missing_files_have_a_reason() {
        let star = load(&sample(Kind::Star), SomaEdit::default()).expect("grown");
        assert!(star.measures.n_sections > 10 && !star.balls.is_empty());
        assert_eq!(star.sections.len(), star.measures.n_sections);
        let error = load(Path::new("not/there.swc"), SomaEdit::default()).expect_err("missing");
        assert!(!error.contains("there.swc") && error.len() > 5, "{error}");
        assert!(load(Path::new("sample:nothing"), SomaEdit::default()).is_err());
    }

    #[test]
    fn folders_are_searched_and_empty_ones_told_of() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path();
        let wanted = Wanted {
            paths: vec![root.to_path_buf()],
            ..Wanted::default()
        };
        let empty = find(&wanted);
        assert_eq!((empty.files.len(), empty.failures.len()), (0, 1));
        for name in ["b.swc", "a.SWC", "note.txt", ".c.swc"] {
            fs::write(root.join(name), "1 1 0 0 0 5 -1\n").expect("written");
        }
        assert_eq!(find(&wanted).files.len(), 2);
    }

    #[test]
    fn a_changed_file_is_noticed() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.swc");
        fs::write(&file, "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n").expect("written");
        let source = load(&file, SomaEdit::default()).expect("read");
        assert_eq!(stale(&file, source.written), None);
        let later = SystemTime::now() + std::time::Duration::from_secs(5);
        fs::File::options()
            .write(true)
            .open(&file)
            .and_then(|f| f.set_modified(later))
            .expect("touched");
        assert_eq!(stale(&file, source.written), Some(Stale::Changed));
        fs::remove_file(&file).expect("removed");
        assert_eq!(stale(&file, source.written), Some(Stale::Gone));
    }
}
