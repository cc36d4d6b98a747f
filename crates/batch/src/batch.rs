//! A batch as it is asked for.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use neurotess_formats::ReadOptions;
use neurotess_mesh::Format;
use neurotess_output::Existing;
use neurotess_recipe::{FileOptions, MeshOptions};

use crate::error::BatchError;
use crate::event::{BatchReport, Event};
use crate::inputs::{Inputs, NotFound};
use crate::key::Key;
use crate::options::CellOptions;
use crate::plan::{Cell, Plan};
use crate::record::OutputRecord;
use crate::shard::Shard;
use crate::tables::Tables;
use crate::targets;
use crate::tracing::MORPHOLOGIES;

/// Many tracings, or the cells of a circuit, which are meshed into a folder.
///
/// ```
/// use neurotess_batch::{Batch, Event, Outcome};
/// use neurotess_recipe::MeshOptions;
///
/// # let cells = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/g*.swc");
/// # let folder = std::env::temp_dir().join(format!("neurotess-batch-{}", std::process::id()));
/// let batch = Batch::new([cells])
///     .options(MeshOptions::default().with_level(1))
///     .into(&folder)
///     .resume(true);
/// let report = batch.clone().run(|event| {
///     if let Event::Ended(Outcome::Failed(error)) = event {
///         eprintln!("{error}");
///     }
/// })?;
/// assert!(report.is_complete() && report.done().count() == 1);
/// // It is up to date now.
/// assert_eq!(batch.run(|_| {})?.kept(), 1);
/// # std::fs::remove_dir_all(folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "it does nothing until it runs"]
pub struct Batch {
    source: Source,
    out: Option<Out>,
    cell: CellOptions,
    resume: bool,
    shard: Option<Shard>,
    workers: Option<usize>,
}

/// What is meshed.
#[derive(Clone, Debug)]
enum Source {
    Files(Inputs),
    #[cfg(feature = "circuit")]
    Circuit(
        Arc<neurotess_circuit::Circuit>,
        Vec<neurotess_circuit::Instance>,
    ),
}

/// Where meshes go.
#[derive(Clone, Debug)]
enum Out {
    Folder(PathBuf),
    /// As OUT of the command: a file for a single input.
    FileOrFolder(PathBuf),
}

impl Batch {
    /// Files, folders (which are searched recursively) and globs; `-` is standard input. They are searched now.
    pub fn new<P: Into<PathBuf>>(inputs: impl IntoIterator<Item = P>) -> Self {
        let inputs: Vec<PathBuf> = inputs.into_iter().map(Into::into).collect();
        Self::of(Inputs::find(&inputs, &MORPHOLOGIES))
    }

    /// Files that were found.
    pub fn of(inputs: Inputs) -> Self {
        Self::with(Source::Files(inputs))
    }

    /// Cells of a circuit, each in the circuit's coordinates. A morphology that several have is meshed once.
    #[cfg(feature = "circuit")]
    pub fn of_circuit(
        circuit: Arc<neurotess_circuit::Circuit>,
        instances: Vec<neurotess_circuit::Instance>,
    ) -> Self {
        Self::with(Source::Circuit(circuit, instances))
    }

    fn with(source: Source) -> Self {
        Self {
            source,
            out: None,
            cell: CellOptions {
                read: ReadOptions::default(),
                mesh: MeshOptions::default(),
                files: FileOptions::new(Format::Ply),
                tables: Tables::default(),
                existing: Existing::Refuse("resume the batch, or let it replace files"),
                measures: false,
                stopped: Arc::default(),
            },
            resume: false,
            shard: None,
            workers: None,
        }
    }

    /// How cells are meshed.
    pub fn options(mut self, options: MeshOptions) -> Self {
        self.cell.mesh = options;
        self
    }

    /// How tracings are read.
    pub fn read(mut self, options: ReadOptions) -> Self {
        self.cell.read = options;
        self
    }

    /// How meshes go into files; PLY in µm unless something else is said.
    pub fn files(mut self, options: FileOptions) -> Self {
        self.cell.files = options;
        self
    }

    /// The folder that meshes go into. It repeats the structure below the input's folder, so that files of one name in
    /// different folders do not collide.
    pub fn into(mut self, folder: impl Into<PathBuf>) -> Self {
        self.out = Some(Out::Folder(folder.into()));
        self
    }

    /// As OUT of `neurotess mesh`: a file for a single input, `-` for standard output; a folder for several.
    pub fn into_file_or_folder(mut self, out: impl Into<PathBuf>) -> Self {
        self.out = Some(Out::FileOrFolder(out.into()));
        self
    }

