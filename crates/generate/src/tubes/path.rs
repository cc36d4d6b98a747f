//! Tubes along a path, from a root, a joint or an inset to an end, a joint or an inset.

use glam::DVec3;
use neurotess_mesh::{Patch, PatchKind, Role, TracingPoint};

use super::assembly::{Assembly, PathStart, PlacedInset, Ring};
use super::facing::{self, Facing};
use super::path_rings::PathRings;
use super::twist::{FIXED, Target, relax};
use crate::plan::{Inset, InsetSite};
use crate::tracing::{NONE, Root};
use crate::tubes::frame;

impl Assembly<'_> {
    /// Builds the tubes from a fork, root or inset to the next fork, end or inset, once that is placed; what leaves
    /// through insets on the way goes to `starts`.
    pub(super) fn path(&mut self, start: PathStart, starts: &mut Vec<PathStart>) {
        let nodes = self.run(start);
        let end = nodes[nodes.len() - 1];
        if let Some(inset) = self.skeleton.node(end).inset()
            && self.placed(end).is_none()
        {
            self.waiting.insert(inset, start);
            return;
        }
        let mut path = self.path_rings(nodes);
        let zones = self.zones_of(&path.nodes);
        self.turn_rings(&mut path, &zones);
        let mut facing: Vec<Facing> = Vec::new();
        for (ring, insets) in &zones {
            facing.extend(facing::assign(&path, *ring, insets));
        }
        let angles = corner_angles(&path, &facing);
        let rings = self.rings(&path, &angles);
        let first_patches = self.tubes(&path, &rings, &facing);
        for mut facing in facing {
            let ring = facing.ring;
            let corners = [angles[ring], angles[ring + 1]];
            facing::settle(&mut facing, &path, corners, &path.cones(ring));
            let node = self.inset(&path, &rings, &facing);
            match self.children.of(node) {
                // Its branch ends here.
                [] => starts.extend(self.waiting.remove(&facing.inset)),
                [second, ..] => starts.push([node, *second]),
            }
        }
        self.note_forks(&path, &zones, &first_patches);
    }

    fn path_rings(&self, nodes: Vec<u32>) -> PathRings {
        let mut centers: Vec<DVec3> = Vec::with_capacity(nodes.len());
        centers.extend(nodes.iter().map(|&n| self.skeleton.node(n).center));
        for end in [0, nodes.len() - 1] {
            if let Some(inset) = self.placed(nodes[end]) {
                centers[end] = inset.center;
            }
        }
        let radii = nodes
            .iter()
            .map(|&n| self.skeleton.node(n).radius)
            .collect();
        let tangents = self.tangents(&nodes, &centers);
        let frames = self.frames(&nodes, &centers, &tangents);
        PathRings {
            nodes,
            centers,
            radii,
            tangents,
            frames,
        }
    }

    /// Nodes from a fork or root to the next fork or end, both included.
    fn run(&self, start: PathStart) -> Vec<u32> {
        let mut nodes = start.to_vec();
        let [_, mut here] = start;
        while let [only] = self.children.of(here) {
            nodes.push(*only);
            here = *only;
        }
        nodes
    }

    fn placed(&self, node: u32) -> Option<&PlacedInset> {
        let inset = self.skeleton.node(node).inset()?;
        self.placed[inset as usize].as_ref()
    }

    /// Zones by their first ring.
    fn zones_of(&self, nodes: &[u32]) -> Vec<(usize, Vec<(u32, Inset)>)> {
        let zones = nodes.iter().enumerate().filter_map(|(ring, &node)| {
            let zone = self.skeleton.node(node).marks.zone_begins;
            (zone != NONE).then_some((ring, zone))
        });
        zones
            .map(|(ring, zone)| {
                let insets = self.layout.zones[zone as usize].iter();
                let insets = insets.map(|&i| (i, self.layout.insets[i as usize]));
                (ring, insets.collect())
            })
            .collect()
    }

    /// Direction of the path at each node; at joints that of the segment.
    fn tangents(&self, nodes: &[u32], centers: &[DVec3]) -> Vec<DVec3> {
        let last = nodes.len() - 1;
        (0..nodes.len())
            .map(|i| {
                let own = self.orientations[nodes[i] as usize];
                if let Some(inset) = self.placed(nodes[i]) {
                    inset.tangent
                } else if self.joints[nodes[i] as usize].is_none() {
                    own
                } else if i == last {
                    (centers[i] - centers[i - 1]).try_normalize().unwrap_or(own)
                } else {
                    (centers[i + 1] - centers[i]).try_normalize().unwrap_or(own)
                }
            })
            .collect()
    }

    /// Rotation-minimizing frames from the start on.
    fn frames(&self, nodes: &[u32], centers: &[DVec3], tangents: &[DVec3]) -> Vec<DVec3> {
        let first = match (&self.joints[nodes[0] as usize], self.first_ring(nodes[0])) {
            (Some(joint), _) => frame::across(joint.shape.normal, tangents[0]),
            (None, Some(ring)) => {
                let corner = self.mesh.vertices[ring[0] as usize].position.as_dvec3();
                frame::across(corner - centers[0], tangents[0])
            }
            (None, None) => tangents[0].any_orthonormal_vector(),
        };
        let mut frames = Vec::with_capacity(nodes.len());
        frames.push(first);
        for i in 1..nodes.len() {
            let way = centers[i] - centers[i - 1];
            frames.push(frame::transport(
                way,
                frames[i - 1],
                tangents[i - 1],
                tangents[i],
            ));
        }
        frames
    }

    /// Ring of an insertion or of an inset.
    fn first_ring(&self, node: u32) -> Option<Ring> {
        if let Some(inset) = self.placed(node) {
            return Some(inset.ring);
        }
        let found = self
            .insertion_rings
            .binary_search_by_key(&node, |&(node, _)| node)
            .ok()?;
        Some(self.insertion_rings[found].1)
    }

    /// Direction of the first corner of the ring that a path's last node has already: a joint's or an inset's.
    fn end_frame(&self, path: &PathRings) -> Option<DVec3> {
        let last = path.nodes.len() - 1;
        let node = path.nodes[last];
        let corner = match (&self.joints[node as usize], self.placed(node)) {
            (Some(joint), _) => joint.shape.normal,
            (None, Some(inset)) => {
                let corner = self.mesh.vertices[inset.ring[0] as usize].position;
                corner.as_dvec3() - inset.center
            }
            (None, None) => return None,
        };
        Some(frame::across(corner, path.tangents[last]))
    }

    /// Turns frames as little as possible between the rings that there are, so that quads face the
    /// branches that leave.
    fn turn_rings(&self, path: &mut PathRings, zones: &[(usize, Vec<(u32, Inset)>)]) {
        let last = path.nodes.len() - 1;
        let end = self.end_frame(path);
        if zones.is_empty() && end.is_none() {
            return;
        }
        let mut targets = vec![Target::default(); last + 1];
        let starts_fixed = self.joints[path.nodes[0] as usize].is_some()
            || self.first_ring(path.nodes[0]).is_some();
        if starts_fixed {
            targets[0].weight = FIXED;
        }
        facing::targets(path, zones, &mut targets);
        if let Some(goal) = end {
            let (_, rest) = frame::quarters(path.frames[last], goal, path.tangents[last]);
            let before = targets[..last].iter().rev().find(|t| t.weight > 0.0);
            let before = before.map_or(0.0, |t| t.angle);
            let quarter = std::f64::consts::FRAC_PI_2;
            targets[last] = Target {
                angle: rest + ((before - rest) / quarter).round() * quarter,
                weight: FIXED,
            };
        }
        let stiffness: Vec<f64> = (0..last)
            .map(|i| {
                let length = path.centers[i].distance(path.centers[i + 1]);
                let radius = path.radii[i].max(path.radii[i + 1]);
                (radius / length.max(1e-9)).clamp(1e-4, 10.0)
            })
            .collect();
        let angles = relax(&stiffness, &targets);
        let turned = path.frames.iter_mut().zip(&path.tangents).zip(angles);
        for ((frame, &tangent), angle) in turned.skip(usize::from(starts_fixed)) {
            *frame = frame::turn(*frame, tangent, angle);
        }
    }

    /// The vertices of all rings: those that there are, and new ones.
    fn rings(&mut self, path: &PathRings, angles: &[[f64; 4]]) -> Vec<Ring> {
        let last = path.nodes.len() - 1;
        (0..=last).map(|i| self.ring(path, i, &angles[i])).collect()
    }

    fn ring(&mut self, path: &PathRings, i: usize, angles: &[f64; 4]) -> Ring {
        let (node, last) = (path.nodes[i], path.nodes.len() - 1);
        if i == 0 {
            if let Some(joint) = &self.joints[node as usize] {
                return joint.ring(path.nodes[1]);
            }
            if let Some(ring) = self.first_ring(node) {
                return ring;
            }
        }
        if i == last
            && let (Some(along), Some(goal)) = (self.last_ring(path), self.end_frame(path))
        {
            let (quarter, _) = frame::quarters(path.frames[i], goal, path.tangents[i]);
            return [0, 1, 2, 3].map(|k: i32| along[(k - quarter).rem_euclid(4) as usize]);
        }
        debug_assert!(i > 0 || self.skeleton.node(node).root == Root::Free);
        let role = if i == 0 || i == last {
            Role::End
        } else {
            Role::Ordinary
        };
        self.own_ring(node, role, path.tangents[i], path.frames[i], angles)
    }

    /// The ring that a path's last node has already, counter-clockwise about the path.
    fn last_ring(&self, path: &PathRings) -> Option<Ring> {
        let last = path.nodes.len() - 1;
        let node = path.nodes[last];
        match &self.joints[node as usize] {
            Some(joint) => {
                // Seen from the path the joint's ring runs the other way round.
                let [up, before, down, after] = joint.ring(path.nodes[last - 1]);
                Some([up, after, down, before])
            }
            None => self.placed(node).map(|inset| inset.ring),
        }
    }

    /// Lateral patches between rings, but for quads that branches leave through, and caps at the ends.
    /// Returns the number of the first patch of each segment, and one past the last.
    fn tubes(&mut self, path: &PathRings, rings: &[Ring], facing: &[Facing]) -> Vec<u32> {
        let (first, last) = (path.nodes[0], path.nodes.len() - 1);
        let mut first_patches = vec![self.mesh.patches.len() as u32];
        let free = self.joints[first as usize].is_none() && self.first_ring(first).is_none();
        if free {
            let [a, b, c, d] = rings[0];
            self.cap([d, c, b, a]);
        }
        let mut facing = facing.iter().peekable();
        for (i, pair) in rings.windows(2).enumerate() {
            let mut open = [false; 4];
            while let Some(branch) = facing.next_if(|f| f.ring == i) {
                open[branch.side] = true;
            }
            let [ring, next] = [pair[0], pair[1]];
            for k in (0..4).filter(|&k| !open[k]) {
                let corners = [ring[k], ring[(k + 1) % 4], next[(k + 1) % 4], next[k]];
                self.mesh.patches.push(Patch {
                    corners,
                    kind: PatchKind::Lateral,
                });
            }
            first_patches.push(self.mesh.patches.len() as u32);
        }
        if self.last_ring(path).is_none() {
            self.cap(rings[last]);
        }
        first_patches
    }

    fn cap(&mut self, corners: Ring) {
        self.mesh.patches.push(Patch {
            corners,
            kind: PatchKind::Cap,
        });
    }

    /// Adds an inset with its lofts; returns the node that its branch begins or ends with.
    fn inset(&mut self, path: &PathRings, rings: &[Ring], facing: &Facing) -> u32 {
        let (ring, side) = (facing.ring, facing.side);
        let inset = self.layout.insets[facing.inset as usize];
        let shape = InsetSite {
            exit: facing.exit,
            direction: facing.direction,
            radius: facing.radius,
            lift: inset.lift,
            along: path.chord(ring),
        }
        .shape(&path.cones(ring));
        let node = self.inset_nodes[facing.inset as usize];
        let tracing = self.tracing(node, Role::Inset);
        let tangent = inset.tangent(shape.direction);
        let (collar, order) = match inset.at_end {
            false => (shape.collar, [0, 1, 2, 3]),
            // Seen from the path that ends here the corners run the other way round.
            true => (-shape.collar, [0, 3, 2, 1]),
        };
        self.mesh.tracing[tracing as usize] = TracingPoint {
            center: shape.center.as_vec3(),
            tangent: tangent.as_vec3(),
            collar: collar as f32,
            ..self.mesh.tracing[tracing as usize]
        };
        let mut inner = [0; 4];
        for k in order {
            let vertex = self.vertex(shape.center, shape.corners[k] - shape.center, tracing);
            self.mesh.vertices[vertex as usize].normal = shape.radials[k].as_vec3();
            inner[k] = vertex;
        }
        let (near, far) = (rings[ring], rings[ring + 1]);
        let after = (side + 1) % 4;
        let outer = [near[side], near[after], far[after], far[side]];
        let first = self.mesh.patches.len() as u32;
        self.lofts(outer, inner);
        self.fork_patches.push((inset.fork, first..first + 4));
        self.placed[facing.inset as usize] = Some(PlacedInset {
            ring: order.map(|k| inner[k]),
            center: shape.center,
            tangent,
        });
        node
    }

    /// Notes which patches are near a fork: those of two segments from joints and insets, and of the
    /// trunk around a zone.
    fn note_forks(
        &mut self,
        path: &PathRings,
        zones: &[(usize, Vec<(u32, Inset)>)],
        first: &[u32],
    ) {
        let last = path.nodes.len() - 1;
        let segments = |from: usize, to: usize| first[from.min(last)]..first[to.min(last)];
        let fork = |end: usize| {
            let node = self.skeleton.node(path.nodes[end]);
            let inset = node.inset().map(|inset| inset as usize);
            inset.map_or(node.marks.fork, |inset| self.layout.insets[inset].fork)
        };
        let (start, end) = (fork(0), fork(last));
        if start != NONE {
            self.fork_patches.push((start, segments(0, 2)));
        }
        if end != NONE {
            self.fork_patches
                .push((end, segments(last.saturating_sub(2), last)));
        }
        for (ring, insets) in zones {
            for (_, inset) in insets {
                let around = segments(ring.saturating_sub(1), ring + 2);
                self.fork_patches.push((inset.fork, around));
            }
        }
    }
}

/// Angles of the corners of every ring.
fn corner_angles(path: &PathRings, facing: &[Facing]) -> Vec<[f64; 4]> {
    let mut from = 0;
    (0..path.nodes.len())
        .map(|ring| {
            while facing.get(from).is_some_and(|f| f.ring + 1 < ring) {
                from += 1;
            }
            let here = facing[from..].iter().take_while(|f| f.ring <= ring);
            facing::corner_angles(ring, &here.collect::<Vec<_>>())
        })
        .collect()
}
