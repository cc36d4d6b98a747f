//! First rings: where each neurite leaves its soma.
//!
//! A ring's **position** is 0 on the soma's sphere and 1 at the first point outside it; between the
//! two it lies on the ray from the soma's center. Beyond 1 it follows the traced path: 2 is as far
//! beyond the first point as that is from the sphere, at least [`MIN_BEYOND`] radii. What the ring
//! has passed becomes a part of the soma.
//!
//! A neurite without a request has its ring at its first point, where that is near and unbranched, else
//! at a new point on the ray to it at the soma's reach.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use neurotess_morphology::{Morphology, shape};

use crate::tracing::SomaSphere;
use crate::tracing::{Children, NONE, Root, Skeleton, SkeletonNode};
use crate::warning::Warnings;
use crate::{GenerateOptions, SomaMethod, SphereKind};

/// Least way from position 1 to 2, in radii of the soma: many tracings begin on its sphere, where
/// twice nothing is nothing.
const MIN_BEYOND: f64 = 0.5;
/// Least way between a ring and a fork or an end beyond it, in radii of the thicker one.
const MIN_WAY: f64 = 1.5;
/// A neurite whose radius is below this share of its soma's leaves it through an inset: pulled to a
/// ring this small, a quad of the soma creases like a star. Thicker ones pull the soma out towards them,
/// as in García-Cantero et al. 2017; at 0.2 most real somata would stay plain spheres.
const THIN: f64 = 0.1;
/// Height of an inset's corners over the soma, in radii of the neurite.
pub(crate) const SOMA_LIFT: f64 = 0.4;
/// A path that turns back towards the soma ends a ring's way: least cosine to the ray.
const MIN_OUTWARDS: f64 = 0.5;

/// Distance of an inset's ring from the soma's center, whose corners stand over a surface at such a distance.
pub(crate) fn over_surface(surface: f64, radius: f64) -> f64 {
    let corners = surface + SOMA_LIFT * radius;
    (corners * corners - radius * radius).max(0.0).sqrt()
}

/// Requested positions of first rings.
pub(crate) struct RingRequests<'a> {
    /// Number of each section's neurite.
    neurites: Vec<u32>,
    positions: &'a BTreeMap<u32, f64>,
    /// Whether the soma's method can follow requests.
    supported: bool,
    /// Whether thin neurites leave through insets.
    insets: bool,
}

impl<'a> RingRequests<'a> {
    pub(crate) fn new(morphology: &Morphology, options: &'a GenerateOptions) -> Self {
        Self {
            neurites: shape::neurites(morphology),
            positions: &options.rings,
            supported: matches!(options.soma, SomaMethod::Fem | SomaMethod::Profile),
            insets: options.soma == SomaMethod::Fem && options.sphere == SphereKind::Cube,
        }
    }

    /// Number of a node's neurite.
    pub(crate) fn neurite(&self, node: &SkeletonNode) -> u32 {
        let section = node.section.index().expect("nodes lie on neurites");
        self.neurites[section]
    }

    fn of(&self, node: &SkeletonNode) -> Option<f64> {
        let request = self.positions.get(&self.neurite(node));
        let request = request.filter(|request| self.supported && request.is_finite());
        request.map(|request| request.clamp(0.0, 2.0))
    }

    /// Number of requests for neurites that have no first ring.
    pub(crate) fn unused(&self, rings: &[PlacedRing]) -> usize {
        let used = rings.iter().filter(|ring| ring.requested.is_some());
        let used: BTreeSet<u32> = used.map(|ring| ring.neurite).collect();
        self.positions.keys().filter(|n| !used.contains(n)).count()
    }
}

/// The first ring of a neurite, at a node of the skeleton.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedRing {
    pub(crate) neurite: u32,
    pub(crate) soma: u32,
    pub(crate) node: u32,
    pub(crate) position: f64,
    pub(crate) requested: Option<f64>,
    /// Requested farther out than where it would be without a request.
    pub(crate) farther: bool,
    /// Distance from the soma's center in radii of the soma.
    pub(crate) reach: f64,
    /// Whether its neurite is so thin that it leaves through an inset.
    pub(crate) inset: bool,
}

impl PlacedRing {
    /// Whether it is not as far out as requested.
    pub(crate) fn limited(&self) -> bool {
        self.requested
            .is_some_and(|requested| self.position < requested - 1e-3)
    }
}

/// The skeleton with a first ring for every neurite of a soma. `farthest`, by soma: radii from
/// its center beyond which requests are limited.
pub(crate) fn insert(
    skeleton: &Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    requests: &RingRequests<'_>,
    farthest: &[f64],
    warnings: &mut Warnings,
) -> (Skeleton, Vec<PlacedRing>) {
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
        let request = requests.of(node);
        let over = stem
            .over_soma()
            .filter(|_| requests.insets && request.is_none());
        let far = farthest[soma as usize] * soma_sphere.radius;
        let site = over.unwrap_or_else(|| stem.site(request, far));
        let mut here = i as u32;
        while here != site.next {
            passed[here as usize] = true;
            here = children.of(here)[0];
        }
        sites.insert(site.next, Site { soma, ..site });
    }
    insert_at(skeleton, soma_spheres, requests, &sites, &passed, warnings)
}

