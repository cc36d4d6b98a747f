//! Points put between traced ones, so that branches can bend where they meet.

use super::rods::Rods;
use super::spread::Spread;

/// Up to this many spread lengths from a contact segments are cut.
const NEAR: f64 = 1.5;
/// Longest piece, in radii. Not shorter: pieces of 1.2 radii make bends that cross in the mesh.
const PIECE: f64 = 2.0;
/// Pieces of one segment, at most, in one go. A guard.
const MAX_PIECES: f64 = 200.0;

/// Cuts segments near contacts; returns whether any was cut. `room`: points that may still be added.
pub(super) fn cut_near_contacts(rods: &mut Rods, spread: &Spread, room: &mut usize) -> bool {
    let mut parts = vec![1; rods.count()];
    for i in rods.segments() {
        let above = rods.parent(i);
        let distance = [i, above].map(|n| spread.distance[n as usize]);
        if distance[0].min(distance[1]) >= NEAR || rods.fixed(i) {
            continue;
        }
        let piece = PIECE * rods.radius(i).max(rods.radius(above));
        let wanted = (rods.length[i as usize] / piece).ceil();
        let wanted = wanted.clamp(1.0, MAX_PIECES) as u32;
        let part = wanted.min(u32::try_from(*room).unwrap_or(u32::MAX).saturating_add(1));
        *room -= part as usize - 1;
        parts[i as usize] = part;
    }
    let any = parts.iter().any(|&part| part > 1);
    if any {
        rods.cut(&parts);
    }
    any
}
