//! In which order sections are written.

use std::collections::HashMap;

use neurotess_morphology::{Morphology, Piece};

/// The sections in the order of the file that was read, but where a neurite begins with a section of one point, the first of
/// its children comes next: the two are one segment, which has the neurite's place among the others.
pub(super) fn neurites_begun(morphology: &Morphology) -> Vec<Piece> {
    let pieces = morphology.pieces_in_file_order();
    // Neurites that begin so, by their point, until their first child is found.
    let mut begun: HashMap<usize, usize> = HashMap::new();
    let mut place: Vec<(usize, bool)> = Vec::with_capacity(pieces.len());
    for (index, piece) in pieces.iter().enumerate() {
        let branch = piece.branch_point(morphology);
        let parent = branch.and_then(|branch| begun.remove(&branch));
        place.push(parent.map_or((index, false), |parent| (parent, true)));
        if branch.is_none() && piece.points.len() == 1 {
            begun.insert(piece.points.start, index);
        }
    }
    let mut ordered: Vec<((usize, bool), Piece)> = place.into_iter().zip(pieces).collect();
    ordered.sort_by_key(|(place, _)| *place);
    ordered.into_iter().map(|(_, piece)| piece).collect()
}
