//! Tubes along a path, from what it begins in to what it ends in.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use neurotess_mesh::{Patch, PatchKind, Role, TracingPoint, Vertex};

use super::assembly::{Assembly, PlacedInset, Ring};
use super::facing::{self, Facing, QUARTERS};
use super::frame;
use super::path_rings::PathRings;
use super::twist::{FIXED, Target, relax};
use crate::plan::{Inset, InsetSite, Path, PathEnd, PlannedRing};

/// A zone of a path: its first ring, and the insets there.
type Zone = (usize, Vec<(u32, Inset)>);

impl Assembly<'_> {
    /// Builds the tubes of a path; one that ends in an inset waits until that is placed. What leaves through insets on the
    /// way goes to `starts`.
    pub(super) fn path(&mut self, number: u32, starts: &mut Vec<u32>) {
        let plan = self.plan;
        let path = &plan.paths[number as usize];
        if let PathEnd::Inset(inset) = path.end
            && self.placed[inset as usize].is_none()
        {
            self.waiting.insert(inset, number);
            return;
        }
        let ends = self.ends(number);
        let mut rings = self.path_rings(path, &ends);
        let zones = self.zones_of(path);
        turn_rings(&mut rings, &zones, &ends);
        // Each branch gets a quad of its zone, and the corners around it move to make that as wide as the branch.
        let mut facing: Vec<Facing> = Vec::new();
        for (ring, insets) in &zones {
            facing.extend(facing::assign(&rings, *ring, insets));
        }
        let angles = corner_angles(&rings, &facing);
        let corners: Vec<Ring> = (0..=path.last())
            .map(|ring| self.corners(&rings, ring, &angles[ring], &ends))
            .collect();
        let first_patches = self.tubes(&corners, &facing, &ends);
        for mut facing in facing {
            let ring = facing.ring;
            let quad = [angles[ring], angles[ring + 1]];
            facing::settle(&mut facing, &rings, quad, &rings.cones(ring));
            self.inset(&rings, &corners, &facing);
            let inset = &plan.insets[facing.inset as usize];
            match inset.at_end {
                true => starts.extend(self.waiting.remove(&facing.inset)),
                false => starts.push(inset.path),
            }
        }
        self.note_forks(path, &zones, &first_patches);
    }

    /// What is there already at both ends of a path.
    fn ends(&self, path: u32) -> Ends {
        Ends([false, true].map(|at_end| self.made_end(path, at_end)))
    }

    fn made_end(&self, number: u32, at_end: bool) -> Option<MadeEnd> {
        let path = &self.plan.paths[number as usize];
        if let Some((joint, arm)) = self.joint_arm(number, at_end) {
            let ring = joint.ring(arm);
            // Seen from a path that ends in it the joint's ring runs the other way round.
            let [up, before, down, after] = ring;
            return Some(MadeEnd {
                ring: if at_end {
                    [up, after, down, before]
                } else {
                    ring
                },
                corner: joint.shape.normal,
                inset: None,
            });
        }
        let end = if at_end { path.end } else { path.start };
        let placed = end
            .inset()
            .and_then(|inset| self.placed[inset as usize].as_ref());
        let (ring, center, inset) = match placed {
            Some(placed) => (
                placed.ring,
                placed.center,
                Some((placed.center, placed.tangent)),
            ),
            None if at_end => return None,
            None => (*self.soma_rings.get(&number)?, path.rings[0].center, None),
        };
        let corner = self.mesh.vertices[ring[0] as usize].position.as_dvec3();
        Some(MadeEnd {
            ring,
            corner: corner - center,
            inset,
        })
    }

    fn path_rings<'p>(&self, path: &'p Path, ends: &Ends) -> PathRings<'p> {
        let mut centers: Vec<DVec3> = path.rings.iter().map(|ring| ring.center).collect();
        let mut tangents: Vec<DVec3> = path.rings.iter().map(|ring| ring.normal).collect();
        let last = path.last();
        for (end, ring) in ends.0.iter().zip([0, last]) {
            if let Some((center, tangent)) = end.as_ref().and_then(|end| end.inset) {
                (centers[ring], tangents[ring]) = (center, tangent);
            }
        }
        // A joint looks along the segment that leaves it.
        for (end, ring, [from, to]) in [(path.start, 0, [0, 1]), (path.end, last, [last - 1, last])]
        {
            if end.is_joint() {
                tangents[ring] = (centers[to] - centers[from])
                    .try_normalize()
                    .unwrap_or(tangents[ring]);
            }
        }
        let frames = frames(&centers, &tangents, ends);
        PathRings {
            path,
            centers,
            radii: path.rings.iter().map(|ring| ring.radius).collect(),
            tangents,
            frames,
        }
    }

    /// Zones by their first ring.
    fn zones_of(&self, path: &Path) -> Vec<Zone> {
        let inset = |&inset: &u32| (inset, self.plan.insets[inset as usize]);
        let zones = path.zones();
        zones
            .map(|(ring, insets)| (ring, insets.iter().map(inset).collect()))
            .collect()
    }

    /// The vertices of a ring: those that there are, or new ones.
    fn corners(
        &mut self,
        rings: &PathRings<'_>,
        ring: usize,
        angles: &[f64; 4],
        ends: &Ends,
    ) -> Ring {
        let last = rings.last();
        if ring == 0
            && let Some(start) = ends.start()
        {
            return start.ring;
        }
        if ring == last
            && let Some(end) = ends.end()
        {
            // The path's corners have turned by quarters on the way.
            let goal = frame::across(end.corner, rings.tangents[ring]);
            let (quarter, _) = frame::quarters(rings.frames[ring], goal, rings.tangents[ring]);
            return [0, 1, 2, 3].map(|k: i32| end.ring[(k - quarter).rem_euclid(4) as usize]);
        }
        let is_end = ring == 0 || ring == last;
        let role = if is_end { Role::End } else { Role::Ordinary };
        self.own_ring(rings, ring, role, angles)
    }

    /// A ring of four new vertices at these angles from the frame.
    fn own_ring(
        &mut self,
        rings: &PathRings<'_>,
        ring: usize,
        role: Role,
        angles: &[f64; 4],
    ) -> Ring {
        let planned = &rings.path.rings[ring];
        let (tangent, frame) = (rings.tangents[ring], rings.frames[ring]);
        let tracing = self.tracing(planned, role);
        let taper = rings.taper(ring);
        let point = &mut self.mesh.tracing[tracing as usize];
        (point.tangent, point.taper, point.border) =
            (tangent.as_vec3(), taper as f32, rings.border(ring));
        let side = tangent.cross(frame);
        let directions = if *angles == QUARTERS {
            // Nearly all rings, without sines.
            [frame, side, -frame, -side]
        } else {
            angles.map(|angle| frame * angle.cos() + side * angle.sin())
        };
        // Normals stand on the cone: directions are unit vectors across the unit tangent.
        let lean = (1.0 + taper * taper).sqrt().recip();
        let corners = directions.map(|direction| {
            self.mesh.vertices.push(Vertex {
                position: (planned.center + direction * planned.radius).as_vec3(),
                normal: ((direction - tangent * taper) * lean).as_vec3(),
                tracing,
            });
            self.mesh.vertices.len() as u32 - 1
        });
        if let Some(crease) = rings.crease(ring) {
            // Its normal stays that of the circle.
            let position = planned.center + crease.offset * planned.radius;
            self.mesh.vertices[corners[crease.corner] as usize].position = position.as_vec3();
        }
        corners
    }

    /// Lateral patches between rings, but for quads that branches leave through, and caps at the ends.
    /// Returns the number of the first patch of each segment, and one past the last.
    fn tubes(&mut self, rings: &[Ring], facing: &[Facing], ends: &Ends) -> Vec<u32> {
        let mut first_patches = vec![self.mesh.patches.len() as u32];
        if ends.start().is_none() {
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
        if ends.end().is_none() {
            self.cap(rings[rings.len() - 1]);
        }
        first_patches
    }

    fn cap(&mut self, corners: Ring) {
        self.mesh.patches.push(Patch {
            corners,
            kind: PatchKind::Cap,
        });
    }

    /// Adds an inset with its lofts.
    fn inset(&mut self, path: &PathRings<'_>, rings: &[Ring], facing: &Facing) {
        let (ring, side) = (facing.ring, facing.side);
        let inset = self.plan.insets[facing.inset as usize];
        let shape = InsetSite {
            exit: facing.exit,
            direction: facing.direction,
            radius: facing.radius,
            lift: inset.lift,
            along: path.chord(ring),
        }
        .shape(&path.cones(ring));
        let of_branch = &self.plan.paths[inset.path as usize].rings;
        let own = if inset.at_end {
            of_branch.last()
        } else {
            of_branch.first()
        };
        let tracing = self.tracing(own.expect("paths have rings"), Role::Inset);
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
    }

    /// Notes which patches are near a fork: those of two segments from joints and insets, and of the
    /// trunk around a zone. `first`: the first patch of each segment.
    fn note_forks(&mut self, path: &Path, zones: &[Zone], first: &[u32]) {
        let last = path.last();
        let segments = |from: usize, to: usize| first[from.min(last)]..first[to.min(last)];
        let fork = |end: PathEnd| match end {
            PathEnd::Joint(joint) => Some(self.plan.joints[joint as usize].fork),
            PathEnd::Inset(inset) => Some(self.plan.insets[inset as usize].fork),
            PathEnd::Free | PathEnd::Soma(_) => None,
        };
        let (start, end) = (fork(path.start), fork(path.end));
        if let Some(fork) = start {
            self.fork_patches.push((fork, segments(0, 2)));
        }
        if let Some(fork) = end {
            let segments = segments(last.saturating_sub(2), last);
            self.fork_patches.push((fork, segments));
        }
        for (ring, insets) in zones {
            for (_, inset) in insets {
                let around = segments(ring.saturating_sub(1), ring + 2);
                self.fork_patches.push((inset.fork, around));
            }
        }
    }
}

