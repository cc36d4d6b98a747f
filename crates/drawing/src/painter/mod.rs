//! Who draws: the processor, or a graphics adapter.
//!
//! The processor draws where nothing names an adapter, but for scenes so large that a hardware adapter is worth opening,
//! and for `--lod` of the window's exploration and of meshes that are refined beforehand, which only adapters have.

#[cfg(feature = "gpu")]
mod adapter;
mod cost;
mod processor;
#[cfg(feature = "gpu")]
mod vertex_source;

use std::sync::Arc;

use neurotess_picture::color::ColorTable;
use neurotess_picture::{Image, KeyColors, PictureOptions, Viewpoint, VisibleKey, Watch};
use neurotess_raster as raster;

use crate::error::{DrawError, together};
use crate::job::Job;
use crate::options::DrawOptions;
use crate::scene::meshes::SceneMeshes;
use crate::shown::Shown;
use neurotess_options::words::Lod;

pub use cost::{BudgetStats, Cost, SourceStats, StreamStats};

/// A graphics device.
#[cfg(feature = "gpu")]
pub type Device = neurotess_render::Gpu;

/// A graphics device, of which this build has none.
#[cfg(not(feature = "gpu"))]
#[derive(Debug)]
pub enum Device {}

/// Opens graphics adapters by a part of their name.
pub type Open<'a> = &'a dyn Fn(Option<&str>) -> Result<Arc<Device>, String>;

/// Opens an adapter for one command.
///
/// # Errors
/// There is none of this name.
#[cfg(feature = "gpu")]
pub fn open(name: Option<&str>) -> Result<Arc<Device>, String> {
    Device::open(name).map(Arc::new).map_err(|e| e.to_string())
}

/// Opens no adapter: this build has none.
///
/// # Errors
/// Always.
#[cfg(not(feature = "gpu"))]
pub fn open(name: Option<&str>) -> Result<Arc<Device>, String> {
    let name = name.map_or(String::new(), |name| format!(" '{name}'"));
    Err(format!(
        "this build draws by the processor alone and knows no adapter{name}: build it with the feature 'gpu', or use \
         --adapter cpu"
    ))
}

/// The name by which the processor is asked for.
pub(crate) const PROCESSOR: &str = "cpu";
/// The variable that names what draws, where no option does.
const VARIABLE: &str = "NEUROTESS_ADAPTER";
/// Coarse patches of all pictures together from which on a hardware adapter is looked for: a core of the processor takes
/// some seconds for them. Listing adapters takes 0.06 to 0.25 s, opening one and making its pipelines as long again.
#[cfg(feature = "gpu")]
const WORTH_AN_ADAPTER: u64 = 2_000_000;

/// What draws the pictures of a job.
pub(crate) struct Painter {
    kind: Kind,
    /// Its name, its interface, and whether it is a processor.
    pub(crate) name: [String; 2],
    pub(crate) software: bool,
}

enum Kind {
    Processor(Box<processor::Processor>),
    #[cfg(feature = "gpu")]
    Adapter(Box<adapter::Adapter>),
}

/// A picture that is colored anew.
pub enum Recolored {
    /// Drawn by the processor.
    Processor(raster::StaticPicture),
    /// Drawn by an adapter.
    #[cfg(feature = "gpu")]
    Adapter(Arc<Device>, neurotess_render::StaticPicture),
}

/// Takes bands of pictures.
pub type Take<'a> = &'a mut dyn FnMut(u32, Image) -> Result<(), DrawError>;

/// Whether the processor is to draw: by the options, or by the variable.
///
/// # Errors
/// Wrong usage: what only adapters draw.
pub fn wanted(asked: &DrawOptions) -> Result<Wanted, DrawError> {
    let variable = || std::env::var(VARIABLE).ok().filter(|name| !name.is_empty());
    let name = asked.device.adapter.clone().or_else(variable);
    let mode = asked.picture.refinement.mode()?;
    let by_adapters = matches!(mode, Lod::Exploration | Lod::Prerefined);
    match name {
        Some(name) if name.eq_ignore_ascii_case(PROCESSOR) => match by_adapters {
            true => together(
                "the processor draws no --lod exploration or prerefined: leave out --lod, or name another --adapter",
            ),
            false => Ok(Wanted::Processor),
        },
        Some(name) => Ok(Wanted::Adapter(Some(name))),
        None if by_adapters => Ok(Wanted::Adapter(None)),
        None => Ok(Wanted::Whatever),
    }
}

/// What is to draw.
pub enum Wanted {
    /// The processor.
    Processor,
    /// An adapter of this name, or any.
    Adapter(Option<String>),
    /// The processor, or for large scenes graphics hardware.
    Whatever,
}

impl Wanted {
    /// The adapter that draws pictures of so many coarse patches together; none if the processor does.
    ///
    /// # Errors
    /// A message: there is no adapter of that name, or none that can draw.
    pub fn device(&self, patches: u64, open: Open<'_>) -> Result<Option<Arc<Device>>, String> {
        Ok(match self {
            Self::Processor => None,
            Self::Adapter(name) => Some(open(name.as_deref())?),
            Self::Whatever => worth(patches, open),
        })
    }
}

/// Opens the hardware adapter that is worth it for so many patches, if there is one.
#[cfg(feature = "gpu")]
fn worth(patches: u64, open: Open<'_>) -> Option<Arc<Device>> {
    if patches < WORTH_AN_ADAPTER {
        return None;
    }
    let adapters = neurotess_render::adapter::adapters();
    let hardware = adapters.iter().any(|adapter| !adapter.software);
    hardware.then(|| open(None).ok()).flatten()
}

