//! A cell and its picture.
#![allow(dead_code, reason = "each test program uses some of it")]

use glam::{DQuat, DVec3};
use neurotess_formats::{ReadOptions, swc};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::CoarseMesh;
use neurotess_raster::Scene;
use neurotess_refine::{LodCriterion, RefineOptions};
use neurotess_render::color::{ColorTable, Palette, Rgb, category};
use neurotess_render::{
    AdaptiveSettings, BoundingSphere, Camera, DEFAULT_FOV, Exploration, Gpu, Image, Instance,
    PictureOptions, Placement, Prerefined, PrerefinedSurface, Proxy, Side, Template, TemplateId,
    Templates, VertexSource, Viewpoint, Watch, render_still,
};

/// A soma, an axon, and a dendrite that forks.
pub(crate) const CELL: &str = "1 1 0 0 0 5 -1
2 2 0 -9 0 0.4 1
3 2 3 -30 2 0.3 2
4 2 -4 -44 6 0.05 3
5 3 0 9 0 1.6 1
6 3 2 25 0 1.2 5
7 3 12 40 3 0.9 6
8 3 -9 42 -4 0.8 6
9 4 -12 2 9 1.5 1
10 4 -30 9 20 1 9
";

/// The coarse mesh of a tracing.
pub(crate) fn mesh(swc_text: &str) -> CoarseMesh {
    let read = swc::read_bytes(swc_text.as_bytes(), "cell.swc", &ReadOptions::default());
    let morphology = read.expect("a cell").morphology;
    generate(&morphology, &GenerateOptions::default())
        .expect("meshed")
        .mesh
}

/// Bounding spheres around a mesh.
pub(crate) fn spheres(mesh: &CoarseMesh) -> Vec<BoundingSphere> {
    let tracing = mesh.tracing.iter();
    let sphere = tracing.map(|t| {
        let center = mesh.origin + t.center.as_dvec3();
        (center, f64::from(t.radius))
    });
    sphere.collect()
}

/// A camera that fits.
pub(crate) fn camera(mesh: &CoarseMesh, size: [u32; 2]) -> Camera {
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    Camera::fit(Side::Front, DEFAULT_FOV, aspect, 0.05, &spheres(mesh)).expect("fits")
}

/// One cell, colored by type.
pub(crate) fn one_template(gpu: &Gpu, mesh: &CoarseMesh) -> (Templates, TemplateId) {
    let (color_keys, _) = by_type(mesh);
    let template = Template {
        mesh,
        color_keys: &color_keys,
        values: &[],
    };
    let mut templates = Templates::new();
    let ids = templates.add(gpu, &[template]).expect("uploaded");
    (templates, ids[0])
}

/// Color keys and table by type.
pub(crate) fn by_type(mesh: &CoarseMesh) -> (Vec<u32>, ColorTable) {
    let color_keys = mesh
        .tracing
        .iter()
        .map(|t| category(t.kind.0.max(0) as u32));
    let table = ColorTable {
        scale: Vec::new(),
        categories: (0..8).map(|kind| Palette::NeuroM.of_type(kind)).collect(),
        ..ColorTable::default()
    };
    (color_keys.collect(), table)
}

/// Who draws.
pub(crate) enum By<'g> {
    Processor,
    Adapter(&'g Gpu),
}

impl By<'_> {
    /// The whole picture of a mesh at level 4, in the colors of its types.
    pub(crate) fn picture(
        &self,
        mesh: &CoarseMesh,
        camera: &Camera,
        options: &PictureOptions,
    ) -> Image {
        let (color_keys, table) = by_type(mesh);
        self.draw(mesh, &color_keys, &table, camera, options)
    }

    /// The same on a scale.
    pub(crate) fn picture_of(
        &self,
        mesh: &CoarseMesh,
        color_keys: &[u32],
        scale: &[Rgb],
        camera: &Camera,
        options: &PictureOptions,
    ) -> Image {
        let table = ColorTable {
            scale: scale.to_vec(),
            categories: Vec::new(),
            ..ColorTable::default()
        };
        self.draw(mesh, color_keys, &table, camera, options)
    }

    fn draw(
        &self,
        mesh: &CoarseMesh,
        color_keys: &[u32],
        table: &ColorTable,
        camera: &Camera,
        options: &PictureOptions,
    ) -> Image {
        match self {
            Self::Processor => rastered(mesh, color_keys, table, camera, options),
            Self::Adapter(gpu) => draw(gpu, mesh, color_keys, table, camera, options),
        }
    }
}