/// What is there already where a path begins and where it ends; nothing where it gets rings and caps of its own.
struct Ends([Option<MadeEnd>; 2]);

impl Ends {
    fn start(&self) -> Option<&MadeEnd> {
        self.0[0].as_ref()
    }

    fn end(&self) -> Option<&MadeEnd> {
        self.0[1].as_ref()
    }
}

/// The ring of a joint, an inset or a soma.
struct MadeEnd {
    /// Counter-clockwise about the path.
    ring: Ring,
    /// Towards its first corner.
    corner: DVec3,
    /// Of an inset: its center, and the direction of the path there.
    inset: Option<(DVec3, DVec3)>,
}

/// Rotation-minimizing frames from the start on.
fn frames(centers: &[DVec3], tangents: &[DVec3], ends: &Ends) -> Vec<DVec3> {
    let first = match ends.start() {
        Some(start) => frame::across(start.corner, tangents[0]),
        None => tangents[0].any_orthonormal_vector(),
    };
    let mut frames = Vec::with_capacity(centers.len());
    frames.push(first);
    for i in 1..centers.len() {
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

/// Turns frames as little as possible between the rings that there are, so that quads face the branches that leave, and corners
/// lie in the creases of bends.
fn turn_rings(rings: &mut PathRings<'_>, zones: &[Zone], ends: &Ends) {
    let last = rings.last();
    let is_bend = |ring: &PlannedRing| ring.crease.is_some();
    if zones.is_empty() && ends.end().is_none() && !rings.path.rings.iter().any(is_bend) {
        return;
    }
    let mut targets = vec![Target::default(); last + 1];
    let starts_fixed = ends.start().is_some();
    if starts_fixed {
        targets[0].weight = FIXED;
    }
    facing::targets(rings, zones, &mut targets);
    if let Some(end) = ends.end() {
        let goal = frame::across(end.corner, rings.tangents[last]);
        let (_, rest) = frame::quarters(rings.frames[last], goal, rings.tangents[last]);
        let before = targets[..last].iter().rev().find(|t| t.weight > 0.0);
        let before = before.map_or(0.0, |t| t.angle);
        targets[last] = Target {
            angle: rest + ((before - rest) / FRAC_PI_2).round() * FRAC_PI_2,
            weight: FIXED,
        };
    }
    // Long thin segments turn more easily.
    let stiffness = |i: usize| {
        let length = rings.centers[i].distance(rings.centers[i + 1]);
        let radius = rings.radii[i].max(rings.radii[i + 1]);
        (radius / length.max(f64::MIN_POSITIVE)).clamp(1e-4, 10.0)
    };
    let stiffness: Vec<f64> = (0..last).map(stiffness).collect();
    let angles = relax(&stiffness, &targets);
    let turned = rings.frames.iter_mut().zip(&rings.tangents).zip(angles);
    for ((frame, &tangent), angle) in turned.skip(usize::from(starts_fixed)) {
        *frame = frame::turn(*frame, tangent, angle);
    }
}

/// Angles of the corners of every ring.
fn corner_angles(path: &PathRings<'_>, facing: &[Facing]) -> Vec<[f64; 4]> {
    let mut from = 0;
    (0..=path.last())
        .map(|ring| {
            while facing.get(from).is_some_and(|f| f.ring + 1 < ring) {
                from += 1;
            }
            let here = facing[from..].iter().take_while(|f| f.ring <= ring);
            let mut angles = facing::corner_angles(ring, &here.collect::<Vec<_>>());
            if let Some(crease) = path.crease(ring) {
                angles[crease.corner] += crease.angle;
            }
            angles
        })
        .collect()
}
