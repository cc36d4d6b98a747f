//! A soma's surface at any size, and the size that keeps what was traced.
//!
//! The neurites' pull adds volume or takes some. So the traced shape is made larger or smaller until the finished
//! surface has the traced volume (or area). Directions are those of size 1; what follows the size are distances, which cost a
//! few operations a vertex.

use glam::DVec3;

use super::insertion_quads::{Insertion, InsertionQuads};
use super::measure::{Coarse, Extent};
use super::pull::Pull;
use super::soma_surface::{SomaRequest, SomaSurface};
use super::sphere::Sphere;
use super::stubs;
use crate::{SomaKeep, SomaMethod};

/// All that a surface of some size follows from.
pub(super) struct Draft<'a> {
    pub(super) request: &'a SomaRequest<'a>,
    pub(super) sphere: &'a Sphere,
    pub(super) pull: &'a Pull<'a>,
    /// Of surface nodes: directions from the center, the distance of what was traced, and the share of it where they
    /// are at size 1.
    pub(super) directions: Vec<DVec3>,
    pub(super) surface: Vec<f64>,
    pub(super) lengths: Vec<f64>,
    pub(super) insertion_quads: &'a InsertionQuads,
    /// The rings' corners, about the soma's center.
    pub(super) corners: &'a [[DVec3; 4]],
    pub(super) insertions: &'a [Insertion],
}

/// Steps over the size; two are enough but for rings that hold most of the surface.
const STEPS: u32 = 5;
/// Share of what is kept by which the finished soma may be off.
const EXACT: f64 = 5e-4;
/// Sizes that are tried of what grows in all directions: beyond, rings would hold the surface far from where it was traced.
const SIZES: [f64; 2] = [0.7, 1.3];

/// Volume (µm³) of what was traced up to these first rings, neurites included, and area (µm²) of the soma.
pub(super) fn traced(request: &SomaRequest<'_>, insertions: &[Insertion]) -> (f64, f64) {
    let (volume, area) = request.soma.traced();
    let of_neurites = stubs::up_to_rings(request.soma.stubs(), insertions);
    (volume + of_neurites, area)
}

impl Draft<'_> {
    /// The surface of the size that keeps what is asked for.
    pub(super) fn fitting(&self) -> SomaSurface {
        let (volume, area) = traced(self.request, self.insertions);
        let elastic = self.request.method == SomaMethod::Fem;
        let kept = |extent: &Extent| match self.request.keep {
            SomaKeep::Scale => 1.0,
            SomaKeep::Volume => extent.volume / volume,
            // Of a body that is as large, the root of its area.
            SomaKeep::Area => (extent.area + extent.open) / area,
        };
        let grows_by = self.request.soma.shape().grows_by();
        let power = match self.request.keep {
            SomaKeep::Area => 1.5 / grows_by,
            SomaKeep::Scale | SomaKeep::Volume => 1.0 / grows_by,
        };
        let sizes = SIZES.map(|size| size.powf(3.0 / grows_by));
        let surface = self.of_size(1.0);
        if !elastic {
            return surface;
        }
        let mut best = (kept(&surface.extent), surface);
        let mut before = (1.0, best.0);
        let mut size = f64::powf(best.0, -power);
        for _ in 0..STEPS {
            let is_positive = best.0.is_finite() && best.0 > 0.0;
            if !is_positive || (best.0 - 1.0).abs() <= EXACT {
                break;
            }
            size = size.clamp(sizes[0], sizes[1]);
            let surface = self.of_size(size);
            let here = (size, kept(&surface.extent));
            // Along the secant in the logarithm, which is nearly straight.
            let slope = (here.1 / before.1).ln() / (here.0 / before.0).ln();
            size = match slope.is_finite() && slope > 0.1 {
                true => here.0 * (-here.1.ln() / slope).exp(),
                false => here.0 * f64::powf(here.1, -power),
            };
            before = here;
            if (here.1 - 1.0).abs() < (best.0 - 1.0).abs() {
                best = (here.1, surface);
            } else if here.0 == sizes[0] || here.0 == sizes[1] {
                break;
            }
        }
        SomaSurface {
            off: best.0 - 1.0,
            ..best.1
        }
    }

    /// The surface of a size, about the soma's center.
    fn of_size(&self, size: f64) -> SomaSurface {
        let same = size == 1.0;
        let mut vertices: Vec<DVec3> = (0..self.sphere.surface)
            .map(|node| {
                let direction = self.directions[node];
                if same {
                    return direction * (self.lengths[node] * self.surface[node]);
                }
                let surface = self.request.soma.surface_of_size(direction, size);
                let grown = surface / self.surface[node];
                direction * (self.pull.node(node, grown).length() * surface)
            })
            .collect();
        let quads = self.insertion_quads.quads.iter();
        let mut rings: Vec<[u32; 4]> = quads.map(|&quad| self.sphere.quads[quad]).collect();
        let mut insets = vec![None; rings.len()];
        let mut insertions = self.insertions.to_vec();
        let places = rings.iter_mut().zip(self.corners);
        for ((ring, corners), (insertion, inset)) in
            places.zip(insertions.iter_mut().zip(&mut insets))
        {
            if insertion.inset {
                let before = insertion.center();
                insertion.raise(ring.map(|v| vertices[v as usize].length()));
                let raised = insertion.center() - before;
                *inset = Some(*ring);
                let first = vertices.len() as u32;
                *ring = [0, 1, 2, 3].map(|k| first + k);
                vertices.extend(corners.map(|corner| corner + raised));
                continue;
            }
            for (&vertex, &corner) in ring.iter().zip(corners) {
                vertices[vertex as usize] = corner;
            }
        }
        let mut taken = vec![false; self.sphere.quads.len()];
        let quads = self.insertion_quads.quads.iter();
        quads.for_each(|&quad| taken[quad] = true);
        let left = self.sphere.quads.iter().zip(&taken);
        let left = left.filter(|(_, taken)| !**taken).map(|(quad, _)| *quad);
        let quads: Vec<[u32; 4]> = left.collect();
        let coarse = Coarse {
            vertices: &vertices,
            quads: &quads,
            rings: &rings,
            insets: &insets,
            insertions: &insertions,
        };
        let extent = coarse.extent();
        let center = self.request.soma.center;
        vertices.iter_mut().for_each(|vertex| *vertex += center);
        SomaSurface {
            vertices,
            quads,
            rings,
            insets,
            insertions,
            shrunk: 0,
            turned: 0,
            misfits: 0,
            off: 0.0,
            folded: 0,
            dropped: Vec::new(),
            extent,
        }
    }
}
