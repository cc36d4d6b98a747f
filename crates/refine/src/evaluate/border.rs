//! Where patches go over from one tracing point to another: what they show of the cell.
//!
//! Between two rings that is half way within a section, and between sections where the fork is, which the mesh says.
//!
//! A loft is nearest to the cone of its trunk until it leaves that, and then to the branch's. Its cubic leaves the trunk's
//! surface at w from the branch's cone, measured along the trunk, and arrives h above the trunk. Where it is as near to
//! either, w u² · 3l ≈ h (1 − u)² with u = 1 − y and the share l of the way that the first leg leaves (see `first_leg`).
//! Twin: plan.wgsl.

use neurotess_mesh::Role;

use super::corner::Corners;
use super::edges::SOMA_FILLET;
use super::four::{F32x4, Vec3x4};

/// Least height of insets above their trunks, in radii of the branch: their corners are lifted by no less.
pub(crate) const LEAST_LIFT: f32 = 0.4;
/// The cubics leave out terms of u³: with this factor their borders are within 0.02 of y for h / w from 0.03 to 1.
pub(crate) const BORDER_CUBIC: f32 = 1.2;

/// The y from which on lofts show their branches, at x between the trunk's corners a and b and the inset's d and c.
pub(crate) fn loft_border([a, b, c, d]: [&Corners; 4], x: F32x4) -> F32x4 {
    let mix = |a: Vec3x4, b: Vec3x4| a * (1.0 - x) + b * x;
    // The trunk's side, on the arc between its corners.
    let offset = mix(a.offset, b.offset);
    let length = a.offset.length() * (1.0 - x) + b.offset.length() * x;
    let near = mix(a.center, b.center) + offset.normalize_or(a.radial) * length;
    let least = c.radius * 1e-3;
    let far = ((near - c.center).cross(c.tangent).length() - c.radius).max(least);
    let height = height(a, d) * (1.0 - x) + height(b, c) * x;
    let third = F32x4::splat(2.0 / 3.0);
    let left = F32x4::select(
        a.has_role(Role::Soma),
        (SOMA_FILLET * c.radius / far).min(third),
        third,
    );
    let lifted = height.max(c.radius * LEAST_LIFT);
    1.0 / (1.0 + (BORDER_CUBIC / 3.0 * lifted / (far * left)).sqrt())
}

/// By how much of a part borders between rings lie before rows, so that the twin decides alike: less than the least
/// difference between a row and sixteenths with half a part, which is a sixteenth of a part.
pub(crate) const CLEAR_OF_ROWS: f32 = 0.01;

/// How far along the way to a point, of so many parts, what is shown becomes that of the point; `border`: that of the
/// point. It is shifted by half a part, as that of lofts is.
pub(crate) fn along_border(border: i8, parts: u32) -> f32 {
    if border == 0 {
        return 0.5;
    }
    let border = f32::from(border) / 16.0;
    border.abs() + (0.5 * border.signum() - CLEAR_OF_ROWS) / parts as f32
}

/// How far (µm) an inset's corner is off the cone of the trunk's corner.
fn height(trunk: &Corners, inset: &Corners) -> F32x4 {
    let from = inset.position - trunk.center;
    let of_soma = from.length() - trunk.offset.length();
    let of_tube = from.cross(trunk.tangent).length() - trunk.radius;
    F32x4::select(trunk.has_role(Role::Soma), of_soma, of_tube)
}

/// By how much y is shifted against the border for a vertex on a loft: half a row. A face between two rows shows the
/// soma if any of its corners does, else the highest section: that of the branch, but where a path ends at the inset.
pub(crate) fn shift(trunk: &Corners, inset: &Corners, rows: f32) -> F32x4 {
    let first = trunk.has_role(Role::Soma) | inset.collar.cmplt(F32x4::ZERO);
    F32x4::select(first, F32x4::splat(-0.5 / rows), F32x4::splat(0.5 / rows))
}

#[cfg(test)]
mod tests {
    use super::along_border;

    /// The part of the way that shows the lower section, where faces between two rows show the higher one.
    fn lower(border: i8, parts: u32) -> f32 {
        let is_second = |k: u32| k as f32 / parts as f32 >= along_border(border, parts);
        let of_second = (1..parts).filter(|&k| is_second(k)).count() as u32;
        let rows = match border < 0 {
            true => of_second,
            false => parts - 1 - of_second,
        };
        rows as f32 / parts as f32
    }

    #[test]
    fn faces_change_their_section_at_the_row_nearest_to_the_border() {
        for parts in [2, 3, 4, 8, 13, 16, 64] {
            for border in 1..=15 {
                let share = f32::from(border) / 16.0;
                for (border, share) in [(border, share), (-border, 1.0 - share)] {
                    // The ring of the higher section has a row at least.
                    let share = share.min(1.0 - 1.0 / parts as f32);
                    let off = (lower(border, parts) - share).abs();
                    assert!(
                        off <= 0.5 / parts as f32 + 1e-6,
                        "{border} of {parts}: {off}"
                    );
                }
            }
        }
    }

    #[test]
    fn within_a_section_samples_change_half_way() {
        assert_eq!([1, 5, 64].map(|parts| along_border(0, parts)), [0.5; 3]);
    }
}
