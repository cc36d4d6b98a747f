//! Pictures that stay in memory, of cells that are in memory or of a circuit: the options and looks of
//! `neurotess render` without its files.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Parser;
use glam::{DVec2, DVec3};
use neurotess::circuit::NodeRef;
use neurotess::coloring::{MarkerSet, MeshValues, OwnNumbers};
use neurotess::morphology::{Morphology, SectionId, shape};
use neurotess::picture::color::Rgb;
use neurotess::picture::overlay::Overlay;
use neurotess::picture::{
    BoundingSphere, Camera, Image, PictureOptions, Placement, Viewpoint, Watch,
};
use neurotess::recipe::memory::{self, TooLittleMemory};
use rayon::prelude::*;

use super::args::RenderArgs;
use super::cells::{self, MeshedCell};
use super::circuit_instances::CircuitInstances;
use super::coloring::PictureColors;
use super::film::FixedFilm;
use super::job::RenderJob;
use super::meshes::SceneMeshes;
use super::painter::{Open, Painter};
use super::scene::RenderScene;
use super::shown::{self, Shown};
use super::{bounds, cameras, checks, coloring, draw, scene};
use crate::options::size::Size;
use crate::report::{self, Common, Entry, Failed, Reporter, Usage};

/// The options alone, without the program around them.
#[derive(Debug, Parser)]
struct Options {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    args: RenderArgs,
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub enum DrawingInput<'a> {
    /// Cells with their names, in their own coordinates.
    Cells(&'a [(&'a str, &'a Morphology)]),
    /// A circuit, of which the options select cells; only of these, if some are listed.
    Circuit(&'a Path, Option<&'a [NodeRef]>),
}

/// Colors that options do not tell.
#[derive(Clone, Debug, Default)]
pub struct DrawingColors {
    /// Numbers of the cells, which they are colored by.
    pub own: Option<OwnNumbers>,
    /// Of numbers over time the times of the pictures, as `--time` has them.
    pub time: Option<String>,
    /// Times (ms) of the pictures, one by one, instead of `time`.
    pub times: Option<Vec<f64>>,
    /// Numbers of the meshes beside the cells, in the order of the options.
    pub meshes: Option<MeshValues>,
    /// Colors of numbers, instead of a color map.
    pub scale: Option<Vec<Rgb>>,
}

/// Why nothing is drawn.
#[derive(Debug)]
pub enum DrawError {
    /// An option is wrong, in the words of the command line.
    Option(String),
    /// An input or the device fails, or another thread asked to stop.
    Failed(String),
    /// There is too little memory.
    Memory(String),
}

/// Cells to be drawn once or often.
pub struct Drawing {
    args: Box<RenderArgs>,
    cells: Vec<MeshedCell>,
    placements: Vec<(usize, Placement)>,
    instances: Option<CircuitInstances>,
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
}

/// What is at a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    /// Index of the cell among those that are drawn.
    pub cell: usize,
    /// Its name: that of the cell, or population and id of a node.
    pub name: String,
    /// The id of the node, if it is of a circuit.
    pub node: Option<u64>,
    /// The section; none on the soma.
    pub section: Option<SectionId>,
    /// The file's own number of the nearest sample; none on the soma.
    pub sample: Option<i64>,
    /// Where it is (µm).
    pub position: DVec3,
}

impl Drawing {
    /// Reads and meshes what is to be drawn, and uploads it if an adapter draws, which `open` opens; `colors` go before
    /// those of the options. Returns what there is to say about it, too. Ends soon after another thread sets `stopped`.
    ///
    /// # Errors
    /// Wrong options, inputs that fail, or a device that does.
    pub fn new(
        open: Open<'_>,
        input: DrawingInput<'_>,
        options: impl IntoIterator<Item = String>,
        colors: DrawingColors,
        stopped: &Arc<AtomicBool>,
    ) -> Result<(Self, Vec<String>), DrawError> {
        let Options { mut args, common } = parsed(input, options)?;
        if let DrawingInput::Circuit(_, Some(nodes)) = input {
            args.cells.list(nodes);
        }
        args.scale = colors.scale;
        args.times = colors.times;
        if let Some(time) = colors.time {
            args.time = Some(time.parse().map_err(DrawError::Option)?);
        }
        let args = Box::new(args);
        let reporter = Reporter::recording(common, stopped);
        let made = Self::made(
            open,
            input,
            args,
            (colors.own, colors.meshes.as_ref()),
            &reporter,
        );
        let mut told = reporter.take_recorded();
        match made {
            Ok(drawing) => Ok((drawing, told)),
            Err(e) if e.is::<TooLittleMemory>() => Err(DrawError::Memory(report::told(&e))),
            Err(e) if e.is::<Usage>() => Err(DrawError::Option(report::told(&e))),
            Err(e) => {
                told.push(report::told(&e));
                Err(DrawError::Failed(told.join("; ")))
            }
        }
    }

