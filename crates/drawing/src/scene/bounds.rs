//! Bounding spheres of the scene.

use neurotess_picture::bounds::{bounds, merged, traced};
use neurotess_picture::{BoundingSphere, Placement};
use rayon::prelude::*;

use super::cells::MANY;
use crate::meshed::MeshedCell;

/// Most spheres of a scene, which take milliseconds to fit a camera to and to test tiles with.
const MAX_SPHERES: usize = 400_000;

/// Fewest of a cell; among so many cells that the shape of a single one hardly matters, fewer.
const FEWEST: usize = 16;
const FEWEST_OF_MANY: usize = 4;
const MANY_CELLS: usize = 1 << 17;

/// Bounding spheres of the scene, to fit a camera to.
pub(crate) fn spheres(
    cells: &[&MeshedCell],
    placements: &[(usize, Placement)],
) -> Vec<BoundingSphere> {
    if placements.len() >= MANY || cells.iter().any(|cell| cell.bounds.is_some()) {
        return covering(cells, placements);
    }
    let own: Vec<Vec<BoundingSphere>> = cells.iter().map(|cell| traced(&cell.mesh)).collect();
    placed(&own, placements)
}

/// Bounding spheres that hold all surfaces, at any level.
pub(crate) fn covering(
    cells: &[&MeshedCell],
    placements: &[(usize, Placement)],
) -> Vec<BoundingSphere> {
    let fewest = match placements.len() < MANY_CELLS {
        true => FEWEST,
        false => FEWEST_OF_MANY,
    };
    let most = (MAX_SPHERES / placements.len().max(1)).max(fewest);
    let own: Vec<Vec<BoundingSphere>> = cells
        .par_iter()
        .map(|cell| match &cell.bounds {
            Some(known) => merged(known, most),
            None => merged(&bounds(&cell.mesh), most),
        })
        .collect();
    placed(&own, placements)
}

/// Spheres of cells where their instances are.
fn placed(own: &[Vec<BoundingSphere>], placements: &[(usize, Placement)]) -> Vec<BoundingSphere> {
    let at = |&(cell, placement): &(usize, Placement)| {
        let spheres = own[cell].iter();
        spheres.map(move |&(center, radius)| {
            (placement.world_from_cell(center), radius * placement.scale)
        })
    };
    // A million cells have 4 million spheres: 128 MB, which must not be moved as they grow.
    let count = placements.iter().map(|&(cell, _)| own[cell].len()).sum();
    let mut spheres = Vec::with_capacity(count);
    placements
        .iter()
        .for_each(|placement| spheres.extend(at(placement)));
    spheres
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::*;

    #[test]
    fn spheres_go_where_cells_are_placed() {
        let own = [vec![(DVec3::X, 1.0)]];
        let turned = Placement {
            rotation: DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            scale: 2.0,
            translation: DVec3::new(0.0, 0.0, 5.0),
        };
        let spheres = placed(&own, &[(0, Placement::default()), (0, turned)]);
        assert_eq!(spheres[0], (DVec3::X, 1.0));
        assert!(spheres[1].0.distance(DVec3::new(0.0, 2.0, 5.0)) < 1e-12 && spheres[1].1 == 2.0);
    }
}
