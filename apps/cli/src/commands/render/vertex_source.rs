//! Who makes the vertices: `--lod`, and what it says of itself.

use std::collections::BTreeMap;

use neurotess::refine::{Lod, LodCriterion, RefineOptions};
use neurotess::render::{
    Adaptive, AdaptiveSettings, BoundingSphere, Camera, DEFAULT_BUDGET, Exploration,
    ExplorationStats, Frame, Gpu, Instance, PictureOptions, Placement, Prerefined,
    PrerefinedSurface, Proxy, Scene, Template, Templates, Tile, VertexSource,
};
use rayon::prelude::*;

use super::Sitting;
use super::args::{LodArg, RenderArgs};
use super::cells::Cell;
use super::scene::covering;
use crate::report::usage;

/// A maker of any kind.
pub(crate) enum Maker {
    /// In memory.
    Stored(Box<Prerefined>),
    /// As it is drawn.
    OnTheFly(Box<Adaptive>),
    /// Within a budget.
    Exploring(Box<Exploration>),
}

/// What a maker draws and holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Made {
    pub(crate) patches: u64,
    pub(crate) patches_drawn: u64,
    pub(crate) vertices: u64,
    pub(crate) triangles: u64,
    pub(crate) levels: BTreeMap<u32, u64>,
    pub(crate) bytes: BTreeMap<&'static str, u64>,
    pub(crate) bytes_per_point: f64,
    pub(crate) exploration: Option<ExplorationStats>,
}

/// The mode that options ask for.
///
/// # Errors
/// Wrong usage: a level where levels follow from the error.
pub(crate) fn mode(args: &RenderArgs) -> anyhow::Result<LodArg> {
    let exploring = args.lod == Some(LodArg::Exploration);
    if args.budget.is_some() && !exploring {
        return usage("--budget is for --lod exploration");
    }
    if exploring && args.pixels.is_some() {
        return usage("--lod exploration is within half a pixel: leave out --pixels");
    }
    match (args.lod, args.level) {
        (Some(LodArg::Adaptive), Some(_)) => usage(
            "--lod adaptive chooses levels by --pixels: leave out --level, or use --lod homogeneous",
        ),
        (Some(LodArg::Exploration | LodArg::Static), Some(_)) => {
            usage("this --lod has no levels: leave out --level, or use --lod homogeneous")
        }
        (Some(LodArg::Static), None) if args.pixels.is_some() => {
            usage("--lod static is within half a pixel: leave out --pixels, or use --lod adaptive")
        }
        (Some(mode), _) => Ok(mode),
        (None, Some(_)) => Ok(LodArg::Homogeneous),
        (None, None) => Ok(LodArg::Adaptive),
    }
}

impl Maker {
    /// Uploads the cells.
    pub(crate) fn new(
        gpu: &Gpu,
        options: &PictureOptions,
        sitting: &Sitting<'_>,
    ) -> anyhow::Result<Self> {
        let Sitting {
            args,
            cells,
            places,
            colored,
            ..
        } = *sitting;
        let lod = match mode(args)? {
            LodArg::Prerefined => return stored(gpu, sitting),
            LodArg::Homogeneous => LodCriterion::Homogeneous(args.level.unwrap_or(DEFAULT_LEVEL)),
            LodArg::Adaptive => LodCriterion::PixelError(args.error() as f32),
            LodArg::Static => LodCriterion::PixelError(0.5),
            LodArg::Exploration => return exploring(gpu, options, sitting),
        };
        let list: Vec<Template<'_>> = cells
            .iter()
            .zip(&colored.coloring.color_keys)
            .map(|(cell, color_keys)| Template {
                mesh: &cell.mesh,
                color_keys,
                values: &[],
            })
            .collect();
        let mut templates = Templates::new();
        let ids = templates.add(gpu, &list)?;
        let instances = places.iter().map(|&(cell, placement)| Instance {
            placement,
            ..Instance::new(ids[cell])
        });
        let scene = Scene::new(templates, instances.collect())?;
        let refining = AdaptiveSettings {
            lod,
            wireframe: args.wireframe,
            ..AdaptiveSettings::default()
        };
        let mut maker = Adaptive::new(gpu, scene, refining, options.sub_pixels(gpu))?;
        maker.set_bounds(covering(cells, places));
        Ok(Self::OnTheFly(Box::new(maker)))
    }

    /// As the painter takes it.
    pub(crate) fn as_maker(&mut self) -> &mut dyn VertexSource {
        match self {
            Self::Stored(maker) => maker.as_mut(),
            Self::OnTheFly(maker) => maker.as_mut(),
            Self::Exploring(maker) => maker.as_mut(),
        }
    }

