//! Tiles: from a frame to bytes.
//!
//! ```text
//! maker.prepare ─▶ draw: colour, normals, depth ─▶ occlude ─▶ blur ─▶ gather: bytes ─▶ read back
//!                  (samples per sub-pixel)          (sub-pixels)       (pixels)
//! ```

use crate::colour::{ColourTable, Rgb, linear};
use crate::device::Gpu;
use crate::error::DeviceError;
use crate::finish::{Finish, Finisher};
use crate::frame::Frame;
use crate::maker::VertexMaker;
use crate::shade::{
    COLOUR_FORMAT, DEPTH_FORMAT, DISTANCE_FORMAT, GUARD, Look, NORMAL_FORMAT, Shade, Shader,
    TableSizes,
};
use crate::timing::{Pass, Timer};

/// How a tile is finished.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finishing {
    /// Sub-pixels per pixel along a side.
    pub(crate) scale: u32,
    /// Sub-pixels around what is kept.
    pub(crate) margin: u32,
    /// Radius (µm) of ambient occlusion, and the most sub-pixels that it may be.
    pub(crate) occlusion: Option<(f32, f32)>,
    /// Colour behind everything; none: transparent.
    pub(crate) background: Option<Rgb>,
}

impl Finishing {
    /// What is kept of a tile.
    fn without_margin(&self, frame: &Frame) -> Frame {
        let mut kept = *frame;
        kept.tile.x += self.margin as i32;
        kept.tile.y += self.margin as i32;
        kept.tile.width -= 2 * self.margin;
        kept.tile.height -= 2 * self.margin;
        kept
    }
}

/// Textures and buffers for one tile of the greatest size.
struct Targets {
    colour: wgpu::TextureView,
    resolved: Option<wgpu::TextureView>,
    normal: wgpu::TextureView,
    distance: wgpu::TextureView,
    depth: wgpu::TextureView,
    raw: wgpu::Buffer,
    blurred: wgpu::Buffer,
    pixels: wgpu::Buffer,
    read: wgpu::Buffer,
    size: [u32; 2],
    bytes: u64,
}

/// Paints tiles of one maker.
pub(crate) struct Painter<'g> {
    gpu: &'g Gpu,
    shader: Shader,
    finisher: Finisher,
    shade: wgpu::Buffer,
    finish: wgpu::Buffer,
    table: wgpu::Buffer,
    sizes: TableSizes,
    samples: u32,
    targets: Option<Targets>,
    pub(crate) timer: Timer,
}

impl<'g> Painter<'g> {
    /// `samples`: of a sub-pixel, 1 or 4.
    pub(crate) fn new(
        gpu: &'g Gpu,
        maker: &dyn VertexMaker,
        table: &ColourTable,
        samples: u32,
    ) -> Result<Self, DeviceError> {
        let uniform = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let (entries, colours) = table.entries();
        let bytes: &[u8] = bytemuck::cast_slice(&entries);
        let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let table_buffer = make(gpu, "colours", bytes.len() as u64, storage);
        gpu.queue.write_buffer(&table_buffer, 0, bytes);
        let painter = Self {
            shader: Shader::new(gpu, maker, samples),
            finisher: Finisher::new(gpu, samples),
            shade: make(gpu, "shade", size_of::<Shade>() as u64, uniform),
            finish: make(gpu, "finish", size_of::<Finish>() as u64, uniform),
            table: table_buffer,
            sizes: TableSizes {
                scale: table.scale.len() as u32,
                colours,
                valued: table.values.instances() as u32,
            },
            samples,
            targets: None,
            timer: Timer::new(gpu),
            gpu,
        };
        gpu.check()?;
        Ok(painter)
    }

    /// Bytes of the textures and buffers that pictures pass through.
    pub(crate) fn target_bytes(&self) -> u64 {
        self.targets.as_ref().map_or(0, |targets| targets.bytes)
    }

