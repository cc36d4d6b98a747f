//! Whether a mesh is a surface around what was traced at all: no piece of it has a negative volume, and none is far outside
//! of the tracing. Where a path turns back within its own tube and none of its rings can be turned or left out, the tube
//! runs through itself inside out. Then the path is simplified until it does not: what is lost lies inside the tube.

use std::collections::BTreeSet;

use glam::Vec3;
use neurotess_mesh::{
    CoarseMesh, Extent, Patch, PatchKind, SurfaceMesh, SurfaceVertex, TracingPoint,
};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement, patch_points};

use crate::judge::part::Part;
use crate::tracing::{NONE, Root, Skeleton};

/// Levels at which a surface is looked at whose tubes turn over: the rings alone, what is between them, and that more finely.
const LEVELS: [u32; 3] = [1, 2, 4];
/// The surface is within the box around all traced points, each with so many radii around it. Between the points that are
/// looked at it may reach farther, and nothing is to be beyond two radii: with 1.8, one of some thousand paths that turn
/// back was.
const MAX_RADII: f32 = 1.5;
/// Steps along a side of a patch that may reach far.
const STEPS: u32 = 8;
/// A ring whose normal is this far from the way to the next one bends the tube between them beyond both: cosine of 73°. By
/// eye; what bends less stays between its rings.
const LEANING: f32 = 0.3;
/// A tube whose rings differ more than this is wide beside its thinner ring. By eye.
const TAPERED: f32 = 2.0;

/// The file's own numbers of samples on pieces of the surface that are inside out, or where it is far from the tracing: none
/// of a sound one. Only pieces with a tube that turns over are looked at as a whole, and refined only where that tube may
/// outweigh the others: to refine a cell takes as long as making it.
pub(crate) fn faulty_samples(mesh: &CoarseMesh) -> BTreeSet<i32> {
    let reach = mesh.around_tracing(MAX_RADII);
    let mut faulty = BTreeSet::new();
    // Lateral patches, those that turn over and those that lean.
    let (mut turned, mut leaning) = (Vec::new(), Vec::new());
    for (patch, &Patch { corners, kind }) in mesh.patches.iter().enumerate() {
        let may_reach_far = match kind {
            PatchKind::Lateral => {
                let (cosine, taper) = bend(mesh, corners);
                if cosine < 0.0 {
                    turned.push(patch);
                }
                if cosine < LEANING {
                    leaning.push(patch);
                }
                cosine < LEANING || taper > TAPERED
            }
            PatchKind::Loft => true,
            PatchKind::Soma | PatchKind::Cap => false,
        };
        if may_reach_far && reaches_beyond(mesh, &reach, patch) {
            faulty.extend(corners.map(|corner| point(mesh, corner).sample.0));
        }
    }
    if turned.is_empty() {
        return faulty;
    }
    for piece in doubtful_pieces(mesh, &turned, &leaning) {
        let part = Part::new(mesh, piece).mesh;
        for level in LEVELS {
            let lod = LodCriterion::Homogeneous(level);
            let refined = Refinement::new(&part, lod, &RefineOptions::default());
            let surface = SurfaceMesh::collect(&refined);
            let outside = surface
                .vertices
                .iter()
                .filter(|vertex| !reach.has(vertex.position));
            faulty.extend(outside.map(|vertex| vertex.point));
            faulty.extend(inside_out(&surface).map(|vertex| vertex.point));
        }
    }
    faulty
}

/// The patches of pieces that have some that turn over, but for pieces with so much more volume than their `leaning` patches
/// may have that they are right side out at every level.
fn doubtful_pieces(mesh: &CoarseMesh, turned: &[usize], leaning: &[usize]) -> Vec<Vec<u32>> {
    let corners = || mesh.patches.iter().map(|patch| patch.corners);
    let mut pieces = Pieces::new(mesh.vertices.len());
    for [a, b, c, d] in corners() {
        pieces.join(a, b);
        pieces.join(a, c);
        pieces.join(a, d);
    }
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let at = |corner: u32| mesh.vertices[corner as usize].position;
    let radius = |corner: u32| point(mesh, corner).radius;
    let volumes = volumes(&mut pieces, corners().flat_map(halves), at, radius);
    let mut unknown = vec![0.0; mesh.vertices.len()];
    for &patch in leaning {
        let corners = mesh.patches[patch].corners;
        let thickest = corners.map(radius).into_iter().fold(0.0, f32::max);
        let [a, b, c, d] = corners.map(at);
        let length = a.distance(d).max(b.distance(c));
        let volume = length * thickest * thickest;
        unknown[pieces.of(corners[0]) as usize] += f64::from(volume);
    }
    let first = |patch: usize| mesh.patches[patch].corners[0];
    let mut doubtful: Vec<u32> = turned.iter().map(|&p| pieces.of(first(p))).collect();
    doubtful.sort_unstable();
    doubtful.dedup();
    doubtful.retain(|&piece| {
        let [volume, of_tube] = volumes[piece as usize];
        volume <= CLEAR_VOLUME * of_tube + MAX_TURNED * unknown[piece as usize]
    });
    let mut patches = vec![Vec::new(); doubtful.len()];
    for (patch, corners) in (0..).zip(corners()) {
        if let Ok(place) = doubtful.binary_search(&pieces.of(corners[0])) {
            patches[place].push(patch);
        }
    }
    patches
}

