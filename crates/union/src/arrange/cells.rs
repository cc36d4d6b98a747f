//! Winding numbers of the cells of an arrangement.
//!
//! Across a piece the number rises by one from the side of the normal to the other, so that all cells that
//! hang together follow from one of them; that one is told by a ray through the whole surface. The pieces
//! may be a small part of it.

use neurotess_mesh::Forest;

use crate::arrange::engine::{Arrangement, Piece};
use crate::arrange::region::Region;
use crate::arrange::winding::{Query, windings};
use crate::surface::work::Work;

/// Pieces in one place: most often one, more where faces coincide.
pub(crate) struct Wall {
    /// Numbers of the pieces; the first one's turning is the wall's.
    pub(crate) pieces: Vec<u32>,
    /// What the winding number rises by from the side of the normal to the other.
    step: i32,
    /// The cell on the side of the normal, and the other.
    pub(crate) cells: [u32; 2],
}

/// Pieces put together where they coincide, in the order of their first.
pub(crate) fn walls(arrangement: &Arrangement) -> Vec<Wall> {
    let pieces = &arrangement.pieces;
    let mut sorted: Vec<([u32; 3], u32)> = (0..)
        .zip(pieces)
        .map(|(n, piece)| {
            let mut key = piece.corners;
            key.sort_unstable();
            (key, n)
        })
        .collect();
    sorted.sort_unstable();
    let wall = |alike: &[([u32; 3], u32)]| {
        let first = &pieces[alike[0].1 as usize];
        let turns = alike
            .iter()
            .map(|&(_, n)| turns_alike(first, &pieces[n as usize]));
        Wall {
            step: turns.map(|alike| if alike { 1 } else { -1 }).sum(),
            cells: first.cells,
            pieces: alike.iter().map(|&(_, n)| n).collect(),
        }
    };
    let mut walls: Vec<Wall> = sorted.chunk_by(|a, b| a.0 == b.0).map(wall).collect();
    walls.sort_unstable_by_key(|wall| wall.pieces[0]);
    walls
}

/// Whether pieces of the same corners turn the same way.
pub(crate) fn turns_alike(a: &Piece, b: &Piece) -> bool {
    (0..3).any(|turn| (0..3).all(|n| a.corners[n] == b.corners[(n + turn) % 3]))
}

/// The winding number of each cell; none if two ways to a cell differ, which an arrangement of all faces
/// around each edge cannot give.
pub(crate) fn cell_windings(
    work: &Work,
    region: &Region,
    arrangement: &Arrangement,
    walls: &[Wall],
) -> Option<Vec<i32>> {
    let starts = starts(arrangement, walls);
    let queries: Vec<Query> = starts
        .iter()
        .map(|&wall| query(region, arrangement, &walls[wall]))
        .collect();
    let beside = windings(|face| work.corners(face), work.triangles.len(), &queries);

    let mut steps = vec![Vec::new(); arrangement.cells];
    for wall in walls {
        let [normal, behind] = wall.cells;
        steps[normal as usize].push((behind, wall.step));
        steps[behind as usize].push((normal, -wall.step));
    }
    let mut found: Vec<Option<i32>> = vec![None; arrangement.cells];
    for (&start, winding) in starts.iter().zip(beside) {
        // The ray starts on that side of the wall that +x is on.
        let rises = normal_x(arrangement, &walls[start]) > 0.0;
        let cell = walls[start].cells[usize::from(!rises)];
        found[cell as usize] = Some(winding);
        let mut open = vec![cell];
        while let Some(cell) = open.pop() {
            let winding = found[cell as usize]?;
            for &(next, step) in &steps[cell as usize] {
                match found[next as usize] {
                    None => {
                        found[next as usize] = Some(winding + step);
                        open.push(next);
                    }
                    Some(other) if other != winding + step => return None,
                    Some(_) => {}
                }
            }
        }
    }
    // Cells that no wall names have no piece either.
    Some(found.into_iter().map(Option::unwrap_or_default).collect())
}

/// For each set of cells that hang together, the wall that a ray along x leaves most safely.
fn starts(arrangement: &Arrangement, walls: &[Wall]) -> Vec<usize> {
    let mut forest = Forest::new(arrangement.cells);
    for wall in walls {
        forest.unite(wall.cells[0], wall.cells[1]);
    }
    let mut best: Vec<Option<(f64, usize)>> = vec![None; arrangement.cells];
    for (n, wall) in walls.iter().enumerate() {
        let best = &mut best[forest.root(wall.cells[0]) as usize];
        let alone = if wall.pieces.len() == 1 { 1.0 } else { 1e-9 };
        let safety = alone * height_across_x(arrangement, wall);
        if best.is_none_or(|(most, _)| safety > most) {
            *best = Some((safety, n));
        }
    }
    best.into_iter().flatten().map(|(_, n)| n).collect()
}

fn query(region: &Region, arrangement: &Arrangement, wall: &Wall) -> Query {
    let piece = |n: u32| &arrangement.pieces[n as usize];
    let corners = piece(wall.pieces[0]).corners;
    let sum: glam::DVec3 = corners
        .map(|corner| arrangement.position(corner))
        .iter()
        .sum();
    let mut without: Vec<u32> = wall
        .pieces
        .iter()
        .map(|&n| region.faces[piece(n).source as usize])
        .collect();
    without.sort_unstable();
    Query {
        point: sum / 3.0,
        without,
    }
}

/// Twice the area of a wall seen along x, signed.
fn normal_x(arrangement: &Arrangement, wall: &Wall) -> f64 {
    let corners = arrangement.pieces[wall.pieces[0] as usize].corners;
    let [a, b, c] = corners.map(|corner| arrangement.position(corner));
    (b - a).cross(c - a).x
}

/// The least height of a wall seen along x, about.
fn height_across_x(arrangement: &Arrangement, wall: &Wall) -> f64 {
    let corners = arrangement.pieces[wall.pieces[0] as usize].corners;
    let [a, b, c] = corners.map(|corner| arrangement.position(corner));
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if longest > 0.0 {
        normal_x(arrangement, wall).abs() / longest
    } else {
        0.0
    }
}
