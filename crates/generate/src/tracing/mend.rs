//! Mends the tracing before it is meshed: radii, coincident points, what lies inside the soma.
//!
//! Every mending is counted and reported with the first sample concerned; none is silent.

use glam::DVec3;

use super::skeleton::{NONE, Root, Skeleton, SkeletonNode};
use super::soma_sphere::SomaSphere;
use crate::warning::Warnings;

/// Radius (µm) of last resort, as of a thin dendrite: where no point of a cell has one.
const FALLBACK_RADIUS: f64 = 0.5;
/// Points nearer to their parent than this share of the larger radius are one point. A guard.
const COINCIDENT: f64 = 1e-3;
/// What is so near over the soma's surface lies within it, as a share of the distance from the center: many tracings begin on
/// the sphere. A guard.
const INSIDE: f64 = 0.02;

/// Changes all radii (µm).
pub(crate) fn change_radii(skeleton: &mut Skeleton, change: impl Fn(f64) -> f64) {
    let count = skeleton.nodes().len() as u32;
    let (mut shapes, _) = skeleton.shapes();
    for index in 0..count {
        let radius = shapes.node(index).radius;
        shapes.set_radius(index, change(radius));
    }
}

/// Replaces radii that are no radii by `unknown` (µm), or by what the path around them says.
pub(crate) fn mend_radii(skeleton: &mut Skeleton, unknown: Option<f64>, warnings: &mut Warnings) {
    let good = |r: f64| r.is_finite() && r > 0.0;
    if skeleton.nodes().iter().all(|n| good(n.radius)) {
        return;
    }
    let mut tell = |sample: i64, radius: f64, from_neighbors: bool| match from_neighbors {
        true => warnings.add(
            "radius_mended",
            Some(sample),
            "radius was zero, negative or no number: taken from its neighbors",
        ),
        false => warnings.add(
            "radius_unknown",
            Some(sample),
            &format!("no radius here or along the path: {radius} µm taken; --radius says another"),
        ),
    };
    let fallback = median(
        skeleton
            .nodes()
            .iter()
            .map(|n| n.radius)
            .filter(|&r| good(r))
            .collect(),
    )
    .unwrap_or(FALLBACK_RADIUS);
    let count = skeleton.nodes().len();
    // Nearest good radius and its distance: towards the root, and towards the ends.
    let mut up: Vec<Option<(f64, f64)>> = vec![None; count];
    let mut down: Vec<Option<(f64, f64)>> = vec![None; count];
    let nodes = skeleton.nodes();
    let length = |i: usize| {
        let parent = nodes[i].parent as usize;
        nodes[i].center.distance(nodes[parent].center)
    };
    for i in 0..count {
        let node = nodes[i];
        up[i] = if good(node.radius) {
            Some((node.radius, 0.0))
        } else if node.parent == NONE {
            None
        } else {
            up[node.parent as usize].map(|(r, d)| (r, d + length(i)))
        };
    }
    for i in (0..count).rev() {
        let node = nodes[i];
        if good(node.radius) {
            down[i] = Some((node.radius, 0.0));
        }
        if node.parent == NONE {
            continue;
        }
        if let Some((r, d)) = down[i] {
            let d = d + length(i);
            let parent = &mut down[node.parent as usize];
            if parent.is_none_or(|(_, other)| d < other) {
                *parent = Some((r, d));
            }
        }
    }
    let (mut shapes, _) = skeleton.shapes();
    for i in 0..count {
        let node = *shapes.node(i as u32);
        if good(node.radius) {
            continue;
        }
        let near = match (up[i], down[i]) {
            (Some((a, da)), Some((b, db))) if da + db > 0.0 => Some((a * db + b * da) / (da + db)),
            (Some((r, _)), _) | (None, Some((r, _))) => Some(r),
            (None, None) => None,
        };
        let near = near.filter(|_| unknown.is_none());
        let radius = near.or(unknown).unwrap_or(fallback);
        shapes.set_radius(i as u32, radius);
        tell(node.sample, radius, near.is_some());
    }
}

