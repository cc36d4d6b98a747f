//! Hubs of thick branches that have no type: somata of skeletons from electron microscopy.
//!
//! Such skeletons (kimimaro, igneous, MICrONS, H01) have radii that are distances from the surface, and no soma: within it,
//! samples are as thick as they are far from its surface, and branches meet that are thick there and thin outside. As tubes
//! they would run through one another. So what lies within the ball of the thickest sample becomes one body, the union of
//! its frusta, and its branches leave it as neurites leave a soma.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use neurotess_mesh::SwcType;
use neurotess_morphology::{SomaSample, SomaShape};

use super::reference::FEM_REACH;
use crate::tracing::{NONE, Root, Skeleton, SkeletonNode, SomaSphere};
use crate::warning::Warnings;
use crate::{GenerateOptions, SomaMethod};

/// Least branches of a hub: of two a tube is a good picture.
const FEWEST: usize = 3;
/// Greatest radius with which a branch leaves a hub, as a share of the hub's. By eye: forks of dendrites are nearly as thick
/// as their branches.
const THINNER: f64 = 0.7;
/// Greatest cross-section of all branches as they leave it, as a share of the hub's own.
const ALL_THINNER: f64 = 1.0;
/// Forks of a tree that are tried, the thickest first. A guard.
const MAX_TRIED: usize = 8;

/// A body that stands for a hub: the label that its surface has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hub {
    /// The thickest sample.
    pub(crate) node: SkeletonNode,
}

/// A hub in a tree.
struct Found {
    middle: u32,
    /// All nodes of the ball.
    inner: Vec<u32>,
    /// Links that leave it: the node within, the one outside, and the share of the link within.
    leaving: Vec<(u32, u32, f64)>,
    shape: SomaShape,
}

/// Makes hubs somata, after all others.
pub(crate) fn find(
    skeleton: &mut Skeleton,
    soma_spheres: &mut Vec<Option<SomaSphere>>,
    options: &GenerateOptions,
    warnings: &mut Warnings,
) -> Vec<Hub> {
    if options.soma != SomaMethod::Fem {
        return Vec::new();
    }
    let found: Vec<Found> = forks_by_tree(skeleton)
        .into_values()
        .filter_map(|forks| {
            forks
                .iter()
                .take(MAX_TRIED)
                .find_map(|&fork| Found::around(skeleton, fork))
        })
        .collect();
    let hubs = found.iter().map(|hub| Hub {
        node: *skeleton.node(hub.middle),
    });
    let hubs: Vec<Hub> = hubs.collect();
    for hub in &hubs {
        warnings.add(
            "hub",
            Some(hub.node.sample),
            "thick branches without a type meet, as in a soma: meshed as one body",
        );
    }
    let mut keep = vec![true; skeleton.nodes().len()];
    for hub in found {
        let soma = soma_spheres.len() as u32;
        let shape = Arc::new(hub.shape);
        soma_spheres.push(Some(SomaSphere::new(shape, options.soma_scale, FEM_REACH)));
        hub.inner
            .iter()
            .for_each(|&node| keep[node as usize] = false);
        let nodes = skeleton.links();
        for (within, outside, share) in hub.leaving {
            let [a, b] = [within, outside].map(|node| nodes[node as usize]);
            let first = nodes.len() as u32;
            nodes.push(SkeletonNode {
                center: a.center.lerp(b.center, share),
                radius: a.radius + share * (b.radius - a.radius),
                parent: NONE,
                root: Root::Soma(soma),
                ..b
            });
            keep.push(true);
            // Towards the root, links turn round.
            let (mut parent, mut here) = (first, outside);
            if a.parent == outside {
                while here != NONE {
                    let node = &mut nodes[here as usize];
                    (parent, here, node.parent, node.root) =
                        (here, node.parent, parent, Root::Free);
                }
            } else {
                nodes[outside as usize].parent = first;
            }
        }
    }
    if !hubs.is_empty() {
        skeleton.cut(&keep);
        skeleton.reorder();
    }
    hubs
}

