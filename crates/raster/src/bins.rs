//! Triangles of a task, by the tiles that they may cover.

use glam::Vec3;

use crate::grid::{Grid, TILE};
use crate::projection::{Place, Projection, STEPS};

/// A vertex on the grid.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vertex {
    pub(crate) place: Place,
    /// Share of the samples that are covered; far outside 0 to 1 where something is left out.
    pub(crate) coverage: f32,
    /// Distance (µm) to the plane that cuts.
    pub(crate) kept: f32,
    /// Normal in the view, times 32,767.
    pub(crate) normal: [i16; 3],
    /// Thinness times 255.
    pub(crate) thin: u8,
    /// Index of what it has its color of.
    pub(crate) point: u32,
}

/// A vertex before or behind the near plane.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Projected {
    Before(Vertex),
    /// Not before it: its position in the view, and the vertex without a place.
    Behind(Vec3, Vertex),
}

/// Vertices of a surface on the grid.
#[derive(Default)]
pub(crate) struct Vertices {
    pub(crate) vertices: Vec<Vertex>,
    /// By vertex that is behind the near plane: its index, and its position in the view.
    behind: Vec<(u32, Vec3)>,
}

impl Vertices {
    pub(crate) fn push(&mut self, projected: Projected) {
        let vertex = match projected {
            Projected::Before(vertex) => vertex,
            Projected::Behind(position, vertex) => {
                self.behind.push((self.vertices.len() as u32, position));
                vertex
            }
        };
        self.vertices.push(vertex);
    }

    fn is_behind(&self, index: u32) -> bool {
        self.vertices[index as usize].place.nearness <= 0.0
    }

    fn position(&self, index: u32, projection: &Projection) -> Vec3 {
        let found = self.behind.binary_search_by_key(&index, |&(i, _)| i);
        match found {
            Ok(at) => self.behind[at].1,
            Err(_) => projection.view_at(self.vertices[index as usize].place),
        }
    }
}

/// What a task made of a surface: vertices, and triangles by tile.
pub(crate) struct Piece {
    vertices: Vec<Vertex>,
    triangles: Vec<Triangle>,
    /// Triangles of all tiles, one tile after the other.
    in_tiles: Vec<u32>,
    /// By tile: where its triangles begin, and where the last one's end.
    starts: Vec<u32>,
}

/// Set in the index of a vertex that clipping made, until all others are there.
const CLIPPED: u32 = 1 << 31;

/// Triangles of a surface that a task makes.
#[derive(Default)]
pub(crate) struct Bins {
    /// Their corners run around them clockwise on the grid, whose y runs down.
    triangles: Vec<Triangle>,
    clipped: Vec<Vertex>,
    /// Tile and triangle.
    bins: Vec<(u32, u32)>,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    /// Indices of vertices.
    pub(crate) corners: [u32; 3],
    /// Whether one looks at its front.
    pub(crate) is_front: bool,
    /// Whether the side across from its first corner is no edge.
    pub(crate) is_half: bool,
}

impl Piece {
    /// The vertices of a triangle.
    pub(crate) fn corners(&self, triangle: &Triangle) -> [&Vertex; 3] {
        triangle
            .corners
            .map(|corner| &self.vertices[corner as usize])
    }

    /// The triangles of a tile.
    pub(crate) fn of_tile(&self, tile: usize) -> impl Iterator<Item = &Triangle> {
        let [first, end] = [tile, tile + 1].map(|at| self.starts[at] as usize);
        let triangles = self.in_tiles[first..end].iter();
        triangles.map(|&triangle| &self.triangles[triangle as usize])
    }
}

impl Bins {
    /// Adds a triangle, if it may cover a sample. `two_sided`: also one whose back shows.
    pub(crate) fn add(
        &mut self,
        (grid, projection): (&Grid, &Projection),
        vertices: &Vertices,
        triangle: Triangle,
        two_sided: bool,
    ) {
        let corners = triangle.corners;
        match corners.map(|corner| vertices.is_behind(corner)) {
            [false, false, false] => {
                let places = corners.map(|corner| vertices.vertices[corner as usize].place);
                self.add_placed(grid, places, triangle, two_sided);
            }
            [true, true, true] => {}
            _ => {
                let polygon = self.clip(projection, vertices, corners);
                for k in 2..polygon.len() {
                    let fan = [polygon[0], polygon[k - 1], polygon[k]];
                    let places = fan.map(|corner| match corner & CLIPPED {
                        0 => vertices.vertices[corner as usize].place,
                        _ => self.clipped[(corner & !CLIPPED) as usize].place,
                    });
                    let triangle = Triangle {
                        corners: fan,
                        ..triangle
                    };
                    self.add_placed(grid, places, triangle, two_sided);
                }
            }
        }
    }