#[cfg(not(feature = "gpu"))]
fn worth(_patches: u64, _open: Open<'_>) -> Option<Arc<Device>> {
    None
}

impl Painter {
    /// The adapter that draws the pictures of a job; none if the processor does.
    ///
    /// # Errors
    /// There is no adapter of that name, or none that draws what is asked for.
    pub(crate) fn device(open: Open<'_>, job: &Job<'_>) -> Result<Option<Arc<Device>>, DrawError> {
        let patches = job.shown().patches() * job.cameras.len() as u64;
        let device = wanted(job.asked)?.device(patches, open);
        device.map_err(DrawError::Failed)
    }

    /// For the pictures of a job: cells, markers and `meshes` beside them.
    pub(crate) fn new(
        device: Option<Arc<Device>>,
        options: &PictureOptions,
        job: &Job<'_>,
        meshes: SceneMeshes,
    ) -> Result<Self, DrawError> {
        let Some(device) = device else {
            let processor = processor::Processor::new(options, &job.shown(), meshes)?;
            return Ok(Self {
                kind: Kind::Processor(Box::new(processor)),
                name: [PROCESSOR, "raster"].map(str::to_owned),
                software: true,
            });
        };
        Self::by_adapter(device, options, job, meshes)
    }

    #[cfg(feature = "gpu")]
    fn by_adapter(
        gpu: Arc<Device>,
        options: &PictureOptions,
        job: &Job<'_>,
        meshes: SceneMeshes,
    ) -> Result<Self, DrawError> {
        let name = [gpu.adapter.name.clone(), gpu.adapter.backend.clone()];
        let software = gpu.adapter.software;
        let adapter = adapter::Adapter::new(gpu, options, job, meshes)?;
        Ok(Self {
            kind: Kind::Adapter(Box::new(adapter)),
            name,
            software,
        })
    }

    #[cfg(not(feature = "gpu"))]
    fn by_adapter(
        gpu: Arc<Device>,
        _options: &PictureOptions,
        _job: &Job<'_>,
        _meshes: SceneMeshes,
    ) -> Result<Self, DrawError> {
        match Arc::into_inner(gpu) {
            Some(never) => match never {},
            None => Err(DrawError::Failed("there is no adapter".into())),
        }
    }

    /// Whether an adapter draws.
    pub(crate) fn is_adapter(&self) -> bool {
        !matches!(self.kind, Kind::Processor(_))
    }

    /// Sets what counts finished tiles and can stop pictures.
    pub(crate) fn set_watch(&mut self, watch: Watch) {
        match &mut self.kind {
            Kind::Processor(processor) => processor.watch = watch,
            #[cfg(feature = "gpu")]
            Kind::Adapter(adapter) => adapter.renderer.set_watch(watch),
        }
    }

    /// Gives up what a picture that was stopped has in use.
    pub(crate) fn recover(&mut self) {
        #[cfg(feature = "gpu")]
        if let Kind::Adapter(adapter) = &mut self.kind {
            adapter.renderer = neurotess_render::StillRenderer::new();
        }
    }

    /// Draws a picture; `take` gets its bands from the top.
    pub(crate) fn draw(
        &mut self,
        shown: &Shown<'_>,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
        take: Take<'_>,
    ) -> Result<Cost, DrawError> {
        match &mut self.kind {
            Kind::Processor(processor) => processor.draw(shown, view, table, options, take),
            #[cfg(feature = "gpu")]
            Kind::Adapter(adapter) => adapter.draw(view, table, options, take),
        }
    }

    /// Draws a picture that can be colored anew, and its number of tiles; none if this one cannot.
    pub(crate) fn draw_static(
        &mut self,
        shown: &Shown<'_>,
        view: &Viewpoint,
        table: &ColorTable,
        options: &PictureOptions,
    ) -> Result<Option<(Recolored, usize)>, DrawError> {
        match &mut self.kind {
            Kind::Processor(processor) => processor.draw_static(shown, view, table, options),
            #[cfg(feature = "gpu")]
            Kind::Adapter(adapter) => adapter.draw_static(view, table, options),
        }
    }

    /// What it drew, or draws, in a whole picture.
    pub(crate) fn stats(
        &mut self,
        view: &Viewpoint,
        options: &PictureOptions,
    ) -> Result<SourceStats, DrawError> {
        match &mut self.kind {
            Kind::Processor(processor) => Ok(processor.stats(view, options)),
            #[cfg(feature = "gpu")]
            Kind::Adapter(adapter) => adapter.stats(view, options),
        }
    }
}

impl Recolored {
    /// What shows.
    pub fn keys(&self) -> &[VisibleKey] {
        match self {
            Self::Processor(picture) => picture.keys(),
            #[cfg(feature = "gpu")]
            Self::Adapter(_, picture) => picture.keys(),
        }
    }

    /// Number of weights, and their bytes.
    pub fn size(&self) -> (usize, u64) {
        match self {
            Self::Processor(picture) => (picture.weights(), picture.bytes()),
            #[cfg(feature = "gpu")]
            Self::Adapter(_, picture) => (picture.weights(), picture.bytes()),
        }
    }

    /// The picture in these colors.
    ///
    /// # Errors
    /// The adapter fails.
    pub fn image(&self, colors: &KeyColors<'_>) -> Result<Image, DrawError> {
        match self {
            Self::Processor(picture) => Ok(picture.image(colors)),
            #[cfg(feature = "gpu")]
            Self::Adapter(gpu, picture) => {
                picture.recolor(gpu, colors).map_err(DrawError::failed)?;
                picture.image(gpu).map_err(DrawError::failed)
            }
        }
    }
}
