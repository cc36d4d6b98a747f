//! Puts somata, joints and rings together into one closed coarse mesh.
//!
//! Every ring is four vertices, counter-clockwise about the path's direction. Two consecutive rings
//! are joined by four lateral patches. A soma makes the vertices of its insertions' rings, a joint its
//! poles and crotches, a path all others.

use glam::{DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Patch, PatchKind, Role, TracingPoint, Vertex};

use crate::fork;
use crate::frame;
use crate::joint::Joint;
use crate::normals::average_normals;
use crate::skeleton::{Children, NONE, Root, Skeleton, SkeletonNode};
use crate::soma::SomaSurface;

/// Four vertices, counter-clockwise about the path's direction.
type Ring = [u32; 4];

/// Makes the mesh. `orientations`: one per node; `somata`: as many as the morphology has, with the
/// nodes of their insertions in order.
pub(crate) struct Assembly<'a> {
    skeleton: &'a Skeleton,
    children: &'a Children,
    orientations: &'a [DVec3],
    mesh: CoarseMesh,
    /// Ring of each insertion node.
    insertion_rings: Vec<(u32, Ring)>,
    /// Per node: its joint, if it is a fork.
    joints: Vec<Option<Box<MeshJoint>>>,
}

/// A joint with its vertices in the mesh.
struct MeshJoint {
    shape: Joint,
    /// Neighbor nodes as the joint numbers them.
    neighbors: Vec<u32>,
    poles: [u32; 2],
    crotches: Vec<u32>,
}

impl MeshJoint {
    /// Ring towards a neighbor, counter-clockwise about the direction away from the joint.
    fn ring(&self, neighbor: u32) -> Ring {
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
    pub(crate) fn new(skeleton: &'a Skeleton, orientations: &'a [DVec3]) -> Self {
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
        }
    }

    /// Adds a soma; `insertions` are the nodes of its rings, in order.
    pub(crate) fn soma(
        &mut self,
        surface: &SomaSurface,
        center: DVec3,
        sample: i64,
        insertions: &[u32],
    ) {
        let mut owner = vec![NONE; surface.vertices.len()];
        for (&node, ring) in insertions.iter().zip(&surface.rings) {
            let tracing = self.tracing(node, Role::Insertion);
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
                    kind: 1,
                    sample: clamp_id(sample),
                    section: 0,
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
        let patches = surface.quads.iter();
        self.mesh.patches.extend(patches.map(|&q| Patch {
            corners: shift(q),
            kind: PatchKind::Soma,
        }));
        let rings = insertions.iter().zip(&surface.rings);
        self.insertion_rings
            .extend(rings.map(|(&node, &ring)| (node, shift(ring))));
    }

    /// Adds joints and paths, and returns the mesh.
    pub(crate) fn finish(mut self) -> CoarseMesh {
        for node in 0..self.skeleton.nodes().len() as u32 {
            if self.children.of(node).len() > 1 {
                self.add_joint(node);
            }
        }
        self.insertion_rings.sort_unstable_by_key(|&(node, _)| node);
        for node in 0..self.skeleton.nodes().len() as u32 {
            let starts =
                self.skeleton.node(node).parent == NONE || self.joints[node as usize].is_some();
            if starts {
                for child in 0..self.children.of(node).len() {
                    self.path(node, self.children.of(node)[child]);
                }
            }
        }
        average_normals(&mut self.mesh);
        self.mesh
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

    fn tracing(&mut self, node: u32, role: Role) -> u32 {
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
            kind,
            sample: clamp_id(sample),
            section,
        });
        self.mesh.tracing.len() as u32 - 1
    }

    fn vertex(&mut self, center: DVec3, offset: DVec3, tracing: u32) -> u32 {
        let position = (center + offset).as_vec3();
        let normal = offset.normalize_or_zero().as_vec3();
        self.mesh.vertices.push(Vertex {
            position,
            normal,
            tracing,
        });
        self.mesh.vertices.len() as u32 - 1
    }

    /// Builds the tubes from a fork or root down to the next fork or end.
    fn path(&mut self, start: u32, second: u32) {
        let nodes = self.run(start, second);
        let tangents = self.tangents(&nodes);
        let frames = self.frames(&nodes, &tangents);
        let last = nodes.len() - 1;
        let mut ring = self.start_ring(&nodes, &tangents, &frames);
        for i in 1..nodes.len() {
            let next = match &self.joints[nodes[i] as usize] {
                Some(joint) => {
                    // Seen from the path the joint's ring runs the other way round.
                    let [up, before, down, after] = joint.ring(nodes[i - 1]);
                    let along = [up, after, down, before];
                    let goal = frame::across(joint.shape.normal, tangents[i]);
                    let (quarter, _) = frame::quarters(frames[i], goal, tangents[i]);
                    [0, 1, 2, 3].map(|k: i32| along[(k - quarter).rem_euclid(4) as usize])
                }
                None => {
                    let role = if i == last { Role::End } else { Role::Ordinary };
                    self.own_ring(nodes[i], role, tangents[i], frames[i])
                }
            };
            for k in 0..4 {
                let corners = [ring[k], ring[(k + 1) % 4], next[(k + 1) % 4], next[k]];
                self.mesh.patches.push(Patch {
                    corners,
                    kind: PatchKind::Lateral,
                });
            }
            ring = next;
        }
        if self.joints[nodes[last] as usize].is_none() {
            self.mesh.patches.push(Patch {
                corners: ring,
                kind: PatchKind::Cap,
            });
        }
    }

