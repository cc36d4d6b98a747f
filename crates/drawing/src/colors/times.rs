//! Times of pictures as their legends tell them.

/// A time as text, with enough digits to distinguish it from its neighbors.
pub(super) fn time_text(times: &[f64], time: f64) -> String {
    let rounded = |digits: i32| {
        let unit = 10f64.powi(digits);
        times
            .iter()
            .all(|t| ((t * unit).round() / unit - t).abs() < 1e-6)
    };
    let digits = (0..6).find(|&digits| rounded(digits)).unwrap_or(6);
    format!("{time:.*} ms", digits as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_digits_that_they_need() {
        assert_eq!(time_text(&[0.0, 1.0], 1.0), "1 ms");
        assert_eq!(time_text(&[0.0, 0.5], 0.0), "0.0 ms");
        assert_eq!(time_text(&[0.1 + 0.2], 0.1 + 0.2), "0.3 ms");
        assert_eq!(time_text(&[1.0 / 3.0], 1.0 / 3.0), "0.333333 ms");
    }
}
