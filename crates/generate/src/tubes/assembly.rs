//! Puts somata, joints and rings together into one closed coarse mesh.
//!
//! Every ring is four vertices, counter-clockwise about the path's direction. Two consecutive rings
//! are joined by four lateral patches. A soma makes the vertices of its insertions' rings, a joint its
//! poles and crotches, a path all others.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec3, Vec3};
use neurotess_mesh::{
    CoarseMesh, Patch, PatchKind, Role, SampleId, SectionNumber, SwcType, TracingPoint, Vertex,
};
use neurotess_morphology::Morphology;

use super::facing::QUARTERS;
use crate::plan::fork;
use crate::plan::joint::Joint;
use crate::plan::{self, Layout};
use crate::soma::SomaSurface;
use crate::soma::first_rings;
use crate::soma::{self, BuiltSoma};
use crate::tracing::SomaSphere;
use crate::tracing::{Children, NONE, Root, Skeleton, SkeletonNode};
use crate::tubes::average_normals;

/// Four vertices, counter-clockwise about the path's direction.
pub(super) type Ring = [u32; 4];
/// First two nodes of a path.
pub(super) type PathStart = [u32; 2];

/// Makes the mesh. `orientations`: one per node; `somata`: as many as the morphology has, with the
/// nodes of their insertions in order.
pub(crate) struct Assembly<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) children: &'a Children,
    pub(super) orientations: &'a [DVec3],
    pub(super) mesh: CoarseMesh,
    /// Ring of each insertion node.
    pub(super) insertion_rings: Vec<(u32, Ring)>,
    /// Per node: its joint, if it is a fork.
    pub(super) joints: Vec<Option<Box<MeshJoint>>>,
    pub(super) layout: &'a Layout,
    /// Per inset: the node that its branch begins or ends with.
    pub(super) inset_nodes: Vec<u32>,
    /// Per inset, once its trunk is made.
    pub(super) placed: Vec<Option<PlacedInset>>,
    /// Paths that end in insets that are not placed yet, by these.
    pub(super) waiting: BTreeMap<u32, PathStart>,
    /// Patches near a fork, by the fork's node in the skeleton that was laid out.
    pub(super) fork_patches: Vec<(u32, Range<u32>)>,
}

/// The somata of a cell, as many as the morphology has.
pub(crate) struct Somata<'a> {
    pub(crate) morphology: &'a Morphology,
    pub(crate) soma_spheres: &'a [Option<SomaSphere>],
    pub(crate) surfaces: &'a [Option<BuiltSoma>],
}

/// An inset in the mesh.
pub(super) struct PlacedInset {
    /// Counter-clockwise about the tangent.
    pub(super) ring: Ring,
    pub(super) center: DVec3,
    /// Unit direction of the branch's path.
    pub(super) tangent: DVec3,
}

/// A joint with its vertices in the mesh.
pub(super) struct MeshJoint {
    pub(super) shape: Joint,
    /// Neighbor nodes as the joint numbers them.
    pub(super) neighbors: Vec<u32>,
    pub(super) poles: [u32; 2],
    pub(super) crotches: Vec<u32>,
}

impl MeshJoint {
    /// Ring towards a neighbor, counter-clockwise about the direction away from the joint.
    pub(super) fn ring(&self, neighbor: u32) -> Ring {
        let k = self.crotches.len();
        let number = self
            .neighbors
            .iter()
            .position(|&n| n == neighbor)
            .expect("a path leads to its joint from one of the joint's neighbors");
        let slot = self.shape.slot(number);
        let before = self.crotches[(slot + k - 1) % k];
        [self.poles[0], before, self.poles[1], self.crotches[slot]]
    }
}

impl<'a> Assembly<'a> {
    pub(crate) fn new(layout: &'a Layout, orientations: &'a [DVec3]) -> Self {
        let skeleton = &layout.skeleton;
        // A ring and four patches a node, and something for somata.
        let (nodes, soma) = (skeleton.nodes().len(), 1024);
        let mesh = CoarseMesh {
            vertices: Vec::with_capacity(4 * nodes + soma),
            patches: Vec::with_capacity(4 * nodes + soma),
            tracing: Vec::with_capacity(nodes + soma),
            ..CoarseMesh::default()
        };
        Self {
            skeleton,
            children: skeleton.children(),
            orientations,
            mesh,
            insertion_rings: Vec::new(),
            joints: (0..skeleton.nodes().len()).map(|_| None).collect(),
            layout,
            inset_nodes: inset_nodes(layout),
            placed: layout.insets.iter().map(|_| None).collect(),
            waiting: BTreeMap::new(),
            fork_patches: Vec::new(),
        }
    }