/// Where a ring goes on its neurite.
#[derive(Clone, Copy, Debug)]
struct Site {
    soma: u32,
    /// The first node that stays: the ring itself, or what follows it.
    next: u32,
    /// Center and radius of a node to be added for the ring; none: `next` is the ring.
    added: Option<(DVec3, f64)>,
    position: f64,
    requested: Option<f64>,
    farther: bool,
    /// Whether the ring stands over the soma's surface as an inset.
    inset: bool,
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

    /// `farthest`: distance (µm) from the soma's center beyond which requests are limited.
    fn site(&self, requested: Option<f64>, farthest: f64) -> Site {
        let usual = self.usual();
        let Some(requested) = requested else {
            return usual;
        };
        let farther = requested > usual.position + 1e-6;
        let at = self.soma_sphere.radius + requested.min(1.0) * self.gap();
        let site = if farther && farthest <= self.soma_sphere.radius + usual.position * self.gap() {
            usual
        } else if farther && farthest < at {
            self.on_ray(self.before_fork(farthest))
        } else if requested >= 1.0 && self.branches == 1 {
            self.on_path(requested, farthest)
        } else {
            self.on_ray(self.before_fork(at))
        };
        Site {
            requested: Some(requested),
            farther,
            ..site
        }
    }

    fn at_node(&self, next: u32, position: f64) -> Site {
        Site {
            soma: 0,
            next,
            added: None,
            position,
            requested: None,
            farther: false,
            inset: false,
        }
    }

    /// An inset right over the sphere, if the neurite is thin and leads away from it.
    fn over_soma(&self) -> Option<Site> {
        let (soma, radius) = (
            self.soma_sphere.radius,
            self.skeleton.node(self.root).radius,
        );
        if radius >= THIN * soma {
            return None;
        }
        let at = over_surface(soma, radius);
        if self.distance >= at + radius {
            let site = self.on_ray(at);
            return Some(Site {
                inset: true,
                ..site
            });
        }
        // The first points are too near: along the path to where it is free.
        let way = at + 0.5 * radius - self.distance;
        let unit = self.gap().max(MIN_BEYOND * soma);
        let site = (self.branches == 1).then(|| self.on_path(1.0 + way / unit, 1.35 * soma))?;
        let center = site
            .added
            .map_or(self.skeleton.node(site.next).center, |(center, _)| center);
        let distance = center.distance(self.soma_sphere.center);
        (distance >= at).then_some(Site {
            inset: true,
            ..site
        })
    }

    fn on_ray(&self, at: f64) -> Site {
        let center = self.soma_sphere.center + self.direction * at;
        Site {
            added: Some((center, self.skeleton.node(self.root).radius)),
            ..self.at_node(self.root, (at - self.soma_sphere.radius) / self.gap())
        }
    }

    /// A ring cannot be on a fork.
    fn before_fork(&self, at: f64) -> f64 {
        let free = self.distance - MIN_WAY * self.skeleton.node(self.root).radius;
        match self.branches {
            0 | 1 => at,
            _ => at.min(free.max(self.soma_sphere.radius + 0.4 * self.gap())),
        }
    }

    /// Beyond the first point, but not up to the next fork or end, nor where the path turns back.
    fn on_path(&self, position: f64, farthest: f64) -> Site {
        let unit = self.gap().max(MIN_BEYOND * self.soma_sphere.radius);
        let most = (position - 1.0) * unit;
        let mut left = most.min(self.free_way(most, farthest));
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
                    added: Some((a.center.lerp(b.center, t), radius)),
                    ..self.at_node(next, reached)
                };
            }
            left -= length;
            here = next;
        }
        self.at_node(here, reached)
    }

    /// Way (µm) from the first point that a ring may go, up to `most`.
    fn free_way(&self, most: f64, farthest: f64) -> f64 {
        let (mut here, mut way, mut thickest) = (self.root, 0.0, 0.0_f64);
        loop {
            let node = self.skeleton.node(here);
            thickest = thickest.max(node.radius);
            let [next] = *self.children.of(here) else {
                return (way - MIN_WAY * thickest).max(0.5 * way);
            };
            if way > most + MIN_WAY * thickest {
                return way;
            }
            let from = node.center - self.soma_sphere.center;
            let step = self.skeleton.node(next).center - node.center;
            let outwards = step.normalize_or_zero().dot(from.normalize_or_zero());
            if outwards < MIN_OUTWARDS {
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

fn insert_at(
    skeleton: &Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    requests: &RingRequests<'_>,
    sites: &BTreeMap<u32, Site>,
    passed: &[bool],
    warnings: &mut Warnings,
) -> (Skeleton, Vec<PlacedRing>) {
    let children = skeleton.children();
    let mut nodes: Vec<SkeletonNode> = Vec::with_capacity(skeleton.nodes().len() + sites.len());
    let mut new_index = vec![NONE; skeleton.nodes().len()];
    let mut rings = Vec::with_capacity(sites.len());
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
            rings.push(PlacedRing {
                neurite: requests.neurite(&node),
                soma: site.soma,
                node: nodes.len() as u32,
                position: site.position,
                requested: site.requested,
                farther: site.farther,
                inset: site.inset,
                reach: soma_spheres[site.soma as usize].map_or(0.0, |soma_sphere| {
                    let ring = site.added.map_or(node.center, |(center, _)| center);
                    ring.distance(soma_sphere.center) / soma_sphere.radius
                }),
            });
            match site.added {
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
    (Skeleton::from_nodes(nodes), rings)
}

/// Joins an added ring to the first traced point.
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
