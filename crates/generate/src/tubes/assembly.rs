//! Puts somata, joints and paths together into one closed coarse mesh.
//!
//! Every ring is four vertices, counter-clockwise about the path's direction. Two consecutive rings are joined by four
//! lateral patches. A soma makes the vertices of its insertions' rings, a joint its poles and crotches, a path all
//! others.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DVec3, Vec3};
use neurotess_mesh::{
    CoarseMesh, Patch, PatchKind, Role, SampleId, SectionNumber, SwcType, TracingPoint, Vertex,
};

use super::normals::average_normals;
use crate::plan::{Joint, JointShape, Label, Origin, PathEnd, Plan, PlannedRing};
use crate::soma::BuiltSoma;
use crate::tracing::SomaSphere;

/// Four vertices, counter-clockwise about the path's direction.
pub(super) type Ring = [u32; 4];

/// The somata of a cell: as many as the morphology has, and then hubs.
pub(crate) struct Somata<'a> {
    /// What the surface of each is labeled as.
    pub(crate) labels: &'a [SomaLabel],
    pub(crate) soma_spheres: &'a [Option<SomaSphere>],
    pub(crate) surfaces: &'a [Option<BuiltSoma>],
}

/// What the surface of a soma is labeled as.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SomaLabel {
    pub(crate) sample: i64,
    pub(crate) kind: SwcType,
    pub(crate) section: SectionNumber,
}

/// A mesh, and what became of the forks.
pub(crate) struct Tubes {
    pub(crate) mesh: CoarseMesh,
    /// Patches near a fork, by the fork's node in the tracing.
    pub(crate) patches: Vec<(u32, Range<u32>)>,
}

/// The mesh of a plan. Without somata their neurites are closed by caps.
pub(crate) fn tubes(plan: &Plan, somata: Option<&Somata<'_>>) -> Tubes {
    let mut assembly = Assembly::new(plan);
    if let Some(somata) = somata {
        assembly.add_somata(somata);
    }
    assembly.joints = plan
        .joints
        .iter()
        .map(|joint| assembly.joint(joint))
        .collect();
    // A branch waits until its trunk is made.
    let mut starts = Vec::new();
    for origin in &plan.origins {
        match *origin {
            Origin::Root(path) => assembly.path(path, &mut starts),
            Origin::Joint(joint) => {
                let arms = plan.joints[joint as usize].arms.iter();
                for arm in arms.filter(|arm| !arm.at_end) {
                    assembly.path(arm.path, &mut starts);
                }
            }
        }
        while let Some(path) = starts.pop() {
            assembly.path(path, &mut starts);
        }
    }
    debug_assert!(assembly.waiting.is_empty(), "each trunk is made at last");
    average_normals(&mut assembly.mesh);
    Tubes {
        mesh: assembly.mesh,
        patches: assembly.fork_patches,
    }
}

/// A mesh as it grows.
pub(super) struct Assembly<'a> {
    pub(super) plan: &'a Plan,
    pub(super) mesh: CoarseMesh,
    /// By path that begins on a soma: its ring there.
    pub(super) soma_rings: BTreeMap<u32, Ring>,
    pub(super) joints: Vec<MeshJoint>,
    /// By inset, once its trunk is made.
    pub(super) placed: Vec<Option<PlacedInset>>,
    /// Paths that end in insets that are not placed yet, by these.
    pub(super) waiting: BTreeMap<u32, u32>,
    /// Patches near a fork.
    pub(super) fork_patches: Vec<(u32, Range<u32>)>,
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
    pub(super) shape: JointShape,
    poles: [u32; 2],
    crotches: Vec<u32>,
}

impl MeshJoint {
    /// Ring towards an arm, counter-clockwise about the direction away from the joint.
    pub(super) fn ring(&self, arm: usize) -> Ring {
        let count = self.crotches.len();
        let slot = self.shape.slot(arm);
        let before = self.crotches[(slot + count - 1) % count];
        [self.poles[0], before, self.poles[1], self.crotches[slot]]
    }
}

impl<'a> Assembly<'a> {
    fn new(plan: &'a Plan) -> Self {
        let rings: usize = plan.paths.iter().map(|path| path.rings.len()).sum();
        // A ring and four patches for each, and something for somata.
        let (rings, soma) = (rings, 1024);
        Self {
            plan,
            mesh: CoarseMesh {
                vertices: Vec::with_capacity(4 * rings + soma),
                patches: Vec::with_capacity(4 * rings + soma),
                tracing: Vec::with_capacity(rings + soma),
                ..CoarseMesh::default()
            },
            soma_rings: BTreeMap::new(),
            joints: Vec::new(),
            placed: plan.insets.iter().map(|_| None).collect(),
            waiting: BTreeMap::new(),
            fork_patches: Vec::new(),
        }
    }

    /// Adds the vertices of a joint.
    fn joint(&mut self, joint: &Joint) -> MeshJoint {
        let shape = JointShape::new(joint.radius, &self.plan.neighbors(joint));
        let tracing = self.tracing(&joint.ring(), Role::Joint);
        let poles = shape.poles.map(|p| self.vertex(joint.center, p, tracing));
        let crotches = shape.crotches.iter();
        let crotches = crotches.map(|&c| self.vertex(joint.center, c, tracing));
        MeshJoint {
            poles,
            crotches: crotches.collect(),
            shape,
        }
    }

    /// Of a joint that a path begins or ends in, the joint and the number of the path's arm.
    pub(super) fn joint_arm(&self, path: u32, at_end: bool) -> Option<(&MeshJoint, usize)> {
        let planned = &self.plan.paths[path as usize];
        let end = if at_end { planned.end } else { planned.start };
        let PathEnd::Joint(joint) = end else {
            return None;
        };
        let mut arms = self.plan.joints[joint as usize].arms.iter();
        let arm = arms.position(|arm| arm.path == path && arm.at_end == at_end);
        let arm = arm.expect("a path that begins or ends in a joint is one of its arms");
        Some((&self.joints[joint as usize], arm))
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

    /// Adds the tracing point of a ring.
    pub(super) fn tracing(&mut self, ring: &PlannedRing, role: Role) -> u32 {
        let Label {
            sample,
            kind,
            section,
        } = ring.label;
        self.mesh.tracing.push(TracingPoint {
            center: ring.center.as_vec3(),
            radius: ring.radius as f32,
            tangent: ring.normal.as_vec3(),
            role,
            collar: 0.0,
            taper: 0.0,
            border: 0,
            kind,
            sample: sample_id(sample),
            section,
        });
        self.mesh.tracing.len() as u32 - 1
    }

    /// Adds a vertex, which looks away from a center.
    pub(super) fn vertex(&mut self, center: DVec3, offset: DVec3, tracing: u32) -> u32 {
        self.mesh.vertices.push(Vertex {
            position: (center + offset).as_vec3(),
            normal: offset.normalize_or_zero().as_vec3(),
            tracing,
        });
        self.mesh.vertices.len() as u32 - 1
    }
}

/// Sample numbers beyond 32 bits cannot be exported: they saturate.
pub(super) fn sample_id(id: i64) -> SampleId {
    SampleId(id.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32)
}
