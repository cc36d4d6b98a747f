//! First rings: where each neurite leaves its soma.
//!
//! A ring's **position** is 0 on the soma's sphere and 1 at the first point outside it; between the
//! two it lies on the ray from the soma's center. Beyond 1 it follows the traced path: 2 is as far
//! beyond the first point as that is from the sphere, at least [`LEAST_BEYOND`] radii. What the ring
//! has passed becomes a part of the soma.
//!
//! A position that is not asked for is the first point where that is near and plain, else a point of
//! our own on the ray to it at the soma's reach.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use neurotess_morphology::{Morphology, shape};

use crate::prepare::SomaSphere;
use crate::skeleton::{Children, NONE, Root, Skeleton, SkeletonNode};
use crate::warning::Warnings;
use crate::{GenerateOptions, SomaMethod};

/// Least way from position 1 to 2, in radii of the soma: many tracings begin on its sphere, where
/// twice nothing is nothing.
const LEAST_BEYOND: f64 = 0.5;
/// Least way between a ring and a fork or an end beyond it, in radii of the thicker one.
const LEAST_WAY: f64 = 1.5;
/// A path that turns back towards the soma ends a ring's way: least cosine to the ray.
const LEAST_OUTWARDS: f64 = 0.5;

/// Where first rings are asked to be.
pub(crate) struct RingRequests<'a> {
    /// Number of each section's neurite.
    neurites: Vec<u32>,
    positions: &'a BTreeMap<u32, f64>,
    /// Whether the method has a choice.
    heard: bool,
}

impl<'a> RingRequests<'a> {
    pub(crate) fn new(morphology: &Morphology, options: &'a GenerateOptions) -> Self {
        Self {
            neurites: shape::neurites(morphology),
            positions: &options.rings,
            heard: matches!(options.soma, SomaMethod::Fem | SomaMethod::Profile),
        }
    }

    /// Number of a node's neurite.
    pub(crate) fn neurite(&self, node: &SkeletonNode) -> u32 {
        self.neurites[(node.section - 1) as usize]
    }

    fn of(&self, node: &SkeletonNode) -> Option<f64> {
        let request = self.positions.get(&self.neurite(node));
        let request = request.filter(|request| self.heard && request.is_finite());
        request.map(|request| request.clamp(0.0, 2.0))
    }

    /// Number of requests that no ring has heard.
    pub(crate) fn unused(&self, given: &[Given]) -> usize {
        let heard = given.iter().filter(|g| g.asked.is_some());
        let heard: BTreeSet<u32> = heard.map(|g| g.neurite).collect();
        self.positions.keys().filter(|n| !heard.contains(n)).count()
    }
}

/// A ring that a neurite was given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Given {
    pub(crate) neurite: u32,
    pub(crate) soma: u32,
    pub(crate) node: u32,
    pub(crate) position: f64,
    pub(crate) asked: Option<f64>,
    /// Asked to be farther out than it would be if nobody asked.
    pub(crate) farther: bool,
    /// Distance from the soma's center in radii of the soma.
    pub(crate) reach: f64,
}

impl Given {
    /// Not as far out as asked for.
    pub(crate) fn limited(&self) -> bool {
        self.asked.is_some_and(|asked| self.position < asked - 1e-3)
    }
}

/// Gives every neurite of a soma its first ring: the skeleton with them. `farthest`, by soma: radii from
/// its center beyond which no request is heard.
pub(crate) fn insert(
    skeleton: &Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    requests: &RingRequests<'_>,
    farthest: &[f64],
    warnings: &mut Warnings,
) -> (Skeleton, Vec<Given>) {
    let children = skeleton.children();
    let mut sites: BTreeMap<u32, Site> = BTreeMap::new();
    let mut passed = vec![false; skeleton.nodes().len()];
    for (i, node) in skeleton.nodes().iter().enumerate() {
        let Root::Soma(soma) = node.root else {
            continue;
        };
        let Some(soma_sphere) = soma_spheres[soma as usize].filter(|_| node.parent == NONE) else {
            continue;
        };
        let stem = Stem::new(skeleton, children, i as u32, soma_sphere);
        let site = stem.site(
            requests.of(node),
            farthest[soma as usize] * soma_sphere.radius,
        );
        let mut here = i as u32;
        while here != site.next {
            passed[here as usize] = true;
            here = children.of(here)[0];
        }
        sites.insert(site.next, Site { soma, ..site });
    }
    place(skeleton, soma_spheres, requests, &sites, &passed, warnings)
}

