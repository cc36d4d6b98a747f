//! Pictures compared as an eye does. Drivers place samples and round differently: blurred over 3 × 3
//! pixels, pictures of two of them are at most 1 of 255 apart in the mean, and at most one pixel in 200 is
//! more than 16 apart.

use neurotess_render::Image;

/// Greatest mean difference of blurred channels, of 255.
pub(crate) const MEAN: f64 = 1.0;
/// Difference of a blurred channel that counts, of 255.
const MUCH: f64 = 16.0;
/// Greatest share of pixels that differ by so much.
const SHARE: f64 = 0.005;

/// What is between two pictures of one size.
pub(crate) struct Difference {
    /// Mean difference of blurred channels, of 255.
    pub(crate) mean: f64,
    /// Share of pixels that are far apart.
    pub(crate) share: f64,
    /// Differences of blurred channels, four a pixel.
    pub(crate) steps: Vec<f64>,
    /// Whether all bytes are the same.
    is_equal: bool,
}

impl Difference {
    pub(crate) fn between(a: &Image, b: &Image) -> Self {
        assert_eq!((a.width, a.height), (b.width, b.height));
        let is_equal = a == b;
        let [a, b] = [a, b].map(blurred);
        let steps: Vec<f64> = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).collect();
        let far = |pixel: &&[f64]| pixel.iter().any(|&step| step > MUCH);
        Self {
            mean: steps.iter().sum::<f64>() / steps.len() as f64,
            share: 4.0 * steps.chunks(4).filter(far).count() as f64 / steps.len() as f64,
            steps,
            is_equal,
        }
    }

    /// Whether an eye sees it.
    pub(crate) fn is_seen(&self) -> bool {
        self.exceeds(1.0)
    }

    /// Whether it is larger than this share of what an eye sees.
    pub(crate) fn exceeds(&self, share: f64) -> bool {
        self.mean > share * MEAN || self.share > share * SHARE
    }

    /// Whether there is any, to the byte.
    pub(crate) fn is_any(&self) -> bool {
        !self.is_equal
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { mean, share, .. } = self;
        let percent = 100.0 * share;
        write!(
            f,
            "{mean:.2} apart in the mean, {percent:.2} % of pixels far apart"
        )
    }
}

/// Means over 3 × 3 pixels, colors premultiplied.
fn blurred(image: &Image) -> Vec<f64> {
    let (width, height) = (i64::from(image.width), i64::from(image.height));
    let mut out = Vec::with_capacity(image.pixels.len());
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0.0; 4];
            for (dx, dy) in (0..9).map(|i| (i % 3 - 1, i / 3 - 1)) {
                let (x, y) = ((x + dx).clamp(0, width - 1), (y + dy).clamp(0, height - 1));
                let p = image.at(x as u32, y as u32).map(f64::from);
                for k in 0..4 {
                    sum[k] += if k < 3 { p[k] * p[3] / 255.0 } else { p[k] } / 9.0;
                }
            }
            out.extend(sum);
        }
    }
    out
}