    /// Tables beside the mesh of a single cell.
    pub fn tables(mut self, tables: Tables) -> Self {
        self.cell.tables = tables;
        self
    }

    /// What becomes of files that are there; an error unless something else is said.
    pub fn existing(mut self, existing: Existing) -> Self {
        self.cell.existing = existing;
        self
    }

    /// Whether a file is left alone that is up to date: made from the same inputs with the same options, by a build that
    /// makes the same meshes. Others that are recorded in the folder's `.neurotess-made` are replaced. Several batches, of
    /// several processes, may then share a folder.
    pub fn resume(mut self, resume: bool) -> Self {
        self.resume = resume;
        self
    }

    /// Only a part of the cells, for one of many machines.
    pub fn shard(mut self, shard: Shard) -> Self {
        self.shard = Some(shard);
        self
    }

    /// Threads, each of which has one cell in memory; where there are fewer cells, a cell has several. All cores unless
    /// something else is said. Meshes are the same for any number.
    pub fn workers(mut self, workers: usize) -> Self {
        self.workers = Some(workers);
        self
    }

    /// Whether volume and area of each mesh are in its report, which takes a pass over the surface.
    pub fn measures(mut self, measures: bool) -> Self {
        self.cell.measures = measures;
        self
    }

    /// Cells end soon after another thread sets this, without a file; the rest is not begun.
    pub fn stopped_by(mut self, stopped: Arc<AtomicBool>) -> Self {
        self.cell.stopped = stopped;
        self
    }

    /// Which files are made, and which are up to date.
    ///
    /// # Errors
    /// No folder was given, options do not fit together, or inputs cannot become the files that are asked for.
    pub fn plan(self) -> Result<Plan, BatchError> {
        let Self {
            source,
            out,
            cell,
            resume,
            shard,
            workers,
        } = self;
        let out = out.ok_or(BatchError::NoFolder)?;
        cell.mesh.check()?;
        cell.files.check(&cell.mesh)?;
        let extension = cell.files.format.extension();
        let (mut cells, folder) = source.cells(&out, extension)?;
        if let Some(shard) = shard {
            cells = shard.of(cells);
        }
        let record_folder = match folder {
            true => out.path(),
            false => out.path().parent().unwrap_or(Path::new("")),
        };
        let record = OutputRecord::open(record_folder, Key::new(&cell.mesh, &cell.files)?);
        let mut plan = Plan::new(cell, cells, record, resume);
        // For a single file there is no record beside it, unless a later run needs one.
        plan.records = resume || folder;
        plan.threads = workers.unwrap_or_else(cores);
        plan.not_found = source.not_found();
        Ok(plan)
    }

    /// Meshes all cells, and tells what happens, by any thread. One that fails is an outcome, and the others go on. A file
    /// is there whole or not at all.
    ///
    /// # Errors
    /// As [`plan`](Self::plan), or there are no threads to be had.
    pub fn run(self, tell: impl Fn(Event<'_>) + Sync) -> Result<BatchReport, BatchError> {
        let plan = self.plan()?;
        tell(Event::Planned(&plan));
        plan.run(tell)
    }
}

impl Source {
    /// Inputs without any file.
    fn not_found(self) -> Vec<NotFound> {
        match self {
            Self::Files(inputs) => inputs.not_found,
            #[cfg(feature = "circuit")]
            Self::Circuit(..) => Vec::new(),
        }
    }

    /// The cells, each with its file, and whether that is in a folder of them.
    fn cells(&self, out: &Out, extension: &str) -> Result<(Vec<Cell>, bool), BatchError> {
        match self {
            Self::Files(inputs) => {
                let whole;
                let inputs = match out {
                    Out::FileOrFolder(_) => inputs,
                    Out::Folder(_) => {
                        whole = Inputs {
                            one_file: false,
                            ..inputs.clone()
                        };
                        &whole
                    }
                };
                let jobs = targets::plan(inputs, out.path(), extension)?;
                let cell = |(template, job)| Cell {
                    job,
                    template,
                    node: None,
                    place: None,
                };
                let cells = jobs.into_iter().enumerate().map(cell).collect();
                Ok((cells, targets::is_folder(out.path(), inputs)))
            }
            #[cfg(feature = "circuit")]
            Self::Circuit(circuit, instances) => {
                let folder = out.path();
                if folder.is_file() {
                    return Err(targets::TargetError::NotAFolder(folder.to_path_buf()).into());
                }
                let cells = crate::circuit::cells(circuit, instances, folder, extension);
                Ok((cells, true))
            }
        }
    }
}

impl Out {
    fn path(&self) -> &Path {
        match self {
            Self::Folder(path) | Self::FileOrFolder(path) => path,
        }
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
