//! Cells are made and written, by several workers, each of which writes one file of many cells, or the files of one.

use std::collections::BTreeSet;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use neurotess_batch::workers::{self, guarded};
use neurotess_mesh::draco::DracoError;
use neurotess_output::OutputError;
use neurotess_recipe::MeshError;

use crate::error::{ExportError, Failure, Fault};
use crate::event::{CellDone, Event, ExportReport};
use crate::facts::soma_center;
use crate::folder::Folder;
use crate::levels::LevelOptions;
use crate::multilod::{MultilodMesh, multilod};
use crate::plan::Unit;
use crate::shards::{ShardWriter, Sharding};
use crate::skeleton::skeleton;
use crate::source::Source;
use crate::templates::Templates;

/// The work on a folder.
pub(crate) struct Run<'r> {
    pub(crate) source: &'r Source,
    pub(crate) ids: &'r [u64],
    pub(crate) folder: &'r Folder,
    pub(crate) sharding: Option<Sharding>,
    pub(crate) levels: LevelOptions,
    pub(crate) threads: usize,
    pub(crate) stopped: &'r AtomicBool,
    pub(crate) tell: &'r (dyn Fn(Event<'_>) + Sync),
}

/// A cell as its files hold it.
struct Encoded {
    mesh: MultilodMesh,
    skeleton: Vec<u8>,
}

/// What has been done so far.
#[derive(Default)]
struct Done {
    report: ExportReport,
    /// Tracings of which it is told that they failed.
    failed: BTreeSet<usize>,
}

