//! Fragments: what of a triangle is at a sub-pixel, and which of its samples it covers. Twin of `facet`, `mask_of` and the
//! colors in shade.wgsl.

use std::borrow::Cow;

use glam::Vec3;

use crate::bins::Vertex;
use crate::sample::Surface;
use crate::sheet::Sheet;

/// What the triangles of a surface have in common.
pub(crate) struct Paint<'a> {
    /// Linear colors of what vertices have their colors of, and how much of an edge each has.
    pub(crate) colors: Cow<'a, [[f32; 4]]>,
    /// Their color keys, and the instance.
    pub(crate) keys: Cow<'a, [u32]>,
    pub(crate) instance: u32,
    /// Of a mesh that is no cell.
    pub(crate) sheet: Option<Sheet>,
    /// The normal in the view that back faces have, where the surface is cut.
    pub(crate) filled: Option<Vec3>,
    /// Half the width (sub-pixels) of the wireframe's lines; 0: no wireframe.
    pub(crate) wire: f32,
}

impl Paint<'_> {
    /// Whether back faces show.
    pub(crate) fn is_two_sided(&self) -> bool {
        self.filled.is_some() || self.sheet.is_some()
    }
}

/// What of a triangle is at a sub-pixel.
pub(crate) struct Fragment<'a> {
    pub(crate) paint: &'a Paint<'a>,
    pub(crate) corners: [&'a Vertex; 3],
    /// Shares of the corners at the middle of the sub-pixel, which may lie outside the triangle.
    pub(crate) shares: [f32; 3],
    pub(crate) is_front: bool,
    /// How strongly lines of the wireframe cover it.
    pub(crate) line: f32,
}

impl Fragment<'_> {
    /// Mean of a number of the corners.
    pub(crate) fn mean(&self, of: impl Fn(&Vertex) -> f32) -> f32 {
        let [a, b, c] = self.shares;
        a * of(self.corners[0]) + b * of(self.corners[1]) + c * of(self.corners[2])
    }

    /// Coverage, after the cut.
    pub(crate) fn coverage(&self) -> f32 {
        match self.mean(|v| v.kept) < 0.0 {
            true => 0.0,
            false => self.mean(|v| v.coverage),
        }
    }

    /// Shares that do not leave the triangle: where a sub-pixel is covered in part, colors are those of the part.
    pub(crate) fn inner_shares(&self) -> [f32; 3] {
        let inside = self.shares.map(|share| share.clamp(0.0, 1.0));
        let scale = 1.0 / (inside[0] + inside[1] + inside[2]);
        inside.map(|share| share * scale)
    }

    fn color(&self) -> [f32; 4] {
        let points = self.corners.map(|corner| corner.point);
        let [a, b, c] = points.map(|point| self.paint.colors[point as usize]);
        if points[0] == points[1] && points[1] == points[2] {
            return a;
        }
        let [p, q, r] = self.inner_shares();
        [0, 1, 2, 3].map(|k| p * a[k] + q * b[k] + r * c[k])
    }

    /// Thinness, 0 to 1.
    fn thin(&self) -> f32 {
        self.mean(|v| f32::from(v.thin)).clamp(0.0, 255.0) / 255.0
    }

    /// The normal in the view, of any length.
    fn normal(&self) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|k| self.mean(|v| f32::from(v.normal[k])));
        let normal = Vec3::new(x, y, z);
        match (self.is_front, self.paint.sheet.is_some()) {
            (true, _) => normal,
            // A surface that may be open is lit alike from both sides.
            (false, true) => -normal,
            // Back faces show only where the surface is cut: with the plane's normal it looks as if it were filled.
            (false, false) => self.paint.filled.unwrap_or(normal),
        }
    }

    pub(crate) fn surface(&self) -> Surface {
        let [r, g, b, edge] = self.color();
        let thin = self.thin();
        let [r, g, b] = lined([r, g, b], self.line * (1.0 - thin));
        let surface = Surface::new(self.normal(), [r, g, b, edge], thin);
        match &self.paint.sheet {
            Some(sheet) if sheet.is_translucent() => surface.translucent(),
            _ => surface,
        }
    }
}

/// What is kept of a fragment for each sample that it covers.
pub(crate) trait Held: Copy + Default + Send + Sync {
    /// Of a fragment.
    fn of(fragment: &Fragment<'_>) -> Self;
    /// Its surface, without keys.
    fn surface(&self) -> Surface;
}

impl Held for Surface {
    fn of(fragment: &Fragment<'_>) -> Self {
        fragment.surface()
    }

    fn surface(&self) -> Surface {
        *self
    }
}

/// A color under a line of the wireframe.
fn lined(color: [f32; 3], share: f32) -> [f32; 3] {
    if share <= 0.0 {
        return color;
    }
    let line = match luminance(color) > 0.06 {
        true => color.map(|c| c * 0.06),
        false => [0.22; 3],
    };
    [0, 1, 2].map(|k| color[k] + (line[k] - color[k]) * share)
}

fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Coverage by lines along the sides of a triangle, of this half width (sub-pixels). `shares`: those of the corners;
/// `widths`: by how much they change in a sub-pixel. `is_half`: the side across from the first corner is no edge.
pub(crate) fn lines(shares: [f32; 3], widths: [f32; 3], is_half: bool, half_width: f32) -> f32 {
    let mut nearest = f32::MAX;
    let mut widest: f32 = 0.0;
    for k in usize::from(is_half)..3 {
        let width = widths[k].max(1e-6);
        let distance = shares[k].abs().min((1.0 - shares[k]).abs());
        nearest = nearest.min(distance / width);
        widest = widest.max(width);
    }
    // Where lines are so close that they would touch, they fade to a tint.
    let crowded = widest * half_width * 4.0;
    let t = (nearest - (half_width - 0.5)).clamp(0.0, 1.0);
    (1.0 - t * t * (3.0 - 2.0 * t)) * (1.6 - crowded).clamp(0.25, 1.0)
}
