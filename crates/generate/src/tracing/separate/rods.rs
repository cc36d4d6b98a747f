//! The skeleton as elastic rods: where each point was traced, where it is, which points were put
//! between.

use glam::DVec3;

use crate::separate::paths::{Origin, Paths};
use crate::tracing::SomaSphere;
use crate::tracing::{NONE, Root, Skeleton, SkeletonNode};

/// What a point of a rod stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// A node of the skeleton that was given.
    Traced,
    /// One that was put between two of these, so that the rod can bend.
    Added,
    /// The foot of the cone that the soma's surface makes towards a ring beyond its sphere. It is no node of a
    /// skeleton.
    Foot,
}

/// A point of a rod.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// What becomes of it in the skeleton, at its present center.
    pub(super) node: SkeletonNode,
    /// Where the tracing has it (µm).
    pub(super) rest: DVec3,
    /// What it stands for.
    pub(super) role: Role,
    /// The traced segment that it ends, or lies on, by its lower end in the skeleton that was given.
    pub(super) traced_segment: u32,
}

/// Points, parents before children, and what follows from their links and traced places.
#[derive(Debug, Default)]
pub(super) struct Rods {
    pub(super) points: Vec<Point>,
    pub(super) somata: Vec<Option<SomaSphere>>,
    /// Traced length of the segment above each point (µm).
    pub(super) length: Vec<f64>,
    /// Children of each point.
    pub(super) children: Vec<u32>,
    /// The only child; [`NONE`] at ends and forks.
    pub(super) only: Vec<u32>,
    pub(super) paths: Paths,
}

impl Rods {
    pub(super) fn new(skeleton: &Skeleton, somata: &[Option<SomaSphere>]) -> Self {
        let mut points = Vec::with_capacity(skeleton.nodes().len());
        let mut moved_to = Vec::with_capacity(skeleton.nodes().len());
        for (i, node) in skeleton.nodes().iter().enumerate() {
            let mut point = Point {
                node: *node,
                rest: node.center,
                role: Role::Traced,
                traced_segment: i as u32,
            };
            if node.parent != NONE {
                point.node.parent = moved_to[node.parent as usize];
            } else if let Some(foot) = foot(&point, somata) {
                point.node.parent = points.len() as u32;
                points.push(foot);
            }
            moved_to.push(points.len() as u32);
            points.push(point);
        }
        Self::of_points(points, somata.to_vec())
    }

    fn of_points(points: Vec<Point>, somata: Vec<Option<SomaSphere>>) -> Self {
        let parent = |p: &Point| p.node.parent;
        let length = points.iter().map(|p| match parent(p) {
            NONE => 0.0,
            above => p.rest.distance(points[above as usize].rest),
        });
        let length: Vec<f64> = length.collect();
        let mut children = vec![0; points.len()];
        let mut only = vec![NONE; points.len()];
        for (i, point) in points.iter().enumerate().filter(|(_, p)| parent(p) != NONE) {
            let above = parent(point) as usize;
            children[above] += 1;
            only[above] = if children[above] == 1 { i as u32 } else { NONE };
        }
        let origin = |root: u32| origin(&points[root as usize], &somata);
        let paths = Paths::new(points.iter().map(parent).collect(), &length, origin);
        Self {
            points,
            somata,
            length,
            children,
            only,
            paths,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.points.len()
    }

    pub(super) fn radius(&self, point: u32) -> f64 {
        self.points[point as usize].node.radius
    }

    pub(super) fn parent(&self, point: u32) -> u32 {
        self.points[point as usize].node.parent
    }

    /// Lower ends of all segments.
    pub(super) fn segments(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.count() as u32).filter(|&i| self.parent(i) != NONE)
    }

    /// Where each point is (µm).
    pub(super) fn centers(&self) -> Vec<DVec3> {
        self.points.iter().map(|p| p.node.center).collect()
    }

    /// Where each point was traced (µm).
    pub(super) fn rests(&self) -> Vec<DVec3> {
        self.points.iter().map(|p| p.rest).collect()
    }

    /// Rings on somata stay: the soma was built for them.
    pub(super) fn fixed(&self, point: u32) -> bool {
        sphere_of(&self.points[point as usize].node, &self.somata).is_some()
    }

    /// Whether a point is an end that nothing hangs on or holds.
    pub(super) fn free_end(&self, point: u32) -> bool {
        let root = self.parent(point) == NONE;
        self.children[point as usize] == usize::from(root) as u32 && !self.fixed(point)
    }

