//! Base64 (RFC 4648).

/// Decodes until `limit` bytes or the end of the text; white space and padding are skipped, so that
/// parts that were padded by themselves may follow one another. None if anything else is met.
pub(super) fn decode(text: &[u8], limit: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::with_capacity(limit.min(text.len()));
    let (mut bits, mut held) = (0u32, 0);
    for &letter in text {
        if bytes.len() >= limit {
            break;
        }
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' => {
                held = 0;
                continue;
            }
            _ if letter.is_ascii_whitespace() => continue,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn known_texts_decode() {
        assert_eq!(
            decode(b"bmV1cm90ZXNz", 99).as_deref(),
            Some(&b"neurotess"[..])
        );
        assert_eq!(
            decode(b" bmV1 cm8=\nAA==", 99).as_deref(),
            Some(&b"neuro\0"[..])
        );
        assert_eq!(decode(b"bmV1cm8=", 2).as_deref(), Some(&b"ne"[..]));
        assert_eq!(decode(b"b*", 9), None);
    }
}