/// Forks of trees without a type and a soma, by root, the thickest first.
fn forks_by_tree(skeleton: &Skeleton) -> BTreeMap<u32, Vec<u32>> {
    let mut roots: Vec<u32> = Vec::with_capacity(skeleton.nodes().len());
    let mut forks: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (index, node) in (0..).zip(skeleton.nodes()) {
        let root = match node.parent {
            NONE => index,
            parent => roots[parent as usize],
        };
        roots.push(root);
        let links = skeleton.children().of(index).len() + usize::from(node.parent != NONE);
        let is_free = skeleton.node(root).root == Root::Free;
        if links >= FEWEST && is_free && node.kind == SwcType(0) {
            forks.entry(root).or_default().push(index);
        }
    }
    for forks in forks.values_mut() {
        let radius = |node: u32| skeleton.node(node).radius;
        forks.sort_by(|&a, &b| radius(b).total_cmp(&radius(a)).then(a.cmp(&b)));
    }
    forks
}

impl Found {
    /// The hub whose thickest sample is uphill from a fork, if it is one.
    fn around(skeleton: &Skeleton, fork: u32) -> Option<Self> {
        let radius = |node: u32| skeleton.node(node).radius;
        let mut middle = fork;
        loop {
            let thicker = skeleton.neighbors(middle).into_iter();
            let thicker = thicker.filter(|&near| radius(near) > radius(middle));
            match thicker.max_by(|&a, &b| radius(a).total_cmp(&radius(b)).then(b.cmp(&a))) {
                Some(next) => middle = next,
                None => break,
            }
        }
        let ball = *skeleton.node(middle);
        let is_within = |node: u32| {
            let center = skeleton.node(node).center;
            center.distance_squared(ball.center) < ball.radius * ball.radius
        };
        let (mut inner, mut parents, mut leaving) = (vec![middle], vec![None], Vec::new());
        let mut next = 0;
        while let Some(&here) = inner.get(next) {
            let before: Option<u32> = parents[next];
            let before = before.map(|parent| inner[parent as usize]);
            for near in skeleton
                .neighbors(here)
                .into_iter()
                .filter(|&near| Some(near) != before)
            {
                if skeleton.node(near).kind != SwcType(0) {
                    return None;
                }
                if is_within(near) {
                    inner.push(near);
                    parents.push(Some(next as u32));
                } else {
                    leaving.push((here, near, crossing(skeleton, [here, near], &ball)));
                }
            }
            next += 1;
        }
        let left = |&(a, b, share): &(u32, u32, f64)| radius(a) + share * (radius(b) - radius(a));
        let radii = || leaving.iter().map(left);
        let thickest = radii().fold(0.0, f64::max);
        let all: f64 = radii().map(|radius| radius * radius).sum();
        let is_hub = leaving.len() >= FEWEST
            && thickest <= THINNER * ball.radius
            && all <= ALL_THINNER * ball.radius * ball.radius;
        if !is_hub {
            return None;
        }
        let sample = |center: DVec3, radius: f64, parent: Option<u32>| SomaSample {
            id: 0,
            position: center.as_vec3(),
            radius: radius as f32,
            parent,
        };
        let mut samples: Vec<SomaSample> = Vec::with_capacity(inner.len() + leaving.len());
        let places: BTreeMap<u32, u32> = inner.iter().copied().zip(0..).collect();
        for (&node, &parent) in inner.iter().zip(&parents) {
            let node = skeleton.node(node);
            samples.push(sample(node.center, node.radius, parent));
        }
        for link in &leaving {
            let [a, b] = [link.0, link.1].map(|node| skeleton.node(node).center);
            samples.push(sample(a.lerp(b, link.2), left(link), Some(places[&link.0])));
        }
        let shape = SomaShape::of_hub(&samples)?;
        (!shape.is_like_neurite()).then_some(Self {
            middle,
            inner,
            leaving,
            shape,
        })
    }
}

/// The share of a link after which it leaves a ball that it begins within.
fn crossing(skeleton: &Skeleton, link: [u32; 2], ball: &SkeletonNode) -> f64 {
    let [a, b] = link.map(|node| skeleton.node(node).center - ball.center);
    let way = b - a;
    let (along, squared) = (a.dot(way), way.length_squared());
    let lack = ball.radius * ball.radius - a.length_squared();
    let root = (along * along + squared * lack).max(0.0).sqrt();
    let share = (root - along) / squared;
    if share.is_finite() {
        share.clamp(0.0, 1.0)
    } else {
        0.0
    }
}
