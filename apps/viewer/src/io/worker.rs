//! The window's background work: reading, meshing, saving. Results come back as messages, and the
//! window is woken for each.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use neurotess::circuit::Circuit;

use crate::io::circuit_caches::CircuitCaches;
use crate::io::find::{self, Found, OpenRequest};
use crate::io::load;
use crate::io::markers;
use crate::io::meshes;
use crate::io::remesh::{self, MeshRequest};
use crate::io::task::{Progress, Task, caught};
use crate::model::document::{SomaEdit, SourceId};
use crate::model::ids::CircuitId;
use crate::model::markers::{MarkerContent, MarkerSource};
use crate::model::meshes::ReadMesh;
use crate::model::save::Written;
use crate::model::sources::{Meshed, Source, Stale};

/// A result of background work.
#[derive(Debug)]
pub(crate) enum Message {
    /// What was found of a request.
    Found(Box<Found>),
    /// A file that was read; the number is its index among the files that were found.
    Loaded(usize, Box<Result<Source, (PathBuf, String)>>),
    /// All files of a loading are read, or it was canceled.
    LoadingDone(Result<(), String>),
    /// What was wrong with a circuit's cache.
    Cache(String),
    /// A file that was read again.
    Reloaded(SourceId, Box<Result<Source, String>>),
    /// A cell that was meshed again with another soma or other spines.
    Meshed(MeshRequest, Box<Result<Meshed, String>>),
    /// Synapses or points that were read.
    Markers(MarkerSource, Box<Result<MarkerContent, String>>),
    /// A mesh that was read.
    Mesh(PathBuf, Box<Result<ReadMesh, String>>),
    /// Files that were changed or removed, or are as they were read.
    Files(Vec<(SourceId, Option<Stale>)>),
    /// Files are no longer watched, for this reason.
    NotWatched(String),
    /// Saving ended: with this message, or with an error.
    Saved(Result<Written, String>),
}

/// A file that is watched, and when it was last written.
pub(crate) type Watched = (SourceId, PathBuf, Option<SystemTime>);

/// Starts work and takes its results.
pub(crate) struct Worker {
    /// For messages that tasks send before they end.
    sender: Sender<Message>,
    receiver: Receiver<Message>,
    wake: Arc<dyn Fn() + Send + Sync>,
    loading: Option<Task<()>>,
    saving: Option<Task<Written>>,
    reloading: Vec<(SourceId, Task<Source>)>,
    remeshing: Option<(MeshRequest, Task<Meshed>)>,
    marking: Option<(MarkerSource, Task<MarkerContent>)>,
    reading_mesh: Option<(PathBuf, Task<ReadMesh>)>,
    watching: Option<Task<()>>,
    watched: Arc<Mutex<Vec<Watched>>>,
}

