//! A progressive renderer with a cell to draw.

use neurotess_mesh::CoarseMesh;
use neurotess_render::pick::PickHit;
use neurotess_render::{
    Adaptive, AdaptiveSettings, Gpu, Image, Instance, Look, Occlusion, Placement,
    ProgressiveRenderer, Scene, Steps, ViewParams,
};

use crate::pictured::{by_type, camera, one_template, spheres};

pub(crate) const SIZE: [u32; 2] = [200, 260];

pub(crate) fn source(gpu: &Gpu, mesh: &CoarseMesh, instances: &[Placement]) -> Adaptive {
    let (templates, id) = one_template(gpu, mesh);
    let instances = instances.iter().map(|&placement| Instance {
        placement,
        ..Instance::new(id)
    });
    let scene = Scene::new(templates, instances.collect()).expect("a scene");
    Adaptive::new(gpu, scene, AdaptiveSettings::default(), 1).expect("a source")
}

pub(crate) fn view(mesh: &CoarseMesh) -> ViewParams {
    let camera = camera(mesh, SIZE);
    ViewParams {
        camera,
        near: camera.near(&spheres(mesh)),
        size: SIZE,
        look: Look::default(),
        occlusion: Occlusion::Fit,
        background: [255; 3],
        frozen: None,
    }
}

pub(crate) fn renderer(gpu: &Gpu, mesh: &CoarseMesh) -> ProgressiveRenderer {
    let mut renderer = ProgressiveRenderer::new(gpu);
    renderer.set_colors(by_type(mesh).1);
    renderer
}

/// The texture's pixels; their width must be a multiple of 64.
pub(crate) fn pixels(gpu: &Gpu, renderer: &ProgressiveRenderer) -> Image {
    read(gpu, renderer.texture().expect("a picture"))
}

/// The pixels of a texture of four bytes each; their width must be a multiple of 64.
pub(crate) fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Image {
    let (width, height) = (texture.width(), texture.height());
    let row = (4 * width).next_multiple_of(256);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    gpu.wait().expect("done");
    let range = buffer.slice(..).get_mapped_range().expect("mapped");
    let mut image = Image::new(width, height);
    for (to, from) in image
        .pixels
        .chunks_mut(4 * width as usize)
        .zip(range.chunks(row as usize))
    {
        to.copy_from_slice(&from[..4 * width as usize]);
    }
    image
}

pub(crate) fn picture(
    gpu: &Gpu,
    renderer: &mut ProgressiveRenderer,
    source: &mut Adaptive,
    view: ViewParams,
    steps: Steps,
) -> Image {
    renderer.begin(view, steps);
    while renderer.progress().is_some() {
        renderer.slice(gpu, source).expect("drawn");
    }
    pixels(gpu, renderer)
}

/// Mean difference of bytes.
pub(crate) fn difference(a: &Image, b: &Image) -> f64 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let sum: u64 = a
        .pixels
        .iter()
        .zip(&b.pixels)
        .map(|(a, b)| u64::from(a.abs_diff(*b)))
        .sum();
    sum as f64 / a.pixels.len() as f64
}

pub(crate) fn picks(
    gpu: &Gpu,
    renderer: &mut ProgressiveRenderer,
    source: &mut Adaptive,
    view: &ViewParams,
) -> Vec<Option<PickHit>> {
    renderer.identify(gpu, source, view).expect("drawn");
    let resolver = source.resolver();
    gpu.wait().expect("done");
    let (size, ids) = renderer.ids().expect("no fault").expect("arrived");
    assert_eq!(size, view.size);
    assert!(
        renderer.ids().expect("no fault").is_none(),
        "handed over once"
    );
    ids.into_iter().map(|id| resolver.resolve(id)).collect()
}
