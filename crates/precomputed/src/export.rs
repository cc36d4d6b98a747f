//! A folder of precomputed data as it is asked for.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use neurotess_batch::{Inputs, MORPHOLOGIES, Shard};
use neurotess_circuit::{Edges, Groups};
use neurotess_mesh::palette::Palette;
use neurotess_mesh::palette::Rgb;

use crate::error::ExportError;
use crate::event::{Event, ExportReport};
use crate::folder::{Before, Folder};
use crate::levels::LevelOptions;
use crate::plan::{self, units};
use crate::run::Run;
use crate::shards::Sharding;
use crate::source::Source;
use crate::synapses;
use crate::view::link_to;

/// Most levels.
const MOST_LEVELS: usize = 12;

/// Where the folder is found unless something else is said: [`serve`](crate::Server) serves it there.
pub const LOCAL_URL: &str = "http://127.0.0.1:9000";

/// Tracings, or the cells of a circuit, as a folder that neuroglancer opens.
///
/// ```
/// use neurotess_precomputed::Export;
///
/// # let cells = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/granule.swc");
/// # let folder = tempfile::tempdir()?;
/// # let folder = folder.path().join("cells");
/// let report = Export::new([cells]).into(&folder).run(|_| ())?;
/// assert_eq!((report.written, report.failures.len()), (1, 0));
/// assert!(folder.join("mesh/1.index").is_file());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Export {
    source: Source,
    out: Option<PathBuf>,
    levels: LevelOptions,
    sharded: bool,
    before: Before,
    part: Option<Shard>,
    workers: Option<usize>,
    url: String,
    color_by: String,
    synapses: Vec<Edges>,
    stopped: Arc<AtomicBool>,
}

impl Export {
    /// Files, folders (which are searched recursively) and globs. They are searched now.
    pub fn new<P: Into<PathBuf>>(inputs: impl IntoIterator<Item = P>) -> Self {
        let inputs: Vec<PathBuf> = inputs.into_iter().map(Into::into).collect();
        Self::of(Inputs::find(&inputs, &MORPHOLOGIES))
    }

    /// Files that were found.
    pub fn of(inputs: Inputs) -> Self {
        Self::with(Source::Files(inputs))
    }

    /// Cells of a circuit, each in the circuit's coordinates. A morphology that several have is meshed once.
    pub fn of_circuit(
        circuit: Arc<neurotess_circuit::Circuit>,
        instances: Vec<neurotess_circuit::Instance>,
    ) -> Self {
        Self::with(Source::Circuit(circuit, Arc::new(instances)))
    }

    fn with(source: Source) -> Self {
        Self {
            source,
            out: None,
            levels: LevelOptions::default(),
            sharded: false,
            before: Before::Refuse,
            part: None,
            workers: None,
            url: LOCAL_URL.to_owned(),
            color_by: "population".to_owned(),
            synapses: Vec::new(),
            stopped: Arc::default(),
        }
    }

    /// The folder that is written.
    pub fn into(mut self, folder: impl Into<PathBuf>) -> Self {
        self.out = Some(folder.into());
        self
    }

    /// Which levels of detail meshes have.
    pub fn levels(mut self, levels: LevelOptions) -> Self {
        self.levels = levels;
        self
    }

    /// Whether many cells are in a file: for circuits, of which a million cells are in four thousand files.
    pub fn sharded(mut self, sharded: bool) -> Self {
        self.sharded = sharded;
        self
    }

    /// Whether a folder that was begun before, of the same cells and with the same options, is finished.
    pub fn resume(mut self, resume: bool) -> Self {
        self.before = if resume { Before::Keep } else { Before::Refuse };
        self
    }

    /// Whether a folder that is there is written anew.
    pub fn replace(mut self, replace: bool) -> Self {
        self.before = if replace {
            Before::Replace
        } else {
            self.before
        };
        self
    }

    /// Only a part of the cells, by whole shards, for one of many machines. The first part also writes what all share. Parts
    /// share a folder, so each resumes it.
    pub fn part(mut self, part: Shard) -> Self {
        self.part = Some(part);
        self.before = Before::Keep;
        self
    }

    /// Threads, each of which has a few cells in memory. All cores unless something else is said. Files are the same for any
    /// number.
    pub fn workers(mut self, workers: usize) -> Self {
        self.workers = Some(workers);
        self
    }

