//! Work beside the window: reading, meshing, saving. Results come back as messages; the window is told
//! that there is one.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use neurotess::generate::{Generated, generate};
use neurotess::morphology::Morphology;

use crate::io::find::{self, Found, OpenRequest};
use crate::io::load;
use crate::model::document::{SomaEdit, SourceId};
use crate::model::sources::{Source, Stale};

/// What work gives.
#[derive(Debug)]
pub(crate) enum Message {
    /// What was found of what was asked for.
    Found(Box<Found>),
    /// A file that was read; the number is its place among those found of that loading.
    Loaded(usize, Box<Result<Source, (PathBuf, String)>>),
    /// All files of a loading are read, or it was canceled.
    LoadingDone,
    /// A file that was read again.
    Reloaded(SourceId, Box<Result<Source, String>>),
    /// A soma that was made again.
    Soma(SourceId, SomaEdit, Box<Generated>),
    /// What has become of files.
    Files(Vec<(SourceId, Option<Stale>)>),
    /// A job of saving ended: what to say, or what went wrong.
    Saved(Result<String, String>),
}

/// How far a job is.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    /// What it does.
    pub(crate) what: String,
    /// What its steps are, as in `tiles`.
    pub(crate) steps: &'static str,
    /// Steps done.
    pub(crate) done: Arc<AtomicUsize>,
    /// All steps, 0 where that is not known yet.
    pub(crate) all: Arc<AtomicUsize>,
    /// Set to end it.
    pub(crate) canceled: Arc<AtomicBool>,
}

impl Job {
    pub(crate) fn new(what: &str, steps: &'static str, all: usize) -> Self {
        Self {
            what: what.to_owned(),
            steps,
            done: Arc::default(),
            all: Arc::new(AtomicUsize::new(all)),
            canceled: Arc::default(),
        }
    }

    /// Whether it should end.
    pub(crate) fn is_canceled(&self) -> bool {
        self.canceled.load(Ordering::Relaxed)
    }

    /// What it does and how far it is, for people.
    pub(crate) fn said(&self) -> String {
        let (what, steps) = (&self.what, self.steps);
        match [&self.done, &self.all].map(|n| n.load(Ordering::Relaxed)) {
            [_, 0 | 1] => what.clone(),
            [done, all] => format!("{what}: {done} of {all} {steps}"),
        }
    }

    /// Share done, 0 to 1.
    pub(crate) fn share(&self) -> f32 {
        let all = self.all.load(Ordering::Relaxed).max(1);
        self.done.load(Ordering::Relaxed) as f32 / all as f32
    }
}

/// A file that is looked after, and when it was written last.
pub(crate) type Watched = (SourceId, PathBuf, Option<SystemTime>);

/// Starts work and takes its results.
pub(crate) struct Worker {
    sender: Sender<Message>,
    receiver: Receiver<Message>,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// Loading under way.
    pub(crate) loading: Option<Job>,
    /// Saving under way.
    pub(crate) saving: Option<Job>,
    watching: Arc<Mutex<Vec<Watched>>>,
    somata: usize,
}