    fn made(
        open: Open<'_>,
        input: DrawingInput<'_>,
        args: Box<RenderArgs>,
        (own, of_meshes): (Option<OwnNumbers>, Option<&MeshValues>),
        reporter: &Reporter,
    ) -> anyhow::Result<Self> {
        shown::mode(&args)?;
        if own.is_none() && of_meshes.is_none() {
            checks::check_value(&args)?;
        }
        let told = matches!(own, Some(OwnNumbers::Still(_)));
        let RenderScene {
            entries,
            placements,
            instances,
            ..
        } = match input {
            DrawingInput::Cells(cells) => in_memory(cells, &args, reporter.stopped())?,
            DrawingInput::Circuit(..) => scene::read(&args, reporter)?,
        };
        let done = |entry| match entry {
            Entry::Done(cell) => Some(cell),
            Entry::Failed(Failed { file, error }) => {
                reporter.warning(&format!("{file}: left out: {error}"));
                None
            }
        };
        let cells: Vec<MeshedCell> = entries.into_iter().filter_map(done).collect();
        if reporter.stopped().load(Ordering::Relaxed) {
            anyhow::bail!("stopped");
        }
        if placements.is_empty() && args.meshes.mesh.is_empty() {
            anyhow::bail!("there is no cell to draw");
        }
        let shown: Vec<&MeshedCell> = cells.iter().collect();
        let of_cells: Vec<usize> = placements.iter().map(|&(cell, _)| cell).collect();
        let meshes = SceneMeshes::read(&args.meshes, reporter)?;
        let shown_by = (instances.as_ref(), &of_cells[..]);
        let mut colored = coloring::of_pictures(&shown, shown_by, &args, own, reporter)?;
        colored.add_meshes(&meshes, of_meshes.map(|values| (values, told)), &args)?;
        let mut spheres = bounds::spheres(&shown, &placements);
        spheres.extend(colored.markers.as_ref().and_then(MarkerSet::bounds));
        let around: Vec<_> = spheres.iter().copied().chain(meshes.points()).collect();
        spheres.extend(meshes.fitted());
        let cameras = cameras::cameras(&args, &spheres)?;
        let (overlay, cameras) = draw::overlay(&args, &colored, cameras, &spheres);
        if overlay.legend_left_out {
            reporter.warning("the legend is left out: it needs a larger --size, or --no-legend");
        }
        let job = RenderJob {
            args: &args,
            cells: &shown,
            placements: &placements,
            colored: &colored,
            cameras: &cameras,
            #[cfg(feature = "gpu")]
            spheres: &spheres,
            around: &around,
            overlay: &overlay,
            files: &[],
        };
        let options = draw::picture_options(&args, colored.least_width());
        let device = Painter::device(open, &job)?;
        let painter = Painter::new(device, &options, &job, meshes)?;
        Ok(Self {
            args,
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
        })
    }

    /// Whether a graphics adapter draws, not the processor.
    pub fn by_adapter(&self) -> bool {
        self.painter.is_adapter()
    }

    /// Number of pictures that the options ask for.
    pub fn pictures(&self) -> usize {
        self.cameras.len()
    }

    /// The camera of a picture.
    pub fn camera(&self, picture: usize) -> Option<Camera> {
        self.cameras.get(picture).copied()
    }

    /// Draws one of the pictures, with legend and scale bar. Ends soon after another thread sets `stopped`.
    ///
    /// # Errors
    /// The device or a report fails, or the picture was stopped.
    pub fn draw(&mut self, picture: usize, stopped: &Arc<AtomicBool>) -> Result<Image, DrawError> {
        self.stoppable(stopped, |drawing| drawing.numbered(picture))
    }

