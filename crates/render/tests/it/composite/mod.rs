//! Cells in the pass of another program, between what it draws itself.

mod host;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::dcamera::rh::proj::directx::{orthographic, perspective, perspective_infinite_reverse};
use glam::dcamera::rh::view::look_at_mat4;
use glam::{DMat4, DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Faces, SurfaceMesh, SurfaceVertex};
use neurotess_refine::{LodCriterion, RefineOptions};
use neurotess_render::color::{Rgb, category};
use neurotess_render::{
    Combined, Composite, CompositeError, DeviceError, Gpu, HostPass, HostView, HostViewError,
    Image, Light, Look, MeshGeometry, MeshLook, Meshes, Placement, Prerefined, PrerefinedSurface,
    VertexSource,
};
use wgpu::TextureFormat;

use crate::adapter::gpu;
use crate::device::Broken;
use crate::pictured::{CELL, by_type, mesh};
use crate::renderer::{read, source};
use host::{Host, SIZE, adapter, open, pixel_of};

const ASPECT: f64 = 1.5;
const PASS: HostPass = HostPass {
    color: TextureFormat::Rgba8Unorm,
    depth: TextureFormat::Depth32Float,
    samples: 4,
};
const BLUE: [u8; 4] = [0, 0, 255, 255];
const BLACK: [u8; 4] = [0, 0, 0, 255];
const RED: [u8; 4] = [255, 0, 0, 255];

fn view(projection: DMat4) -> HostView {
    HostView {
        view: look_at_mat4(DVec3::Z * 100.0, DVec3::ZERO, DVec3::Y),
        projection,
        origin: [0, 0],
        size: SIZE,
    }
}

fn at(image: &Image, clip_from_world: DMat4, point: DVec3) -> [u8; 4] {
    let [x, y] = pixel_of(clip_from_world, point);
    image.at(x, y)
}

/// The cell at level 4.
fn refined(gpu: &Gpu, mesh: &CoarseMesh) -> Prerefined {
    let (color_keys, _) = by_type(mesh);
    let surface = PrerefinedSurface {
        mesh,
        color_keys: &color_keys,
    };
    let level = |_| LodCriterion::Homogeneous(4).into();
    let options = RefineOptions::default();
    Prerefined::new(gpu, &[surface], level, &options, false).expect("uploaded")
}

/// What draws the cell into a program's pass, and the program.
struct Both {
    gpu: Gpu,
    source: Box<dyn VertexSource>,
    mesh: CoarseMesh,
}

impl Both {
    /// Cells that are refined as they are drawn take a second for their shaders, so the quick lane has refined ones.
    fn new() -> Self {
        let (gpu, mesh) = (open(), mesh(CELL));
        let source: Box<dyn VertexSource> = match neurotess_testing::is_full() {
            true => Box::new(source(&gpu, &mesh, &[Placement::default()])),
            false => Box::new(refined(&gpu, &mesh)),
        };
        Self { gpu, source, mesh }
    }

    fn cells(&self, pass: HostPass) -> Composite {
        let mut cells = Composite::new(&self.gpu, pass).expect("what draws");
        cells.set_colors(by_type(&self.mesh).1);
        cells
    }

    fn prepare(&mut self, cells: &mut Composite, view: &HostView) {
        let (gpu, look) = (&self.gpu, Look::default());
        cells
            .prepare(gpu, &mut *self.source, view, &look)
            .expect("drawn");
    }

