//! Stems of a soma that has more of them than its surface has room for, gathered into trunks.
//!
//! A real soma has up to some twenty stems. A file may name any number: each takes a quad of the sphere
//! and twelve equations of its elastic answer, and beyond a few dozen their rings touch whatever is
//! done. So stems whose directions are near each other leave the soma together, by a trunk that forks
//! just outside; all stay attached, and the soma's cost has a bound.

use std::collections::BTreeMap;

use glam::DVec3;

use super::site::MIN_WAY;
use crate::tracing::SomaSphere;
use crate::tracing::{NONE, Root, Skeleton, SkeletonNode};
use crate::warning::Warnings;

/// Stems that a soma may have before any are gathered. A guard.
const MAX_STEMS: usize = 40;
/// Least angle between two trunks (radians): at most 58 disks of this angle fit on a sphere.
const APART: f64 = 0.5;

/// Gathers the stems of crowded somata.
pub(crate) fn gather(
    skeleton: &mut Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    warnings: &mut Warnings,
) {
    let mut stems: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (index, node) in skeleton.nodes().iter().enumerate() {
        if let (Root::Soma(soma), NONE) = (node.root, node.parent) {
            stems.entry(soma).or_default().push(index as u32);
        }
    }
    let mut bundles = Vec::new();
    for (soma, stems) in stems {
        if let Some(soma_sphere) = soma_spheres[soma as usize]
            .as_ref()
            .filter(|_| stems.len() > MAX_STEMS)
        {
            let near = bundle(skeleton, soma_sphere, stems).into_iter();
            bundles.extend(near.filter(|b| b.len() > 1).map(|b| (soma, soma_sphere, b)));
        }
    }
    if bundles.is_empty() {
        return;
    }
    let nodes = skeleton.links();
    for (soma, soma_sphere, bundle) in bundles {
        let trunk = SkeletonNode {
            parent: NONE,
            root: Root::Soma(soma),
            ..trunk(nodes, soma_sphere, &bundle)
        };
        let parent = nodes.len() as u32;
        nodes.push(trunk);
        for &stem in &bundle {
            let stem = &mut nodes[stem as usize];
            (stem.parent, stem.root) = (parent, Root::Free);
        }
        warnings.add_many(
            "stems_gathered",
            bundle.len(),
            "more neurites leave the soma than it has room for: neighbors share a trunk",
        );
    }
    skeleton.reorder();
}

/// Stems by trunk, the thickest first: each joins the nearest trunk within [`APART`], or begins one.
fn bundle(skeleton: &Skeleton, soma_sphere: &SomaSphere, mut stems: Vec<u32>) -> Vec<Vec<u32>> {
    let radius = |stem: u32| skeleton.node(stem).radius;
    stems.sort_by(|&a, &b| radius(b).total_cmp(&radius(a)).then(a.cmp(&b)));
    let mut trunks: Vec<(DVec3, Vec<u32>)> = Vec::new();
    for stem in stems {
        let direction = outwards(skeleton.node(stem), soma_sphere);
        let near = |trunk: &(DVec3, Vec<u32>)| trunk.0.dot(direction);
        let nearest = trunks.iter_mut().max_by(|a, b| near(a).total_cmp(&near(b)));
        match nearest {
            Some(trunk) if near(trunk) > APART.cos() => trunk.1.push(stem),
            _ => trunks.push((direction, vec![stem])),
        }
    }
    trunks.into_iter().map(|(_, stems)| stems).collect()
}

fn outwards(node: &SkeletonNode, soma_sphere: &SomaSphere) -> DVec3 {
    (node.center - soma_sphere.center)
        .try_normalize()
        .unwrap_or(DVec3::Y)
}

/// Where a bundle forks: as thick as its thickest stem, half-way to the nearest of them, but clear of
/// the soma.
fn trunk(nodes: &[SkeletonNode], soma_sphere: &SomaSphere, bundle: &[u32]) -> SkeletonNode {
    let thickest = nodes[bundle[0] as usize];
    let stems = bundle.iter().map(|&stem| &nodes[stem as usize]);
    let sum: DVec3 = stems.clone().map(|stem| outwards(stem, soma_sphere)).sum();
    let direction = sum
        .try_normalize()
        .unwrap_or(outwards(&thickest, soma_sphere));
    let distances = stems.map(|stem| stem.center.distance(soma_sphere.center));
    let nearest = distances.fold(f64::INFINITY, f64::min);
    let surface = soma_sphere.surface(direction);
    let clear = (MIN_WAY * thickest.radius).min(0.5 * surface);
    let distance = surface + (0.5 * (nearest - surface)).max(clear);
    SkeletonNode {
        center: soma_sphere.center + direction * distance,
        ..thickest
    }
}
