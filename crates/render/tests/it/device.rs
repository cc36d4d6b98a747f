//! The device itself.

use crate::adapter::{device, gpu};
use glam::DVec3;
use neurotess_refine::wgsl::{ShaderParts, WgslFile};
use neurotess_render::color::ColorTable;
use neurotess_render::{
    Camera, DeviceError, Frame, Gpu, PictureError, PictureOptions, SourceKey, VertexSource,
    Viewpoint, render_still,
};

#[neurotess_testing::test(needs(gpu))]
fn complaints_are_kept_until_asked_for() {
    let gpu = device();
    let _ = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: !3,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    assert!(gpu.check().is_err());
    assert_eq!(gpu.check(), Ok(()));
}

/// A source whose shader does not compile.
pub(crate) struct Broken(wgpu::BindGroupLayout);

impl Broken {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: None,
                entries: &[],
            });
        Self(layout)
    }
}

impl VertexSource for Broken {
    fn key(&self) -> SourceKey {
        SourceKey {
            name: "broken",
            ..SourceKey::default()
        }
    }

    fn shader(&self, _shader: usize) -> ShaderParts {
        ShaderParts::new(&[WgslFile {
            name: "broken.wgsl",
            text: "// Broken.\nfn surface_vertex(v: u32, i: u32) -> SurfaceVertex {\n    return nowhere;\n}\n",
        }])
    }

    fn layout(&self, _shader: usize) -> &wgpu::BindGroupLayout {
        &self.0
    }

    fn prepare(&mut self, _gpu: &Gpu, _frame: &Frame) -> Result<usize, DeviceError> {
        Ok(1)
    }

    fn draw(&self, _round: usize, _shader: usize, _pass: &mut wgpu::RenderPass<'_>) {}
}

#[neurotess_testing::test(needs(gpu))]
fn what_the_driver_says_of_a_shader_names_file_and_line() {
    let gpu = device();
    let camera = Camera::new(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.5).expect("a camera");
    let drawn = render_still(
        &gpu,
        &mut Broken::new(&gpu),
        &Viewpoint { camera, near: 0.1 },
        &ColorTable::default(),
        &PictureOptions::default(),
        |_, _| Ok::<(), ()>(()),
    );
    let Err(PictureError::Device(DeviceError::Driver(said))) = drawn else {
        panic!("it does not compile");
    };
    assert!(said.contains("broken.wgsl:3:"), "{said}");
}
