//! Draws tiles: from a frame to bytes.
//!
//! ```text
//! source.prepare ─▶ draw: color, normals, depth ─▶ occlude ─▶ blur ─▶ gather: bytes ─▶ read back
//!                  (samples per sub-pixel)          (sub-pixels)       (pixels)
//! ```

mod pass;
mod read;
mod tile;

use crate::gpu::buffers::make;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::parallel::beside;
use crate::gpu::timing::{Pass, Timer};
use crate::output::static_picture::collect::{Collector, Wanted};
use crate::shading::finish::{Finish, Finisher, Last};
use crate::shading::shade::{PipelineKey, Shade, Shader, TableSizes};
use crate::shading::targets::Targets;
use crate::sources::VertexSource;
use neurotess_picture::Frame;
use neurotess_picture::Look;
use neurotess_picture::Watch;
use neurotess_picture::color::{ColorTable, linear};
use neurotess_picture::recolor::Collected;

use read::{filled, read_watched};

pub(crate) use pass::TilePass;
pub(crate) use tile::{Finishing, KeptTile};

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
        let (shader, finisher) = beside(
            gpu,
            || Shader::new(gpu, source, key),
            || Finisher::new(gpu, samples, Last::Gather),
        );
        let renderer = Self {
            key,
            shader,
            finisher,
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

/// Writes to a buffer, which is replaced if it has another size.
fn upload(gpu: &Gpu, buffer: &mut wgpu::Buffer, bytes: &[u8]) {
    let size = (bytes.len() as u64).max(16);
    if buffer.size() != size {
        let usage = buffer.usage();
        *buffer = make(gpu, "table", size, usage);
    }
    gpu.queue.write_buffer(buffer, 0, bytes);
}