    /// Nodes from a fork or root to the next fork or end, both included.
    fn run(&self, start: u32, second: u32) -> Vec<u32> {
        let mut nodes = vec![start, second];
        let mut here = second;
        while let [only] = self.children.of(here) {
            nodes.push(*only);
            here = *only;
        }
        nodes
    }

    /// Direction of the path at each node; at joints that of the segment.
    fn tangents(&self, nodes: &[u32]) -> Vec<DVec3> {
        let center = |i: usize| self.skeleton.node(nodes[i]).center;
        let last = nodes.len() - 1;
        (0..nodes.len())
            .map(|i| {
                let own = self.orientations[nodes[i] as usize];
                if self.joints[nodes[i] as usize].is_none() {
                    own
                } else if i == last {
                    (center(i) - center(i - 1)).try_normalize().unwrap_or(own)
                } else {
                    (center(i + 1) - center(i)).try_normalize().unwrap_or(own)
                }
            })
            .collect()
    }

    /// Frames along a run: rotation-minimizing from the start, with the angle that remains at a
    /// joint at its end spread in proportion to the length of the path.
    fn frames(&self, nodes: &[u32], tangents: &[DVec3]) -> Vec<DVec3> {
        let center = |i: usize| self.skeleton.node(nodes[i]).center;
        let first = match (
            &self.joints[nodes[0] as usize],
            self.insertion_ring(nodes[0]),
        ) {
            (Some(joint), _) => frame::across(joint.shape.normal, tangents[0]),
            (None, Some(ring)) => {
                let corner = self.mesh.vertices[ring[0] as usize].position.as_dvec3();
                frame::across(corner - center(0), tangents[0])
            }
            (None, None) => tangents[0].any_orthonormal_vector(),
        };
        let mut frames = vec![first];
        let mut lengths = vec![0.0];
        for i in 1..nodes.len() {
            let way = center(i) - center(i - 1);
            frames.push(frame::transport(
                way,
                frames[i - 1],
                tangents[i - 1],
                tangents[i],
            ));
            lengths.push(lengths[i - 1] + way.length());
        }
        let last = nodes.len() - 1;
        if let Some(joint) = &self.joints[nodes[last] as usize] {
            let goal = frame::across(joint.shape.normal, tangents[last]);
            let (_, rest) = frame::quarters(frames[last], goal, tangents[last]);
            let total = lengths[last].max(f64::MIN_POSITIVE);
            for i in 1..=last {
                frames[i] = frame::turn(frames[i], tangents[i], rest * lengths[i] / total);
            }
        }
        frames
    }

    fn insertion_ring(&self, node: u32) -> Option<Ring> {
        let found = self
            .insertion_rings
            .binary_search_by_key(&node, |&(node, _)| node)
            .ok()?;
        Some(self.insertion_rings[found].1)
    }

    fn start_ring(&mut self, nodes: &[u32], tangents: &[DVec3], frames: &[DVec3]) -> Ring {
        if let Some(joint) = &self.joints[nodes[0] as usize] {
            return joint.ring(nodes[1]);
        }
        if let Some(ring) = self.insertion_ring(nodes[0]) {
            return ring;
        }
        debug_assert_eq!(self.skeleton.node(nodes[0]).root, Root::Free);
        let ring = self.own_ring(nodes[0], Role::End, tangents[0], frames[0]);
        let [a, b, c, d] = ring;
        self.mesh.patches.push(Patch {
            corners: [d, c, b, a],
            kind: PatchKind::Cap,
        });
        ring
    }

    fn own_ring(&mut self, node: u32, role: Role, tangent: DVec3, frame: DVec3) -> Ring {
        let SkeletonNode { center, radius, .. } = *self.skeleton.node(node);
        let tracing = self.tracing(node, role);
        self.mesh.tracing[tracing as usize].tangent = tangent.as_vec3();
        let side = tangent.cross(frame);
        let ring = [frame, side, -frame, -side]
            .map(|direction| self.vertex(center, direction * radius, tracing));
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

/// Sample numbers beyond 32 bits cannot be exported: they saturate.
fn clamp_id(id: i64) -> i32 {
    id.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}
