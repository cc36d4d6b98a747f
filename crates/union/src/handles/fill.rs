//! Small holes that merging has made are filled.
//!
//! **Theory.** A branch that bends back into itself by about as much as it is thick closes a loop around a hole that
//! is smaller than the branch: a handle that tells nothing of the cell. As I. Guskov and Z. Wood (Topological Noise
//! Removal, 2001), we look for handles within small pieces of the surface, here around seams. Loops that bound a disk
//! outside the solid, **tunnels** (T. Dey, K. Li, J. Sun, On Computing Handle and Tunnel Loops, 2007), are filled: a
//! small body that holds the loop is merged into the surface. Loops that go around a bridge of solid are left.
//!
//! **Why not** cut the surface along the loop and close both sides with a disk each, as Guskov and Wood do: in a
//! hole of three edges, or in the tip of a crack, there is no room for two disks that do not cross. For a union
//! crossings are no obstacle.
//!
//! **Practice.** Only surfaces with more handles than before are looked at. Each body is tried on a copy. It is kept
//! if there are fewer handles, as many components as before, and nothing crosses.

use neurotess_mesh::{SurfaceVertex, Topology, Watch, genus_by_component, measure};

use super::blend::blend;
use super::loops::{least_radius, middle, seams, tunnels};
use super::patch::Loop;
use super::plug::Ellipsoid;
use crate::body::{handles, is_sound};
use crate::options::{UnionError, UnionOptions};
use crate::report::Filled;
use crate::surface::work::Work;

/// Sizes of bodies that are tried: by what just holds the loop, and at least of the radius there. Their faces are
/// flat, so that 1 would not hold it. The first was enough in the real cells.
const SIZES: [(f64, f64); 4] = [(1.3, 0.15), (1.3, 0.05), (1.7, 0.3), (2.2, 0.5)];

/// Fills small holes at seams, and tells each. `handles_before` are those that merging did not make.
pub(crate) fn fill(
    work: &mut Work,
    options: &UnionOptions,
    handles_before: i64,
    watch: &Watch<'_>,
) -> Result<Vec<Filled>, UnionError> {
    let mut filled = Vec::new();
    // Faster than all of the shape, and enough for most cells.
    let handles_now = genus_by_component(work.vertices.len(), &work.faces());
    if handles_now.iter().sum::<i64>() <= handles_before {
        return Ok(filled);
    }
    let mut now = work.shape();
    for seam in seams(work) {
        while handles(&now) > handles_before
            && let Some((shape, one)) = fill_one(work, &now, &seam, options, watch)?
        {
            now = shape;
            filled.push(one);
        }
    }
    Ok(filled)
}

/// Fills a hole at a seam, if there is one that can be filled; returns the shape after.
fn fill_one(
    work: &mut Work,
    before: &Topology,
    seam: &[u32],
    options: &UnionOptions,
    watch: &Watch<'_>,
) -> Result<Option<(Topology, Filled)>, UnionError> {
    watch.check()?;
    let loops = tunnels(work, seam, options.fill);
    for size in SIZES {
        for around in &loops {
            let Some(tried) = plugged(work, around, size, options, watch)? else {
                continue;
            };
            let after = tried.shape();
            if is_better(before, &after) {
                let tried = blend(tried, work.vertices.len() as u32, options.needles);
                let filled = told(work, &tried, around);
                *work = tried;
                return Ok(Some((after, filled)));
            }
        }
    }
    Ok(None)
}

/// The surface with a body around a loop merged into it; none if it then crosses itself, or nothing comes of it.
fn plugged(
    work: &Work,
    around: &Loop,
    (scale, least): (f64, f64),
    options: &UnionOptions,
    watch: &Watch<'_>,
) -> Result<Option<Work>, UnionError> {
    let least = least * least_radius(work, &around.vertices);
    let Some(body) = Ellipsoid::around(&around.points(work), scale, least) else {
        return Ok(None);
    };
    let names: Vec<SurfaceVertex> = around
        .vertices
        .iter()
        .map(|&v| work.vertices[v as usize])
        .collect();
    let of = around.vertices.first();
    let of = of.and_then(|v| work.triangles.iter().position(|face| face.contains(v)));
    let part = of.map_or(0, |face| work.parts[face]);
    body.body().merged(work, &names, part, options, watch)
}

fn is_better(before: &Topology, after: &Topology) -> bool {
    is_sound(after) && after.components == before.components && handles(after) < handles(before)
}

fn told(before: &Work, after: &Work, around: &Loop) -> Filled {
    let [volume, more] = [before, after].map(|work| {
        let measured = measure(&work.positions(), &work.faces());
        measured.volume
    });
    let middle = middle(&around.points(before));
    let distance = |vertex: &u32| before.position(*vertex).as_dvec3().distance(middle);
    let nearest = around.vertices.iter().copied();
    let nearest = nearest.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let beside = nearest.map_or_else(Default::default, |n| before.vertices[n as usize]);
    Filled {
        position: before.place(middle),
        point: beside.point,
        section: beside.section,
        girth: around.length,
        volume: more - volume,
    }
}