    /// Where browsers find the folder; [`LOCAL_URL`] unless something else is said.
    pub fn url(mut self, url: impl Into<String>) -> Self {
        self.url = url.into();
        self
    }

    /// The attribute of a circuit's nodes that colors cells: their population unless something else is said.
    pub fn color_by(mut self, attribute: impl Into<String>) -> Self {
        self.color_by = attribute.into();
        self
    }

    /// Connections of the circuit whose synapses become annotations, those that have an end among the cells. They are in
    /// memory, with all of their numbers.
    pub fn synapses(mut self, edges: impl IntoIterator<Item = Edges>) -> Self {
        self.synapses = edges.into_iter().collect();
        self
    }

    /// Ends soon after another thread sets this, without files of cells that are not whole.
    pub fn stopped_by(mut self, stopped: Arc<AtomicBool>) -> Self {
        self.stopped = stopped;
        self
    }

    /// Writes the folder, and tells what happens, by any thread. A tracing that cannot be meshed is a failure in the report,
    /// and the others go on.
    ///
    /// # Errors
    /// No folder was given, options are wrong, no tracing can be read, the folder has other files or those of other cells, or
    /// what all cells share cannot be written.
    pub fn run(self, tell: impl Fn(Event<'_>) + Sync) -> Result<ExportReport, ExportError> {
        let out = self.out.as_deref().ok_or(ExportError::NoFolder)?;
        let LevelOptions { max_error, count } = self.levels;
        if !(max_error > 0.0 && max_error.is_finite() && (1..=MOST_LEVELS).contains(&count)) {
            return Err(ExportError::Levels);
        }
        if self.source.len() == 0 {
            return Err(ExportError::Empty);
        }
        let ids = self.source.ids()?;
        self.check_color()?;
        self.source.check(out)?;
        let sharding = self.sharded.then(|| Sharding::for_count(ids.len()));
        let folder = Folder::new(out, sharding);
        let text = plan::text(&self.source, &ids, self.levels, sharding);
        folder.begin(&text, self.before)?;
        let run = Run {
            source: &self.source,
            ids: &ids,
            folder: &folder,
            sharding,
            levels: self.levels,
            threads: self.workers.unwrap_or_else(cores),
            stopped: &self.stopped,
            tell: &tell,
        };
        let mut report = ExportReport::default();
        if self.part.is_none_or(Shard::is_first) {
            self.write_shared(&run, &mut report)?;
        }
        run.cells(&units(&ids, sharding, self.part), &mut report)?;
        if let Source::Files(inputs) = &self.source {
            report.not_found.clone_from(&inputs.not_found);
        }
        Ok(report)
    }

    /// Refuses an attribute that no node has.
    fn check_color(&self) -> Result<(), ExportError> {
        let Source::Circuit(circuit, _) = &self.source else {
            return Ok(());
        };
        let all = circuit
            .populations
            .iter()
            .flat_map(|of| of.attributes.keys());
        let mut there: Vec<String> = all.cloned().chain(["population".to_owned()]).collect();
        if there.contains(&self.color_by) {
            return Ok(());
        }
        there.sort_unstable();
        there.dedup();
        let name = self.color_by.clone();
        Err(ExportError::NoAttribute { name, there })
    }

    /// Writes what all cells share.
    fn write_shared(&self, run: &Run<'_>, report: &mut ExportReport) -> Result<(), ExportError> {
        let facts = run.facts()?;
        let table = run.table(&facts);
        run.infos(&table)?;
        if let Source::Circuit(circuit, instances) = &self.source {
            let (folder, ids) = (run.folder, run.ids);
            report.synapses = synapses::write(folder, circuit, instances, ids, &self.synapses)?;
        }
        let view = run.view(&table, &self.url, &*self.colors(), report.synapses > 0)?;
        report.link = link_to(&view.state());
        Ok(())
    }

    /// Colors of cells by groups of a circuit, if there are several; else neuroglancer gives each cell its own.
    fn colors(&self) -> Box<dyn Fn(usize) -> Option<Rgb>> {
        if let Source::Circuit(circuit, instances) = &self.source {
            let groups = Groups::by(&circuit.populations, &self.color_by);
            let instances = Arc::clone(instances);
            return Box::new(move |cell| {
                let group = groups.of(instances[cell].node) as usize;
                (groups.texts.len() > 1).then(|| Palette::default().distinct(group))
            });
        }
        Box::new(|_| None)
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
