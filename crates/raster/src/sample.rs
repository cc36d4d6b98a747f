//! What a sample holds until it is lit.

use glam::Vec3;

use crate::fragment::Fragment;

/// What is kept of a fragment for each sample that it covers.
pub(crate) trait Held: Copy + Default + Send + Sync {
    /// Of a fragment.
    fn of(fragment: &Fragment<'_>) -> Self;
    /// Its surface, without keys.
    fn surface(&self) -> Surface;
}

/// A surface at a sample: normal in 32 bits, color in 24, how thin its tube is in six, and two flags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Surface(u64);

/// Whether the color is one of the scale.
const OF_SCALE: u64 = 1 << 62;
/// Whether it is translucent.
const TRANSLUCENT: u64 = 1 << 63;
/// Steps of how thin a tube is.
const THIN: f32 = 63.0;

impl Surface {
    /// `normal`: in the view, of any length; `color`: linear.
    pub(crate) fn new(normal: Vec3, color: [f32; 3], thin: f32, of_scale: bool) -> Self {
        let sum = normal.x.abs() + normal.y.abs() + normal.z.abs();
        let inverse = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        let (mut x, mut y) = (normal.x * inverse, normal.y * inverse);
        if normal.z < 0.0 {
            let sign = |v: f32| if v >= 0.0 { 1.0 } else { -1.0 };
            (x, y) = ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y));
        }
        let place = |v: f32| u64::from(((v * 32767.0) as i16) as u16);
        // Square roots: steps that an eye sees as nearly even.
        let byte = |v: f32| (v.max(0.0).sqrt() * 255.0 + 0.5) as u64 & 255;
        let [red, green, blue] = color.map(byte);
        let thin = (thin.clamp(0.0, 1.0) * THIN + 0.5) as u64;
        let scale = if of_scale { OF_SCALE } else { 0 };
        Self(place(x) | place(y) << 16 | red << 32 | green << 40 | blue << 48 | thin << 56 | scale)
    }

    /// The same as something that lets through what is behind.
    pub(crate) fn translucent(self) -> Self {
        Self(self.0 | TRANSLUCENT)
    }

    pub(crate) fn is_translucent(self) -> bool {
        self.0 & TRANSLUCENT != 0
    }

    pub(crate) fn is_of_scale(self) -> bool {
        self.0 & OF_SCALE != 0
    }

    /// Unit normal in the view.
    pub(crate) fn normal(self) -> Vec3 {
        let place = |bits: u64| f32::from((bits & 0xffff) as u16 as i16) / 32767.0;
        let (x, y) = (place(self.0), place(self.0 >> 16));
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        let folded = |v: f32| if v >= 0.0 { v - fold } else { v + fold };
        Vec3::new(folded(x), folded(y), z).normalize_or(Vec3::Z)
    }

    /// Linear color.
    pub(crate) fn color(self) -> [f32; 3] {
        [32, 40, 48].map(|shift| {
            let root = (self.0 >> shift & 255) as f32 / 255.0;
            root * root
        })
    }

    /// From 0 for tubes at least two pixels wide to 1 for width 0.
    pub(crate) fn thin(self) -> f32 {
        (self.0 >> 56 & 63) as f32 / THIN
    }
}

impl Held for Surface {
    fn of(fragment: &Fragment<'_>) -> Self {
        fragment.surface()
    }

    fn surface(&self) -> Surface {
        *self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_keeps_its_normal_and_color() {
        for i in 0..500 {
            let t = i as f32;
            let normal =
                Vec3::new((t * 1.3).sin(), (t * 0.7).cos(), (t * 0.31).sin()).normalize_or(Vec3::Y);
            let color = [0.2, (t / 500.0).min(1.0), 1.0];
            let held = Surface::new(normal * 20_000.0, color, t / 500.0, i % 2 == 0);
            assert!(held.normal().distance(normal) < 2e-4, "{normal}");
            for (a, b) in held.color().into_iter().zip(color) {
                assert!((a.sqrt() - b.sqrt()).abs() < 0.5 / 254.0, "{a} {b}");
            }
            assert!((held.thin() - t / 500.0).abs() < 0.01);
            assert_eq!(held.is_of_scale(), i % 2 == 0);
            assert!(!held.is_translucent() && held.translucent().is_translucent());
        }
    }
}