/// Makes neurites at least this thick (µm).
pub(crate) fn thicken(skeleton: &mut Skeleton, least: f64, warnings: &mut Warnings) {
    let thin = |node: &&SkeletonNode| node.radius < least;
    let mut thin = skeleton.nodes().iter().filter(thin);
    let Some(first) = thin.next().map(|node| node.sample) else {
        return;
    };
    let others = thin.count();
    let message = "thinner than the least radius that was asked for: made as thick";
    warnings.add("radius_raised", Some(first), message);
    warnings.add_many("radius_raised", others, message);
    change_radii(skeleton, |radius| radius.max(least));
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Merges points that coincide with their parent. The larger radius stays, except at a fork, whose
/// repetition in a child carries the child's own radius.
pub(crate) fn merge_coincident(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let count = skeleton.nodes().len();
    let (mut shapes, children) = skeleton.shapes();
    let mut keep = vec![true; count];
    let mut merged_into: Vec<u32> = (0..count as u32).collect();
    for i in 0..count {
        let node = *shapes.node(i as u32);
        if node.parent == NONE {
            continue;
        }
        let parent = merged_into[node.parent as usize];
        let before = *shapes.node(parent);
        let larger = before.radius.max(node.radius);
        if node.center.distance(before.center) >= COINCIDENT * larger {
            continue;
        }
        keep[i] = false;
        merged_into[i] = parent;
        if children.of(node.parent).len() == 1 {
            shapes.set_radius(parent, larger);
        }
        warnings.add(
            "coincident_points",
            Some(node.sample),
            "point coincides with its parent: merged",
        );
    }
    skeleton.retain(&keep);
}

/// Leaves out what a neurite traces inside its soma: its leading points, or all of it.
pub(crate) fn leave_out_inside(
    skeleton: &mut Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    warnings: &mut Warnings,
) {
    let children = skeleton.children();
    let count = skeleton.nodes().len();
    let mut keep = vec![true; count];
    // The soma that a node may still be inside of: all nodes before it were.
    let mut leading: Vec<Option<u32>> = vec![None; count];
    let mut dropped_roots = 0;
    for i in 0..count {
        let node = skeleton.nodes()[i];
        let soma = match node.root {
            Root::Soma(soma) if node.parent == NONE => Some(soma),
            _ if node.parent != NONE => leading[node.parent as usize],
            _ => None,
        };
        let Some((soma, soma_sphere)) =
            soma.and_then(|s| Some((s, soma_spheres[s as usize].as_ref()?)))
        else {
            continue;
        };
        let distance = node.center.distance(soma_sphere.center);
        let surface = soma_sphere.towards(node.center);
        if distance < (1.0 + INSIDE) * surface {
            keep[i] = false;
            leading[i] = Some(soma);
            dropped_roots += usize::from(children.of(i as u32).is_empty());
            warnings.add(
                "inside_soma",
                Some(node.sample),
                "point lies inside the soma: left out of the mesh",
            );
        }
    }
    if dropped_roots > 0 {
        warnings.add_many(
            "neurite_inside_soma",
            dropped_roots,
            "branch ends inside the soma: left out of the mesh",
        );
    }
    skeleton.retain(&keep);
}

/// Gives a free tree of one point a second one, so that it becomes a short rod.
pub(crate) fn lengthen_single_points(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let children = skeleton.children();
    let single = |i: &u32| {
        let node = skeleton.node(*i);
        node.parent == NONE && node.root == Root::Free && children.of(*i).is_empty()
    };
    let singles: Vec<u32> = (0..skeleton.nodes().len() as u32).filter(single).collect();
    if singles.is_empty() {
        return;
    }
    let nodes = skeleton.links();
    for i in singles {
        let node = nodes[i as usize];
        let half = DVec3::Y * (0.5 * node.radius);
        nodes[i as usize].center -= half;
        nodes.push(SkeletonNode {
            center: node.center + half,
            parent: i,
            ..node
        });
        warnings.add(
            "one_point_tree",
            Some(node.sample),
            "tree of a single point: drawn as a rod of its radius",
        );
    }
}
