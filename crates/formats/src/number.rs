//! Numbers as all writers of text write them.

use neurotess_morphology::Morphology;

/// Most decimals tried before all that a number has are written.
const MAX_DECIMALS: usize = 12;

/// Appends the shortest decimal that reads back as `value` relative to `origin`.
pub(crate) fn decimal(text: &mut String, value: f32, origin: f64) {
    use std::fmt::Write as _;
    let start = text.len();
    let exact = origin + f64::from(value);
    // The second condition keeps the choice of the origin, which is made by such comparisons.
    let far = |x: f64| (x as f32).abs() > Morphology::FARTHEST_UNSHIFTED;
    let same = |text: &str| {
        let read: f64 = fast_float2::parse(text).unwrap_or(f64::NAN);
        (read - origin) as f32 == value && far(read) == far(exact)
    };
    if origin == 0.0 {
        let _ = write!(text, "{value}");
        if same(&text[start..]) {
            return;
        }
        text.truncate(start);
    } else {
        for decimals in 0..=MAX_DECIMALS {
            let _ = write!(text, "{exact:.decimals$}");
            if same(&text[start..]) {
                return;
            }
            text.truncate(start);
        }
    }
    let _ = write!(text, "{exact}");
}
