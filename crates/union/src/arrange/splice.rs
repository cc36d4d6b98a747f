//! The union near crossings, put into the surface in place of what was there.
//!
//! Faces of a region are arranged and those pieces kept that have the solid behind them and nothing in
//! front. The rest of the surface is not cut by anything, so whatever of it hangs together is kept or goes
//! as a whole, as the faces of the region beside it do.

use glam::DVec3;
use neurotess_mesh::Forest;

use crate::arrange::cells::{Wall, cell_windings, turns_alike, walls};
use crate::arrange::engine::{Arrangement, arrange};
use crate::arrange::region::Region;
use crate::arrange::sheets::{Kept, Sheets};
use crate::surface::work::Work;

/// Why a region could not be replaced. With more rings of neighbors it may.
#[derive(Debug)]
pub(crate) enum Fault {
    /// The arrangement failed.
    Engine(String),
    /// What is kept does not close.
    Open,
    /// Two ways to a cell give different winding numbers.
    Inconsistent,
}

/// Replaces the faces of a region by the union of the surface with itself there.
pub(crate) fn splice(work: &mut Work, region: &Region) -> Result<(), Fault> {
    let corners: Vec<[DVec3; 3]> = region.faces.iter().map(|&f| work.corners(f)).collect();
    let arrangement = arrange(&corners).map_err(Fault::Engine)?;
    let walls = walls(&arrangement);
    let windings = cell_windings(work, region, &arrangement, &walls).ok_or(Fault::Inconsistent)?;
    let kept = kept(&arrangement, &walls, &windings);
    let stays = rest(work, region, &kept)?;
    let sheets = Sheets::new(work, region, &arrangement, &kept, &stays).ok_or(Fault::Open)?;
    let faces = sheets.faces(work);
    replace(work, region, &faces, &stays);
    Ok(())
}

/// The boundary of where the winding number is 1 or more, in the order of the sources.
fn kept(arrangement: &Arrangement, walls: &[Wall], windings: &[i32]) -> Vec<Kept> {
    let solid = |cell: u32| windings[cell as usize] >= 1;
    let mut kept = Vec::new();
    for wall in walls {
        let [front, behind] = wall.cells.map(solid);
        if front == behind {
            continue;
        }
        let pieces = wall.pieces.iter().map(|&n| &arrangement.pieces[n as usize]);
        let first = &arrangement.pieces[wall.pieces[0] as usize];
        // The first that has the solid behind it; where faces cancel, none may.
        let fits = |turns: bool| turns == behind;
        let of = pieces.clone().find(|piece| fits(turns_alike(first, piece)));
        kept.push(match of {
            Some(piece) => Kept {
                source: piece.source,
                corners: piece.corners,
            },
            None => Kept {
                source: first.source,
                corners: [first.corners[0], first.corners[2], first.corners[1]],
            },
        });
    }
    kept.sort_by_key(|piece| piece.source);
    kept
}

/// For each face of the surface outside the region, whether it stays.
fn rest(work: &Work, region: &Region, kept: &[Kept]) -> Result<Vec<bool>, Fault> {
    let count = work.vertices.len();
    let mut forest = Forest::new(count);
    let mut outside = vec![false; count];
    for (&[a, b, c], _) in work
        .triangles
        .iter()
        .zip(&region.has)
        .filter(|(_, has)| !**has)
    {
        forest.unite(a, b);
        forest.unite(b, c);
        [a, b, c]
            .iter()
            .for_each(|&corner| outside[corner as usize] = true);
    }
    let mut is_kept = vec![false; region.faces.len()];
    for piece in kept {
        is_kept[piece.source as usize] = true;
    }
    let mut stays: Vec<Option<bool>> = vec![None; count];
    for ((&face, &crossing), &is_kept) in region.faces.iter().zip(&region.crossing).zip(&is_kept) {
        for corner in work.triangles[face as usize] {
            if outside[corner as usize] {
                let stays = &mut stays[forest.root(corner) as usize];
                // A face that is cut says nothing of the whole of its neighbor.
                if crossing || stays.is_some_and(|stays| stays != is_kept) {
                    return Err(Fault::Open);
                }
                *stays = Some(is_kept);
            }
        }
    }
    let stays = work.triangles.iter().zip(&region.has).map(|(face, &has)| {
        // What has no neighbor in the region crosses nothing.
        !has && stays[forest.root(face[0]) as usize].unwrap_or(true)
    });
    Ok(stays.collect())
}

/// Puts faces, told with the number of their source in the region, where their sources were.
fn replace(work: &mut Work, region: &Region, faces: &[(u32, [u32; 3])], stays: &[bool]) {
    let mut triangles = Vec::with_capacity(work.triangles.len());
    let mut parts = Vec::with_capacity(work.triangles.len());
    let mut changed = Vec::with_capacity(work.triangles.len());
    let mut pieces = faces.iter().peekable();
    let mut source = 0;
    for (face, &stays) in stays.iter().enumerate() {
        let part = work.parts[face];
        if region.has[face] {
            while let Some((_, corners)) = pieces.next_if(|(of, _)| *of == source) {
                triangles.push(*corners);
                parts.push(part);
                changed.push(work.changed[face] || region.crossing[source as usize]);
            }
            source += 1;
        } else if stays {
            triangles.push(work.triangles[face]);
            parts.push(part);
            changed.push(work.changed[face]);
        }
    }
    work.triangles = triangles;
    work.parts = parts;
    work.changed = changed;
}
