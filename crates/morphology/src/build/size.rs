//! Whether a cell is too large for a neuron, as files in nanometers or voxels are, or too small, as those in millimeters.

use glam::DVec3;

use super::Node;

/// A side (µm) of the box around a cell that is possible for any radius: 5 cm. Axons that go through a whole
/// mouse brain stay below 2 cm, those of nanometers without good radii begin at some centimeters.
const POSSIBLE: f64 = 50_000.0;
/// A side (µm) that is possible even where neurites are thick. A cell of 5 µm in nanometers is as large.
const POSSIBLE_IF_THICK: f64 = 5_000.0;
/// The median radius (µm) of a thick neurite: in nanometers the thinnest ones have more, in voxels of 8 nm most do, in
/// micrometers only giant axons, which are shorter.
const THICK: f64 = 5.0;

/// The median distance (µm) of samples that is possible in a cell of more than [`POSSIBLE_IF_THICK`]: tracings through whole
/// brains have one every 5 to 50 µm.
const SPARSE: f64 = 200.0;
/// A side (µm) that is too small for a tracing of a neurite: in millimeters, it is a cell of 1 mm.
const SMALL: f64 = 1.0;
/// The radius (µm) of a soma that is too small, and the side of the cell below which that says something: in millimeters, a
/// soma of 5 µm has 0.005, and an axon through a whole brain 20.
const SMALL_SOMA: (f64, f64) = (0.1, 20.0);

/// What the size of a cell says of its unit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Size {
    Plausible,
    TooLarge,
    TooSmall,
}

/// Whether the unit is likely not the micrometer. The limits are chosen by eye, between cells as they are and the
/// same a thousand times larger or smaller; skeletons in voxels of 8 nm are found too.
pub(super) fn size(nodes: &[Node], is_of_soma: impl Fn(u32) -> bool) -> Size {
    let first = nodes.first().map_or(DVec3::ZERO, |node| node.position);
    let (min, max) = nodes.iter().fold((first, first), |(min, max), node| {
        (min.min(node.position), max.max(node.position))
    });
    let side = (max - min).max_element();
    if side <= POSSIBLE_IF_THICK {
        let of_soma = (0_u32..).zip(nodes).filter(|&(i, _)| is_of_soma(i));
        let soma = of_soma.map(|(_, node)| node.radius).fold(0.0, f64::max);
        let has_neurite = nodes.len() > 2 && side > 0.0;
        let (radius, largest) = SMALL_SOMA;
        let small_soma = soma > 0.0 && soma < radius && side < largest;
        return match has_neurite && (side < SMALL || small_soma) {
            true => Size::TooSmall,
            false => Size::Plausible,
        };
    }
    if side > POSSIBLE {
        return Size::TooLarge;
    }
    let of_neurites = (0_u32..).zip(nodes).filter(|&(i, _)| !is_of_soma(i));
    let mut radii: Vec<f64> = of_neurites.clone().map(|(_, node)| node.radius).collect();
    radii.retain(|&radius| radius > 0.0);
    if median(&mut radii).is_some_and(|radius| radius > THICK) {
        return Size::TooLarge;
    }
    let link = |(_, node): (u32, &Node)| {
        let parent = nodes.get(node.parent? as usize)?;
        Some(parent.position.distance(node.position))
    };
    let mut links: Vec<f64> = of_neurites.filter_map(link).collect();
    // Two points may be far apart; a tree of them is not.
    match links.len() > 2 && median(&mut links).is_some_and(|link| link > SPARSE) {
        true => Size::TooLarge,
        false => Size::Plausible,
    }
}

fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (middle < values.len()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Morphology, NeuriteKind, Oddity};

    /// Whether an axon of this length and radius is noted.
    fn noted(length: f64, radius: f64) -> bool {
        let node = |(i, x): (u32, f64)| Node {
            id: i64::from(i) + 1,
            kind: NeuriteKind::AXON,
            position: DVec3::new(x, 0.0, 0.0),
            radius,
            parent: i.checked_sub(1),
            section: None,
        };
        let nodes: Vec<Node> = (0_u32..).zip([0.0, length]).map(node).collect();
        let built = Morphology::from_nodes("axon", Vec::new(), &nodes).expect("built");
        built
            .notes
            .iter()
            .any(|note| note.oddity == Oddity::TooLarge)
    }

    #[test]
    fn nanometers_are_noted_and_large_cells_are_not() {
        assert!(noted(300_000.0, 150.0), "a cortical cell in nanometers");
        assert!(noted(20_000.0, 60.0), "a cell of a fly in nanometers");
        assert!(noted(80_000.0, 1.0), "in nanometers, without good radii");
        assert!(noted(61_811.0, 32.0), "in voxels of 8 nm");
        assert!(noted(24_000.0, 17.0), "a thin one in voxels of 8 nm");
        assert!(
            !noted(15_000.0, 0.4),
            "an axon through the brain of a mouse"
        );
        assert!(!noted(1_000.0, 250.0), "a stretch of a giant axon");
    }
}
