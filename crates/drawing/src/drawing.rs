//! Pictures of cells and circuits: a scene, with all that is needed to draw it once or often.

mod ids;
mod pictures;

use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Instant;

use neurotess_circuit::NodeRef;
use neurotess_color::{ClosestColors, MarkerSet};
use neurotess_morphology::Morphology;
use neurotess_options::groups::CellSelection;
use neurotess_options::words::{Point, Time, ViewSide};
use neurotess_picture::overlay::{Legend, Overlay};
use neurotess_picture::{BoundingSphere, Camera, Placement, Viewpoint};

use crate::cameras;
use crate::colors::{self, PictureColors};
use crate::error::DrawError;
use crate::film::{FilmStats, FixedFilm};
use crate::host::Host;
use crate::job::Job;
use crate::meshed::MeshedCell;
use crate::options::{DrawOptions, OwnData};
use crate::overlay::{overlay, tell_lowered};
use crate::painter::{Open, Painter, SourceStats};
use crate::png::recipe_of;
use crate::scene::meshes::SceneMeshes;
use crate::scene::{CircuitInstances, Scene, bounds, of_memory, read_circuit};
use crate::shown::Shown;

use ids::KeptIds;
pub use ids::{IdImage, Picked};

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub enum DrawingInput<'a> {
    /// Cells with their names, in their own coordinates.
    Cells(&'a [(&'a str, &'a Morphology)]),
    /// A circuit, of which the options select cells; only of these, if some are listed.
    Circuit(&'a Path, Option<&'a [NodeRef]>),
}

/// Cells to be drawn once or often.
pub struct Drawing {
    asked: Box<DrawOptions>,
    pub(crate) cells: Vec<MeshedCell>,
    pub(crate) placements: Vec<(usize, Placement)>,
    pub(crate) instances: Option<CircuitInstances>,
    /// What the cameras of the options fit.
    spheres: Vec<BoundingSphere>,
    /// What holds everything, for near planes.
    around: Vec<BoundingSphere>,
    colored: PictureColors,
    cameras: Vec<Camera>,
    overlay: Overlay,
    painter: Painter,
    /// Of a series of times from a fixed camera: drawn with the first of its pictures.
    film: Option<FixedFilm>,
    /// What was picked from last.
    kept_ids: Option<KeptIds>,
    seconds: DrawingSeconds,
    /// Which of the meshes beside the cells were in memory.
    in_memory: Vec<bool>,
    /// What is drawn that no file can tell.
    left_out: Vec<&'static str>,
}

/// How long it took until the first picture could be drawn (s).
#[derive(Clone, Copy, Debug, Default)]
pub struct DrawingSeconds {
    /// Cameras, colors, legend.
    pub frame: f64,
    /// Opening the adapter.
    pub adapter: f64,
    /// Making what is drawn from, and uploading it.
    pub upload: f64,
}

impl Drawing {
    /// Reads and meshes what is to be drawn, and uploads it if an adapter draws, which `open` opens. Numbers of `own` go
    /// before what the options color by. Ends soon after another thread stops the host.
    ///
    /// # Errors
    /// Wrong options, inputs that fail, or a device that does.
    pub fn new(
        input: DrawingInput<'_>,
        mut asked: DrawOptions,
        own: OwnData,
        open: Open<'_>,
        host: &dyn Host,
    ) -> Result<Self, DrawError> {
        if let DrawingInput::Circuit(_, Some(nodes)) = input {
            asked.picture.cells.listed = Some(nodes.to_vec());
        }
        asked.picture.check()?;
        let scene = match input {
            DrawingInput::Cells(cells) => of_memory(cells, &asked, host)?,
            DrawingInput::Circuit(path, _) => read_circuit(path, &asked, host)?,
        };
        Self::of_scene(scene, asked, own, open, host)
    }