    /// Adds all somata.
    pub(crate) fn somata(&mut self, somata: &Somata<'_>) {
        let ring_nodes = soma::ring_nodes(self.skeleton, somata.surfaces.len());
        for (index, (soma, nodes)) in somata.surfaces.iter().zip(ring_nodes).enumerate() {
            if let (Some(soma), Some(soma_sphere)) = (soma, somata.soma_spheres[index]) {
                let samples = &somata.morphology.somata[index].samples;
                let sample = samples.first().map_or(-1, |s| s.id);
                self.soma(&soma.surface, soma_sphere.center, sample, &nodes);
            }
        }
    }

    /// Adds a soma; `insertions` are the nodes of its rings, in order.
    fn soma(&mut self, surface: &SomaSurface, center: DVec3, sample: i64, insertions: &[u32]) {
        let mut owner = vec![NONE; surface.vertices.len()];
        for ((&node, ring), inset) in insertions.iter().zip(&surface.rings).zip(&surface.insets) {
            let tracing = match inset {
                Some(_) => self.soma_inset(node, center),
                None => self.tracing(node, Role::Insertion),
            };
            ring.iter().for_each(|&v| owner[v as usize] = tracing);
        }
        let first = self.mesh.vertices.len() as u32;
        for (&position, &tracing) in surface.vertices.iter().zip(&owner) {
            let tracing = if tracing == NONE {
                self.mesh.tracing.push(TracingPoint {
                    center: center.as_vec3(),
                    radius: position.distance(center) as f32,
                    tangent: Vec3::ZERO,
                    role: Role::Soma,
                    collar: 0.0,
                    kind: SwcType::SOMA,
                    sample: clamp_id(sample),
                    section: SectionNumber::SOMA,
                });
                self.mesh.tracing.len() as u32 - 1
            } else {
                tracing
            };
            self.mesh.vertices.push(Vertex {
                position: position.as_vec3(),
                normal: Vec3::ZERO,
                tracing,
            });
        }
        let shift = |q: [u32; 4]| q.map(|v| v + first);
        for (ring, quad) in surface.rings.iter().zip(&surface.insets) {
            if let Some(quad) = quad {
                self.lofts(shift(*quad), shift(*ring));
            }
        }
        let patches = surface.quads.iter();
        self.mesh.patches.extend(patches.map(|&q| Patch {
            corners: shift(q),
            kind: PatchKind::Soma,
        }));
        let rings = insertions.iter().zip(&surface.rings);
        self.insertion_rings
            .extend(rings.map(|(&node, &ring)| (node, shift(ring))));
    }

    /// The tracing point of a ring that stands over its soma's surface.
    fn soma_inset(&mut self, node: u32, soma: DVec3) -> u32 {
        let SkeletonNode { center, radius, .. } = *self.skeleton.node(node);
        let tracing = self.tracing(node, Role::Inset);
        let point = &mut self.mesh.tracing[tracing as usize];
        point.tangent = (center - soma).normalize_or(DVec3::Y).as_vec3();
        point.collar = plan::collar(first_rings::SOMA_LIFT * radius, radius, 1.0) as f32;
        tracing
    }

    /// Patches from the sides of a quad to a ring over it, corner by corner.
    pub(super) fn lofts(&mut self, quad: [u32; 4], ring: Ring) {
        for v in ring {
            let vertex = &mut self.mesh.vertices[v as usize];
            let point = &self.mesh.tracing[vertex.tracing as usize];
            if point.role == Role::Inset && vertex.normal == Vec3::ZERO {
                vertex.normal = (vertex.position - point.center).normalize_or(Vec3::Y);
            }
        }
        for k in 0..4 {
            let next = (k + 1) % 4;
            self.mesh.patches.push(Patch {
                corners: [quad[k], quad[next], ring[next], ring[k]],
                kind: PatchKind::Loft,
            });
        }
    }