    /// Cuts each segment into so many equal parts.
    pub(super) fn cut(&mut self, parts: &[u32]) {
        let mut points: Vec<Point> = Vec::with_capacity(self.count());
        let mut moved_to = Vec::with_capacity(self.count());
        for (point, &parts) in self.points.iter().zip(parts) {
            let mut parent = match point.node.parent {
                NONE => NONE,
                above => moved_to[above as usize],
            };
            if parent != NONE {
                let above = points[parent as usize];
                for part in 1..parts {
                    let share = f64::from(part) / f64::from(parts);
                    points.push(between(&above, point, share, parent));
                    parent = points.len() as u32 - 1;
                }
            }
            let node = SkeletonNode {
                parent,
                ..point.node
            };
            moved_to.push(points.len() as u32);
            points.push(Point { node, ..*point });
        }
        *self = Self::of_points(points, std::mem::take(&mut self.somata));
    }

    /// Leaves points out, none of them a root; their children move to the nearest one above that stays.
    pub(super) fn retain(&mut self, keep: &[bool]) {
        let mut points: Vec<Point> = Vec::with_capacity(self.count());
        let mut stands_for: Vec<u32> = Vec::with_capacity(self.count());
        for (point, &keep) in self.points.iter().zip(keep) {
            let parent = match point.node.parent {
                NONE => NONE,
                above => stands_for[above as usize],
            };
            if keep || parent == NONE {
                stands_for.push(points.len() as u32);
                let node = SkeletonNode {
                    parent,
                    ..point.node
                };
                points.push(Point { node, ..*point });
            } else {
                stands_for.push(parent);
            }
        }
        *self = Self::of_points(points, std::mem::take(&mut self.somata));
    }

    /// Points that are nodes of a skeleton.
    pub(super) fn nodes(&self) -> impl Iterator<Item = u32> + '_ {
        let is_node = |&i: &u32| self.points[i as usize].role != Role::Foot;
        (0..self.count() as u32).filter(is_node)
    }

    /// The points as nodes of a skeleton.
    pub(super) fn skeleton(&self) -> Skeleton {
        let mut moved_to = vec![NONE; self.count()];
        let mut nodes = Vec::with_capacity(self.count());
        for i in self.nodes() {
            let node = self.points[i as usize].node;
            let parent = match node.parent {
                NONE => NONE,
                above => moved_to[above as usize],
            };
            moved_to[i as usize] = nodes.len() as u32;
            nodes.push(SkeletonNode { parent, ..node });
        }
        Skeleton::from_nodes(nodes)
    }
}

/// A new point on a segment, at a share of the way from its upper end.
fn between(above: &Point, below: &Point, share: f64, parent: u32) -> Point {
    let near = if share < 0.5 { above } else { below };
    let radius = above.node.radius + share * (below.node.radius - above.node.radius);
    Point {
        node: SkeletonNode {
            center: above.node.center.lerp(below.node.center, share),
            radius,
            parent,
            root: Root::Free,
            sample: near.node.sample,
            ..below.node
        },
        rest: above.rest.lerp(below.rest, share),
        role: Role::Added,
        traced_segment: below.traced_segment,
    }
}

/// The sphere of the soma that a root hangs on, if it is meshed.
fn sphere_of<'a>(node: &SkeletonNode, somata: &'a [Option<SomaSphere>]) -> Option<&'a SomaSphere> {
    match node.root {
        Root::Soma(soma) | Root::Insertion(soma) => somata[soma as usize].as_ref(),
        Root::Free => None,
    }
}

/// The foot of a ring that is beyond its soma's surface, which widens towards the sphere as far as the ring is away.
fn foot(ring: &Point, somata: &[Option<SomaSphere>]) -> Option<Point> {
    let sphere = sphere_of(&ring.node, somata)?;
    let way = ring.rest - sphere.center;
    let surface = sphere.towards(ring.rest);
    let beyond = way.length() - surface;
    let center = sphere.center + way * (surface / way.length());
    let node = SkeletonNode {
        center,
        radius: ring.node.radius + beyond,
        ..ring.node
    };
    (beyond > 0.01 * surface).then_some(Point {
        node,
        rest: center,
        role: Role::Foot,
        ..*ring
    })
}

fn origin(root: &Point, somata: &[Option<SomaSphere>]) -> Option<Origin> {
    let (Root::Soma(soma) | Root::Insertion(soma)) = root.node.root else {
        return None;
    };
    let beyond =
        |sphere: &SomaSphere| root.rest.distance(sphere.center) - sphere.towards(root.rest);
    let way = somata[soma as usize].as_ref().map_or(0.0, beyond).max(0.0);
    Some(Origin { soma, way })
}