    /// One wall is behind the cell, the other before its left half.
    fn check(
        &mut self,
        cells: &mut Composite,
        pass: HostPass,
        (projection, reversed): (DMat4, bool),
    ) {
        let view = view(projection);
        let clip = projection * view.view;
        let host = Host::new(&self.gpu, pass, clip, reversed);
        self.prepare(cells, &view);
        // All walls before the cell, all after it, and one of each.
        for walls in [[0..2, 0..0], [0..0, 0..2], [0..1, 1..2], [1..2, 0..1]] {
            let what = format!("{pass:?} {reversed} {walls:?}");
            let texture = host.pass(&self.gpu, walls, |pass| cells.draw(pass));
            let image = read(&self.gpu, texture);
            let at = |x, y| at(&image, clip, DVec3::new(x, y, 0.0));
            let soma = at(2.0, 1.0);
            let others = [BLUE, RED, BLACK];
            assert!(
                !others.contains(&soma) && soma[3] == 255,
                "{what}: {soma:?}"
            );
            assert_eq!(at(-2.0, 1.0), RED, "{what}");
            assert_eq!(at(25.0, -20.0), BLUE, "{what}");
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn cells_hide_what_is_behind_them_and_are_hidden_by_what_is_before() {
    let mut both = Both::new();
    let mut cells = both.cells(PASS);
    let near = perspective(0.9, ASPECT, 1.0, 500.0);
    both.check(&mut cells, PASS, (near, false));
    let flat = orthographic(-72.0, 72.0, -48.0, 48.0, 1.0, 500.0);
    both.check(&mut cells, PASS, (flat, false));
    let reversed = perspective_infinite_reverse(0.9, ASPECT, 1.0);
    both.check(&mut cells, PASS, (reversed, true));

    // Nothing shows beyond the program's far plane: the cell is 80 to 110 µm away.
    let short = view(perspective(0.9, ASPECT, 1.0, 75.0));
    let host = Host::new(&both.gpu, PASS, short.projection * short.view, false);
    both.prepare(&mut cells, &short);
    let texture = host.pass(&both.gpu, [0..0, 0..0], |pass| cells.draw(pass));
    let image = read(&both.gpu, texture);
    assert!(image.pixels.chunks(4).all(|pixel| pixel == BLACK));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn passes_have_other_formats_and_samples() {
    let mut both = Both::new();
    let others = [
        (TextureFormat::Rgba8UnormSrgb, TextureFormat::Depth24Plus, 1),
        (TextureFormat::Rgba8Unorm, TextureFormat::Depth16Unorm, 1),
        (TextureFormat::Rgba8UnormSrgb, TextureFormat::Depth24Plus, 4),
    ];
    for (color, depth, samples) in others {
        let pass = HostPass {
            color,
            depth,
            samples,
        };
        let mut cells = both.cells(pass);
        let near = perspective(0.9, ASPECT, 1.0, 500.0);
        both.check(&mut cells, pass, (near, false));
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn translucent_meshes_lie_between_the_walls_too() {
    const GREEN: Rgb = [0, 200, 0];
    let both = Both::new();
    let (_, mut table) = by_type(&both.mesh);
    let vertex = |(x, y)| SurfaceVertex {
        position: Vec3::new(x, y, 0.0),
        ..SurfaceVertex::default()
    };
    let corners = [(-90.0, -90.0), (90.0, -90.0), (90.0, 90.0), (-90.0, 90.0)];
    let square = SurfaceMesh {
        origin: DVec3::ZERO,
        vertices: corners.map(vertex).into(),
        faces: Faces {
            triangles: Vec::new(),
            quads: vec![[0, 1, 2, 3]],
        },
    };
    let look = MeshLook {
        color_key: category(table.categories.len() as u32),
        opacity: 0.5,
        edges: false,
        scale: 1.0,
    };
    table.categories.push(GREEN);
    let geometry = MeshGeometry::new(&both.gpu, square).expect("uploaded");
    let mut meshes = Meshes::new(&both.gpu, vec![(Arc::new(geometry), look)]);
    let mut nothing = source(&both.gpu, &both.mesh, &[]);
    let mut source = Combined::new(&mut nothing).with_meshes(Some(&mut meshes));
    let mut cells = both.cells(PASS);
    cells.set_colors(table);
    let view = view(perspective(0.9, ASPECT, 1.0, 500.0));
    let flat = Look {
        light: Light::Flat,
        ..Look::default()
    };
    cells
        .prepare(&both.gpu, &mut source, &view, &flat)
        .expect("drawn");
    let host = Host::new(&both.gpu, PASS, view.projection * view.view, false);
    let texture = host.pass(&both.gpu, [0..2, 0..0], |pass| cells.draw(pass));
    let image = read(&both.gpu, texture);
    let mut sum = [0; 3];
    for y in 32..96 {
        for x in 16..80 {
            assert_eq!(image.at(x, y), RED, "{x} {y}");
            let [r, g, b, _] = image.at(x + 96, y);
            sum = [
                sum[0] + u32::from(r),
                sum[1] + u32::from(g),
                sum[2] + u32::from(b),
            ];
        }
    }
    // Half of the samples are green, the others blue.
    let mean = sum.map(|s| f64::from(s) / (64.0 * 64.0));
    for (found, expected) in mean.into_iter().zip([0.0, 100.0, 127.5]) {
        assert!((found - expected).abs() < 8.0, "{mean:?}");
    }
}

#[neurotess_testing::test(needs(gpu))]
fn a_view_that_no_camera_has_is_an_error_and_draws_nothing() {
    let mut both = Both::new();
    let mut cells = both.cells(PASS);
    let view = view(DMat4::ZERO);
    assert_eq!(
        cells.prepare(&both.gpu, &mut *both.source, &view, &Look::default()),
        Err(CompositeError::View(HostViewError::Projection))
    );
}

#[neurotess_testing::test(needs(gpu))]
fn errors_of_ours_do_not_come_to_the_programs_handler() {
    let gpu = open();
    let heard = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&heard);
    gpu.device.on_uncaptured_error(Arc::new(move |_| {
        counted.fetch_add(1, Ordering::Relaxed);
    }));
    let too_large = || {
        let _ = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: !3,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
    };
    let scoped = gpu.scoped(|| {
        too_large();
        Ok::<(), DeviceError>(())
    });
    assert!(scoped.is_err());
    // A pass that no device draws into.
    let wrong = HostPass {
        depth: TextureFormat::Rgba8Unorm,
        ..PASS
    };
    assert!(matches!(
        Composite::new(&gpu, wrong),
        Err(DeviceError::Driver(_))
    ));
    // A shader that does not compile, which other threads find out.
    let mut cells = Composite::new(&gpu, PASS).expect("what draws");
    let seen = view(perspective(0.9, ASPECT, 1.0, 500.0));
    let drawn = cells.prepare(&gpu, &mut Broken::new(&gpu), &seen, &Look::default());
    let Err(CompositeError::Device(DeviceError::Driver(said))) = drawn else {
        panic!("it does not compile");
    };
    assert!(said.contains("broken.wgsl:3:"), "{said}");
    assert_eq!((heard.load(Ordering::Relaxed), gpu.check()), (0, Ok(())));
    // The program's own errors are its own.
    too_large();
    assert_eq!((heard.load(Ordering::Relaxed), gpu.check()), (1, Ok(())));
}

#[neurotess_testing::test(needs(gpu))]
fn a_device_with_too_little_is_refused() {
    let adapter = adapter();
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits {
            max_storage_buffers_per_shader_stage: 4,
            ..Gpu::requirements().limits(&adapter)
        },
        ..Default::default()
    };
    let (device, queue) =
        pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
    let refused = Gpu::of_host(&adapter, device, queue).expect_err("too few buffers");
    let said = refused.to_string();
    assert!(
        said.contains("max_storage_buffers_per_shader_stage is 4 instead of 8"),
        "{said}"
    );
}