/// Where a ring goes.
#[derive(Clone, Copy, Debug)]
struct Site {
    soma: u32,
    /// The first node that stays: the ring itself, or what follows it.
    next: u32,
    /// Center and radius of a ring of its own; none: the node is the ring.
    own: Option<(DVec3, f64)>,
    position: f64,
    asked: Option<f64>,
    farther: bool,
}

/// A neurite as it leaves its soma.
struct Stem<'a> {
    skeleton: &'a Skeleton,
    children: &'a Children,
    root: u32,
    soma_sphere: SomaSphere,
    /// From the soma's center to the first point.
    direction: DVec3,
    distance: f64,
    branches: usize,
}

impl<'a> Stem<'a> {
    fn new(
        skeleton: &'a Skeleton,
        children: &'a Children,
        root: u32,
        soma_sphere: SomaSphere,
    ) -> Self {
        let offset = skeleton.node(root).center - soma_sphere.center;
        Self {
            skeleton,
            children,
            root,
            soma_sphere,
            direction: offset.try_normalize().unwrap_or(DVec3::Y),
            distance: offset.length(),
            branches: children.of(root).len(),
        }
    }

    /// Way (µm) from position 0 to 1.
    fn gap(&self) -> f64 {
        (self.distance - self.soma_sphere.radius).max(1e-6 * self.soma_sphere.radius)
    }

    fn usual(&self) -> Site {
        let reach = self.soma_sphere.reach * self.soma_sphere.radius;
        match self.branches {
            1 if self.distance <= reach => self.at_node(self.root, 1.0),
            0 if self.distance <= reach => self.on_ray(self.distance),
            0 | 1 => self.on_ray(reach),
            _ => self.on_ray(reach.min(self.soma_sphere.radius + 0.4 * self.gap())),
        }
    }

    /// `farthest`: distance (µm) from the soma's center beyond which no request is heard.
    fn site(&self, asked: Option<f64>, farthest: f64) -> Site {
        let usual = self.usual();
        let Some(asked) = asked else {
            return usual;
        };
        let farther = asked > usual.position + 1e-6;
        let at = self.soma_sphere.radius + asked.min(1.0) * self.gap();
        let site = if farther && farthest <= self.soma_sphere.radius + usual.position * self.gap() {
            usual
        } else if farther && farthest < at {
            self.on_ray(self.before_fork(farthest))
        } else if asked >= 1.0 && self.branches == 1 {
            self.on_path(asked, farthest)
        } else {
            self.on_ray(self.before_fork(at))
        };
        Site {
            asked: Some(asked),
            farther,
            ..site
        }
    }

    fn at_node(&self, next: u32, position: f64) -> Site {
        Site {
            soma: 0,
            next,
            own: None,
            position,
            asked: None,
            farther: false,
        }
    }

    fn on_ray(&self, at: f64) -> Site {
        let center = self.soma_sphere.center + self.direction * at;
        Site {
            own: Some((center, self.skeleton.node(self.root).radius)),
            ..self.at_node(self.root, (at - self.soma_sphere.radius) / self.gap())
        }
    }

    /// A ring cannot be on a fork.
    fn before_fork(&self, at: f64) -> f64 {
        let free = self.distance - LEAST_WAY * self.skeleton.node(self.root).radius;
        match self.branches {
            0 | 1 => at,
            _ => at.min(free.max(self.soma_sphere.radius + 0.4 * self.gap())),
        }
    }

    /// Beyond the first point, but not up to the next fork or end, nor where the path turns back.
    fn on_path(&self, position: f64, farthest: f64) -> Site {
        let unit = self.gap().max(LEAST_BEYOND * self.soma_sphere.radius);
        let wanted = (position - 1.0) * unit;
        let mut left = wanted.min(self.free_way(wanted, farthest));
        let reached = 1.0 + left / unit;
        let mut here = self.root;
        while let [next] = *self.children.of(here) {
            let (a, b) = (self.skeleton.node(here), self.skeleton.node(next));
            let length = a.center.distance(b.center);
            if left < 1e-3 * length {
                break;
            }
            if left < 0.999 * length {
                let t = left / length;
                let radius = a.radius + t * (b.radius - a.radius);
                return Site {
                    own: Some((a.center.lerp(b.center, t), radius)),
                    ..self.at_node(next, reached)
                };
            }
            left -= length;
            here = next;
        }
        self.at_node(here, reached)
    }