fn rastered(
    mesh: &CoarseMesh,
    color_keys: &[u32],
    table: &ColorTable,
    camera: &Camera,
    options: &PictureOptions,
) -> Image {
    let template = Template {
        mesh,
        color_keys,
        values: &[],
    };
    let settings = AdaptiveSettings {
        lod: LodCriterion::Homogeneous(4),
        ..AdaptiveSettings::default()
    };
    let instances = vec![Instance::new(TemplateId(0))];
    let scene = Scene::new(vec![template], instances, settings).expect("a scene");
    let view = Viewpoint {
        camera: *camera,
        near: camera.near(&spheres(mesh)),
    };
    let mut whole = Image::new(options.size[0], 0);
    let take = |_: u32, band: Image| {
        whole.height += band.height;
        whole.pixels.extend(band.pixels);
        Ok::<(), std::convert::Infallible>(())
    };
    let drawn = neurotess_raster::draw(&scene, &view, table, options, &Watch::default(), take);
    drawn.expect("drawn");
    whole
}

/// The whole picture of a mesh at level 4, in the colors of its types.
pub(crate) fn picture(
    gpu: &Gpu,
    mesh: &CoarseMesh,
    camera: &Camera,
    options: &PictureOptions,
) -> Image {
    By::Adapter(gpu).picture(mesh, camera, options)
}

/// A row of cells, each behind the other, within a budget of triangles.
pub(crate) fn explored(
    gpu: &Gpu,
    mesh: &CoarseMesh,
    count: u32,
    budget: u32,
    camera: &Camera,
    options: &PictureOptions,
) -> Image {
    let (color_keys, table) = by_type(mesh);
    let mut source = Exploration::new(gpu, gpu.sub_pixels(options)).expect("a source");
    source.set_budget(budget);
    let ids = source
        .add(gpu, &[Proxy::new(mesh, &color_keys)])
        .expect("uploaded");
    let instances = (0..count).map(|i| Instance {
        placement: Placement {
            rotation: DQuat::from_rotation_y(f64::from(i)),
            translation: DVec3::new(40.0, 0.0, -90.0) * f64::from(i),
            ..Placement::default()
        },
        ..Instance::new(ids[0])
    });
    source
        .set_instances(gpu, instances.collect())
        .expect("placed");
    whole(gpu, &mut source, camera, 1.0, &table, options)
}

fn whole(
    gpu: &Gpu,
    source: &mut dyn VertexSource,
    camera: &Camera,
    near: f64,
    table: &ColorTable,
    options: &PictureOptions,
) -> Image {
    let mut whole = Image::new(options.size[0], options.size[1]);
    let taken = |top: u32, band: Image| {
        whole.lay(0, i64::from(top), &band);
        Ok::<(), std::convert::Infallible>(())
    };
    render_still(
        gpu,
        source,
        &Viewpoint {
            camera: *camera,
            near,
        },
        table,
        options,
        taken,
    )
    .expect("drawn");
    whole
}

fn draw(
    gpu: &Gpu,
    mesh: &CoarseMesh,
    color_keys: &[u32],
    table: &ColorTable,
    camera: &Camera,
    options: &PictureOptions,
) -> Image {
    let painted = PrerefinedSurface { mesh, color_keys };
    let mut source = Prerefined::new(
        gpu,
        &[painted],
        |_| LodCriterion::Homogeneous(4).into(),
        &RefineOptions::default(),
        options.look.wire > 0.0,
    )
    .expect("uploaded");
    let near = camera.near(&spheres(mesh));
    whole(gpu, &mut source, camera, near, table, options)
}
