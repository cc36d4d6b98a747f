//! Times of pictures: `--time`, and `--frames` with it.

use crate::options::time::Time;
use crate::report::usage;

/// Most pictures of a series.
pub(crate) const MOST: u32 = 100_000;

/// Times (ms) of all pictures, as `--time` and `--frames` say; none: `--time` is not given.
///
/// # Errors
/// Wrong usage: a series that has no number of pictures, or too many.
pub(crate) fn times(time: Option<Time>, pictures: Option<u32>) -> anyhow::Result<Option<Vec<f64>>> {
    let (from, to, step) = match time {
        None => return Ok(None),
        Some(Time::At(time)) => return Ok(Some(vec![time])),
        Some(Time::Series(from, to, step)) => (from, to, step),
    };
    let (step, frames) = match (step, pictures) {
        (None, None) => {
            return usage("--time FROM:TO needs a step, as in 0:100:0.5, or --frames N");
        }
        (None, Some(frames)) => ((to - from) / f64::from(frames), f64::from(frames)),
        // 0:0.3:0.1 gives three pictures in spite of rounding.
        (Some(step), _) => (step, ((to - from) / step - 1e-6).ceil().max(1.0)),
    };
    if frames > f64::from(MOST) {
        return usage(format!(
            "--time makes {frames:.0} pictures: choose a larger step, for {MOST} at most"
        ));
    }
    if step.is_sign_positive() && pictures.is_some_and(|n| f64::from(n) != frames) {
        return usage(format!(
            "--time makes {frames:.0} pictures: leave out --frames, or the step"
        ));
    }
    let time = |frame: u32| from + f64::from(frame) * step;
    Ok(Some((0..frames as u32).map(time).collect()))
}

/// A time as text, with enough digits to distinguish it from its neighbors.
pub(crate) fn time_text(times: &[f64], time: f64) -> String {
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
