//! Saving of sessions, meshes, pictures and settings.

use std::path::Path;
use std::sync::Arc;

use super::Viewer;
use crate::io::background::apart;
use crate::io::save::{self, MeshPlan, SeenFrom, video};
use crate::io::task::Progress;
use crate::model::document::Neuron;
use crate::model::film::{FilmFrame, film_frames};
use crate::model::save::{FilmOptions, SaveRequest};
use crate::model::session::{self, Session};
use crate::model::settings;
use crate::scene::color_scheme;
use crate::scene::content;
use crate::scene::dimensions;
use crate::scene::pictures::{StillScene, pictures};

impl Viewer {
    /// Saves the session before the program ends because of an error. Returns the message.
    pub(crate) fn rescue(&self, lost: &str) -> String {
        if self.state.document.neurons.is_empty() {
            return format!("{lost}: start again, or choose another one by NEUROTESS_ADAPTER");
        }
        let folder = &self.rescue;
        let file = folder.join(format!("rescued.{}", session::EXTENSION));
        match Session::of(&self.state, folder).write(&file) {
            Ok(()) => format!("{lost}: your session is in {}", file.display()),
            Err(e) => format!("{lost}, and the session could not be saved: {e}"),
        }
    }

    pub(super) fn save(&mut self, request: SaveRequest) {
        if let SaveRequest::Session(path) = &request {
            // A session is small, so it is written at once, also while other files are being
            // written.
            return self.save_session(path);
        }
        if self.worker.is_saving() || self.unprepared.is_some() {
            self.state
                .problem("save", "wait until the last one is written, or stop it");
            return;
        }
        let draws = matches!(request, SaveRequest::Picture(_) | SaveRequest::Film(_));
        let shows = !self.state.document.neurons.is_empty();
        if draws && shows && !self.stage.is_prepared(&self.state) {
            self.unprepared = Some(request);
            return;
        }
        match request {
            SaveRequest::Session(path) => self.save_session(&path),
            SaveRequest::Meshes(options) => {
                let plans = self.mesh_plans(options.all);
                let seen_from = SeenFrom {
                    view: self.state.view,
                    detail: self.state.document.detail,
                    height: self.stage.height(),
                };
                let progress = match plans.len() {
                    1 => Progress::new("saving the mesh", "steps", 0),
                    several => Progress::new("saving meshes", "meshes", several),
                };
                self.worker.save(progress, move |progress| {
                    save::meshes(&plans, &options, &seen_from, progress)
                });
            }
            SaveRequest::Picture(options) => {
                self.state.settings.picture_size = options.size;
                let still_scene = self.still_scene();
                let film_frame = FilmFrame {
                    view: self.state.view,
                    time: Some(self.state.playback.pace.time),
                };
                let progress = Progress::new("drawing the picture", still_scene.steps(), 0);
                self.worker.save(progress, move |progress| {
                    let files =
                        apart(|| pictures(&still_scene, &[film_frame], &options, progress))?;
                    let file = files.first().map(|f| f.display().to_string());
                    Ok(format!("Saved {}", file.unwrap_or_default()).into())
                });
            }
            SaveRequest::Film(film) => {
                self.save_film(film);
            }
            SaveRequest::Page(path) => {
                let plans = self.mesh_plans(true);
                let (look, title) = (self.state.document.look.clone(), self.state.usual_name());
                let progress = Progress::new("writing the page", "files", 1);
                self.worker.save(progress, move |_| {
                    save::page(&path, &title, &plans, &look, &color_scheme(&look))
                });
            }
            SaveRequest::Plot(path, plot) => {
                let progress = Progress::new("writing the plot", "files", 1);
                let work = move |_: &Progress| save::plot(&path, &plot).map(Into::into);
                self.worker.save(progress, work);
            }
        }
    }

    /// Begins to draw what waited, unless the stage has still other meshes or colors than the document.
    pub(super) fn save_prepared(&mut self) {
        if let Some(request) = self.unprepared.take() {
            self.save(request);
        }
    }

    fn save_film(&mut self, film: FilmOptions) {
        let state = &self.state;
        let (keys, now) = (&state.views.key_views, state.view);
        let at = Some(state.playback.pace.time);
        let time = film.time.filter(|_| state.playback.facts.is_some());
        let film_frames = film_frames(keys, now, film.frames, time, at);
        if film_frames.is_empty() {
            let why = "keep two views for it (K), or open a report whose time goes on";
            self.state.problem("film", why);
            return;
        }
        let still_scene = self.still_scene();
        let progress = Progress::new("drawing the film", still_scene.steps(), 0);
        let work = move |progress: &Progress| {
            let files = apart(|| pictures(&still_scene, &film_frames, &film.picture, progress))?;
            let (count, first) = (files.len(), files.first().cloned().unwrap_or_default());
            let also = match film.video && count > 1 {
                true => {
                    let video = video::video(&first, film.picture.replace, progress)?;
                    format!(" and {}", video.display())
                }
                false => String::new(),
            };
            Ok(format!("Saved {count} pictures from {}{also}", first.display()).into())
        };
        self.worker.save(progress, work);
    }

    fn save_session(&mut self, path: &Path) {
        let folder = path.parent().unwrap_or(Path::new(""));
        match Session::of(&self.state, folder).write(path) {
            Ok(()) => {
                self.state.messages.status = format!("Saved {}", path.display());
                self.state.session = Some(path.to_path_buf());
                self.state.changes.note_saved();
                self.state.settings.remember_files(&[path.to_path_buf()]);
            }
            Err(why) => {
                self.state.messages.status = "The session was not saved".into();
                self.state.problem(path.display().to_string(), why);
            }
        }
    }

    fn mesh_plans(&self, all: bool) -> Vec<MeshPlan> {
        let state = &self.state;
        let placements = state.placements();
        let neurons = &state.document.neurons;
        let inputs = neurons.iter().zip(placements.iter()).enumerate();
        let inputs = inputs.filter(|(i, _)| match all {
            true => neurons.shows(*i),
            false => neurons.selected().contains(*i),
        });
        let plan = |(_, (neuron, &placement)): (usize, (&Neuron, &_))| {
            let source = state.sources.get(neuron.source)?;
            Some(MeshPlan {
                name: neuron.name.clone(),
                morphology: source.morphology.clone(),
                generated: source.generated.clone(),
                generate: source.soma.options(),
                placement,
            })
        };
        inputs.filter_map(plan).collect()
    }

    fn still_scene(&self) -> StillScene {
        let (content, markers, meshes) = self.stage.saved_content(&self.state);
        let gpu = self.stage.gpu();
        StillScene {
            // What draws by the processor takes several times as long as the processor itself.
            gpu: (!gpu.adapter.software).then(|| Arc::clone(gpu)),
            content,
            markers,
            form: self.state.document.markers.form(),
            look: self.state.document.look.clone(),
            states: content::states(&self.state.document),
            spheres: self.state.spheres(),
            around: self.state.mesh_points(true),
            meshes,
            figures: dimensions::figures(&self.state),
            told: self.state.told(),
        }
    }

    /// Writes the settings, if they have changed.
    pub fn remember(&mut self) {
        self.note_settings();
        if let Err(why) = settings::write_noted() {
            self.state.problem("settings", why);
        }
    }

    /// Notes the settings, if they have changed, to be written if the program is interrupted.
    pub(super) fn note_settings(&mut self) {
        if self.state.settings != self.remembered {
            self.remembered = self.state.settings.clone();
            self.remembered.note();
        }
    }
}
