//! Times of a recording.

use std::fmt;
use std::str::FromStr;

use crate::OptionError;
use crate::given::by_text;

/// Most pictures of a series.
pub const MOST_PICTURES: u32 = 100_000;

/// A time of a recording (ms), or a series of them: FROM:TO:STEP.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Time {
    /// One time.
    At(f64),
    /// A series: from, to (excluded), and the step between, if it is given.
    Series(f64, f64, Option<f64>),
}

impl Time {
    /// All times (ms): of a series without a step as many as `pictures` says.
    ///
    /// # Errors
    /// A series that has no number of pictures, or too many.
    pub fn all(self, pictures: Option<u32>) -> Result<Vec<f64>, OptionError> {
        let (from, to, step) = match self {
            Self::At(time) => return Ok(vec![time]),
            Self::Series(from, to, step) => (from, to, step),
        };
        let (step, frames) = match (step, pictures) {
            (None, None) => {
                return Err(OptionError::together(
                    "--time FROM:TO needs a step, as in 0:100:0.5, or --frames N",
                ));
            }
            (None, Some(frames)) => ((to - from) / f64::from(frames), f64::from(frames)),
            // 0:0.3:0.1 gives three pictures in spite of rounding.
            (Some(step), _) => (step, ((to - from) / step - 1e-6).ceil().max(1.0)),
        };
        if frames > f64::from(MOST_PICTURES) {
            return Err(OptionError::together(format!(
                "--time makes {frames:.0} pictures: choose a larger step, for {MOST_PICTURES} at most"
            )));
        }
        if step.is_sign_positive() && pictures.is_some_and(|n| f64::from(n) != frames) {
            return Err(OptionError::together(format!(
                "--time makes {frames:.0} pictures: leave out --frames, or the step"
            )));
        }
        let time = |frame: u32| from + f64::from(frame) * step;
        Ok((0..frames as u32).map(time).collect())
    }
}

impl FromStr for Time {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text.split(':').map(|n| n.trim().parse().ok()).collect();
        let numbers = numbers.filter(|all| all.iter().all(|n| n.is_finite()));
        match numbers.as_deref() {
            Some(&[time]) => Ok(Self::At(time)),
            Some(&[from, to]) if from < to => Ok(Self::Series(from, to, None)),
            Some(&[from, to, step]) if from < to && step > 0.0 => {
                Ok(Self::Series(from, to, Some(step)))
            }
            _ => Err("a time in ms is needed, or FROM:TO:STEP, as in 0:100:0.5".into()),
        }
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::At(time) => time.fmt(f),
            Self::Series(from, to, None) => write!(f, "{from}:{to}"),
            Self::Series(from, to, Some(step)) => write!(f, "{from}:{to}:{step}"),
        }
    }
}

by_text!(Time);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_series_are_read() {
        for (text, time) in [
            ("14.5", Time::At(14.5)),
            ("-3", Time::At(-3.0)),
            ("0:100:0.5", Time::Series(0.0, 100.0, Some(0.5))),
            ("5:8", Time::Series(5.0, 8.0, None)),
        ] {
            assert_eq!(text.parse(), Ok(time));
            assert_eq!(time.to_string(), text);
        }
        for wrong in ["", "x", "3:1", "0:1:0", "0:1:-1", "0:1:2:3", "nan", "0:inf"] {
            assert!(wrong.parse::<Time>().is_err(), "{wrong}");
        }
    }
}
