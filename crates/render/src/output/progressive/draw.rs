//! Draws a slice of a picture; the last one of a step finishes it and shows it.

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::output::static_picture::StaticPicture;
use crate::output::tiles::TilePass;
use crate::sources::VertexSource;
use neurotess_picture::Frame;

use super::ProgressiveRenderer;
use super::canvas::Canvas;
use super::step::{finish_uniform, offset, selected, shade};
use super::under_way::UnderWay;

impl ProgressiveRenderer {
    /// Draws one slice of one step. The last slice also finishes the step.
    pub(super) fn draw(
        &self,
        gpu: &Gpu,
        source: &mut dyn VertexSource,
        renderer: usize,
        way: &UnderWay,
    ) -> Result<(), DeviceError> {
        let UnderWay { params, steps, .. } = way;
        let renderer = &self.renderers[renderer];
        let canvas = match way.draft {
            true => self.draft.as_ref(),
            false => self.fine.as_ref(),
        };
        let Some(canvas) = canvas else {
            return Ok(());
        };
        let [width, height] = params.size;
        let edge = |slice: u32, all: u32| {
            (u64::from(slice) * u64::from(all) / u64::from(steps.slices)) as u32
        };
        let slice = |all: u32| edge(way.slice, all)..edge(way.slice + 1, all);
        let (rows, shaders) = match way.banded {
            true => (slice(height), 0..usize::MAX),
            false => {
                let shaders = slice(source.shaders() as u32);
                (0..height, shaders.start as usize..shaders.end as usize)
            }
        };
        let place = offset(way.step, steps.steps);
        let shade = shade(renderer, params).moved(steps.steps, place);
        gpu.queue
            .write_buffer(&renderer.shade, 0, bytemuck::bytes_of(&shade));
        let group = renderer.shade_group(gpu);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let band = way.banded.then_some((rows.start, rows.end));
        let rounds = source.prepare(gpu, &selected(params, band))?.max(1);
        for round in 0..rounds {
            source.select(round, &mut encoder, None);
            let part = TilePass {
                round,
                shaders: shaders.clone(),
                first: way.slice == 0 && round == 0,
                last: way.slice + 1 == steps.slices && round + 1 == rounds,
                within: Some([0, rows.start, width, rows.end - rows.start]),
            };
            renderer.draw(source, &part, &canvas.targets, &group, &mut encoder);
        }
        if way.slice + 1 == steps.slices {
            self.finish(gpu, canvas, way, &mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
        self.clock.start(gpu);
        gpu.check()
    }

    fn finish(
        &self,
        gpu: &Gpu,
        canvas: &Canvas,
        way: &UnderWay,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let UnderWay {
            params,
            steps,
            step,
            ..
        } = way;
        let Some((_, finisher)) = self.finishers.iter().find(|(n, _)| *n == canvas.samples) else {
            return;
        };
        let frame = Frame::whole(params.camera, params.near, params.size);
        let uniform = finish_uniform(params, &frame, *step, steps.steps);
        gpu.queue
            .write_buffer(&self.finish, 0, bytemuck::bytes_of(&uniform));
        let group = canvas.group(gpu, finisher, &self.finish);
        // Steps lie within the same pixel, so occlusion is computed once for all of them.
        let occluded = uniform.radius > 0.0 && *step == 0;
        if occluded {
            finisher.begin(&canvas.targets, encoder);
        }
        let over = params.size.map(|n| n.div_ceil(8));
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("finish"),
            timestamp_writes: None,
        });
        pass.set_bind_group(0, &group, &[]);
        if occluded {
            let targets = &canvas.targets;
            finisher.find_blocks(gpu, targets, &mut pass);
            finisher.occlude(targets, &mut pass);
            finisher.blur(targets, &mut pass);
        }
        pass.set_pipeline(&finisher.last);
        pass.dispatch_workgroups(over[0], over[1], 1);
        drop(pass);
        if !way.hidden {
            self.present(gpu, canvas, encoder);
        }
    }

    /// Encodes writing the picture of a canvas into its texture.
    pub(super) fn present(&self, gpu: &Gpu, canvas: &Canvas, encoder: &mut wgpu::CommandEncoder) {
        let fine = !self.shows_draft;
        let recolored = self.recoloring.colored().filter(|_| fine);
        let given = self.given.as_ref().filter(|_| fine);
        let own = given.unwrap_or(&canvas.targets.pixels);
        let pixels = recolored.map_or(own, StaticPicture::pixels);
        let from = (pixels, &canvas.targets.normal);
        self.presenter
            .present(gpu, from, &canvas.screen, &self.outlines, encoder);
    }
}