    /// What it draws of a whole picture.
    pub(crate) fn made(
        &mut self,
        gpu: &Gpu,
        camera: &Camera,
        near: f64,
        options: &PictureOptions,
    ) -> anyhow::Result<Made> {
        match self {
            Self::Stored(maker) => Ok(resident(maker)),
            Self::OnTheFly(maker) => {
                maker.prepare(gpu, &whole(gpu, camera, near, options))?;
                let stats = maker.stats(gpu)?;
                let levels = (0..).zip(&stats.level_histogram);
                let levels = levels.filter(|&(_, &sides)| sides > 0);
                Ok(Made {
                    patches: stats.patches,
                    patches_drawn: stats.patches_drawn,
                    vertices: stats.vertices,
                    triangles: stats.triangles,
                    levels: levels.map(|(level, &sides)| (level, sides)).collect(),
                    bytes: maker.bytes().into_iter().collect(),
                    bytes_per_point: maker.bytes_per_point(),
                    exploration: None,
                })
            }
            Self::Exploring(maker) => {
                maker.prepare(gpu, &whole(gpu, camera, near, options))?;
                let stats = maker.stats(gpu)?;
                Ok(Made {
                    patches_drawn: stats.visible_chunks,
                    vertices: 2 * stats.triangles,
                    triangles: stats.triangles,
                    bytes: maker.bytes().into_iter().collect(),
                    bytes_per_point: maker.bytes_per_point(),
                    exploration: Some(stats),
                    ..Made::default()
                })
            }
        }
    }
}

/// The whole picture as one frame.
fn whole(gpu: &Gpu, camera: &Camera, near: f64, options: &PictureOptions) -> Frame {
    let size = options.size.map(|n| n * options.sub_pixels(gpu));
    Frame {
        camera: *camera,
        near,
        size,
        tile: Tile {
            x: 0,
            y: 0,
            width: size[0],
            height: size[1],
        },
    }
}

fn exploring(gpu: &Gpu, options: &PictureOptions, sitting: &Sitting<'_>) -> anyhow::Result<Maker> {
    let Sitting {
        args,
        cells,
        places,
        colored,
        ..
    } = *sitting;
    let sketches: Vec<Proxy> = cells
        .par_iter()
        .zip(&colored.coloring.color_keys)
        .map(|(cell, words)| Proxy::new(&cell.mesh, words))
        .collect();
    let mut maker = Exploration::new(gpu, options.sub_pixels(gpu))?;
    maker.set_budget(args.budget.unwrap_or(DEFAULT_BUDGET));
    let ids = maker.add(gpu, &sketches)?;
    let instances = places.iter().map(|&(cell, placement)| Instance {
        placement,
        ..Instance::new(ids[cell])
    });
    maker.set_instances(gpu, instances.collect())?;
    Ok(Maker::Exploring(Box::new(maker)))
}

/// Level where none is given.
const DEFAULT_LEVEL: u32 = 4;

fn stored(gpu: &Gpu, sitting: &Sitting<'_>) -> anyhow::Result<Maker> {
    let Sitting {
        args,
        cells,
        places,
        colored,
        cameras,
        balls,
        ..
    } = *sitting;
    if places.iter().any(|(_, at)| *at != Placement::default()) {
        return usage(
            "--lod prerefined draws tracings where they are: circuits need another --lod",
        );
    }
    let painted: Vec<PrerefinedSurface<'_>> = cells
        .iter()
        .zip(&colored.coloring.color_keys)
        .map(|(cell, color_keys)| PrerefinedSurface {
            mesh: &cell.mesh,
            color_keys,
        })
        .collect();
    let levels = |cell: usize| levels(args, cells[cell], cameras, balls);
    let options = RefineOptions::default();
    let maker = Prerefined::new(gpu, &painted, levels, &options, args.wireframe)?;
    Ok(Maker::Stored(Box::new(maker)))
}

/// Levels of a cell: as told, or by the error that shows from the one camera; where it moves, from
/// the nearest that anything seen ever is.
fn levels(
    args: &RenderArgs,
    cell: &Cell,
    cameras: &[Camera],
    balls: &[BoundingSphere],
) -> Lod<'static> {
    let [width, height] = args.size.0.map(f64::from);
    let nearest = |camera: &Camera| camera.nearest_seen(width / height, balls);
    match (args.level, cameras) {
        (Some(level), _) => LodCriterion::Homogeneous(level).into(),
        (None, [camera]) => Lod::seen_from(
            LodCriterion::PixelError(args.error() as f32),
            camera.refine_view(cell.mesh.origin, height, nearest(camera)),
        ),
        (None, _) => {
            let error =
                |camera: &Camera| camera.pixel_slope(height) * nearest(camera) * args.error();
            let least = cameras.iter().map(error).fold(f64::MAX, f64::min);
            LodCriterion::MaxError(least as f32).into()
        }
    }
}

fn resident(maker: &Prerefined) -> Made {
    let resident = maker.resident();
    let bytes = [
        ("vertices", resident.vertex_bytes),
        ("corners", resident.corner_bytes),
    ];
    let sum: u64 = bytes.iter().map(|(_, bytes)| bytes).sum();
    Made {
        patches: resident.patches as u64,
        patches_drawn: maker.patches_drawn() as u64,
        vertices: resident.vertices as u64,
        triangles: resident.triangles as u64,
        levels: resident
            .levels
            .iter()
            .map(|(&l, &n)| (l, n as u64))
            .collect(),
        bytes: bytes.into_iter().collect(),
        bytes_per_point: sum as f64 / resident.points.max(1) as f64,
        exploration: None,
    }
}
