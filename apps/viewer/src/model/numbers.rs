//! Numbers as people read them.

/// A whole number with thin gaps between thousands.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            // A space that breaks no line.
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

/// A number with six significant digits.
pub(crate) fn significant(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// A change in percent with its sign; none that rounds to none has one.
pub(crate) fn change(percent: f64) -> String {
    let rounded = (10.0 * percent).round() / 10.0;
    match rounded == 0.0 {
        true => "0.0 %".to_owned(),
        false => format!("{rounded:+.1} %"),
    }
}

/// A length, area or volume, rounded to significant digits.
pub(crate) fn measured(value: f64, unit: &str) -> String {
    let a = value.abs();
    if a >= 10_000.0 {
        format!("{} {unit}", grouped(value.round().max(0.0) as u64))
    } else if a >= 100.0 {
        format!("{value:.0} {unit}")
    } else if a >= 10.0 {
        format!("{value:.1} {unit}")
    } else {
        format!("{value:.2} {unit}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped_and_rounded() {
        assert_eq!(grouped(1_234_567), "1\u{a0}234\u{a0}567");
        assert_eq!(grouped(12), "12");
        assert_eq!(measured(3.15159, "µm"), "3.15 µm");
        assert_eq!(
            [-0.04, 0.04, -0.06, 3.0].map(change),
            ["0.0 %", "0.0 %", "-0.1 %", "+3.0 %"]
        );
        assert_eq!(measured(31.5159, "µm"), "31.5 µm");
        assert_eq!(measured(12345.6, "µm²"), "12\u{a0}346 µm²");
    }
}
