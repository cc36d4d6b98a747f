//! The picture in the window: the scene on the device, drafts while something moves, the full picture at
//! rest, and what is under the cursor. Nothing is drawn when nothing changes.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use eframe::egui;
use egui_wgpu::RenderState;
use neurotess::colouring::Colouring;
use neurotess::render::{
    Adaptive, Choice, DeviceError, Gpu, Live, Namer, Occlusion, Outlines, Refining, Scene, Shot,
    Steps, Templates, VertexMaker,
};

use crate::document::{ColourBy, Detail, Look};
use crate::explorer::Explorer;
use crate::picks::{Picks, Seen, seen};
use crate::scene::{self, BuildError, Shown, ShownSource, Standing};
use crate::state::{Counters, Draft, Picked, State};

/// How long nothing must have moved before the full picture is made.
const REST: Duration = Duration::from_millis(130);
/// A draft should take no longer.
const DRAFT_MS: f64 = 40.0;
/// A slice of a picture should take no longer.
const SLICE_MS: f64 = 120.0;
/// Most bands of a step.
const MOST_BANDS: f64 = 3.0;
/// Drafts that are coarser than this have half as many pixels to each side.
const HALF_FROM: f32 = 6.0;
/// So many frame times are shown.
const FRAMES: usize = 90;
/// Cells up to which a soma is changed at once; with more, all colours are made anew beside.
const QUICK: usize = 24;

/// All that draws.
pub struct Stage {
    gpu: Arc<Gpu>,
    render: RenderState,
    live: Live,
    maker: Adaptive,
    explorer: Explorer,
    /// Whether the last draft was the explorer's.
    explored: bool,
    texture: Option<(egui::TextureId, [u32; 2], bool)>,
    /// What is on the device.
    shown: Shown,
    colours: Option<ColourKey>,
    building: Option<Receiver<Built>>,
    drawn: Option<Drawn>,
    moved: Instant,
    rest: Rest,
    coarser: f32,
    bands: u32,
    frames: VecDeque<f32>,
    picks: Option<Picks>,
    namer: Option<(Namer, Shot)>,
    mask: Option<MaskKey>,
    counted: bool,
}

type Built = Result<(Templates, Shown, ColourKey), DeviceError>;

/// What colours depend on.
#[derive(Clone, Debug, PartialEq)]
struct ColourKey {
    by: ColourBy,
    palette: neurotess::render::Palette,
    map: neurotess::render::ColourMap,
    background: [u8; 3],
}

impl ColourKey {
    fn new(look: &Look) -> Self {
        Self {
            by: look.colour_by,
            palette: look.palette,
            map: look.colour_map,
            background: look.background,
        }
    }
}

/// What a picture depends on.
#[derive(Clone, Debug, PartialEq)]
struct Drawn {
    shot: Shot,
    detail: Detail,
    states: Vec<u32>,
    standing: Vec<Standing>,
}

/// How far the full picture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rest {
    /// Something moved a moment ago.
    Waits,
    /// Slices are being made.
    Slices,
    /// All is drawn.
    Done,
}

/// What outlines depend on.
#[derive(Clone, Debug, PartialEq)]
struct MaskKey {
    hovered: Option<Picked>,
    selected: Vec<usize>,
    shot: Shot,
}

impl Stage {
    /// On a device that the window has.
    ///
    /// # Errors
    /// The device refuses.
    pub fn new(render: RenderState) -> Result<Self, DeviceError> {
        let gpu = Gpu::share(&render.adapter, render.device.clone(), render.queue.clone());
        let live = Live::new(&gpu);
        let maker = Adaptive::new(&gpu, Scene::default(), Refining::default(), 1)?;
        let shown = Shown {
            sources: Vec::new(),
            instances: Vec::new(),
            colouring: Arc::new(scene::colours(&[], &Look::default())),
        };
        let software = gpu.adapter.software;
        Ok(Self {
            gpu: Arc::new(gpu),
            render,
            live,
            maker,
            explorer: Explorer::default(),
            explored: false,
            texture: None,
            shown,
            colours: None,
            building: None,
            drawn: None,
            moved: Instant::now(),
            rest: Rest::Done,
            coarser: if software { 4.0 } else { 1.0 },
            bands: if software { 2 } else { 1 },
            frames: VecDeque::new(),
            picks: None,
            namer: None,
            mask: None,
            counted: false,
        })
    }