    fn add_placed(
        &mut self,
        grid: &Grid,
        [a, b, c]: [Place; 3],
        triangle: Triangle,
        two_sided: bool,
    ) {
        // y runs down: what is counter-clockwise to the eye has a negative area.
        let area = i64::from(b.x - a.x) * i64::from(c.y - a.y)
            - i64::from(b.y - a.y) * i64::from(c.x - a.x);
        if area == 0 || (area > 0 && !two_sided) {
            return;
        }
        let (left, right) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (upper, lower) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        // Samples lie at odd multiples of 32 steps: nothing between two of them is covered.
        let between = |low: i32, high: i32| (low - 33) >> 6 == (high - 32) >> 6;
        if grid.many_samples && (between(left, right) || between(upper, lower)) {
            return;
        }
        let sub_pixels = |low: i32, high: i32, k: usize| {
            let drawn = &grid.drawn[k];
            let low = low.div_euclid(STEPS).max(drawn.start);
            let high = high.div_euclid(STEPS).min(drawn.end - 1);
            (low <= high).then(|| [low - drawn.start, high - drawn.start].map(|n| n / TILE))
        };
        let Some([across, down]) = sub_pixels(left, right, 0)
            .zip(sub_pixels(upper, lower, 1))
            .map(<[_; 2]>::from)
        else {
            return;
        };
        let index = self.triangles.len() as u32;
        let [p, q, r] = triangle.corners;
        let is_front = area < 0;
        self.triangles.push(Triangle {
            corners: if is_front { [p, r, q] } else { [p, q, r] },
            is_front,
            ..triangle
        });
        for y in down[0]..=down[1] {
            for x in across[0]..=across[1] {
                self.bins.push(((y * grid.tiles[0] + x) as u32, index));
            }
        }
    }

    /// The part of a triangle before the near plane, as a polygon (Sutherland & Hodgman, Reentrant polygon clipping, 1974).
    fn clip(
        &mut self,
        projection: &Projection,
        vertices: &Vertices,
        corners: [u32; 3],
    ) -> Vec<u32> {
        // A little before the plane, so that what lies on it has a place.
        let near = projection.near + projection.near.abs().max(1e-6) * 1e-4;
        let mut polygon = Vec::with_capacity(4);
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let [from_behind, to_behind] = [from, to].map(|corner| vertices.is_behind(corner));
            if !from_behind {
                polygon.push(from);
            }
            if from_behind == to_behind {
                continue;
            }
            // The same from both triangles that share the side.
            let (a, b) = (from.min(to), from.max(to));
            let [at_a, at_b] = [a, b].map(|corner| vertices.position(corner, projection));
            let share = ((-near - at_a.z) / (at_b.z - at_a.z)).clamp(0.0, 1.0);
            let mut middle = at_a + (at_b - at_a) * share;
            middle.z = -near;
            let [a, b] = [a, b].map(|corner| vertices.vertices[corner as usize]);
            let Some(place) = projection.place(middle) else {
                continue;
            };
            let mix = |a: f32, b: f32| a + (b - a) * share;
            polygon.push(CLIPPED | self.clipped.len() as u32);
            self.clipped.push(Vertex {
                place,
                coverage: mix(a.coverage, b.coverage),
                kept: mix(a.kept, b.kept),
                normal: [0, 1, 2]
                    .map(|k| mix(f32::from(a.normal[k]), f32::from(b.normal[k])) as i16),
                thin: mix(f32::from(a.thin), f32::from(b.thin)) as u8,
                point: if share < 0.5 { a.point } else { b.point },
            });
        }
        polygon
    }

    /// With its vertices, and triangles by tile; within one in the order in which they came.
    pub(crate) fn finished(self, vertices: Vertices, tiles: usize) -> Piece {
        let mut starts = vec![0_u32; tiles + 1];
        for &(tile, _) in &self.bins {
            starts[tile as usize + 1] += 1;
        }
        for tile in 0..tiles {
            starts[tile + 1] += starts[tile];
        }
        let mut in_tiles = vec![0; self.bins.len()];
        // What begins a tile moves to its end, where the next begins.
        for &(tile, triangle) in &self.bins {
            let place = &mut starts[tile as usize];
            in_tiles[*place as usize] = triangle;
            *place += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
        let mut vertices = vertices.vertices;
        let mut triangles = self.triangles;
        let first = vertices.len() as u32;
        if !self.clipped.is_empty() {
            for corner in triangles.iter_mut().flat_map(|t| &mut t.corners) {
                if *corner & CLIPPED != 0 {
                    *corner = first + (*corner & !CLIPPED);
                }
            }
        }
        vertices.extend(self.clipped);
        Piece {
            vertices,
            triangles,
            in_tiles,
            starts,
        }
    }
}
