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
    // A no-break space, alone in Latin-1, in UTF-8 after its lead byte, which numbers never have.
    classes[0xa0] = Class::Blank;
    classes[0xc2] = Class::Blank;
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
    let (number, length) = any_float(text, column)?;
    if number.abs() <= limit {
        Ok((number, length))
    } else {
        Err(Fault::OutOfRange {
            column,
            text: shown(text),
        })
    }
}

/// A number at the start of the text, finite or not, and how long it is.
#[inline]
pub(super) fn any_float(text: &[u8], column: &'static str) -> Result<(f64, usize), Fault> {
    let quick = if long(text) { None } else { plain(text) };
    let read = quick.or_else(|| lenient(text));
    read.ok_or_else(|| not_a_number(text, column))
}

/// A whole number at the start of the text, how long it is, and whether it was written `1.0`.
pub(super) fn whole(text: &[u8], column: &'static str) -> Result<(i64, usize, bool), Fault> {
    let negative = text.first() == Some(&b'-');
    let signed = usize::from(negative || text.first() == Some(&b'+'));
    let (mut value, mut length) = (0_i64, signed);
    while let Some(digit) = text.get(length).map(|b| b.wrapping_sub(b'0')) {
        if digit > 9 {
            break;
        }
        value = value.wrapping_mul(10).wrapping_add(i64::from(digit));
        length += 1;
    }
    if (1..=18).contains(&(length - signed)) && ends(&text[length..]) {
        return Ok((if negative { -value } else { value }, length, false));
    }
    let (number, length) = lenient(text).ok_or_else(|| not_a_number(text, column))?;
    // Beyond 2^53 floating-point numbers cannot tell neighbors apart.
    if number.fract() == 0.0 && number.abs() < 9_007_199_254_740_992.0 {
        Ok((number as i64, length, true))
    } else {
        Err(Fault::NotWhole {
            column,
            text: shown(text),
        })
    }
}

/// Whether a number at the start of the text has more than eight letters: such ones are read faster
/// eight digits at a time. None of the first bytes is below the signs that numbers are made of.
fn long(text: &[u8]) -> bool {
    const ONES: u64 = u64::from_le_bytes([1; 8]);
    let Some(bytes) = text.get(1..).and_then(|t| t.first_chunk()) else {
        return false;
    };
    let bytes = u64::from_le_bytes(*bytes);
    bytes.wrapping_sub(ONES * u64::from(b'-')) & !bytes & (ONES << 7) == 0
}

/// Powers of ten that are exact in `f64`, as far as [`plain`] needs them.
const TENS: [f64; 16] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// A number of at most 15 digits without an exponent, as nearly all are, that ends at a separator.
///
/// Digits and power of ten are exact, so their quotient is the nearest number (Clinger 1990).
fn plain(text: &[u8]) -> Option<(f64, usize)> {
    let negative = text.first() == Some(&b'-');
    let mut at = usize::from(negative);
    let (mut digits, mut decimals, mut dot) = (0_u64, 0, 0);
    let start = at;
    while let Some(&byte) = text.get(at) {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            digits = digits.wrapping_mul(10).wrapping_add(u64::from(digit));
            decimals += dot;
        } else if byte == b'.' && dot == 0 {
            dot = 1;
        } else if class(byte) == Class::Letter {
            return None;
        } else {
            break;
        }
        at += 1;
    }
    let count = at - start - dot;
    if count == 0 || count > 15 {
        return None;
    }
    let number = digits as f64 / TENS[decimals];
    Some((if negative { -number } else { number }, at))
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
    fn plain_numbers_are_the_nearest() {
        let mut random = 1_u64;
        for _ in 0..200_000 {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let digits = random >> (14 + random % 40);
            let decimals = (random >> 7) as usize % 15;
            let text = format!("{}", digits as f64 / TENS[decimals]);
            if let Some((number, length)) = plain(text.as_bytes()) {
                assert_eq!(length, text.len());
                assert_eq!(Ok(number), text.parse(), "{text}");
            }
        }
        for text in [
            "-0.5",
            "1.",
            ".25 ",
            "-7",
            "123456789012345",
            "0.00000000000001",
        ] {
            let number = plain(text.as_bytes()).map(|(number, _)| number);
            assert_eq!(number, text.trim().parse().ok(), "{text}");
        }
        for text in [
            "",
            "-",
            ".",
            "1e3",
            "+1",
            "1234567890123456",
            "1.2.3",
            "0x1",
        ] {
            assert_eq!(plain(text.as_bytes()), None, "{text}");
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