impl Worker {
    /// A worker without tasks. `wake` is called when there is a message.
    pub(crate) fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (sender, receiver) = channel();
        Self {
            sender,
            receiver,
            wake: Arc::new(wake),
            loading: None,
            saving: None,
            reloading: Vec::new(),
            remeshing: None,
            marking: None,
            reading_mesh: None,
            watching: None,
            watched: Arc::default(),
        }
    }

    /// Messages that have come.
    pub(crate) fn messages(&mut self) -> Vec<Message> {
        // Taken before the messages, since a task sends none after its end.
        let loaded = self.loading.as_ref().and_then(Task::take);
        let watched = self.watching.as_ref().and_then(Task::take);
        let mut messages: Vec<Message> = self.receiver.try_iter().collect();
        if let Some(result) = loaded {
            self.loading = None;
            messages.push(Message::LoadingDone(result));
        }
        if let Some(result) = watched {
            self.watching = None;
            messages.extend(result.err().map(Message::NotWatched));
        }
        if let Some(result) = self.saving.as_ref().and_then(Task::take) {
            self.saving = None;
            messages.push(Message::Saved(result));
        }
        self.reloading.retain(|(id, task)| match task.take() {
            Some(result) => {
                messages.push(Message::Reloaded(*id, Box::new(result)));
                false
            }
            None => true,
        });
        let remeshed = self.remeshing.as_ref().and_then(|(_, task)| task.take());
        if let Some(result) = remeshed
            && let Some((request, _)) = self.remeshing.take()
        {
            messages.push(Message::Meshed(request, Box::new(result)));
        }
        let read = self.marking.as_ref().and_then(|(_, task)| task.take());
        if let Some(result) = read
            && let Some((source, _)) = self.marking.take()
        {
            messages.push(Message::Markers(source, Box::new(result)));
        }
        let read = self.reading_mesh.as_ref().and_then(|(_, task)| task.take());
        if let Some(result) = read
            && let Some((file, _)) = self.reading_mesh.take()
        {
            messages.push(Message::Mesh(file, Box::new(result)));
        }
        messages
    }

    /// Whether a task is running whose result will come.
    pub(crate) fn is_busy(&self) -> bool {
        let beside = self.marking.is_some() || self.reading_mesh.is_some();
        let reads = self.loading.is_some() || beside;
        reads || self.saving.is_some() || self.remeshing.is_some()
    }

    /// Whether files are being written.
    pub(crate) fn is_saving(&self) -> bool {
        self.saving.is_some()
    }

    /// Progress of reading, of saving, and of reading synapses, points or meshes.
    pub(crate) fn progress(&self) -> [Option<Progress>; 3] {
        let reading = self.loading.as_ref().map(Task::progress);
        let saving = self.saving.as_ref().map(Task::progress);
        let marking = self.marking.as_ref().map(|(_, task)| task.progress());
        let meshes = self.reading_mesh.as_ref().map(|(_, task)| task.progress());
        let marking = marking.or(meshes);
        [reading, saving, marking].map(Option::<&Progress>::cloned)
    }

    fn start<T: Send + 'static>(
        &self,
        progress: Progress,
        work: impl FnOnce(&Progress) -> Result<T, String> + Send + 'static,
    ) -> Task<T> {
        let wake = Arc::clone(&self.wake);
        Task::start(progress, move || wake(), work)
    }

    /// A function by which a task sends messages before its end.
    fn message_sender(&self) -> impl Fn(Message) + Send + 'static {
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        move |message| {
            // If the window is closed, nothing receives it.
            let _ = sender.send(message);
            wake();
        }
    }

    /// Reads files, folders and circuits on all cores.
    pub(crate) fn load(&mut self, request: OpenRequest) {
        let send = self.message_sender();
        let task = self.start(Progress::new("reading", "files", 0), move |progress| {
            let found = find::find(&request);
            let files = found.files.clone();
            let caches = CircuitCaches::open(&found, &request);
            progress.all.store(files.len(), Ordering::Relaxed);
            send(Message::Found(Box::new(found)));
            let next = AtomicUsize::new(0);
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            let (sender, receiver) = channel();
            std::thread::scope(|scope| {
                for _ in 0..cores.min(files.len()) {
                    let (sender, next, files) = (sender.clone(), &next, &files);
                    let (somata, usual) = (&request.somata, &request.usual);
                    let caches = &caches;
                    scope.spawn(move || {
                        loop {
                            let index = next.fetch_add(1, Ordering::Relaxed);
                            let Some(file) = files.get(index).filter(|_| !progress.is_canceled())
                            else {
                                break;
                            };
                            let soma = somata.iter().find(|(path, _)| path == file);
                            let soma = soma.map_or(usual, |(_, soma)| soma).clone();
                            let loaded = caught(|| load::load(file, soma, caches.of_file(index)));
                            let loaded = loaded.map_err(|why| (file.clone(), why));
                            progress.done.fetch_add(1, Ordering::Relaxed);
                            let _ = sender.send((index, loaded));
                        }
                    });
                }
                drop(sender);
                // Results are passed on in the order of the files, so that the list is always the
                // same.
                let (mut early, mut next) = (BTreeMap::new(), 0);
                for (index, loaded) in receiver {
                    early.insert(index, loaded);
                    while let Some(loaded) = early.remove(&next) {
                        send(Message::Loaded(next, Box::new(loaded)));
                        next += 1;
                    }
                }
            });
            // Whoever cancels does not want to wait.
            if !progress.is_canceled() {
                caches.finish().for_each(|why| send(Message::Cache(why)));
            }
            Ok(())
        });
        self.loading = Some(task);
    }

    /// Reads a file again.
    pub(crate) fn reload(&mut self, id: SourceId, file: PathBuf, soma: SomaEdit) {
        let progress = Progress::new("reading", "files", 1);
        let task = self.start(progress, move |_| load::load(&file, soma, None));
        self.reloading.push((id, task));
    }

    /// Whether a cell is being meshed again.
    pub(crate) fn is_remeshing(&self) -> bool {
        self.remeshing.is_some()
    }

    /// Meshes a cell again, with another soma or other spines.
    pub(crate) fn remesh(&mut self, request: MeshRequest) {
        let of = request.clone();
        let task = self.start(Progress::new("meshing", "cells", 1), move |_| {
            remesh::remesh(&of)
        });
        self.remeshing = Some((request, task));
    }

    /// Whether synapses or points are being read.
    pub(crate) fn reads_markers(&self) -> bool {
        self.marking.is_some()
    }

    /// Reads synapses of circuits, or points.
    pub(crate) fn read_markers(
        &mut self,
        source: MarkerSource,
        circuits: Vec<(CircuitId, Arc<Circuit>)>,
    ) {
        let what = match &source {
            MarkerSource::Synapses(_) => "reading synapses",
            MarkerSource::Points(_) => "reading points",
        };
        let of = source.clone();
        let task = self.start(Progress::new(what, "populations", 0), move |progress| {
            markers::read(&of, &circuits, progress)
        });
        self.marking = Some((source, task));
    }

    /// Whether a mesh is being read.
    pub(crate) fn reads_mesh(&self) -> bool {
        self.reading_mesh.is_some()
    }

    /// Reads a mesh.
    pub(crate) fn read_mesh(&mut self, file: PathBuf) {
        let of = file.clone();
        let progress = Progress::new("reading a mesh", "files", 1);
        let task = self.start(progress, move |_| meshes::read(&of));
        self.reading_mesh = Some((file, task));
    }

    /// Drops the mesh that is being read.
    pub(crate) fn stop_mesh(&mut self) {
        self.reading_mesh = None;
    }

    /// Stops reading synapses or points at once; a file that is just being read is read to its end, and
    /// its content dropped. Returns what was being read.
    pub(crate) fn stop_markers(&mut self) -> Option<MarkerSource> {
        let (source, task) = self.marking.take()?;
        task.progress().cancel();
        Some(source)
    }

    /// Starts saving; `work` reports its progress, and stops if it was canceled.
    pub(crate) fn save(
        &mut self,
        progress: Progress,
        work: impl FnOnce(&Progress) -> Result<Written, String> + Send + 'static,
    ) {
        self.saving = Some(self.start(progress, work));
    }

    /// Watches these files from now on: checks them every two seconds, on a thread of its own.
    pub(crate) fn watch(&mut self, files: Vec<Watched>) {
        let any = !files.is_empty();
        *self.watched.lock().unwrap_or_else(PoisonError::into_inner) = files;
        if !any || self.watching.is_some() {
            return;
        }
        let (watched, send) = (Arc::downgrade(&self.watched), self.message_sender());
        let task = self.start(Progress::new("watching", "files", 0), move |progress| {
            let mut known: Vec<(SourceId, Option<Stale>)> = Vec::new();
            loop {
                for _ in 0..20 {
                    std::thread::sleep(Duration::from_millis(100));
                    if progress.is_canceled() {
                        return Ok(());
                    }
                }
                // The window was closed, or all files were.
                let Some(watched) = watched.upgrade() else {
                    return Ok(());
                };
                let files = watched
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .clone();
                if files.is_empty() {
                    return Ok(());
                }
                let now: Vec<_> = files
                    .iter()
                    .map(|(id, file, written)| (*id, load::stale(file, *written)))
                    .collect();
                if now != known && (now.iter().any(|(_, s)| s.is_some()) || !known.is_empty()) {
                    send(Message::Files(now.clone()));
                }
                known = now;
            }
        });
        self.watching = Some(task);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::settings::Settings;
    use crate::model::state::State;

    /// All messages of opening a circuit.
    fn opened(circuit: &std::path::Path, without_caches: bool) -> Vec<Message> {
        let mut worker = Worker::new(|| {});
        worker.load(OpenRequest {
            paths: vec![circuit.to_path_buf()],
            without_caches,
            ..OpenRequest::default()
        });
        let mut messages = Vec::new();
        while worker.is_busy() {
            messages.extend(worker.messages());
            std::thread::yield_now();
        }
        messages
    }

    /// The source of the only cell, and what was wrong with the cache.
    fn of_one_cell(messages: Vec<Message>) -> (Source, Vec<String>) {
        let (mut source, mut wrong) = (None, Vec::new());
        for message in messages {
            match message {
                Message::Loaded(_, loaded) => source = (*loaded).ok(),
                Message::Cache(why) => wrong.push(why),
                _ => {}
            }
        }
        (source.expect("read"), wrong)
    }

    #[test]
    fn cells_of_circuits_come_from_their_cache_and_are_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        let (cell, circuit) = (
            folder.path().join("a.swc"),
            folder.path().join("few.scene.toml"),
        );
        std::fs::write(&cell, "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n").expect("written");
        std::fs::write(&circuit, "[[cells]]\nfile = \"a.swc\"\n").expect("written");
        let (without, _) = of_one_cell(opened(&circuit, true));
        assert!(without.proxy.is_none());
        let (with, wrong) = of_one_cell(opened(&circuit, false));
        assert!(with.proxy.is_some() && wrong.is_empty());
        assert_eq!(with.generated.mesh, without.generated.mesh);
        // A file of so few points was not left behind; one that is there is damaged, and replaced.
        let file = folder.path().join("few.scene.ntcache");
        assert!(!file.exists());
        std::fs::write(&file, "neurotess cache").expect("written");
        let (damaged, wrong) = of_one_cell(opened(&circuit, false));
        assert_eq!(damaged.generated.mesh, without.generated.mesh);
        let [why] = &wrong[..] else {
            panic!("{wrong:?}");
        };
        assert!(why.contains("few.scene.ntcache"), "{why}");
        let (again, wrong) = of_one_cell(opened(&circuit, false));
        assert!(wrong.is_empty());
        assert_eq!(again.generated.mesh, without.generated.mesh);
        let spheres = |source: &Source| source.proxy.as_ref().map(|proxy| proxy.spheres());
        assert_eq!(spheres(&again), spheres(&with));
    }

    #[test]
    fn a_task_that_panics_shows_its_text_as_a_problem() {
        let mut worker = Worker::new(|| {});
        worker.save(Progress::new("writing", "files", 1), |_| {
            panic!("patch {} has no corner", 5)
        });
        let message = loop {
            if let Some(message) = worker.messages().pop() {
                break message;
            }
            std::thread::yield_now();
        };
        assert!(!worker.is_busy());
        let mut state = State::new(Settings::default());
        let Message::Saved(result) = message else {
            panic!("{message:?}");
        };
        state.note_saved(result);
        let [problem] = &state.messages.problems[..] else {
            panic!("{:?}", state.messages.problems);
        };
        assert_eq!(problem.what, "save");
        assert!(problem.why.contains("patch 5 has no corner"), "{problem:?}");
        assert!(
            state.messages.status.starts_with("Not saved"),
            "{}",
            state.messages.status
        );
    }
}