    /// Paints a tile, without its margins: four bytes a pixel, straight alpha, sRGB.
    pub(crate) fn paint(
        &mut self,
        maker: &mut dyn VertexMaker,
        frame: &Frame,
        look: &Look,
        finishing: &Finishing,
    ) -> Result<Vec<u8>, DeviceError> {
        let size = [frame.tile.width, frame.tile.height];
        let empty = finishing
            .background
            .map_or([0; 4], |[r, g, b]| [r, g, b, 255]);
        if !maker.shows(&finishing.without_margin(frame)) {
            let pixel = finishing.scale * finishing.scale;
            let [width, height] = size.map(|n| n - 2 * finishing.margin);
            return Ok(empty.repeat((width * height / pixel) as usize));
        }
        if self.targets.as_ref().is_none_or(|t| t.size != size) {
            self.targets = Some(Targets::new(self.gpu, size, self.samples));
            self.gpu.check()?;
        }
        let Some(targets) = &self.targets else {
            return Ok(Vec::new());
        };
        let kept = size.map(|n| (n - 2 * finishing.margin) / finishing.scale);
        let (radius, most) = finishing.occlusion.unwrap_or_default();
        let [r, g, b] = linear(finishing.background.unwrap_or_default());
        let finish = Finish {
            radius,
            most,
            scale: finishing.scale,
            margin: finishing.margin,
            kept,
            clear: u32::from(finishing.background.is_none()),
            empty: u32::from_le_bytes(empty),
            background: [r, g, b, 1.0],
            ..Finish::of(frame)
        };
        let shade = Shade::new(frame, look, finishing.scale, &self.sizes);
        let queue = &self.gpu.queue;
        queue.write_buffer(&self.shade, 0, bytemuck::bytes_of(&shade));
        queue.write_buffer(&self.finish, 0, bytemuck::bytes_of(&finish));
        let (shade_group, finish_group) = self.groups(targets);

        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let rounds = maker.prepare(self.gpu, frame)?.max(1);
        for round in 0..rounds {
            let timestamps = self.timer.compute(Pass::Choose);
            maker.choose(round, &mut encoder, timestamps);
            self.draw(maker, round, rounds, targets, &shade_group, &mut encoder);
        }
        let over = |n: u32| n.div_ceil(8);
        // Nothing to do is still a pass: its times are read.
        let all = |n: u32| if radius > 0.0 { over(n) } else { 0 };
        let (occlude, blur) = (&self.finisher.occlude, &self.finisher.blur);
        for (pipeline, name) in [(occlude, Pass::Occlude), (blur, Pass::Blur)] {
            self.compute(pipeline, &finish_group, size.map(all), name, &mut encoder);
        }
        let pixels = [over(kept[0]), over(kept[1])];
        self.compute(
            &self.finisher.gather,
            &finish_group,
            pixels,
            Pass::Gather,
            &mut encoder,
        );
        let bytes = 4 * u64::from(kept[0]) * u64::from(kept[1]);
        encoder.copy_buffer_to_buffer(&targets.pixels, 0, &targets.read, 0, bytes);
        self.timer.resolve(&mut encoder);
        queue.submit([encoder.finish()]);
        let pixels = read(self.gpu, &targets.read, bytes)?;
        self.timer.read(self.gpu)?;
        Ok(pixels)
    }

    /// Chooses and draws a frame, waits for it, and leaves it where it is: for stopwatches. Gives the
    /// number of rounds.
    pub(crate) fn draw_only(
        &mut self,
        maker: &mut dyn VertexMaker,
        frame: &Frame,
        look: &Look,
    ) -> Result<usize, DeviceError> {
        let size = [frame.tile.width, frame.tile.height];
        if self.targets.as_ref().is_none_or(|t| t.size != size) {
            self.targets = Some(Targets::new(self.gpu, size, self.samples));
            self.gpu.check()?;
        }
        let Some(targets) = &self.targets else {
            return Ok(0);
        };
        let shade = Shade::new(frame, look, 1, &self.sizes);
        let queue = &self.gpu.queue;
        queue.write_buffer(&self.shade, 0, bytemuck::bytes_of(&shade));
        let (shade_group, finish_group) = self.groups(targets);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let rounds = maker.prepare(self.gpu, frame)?.max(1);
        for round in 0..rounds {
            maker.choose(round, &mut encoder, self.timer.compute(Pass::Choose));
            self.draw(maker, round, rounds, targets, &shade_group, &mut encoder);
        }
        // Passes that do nothing: their times are read with the others'.
        let idle = [
            (&self.finisher.occlude, Pass::Occlude),
            (&self.finisher.blur, Pass::Blur),
            (&self.finisher.gather, Pass::Gather),
        ];
        for (pipeline, name) in idle {
            self.compute(pipeline, &finish_group, [0, 0], name, &mut encoder);
        }
        self.timer.resolve(&mut encoder);
        queue.submit([encoder.finish()]);
        self.gpu.wait()?;
        Ok(rounds)
    }