impl Run<'_> {
    /// Whether another thread has ended it.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Writes the files that are not there.
    pub(crate) fn cells(
        &self,
        units: &[Unit],
        report: &mut ExportReport,
    ) -> Result<(), ExportError> {
        let (kept, to_do): (Vec<&Unit>, Vec<&Unit>) =
            units.iter().partition(|unit| self.folder.has(unit.files));
        let cells = |units: &[&Unit]| units.iter().map(|unit| unit.cells.len()).sum::<usize>();
        report.kept = cells(&kept);
        (self.tell)(Event::Planned {
            to_do: cells(&to_do),
            kept: report.kept,
        });
        let templates = Templates::new(self.source, self.levels, self.stopped, self.tell);
        let done = Mutex::new(Done::default());
        let order: Vec<usize> = (0..to_do.len()).collect();
        let results = workers::run(&to_do, &order, self.threads, |unit| {
            self.unit(unit, &templates, &done)
        })?;
        let Done { report: made, .. } = done.into_inner().unwrap_or_else(PoisonError::into_inner);
        for (unit, result) in to_do.iter().zip(results) {
            let fault = match result {
                Ok(Ok(())) => continue,
                Ok(Err(error)) => Fault::Output(error),
                Err(panic) => Fault::Bug(panic),
            };
            let failure = Failure {
                file: self.folder.files(unit.files).swap_remove(0),
                cells: unit.cells.len(),
                fault: Arc::new(fault),
            };
            (self.tell)(Event::Failed(&failure));
            report.failures.push(failure);
        }
        report.failures.extend(made.failures);
        report.written = made.written;
        report.triangles = made.triangles;
        report.bytes = made.bytes;
        report.warnings = templates.warnings();
        report.stopped = self.is_stopped();
        Ok(())
    }

    fn unit(
        &self,
        unit: &Unit,
        templates: &Templates<'_>,
        done: &Mutex<Done>,
    ) -> Result<(), OutputError> {
        let files = self.folder.files(unit.files);
        match self.sharding {
            Some(sharding) => self.shard(&unit.cells, &files, sharding, templates, done),
            None => self.one(unit.cells[0], &files, templates, done),
        }
    }

    /// Writes a cell into files of its own: fragments, then the manifest that names them, then the skeleton.
    fn one(
        &self,
        cell: usize,
        files: &[PathBuf],
        templates: &Templates<'_>,
        done: &Mutex<Done>,
    ) -> Result<(), OutputError> {
        let Some(encoded) = self.encoded(cell, templates, done) else {
            return Ok(());
        };
        let Encoded { mesh, skeleton } = &encoded;
        let parts = [&mesh.fragments, &mesh.manifest, skeleton];
        for (path, bytes) in files.iter().zip(parts) {
            Folder::write(path, bytes)?;
        }
        let bytes = parts.iter().map(|part| part.len() as u64).sum();
        self.count(cell, &encoded, bytes, done);
        Ok(())
    }

    /// Writes the cells of a shard, one after the other, into a file of meshes and one of skeletons.
    fn shard(
        &self,
        cells: &[usize],
        files: &[PathBuf],
        sharding: Sharding,
        templates: &Templates<'_>,
        done: &Mutex<Done>,
    ) -> Result<(), OutputError> {
        let [of_meshes, of_skeletons] = files else {
            return Ok(());
        };
        let mut mesh_output = Folder::output(of_meshes)?;
        let mut skeleton_output = Folder::output(of_skeletons)?;
        let begin = |file| ShardWriter::begin(BufWriter::new(file), sharding);
        let broken = |path: &Path| {
            let path = path.to_path_buf();
            move |error| OutputError::broken(&path, error)
        };
        let mut meshes = begin(mesh_output.file()).map_err(broken(of_meshes))?;
        let mut skeletons = begin(skeleton_output.file()).map_err(broken(of_skeletons))?;
        for &cell in cells {
            if self.is_stopped() {
                return Ok(());
            }
            let Some(encoded) = self.encoded(cell, templates, done) else {
                continue;
            };
            let Encoded { mesh, skeleton } = &encoded;
            let id = self.ids[cell];
            let added = meshes.add(id, &mesh.fragments, &mesh.manifest);
            let mut bytes = added.map_err(broken(of_meshes))?;
            let added = skeletons.add(id, &[], skeleton);
            bytes += added.map_err(broken(of_skeletons))?;
            self.count(cell, &encoded, bytes, done);
        }
        meshes.finish().map_err(broken(of_meshes))?;
        skeletons.finish().map_err(broken(of_skeletons))?;
        if self.is_stopped() {
            return Ok(());
        }
        mesh_output.finish()?;
        skeleton_output.finish()
    }

    /// A cell at its place; none if its tracing failed, of which it is told once, or if the work was ended.
    fn encoded(
        &self,
        cell: usize,
        templates: &Templates<'_>,
        done: &Mutex<Done>,
    ) -> Option<Encoded> {
        if self.is_stopped() {
            return None;
        }
        let template = self.source.template(cell);
        let made = guarded(|| {
            let mesh = templates.get(template);
            let mesh = mesh.as_ref().as_ref().map_err(Arc::clone)?;
            let place = self.source.placement(cell, soma_center(&mesh.morphology));
            let encode = || -> Result<Encoded, DracoError> {
                Ok(Encoded {
                    mesh: multilod(&mesh.placed(place))?,
                    skeleton: skeleton(&mesh.morphology, place),
                })
            };
            encode().map_err(|error| Arc::new(Fault::from(error)))
        });
        let fault = match made {
            Ok(Ok(encoded)) => return Some(encoded),
            Ok(Err(fault)) => fault,
            Err(panic) => Arc::new(Fault::Bug(panic)),
        };
        if matches!(*fault, Fault::Mesh(MeshError::Stopped)) {
            return None;
        }
        let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
        if done.failed.insert(template) {
            let uses = (0..self.source.len()).filter(|&c| self.source.template(c) == template);
            let failure = Failure {
                file: self.source.file(template).to_path_buf(),
                cells: uses.count(),
                fault,
            };
            (self.tell)(Event::Failed(&failure));
            done.report.failures.push(failure);
        }
        None
    }

    fn count(&self, cell: usize, encoded: &Encoded, bytes: u64, done: &Mutex<Done>) {
        let told = CellDone {
            label: self.source.label(cell),
            id: self.ids[cell],
            triangles: encoded.mesh.triangles,
            bytes,
        };
        (self.tell)(Event::Written(&told));
        let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
        done.report.written += 1;
        done.report.triangles += told.triangles as u64;
        done.report.bytes += bytes;
    }
}
