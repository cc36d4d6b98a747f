//! Numbers within bounds.

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("a number above 0 is needed".into()),
    }
}

#[cfg(feature = "render")]
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number >= 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("a number of 0 or more is needed".into()),
    }
}

/// A factor on radii. Far beyond these bounds there is nothing to recognize.
#[cfg(feature = "render")]
pub(crate) fn radius_factor(text: &str) -> Result<f64, String> {
    match positive(text) {
        Ok(factor) if (0.01..=1000.0).contains(&factor) => Ok(factor),
        _ => Err("a number from 0.01 to 1000 is needed".into()),
    }
}
