//! What all surfaces of a band are drawn with: the view, the grid, colors.

use glam::Vec3;
use neurotess_picture::color::ColorTable;
use neurotess_picture::recolor::Contrast;
use neurotess_picture::{Frame, Look, Tile, Viewpoint, VisibleKey, Watch};

use crate::bins::{Projected, Vertex};
use crate::grid::Grid;
use crate::projection::Projection;

/// Instance of what is no neuron: beyond all instances, so it has neither values nor a state.
pub(crate) const NO_INSTANCE: u32 = u32::MAX - 1;

/// How a band is drawn.
pub(crate) struct Painting<'a> {
    pub(crate) view: Viewpoint,
    /// Width and height (sub-pixels) of the whole picture.
    pub(crate) size: [u32; 2],
    /// Sub-pixels per pixel, along one side.
    pub(crate) scale: u32,
    pub(crate) grid: &'a Grid,
    pub(crate) projection: &'a Projection,
    pub(crate) look: &'a Look,
    pub(crate) colors: &'a Colors<'a>,
    /// Half the width (sub-pixels) of the wireframe's lines; 0: none.
    pub(crate) wire: f32,
    /// Says when to stop; another thread may ask for it.
    pub(crate) watch: &'a Watch,
}

impl Painting<'_> {
    /// What is drawn, as a tile of the whole picture.
    pub(crate) fn frame(&self) -> Frame {
        let [across, down] = &self.grid.drawn;
        Frame {
            tile: Tile {
                x: across.start,
                y: down.start,
                width: across.len() as u32,
                height: down.len() as u32,
            },
            ..Frame::whole(self.view.camera, self.view.near, self.size)
        }
    }
}

/// Linear colors of color keys.
pub(crate) struct Colors<'a> {
    table: &'a ColorTable,
    linear: Vec<[f32; 4]>,
    contrast: Contrast,
}

impl<'a> Colors<'a> {
    pub(crate) fn new(table: &'a ColorTable, look: &Look) -> Self {
        Self {
            table,
            linear: table.linear(),
            contrast: Contrast::new(look),
        }
    }

    /// Whether instances of one template have other colors.
    pub(crate) fn differ(&self) -> bool {
        self.table.values.instances() > 0
    }

    /// Of these keys of an instance in a state, each with how much of an edge it has.
    pub(crate) fn of_keys(&self, keys: &[u32], instance: u32, state: u32) -> Vec<[f32; 4]> {
        let color = |&color_key: &u32| {
            let key = VisibleKey {
                instance,
                color_key,
            };
            let color = self
                .contrast
                .key_color(self.table, &self.linear, &key, None);
            self.contrast.in_state(color, state)
        };
        keys.iter().map(color).collect()
    }
}

/// A vertex of something that is never widened.
pub(crate) fn vertex(
    projection: &Projection,
    position: Vec3,
    normal: Vec3,
    point: u32,
) -> Projected {
    let look = Shown {
        coverage: 1.0,
        thin: 0.0,
        point,
    };
    placed_vertex(projection, position, normal, look)
}

/// What a vertex has besides its place.
#[derive(Clone, Copy)]
pub(crate) struct Shown {
    pub(crate) coverage: f32,
    pub(crate) thin: f32,
    pub(crate) point: u32,
}

/// A vertex on the grid.
pub(crate) fn placed_vertex(
    projection: &Projection,
    position: Vec3,
    normal: Vec3,
    shown: Shown,
) -> Projected {
    let at = projection.in_view(position);
    let [x, y, z] = (projection.in_view(normal) * 32767.0).to_array();
    let mut vertex = Vertex {
        coverage: shown.coverage,
        kept: projection.kept(position),
        normal: [x, y, z].map(|n| n as i16),
        thin: (shown.thin * 255.0) as u8,
        point: shown.point,
        ..Vertex::default()
    };
    match projection.place(at) {
        Some(place) => {
            vertex.place = place;
            Projected::Before(vertex)
        }
        None => Projected::Behind(at, vertex),
    }
}
