//! How fast a tube widens at a ring between two others.
//!
//! **Theory.** Between rings the radius is a cubic (`Profiles` of refine's `evaluate/profile.rs`), and both cubics
//! beside a ring have this slope there, so that the radius is continuously differentiable. A cubic between two
//! values has no extremum inside if both its slopes have the sign of the way between the values and neither is more
//! than three times as steep: Fritsch and Carlson, Monotone piecewise cubic interpolation, SIAM Journal on Numerical
//! Analysis 17 (1980), 238–246, section 2 (the square in the region of their figure 1). So the slope is 0 where the
//! radius is locally greatest or least.

/// Greatest slope of a cubic at one of its ends, in slopes of the straight way, that keeps it monotone.
const STEEPEST: f64 = 3.0;

/// The straight way whose slope a ring takes where it may.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Straight {
    /// From the ring before to the one after.
    Across,
    /// From the ring before, so that the tube before it stays a cone.
    Before,
    /// To the ring after.
    After,
}

/// Change of the radius along the path (µm per µm, −1 to 1) at the second of three rings with these radii (µm), at
/// these distances from one to the next (µm): the slope of a straight way, limited so that the radius has no new
/// extremum.
pub(crate) fn taper(radii: [f64; 3], lengths: [f64; 2], straight: Straight) -> f64 {
    let [before, here, after] = radii;
    let slope = |way: f64, length: f64| way / length.max(f64::MIN_POSITIVE);
    let near = slope(here - before, lengths[0]);
    let far = slope(after - here, lengths[1]);
    let monotone = near * far > 0.0;
    if !monotone {
        return 0.0;
    }
    let wanted = match straight {
        Straight::Across => slope(after - before, lengths[0] + lengths[1]),
        Straight::Before => near,
        Straight::After => far,
    };
    let most = STEEPEST * near.abs().min(far.abs());
    wanted.clamp(-most, most).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_keeps_its_slope() {
        let slope = taper([3.0, 2.5, 1.0], [1.0, 3.0], Straight::Across);
        assert!((slope + 0.5).abs() < 1e-12, "{slope}");
    }

    #[test]
    fn a_ring_that_is_thickest_or_thinnest_or_as_thick_as_the_next_has_none() {
        for radii in [
            [1.0, 2.0, 1.5],
            [2.0, 1.0, 1.5],
            [1.0, 1.0, 2.0],
            [1.0, 2.0, 2.0],
        ] {
            assert_eq!(taper(radii, [1.0, 1.0], Straight::Across), 0.0, "{radii:?}");
        }
    }

    #[test]
    fn beside_a_jump_the_slope_is_no_more_than_three_times_the_gentler_one() {
        let slope = taper([2.0, 1.0, 0.9], [2.0, 2.0], Straight::Across);
        assert!((slope + 0.15).abs() < 1e-12, "{slope}");
    }

    #[test]
    fn a_cone_beside_a_ring_stays_one_where_that_makes_no_extremum() {
        let slope = |radii, straight| taper(radii, [1.0, 1.0], straight);
        assert!((slope([3.0, 2.0, 1.6], Straight::Before) + 1.0).abs() < 1e-12);
        assert!((slope([3.0, 2.0, 1.6], Straight::After) + 0.4).abs() < 1e-12);
        assert!((slope([3.0, 2.2, 2.1], Straight::Before) + 0.3).abs() < 1e-12);
        assert_eq!(slope([3.0, 2.0, 2.5], Straight::Before), 0.0);
    }

    #[test]
    fn rings_in_one_place_and_radii_that_are_no_numbers_give_a_slope_all_the_same() {
        assert_eq!(taper([1.0, 2.0, 3.0], [0.0, 0.0], Straight::Across), 1.0);
        assert!(taper([1.0, f64::NAN, 3.0], [1.0, 1.0], Straight::Across).is_finite());
    }
}
