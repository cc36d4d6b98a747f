//! One frame, into a file, where there is no display.

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use neurotess::render::{Image, PngWriter, wgpu};

use crate::cells::Cells;
use crate::host::{Host, open};

/// Width, of which a row of pixels takes a multiple of 256 bytes, and height.
const SIZE: [u32; 2] = [960, 720];

/// Draws a frame and saves it.
pub(crate) fn save(cell: &Path, out: &Path) -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let (_, gpu) = open(&instance, None)?;
    let (device, queue) = (gpu.device.clone(), gpu.queue.clone());
    let mut host = Host::new(&gpu, wgpu::TextureFormat::Rgba8UnormSrgb);
    let mut cells = Cells::new(gpu, cell, host.pass())?;
    let [width, height] = SIZE;
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: host.pass().color,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    host.draw(&target, &mut cells, 0.35)?;

    let mut image = Image::new(width, height);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture"),
        size: image.pixels.len() as u64,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: None,
            },
        },
        target.size(),
    );
    queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let bytes = buffer.slice(..).get_mapped_range()?;
    image.pixels.copy_from_slice(&bytes);
    let mut png = PngWriter::new(BufWriter::new(File::create(out)?), SIZE, false)?;
    png.write(&image)?;
    Ok(png.finish()?)
}
