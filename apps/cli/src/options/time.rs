//! Times of a recording on the command line.

use std::str::FromStr;

/// `--time` (ms)
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Time {
    /// One time.
    At(f64),
    /// A series: from, to (excluded), and the step between, if it is given.
    Series(f64, f64, Option<f64>),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_series_are_read() {
        assert_eq!("14.5".parse(), Ok(Time::At(14.5)));
        assert_eq!("-3".parse(), Ok(Time::At(-3.0)));
        assert_eq!("0:100:0.5".parse(), Ok(Time::Series(0.0, 100.0, Some(0.5))));
        assert_eq!("5:8".parse(), Ok(Time::Series(5.0, 8.0, None)));
        for wrong in ["", "x", "3:1", "0:1:0", "0:1:-1", "0:1:2:3", "nan", "0:inf"] {
            assert!(wrong.parse::<Time>().is_err(), "{wrong}");
        }
    }
}