impl Worker {
    /// `wake` is called when there is a message.
    pub(crate) fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (sender, receiver) = channel();
        Self {
            sender,
            receiver,
            wake: Arc::new(wake),
            loading: None,
            saving: None,
            watching: Arc::default(),
            somata: 0,
        }
    }

    /// Messages that have come.
    pub(crate) fn messages(&mut self) -> Vec<Message> {
        let messages: Vec<Message> = self.receiver.try_iter().collect();
        for message in &messages {
            match message {
                Message::LoadingDone => self.loading = None,
                Message::Saved(_) => self.saving = None,
                Message::Soma(..) => self.somata -= 1,
                _ => {}
            }
        }
        messages
    }

    /// Whether anything is under way whose result will come.
    pub(crate) fn is_busy(&self) -> bool {
        self.loading.is_some() || self.saving.is_some() || self.somata > 0
    }

    fn start(&self, work: impl FnOnce(&dyn Fn(Message)) + Send + 'static) {
        let (sender, wake) = (self.sender.clone(), Arc::clone(&self.wake));
        std::thread::spawn(move || {
            let send = |message| {
                // Nobody listens any more: the window is closed.
                let _ = sender.send(message);
                wake();
            };
            work(&send);
        });
    }

    /// Reads files, folders and circuits on all cores.
    pub(crate) fn load(&mut self, wanted: OpenRequest) {
        let job = Job::new("reading", "files", 0);
        self.loading = Some(job.clone());
        self.start(move |send| {
            let found = find::find(&wanted);
            let files = found.files.clone();
            job.all.store(files.len(), Ordering::Relaxed);
            send(Message::Found(Box::new(found)));
            let next = AtomicUsize::new(0);
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            let (sender, receiver) = channel();
            std::thread::scope(|scope| {
                for _ in 0..cores.min(files.len()) {
                    let (sender, next, files, job) = (sender.clone(), &next, &files, &job);
                    let (somata, usual) = (&wanted.somata, &wanted.usual);
                    scope.spawn(move || {
                        loop {
                            let index = next.fetch_add(1, Ordering::Relaxed);
                            let Some(file) = files.get(index).filter(|_| !job.is_canceled()) else {
                                break;
                            };
                            let soma = somata.iter().find(|(path, _)| path == file);
                            let soma = soma.map_or(usual, |(_, soma)| soma).clone();
                            let loaded = guarded(|| load::load(file, soma));
                            let loaded = loaded.map_err(|why| (file.clone(), why));
                            job.done.fetch_add(1, Ordering::Relaxed);
                            let _ = sender.send((index, loaded));
                        }
                    });
                }
                drop(sender);
                // In the order of the files, whoever was first: the list is the same every time.
                let (mut early, mut next) = (BTreeMap::new(), 0);
                for (index, loaded) in receiver {
                    early.insert(index, loaded);
                    while let Some(loaded) = early.remove(&next) {
                        send(Message::Loaded(next, Box::new(loaded)));
                        next += 1;
                    }
                }
            });
            send(Message::LoadingDone);
        });
    }

    /// Reads a file again.
    pub(crate) fn reload(&self, id: SourceId, file: PathBuf, soma: SomaEdit) {
        self.start(move |send| {
            let loaded = guarded(|| load::load(&file, soma));
            send(Message::Reloaded(id, Box::new(loaded)));
        });
    }

    /// Whether a soma is being made.
    pub(crate) fn rebuilds_soma(&self) -> bool {
        self.somata > 0
    }

    /// Meshes a cell again, with another soma.
    pub(crate) fn soma(&mut self, id: SourceId, morphology: Arc<Morphology>, edit: SomaEdit) {
        self.somata += 1;
        self.start(move |send| {
            let made =
                guarded(|| generate(&morphology, &edit.options()).map_err(|e| e.to_string()));
            send(Message::Soma(id, edit, Box::new(made.unwrap_or_default())));
        });
    }

    /// Saves something: the job says how far it is and when to stop.
    pub(crate) fn save(
        &mut self,
        what: &str,
        (all, steps): (usize, &'static str),
        work: impl FnOnce(&Job) -> Result<String, String> + Send + 'static,
    ) {
        let job = Job::new(what, steps, all);
        self.saving = Some(job.clone());
        self.start(move |send| send(Message::Saved(guarded(|| work(&job)))));
    }

    /// Looks after these files from now on, every two seconds, on a thread of its own.
    pub(crate) fn watch(&mut self, files: Vec<Watched>) {
        let mut watching = self.watching.lock().unwrap_or_else(PoisonError::into_inner);
        let begins = watching.is_empty() && !files.is_empty();
        *watching = files;
        drop(watching);
        if !begins {
            return;
        }
        let watching = Arc::downgrade(&self.watching);
        self.start(move |send| {
            let mut known: Vec<(SourceId, Option<Stale>)> = Vec::new();
            loop {
                std::thread::sleep(Duration::from_secs(2));
                // The window is closed, or all files are.
                let Some(watching) = watching.upgrade() else {
                    return;
                };
                let files = watching
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .clone();
                if files.is_empty() {
                    return;
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
    }
}

/// A bug in one cell is a failure of that cell.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
        let words = words.or_else(|| panic.downcast_ref::<String>().cloned());
        let words = words.unwrap_or_default();
        Err(format!(
            "a bug in neurotess ({words}): please report it with the file"
        ))
    })
}