    /// The device.
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// What is on the device.
    pub(crate) fn shown(&self) -> &Shown {
        &self.shown
    }

    /// What colours mean.
    pub fn colouring(&self) -> &Colouring {
        &self.shown.colouring
    }

    /// Whether all that there is to draw is drawn.
    pub fn is_settled(&self) -> bool {
        self.rest == Rest::Done && self.building.is_none() && self.drawn.is_some()
    }

    /// Height (pixels) of the picture.
    pub fn height(&self) -> f64 {
        self.drawn
            .as_ref()
            .map_or(800.0, |d| f64::from(d.shot.size[1]))
    }

    /// Share of the full picture that is made, while it is.
    pub fn progress(&self) -> Option<f32> {
        self.live.progress()
    }

    /// What is seen at a pixel. Nothing while things move.
    pub fn seen_at(&self, x: f32, y: f32) -> Option<Seen> {
        self.picks.as_ref()?.at(x, y)
    }

    /// Whether it is known what is where.
    pub fn can_pick(&self) -> bool {
        self.picks.is_some()
    }

    /// Draws what has changed; asks for another frame while there is more to draw.
    ///
    /// # Errors
    /// What the device cannot do.
    pub fn update(
        &mut self,
        state: &mut State,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<Option<egui::TextureId>, DeviceError> {
        self.take_built(ctx)?;
        self.want_scene(state, ctx)?;
        self.explorer.update(&self.gpu, &self.shown, ctx);
        if size.contains(&0) {
            return Ok(None);
        }
        let wanted = self.wanted(state, size);
        if self.drawn.as_ref() != Some(&wanted) {
            self.draft(wanted, ctx)?;
        } else {
            self.refine(state, ctx)?;
        }
        self.take_ids(ctx)?;
        self.outline(state);
        state.counters.frames_ms = self.frames.iter().copied().collect();
        state.counters.draft = match self.explored {
            true => Draft::Budget(self.explorer.budget()),
            false => Draft::Error(self.coarser),
        };
        self.gpu.check()?;
        Ok(self.texture_id())
    }

    fn take_built(&mut self, ctx: &egui::Context) -> Result<(), DeviceError> {
        let Some(building) = &self.building else {
            return Ok(());
        };
        let Ok(built) = building.try_recv() else {
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        };
        self.building = None;
        let (templates, shown, colours) = built?;
        let scene = Scene::new(templates, scene::instances(&shown.instances));
        self.maker.set_scene(scene.unwrap_or_default());
        self.live.set_colours(shown.colouring.table.clone());
        self.shown = shown;
        self.colours = Some(colours);
        self.drawn = None;
        Ok(())
    }

    /// Brings sources and neurons on the device up to date: at once, or beside.
    fn want_scene(&mut self, state: &State, ctx: &egui::Context) -> Result<(), DeviceError> {
        if self.building.is_some() {
            return Ok(());
        }
        let sources = scene::sources(state);
        let colours = ColourKey::new(&state.document.look);
        let same_sources = sources.len() == self.shown.sources.len()
            && sources
                .iter()
                .zip(&self.shown.sources)
                .all(|(a, b)| a.id == b.id);
        let changed: Vec<usize> = if same_sources {
            let pairs = sources.iter().zip(&self.shown.sources).enumerate();
            pairs
                .filter(|(_, (a, b))| !Arc::ptr_eq(&a.generated, &b.generated))
                .map(|(i, _)| i)
                .collect()
        } else {
            Vec::new()
        };
        let recoloured = self.colours.as_ref() != Some(&colours);
        if same_sources && !recoloured && changed.is_empty() {
            return Ok(());
        }
        if same_sources && !recoloured && sources.len() <= QUICK {
            return self.replace(sources, &changed, &state.document.look);
        }
        self.build(state, sources, colours, ctx);
        Ok(())
    }

    fn replace(
        &mut self,
        sources: Vec<ShownSource>,
        changed: &[usize],
        look: &Look,
    ) -> Result<(), DeviceError> {
        let colouring = scene::colours(&sources, look);
        let mut scene = self.maker.take_scene();
        let mut replaced = Ok(());
        for &place in changed {
            let template = neurotess::render::Template {
                mesh: &sources[place].generated.mesh,
                words: &colouring.words[place],
                values: &[],
            };
            let id = neurotess::render::TemplateId(place as u32);
            replaced = replaced.and_then(|()| scene.replace(&self.gpu, id, &template));
        }
        self.maker.set_scene(scene);
        self.live.set_colours(colouring.table.clone());
        self.shown.sources = sources;
        self.shown.colouring = Arc::new(colouring);
        self.drawn = None;
        replaced
    }

    fn build(
        &mut self,
        state: &State,
        sources: Vec<ShownSource>,
        key: ColourKey,
        ctx: &egui::Context,
    ) {
        let (sender, receiver) = channel();
        let (gpu, look, ctx) = (
            Arc::clone(&self.gpu),
            state.document.look.clone(),
            ctx.clone(),
        );
        let instances = scene::standing(state, &sources);
        self.building = Some(receiver);
        std::thread::spawn(move || {
            let colouring = Arc::new(scene::colours(&sources, &look));
            let templates = scene::templates(&gpu, &sources, &colouring);
            let shown = Shown {
                sources,
                instances,
                colouring,
            };
            // Nobody waits for it if the window is closed.
            let _ = sender.send(templates.map(|templates| (templates, shown, key)));
            ctx.request_repaint();
        });
    }

    fn wanted(&mut self, state: &State, size: [u32; 2]) -> Drawn {
        let look = &state.document.look;
        let camera = state.view.camera();
        let balls = state.balls(|_| true);
        let mut surface = scene::surface_look(look);
        surface.clip = scene::clip(look, &balls);
        let frozen = state.frozen.map(|view| {
            let camera = view.camera();
            (camera, camera.near(&balls))
        });
        Drawn {
            shot: Shot {
                camera,
                near: camera.near(&balls),
                size,
                look: surface,
                occlusion: if look.occlusion {
                    Occlusion::Fit
                } else {
                    Occlusion::Off
                },
                background: look.background,
                frozen,
            },
            detail: state.document.detail,
            states: scene::states(&state.document),
            standing: scene::standing(state, &self.shown.sources),
        }
    }

    /// Draws at once and coarsely, as coarsely as it takes to keep up.
    fn draft(&mut self, wanted: Drawn, ctx: &egui::Context) -> Result<(), DeviceError> {
        self.moved = Instant::now();
        self.rest = Rest::Waits;
        self.live.stop();
        if self.live.is_busy(&self.gpu) {
            // What was submitted must end first: drafts that pile up come too late.
            ctx.request_repaint_after(Duration::from_millis(3));
            return Ok(());
        }
        if self.drawn.is_some() && self.live.shows_draft() {
            self.keep_up();
        }
        let before = self.drawn.as_ref();
        if before.is_none_or(|d| d.standing != wanted.standing) {
            self.stand(&wanted.standing);
        }
        self.live.set_states(wanted.states.clone());
        self.picks = None;
        self.namer = None;
        self.counted = false;
        self.live.set_outlines(&self.gpu, Outlines::default(), None);
        self.mask = None;
        self.draw_draft(&wanted)?;
        self.drawn = Some(wanted);
        ctx.request_repaint_after(REST);
        Ok(())
    }

    /// By the explorer where it can: it knows neither grids nor another camera.
    fn draw_draft(&mut self, wanted: &Drawn) -> Result<(), DeviceError> {
        let mut shot = wanted.shot;
        let wires = shot.look.wire > 0.0;
        let explorer = match wires || shot.frozen.is_some() {
            true => None,
            false => self.explorer.maker(&self.gpu, &self.shown),
        };
        self.explored = explorer.is_some();
        if let Some(maker) = explorer {
            return self.live.draft(&self.gpu, maker, &shot);
        }
        self.maker.set_refining(Refining {
            // Nothing is left out that would show at rest: holes that come and go look broken.
            choice: coarser(wanted.detail.choice(), self.coarser),
            smallest: wanted.detail.smallest,
            wires,
            ..Refining::default()
        });
        if self.coarser > HALF_FROM {
            shot.size = shot.size.map(|n| n.div_ceil(2));
        }
        self.live.draft(&self.gpu, &mut self.maker, &shot)
    }

    fn stand(&mut self, standing: &[Standing]) {
        self.shown.instances = standing.to_vec();
        let (templates, _) = self.maker.take_scene().into_parts();
        match Scene::new(templates, scene::instances(standing)) {
            Ok(scene) => self.maker.set_scene(scene),
            // Placements are finite by construction; if not, all is built anew.
            Err(_) => self.colours = None,
        }
    }

    /// Drafts become coarser where they take too long, and finer where there is time.
    fn keep_up(&mut self) {
        let took = self.live.last_ms();
        self.note_frame(took);
        if self.explored {
            self.explorer.keep_up(took, DRAFT_MS);
        } else if took > 1.5 * DRAFT_MS {
            self.coarser = (self.coarser * 2.0).min(32.0);
        } else if took < 0.4 * DRAFT_MS {
            self.coarser = (self.coarser / 1.4).max(1.0);
        }
    }

    fn note_frame(&mut self, took: f64) {
        self.frames.push_back(took as f32);
        if self.frames.len() > FRAMES {
            self.frames.pop_front();
        }
    }

    fn refine(&mut self, state: &mut State, ctx: &egui::Context) -> Result<(), DeviceError> {
        let Some(drawn) = &self.drawn else {
            return Ok(());
        };
        let (shot, detail) = (drawn.shot, drawn.detail);
        match self.rest {
            Rest::Waits if self.moved.elapsed() < REST => {
                ctx.request_repaint_after(REST.saturating_sub(self.moved.elapsed()));
            }
            Rest::Waits => {
                if self.live.is_busy(&self.gpu) {
                    ctx.request_repaint_after(Duration::from_millis(5));
                    return Ok(());
                }
                self.maker.set_refining(Refining {
                    choice: detail.choice(),
                    smallest: detail.smallest,
                    wires: shot.look.wire > 0.0,
                    ..Refining::default()
                });
                let steps = Steps {
                    steps: 4,
                    bands: self.bands,
                };
                self.live.begin(shot, steps);
                self.rest = Rest::Slices;
                ctx.request_repaint();
            }
            Rest::Slices => self.slice(shot, ctx)?,
            Rest::Done => self.count(state)?,
        }
        Ok(())
    }

    fn slice(&mut self, shot: Shot, ctx: &egui::Context) -> Result<(), DeviceError> {
        if self.live.is_busy(&self.gpu) {
            ctx.request_repaint_after(Duration::from_millis(5));
            return Ok(());
        }
        if self.live.progress().is_some_and(|share| share > 0.0) {
            let took = self.live.last_ms();
            self.note_frame(took);
            // For the next picture: slices of this one are laid out. Choosing costs each band the same,
            // so many bands would take longer together: no more than three.
            let wanted = f64::from(self.bands) * took / SLICE_MS;
            self.bands = ((f64::from(self.bands) + wanted) / 2.0).clamp(1.0, MOST_BANDS) as u32;
        }
        let whole = self.live.slice(&self.gpu, &mut self.maker)?;
        if whole && self.namer.is_none() && self.picks.is_none() {
            // As soon as the first step shows, the cursor may ask.
            self.live.identify(&self.gpu, &mut self.maker, &shot)?;
            self.namer = Some((self.maker.namer(), shot));
        }
        if self.live.progress().is_none() {
            self.rest = Rest::Done;
        }
        ctx.request_repaint();
        Ok(())
    }

    /// Triangles and patches of the picture at rest, while somebody looks at their panel.
    fn count(&mut self, state: &mut State) -> Result<(), DeviceError> {
        let Some(drawn) = self.drawn.as_ref().filter(|_| !self.counted) else {
            return Ok(());
        };
        if state.tab != crate::command::Tab::Detail || !state.panels {
            return Ok(());
        }
        self.counted = true;
        let shot = drawn.shot;
        let (camera, near) = shot.frozen.unwrap_or((shot.camera, shot.near));
        let frame = neurotess::render::Frame {
            camera,
            near,
            size: shot.size,
            tile: neurotess::render::Tile {
                x: 0,
                y: 0,
                width: shot.size[0],
                height: shot.size[1],
            },
        };
        self.maker.prepare(&self.gpu, &frame)?;
        let stats = self.maker.stats(&self.gpu)?;
        let cells: u64 = self.maker.bytes().iter().map(|(_, bytes)| bytes).sum();
        state.counters = Counters {
            triangles: stats.triangles,
            patches: [stats.patches_drawn, stats.patches],
            bytes: [cells, self.live.bytes()],
            ..std::mem::take(&mut state.counters)
        };
        Ok(())
    }

    fn take_ids(&mut self, ctx: &egui::Context) -> Result<(), DeviceError> {
        if self.namer.is_none() {
            return Ok(());
        }
        // Polls the device.
        let _ = self.live.is_busy(&self.gpu);
        let Some((size, ids)) = self.live.ids()? else {
            ctx.request_repaint_after(Duration::from_millis(5));
            return Ok(());
        };
        let Some((namer, _)) = self.namer.take() else {
            return Ok(());
        };
        let shown = &self.shown;
        self.picks = Some(Picks::new(size, &ids, |id| {
            let named = namer.name(id)?;
            let standing = shown.instances.get(named.instance as usize)?;
            let source = shown.sources.get(standing.source)?;
            seen(named, &source.generated.mesh, &standing.placement)
        }));
        ctx.request_repaint();
        Ok(())
    }

    /// Outlines around what is selected and hovered, when that has changed.
    fn outline(&mut self, state: &State) {
        let (Some(picks), Some(drawn)) = (&self.picks, &self.drawn) else {
            return;
        };
        let key = MaskKey {
            hovered: state.hovered,
            selected: state.document.selected().collect(),
            shot: drawn.shot,
        };
        if self.mask.as_ref() == Some(&key) {
            return;
        }
        let facts = |neuron: usize, section: u32| {
            let source = state.source_of(neuron)?;
            source.sections.get(section as usize).copied()
        };
        let mask = picks.mask(&state.document, state.hovered, facts);
        // Wider lines would drown thin neurites.
        let outlines = Outlines {
            width: 1,
            selected: scene::SELECTION,
            ..Outlines::default()
        };
        self.live
            .set_outlines(&self.gpu, outlines, Some((picks.size(), &mask)));
        self.live.show(&self.gpu);
        self.mask = Some(key);
    }

    /// The picture for egui; the same number for as long as the texture is the same.
    fn texture_id(&mut self) -> Option<egui::TextureId> {
        let texture = self.live.texture()?;
        let key = ([texture.width(), texture.height()], self.live.shows_draft());
        if let Some((id, size, draft)) = self.texture
            && (size, draft) == key
        {
            return Some(id);
        }
        let view = texture.create_view(&Default::default());
        let mut renderer = self.render.renderer.write();
        // Drafts may be smaller than they are shown.
        let filter = match key.1 {
            true => wgpu::FilterMode::Linear,
            false => wgpu::FilterMode::Nearest,
        };
        let id = match self.texture {
            Some((id, ..)) => {
                let device = &self.render.device;
                renderer.update_egui_texture_from_wgpu_texture(device, &view, filter, id);
                id
            }
            None => renderer.register_native_texture(&self.render.device, &view, filter),
        };
        self.texture = Some((id, key.0, key.1));
        Some(id)
    }
}

/// The same choice, so much coarser.
fn coarser(choice: Choice, factor: f32) -> Choice {
    let level = |level: u32| ((level as f32 / factor).round() as u32).max(1);
    match choice {
        Choice::PixelError(error) => Choice::PixelError(error * factor),
        Choice::PixelSize(size) => Choice::PixelSize(size * factor),
        Choice::MaxError(error) => Choice::MaxError(error * factor),
        Choice::Homogeneous(l) => Choice::Homogeneous(level(l)),
        Choice::Distance { level: l, far } => Choice::Distance {
            level: level(l),
            far,
        },
        Choice::PerPoint => Choice::PerPoint,
    }
}

impl From<BuildError> for String {
    fn from(error: BuildError) -> Self {
        error.to_string()
    }
}