fn reaches_beyond(mesh: &CoarseMesh, reach: &Extent, patch: usize) -> bool {
    let corners = mesh.patches[patch].corners;
    let own = corners.iter().fold(Extent::NONE, |own, &corner| {
        own.with(mesh.vertices[corner as usize].position)
    });
    // No curve between the corners leaves them by more than they are apart: nearly all patches are far within.
    let apart = Vec3::splat(own.low.distance(own.high));
    if reach.has(own.low - apart) && reach.has(own.high + apart) {
        return false;
    }
    let mut points = Vec::with_capacity((STEPS as usize + 1).pow(2));
    let options = RefineOptions::default();
    patch_points(mesh, &[patch as u32], STEPS, &options, &mut points);
    !points.into_iter().all(|point| reach.has(point))
}

fn point(mesh: &CoarseMesh, corner: u32) -> &TracingPoint {
    &mesh.tracing[mesh.vertices[corner as usize].tracing as usize]
}

/// Of the angles between the normals of a tube's two rings and the way from one to the other, the cosine of the greatest;
/// and how many times the thicker ring is as thick as the other.
fn bend(mesh: &CoarseMesh, corners: [u32; 4]) -> (f32, f32) {
    let [near, far] = [corners[0], corners[3]].map(|corner| point(mesh, corner));
    let way = (far.center - near.center).normalize_or_zero();
    let cosine = near
        .tangent
        .dot(far.tangent)
        .min(near.tangent.dot(way))
        .min(far.tangent.dot(way));
    let (thin, thick) = (near.radius.min(far.radius), near.radius.max(far.radius));
    (cosine, thick / thin)
}

/// Least volume of a piece, as a share of that of tubes with its area and radii: half of one times the other. A tube that
/// is partly inside out has a part of the volume at one level and less than nothing at the next.
const MIN_VOLUME: f64 = 0.1;
/// A piece whose rings alone have this share of that volume keeps [`MIN_VOLUME`] between them: a straight tube of four
/// sides has 0.7.
const CLEAR_VOLUME: f64 = 0.3;
/// Most volume that a leaning patch may take from its piece, in times its longer side and the square of its thicker radius: a
/// quarter of a tube has 0.8 of that, and one that bends is at most three times as long and inside out all along.
const MAX_TURNED: f64 = 4.0;

/// The vertices of connected pieces of a closed surface that have hardly any volume, or less than none.
fn inside_out(surface: &SurfaceMesh) -> impl Iterator<Item = &SurfaceVertex> {
    let mut pieces = Pieces::new(surface.vertices.len());
    let faces = &surface.faces;
    let halves = |&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]];
    let quads = faces.quads.iter().flat_map(halves);
    let triangles = faces.triangles.iter().copied().chain(quads);
    for [a, b, c] in triangles.clone() {
        pieces.join(a, b);
        pieces.join(a, c);
    }
    let at = |corner: u32| surface.vertices[corner as usize].position;
    let radius = |corner: u32| surface.vertices[corner as usize].radius;
    let volumes = volumes(&mut pieces, triangles, at, radius);
    (0..)
        .zip(&surface.vertices)
        .filter_map(move |(index, vertex)| {
            let [volume, of_tube] = volumes[pieces.of(index) as usize];
            (volume <= MIN_VOLUME * of_tube).then_some(vertex)
        })
}

/// By piece: its volume, and that of a tube with its area and radii.
fn volumes(
    pieces: &mut Pieces,
    triangles: impl Iterator<Item = [u32; 3]>,
    at: impl Fn(u32) -> Vec3,
    radius: impl Fn(u32) -> f32,
) -> Vec<[f64; 2]> {
    let mut volumes = vec![[0.0; 2]; pieces.0.len()];
    for corners in triangles {
        let piece = pieces.of(corners[0]);
        let at = |corner: u32| at(corner).as_dvec3();
        // From a corner of its own piece, so that places far from the origin cost no digits.
        let [a, b, c] = corners.map(|corner| at(corner) - at(piece));
        let area = 0.5 * (b - a).cross(c - a).length();
        let [volume, of_tube] = &mut volumes[piece as usize];
        *volume += a.dot(b.cross(c)) / 6.0;
        *of_tube += 0.5 * area * f64::from(radius(corners[0]));
    }
    volumes
}