    fn numbered(&mut self, picture: usize) -> Result<Image, DrawError> {
        let Some(camera) = self.camera(picture) else {
            return Err(DrawError::Failed("there is no such picture".into()));
        };
        let options = draw::picture_options(&self.args, self.colored.least_width());
        if self.film.is_none() {
            let cells: Vec<&MeshedCell> = self.cells.iter().collect();
            let shown = Shown {
                args: &self.args,
                cells: &cells,
                placements: &self.placements,
                colored: &self.colored,
            };
            let cameras = (&self.cameras[..], &self.around[..]);
            let drawn = FixedFilm::new(&mut self.painter, &shown, cameras, &options);
            self.film = drawn.map_err(|e| DrawError::Failed(report::told(&e)))?;
        }
        let Some(film) = &mut self.film else {
            return self.drawn(picture, camera, &options);
        };
        let colored = film.picture(&self.colored, picture);
        let (mut image, _) = colored.map_err(|e| DrawError::Failed(report::told(&e)))?;
        let legend = self.colored.legend(picture);
        let overlay = self
            .overlay
            .again((!self.args.no_legend).then_some(&legend), &camera);
        overlay.lay_on(0, &mut image);
        Ok(image)
    }

    /// Draws from anywhere, at another size and number of samples, with the colors of one of the pictures. Ends
    /// soon after another thread sets `stopped`.
    ///
    /// # Errors
    /// The device or a report fails, or the picture was stopped.
    pub fn draw_from(
        &mut self,
        picture: usize,
        camera: Camera,
        (size, samples): ([u32; 2], u32),
        stopped: &Arc<AtomicBool>,
    ) -> Result<Image, DrawError> {
        if self.args.size.0 != size {
            self.args.size = Size(size);
            self.film = None;
            self.colored.set_widths(&self.args);
            let first = vec![camera];
            let args = &self.args;
            (self.overlay, _) = draw::overlay(args, &self.colored, first, &self.spheres);
        }
        let options = PictureOptions {
            samples,
            ..draw::picture_options(&self.args, self.colored.least_width())
        };
        self.stoppable(stopped, |drawing| drawing.drawn(picture, camera, &options))
    }

    /// Draws with a renderer that another thread can stop.
    fn stoppable(
        &mut self,
        stopped: &Arc<AtomicBool>,
        draw: impl FnOnce(&mut Self) -> Result<Image, DrawError>,
    ) -> Result<Image, DrawError> {
        self.painter.set_watch(Watch {
            stopped: Arc::clone(stopped),
            ..Watch::default()
        });
        let drawn = draw(self);
        if drawn.is_err() {
            // What was stopped in the middle of a tile has its buffers in use still.
            self.painter.recover();
        }
        drawn
    }

    fn drawn(
        &mut self,
        picture: usize,
        camera: Camera,
        options: &PictureOptions,
    ) -> Result<Image, DrawError> {
        let failed = |e: String| DrawError::Failed(e);
        let (table, legend) = self
            .colored
            .picture(picture)
            .map_err(|e| failed(report::told(&e)))?;
        let legend = (!self.args.no_legend).then_some(&legend);
        let overlay = self.overlay.again(legend, &camera);
        let [width, height] = options.size;
        let bytes = 4 * width as usize * height as usize;
        let pixels = memory::reserved(bytes);
        let mut whole = Image {
            width,
            height,
            pixels: pixels
                .map_err(|e| DrawError::Memory(format!("{e}: choose a smaller size=")))?,
        };
        let mut take = |top: u32, mut band: Image| {
            overlay.lay_on(top, &mut band);
            whole.pixels.extend_from_slice(&band.pixels);
            Ok(())
        };
        let near = camera.near(&self.around);
        let view = Viewpoint { camera, near };
        let cells: Vec<&MeshedCell> = self.cells.iter().collect();
        let shown = Shown {
            args: &self.args,
            cells: &cells,
            placements: &self.placements,
            colored: &self.colored,
        };
        self.painter
            .draw(&shown, &view, &table, options, &mut take)
            .map_err(|e| failed(report::told(&e)))?;
        Ok(whole)
    }

