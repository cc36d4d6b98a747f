//! From linear light to the bytes of a picture. Twin of srgb.wgsl.

use std::sync::LazyLock;

/// The least linear light of each byte, and by a thousandth of light the greatest byte that it may have begun with.
struct Table {
    least: [f32; 256],
    guess: [u8; GUESSES + 1],
}

/// Steps of linear light.
const GUESSES: usize = 1024;

static TABLE: LazyLock<Table> = LazyLock::new(|| {
    // IEC 61966-2-1, solved for where a byte begins: half a step below it.
    let begins = |byte: usize| {
        let c = (byte as f64 - 0.5) / 255.0;
        let linear = match c <= 0.040_45 {
            true => c / 12.92,
            false => libm::pow((c + 0.055) / 1.055, 2.4),
        };
        linear as f32
    };
    let least: [f32; 256] = std::array::from_fn(|byte| match byte {
        0 => 0.0,
        _ => begins(byte),
    });
    let guess = std::array::from_fn(|step| {
        let light = step as f32 / GUESSES as f32;
        (least.partition_point(|&least| least <= light) - 1) as u8
    });
    Table { least, guess }
});

/// The byte of this linear light.
pub(crate) fn encoded(light: f32) -> u8 {
    let light = light.clamp(0.0, 1.0);
    let table = &*TABLE;
    let mut byte = usize::from(table.guess[(light * GUESSES as f32) as usize]);
    while byte < 255 && table.least[byte + 1] <= light {
        byte += 1;
    }
    byte as u8
}

/// The byte of a share, 0 to 1.
pub(crate) fn share(share: f32) -> u8 {
    (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// A pixel of premultiplied linear light over a background, or with straight alpha if there is none.
pub(crate) fn pixel([r, g, b, a]: [f32; 4], background: Option<[f32; 3]>) -> [u8; 4] {
    match background {
        Some(behind) => {
            let over = |light: f32, k: usize| encoded(light + behind[k] * (1.0 - a));
            [over(r, 0), over(g, 1), over(b, 2), 255]
        }
        None => [encoded(r / a), encoded(g / a), encoded(b / a), share(a)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_those_of_the_formula() {
        for i in 0..=20_000 {
            let light = i as f32 / 20_000.0;
            let c = f64::from(light);
            let exact = match c <= 0.003_130_8 {
                true => c * 12.92,
                false => 1.055 * c.powf(1.0 / 2.4) - 0.055,
            };
            let byte = f64::from(encoded(light));
            assert!((byte - exact * 255.0).abs() < 0.501, "{light}: {byte}");
        }
        for byte in 0..=255 {
            let [light, ..] = neurotess_picture::color::linear([byte; 3]);
            assert_eq!(encoded(light), byte);
        }
    }
}