/// Which piece each vertex belongs to: the vertex that stands for it, by way of others.
struct Pieces(Vec<u32>);

impl Pieces {
    /// Each vertex on its own.
    fn new(vertices: usize) -> Self {
        Self((0..vertices as u32).collect())
    }

    fn of(&mut self, vertex: u32) -> u32 {
        let mut vertex = vertex;
        while self.0[vertex as usize] != vertex {
            let next = self.0[vertex as usize];
            self.0[vertex as usize] = self.0[next as usize];
            vertex = next;
        }
        vertex
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// How a skeleton becomes simpler, one after the other until the mesh is sound.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Simpler {
    /// No path turns by more than a right angle.
    WithoutTurns,
    /// Between forks, roots and ends all is straight.
    Straight,
    /// Each tree is one straight tube from its root to the end that is farthest from there: of such a tube no piece can be
    /// inside out.
    Tubes,
}

impl Simpler {
    pub(crate) const ALL: [Self; 3] = [Self::WithoutTurns, Self::Straight, Self::Tubes];

    /// The skeleton, with those trees simpler that these samples belong to.
    pub(crate) fn of(self, skeleton: &Skeleton, faulty: &BTreeSet<i32>) -> Skeleton {
        let mut simpler = Skeleton::from_nodes(skeleton.nodes().to_vec());
        match self {
            Self::WithoutTurns => while straighten(&mut simpler, faulty, turns_back) {},
            Self::Straight => {
                straighten(&mut simpler, faulty, |_, _| true);
            }
            Self::Tubes => {
                let keep = roots_and_farthest(&simpler, faulty);
                simpler.retain(&keep);
            }
        }
        simpler
    }
}

/// The root of each node, and of each root whether samples of its tree are faulty.
fn trees(skeleton: &Skeleton, faulty: &BTreeSet<i32>) -> (Vec<u32>, Vec<bool>) {
    let mut roots: Vec<u32> = Vec::with_capacity(skeleton.nodes().len());
    let mut is_faulty = vec![false; skeleton.nodes().len()];
    for (index, node) in (0..).zip(skeleton.nodes()) {
        let root = match node.parent {
            NONE => index,
            parent => roots[parent as usize],
        };
        roots.push(root);
        is_faulty[root as usize] |= faulty.contains(&(node.sample as i32));
    }
    (roots, is_faulty)
}

/// Leaves out ordinary points of faulty trees of which this is true; whether there were any.
fn straighten(
    skeleton: &mut Skeleton,
    faulty: &BTreeSet<i32>,
    leave_out: fn(&Skeleton, u32) -> bool,
) -> bool {
    let (roots, is_faulty) = trees(skeleton, faulty);
    let is_kept = |(index, root): (u32, &u32)| {
        let node = skeleton.node(index);
        let is_ordinary = node.parent != NONE
            && node.root == Root::Free
            && skeleton.children().of(index).len() == 1;
        !(is_faulty[*root as usize] && is_ordinary && leave_out(skeleton, index))
    };
    let keep: Vec<bool> = (0..).zip(&roots).map(is_kept).collect();
    skeleton.retain(&keep);
    keep.contains(&false)
}

fn turns_back(skeleton: &Skeleton, node: u32) -> bool {
    let center = |node: u32| skeleton.node(node).center;
    let (before, after) = (skeleton.node(node).parent, skeleton.children().of(node)[0]);
    (center(node) - center(before)).dot(center(after) - center(node)) <= 0.0
}

/// Of faulty trees their roots, and the end that is farthest from there; all of the others.
fn roots_and_farthest(skeleton: &Skeleton, faulty: &BTreeSet<i32>) -> Vec<bool> {
    let (roots, is_faulty) = trees(skeleton, faulty);
    let mut farthest: Vec<(f64, u32)> = vec![(-1.0, NONE); roots.len()];
    for (index, &root) in (0..).zip(&roots) {
        let way = skeleton
            .node(index)
            .center
            .distance(skeleton.node(root).center);
        let far = &mut farthest[root as usize];
        if index != root && way > far.0 {
            *far = (way, index);
        }
    }
    let is_kept = |(index, &root): (u32, &u32)| {
        !is_faulty[root as usize] || index == root || farthest[root as usize].1 == index
    };
    (0..).zip(&roots).map(is_kept).collect()
}
