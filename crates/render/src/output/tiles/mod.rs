//! Draws tiles: from a frame to bytes.
//!
//! ```text
//! source.prepare ─▶ draw: color, normals, depth ─▶ occlude ─▶ blur ─▶ gather: bytes ─▶ read back
//!                  (samples per sub-pixel)          (sub-pixels)       (pixels)
//! ```

use std::ops::Range;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::gpu::buffers::make;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::timing::{Pass, Timer};
use crate::output::static_picture::collect::{Collected, Collector, Wanted};
use crate::output::watch::Watch;
use crate::scene::color::{ColorTable, Rgb, linear};
use crate::shading::finish::{Finish, Finisher, Last};
use crate::shading::shade::{GUARD, Look, PipelineKey, Shade, Shader, TableSizes};
use crate::shading::targets::Targets;
use crate::sources::VertexSource;
use crate::view::frame::Frame;

/// How a tile is finished.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finishing {
    /// Sub-pixels per pixel along a side.
    pub(crate) scale: u32,
    /// Radius (µm) of ambient occlusion, and the most sub-pixels that it may reach.
    pub(crate) occlusion: Option<(f32, f32)>,
    /// Color behind everything; none: transparent.
    pub(crate) background: Option<Rgb>,
}

impl Finishing {
    /// Bytes of a pixel where nothing is.
    pub(crate) fn empty_pixel(&self) -> [u8; 4] {
        self.background.map_or([0; 4], |[r, g, b]| [r, g, b, 255])
    }
}

/// A render pass over the targets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TilePass {
    pub(crate) round: usize,
    /// Those of the source's shaders that draw.
    pub(crate) shaders: Range<usize>,
    /// Whether the targets are cleared before.
    pub(crate) first: bool,
    /// Whether it is the last pass of the tile, which resolves samples to sub-pixels.
    pub(crate) last: bool,
    /// Left, top, width and height of the rectangle that is drawn to; none: the whole target.
    pub(crate) within: Option<[u32; 4]>,
}

impl TilePass {
    fn round(round: usize, rounds: usize) -> Self {
        Self {
            round,
            shaders: 0..usize::MAX,
            first: round == 0,
            last: round + 1 == rounds,
            within: None,
        }
    }
}

/// What is drawn at once, and what is kept of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KeptTile {
    /// What is drawn.
    pub(crate) frame: Frame,
    /// The upper left sub-pixel of what is kept.
    pub(crate) inset: [u32; 2],
    /// Width and height (pixels) of what is kept.
    pub(crate) kept: [u32; 2],
}

impl KeptTile {
    /// The frame of what is kept. `scale`: sub-pixels per pixel along a side.
    fn without_margin(&self, scale: u32) -> Frame {
        let mut kept = self.frame;
        kept.tile.x += self.inset[0] as i32;
        kept.tile.y += self.inset[1] as i32;
        kept.tile.width = self.kept[0] * scale;
        kept.tile.height = self.kept[1] * scale;
        kept
    }
}

/// Draws tiles, with pipelines for one kind of source.
pub(crate) struct TileRenderer {
    key: PipelineKey,
    pub(crate) shader: Shader,
    finisher: Finisher,
    pub(crate) shade: wgpu::Buffer,
    finish: wgpu::Buffer,
    table: wgpu::Buffer,
    states: wgpu::Buffer,
    pub(crate) sizes: TableSizes,
    /// Number of the color table that it holds, for a caller that numbers its tables.
    pub(crate) holds: u64,
    samples: u32,
    targets: Option<Targets>,
    pub(crate) timer: Timer,
}

impl TileRenderer {
    pub(crate) fn new(
        gpu: &Gpu,
        source: &dyn VertexSource,
        key: PipelineKey,
    ) -> Result<Self, DeviceError> {
        let samples = key.samples;
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let renderer = Self {
            key,
            shader: Shader::new(gpu, source, key),
            finisher: Finisher::new(gpu, samples, Last::Gather),
            shade: make(gpu, "shade", size_of::<Shade>() as u64, uniform),
            finish: make(gpu, "finish", size_of::<Finish>() as u64, uniform),
            table: make(gpu, "colors", 16, storage),
            states: make(gpu, "states", 16, storage),
            sizes: TableSizes::default(),
            holds: 0,
            samples,
            targets: None,
            timer: Timer::new(gpu),
        };
        gpu.check()?;
        Ok(renderer)
    }

