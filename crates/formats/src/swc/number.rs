//! Numbers and what stands between them.

use crate::Fault;

/// What a byte is in a row.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    Letter,
    Blank,
    Comma,
    Semicolon,
    Hash,
}

/// Class of each byte.
const CLASSES: [Class; 256] = {
    let mut classes = [Class::Letter; 256];
    classes[b' ' as usize] = Class::Blank;
    classes[b'\t' as usize] = Class::Blank;
    classes[0x0b] = Class::Blank;
    classes[0x0c] = Class::Blank;
    classes[b',' as usize] = Class::Comma;
    classes[b';' as usize] = Class::Semicolon;
    classes[b'#' as usize] = Class::Hash;
    classes
};

pub(super) fn class(byte: u8) -> Class {
    CLASSES[byte as usize]
}

/// The text up to the next separator.
pub(super) fn token(text: &[u8]) -> &[u8] {
    let end = text
        .iter()
        .position(|&b| class(b) != Class::Letter)
        .unwrap_or(text.len());
    &text[..end]
}

/// Whether a number may end before `rest`.
fn ends(rest: &[u8]) -> bool {
    rest.first().is_none_or(|&b| class(b) != Class::Letter)
}

/// A number at the start of the text and how long it is.
pub(super) fn float(text: &[u8], column: &'static str, limit: f64) -> Result<(f64, usize), Fault> {
    let (number, length) = lenient(text).ok_or_else(|| not_a_number(text, column))?;
    if number.abs() <= limit {
        Ok((number, length))
    } else {
        Err(Fault::OutOfRange {
            column,
            text: shown(text),
        })
    }
}

/// A whole number at the start of the text, how long it is, and whether it was written `1.0`.
pub(super) fn whole(text: &[u8], column: &'static str) -> Result<(i64, usize, bool), Fault> {
    let negative = text.first() == Some(&b'-');
    let signed = usize::from(negative || text.first() == Some(&b'+'));
    let digits = text[signed..]
        .iter()
        .take(19)
        .take_while(|b| b.is_ascii_digit())
        .count();
    let length = signed + digits;
    if (1..=18).contains(&digits) && ends(&text[length..]) {
        let digit = |value: i64, &b: &u8| value * 10 + i64::from(b - b'0');
        let value = text[signed..length].iter().fold(0, digit);
        return Ok((if negative { -value } else { value }, length, false));
    }
    let (number, length) = lenient(text).ok_or_else(|| not_a_number(text, column))?;
    // Beyond 2^53 floating-point numbers cannot tell neighbours apart.
    if number.fract() == 0.0 && number.abs() < 9_007_199_254_740_992.0 {
        Ok((number as i64, length, true))
    } else {
        Err(Fault::NotWhole {
            column,
            text: shown(text),
        })
    }
}

/// Any number, a sign `+` included, that ends at a separator.
fn lenient(text: &[u8]) -> Option<(f64, usize)> {
    let plus = usize::from(text.first() == Some(&b'+'));
    let unsigned = &text[plus..];
    if plus == 1 && matches!(unsigned.first(), Some(b'+' | b'-')) {
        return None;
    }
    let (number, length) = fast_float2::parse_partial::<f64, _>(unsigned).ok()?;
    (length > 0 && ends(&unsigned[length..])).then_some((number, plus + length))
}

fn not_a_number(text: &[u8], column: &'static str) -> Fault {
    Fault::NotANumber {
        column,
        text: shown(text),
    }
}

/// The field as messages quote it: its first letters.
fn shown(text: &[u8]) -> String {
    String::from_utf8_lossy(token(text))
        .chars()
        .take(40)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<f64> {
        float(text.as_bytes(), "x", 1e37)
            .ok()
            .map(|(number, _)| number)
    }

    #[test]
    fn numbers_may_be_written_in_all_ways_of_c() {
        for (text, number) in [
            ("+1", 1.0),
            (".5", 0.5),
            ("-.5 ", -0.5),
            ("1.", 1.0),
            ("1e3,", 1000.0),
            ("1E-3;", 0.001),
            ("+.25#", 0.25),
            ("007", 7.0),
        ] {
            assert_eq!(read(text), Some(number), "{text}");
        }
    }

    #[test]
    fn what_is_no_finite_number_is_refused() {
        for text in [
            "", "-", "+", "+-1", "1x", "0x10", "1.2.3", "nan", "inf", "-inf", "1e308",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
    }

    #[test]
    fn whole_numbers_may_have_an_empty_fraction_only() {
        let read = |text: &str| whole(text.as_bytes(), "number").ok();
        assert_eq!(read("12 "), Some((12, 2, false)));
        assert_eq!(read("-1"), Some((-1, 2, false)));
        assert_eq!(read("+3.000000"), Some((3, 9, true)));
        assert_eq!(read("2e1"), Some((20, 3, true)));
        assert_eq!(read("1.5"), None);
        assert_eq!(read("9999999999999999999999"), None);
    }
}
