//! How far surfaces near forks are off the branches that were traced: the share of their area whose normal differs by
//! more than 30° from that of the branches' round cones, blended over half the radius of the thinnest.

use std::collections::HashSet;

use glam::Vec3;

use crate::tree::Tree;

/// Radii of a fork within which its surface is looked at, and how far its branches are followed.
const REACH: f32 = 3.0;
const FOLLOWED: f32 = 7.5;
/// Radii from the branches within which a facet is theirs.
const OWN: f32 = 0.6;
/// Cosine of 30°.
const OFF: f32 = 0.866_025_4;
/// Facets without which a fork is not judged.
const MIN_FACETS: usize = 10;

/// The mean over all forks.
pub(crate) fn share(positions: &[Vec3], triangles: &[[u32; 3]], tree: &Tree) -> f64 {
    let mut facets: Vec<Facet> = triangles
        .iter()
        .map(|triangle| Facet::new(triangle.map(|v| positions[v as usize])))
        .collect();
    facets.sort_unstable_by(|a, b| a.center.x.total_cmp(&b.center.x));
    let shares: Vec<f64> = tree
        .forks()
        .filter_map(|fork| of_fork(&facets, tree, fork))
        .collect();
    // No forks: 0, where the sum of nothing is -0.
    (0.0 + shares.iter().sum::<f64>()) / shares.len().max(1) as f64
}

struct Facet {
    center: Vec3,
    normal: Vec3,
    area: f32,
}

impl Facet {
    fn new([a, b, c]: [Vec3; 3]) -> Self {
        let cross = (b - a).cross(c - a);
        Self {
            center: (a + b + c) / 3.0,
            normal: cross.normalize_or_zero(),
            area: 0.5 * cross.length(),
        }
    }
}

/// The share of a fork, of facets sorted by x; none where there is too little to judge.
fn of_fork(facets: &[Facet], tree: &Tree, fork: usize) -> Option<f64> {
    let (center, radius) = (tree.positions[fork], tree.radius(fork));
    let children = tree.children[fork].iter();
    let thinnest = children.fold(f32::INFINITY, |least, &child| least.min(tree.radii[child]));
    if thinnest <= 0.0 {
        return None;
    }
    let branches = tree.branches(fork, FOLLOWED * radius);
    let others = others(tree, fork, &branches, (REACH + 4.0) * radius);
    let nearest = |place: Vec3, cones: &mut dyn Iterator<Item = [usize; 2]>| {
        cones.fold(f32::INFINITY, |least, cone| {
            least.min(tree.distance(place, cone))
        })
    };
    let is_own = |facet: &&Facet| {
        if facet.center.distance(center) > REACH * radius || facet.area < 1e-9 * radius * radius {
            return false;
        }
        let own = nearest(facet.center, &mut branches.iter().flatten().copied()).abs();
        let from_others = others
            .iter()
            .map(|&cone| tree.distance(facet.center, cone).abs());
        own < OWN * radius && from_others.fold(f32::INFINITY, f32::min) > own
    };
    let [first, end] = [-1.0, 1.0].map(|side| {
        facets.partition_point(|facet| facet.center.x < center.x + side * REACH * radius)
    });
    let own: Vec<&Facet> = facets[first..end].iter().filter(is_own).collect();
    if own.len() < MIN_FACETS {
        return None;
    }
    let blended = |place: Vec3| {
        let mut distances = branches
            .iter()
            .map(|branch| nearest(place, &mut branch.iter().copied()));
        let first = distances.next().unwrap_or_default();
        let width = 0.5 * thinnest;
        distances.fold(first, |least, other| {
            let near = (width - (least - other).abs()).max(0.0) / width;
            least.min(other) - near * near * width / 4.0
        })
    };
    let step = 0.01 * thinnest;
    let slope = |place: Vec3| {
        let along = |axis: Vec3| blended(place + step * axis) - blended(place - step * axis);
        Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or_zero()
    };
    let [mut off, mut all] = [0.0; 2];
    for facet in own {
        let area = f64::from(facet.area);
        all += area;
        if facet.normal.dot(slope(facet.center)) < OFF {
            off += area;
        }
    }
    Some(off / all)
}

/// Cones that pass a fork and are none of its branches.
fn others(tree: &Tree, fork: usize, branches: &[Vec<[usize; 2]>], reach: f32) -> Vec<[usize; 2]> {
    let among: HashSet<usize> = branches.iter().flatten().flatten().copied().collect();
    let near = |point: usize| tree.positions[point].distance(tree.positions[fork]) < reach;
    let cones = (0..tree.parents.len()).filter(|&point| near(point));
    cones
        .filter_map(|point| Some([tree.parents[point]?, point]))
        .filter(|&[parent, point]| !(among.contains(&parent) && among.contains(&point)))
        .collect()
}
