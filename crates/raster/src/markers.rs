//! Markers: synapses and points, as spheres, dots and contact discs. Twin of markers.wgsl.

use std::borrow::Cow;

use glam::{Vec3, Vec4};
use neurotess_picture::markers::{DISC, GROWS, LIFT, MarkerRun, OrderedMarkers};
use neurotess_picture::{Frame, Marker, MarkerSettings};
use rayon::prelude::*;

use crate::bins::{Bins, Triangle, Vertices};
use crate::fragment::Paint;
use crate::geometry::{NO_INSTANCE, Painting, vertex};
use crate::projection::Projection;
use crate::triangle::Drawn;

/// Markers of a scene.
pub struct SceneMarkers {
    ordered: OrderedMarkers,
    markers: Vec<Marker>,
}

impl SceneMarkers {
    /// Markers, drawn by these settings.
    pub fn new(markers: &[Marker], settings: MarkerSettings) -> Self {
        let ordered = OrderedMarkers::new(markers, settings);
        let order = ordered.order.iter();
        Self {
            markers: order.map(|&index| markers[index as usize]).collect(),
            ordered,
        }
    }

    /// Number of markers.
    pub fn len(&self) -> usize {
        self.markers.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.markers.is_empty()
    }

    /// Number of markers that a frame draws, and of those in view.
    pub fn shown(&self, frame: &Frame) -> [usize; 2] {
        let (runs, in_view) = self.ordered.select(frame);
        [runs.iter().map(|run| run.count as usize).sum(), in_view]
    }

    /// What shows of them, on the grid.
    pub(crate) fn drawn<'a>(&'a self, painting: &Painting<'a>) -> Vec<Drawn<'a>> {
        let frame = painting.frame();
        let (runs, _) = self.ordered.select(&frame);
        let least = frame.pixel().times(self.ordered.settings.least);
        let sizes = Sizes {
            radius: self.ordered.radius().max(least.flat) as f32,
            least: least.slope as f32,
        };
        let drawn = runs.par_iter().filter(|run| run.count > 0);
        drawn.map(|run| self.run(run, &sizes, painting)).collect()
    }

    fn run<'a>(&'a self, run: &MarkerRun, sizes: &Sizes, painting: &Painting<'a>) -> Drawn<'a> {
        let projection = painting.projection;
        let markers = &self.markers[run.first as usize..][..run.count as usize];
        let shapes = &self.ordered.shapes;
        let range = &shapes.ranges[run.shape];
        let corners = &shapes.corners[range.start as usize..range.end as usize];
        let mut vertices = Vertices::default();
        let mut bins = Bins::default();
        let going_on = markers.iter().take_while(|_| !painting.watch.is_stopped());
        for (point, marker) in (0..).zip(going_on) {
            let center = (marker.position - projection.eye).as_vec3();
            let depth = (-center.dot(projection.axes[2])).max(projection.near);
            let radius = sizes.radius.max(sizes.least * depth);
            for triangle in corners.chunks_exact(3) {
                let first = vertices.vertices.len() as u32;
                for corner in triangle {
                    let corner = Vec4::from_array(*corner);
                    let (offset, normal) = offset(projection, marker, radius, depth, corner);
                    let position = center + offset * radius;
                    vertices.push(vertex(projection, position, normal, point));
                }
                let triangle = Triangle {
                    corners: [first, first + 1, first + 2],
                    is_front: true,
                    is_half: false,
                };
                bins.add((painting.grid, projection), &vertices, triangle, false);
            }
        }
        let piece = bins.finished(vertices, painting.grid.len());
        let keys: Vec<u32> = markers.iter().map(|marker| marker.color_key).collect();
        Drawn {
            pieces: vec![piece],
            paint: Paint {
                colors: Cow::Owned(painting.colors.of_keys(&keys, NO_INSTANCE, 0)),
                keys: Cow::Owned(keys),
                instance: NO_INSTANCE,
                sheet: None,
                filled: None,
                wire: 0.0,
            },
            perspective: projection.is_perspective(),
        }
    }
}

/// Radius (µm), and least radius (µm) at unit depth.
struct Sizes {
    radius: f32,
    least: f32,
}

/// Offset (radii) and normal of a corner of a marker's shape: see the bindings of markers.wgsl for what its last number
/// says.
fn offset(
    projection: &Projection,
    marker: &Marker,
    radius: f32,
    depth: f32,
    corner: Vec4,
) -> (Vec3, Vec3) {
    let at = corner.truncate();
    if corner.w > 2.0 {
        return contact(marker, radius / projection.sub_pixel(depth), corner);
    }
    let [right, up, backward] = projection.axes;
    let offset = match corner.w > 0.0 {
        true => right * at.x + up * at.y + backward * at.z,
        false => at,
    };
    // What is flat is as light as what faces the viewer.
    let normal = if corner.w > 1.0 { backward } else { offset };
    (offset, normal)
}

/// Of a sphere on a disc. Both grow out of the sphere around the marker's place while they get larger in the picture, so
/// that none appears at once. A marker without a direction stays a sphere. `size`: radius (sub-pixels).
fn contact(marker: &Marker, size: f32, corner: Vec4) -> (Vec3, Vec3) {
    let is_contact = marker.outwards != Vec3::ZERO;
    let t = ((size - GROWS[0]) / (GROWS[1] - GROWS[0])).clamp(0.0, 1.0);
    let share = if is_contact {
        t * t * (3.0 - 2.0 * t)
    } else {
        0.0
    };
    let outwards = if is_contact { marker.outwards } else { Vec3::Z };
    let at = corner.truncate();
    if corner.w <= 3.0 {
        return (at + share * LIFT * outwards, at);
    }
    // Any two axes across (Duff et al., Building an orthonormal basis, revisited, 2017).
    let sign = if outwards.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + outwards.z);
    let b = outwards.x * outwards.y * a;
    let right = Vec3::new(
        1.0 + sign * outwards.x * outwards.x * a,
        sign * b,
        -sign * outwards.x,
    );
    let up = Vec3::new(b, sign + outwards.y * outwards.y * a, -outwards.y);
    let aside = right * at.x + up * at.y;
    // Within the sphere as long as it does not show.
    let wide = 0.5 + (DISC - 0.5) * share;
    let normal = match corner.w {
        w if w < 5.0 => outwards,
        w if w < 6.0 => aside,
        _ => -outwards,
    };
    (aside * wide + outwards * at.z, normal)
}
