//! What a sample holds until it is lit.

use glam::Vec3;

/// A surface at a sample: normal in 26 bits, color in 24, how much of an edge its color has in seven, how thin its tube is in
/// six, and whether it is translucent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Surface(u64);

/// Bits of each of a normal's two octahedral coordinates (Meyer et al., On floating-point normal vectors, 2010): accurate
/// to 0.03°.
const PLACE: u32 = 13;
/// Largest of such a coordinate.
const MOST: f32 = ((1 << (PLACE - 1)) - 1) as f32;
/// First bits of what follows the normal.
const COLOR: u32 = 2 * PLACE;
const EDGE: u32 = COLOR + 24;
const THIN: u32 = EDGE + 7;
const TRANSLUCENT: u64 = 1 << 63;
/// Steps of edges and of thinness.
const EDGES: f32 = 127.0;
const THINS: f32 = 63.0;

impl Surface {
    /// `normal`: in the view, of any length; `color`: linear, and how much of an edge it has.
    pub(crate) fn new(normal: Vec3, [red, green, blue, edge]: [f32; 4], thin: f32) -> Self {
        let sum = normal.x.abs() + normal.y.abs() + normal.z.abs();
        let inverse = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        let (mut x, mut y) = (normal.x * inverse, normal.y * inverse);
        if normal.z < 0.0 {
            let sign = |v: f32| if v >= 0.0 { 1.0 } else { -1.0 };
            (x, y) = ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y));
        }
        let place = |v: f32| ((v + 1.0) * MOST + 0.5) as u64;
        // Square roots: steps that an eye sees as nearly even.
        let byte = |v: f32| (v.max(0.0).sqrt() * 255.0 + 0.5) as u64 & 255;
        let step = |v: f32, steps: f32| (v.clamp(0.0, 1.0) * steps + 0.5) as u64;
        let color = byte(red) | byte(green) << 8 | byte(blue) << 16;
        Self(
            place(x)
                | place(y) << PLACE
                | color << COLOR
                | step(edge, EDGES) << EDGE
                | step(thin, THINS) << THIN,
        )
    }

    /// The same as something that lets through what is behind.
    pub(crate) fn translucent(self) -> Self {
        Self(self.0 | TRANSLUCENT)
    }

    pub(crate) fn is_translucent(self) -> bool {
        self.0 & TRANSLUCENT != 0
    }

    fn bits(self, first: u32, count: u32) -> f32 {
        (self.0 >> first & ((1 << count) - 1)) as f32
    }

    /// Unit normal in the view.
    pub(crate) fn normal(self) -> Vec3 {
        let place = |first: u32| self.bits(first, PLACE) / MOST - 1.0;
        let (x, y) = (place(0), place(PLACE));
        let z = 1.0 - x.abs() - y.abs();
        let fold = (-z).max(0.0);
        let folded = |v: f32| if v >= 0.0 { v - fold } else { v + fold };
        Vec3::new(folded(x), folded(y), z).normalize_or(Vec3::Z)
    }

    /// Linear color.
    pub(crate) fn color(self) -> [f32; 3] {
        [0, 8, 16].map(|shift| {
            let root = self.bits(COLOR + shift, 8) / 255.0;
            root * root
        })
    }

    /// How much of an edge its color has: 1 where it is about as light as the background.
    pub(crate) fn edge(self) -> f32 {
        self.bits(EDGE, 7) / EDGES
    }

    /// From 0 for tubes at least two pixels wide to 1 for width 0.
    pub(crate) fn thin(self) -> f32 {
        self.bits(THIN, 6) / THINS
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
            let [r, g, b] = color;
            let held = Surface::new(normal * 20_000.0, [r, g, b, t / 500.0], t / 500.0);
            // Half a step of both coordinates, 1.2e-4 each, up to three times as far on the sphere.
            assert!(held.normal().distance(normal) < 6e-4, "{normal}");
            for (a, b) in held.color().into_iter().zip(color) {
                assert!((a.sqrt() - b.sqrt()).abs() < 0.5 / 254.0, "{a} {b}");
            }
            assert!((held.thin() - t / 500.0).abs() < 0.01);
            assert!((held.edge() - t / 500.0).abs() < 0.005);
            assert!(!held.is_translucent() && held.translucent().is_translucent());
        }
    }
}