    /// Way (µm) from the first point that a ring may go, as far as `wanted` asks.
    fn free_way(&self, wanted: f64, farthest: f64) -> f64 {
        let (mut here, mut way, mut thickest) = (self.root, 0.0, 0.0_f64);
        loop {
            let node = self.skeleton.node(here);
            thickest = thickest.max(node.radius);
            let [next] = *self.children.of(here) else {
                return (way - LEAST_WAY * thickest).max(0.5 * way);
            };
            if way > wanted + LEAST_WAY * thickest {
                return way;
            }
            let from = node.center - self.soma_sphere.center;
            let step = self.skeleton.node(next).center - node.center;
            let outwards = step.normalize_or_zero().dot(from.normalize_or_zero());
            if outwards < LEAST_OUTWARDS {
                return way;
            }
            if (from + step).length() > farthest {
                return way + until(from, step, farthest);
            }
            way += step.length();
            here = next;
        }
    }
}

/// Way along `step` from `from` until the distance from the origin is `far`, which it passes.
fn until(from: DVec3, step: DVec3, far: f64) -> f64 {
    let along = from.dot(step.normalize_or_zero());
    let lack = far * far - from.length_squared();
    // The positive root of x² + 2 x along − lack.
    (lack + along * along).max(0.0).sqrt() - along
}

fn place(
    skeleton: &Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    requests: &RingRequests<'_>,
    sites: &BTreeMap<u32, Site>,
    passed: &[bool],
    warnings: &mut Warnings,
) -> (Skeleton, Vec<Given>) {
    let children = skeleton.children();
    let mut nodes: Vec<SkeletonNode> = Vec::with_capacity(skeleton.nodes().len() + sites.len());
    let mut new_index = vec![NONE; skeleton.nodes().len()];
    let mut given = Vec::with_capacity(sites.len());
    for (i, node) in skeleton.nodes().iter().enumerate() {
        if passed[i] {
            continue;
        }
        let mut node = *node;
        if node.parent != NONE {
            node.parent = new_index[node.parent as usize];
        }
        node.root = Root::Free;
        if let Some(site) = sites.get(&(i as u32)) {
            given.push(Given {
                neurite: requests.neurite(&node),
                soma: site.soma,
                node: nodes.len() as u32,
                position: site.position,
                asked: site.asked,
                farther: site.farther,
                reach: soma_spheres[site.soma as usize].map_or(0.0, |soma_sphere| {
                    let ring = site.own.map_or(node.center, |(center, _)| center);
                    ring.distance(soma_sphere.center) / soma_sphere.radius
                }),
            });
            match site.own {
                None => node.root = Root::Insertion(site.soma),
                Some((center, radius)) => {
                    let parent = nodes.len() as u32;
                    nodes.push(SkeletonNode {
                        center,
                        radius,
                        parent: NONE,
                        root: Root::Insertion(site.soma),
                        ..node
                    });
                    node.parent = parent;
                    if let Some(soma_sphere) = soma_spheres[site.soma as usize] {
                        bridge(
                            &mut node,
                            center,
                            soma_sphere,
                            children.of(i as u32).is_empty(),
                            warnings,
                        );
                    }
                }
            }
        }
        new_index[i] = nodes.len() as u32;
        nodes.push(node);
    }
    (Skeleton::from_nodes(nodes), given)
}

/// The way from a ring of our own to the first traced point.
fn bridge(
    node: &mut SkeletonNode,
    ring: DVec3,
    soma_sphere: SomaSphere,
    only: bool,
    warnings: &mut Warnings,
) {
    let direction = (ring - soma_sphere.center)
        .try_normalize()
        .unwrap_or(DVec3::Y);
    if only && node.center.distance(ring) < node.radius {
        node.center = ring + direction * node.radius;
        warnings.add(
            "one_point_neurite",
            Some(node.sample),
            "neurite of one point on the soma: lengthened by its radius",
        );
    } else if node.center.distance(soma_sphere.center) > 2.0 * soma_sphere.radius
        && node.center.distance(ring) > 0.5 * soma_sphere.radius
    {
        warnings.add(
            "far_from_soma",
            Some(node.sample),
            "neurite starts more than a radius away from the soma: bridged",
        );
    }
}