    /// Of a scene that is meshed.
    ///
    /// # Errors
    /// Wrong options, a report or a mesh that is invalid, or a device that fails.
    pub fn of_scene(
        scene: Scene,
        asked: DrawOptions,
        own: OwnData,
        open: Open<'_>,
        host: &dyn Host,
    ) -> Result<Self, DrawError> {
        let mut clock = Clock(Instant::now());
        let asked = Box::new(asked);
        let picture = &asked.picture;
        picture.check()?;
        if own.numbers.is_none() && own.mesh_values.is_none() {
            picture.check_values()?;
        }
        let Scene {
            entries,
            placements,
            instances,
            ..
        } = scene;
        let cells: Vec<MeshedCell> = entries.into_iter().flatten().collect();
        if host.stopped().load(Ordering::Relaxed) {
            return Err(DrawError::Stopped);
        }
        if placements.is_empty() && picture.meshes.mesh.is_empty() {
            return Err(DrawError::Failed("there is no cell to draw".into()));
        }
        let shown: Vec<&MeshedCell> = cells.iter().collect();
        let of_cells: Vec<usize> = placements.iter().map(|&(cell, _)| cell).collect();
        let OwnData {
            numbers,
            surfaces,
            mesh_values,
        } = own;
        let in_memory: Vec<bool> = surfaces.iter().map(Option::is_some).collect();
        let left_out = [
            (
                "values in memory",
                numbers.is_some() || mesh_values.is_some(),
            ),
            ("a colormap in memory", asked.scale.is_some()),
            ("meshes in memory", in_memory.contains(&true)),
        ];
        let left_out = left_out.into_iter().filter(|(_, is)| *is);
        let left_out = left_out.map(|(what, _)| what).collect();
        let still = matches!(numbers, Some(neurotess_color::OwnNumbers::Still(_)));
        let meshes = SceneMeshes::read(&picture.meshes.mesh, surfaces, host)?;
        let shown_by = (instances.as_ref(), &of_cells[..]);
        let mut colored = colors::of_pictures(&shown, shown_by, &asked, numbers, host)?;
        let of_vertices = mesh_values.as_ref().map(|values| (values, still));
        colored.add_meshes(&meshes, of_vertices, &asked)?;
        let mut spheres = bounds::spheres(&shown, &placements);
        spheres.extend(colored.markers.as_ref().and_then(MarkerSet::bounds));
        let around: Vec<_> = spheres.iter().copied().chain(meshes.points()).collect();
        spheres.extend(meshes.fitted());
        let cameras = cameras::cameras(picture, &spheres)?;
        let (overlay, cameras) = overlay(&asked, &colored, cameras, &spheres);
        let options = picture.drawn(colored.least_width());
        tell_lowered(&options, picture.look.samples.0, &overlay, host);
        let frame = clock.lap();
        let job = Job {
            asked: &asked,
            cells: &shown,
            placements: &placements,
            colored: &colored,
            cameras: &cameras,
            #[cfg(feature = "gpu")]
            spheres: &spheres,
        };
        let device = Painter::device(open, &job)?;
        let adapter = clock.lap();
        let painter = Painter::new(device, &options, &job, meshes)?;
        let seconds = DrawingSeconds {
            frame,
            adapter,
            upload: clock.lap(),
        };
        drop(shown);
        Ok(Self {
            asked,
            cells,
            placements,
            instances,
            spheres,
            around,
            colored,
            cameras,
            overlay,
            painter,
            film: None,
            kept_ids: None,
            seconds,
            in_memory,
            left_out,
        })
    }

    /// Number of pictures that the options ask for.
    pub fn pictures(&self) -> usize {
        self.cameras.len()
    }

    /// Whether a graphics adapter draws.
    pub fn by_adapter(&self) -> bool {
        self.painter.is_adapter()
    }

    /// What draws: its name, its interface, and whether it is a processor.
    pub fn painter(&self) -> ([&str; 2], bool) {
        let [name, interface] = &self.painter.name;
        ([name, interface], self.painter.software)
    }

    /// What was asked for.
    pub fn options(&self) -> &DrawOptions {
        &self.asked
    }

    /// How one of the pictures is made, as PNG files tell it under [`PNG_KEYWORD`](crate::PNG_KEYWORD): from its own camera,
    /// at its own time.
    pub fn recipe(&self, picture: usize) -> String {
        let mut single = self.asked.picture.clone();
        // Which cells are shown is not a part of it, nor what is in memory.
        single.cells = CellSelection::default();
        let mut in_memory = self.in_memory.iter();
        single
            .meshes
            .mesh
            .retain(|_| !in_memory.next().copied().unwrap_or(false));
        let asked = &mut single.camera;
        if let (true, Some(camera)) = (asked.turntable, self.camera(picture)) {
            let [_, up, _] = camera.axes();
            (asked.eye, asked.target) = (Some(Point(camera.eye())), Some(Point(camera.target())));
            (asked.up, asked.view) = (Point(up), ViewSide::default());
            asked.fov = camera.fov().to_degrees();
        }
        if let Some(time) = self.colored.time(picture)
            && (asked.time.is_some() || asked.picture_times.is_some())
        {
            asked.time = Some(Time::At(time));
        }
        (asked.turntable, asked.frames, asked.picture_times) = (false, None, None);
        recipe_of(&single, &self.left_out)
    }

    /// The legend of a picture.
    pub fn legend(&self, picture: usize) -> Legend {
        self.colored.legend(picture)
    }

    /// Number of neurons in the pictures.
    pub fn neurons(&self) -> usize {
        self.placements.len()
    }

    /// How long it took until the first picture could be drawn.
    pub fn seconds(&self) -> DrawingSeconds {
        self.seconds
    }

    /// The colors of the legend that are closest to one another.
    pub fn closest_colors(&self) -> Option<&ClosestColors> {
        self.colored.closest.as_ref()
    }

    /// What a film holds and reads, if the pictures are one.
    pub fn film(&self) -> Option<FilmStats> {
        self.film.as_ref().map(FixedFilm::stats)
    }

    /// The camera of one of the pictures.
    pub fn camera(&self, picture: usize) -> Option<Camera> {
        self.cameras.get(picture).copied()
    }

    /// What a picture draws.
    ///
    /// # Errors
    /// There is no such picture, or the device fails.
    pub fn counted(&mut self, picture: usize) -> Result<SourceStats, DrawError> {
        let Some(camera) = self.camera(picture) else {
            return Err(DrawError::Failed("there is no such picture".into()));
        };
        let near = camera.near(&self.around);
        let options = self.asked.picture.drawn(self.colored.least_width());
        self.painter.stats(&Viewpoint { camera, near }, &options)
    }
}

fn shown<'a>(
    asked: &'a DrawOptions,
    cells: &'a [&'a MeshedCell],
    placements: &'a [(usize, Placement)],
    colored: &'a PictureColors,
) -> Shown<'a> {
    Shown {
        asked,
        cells,
        placements,
        colored,
    }
}

/// A clock that tells the seconds since it was asked last.
struct Clock(Instant);

impl Clock {
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let seconds = (now - self.0).as_secs_f64();
        self.0 = now;
        seconds
    }
}
