//! Places of ticks on an axis, at round numbers.

/// The distance of ticks, 1, 2 or 5 times a power of ten, so that there are at most `most` within a length. 1 for a length
/// that is none.
pub fn step(length: f64, most: usize) -> f64 {
    let least = length / most.max(1) as f64;
    if !(least > 0.0 && least.is_finite()) {
        return 1.0;
    }
    let unit = 10f64.powf(least.log10().floor());
    let fits = |times: &&f64| unit * **times >= least * (1.0 - 1e-9);
    let times = [1.0, 2.0, 5.0].iter().find(fits).copied();
    unit * times.unwrap_or(10.0)
}

/// Multiples of [`step`] from `low` to `high`, at most `most` and one more.
pub fn ticks([low, high]: [f64; 2], most: usize) -> Vec<f64> {
    let step = step(high - low, most);
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    let count = (last - first).clamp(-1.0, most as f64 + 1.0) as i64;
    // Not the sum of steps: 3 × 0.1 is said as 0.3.
    (0..=count).map(|i| (first + i as f64) * step).collect()
}

/// Number of decimals that tell multiples of a step apart.
pub fn digits(step: f64) -> usize {
    match step.abs() {
        step if step > 0.0 && step.is_finite() => (-step.log10() - 1e-9).ceil().max(0.0) as usize,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(ticks([0.0, 10.0], 5), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks([-80.3, 17.0], 6), [-80.0, -60.0, -40.0, -20.0, 0.0]);
        assert_eq!(ticks([1.0, 1.0], 5), [1.0]);
        for length in [1e-9, 0.37, 1.0, 9.99, 123.4, 7e8] {
            let count = ticks([0.1 * length, 1.1 * length], 7).len();
            assert!((2..=8).contains(&count), "{length}: {count}");
        }
        assert_eq!([0.5, 1.0, 20.0, 0.025, 0.1].map(digits), [1, 0, 0, 2, 1]);
        assert!(ticks([f64::NAN, 1.0], 5).len() < 8);
    }
}
