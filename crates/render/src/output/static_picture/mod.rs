//! Static pictures: made once, and colored anew without being drawn anew.
//!
//! **Theory.** In linear light a pixel is a sum over its samples, and light and occlusion do not
//! depend on colors. So a picture is a sparse matrix, whose rows are pixels and whose columns are the
//! color keys that show, times the colors of these keys, plus a constant. Another frame of a
//! recording, another range or color map is one product, whatever the scene; and only keys that show
//! need values. Heras Ciechomski et al. (2008) describe such a static mode for circuits.
//!
//! ```text
//! source ─▶ depths, occlusion ─┐
//! source ─▶ keyed.wgsl ────────┴▶ collect.wgsl ─▶ matrix.rs ─▶ recolor.wgsl ─▶ bytes
//!           (samples)             (tile by tile)   (once)       (by picture)
//! ```

pub(crate) mod collect;
pub(crate) mod recolor;

use crate::gpu::buffers::read_back;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use neurotess_picture::Image;
use neurotess_picture::color::{Rgb, linear};
use neurotess_picture::{Look, edge_color};

use neurotess_picture::recolor::{Contrast, KeyColors, Matrix, VisibleKey};
use recolor::{Product, Recolor};

/// A picture whose colors can be changed: see [`StillRenderer::render_static`].
///
/// [`StillRenderer::render_static`]: crate::StillRenderer::render_static
pub struct StaticPicture {
    size: [u32; 2],
    keys: Vec<VisibleKey>,
    weights: usize,
    product: Product,
    look: Look,
}

impl StaticPicture {
    pub(crate) fn new(
        gpu: &Gpu,
        size: [u32; 2],
        matrix: Matrix,
        look: &Look,
        background: Option<Rgb>,
    ) -> Result<Self, DeviceError> {
        let [r, g, b] = linear(background.unwrap_or_default());
        let empty = background.map_or([0; 4], |[r, g, b]| [r, g, b, 255]);
        let settings = Recolor {
            background: [r, g, b, 1.0],
            edge: edge_color(look),
            transparent: u32::from(background.is_none()),
            empty: u32::from_le_bytes(empty),
            ..Recolor::default()
        };
        let product = Product::new(gpu, &matrix, settings)?;
        Ok(Self {
            size,
            weights: matrix.weights.len(),
            keys: matrix.keys,
            product,
            look: *look,
        })
    }

    /// What shows: each color key of each instance once, in order.
    pub fn keys(&self) -> &[VisibleKey] {
        &self.keys
    }

    /// Number of weights: of all pixels' color keys.
    pub fn weights(&self) -> usize {
        self.weights
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.product.bytes
    }

    /// Colors the picture anew.
    ///
    /// # Errors
    /// The device reports an error.
    ///
    /// # Panics
    /// If there are values, but not one for each key.
    pub fn recolor(&self, gpu: &Gpu, colors: &KeyColors<'_>) -> Result<(), DeviceError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.encode(gpu, colors, &mut encoder);
        gpu.queue.submit([encoder.finish()]);
        gpu.check()
    }

    /// Encodes coloring it anew: see [`StaticPicture::recolor`].
    pub(crate) fn encode(
        &self,
        gpu: &Gpu,
        colors: &KeyColors<'_>,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let values = colors.values;
        assert!(
            values.is_none_or(|values| values.len() == self.keys.len()),
            "a value for each key"
        );
        let contrast = Contrast::new(&self.look);
        let linear = colors.table.linear();
        let colored: Vec<[f32; 4]> = self
            .keys
            .iter()
            .enumerate()
            .map(|(index, key)| {
                let value = values.map(|values| values[index]);
                let color = contrast.key_color(colors.table, &linear, key, value);
                let state = colors.states.get(key.instance as usize).copied();
                contrast.in_state(color, state.unwrap_or_default())
            })
            .collect();
        self.product.multiply(gpu, &colored, encoder);
    }

    /// Bytes of its pixels, as it was colored last: sRGB, by row.
    pub(crate) fn pixels(&self) -> &wgpu::Buffer {
        &self.product.pixels
    }

    /// The picture, as it was colored last. Waits for the device.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn image(&self, gpu: &Gpu) -> Result<Image, DeviceError> {
        let [width, height] = self.size;
        let count = width as usize * height as usize;
        let pixels: Vec<u32> = read_back(gpu, &self.product.pixels, count)?;
        Ok(Image {
            width,
            height,
            pixels: bytemuck::cast_slice(&pixels).to_vec(),
        })
    }
}