    pub(crate) fn key(&self) -> PipelineKey {
        self.key
    }

    /// Whether its pipelines are those of this key.
    pub(crate) fn fits(&self, key: PipelineKey) -> bool {
        self.key == key
    }

    /// Sets the colors.
    pub(crate) fn set_table(&mut self, gpu: &Gpu, table: &ColorTable) {
        let (entries, colors) = table.entries();
        self.sizes = TableSizes {
            scale: table.scale.len() as u32,
            colors,
            valued: table.values.instances() as u32,
        };
        upload(gpu, &mut self.table, bytemuck::cast_slice(&entries));
    }

    /// Sets the states of instances, in the scene's order.
    pub(crate) fn set_states(&mut self, gpu: &Gpu, states: &[u32]) {
        let states = if states.is_empty() { &[0] } else { states };
        upload(gpu, &mut self.states, bytemuck::cast_slice(states));
    }

    /// Bytes of the textures and buffers that a tile is drawn into and finished in.
    pub(crate) fn target_bytes(&self) -> u64 {
        self.targets.as_ref().map_or(0, |targets| targets.bytes)
    }

    /// Draws a tile. Returns what is kept of it: four bytes a pixel, straight alpha, sRGB; nothing if
    /// the watch has stopped the picture.
    pub(crate) fn render(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        tile: &KeptTile,
        look: &Look,
        finishing: &Finishing,
        watch: Option<&Watch>,
    ) -> Result<Option<Vec<u8>>, DeviceError> {
        let empty = finishing.empty_pixel();
        let [width, height] = tile.kept;
        if !source.shows(&tile.without_margin(finishing.scale)) {
            return Ok(Some(empty.repeat(width as usize * height as usize)));
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let groups = self.draw_tile(gpu, source, tile, look, finishing, &mut encoder)?;
        let Some(targets) = &self.targets else {
            return Ok(None);
        };
        let bytes = 4 * u64::from(width) * u64::from(height);
        encoder.clear_buffer(&targets.pixels, 0, Some(bytes));
        let mut pass = self.compute_pass(Pass::Gather, &mut encoder);
        pass.set_bind_group(0, &groups[1], &[]);
        self.finisher.gather(targets, &mut pass);
        drop(pass);
        encoder.copy_buffer_to_buffer(&targets.pixels, 0, &targets.read, 0, bytes);
        self.timer.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        let Some(pixels) = read_watched(gpu, &targets.read, bytes, watch)? else {
            // The device may still be copying into the buffer that is read, so it cannot be used
            // again.
            self.targets = None;
            return Ok(None);
        };
        self.timer.read(gpu)?;
        Ok(Some(filled(pixels, empty)))
    }

    /// Draws a tile and collects the color keys of its pixels, without the margins; none if nothing
    /// shows.
    pub(crate) fn collect(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        tile: &KeptTile,
        look: &Look,
        finishing: &Finishing,
        collector: &mut Collector,
    ) -> Result<Option<Collected>, DeviceError> {
        if !source.shows(&tile.without_margin(finishing.scale)) {
            return Ok(None);
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let groups = self.draw_tile(gpu, source, tile, look, finishing, &mut encoder)?;
        self.timer.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        let groups = [&groups[0], &groups[1]];
        let collected = collector.collect(gpu, source, &tile.frame, groups, tile.kept)?;
        Ok(Some(collected))
    }

    /// What collects color keys for its kind of source: none if the source has none to look up.
    pub(crate) fn collector(&self, gpu: &Gpu, source: &dyn VertexSource) -> Option<Collector> {
        let wanted = Wanted {
            key: self.key,
            shade_layout: &self.shader.layout,
            finish_layout: &self.finisher.layout,
        };
        Collector::new(gpu, source, &wanted)
    }

    /// Draws a tile's samples and their occlusion. Returns the shading's group, and that of the passes that
    /// finish a tile.
    fn draw_tile(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        tile: &KeptTile,
        look: &Look,
        finishing: &Finishing,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<[wgpu::BindGroup; 2], DeviceError> {
        let KeptTile { frame, inset, kept } = tile;
        let size = [frame.tile.width, frame.tile.height];
        let empty = finishing.empty_pixel();
        self.make_targets(gpu, size)?;
        let targets = self.targets.as_ref().expect("targets were just made");
        let (radius, most) = finishing.occlusion.unwrap_or_default();
        let [r, g, b] = linear(finishing.background.unwrap_or_default());
        let finish = Finish {
            radius,
            most,
            scale: finishing.scale,
            tiled: 1,
            kept: *kept,
            inset: *inset,
            clear: u32::from(finishing.background.is_none()),
            empty: u32::from_le_bytes(empty),
            background: [r, g, b, 1.0],
            ..Finish::of(frame)
        };
        let shade = Shade::new(frame, look, finishing.scale, &self.sizes);
        let queue = &gpu.queue;
        queue.write_buffer(&self.shade, 0, bytemuck::bytes_of(&shade));
        queue.write_buffer(&self.finish, 0, bytemuck::bytes_of(&finish));
        let (shade_group, finish_group) = self.groups(gpu, targets);

        let rounds = source.prepare(gpu, frame)?.max(1);
        for round in 0..rounds {
            let timestamps = self.timer.compute(Pass::Select);
            source.select(round, encoder, timestamps);
            let part = TilePass::round(round, rounds);
            self.draw(source, &part, targets, &shade_group, encoder);
        }
        self.occlude(gpu, targets, &finish_group, radius > 0.0, encoder);
        Ok([shade_group, finish_group])
    }

    /// Finds out which parts of the targets show anything, and how they are occluded.
    fn occlude(
        &self,
        gpu: &Gpu,
        targets: &Targets,
        group: &wgpu::BindGroup,
        occluded: bool,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let finisher = &self.finisher;
        finisher.begin(targets, encoder);
        let mut pass = self.compute_pass(Pass::Occlude, encoder);
        pass.set_bind_group(0, group, &[]);
        finisher.find_blocks(gpu, targets, &mut pass);
        if occluded {
            finisher.occlude(targets, &mut pass);
        }
        drop(pass);
        // Without occlusion the pass is empty, since its times are read.
        let mut pass = self.compute_pass(Pass::Blur, encoder);
        pass.set_bind_group(0, group, &[]);
        if occluded {
            finisher.blur(targets, &mut pass);
        }
    }

    /// Selects and draws a frame and waits for it, without reading it back: for measurements.
    /// Returns the number of rounds.
    pub(crate) fn draw_only(
        &mut self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        frame: &Frame,
        look: &Look,
    ) -> Result<usize, DeviceError> {
        let size = [frame.tile.width, frame.tile.height];
        self.make_targets(gpu, size)?;
        let Some(targets) = &self.targets else {
            return Ok(0);
        };
        let shade = Shade::new(frame, look, 1, &self.sizes);
        let queue = &gpu.queue;
        queue.write_buffer(&self.shade, 0, bytemuck::bytes_of(&shade));
        let shade_group = self.shade_group(gpu);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let rounds = source.prepare(gpu, frame)?.max(1);
        for round in 0..rounds {
            source.select(round, &mut encoder, self.timer.compute(Pass::Select));
            let part = TilePass::round(round, rounds);
            self.draw(source, &part, targets, &shade_group, &mut encoder);
        }
        // Empty passes, since their times are read with the others'.
        for name in [Pass::Occlude, Pass::Blur, Pass::Gather] {
            self.compute_pass(name, &mut encoder);
        }
        self.timer.resolve(&mut encoder);
        queue.submit([encoder.finish()]);
        gpu.wait()?;
        Ok(rounds)
    }

    fn groups(&self, gpu: &Gpu, targets: &Targets) -> (wgpu::BindGroup, wgpu::BindGroup) {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let view = wgpu::BindingResource::TextureView;
        let resolved = targets.resolved.as_ref().unwrap_or(&targets.color);
        let device = &gpu.device;
        let shade = self.shade_group(gpu);
        let finish = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("finish"),
            layout: &self.finisher.layout,
            entries: &[
                entry(0, self.finish.as_entire_binding()),
                entry(1, view(resolved)),
                entry(2, view(&targets.normal)),
                entry(3, view(&targets.distance)),
                entry(4, targets.raw.as_entire_binding()),
                entry(5, targets.blurred.as_entire_binding()),
                entry(6, targets.pixels.as_entire_binding()),
                entry(7, targets.blocks.as_entire_binding()),
            ],
        });
        (shade, finish)
    }

    /// Group 1 of the pipelines that draw.
    pub(crate) fn shade_group(&self, gpu: &Gpu) -> wgpu::BindGroup {
        let buffers = [&self.shade, &self.table, &self.states];
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shade"),
            layout: &self.shader.layout,
            entries: &entries,
        })
    }

    fn make_targets(&mut self, gpu: &Gpu, size: [u32; 2]) -> Result<(), DeviceError> {
        if self.targets.as_ref().is_none_or(|t| t.size != size) {
            self.targets = None;
            self.targets = Some(Targets::new(gpu, size, self.samples));
            gpu.check()?;
        }
        Ok(())
    }

    /// Draws what the source selected last.
    pub(crate) fn draw(
        &self,
        source: &dyn VertexSource,
        part: &TilePass,
        targets: &Targets,
        group: &wgpu::BindGroup,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let empty = match part.first {
            true => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            false => wgpu::LoadOp::Load,
        };
        let attachment = |view, resolve_target, store| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations { load: empty, store },
            })
        };
        let kept = match part.last {
            true => wgpu::StoreOp::Discard,
            false => wgpu::StoreOp::Store,
        };
        let resolved = targets.resolved.as_ref().filter(|_| part.last);
        let color_store = match targets.resolved {
            Some(_) => kept,
            None => wgpu::StoreOp::Store,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("draw"),
            color_attachments: &[
                attachment(&targets.color, resolved, color_store),
                attachment(&targets.normal, None, wgpu::StoreOp::Store),
                attachment(&targets.distance, None, wgpu::StoreOp::Store),
            ],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations {
                    load: match part.first {
                        true => wgpu::LoadOp::Clear(0.0),
                        false => wgpu::LoadOp::Load,
                    },
                    // The next round needs the depths of this one.
                    store: kept,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: self.timer.render(Pass::Draw),
            ..Default::default()
        });
        pass.set_bind_group(1, group, &[]);
        let [width, height] = targets.size.map(|n| n as f32 + 2.0 * GUARD);
        pass.set_viewport(-GUARD, -GUARD, width, height, 0.0, 1.0);
        if let Some([x, y, width, height]) = part.within {
            pass.set_scissor_rect(x, y, width, height);
        }
        for (shader, pipeline) in self.shader.pipelines.iter().enumerate() {
            if part.shaders.contains(&shader) {
                pass.set_pipeline(pipeline);
                source.draw(part.round, shader, &mut pass);
            }
        }
    }

    /// A compute pass whose times are noted.
    fn compute_pass<'a>(
        &self,
        name: Pass,
        encoder: &'a mut wgpu::CommandEncoder,
    ) -> wgpu::ComputePass<'a> {
        encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: self.timer.compute(name),
        })
    }
}

