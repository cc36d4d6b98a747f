//! Bytes in a page's text: five signs for four bytes. Base64 takes a sixteenth more, and plain bytes do not survive
//! what mail and editors do to text. The signs mean nothing in HTML.

/// Four bytes have fewer values than five of these signs.
const SIGNS: &[u8; 85] =
    b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%()*+,-./:;=?@[]^_|~";

/// The text of bytes, of which there are a multiple of four in the end: zeros follow.
pub(crate) fn base85(bytes: &[u8]) -> String {
    let mut out = String::with_capacity(bytes.len().div_ceil(4) * 5);
    for four in bytes.chunks(4) {
        let byte = |k: usize| u32::from(four.get(k).copied().unwrap_or(0));
        let mut number = (byte(0) << 24) | (byte(1) << 16) | (byte(2) << 8) | byte(3);
        let mut signs = ['0'; 5];
        for sign in signs.iter_mut().rev() {
            *sign = char::from(SIGNS[(number % 85) as usize]);
            number /= 85;
        }
        out.extend(signs);
    }
    out
}

/// The signs in their order, for the page that reads them.
#[cfg(feature = "host")]
pub(crate) fn signs() -> &'static str {
    str::from_utf8(SIGNS).expect("they are ASCII")
}

#[cfg(all(test, feature = "host"))]
mod tests {
    use super::*;

    #[test]
    fn four_bytes_are_five_signs_that_html_leaves_alone() {
        assert_eq!(base85(&[0, 0, 0, 0, 0, 0, 0, 85]), "0000000010");
        assert_eq!(base85(&[255; 4]).len(), 5);
        let mut signs: Vec<char> = signs().chars().collect();
        assert!(!signs.iter().any(|sign| "<>&{}\"'\\`".contains(*sign)));
        signs.sort_unstable();
        signs.dedup();
        assert_eq!(signs.len(), 85);
    }
}
