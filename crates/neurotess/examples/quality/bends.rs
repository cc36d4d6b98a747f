//! How far the wall on the inner side of bends is inside the cones that were traced.

use glam::Vec3;

use crate::tree::Tree;

/// Turns (degrees) that are looked at, in two classes.
const TURNS: [[f32; 2]; 2] = [[40.0, 100.0], [100.0, 140.0]];
/// Radii from a bend within which there must be no fork, and no other neurite's wall is taken for its own.
const APART: f32 = 4.0;
/// Cones before and after a bend whose union its wall is compared with.
const CONES: usize = 4;

/// Of bends that turn by 40 to 100°, and of those up to 140°: how many there are away from forks, and the median depth of
/// their inner walls within the union of the round cones there, in radii.
pub(crate) fn inside(positions: &[Vec3], triangles: &[[u32; 3]], tree: &Tree) -> [(usize, f32); 2] {
    let mut walls: Vec<[Vec3; 3]> = triangles
        .iter()
        .map(|triangle| triangle.map(|v| positions[v as usize]))
        .collect();
    walls.sort_unstable_by(|a, b| a[0].x.total_cmp(&b[0].x));
    let longest = walls.iter().map(|wall| {
        let x = wall.map(|corner| corner.x);
        x[1].max(x[2]) - x[0].min(x[1]).min(x[2])
    });
    let widest = longest.fold(0.0, f32::max);
    let forks: Vec<usize> = tree.forks().collect();
    let mut depths = [Vec::new(), Vec::new()];
    for point in 0..tree.positions.len() {
        let Some((class, inwards)) = bend(tree, point) else {
            continue;
        };
        let (center, radius) = (tree.positions[point], tree.radii[point]);
        let is_near =
            |fork: &usize| tree.positions[*fork].distance(center) < APART * tree.radius(*fork);
        if radius <= 0.0 || forks.iter().any(is_near) {
            continue;
        }
        let reach = APART * radius;
        let from = walls.partition_point(|wall| wall[0].x < center.x - reach - widest);
        let near = walls[from..]
            .iter()
            .take_while(|wall| wall[0].x <= center.x + reach + widest);
        let hits = near.filter_map(|wall| leaves(center, inwards, wall));
        let wall = hits.fold(f32::INFINITY, f32::min);
        if wall > reach {
            continue;
        }
        let cones = cones(tree, point);
        let at = center + inwards * wall;
        let outside = cones
            .iter()
            .map(|&cone| tree.distance(at, cone))
            .fold(f32::INFINITY, f32::min);
        depths[class].push((-outside / radius).max(0.0));
    }
    depths.map(|mut depths| {
        depths.sort_unstable_by(f32::total_cmp);
        let median = depths.get(depths.len() / 2).copied().unwrap_or(0.0);
        (depths.len(), median)
    })
}

/// Of a point where a path turns, which class of turns it is, and the unit direction to the inner side.
fn bend(tree: &Tree, point: usize) -> Option<(usize, Vec3)> {
    let &[child] = &tree.children[point][..] else {
        return None;
    };
    let center = tree.positions[point];
    let incoming = (center - tree.positions[tree.parents[point]?]).try_normalize()?;
    let outgoing = (tree.positions[child] - center).try_normalize()?;
    let turn = incoming.angle_between(outgoing).to_degrees();
    let class = TURNS
        .iter()
        .position(|[least, most]| (*least..*most).contains(&turn))?;
    Some((class, (outgoing - incoming).try_normalize()?))
}

/// Where a ray leaves the surface through a triangle; nothing where it enters or misses.
fn leaves(from: Vec3, along: Vec3, &[a, b, c]: &[Vec3; 3]) -> Option<f32> {
    // Möller and Trumbore, Fast, minimum storage ray-triangle intersection, 1997.
    let (ab, ac) = (b - a, c - a);
    let across = along.cross(ac);
    let facing = ab.dot(across);
    if ab.cross(ac).dot(along) <= 0.0 || facing == 0.0 {
        return None;
    }
    let to = from - a;
    let u = to.dot(across) / facing;
    let side = to.cross(ab);
    let v = along.dot(side) / facing;
    let t = ac.dot(side) / facing;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// The cones of a path around a point.
fn cones(tree: &Tree, point: usize) -> Vec<[usize; 2]> {
    let mut cones = Vec::new();
    let mut here = point;
    while let Some(parent) = tree.parents[here].filter(|_| cones.len() < CONES) {
        cones.push([parent, here]);
        here = parent;
    }
    here = point;
    while let [child] = tree.children[here][..]
        && cones.len() < 2 * CONES
    {
        cones.push([here, child]);
        here = child;
    }
    cones
}