    fn groups(&self, targets: &Targets) -> (wgpu::BindGroup, wgpu::BindGroup) {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let view = wgpu::BindingResource::TextureView;
        let resolved = targets.resolved.as_ref().unwrap_or(&targets.colour);
        let device = &self.gpu.device;
        let shade = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shade"),
            layout: &self.shader.layout,
            entries: &[
                entry(0, self.shade.as_entire_binding()),
                entry(1, self.table.as_entire_binding()),
            ],
        });
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
            ],
        });
        (shade, finish)
    }

    fn draw(
        &self,
        maker: &dyn VertexMaker,
        round: usize,
        rounds: usize,
        targets: &Targets,
        group: &wgpu::BindGroup,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let first = round == 0;
        let empty = match first {
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
        let colour_store = match targets.resolved {
            Some(_) if round + 1 == rounds => wgpu::StoreOp::Discard,
            _ => wgpu::StoreOp::Store,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("draw"),
            color_attachments: &[
                attachment(&targets.colour, targets.resolved.as_ref(), colour_store),
                attachment(&targets.normal, None, wgpu::StoreOp::Store),
                attachment(&targets.distance, None, wgpu::StoreOp::Store),
            ],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations {
                    load: match first {
                        true => wgpu::LoadOp::Clear(0.0),
                        false => wgpu::LoadOp::Load,
                    },
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: self.timer.render(Pass::Draw),
            ..Default::default()
        });
        pass.set_bind_group(1, group, &[]);
        let [width, height] = targets.size.map(|n| n as f32 + 2.0 * GUARD);
        pass.set_viewport(-GUARD, -GUARD, width, height, 0.0, 1.0);
        for (shader, pipeline) in self.shader.pipelines.iter().enumerate() {
            pass.set_pipeline(pipeline);
            maker.draw(round, shader, &mut pass);
        }
    }

    fn compute(
        &self,
        pipeline: &wgpu::ComputePipeline,
        group: &wgpu::BindGroup,
        groups: [u32; 2],
        name: Pass,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: self.timer.compute(name),
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(groups[0], groups[1], 1);
    }
}

impl Targets {
    fn new(gpu: &Gpu, size: [u32; 2], samples: u32) -> Self {
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let bound = wgpu::TextureUsages::TEXTURE_BINDING;
        let mut bytes = 0;
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let mut texture = |format: wgpu::TextureFormat, samples: u32| {
            bytes += pixels * u64::from(samples * format.block_copy_size(None).unwrap_or(4));
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("target"),
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: attachment | bound,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        let colour = texture(COLOUR_FORMAT, samples);
        let resolved = (samples > 1).then(|| texture(COLOUR_FORMAT, 1));
        let normal = texture(NORMAL_FORMAT, samples);
        let distance = texture(DISTANCE_FORMAT, samples);
        let depth = texture(DEPTH_FORMAT, samples);
        let storage = wgpu::BufferUsages::STORAGE;
        let read = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        Self {
            colour,
            resolved,
            normal,
            distance,
            depth,
            raw: make(gpu, "occlusion", 4 * pixels, storage),
            blurred: make(gpu, "occlusion", 4 * pixels, storage),
            pixels: make(
                gpu,
                "pixels",
                4 * pixels,
                storage | wgpu::BufferUsages::COPY_SRC,
            ),
            read: make(gpu, "read back", 4 * pixels, read),
            size,
            bytes: bytes + 16 * pixels,
        }
    }
}

fn make(gpu: &Gpu, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size.max(16),
        usage,
        mapped_at_creation: false,
    })
}

/// Waits for the device and copies the front of a buffer.
pub(crate) fn read(gpu: &Gpu, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<u8>, DeviceError> {
    let slice = buffer.slice(..bytes);
    slice.map_async(wgpu::MapMode::Read, |_| {});
    gpu.wait()?;
    let copied = slice
        .get_mapped_range()
        .map(|range| range.to_vec())
        .map_err(|e| DeviceError::Lost(e.to_string()))?;
    buffer.unmap();
    Ok(copied)
}
