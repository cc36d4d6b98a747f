//! How far rings turn about their path: as little as possible between fixed ends and targets.

/// How a ring should stand: an angle and its weight; a weight of 0 for none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Target {
    pub(super) angle: f64,
    pub(super) weight: f64,
}

/// Weight of a ring that cannot turn.
pub(super) const FIXED: f64 = 1e6;
/// Weight of a zone's ring, beside a stiffness of 1 for a segment as long as its radius.
pub(super) const FACING: f64 = 8.0;

/// Angles that minimize Σ stiffnessᵢ (αᵢ₊₁ − αᵢ)² + Σ weightᵢ (αᵢ − angleᵢ)², by elimination.
/// `stiffness`: one less than rings.
pub(super) fn relax(stiffness: &[f64], targets: &[Target]) -> Vec<f64> {
    let count = targets.len();
    if targets.iter().all(|t| t.weight == 0.0) {
        return vec![0.0; count];
    }
    let (mut diagonal, mut right) = (vec![0.0; count], vec![0.0; count]);
    for (i, target) in targets.iter().enumerate() {
        diagonal[i] = target.weight;
        right[i] = target.weight * target.angle;
    }
    for (i, &k) in stiffness.iter().enumerate() {
        diagonal[i] += k;
        diagonal[i + 1] += k;
    }
    for (i, &k) in stiffness.iter().enumerate() {
        let factor = k / diagonal[i];
        diagonal[i + 1] -= factor * k;
        right[i + 1] += factor * right[i];
    }
    let mut angles = vec![0.0; count];
    for i in (0..count).rev() {
        let after = stiffness.get(i).map_or(0.0, |k| k * angles[i + 1]);
        angles[i] = (right[i] + after) / diagonal[i];
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turn_is_spread_between_fixed_ends() {
        let fixed = |angle: f64| Target {
            angle,
            weight: FIXED,
        };
        let targets = [fixed(0.0), Target::default(), Target::default(), fixed(0.6)];
        let angles = relax(&[1.0, 1.0, 0.5], &targets);
        // A segment half as stiff turns twice as far.
        for (angle, expected) in angles.iter().zip([0.0, 0.15, 0.3, 0.6]) {
            assert!((angle - expected).abs() < 1e-5, "{angles:?}");
        }
    }

    #[test]
    fn without_targets_nothing_turns() {
        assert_eq!(relax(&[1.0, 2.0], &[Target::default(); 3]), [0.0; 3]);
    }
}
