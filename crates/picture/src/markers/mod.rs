//! Markers: dots, spheres or contact discs that are no part of a membrane, such as synapses.
//!
//! Markers are culled by chunks (chunks.rs); each chunk's size in the picture selects a shape for its markers
//! (shapes.rs), and how many of them are drawn. Markers keep a least size, so that they can be seen from afar, and
//! their cost is bounded by the pixels that they cover and by a budget, not by their number.

mod chunks;
mod shapes;

use glam::{DVec3, Vec3};

use self::chunks::Chunk;
use crate::view::frame::{Frame, Tile};
use crate::view::frustum::shows;

pub use self::chunks::CHUNK;
pub use self::shapes::{DISC, GROWS, LIFT, MarkerShape, Shapes};

/// Most markers of a chunk for each sub-pixel that its bounding sphere covers: further ones could hardly
/// show.
const MAX_PER_SUB_PIXEL: f32 = 4.0;

/// Where a marker is, and its color.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Marker {
    /// Its center (µm).
    pub position: DVec3,
    /// Of one that lies on a membrane: the unit vector away from the inside; zero if there is none.
    pub outwards: Vec3,
    /// What its color is looked up by: see [`ColorTable`](crate::color::ColorTable). Best a category, since
    /// it belongs to no instance that has values.
    pub color_key: u32,
}

/// How markers are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerSettings {
    /// What they are drawn as.
    pub shape: MarkerShape,
    /// Radius (µm).
    pub radius: f64,
    /// Least radius (sub-pixels).
    pub least: f64,
    /// Most triangles of a frame; markers that are too many are left out evenly.
    pub most_triangles: usize,
}

impl Default for MarkerSettings {
    fn default() -> Self {
        Self {
            shape: MarkerShape::Sphere,
            radius: 0.5,
            least: 1.0,
            most_triangles: 20_000_000,
        }
    }
}

/// Markers in the order in which they are stored and drawn.
pub struct OrderedMarkers {
    /// Triangles of the shapes.
    pub shapes: Shapes,
    chunks: Vec<Chunk>,
    /// Index of each stored marker among those that the caller gave.
    pub order: Vec<u32>,
    /// How they are drawn.
    pub settings: MarkerSettings,
}

/// The first markers of a chunk, drawn alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MarkerRun {
    /// Index of the first one in the order.
    pub first: u32,
    /// Index of the shape.
    pub shape: usize,
    /// Number of markers.
    pub count: u32,
}

impl OrderedMarkers {
    /// Orders markers.
    pub fn new(markers: &[Marker], settings: MarkerSettings) -> Self {
        let positions: Vec<DVec3> = markers.iter().map(|marker| marker.position).collect();
        let order = chunks::ordered(&positions);
        Self {
            shapes: Shapes::new(),
            chunks: chunks::chunks(&positions, &order),
            order,
            settings,
        }
    }

    /// Number of chunks.
    pub fn chunks(&self) -> usize {
        self.chunks.len()
    }

    /// Center (µm) of the chunk that a stored marker is in.
    ///
    /// # Panics
    /// If there is no such marker.
    pub fn chunk_center(&self, first: u32) -> DVec3 {
        self.chunks[first as usize / CHUNK].center
    }

    /// Radius (µm): none of points, which have the least size.
    pub fn radius(&self) -> f64 {
        match self.settings.shape {
            MarkerShape::Point => 0.0,
            MarkerShape::Sphere | MarkerShape::Contact => self.settings.radius,
        }
    }

    /// How far (µm) what is drawn for a marker reaches from its place.
    fn reach(&self) -> f64 {
        match self.settings.shape {
            MarkerShape::Contact => self.radius() * f64::from(DISC.max(1.0 + LIFT) + 0.1),
            MarkerShape::Point | MarkerShape::Sphere => self.radius(),
        }
    }

    /// Whether any marker may show in a frame.
    pub fn shows(&self, frame: &Frame) -> bool {
        let (planes, eye) = (frame.frustum(), frame.camera.eye());
        let reach = |chunk: &Chunk| {
            let center = chunk.relative(eye);
            let least = frame.pixel().times(self.settings.least);
            let least = least.at(f64::from(center.length()));
            (chunk.reach + self.reach().max(least)) as f32
        };
        let mut chunks = self.chunks.iter();
        chunks.any(|chunk| shows(&planes, chunk.relative(eye), reach(chunk)))
    }

    /// What a frame draws, chunk by chunk, and the number of markers of those in view. For the whole picture,
    /// whatever the tile, so that tiles fit together.
    pub fn select(&self, frame: &Frame) -> (Vec<MarkerRun>, usize) {
        let whole = Frame {
            tile: Tile {
                x: 0,
                y: 0,
                width: frame.size[0],
                height: frame.size[1],
            },
            ..*frame
        };
        // What lies just outside the picture occludes what is inside.
        let margin = frame.pixel().times(0.1 * f64::from(frame.size[1]));
        let (planes, tile_planes) = (whole.frustum(), frame.frustum());
        let (eye, pixel) = (frame.camera.eye(), frame.pixel());
        let seen = |chunk: &Chunk, planes: &[glam::Vec4; 5]| {
            let center = chunk.relative(eye);
            let reach = chunk.reach + self.reach();
            let around = margin.at(f64::from(center.length()) + reach);
            shows(planes, center, (reach + around) as f32)
        };
        let wanted: Vec<(Chunk, usize, u32)> = self
            .chunks
            .iter()
            .filter(|chunk| seen(chunk, &planes))
            .map(|chunk| {
                let depth = frame.camera.depth(chunk.center);
                let nearest = (depth - chunk.reach).max(frame.near);
                let radius = (self.radius() / pixel.at(nearest)).max(self.settings.least);
                (
                    *chunk,
                    Shapes::of_radius(self.settings.shape, radius as f32),
                    fitting(chunk, pixel.at(depth.max(frame.near))),
                )
            })
            .collect();
        let triangles = |(_, shape, count): &(Chunk, usize, u32)| {
            self.shapes.triangles(*shape) as f64 * f64::from(*count)
        };
        let all: f64 = wanted.iter().map(triangles).sum();
        let share = (self.settings.most_triangles as f64 / all.max(1.0)).min(1.0);
        let mut runs = Vec::new();
        let mut in_view = 0;
        for (chunk, shape, count) in wanted.iter().filter(|(c, ..)| seen(c, &tile_planes)) {
            in_view += chunk.count as usize;
            let count = (share * f64::from(*count)).ceil() as u32;
            runs.push(MarkerRun {
                first: chunk.first,
                shape: *shape,
                count,
            });
        }
        (runs, in_view)
    }
}

/// How many of a chunk's markers are drawn, by the sub-pixels that it covers. `sub_pixel`: size (µm) of one
/// at its depth.
fn fitting(chunk: &Chunk, sub_pixel: f64) -> u32 {
    let radius = (chunk.reach / sub_pixel) as f32 + 1.0;
    let covered = std::f32::consts::PI * radius * radius;
    chunk.count.min((MAX_PER_SUB_PIXEL * covered).ceil() as u32)
}