/// Pixels with those that were not written, which are 0, as an empty picture has them. With a background none
/// that was written is 0; without one, so is the empty pixel.
fn filled(mut pixels: Vec<u8>, empty: [u8; 4]) -> Vec<u8> {
    for pixel in pixels.chunks_exact_mut(4) {
        if pixel == [0; 4] {
            pixel.copy_from_slice(&empty);
        }
    }
    pixels
}

/// Writes to a buffer, which is replaced if it has another size.
fn upload(gpu: &Gpu, buffer: &mut wgpu::Buffer, bytes: &[u8]) {
    let size = (bytes.len() as u64).max(16);
    if buffer.size() != size {
        let usage = buffer.usage();
        *buffer = make(gpu, "table", size, usage);
    }
    gpu.queue.write_buffer(buffer, 0, bytes);
}

/// Waits for the device and copies the first bytes of a buffer; nothing if the watch has stopped
/// the picture.
fn read_watched(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    bytes: u64,
    watch: Option<&Watch>,
) -> Result<Option<Vec<u8>>, DeviceError> {
    let slice = buffer.slice(..bytes);
    let mapped = Arc::new(AtomicBool::new(false));
    let done = Arc::clone(&mapped);
    slice.map_async(wgpu::MapMode::Read, move |_| {
        done.store(true, Ordering::Release);
    });
    match watch {
        Some(watch) if !watch.wait(gpu, &mapped)? => return Ok(None),
        Some(_) => {}
        None => gpu.wait()?,
    }
    let copied = slice
        .get_mapped_range()
        .map(|range| range.to_vec())
        .map_err(|e| DeviceError::Lost(e.to_string()))?;
    buffer.unmap();
    Ok(Some(copied))
}