    /// Adds joints and paths, and returns the mesh, and which patches are near which fork.
    pub(crate) fn finish(mut self) -> (CoarseMesh, Vec<(u32, Range<u32>)>) {
        for node in 0..self.skeleton.nodes().len() as u32 {
            if self.children.of(node).len() > 1 {
                self.add_joint(node);
            }
        }
        self.insertion_rings.sort_unstable_by_key(|&(node, _)| node);
        let mut starts = Vec::new();
        for node in 0..self.skeleton.nodes().len() as u32 {
            let at = self.skeleton.node(node);
            let joint = self.joints[node as usize].is_some();
            // A branch waits until its trunk is made.
            if joint || at.parent == NONE && !matches!(at.root, Root::Inset(_)) {
                for child in 0..self.children.of(node).len() {
                    self.path([node, self.children.of(node)[child]], &mut starts);
                }
            }
            while let Some(start) = starts.pop() {
                self.path(start, &mut starts);
            }
        }
        debug_assert!(self.waiting.is_empty(), "each trunk is made at last");
        average_normals(&mut self.mesh);
        (self.mesh, self.fork_patches)
    }

    fn add_joint(&mut self, fork: u32) {
        let node = *self.skeleton.node(fork);
        let neighbors = fork::neighbors(self.children, self.skeleton, fork);
        let tubes = fork::tubes(self.skeleton, self.children, fork, &neighbors);
        let joint = Joint::new(node.radius, &tubes);
        let tracing = self.tracing(fork, Role::Joint);
        let poles = joint.poles.map(|p| self.vertex(node.center, p, tracing));
        let crotches = joint
            .crotches
            .iter()
            .map(|&c| self.vertex(node.center, c, tracing))
            .collect();
        self.joints[fork as usize] = Some(Box::new(MeshJoint {
            shape: joint,
            neighbors,
            poles,
            crotches,
        }));
    }

    pub(super) fn tracing(&mut self, node: u32, role: Role) -> u32 {
        let SkeletonNode {
            center,
            radius,
            sample,
            kind,
            section,
            ..
        } = *self.skeleton.node(node);
        self.mesh.tracing.push(TracingPoint {
            center: center.as_vec3(),
            radius: radius as f32,
            tangent: self.orientations[node as usize].as_vec3(),
            role,
            collar: 0.0,
            kind,
            sample: clamp_id(sample),
            section,
        });
        self.mesh.tracing.len() as u32 - 1
    }

    pub(super) fn vertex(&mut self, center: DVec3, offset: DVec3, tracing: u32) -> u32 {
        let position = (center + offset).as_vec3();
        let normal = offset.normalize_or_zero().as_vec3();
        self.mesh.vertices.push(Vertex {
            position,
            normal,
            tracing,
        });
        self.mesh.vertices.len() as u32 - 1
    }

    /// A ring of four new vertices at these angles from the frame.
    pub(super) fn own_ring(
        &mut self,
        node: u32,
        role: Role,
        tangent: DVec3,
        frame: DVec3,
        angles: &[f64; 4],
    ) -> Ring {
        let SkeletonNode { center, radius, .. } = *self.skeleton.node(node);
        let tracing = self.tracing(node, role);
        self.mesh.tracing[tracing as usize].tangent = tangent.as_vec3();
        let side = tangent.cross(frame);
        let directions = if *angles == QUARTERS {
            // Nearly all rings, without sines.
            [frame, side, -frame, -side]
        } else {
            angles.map(|angle| frame * angle.cos() + side * angle.sin())
        };
        let ring = directions.map(|direction| self.vertex(center, direction * radius, tracing));
        let slope = if role == Role::Ordinary {
            self.taper(node)
        } else {
            0.0
        };
        for vertex in ring {
            let vertex = &mut self.mesh.vertices[vertex as usize];
            vertex.normal =
                (vertex.normal - (tangent * slope).as_vec3()).normalize_or(vertex.normal);
        }
        ring
    }

    /// Change of radius along the path at an ordinary node.
    fn taper(&self, node: u32) -> f64 {
        let here = self.skeleton.node(node);
        let [child] = self.children.of(node) else {
            return 0.0;
        };
        if here.parent == NONE {
            return 0.0;
        }
        let (before, after) = (self.skeleton.node(here.parent), self.skeleton.node(*child));
        let length = here.center.distance(before.center) + after.center.distance(here.center);
        ((after.radius - before.radius) / length.max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0)
    }
}

fn inset_nodes(layout: &Layout) -> Vec<u32> {
    let mut nodes = vec![NONE; layout.insets.len()];
    for (index, node) in (0..).zip(layout.skeleton.nodes()) {
        if let Some(inset) = node.inset() {
            nodes[inset as usize] = index;
        }
    }
    nodes
}

/// Sample numbers beyond 32 bits cannot be exported: they saturate.
fn clamp_id(id: i64) -> SampleId {
    SampleId(id.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32)
}
