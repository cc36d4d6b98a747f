//! MurmurHash3 (Austin Appleby), the 128-bit variant for x86, of which precomputed data takes the low 64 bits.

/// The low 64 bits of MurmurHash3_x86_128 of some bytes, with seed 0.
pub(crate) fn murmur(bytes: &[u8]) -> u64 {
    const C: [u32; 4] = [0x239b_961b, 0xab0e_9789, 0x38b3_4ae5, 0xa1e3_8b93];
    /// Of each of the four lanes: rotation of a word, rotation of the lane, what is added to it.
    const LANES: [(u32, u32, u32); 4] = [
        (15, 19, 0x561c_cd1b),
        (16, 17, 0x0bca_a747),
        (17, 15, 0x96cd_1c35),
        (18, 13, 0x32ac_3b17),
    ];
    let mixed = |lane: usize, word: u32| {
        let word = word.wrapping_mul(C[lane]).rotate_left(LANES[lane].0);
        word.wrapping_mul(C[(lane + 1) % 4])
    };
    let mut h = [0_u32; 4];
    let (blocks, tail) = bytes.as_chunks::<16>();
    for block in blocks {
        for (lane, word) in block.as_chunks::<4>().0.iter().enumerate() {
            let (_, rotation, added) = LANES[lane];
            h[lane] ^= mixed(lane, u32::from_le_bytes(*word));
            h[lane] = h[lane].rotate_left(rotation);
            h[lane] = h[lane].wrapping_add(h[(lane + 1) % 4]);
            h[lane] = h[lane].wrapping_mul(5).wrapping_add(added);
        }
    }
    for (lane, word) in tail.chunks(4).enumerate() {
        let mut padded = [0; 4];
        padded[..word.len()].copy_from_slice(word);
        h[lane] ^= mixed(lane, u32::from_le_bytes(padded));
    }
    // The function has 32 bits for it.
    let length = bytes.len() as u32;
    h = h.map(|lane| lane ^ length);
    let spread = |h: [u32; 4]| {
        let first = h.iter().fold(0_u32, |sum, lane| sum.wrapping_add(*lane));
        [
            first,
            h[1].wrapping_add(first),
            h[2].wrapping_add(first),
            h[3].wrapping_add(first),
        ]
    };
    let h = spread(spread(h).map(finished));
    u64::from(h[0]) | u64::from(h[1]) << 32
}

/// The last mixing of a lane.
fn finished(mut h: u32) -> u32 {
    h ^= h >> 16;
    h = h.wrapping_mul(0x85eb_ca6b);
    h ^= h >> 13;
    h = h.wrapping_mul(0xc2b2_ae35);
    h ^ h >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against values of the package `mmh3` 5 of PyPI: `mmh3.hash64(bytes, x64arch=False, signed=False)[0]`.
    #[test]
    fn hashes_are_the_published_ones() {
        let of_ids = [
            (0_u64, 0x4772_b084_e028_ae41),
            (1, 0xe8bd_67d6_16d4_ce9a),
            (2, 0xd62f_9cd2_1b01_3f5a),
            (1000, 0xfc1b_462d_eff0_cd6f),
            (720_575_940_623_456_789, 0x9d40_5df8_4565_aa49),
            (u64::MAX, 0x574f_66bd_212b_5d1a),
        ];
        for (id, expected) in of_ids {
            assert_eq!(murmur(&id.to_le_bytes()), expected, "{id}");
        }
        let of_texts: [(&[u8], u64); 4] = [
            (b"", 0),
            (b"a", 0x5556_b01b_a794_933c),
            (b"0123456789abcdef", 0x36ae_d30a_fb7d_4409),
            (b"neurotess writes precomputed data", 0x73eb_ff01_1400_3784),
        ];
        for (text, expected) in of_texts {
            assert_eq!(murmur(text), expected, "{text:?}");
        }
    }
}
