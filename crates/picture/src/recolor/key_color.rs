//! Colors of color keys: twin of `color_of` and `lack_of_contrast` in shade.wgsl.

use crate::color::{ColorTable, linear, luminance};
use crate::look::{HIGHLIGHTED, Light, Look};

use super::matrix::VisibleKey;

/// What colors depend on besides the table.
pub struct Contrast {
    /// Luminance of the background against which colors of the scale stand out by edges.
    background: Option<f32>,
    highlighted: [f32; 4],
}

impl Contrast {
    /// Of this look.
    pub fn new(look: &Look) -> Self {
        let [r, g, b] = linear(look.highlighted.0);
        Self {
            // Plain colors have no edges.
            background: look
                .contrast
                .filter(|_| look.light != Light::Flat)
                .map(luminance),
            highlighted: [r, g, b, look.highlighted.1],
        }
    }

    /// Linear color of a key, and how much of an edge it has. `linear`: the table's colors; `value`:
    /// instead of that in the table.
    pub fn key_color(
        &self,
        table: &ColorTable,
        linear: &[[f32; 4]],
        key: &VisibleKey,
        value: Option<f32>,
    ) -> [f32; 4] {
        let (color, of_scale) = table.color(linear, key.color_key, key.instance, value);
        let [r, g, b] = color;
        match of_scale {
            true => [r, g, b, self.lack_of_contrast(color)],
            false => [r, g, b, 0.0],
        }
    }

    /// The color in this state.
    pub fn in_state(&self, [r, g, b, edge]: [f32; 4], state: u32) -> [f32; 4] {
        if state & HIGHLIGHTED == 0 {
            return [r, g, b, edge];
        }
        let [x, y, z, share] = self.highlighted;
        let mixed = |from: f32, to: f32| from + (to - from) * share;
        [mixed(r, x), mixed(g, y), mixed(b, z), edge]
    }

    fn lack_of_contrast(&self, [r, g, b]: [f32; 3]) -> f32 {
        let Some(background) = self.background else {
            return 0.0;
        };
        let own = 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
        let other = background + 0.05;
        let contrast = own.max(other) / own.min(other);
        let t = ((contrast - 1.25) / (1.8 - 1.25)).clamp(0.0, 1.0);
        1.0 - t * t * (3.0 - 2.0 * t)
    }
}