    /// The nearest neurite or soma at a pixel, or within `reach` pixels of it, as it was traced.
    pub fn pick(
        &self,
        camera: &Camera,
        size: [u32; 2],
        at: [f64; 2],
        reach: f64,
    ) -> Option<Picked> {
        let cursor = DVec2::from(at);
        let pixel = camera.pixel_size(f64::from(size[1]));
        // Depth, and whether the cursor is on a ball between two traced ones.
        let hit = |a: (DVec3, f64), b: (DVec3, f64)| {
            let (p, q) = (camera.pixel_of(a.0, size)?, camera.pixel_of(b.0, size)?);
            let (p, q) = (DVec2::from(p), DVec2::from(q));
            let along = (cursor - p).dot(q - p) / (q - p).length_squared().max(1e-12);
            let along = along.clamp(0.0, 1.0);
            let center = a.0.lerp(b.0, along);
            let radius = a.1 + along * (b.1 - a.1);
            let depth = camera.depth(center);
            let pixels = radius / pixel.at(depth);
            let near = cursor.distance(p.lerp(q, along)) <= pixels + reach;
            (near && pixel.at(depth) > 0.0).then_some((depth - radius, along, center))
        };
        let of_instance = |(instance, &(cell, placement)): (usize, &(usize, Placement))| {
            let morphology = &self.cells[cell].morphology;
            let place = |position: glam::Vec3, radius: f32| {
                let center = morphology.origin + position.as_dvec3();
                let radius = f64::from(radius.max(0.0)) * placement.scale;
                (placement.world_from_cell(center), radius)
            };
            let mut best: Option<(f64, Picked)> = None;
            let mut offer = |(depth, _, position), section, sample| {
                if best.as_ref().is_none_or(|(least, _)| depth < *least) {
                    let picked = Picked {
                        cell: instance,
                        name: String::new(),
                        node: None,
                        section,
                        sample,
                        position,
                    };
                    best = Some((depth, picked));
                }
            };
            for soma in &morphology.somata {
                let ball = place(soma.center, soma.radius);
                if let Some(found) = hit(ball, ball) {
                    offer(found, None, None);
                }
            }
            for (index, section) in morphology.sections.iter().enumerate() {
                let id = SectionId(index as u32);
                let before = shape::branch_point(morphology, id);
                let mut last = before.map(|p| place(p.position, p.radius));
                for point in section.range() {
                    let p = morphology.points[point];
                    let ball = place(p.position, p.radius);
                    if let Some(found) = hit(last.unwrap_or(ball), ball) {
                        let nearer = found.1 < 0.5 && point > section.first as usize;
                        let point = if nearer { point - 1 } else { point };
                        offer(found, Some(id), morphology.sample_ids.get(point).copied());
                    }
                    last = Some(ball);
                }
            }
            best
        };
        let found = self.placements.par_iter().enumerate();
        let found: Vec<_> = found.filter_map(of_instance).collect();
        let nearest = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, picked)| self.named(picked))
    }

    fn named(&self, mut picked: Picked) -> Picked {
        (picked.name, picked.node) = match &self.instances {
            Some(circuit) => (
                circuit.names().swap_remove(picked.cell),
                Some(circuit.instances[picked.cell].id),
            ),
            None => {
                let (cell, _) = self.placements[picked.cell];
                (self.cells[cell].file.clone(), None)
            }
        };
        picked
    }
}

/// Options as the command line takes them.
fn parsed(
    input: DrawingInput<'_>,
    options: impl IntoIterator<Item = String>,
) -> Result<Options, DrawError> {
    let path = match input {
        DrawingInput::Cells(_) => Path::new("-"),
        DrawingInput::Circuit(path, _) => path,
    };
    let mut command = vec!["render".into()];
    command.extend(options.into_iter().map(std::ffi::OsString::from));
    command.extend(["--out=-".into(), "--".into(), path.into()]);
    let options = Options::try_parse_from(command);
    options.map_err(|e| DrawError::Option(report::first_paragraph(&e)))
}

/// The scene of cells that are in memory, each in its own coordinates.
fn in_memory(
    cells: &[(&str, &Morphology)],
    args: &RenderArgs,
    stopped: &AtomicBool,
) -> anyhow::Result<RenderScene> {
    scene::check_of_cells(args)?;
    let options = cells::options(args);
    let meshed = cells.par_iter().map(|&(name, morphology)| {
        let cell = cells::meshed(name.to_owned(), morphology.clone(), &options, stopped);
        cell.map(Entry::Done).map_err(|e| anyhow::anyhow!(e.0))
    });
    let entries = meshed.collect::<anyhow::Result<Vec<_>>>()?;
    let placements = (0..entries.len()).map(|cell| (cell, Placement::default()));
    Ok(RenderScene {
        placements: placements.collect(),
        entries,
        instances: None,
        cache: None,
    })
}
