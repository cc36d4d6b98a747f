//! First rings: where each neurite leaves its soma.
//!
//! A ring's **position** is 0 on the soma's sphere and 1 at the first point outside it; between the
//! two it lies on the ray from the soma's center. Beyond 1 it follows the traced path: 2 is as far
//! beyond the first point as that is from the sphere, at least half a radius. What the ring
//! has passed becomes a part of the soma.
//!
//! A neurite without a request has its ring at its first point, where that is near and unbranched, else
//! at a new point on the ray to it at the soma's reach. If the first point is nearer to the surface than a **hillock** is high,
//! the ring stands where the path is that far beyond it: a neurite that begins on the surface, or within it, draws
//! it out all the same.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use neurotess_morphology::{Morphology, shape};

use super::site::{Site, Stem, hillock};
use crate::tracing::SomaSphere;
use crate::tracing::{NONE, Root, Skeleton, SkeletonNode};
use crate::warning::Warnings;
use crate::{GenerateOptions, SomaMethod, SphereKind};

/// Requested positions of first rings.
pub(crate) struct RingRequests<'a> {
    /// Number of each section's neurite.
    neurites: Vec<u32>,
    positions: &'a BTreeMap<u32, f64>,
    /// Whether the soma's method can follow requests.
    supported: bool,
    /// Whether thin neurites leave through insets.
    insets: bool,
    /// Whether neurites draw the surface out.
    hillocks: bool,
}

impl<'a> RingRequests<'a> {
    pub(crate) fn new(morphology: &Morphology, options: &'a GenerateOptions) -> Self {
        Self {
            neurites: shape::neurites(morphology),
            positions: &options.rings,
            supported: matches!(options.soma, SomaMethod::Fem | SomaMethod::Profile),
            insets: options.soma == SomaMethod::Fem && options.sphere == SphereKind::Cube,
            hillocks: options.soma == SomaMethod::Fem,
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
        let soma_sphere = soma_spheres[soma as usize].as_ref();
        let Some(soma_sphere) = soma_sphere.filter(|_| node.parent == NONE) else {
            continue;
        };
        let hillock = match requests.hillocks {
            true => hillock(node.radius, soma_sphere),
            false => 0.0,
        };
        let stem = Stem::new(skeleton, children, i as u32, soma_sphere, hillock);
        let request = requests.of(node);
        let over = stem
            .over_soma()
            .filter(|_| requests.insets && request.is_none());
        let far = farthest[soma as usize] * stem.surface;
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
                reach: soma_spheres[site.soma as usize]
                    .as_ref()
                    .map_or(0.0, |soma_sphere| {
                        let ring = site.added.map_or(node.center, |(center, _)| center);
                        ring.distance(soma_sphere.center) / soma_sphere.towards(ring)
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
                    if let Some(soma_sphere) = &soma_spheres[site.soma as usize] {
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
    soma_sphere: &SomaSphere,
    only: bool,
    warnings: &mut Warnings,
) {
    let direction = soma_sphere.direction(ring);
    let surface = soma_sphere.surface(direction);
    if only && node.center.distance(ring) < node.radius {
        node.center = ring + direction * node.radius;
        warnings.add(
            "one_point_neurite",
            Some(node.sample),
            "neurite of one point on the soma: lengthened by its radius",
        );
    } else if node.center.distance(soma_sphere.center) > 2.0 * surface
        && node.center.distance(ring) > 0.5 * surface
    {
        warnings.add(
            "far_from_soma",
            Some(node.sample),
            "neurite starts more than a radius away from the soma: bridged",
        );
    }
}
