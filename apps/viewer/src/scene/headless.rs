//! A session's picture without a window.

use std::path::Path;
use std::sync::Arc;

use neurotess::cache::Cache;
use neurotess::render::Gpu;

use crate::io::find::{self, OpenRequest};
use crate::io::task::Progress;
use crate::io::{self, load};
use crate::model::film::FilmFrame;
use crate::model::picture::ToldPicture;
use crate::model::save::PictureFile;
use crate::model::session::Session;
use crate::model::settings::Settings;
use crate::model::state::State;
use crate::scene::colors::ColorRequest;
use crate::scene::content::{self, SceneContent};
use crate::scene::dimensions;
use crate::scene::markers::MarkerRequest;
use crate::scene::meshes;
use crate::scene::pictures::{StillScene, pictures};
use crate::scene::templates;

/// The adapter that draws a scene of so many coarse patches; none: the processor does. Errors are messages.
pub type ChooseAdapter<'a> = &'a dyn Fn(u64) -> Result<Option<Arc<Gpu>>, String>;

/// The result of drawing a session: what is in the picture, and what failed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SessionPicture {
    /// Number of neurons that the picture shows.
    pub neurons: usize,
    /// Files of the session that could not be read: file and reason.
    pub failures: Vec<(String, String)>,
}

/// Draws a session as the window would save it, from its own view or from the saved `view` of this
/// name. `choose`: who draws it. `without_caches`: neither read nor write the cache of its circuit.
///
/// # Errors
/// A message that says what is wrong with the session, the adapter or the file to write, and what
/// to do.
pub fn draw_session(
    file: &Path,
    picture: &PictureFile,
    view: Option<&str>,
    choose: ChooseAdapter<'_>,
    without_caches: bool,
) -> Result<SessionPicture, String> {
    let session = Session::read(file).map_err(|e| e.of(file))?;
    let view = match view {
        Some(name) => session.view_named(name).map_err(|e| e.of(file))?,
        None => session.view,
    };
    let mut state = State::new(Settings::default());
    let mut drawn = SessionPicture::default();
    let mut ids = Vec::new();
    let found = find::find(&OpenRequest {
        circuits: session.circuit.iter().map(|c| c.path.clone()).collect(),
        ..OpenRequest::default()
    });
    for (file, why) in found.failures {
        drawn.failures.push((file.display().to_string(), why));
    }
    let circuit = found.circuits.first().filter(|_| !without_caches);
    let cache = circuit.map(|(_, circuit)| Cache::open(Path::new(&circuit.file)));
    for opened in found.circuits {
        state.circuits.add(opened);
    }
    for entry in &session.file {
        let soma = entry.soma.clone().unwrap_or_default();
        ids.push(match load::load(&entry.path, soma, cache.as_ref()) {
            Ok(source) => Some(state.sources.add(source)),
            Err(why) => {
                let file = entry.path.display().to_string();
                drawn.failures.push((file, why));
                None
            }
        });
    }
    // A cache that cannot be read or written changes nothing in the picture.
    drop(cache.map(Cache::finish));
    state.document.look = session.look.clone();
    state.document.grid = session.grid;
    state.document.report = session.report.clone();
    state.document.markers = session.markers.clone();
    *state.document.meshes = session.mesh.clone();
    state.playback.pace = session.playback;
    let (neurons, opened) = session.neurons_of(&ids, &state);
    state.document.neurons = neurons;
    *state.document.dimensions = session.dimensions(&opened);
    drawn.neurons = state.shown();
    while let Some(file) = state.mesh_due() {
        let read = io::meshes::read(&file);
        state.set_mesh(file, read);
    }
    read_markers(&mut state, &mut drawn);
    let mut still_scene = still_scene(&state, &mut drawn);
    still_scene.gpu = choose(still_scene.content.patches())?;
    let film_frame = FilmFrame {
        view,
        time: Some(session.playback.time),
    };
    pictures(
        &still_scene,
        &[film_frame],
        picture,
        &Progress::new("drawing", "tiles", 0),
    )?;
    Ok(drawn)
}

/// Reads synapses and points of a session.
fn read_markers(state: &mut State, drawn: &mut SessionPicture) {
    while let Some(source) = state.markers_due() {
        let shared = |id| Some((id, state.circuits.shared(id)?));
        let circuits = state.circuits_shown();
        let circuits: Vec<_> = circuits.into_iter().filter_map(shared).collect();
        let progress = Progress::new("reading", "populations", 0);
        let content = io::markers::read(&source, &circuits, &progress);
        state.set_markers(source, content);
    }
    let problems = std::mem::take(&mut state.messages.problems);
    let failures = problems
        .into_iter()
        .map(|problem| (problem.what, problem.why));
    drawn.failures.extend(failures);
}

/// The scene, without an adapter.
fn still_scene(state: &State, drawn: &mut SessionPicture) -> StillScene {
    let sources = templates::templates(state);
    let request = ColorRequest::new(state, &sources);
    let sources = request.meshed(sources, &[]);
    let mut colored = request.colors(&sources);
    drawn.failures.extend(colored.problem.take());
    let instances = content::instances(state, &sources);
    let mut content = SceneContent::new(sources, instances, colored);
    let markers = MarkerRequest::new(state, &content).map(|request| request.markers());
    let (markers, problem) = markers.unzip();
    drawn.failures.extend(problem.flatten());
    if let Some(markers) = &markers {
        markers.add_to(&mut content);
    }
    let mut meshes = meshes::shown(state);
    meshes::add_to(&mut meshes, &mut content);
    StillScene {
        gpu: None,
        content,
        markers: markers.map(Arc::new),
        form: state.document.markers.form(),
        look: state.document.look.clone(),
        states: content::states(&state.document),
        spheres: state.spheres(),
        around: state.mesh_points(true),
        meshes,
        figures: dimensions::figures(state),
        told: ToldPicture::of(&state.document),
    }
}
