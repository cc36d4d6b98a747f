//! The processor's pictures beside an adapter's: placements, states, cuts, views, markers, meshes, values; and beside
//! themselves: bands, static pictures, being stopped.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use crate::adapter::{device, gpu};
use crate::compared::Difference;
use crate::pictured::{CELL, by_type, mesh};
use glam::{DQuat, DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Role, SurfaceMesh};
use neurotess_raster::{SceneMarkers, SceneMesh, draw, draw_static};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_render::color::{ColorMap, ColorTable, InstanceValues, category, fraction};
use neurotess_render::state::{GHOSTED, HIGHLIGHTED, WITHOUT_NEURITES, WITHOUT_SOMA};
use neurotess_render::{
    Adaptive, AdaptiveSettings, Camera, Clip, Combined, Gpu, Image, Instance, KeyColors, Lens,
    Light, Marker, MarkerSettings, MarkerShape, Markers, MeshGeometry, MeshLook, Meshes,
    PictureOptions, Placement, StillRenderer, Template, TemplateId, Templates, Viewpoint, Watch,
};

const SIZE: [u32; 2] = [240, 180];

/// A scene, and how it is looked at.
struct Case {
    mesh: CoarseMesh,
    color_keys: Vec<u32>,
    table: ColorTable,
    instances: Vec<Instance>,
    settings: AdaptiveSettings,
    markers: Vec<Marker>,
    marker_shape: MarkerShape,
    meshes: Vec<(SurfaceMesh, MeshLook)>,
    camera: Camera,
    near: f64,
    options: PictureOptions,
}

impl Case {
    /// A cell in the colors of its types, from a little aside.
    fn new() -> Self {
        let mesh = mesh(CELL);
        let (color_keys, mut table) = by_type(&mesh);
        table.categories.extend([[255, 0, 255], [0, 160, 60]]);
        Self {
            mesh,
            color_keys,
            table,
            instances: vec![Instance::new(TemplateId(0))],
            settings: AdaptiveSettings {
                lod: LodCriterion::PixelError(0.25),
                ..AdaptiveSettings::default()
            },
            markers: Vec::new(),
            marker_shape: MarkerShape::Sphere,
            meshes: Vec::new(),
            camera: camera(DVec3::new(60.0, 40.0, 140.0), 0.5.into()),
            near: 0.5,
            options: PictureOptions {
                size: SIZE,
                ..PictureOptions::default()
            },
        }
    }

    fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    fn marker_settings(&self) -> MarkerSettings {
        MarkerSettings {
            shape: self.marker_shape,
            radius: 3.0,
            ..MarkerSettings::default()
        }
    }

    fn view(&self) -> Viewpoint {
        Viewpoint {
            camera: self.camera,
            near: self.near,
        }
    }

    /// Calls `with` with the scene as the processor draws it.
    fn scene<R>(&self, with: impl FnOnce(&neurotess_raster::Scene<'_>) -> R) -> R {
        let markers = SceneMarkers::new(&self.markers, self.marker_settings());
        let meshes = self.meshes.iter();
        let meshes: Vec<SceneMesh> = meshes
            .map(|(mesh, look)| SceneMesh::new(mesh.clone(), &[], *look))
            .collect();
        let template = Template {
            mesh: &self.mesh,
            color_keys: &self.color_keys,
            values: &[],
        };
        let instances = self.instances.clone();
        let scene = neurotess_raster::Scene::new(vec![template], instances, self.settings);
        let scene = scene.expect("a scene").with_markers(Some(&markers));
        with(&scene.with_meshes(&meshes))
    }

    fn by_processor(&self) -> Image {
        let options = &self.options;
        let mut whole = Whole::new(options.size);
        let view = self.view();
        self.scene(|scene| {
            draw(
                scene,
                &view,
                &self.table,
                options,
                &Watch::default(),
                |_, band| whole.take(band),
            )
            .map(|_| ())
        })
        .expect("drawn");
        whole.0
    }

    fn by_adapter(&self, gpu: &Gpu) -> Image {
        let template = Template {
            mesh: &self.mesh,
            color_keys: &self.color_keys,
            values: &[],
        };
        let mut templates = Templates::new();
        templates.add(gpu, &[template]).expect("uploaded");
        let scene = neurotess_render::Scene::new(templates, self.instances.clone());
        let sub_pixels = gpu.sub_pixels(&self.options);
        let source = Adaptive::new(gpu, scene.expect("a scene"), self.settings, sub_pixels);
        let mut source = source.expect("a source");
        let mut markers = (!self.markers.is_empty())
            .then(|| Markers::new(gpu, &self.markers, self.marker_settings()).expect("uploaded"));
        let meshes = self.meshes.iter().map(|(mesh, look)| {
            let geometry = MeshGeometry::new(gpu, mesh.clone()).expect("uploaded");
            (Arc::new(geometry), *look)
        });
        let mut meshes = Meshes::new(gpu, meshes.collect());
        let mut source = Combined::new(&mut source)
            .with_markers(markers.as_mut())
            .with_meshes((!meshes.is_empty()).then_some(&mut meshes));
        let mut renderer = StillRenderer::new();
        let states: Vec<u32> = self.instances.iter().map(|i| i.state).collect();
        renderer.set_states(&states);
        let mut whole = Whole::new(self.options.size);
        let (view, table) = (self.view(), &self.table);
        renderer
            .render(gpu, &mut source, &view, table, &self.options, |_, band| {
                whole.take(band)
            })
            .expect("drawn");
        whole.0
    }
}

struct Whole(Image);

impl Whole {
    fn new(size: [u32; 2]) -> Self {
        Self(Image::new(size[0], 0))
    }

    fn take(&mut self, band: Image) -> Result<(), Infallible> {
        self.0.height += band.height;
        self.0.pixels.extend(band.pixels);
        Ok(())
    }
}

fn camera(eye: DVec3, lens: Lens) -> Camera {
    Camera::new(eye, DVec3::ZERO, DVec3::Y, lens).expect("a camera")
}

fn placed(turn: f64, scale: f64, translation: DVec3, state: u32) -> Instance {
    Instance {
        placement: Placement {
            rotation: DQuat::from_rotation_y(turn),
            scale,
            translation,
        },
        state,
        ..Instance::new(TemplateId(0))
    }
}

/// Four of them in all states.
fn in_states(case: &mut Case) {
    case.options.look.highlighted = ([255, 160, 0], 0.6);
    case.instances = [
        (HIGHLIGHTED, -45.0),
        (GHOSTED, -15.0),
        (WITHOUT_SOMA, 15.0),
        (WITHOUT_NEURITES, 45.0),
    ]
    .into_iter()
    .map(|(state, x)| placed(x, 0.8, DVec3::new(x, 0.0, -x), state))
    .collect();
}

fn valued(case: &mut Case) {
    case.instances = (0..2)
        .map(|i| {
            placed(
                f64::from(i),
                1.0,
                DVec3::new(40.0 * f64::from(i), 0.0, 0.0),
                0,
            )
        })
        .collect();
    let points = case.mesh.tracing.len();
    // A soma has one color.
    let keys = case.mesh.tracing.iter().zip(0..);
    let keys = keys.map(|(point, key)| if point.role == Role::Soma { 0 } else { key });
    case.color_keys = keys.collect();
    let mut values = InstanceValues::default();
    for shift in [0.0, 0.5] {
        let value = |i: usize| (shift + i as f32 / points as f32) % 1.0;
        let known = (0..points).map(|i| if i < 5 { f32::NAN } else { value(i) });
        values.push(&known.collect::<Vec<f32>>());
    }
    case.table.scale = ColorMap::Viridis.scale();
    case.table.values = values;
}

fn marked(case: &mut Case, shape: MarkerShape) {
    case.marker_shape = shape;
    case.markers = (0..40)
        .map(|i| {
            let t = f64::from(i);
            Marker {
                position: DVec3::new(20.0 * t.sin(), t - 20.0, 20.0 * t.cos()),
                outwards: DVec3::new(t.sin(), 0.0, t.cos()).as_vec3(),
                color_key: category(8 + i % 2),
            }
        })
        .collect();
}

fn meshed(case: &mut Case, opacity: f32, edges: bool) {
    let options = RefineOptions::default();
    let refinement = Refinement::new(&case.mesh, LodCriterion::Homogeneous(3), &options);
    let look = MeshLook {
        color_key: category(9),
        opacity,
        edges,
        scale: 1.3,
    };
    case.meshes = vec![(SurfaceMesh::collect(&refinement), look)];
}

/// Everything that pictures have, by name.
fn cases() -> Vec<(&'static str, Case)> {
    let mut cases = vec![
        ("plain", Case::new()),
        ("states", Case::new().with(in_states)),
        ("values", Case::new().with(valued)),
        (
            "spheres",
            Case::new().with(|c| marked(c, MarkerShape::Sphere)),
        ),
        (
            "contacts",
            Case::new().with(|c| marked(c, MarkerShape::Contact)),
        ),
        ("dots", Case::new().with(|c| marked(c, MarkerShape::Point))),
        ("mesh", Case::new().with(|c| meshed(c, 1.0, false))),
        ("translucent", Case::new().with(|c| meshed(c, 0.4, false))),
    ];
    let mut add = |name, change: &dyn Fn(&mut Case)| cases.push((name, Case::new().with(change)));
    add("cut", &|case| {
        case.options.look.clip = Some(Clip {
            point: DVec3::ZERO,
            normal: DVec3::new(0.0, 0.0, -1.0),
        });
    });
    // The near plane goes through the soma and a neurite that comes near.
    add("near plane", &|case| case.near = 150.0);
    add("orthographic", &|case| {
        case.camera = camera(DVec3::new(60.0, 40.0, 140.0), Lens::orthographic(0.5));
        case.near = -400.0;
    });
    add("transparent", &|case| case.options.background = None);
    add("flat light on black", &|case| {
        case.options.look.light = Light::Flat;
        case.options.background = Some([0; 3]);
    });
    add("light from aside", &|case| {
        case.options.look.light = Light::From(Vec3::new(1.0, 0.2, 0.3));
    });
    add("wide", &|case| case.options.look.least_width = 3.0);
    add("one sample", &|case| case.options.samples = 1);
    add("36 samples", &|case| case.options.samples = 36);
    add("no occlusion", &|case| {
        case.options.occlusion = neurotess_render::Occlusion::Off;
    });
    // Colors change between the vertices that levels make: adapters decide on some levels for many patches at once.
    add("a scale", &|case| {
        case.settings.lod = LodCriterion::Homogeneous(4);
        let points = case.mesh.tracing.iter();
        let keys = points.map(|point| fraction(point.center.length() / 50.0));
        case.color_keys = keys.collect();
        case.table.scale = ColorMap::Viridis.scale();
        case.options.look.contrast = Some([255; 3]);
    });
    cases
}

/// Within a tenth of what an eye sees: see compared.rs.
#[neurotess_testing::test(needs(gpu))]
fn adapters_draw_what_the_processor_draws() {
    let gpu = device();
    // Each compiles shaders for a second: the quick lane has every third.
    let cases = cases().into_iter().enumerate();
    let all = neurotess_testing::is_full();
    for (_, (name, case)) in cases.filter(|(number, _)| all || number % 3 == 1) {
        let difference = Difference::between(&case.by_processor(), &case.by_adapter(&gpu));
        neurotess_testing::note!("{name}: {difference}");
        // One sample a pixel is there or not: at outlines a pixel is as far apart as colors are.
        let allowed = if name == "one sample" { 1.0 } else { 0.1 };
        assert!(!difference.exceeds(allowed), "{name}: {difference}");
    }
}

/// An empty picture would be like any other empty one.
#[neurotess_testing::test]
fn all_of_them_show_something() {
    for (name, case) in cases() {
        let image = case.by_processor();
        let empty = &image.pixels[..4];
        let shown = image.pixels.chunks(4).filter(|p| *p != empty).count();
        assert!(shown > 300, "{name}: {shown}");
    }
}

/// A picture that is colored anew is within two of 255 of one that is drawn in these colors.
#[neurotess_testing::test]
fn what_is_colored_anew_is_as_if_it_were_drawn_anew() {
    for (name, case) in cases() {
        let view = case.view();
        let (picture, _) = case
            .scene(|scene| {
                let watch = Watch::default();
                draw_static(scene, &view, &ColorTable::default(), &case.options, &watch)
            })
            .expect("drawn");
        let states: Vec<u32> = case.instances.iter().map(|i| i.state).collect();
        let colors = KeyColors {
            table: &case.table,
            states: &states,
            values: None,
        };
        let (recolored, drawn) = (picture.image(&colors), case.by_processor());
        let pairs = recolored.pixels.iter().zip(&drawn.pixels);
        let apart = pairs.map(|(a, b)| a.abs_diff(*b)).max();
        // Sixteen bits of a weight, and eight of a sample's color.
        assert!(apart <= Some(2), "{name}: {apart:?}");
    }
}

/// Memory is for a band; they fit together.
#[neurotess_testing::test]
fn bands_fit_together() {
    let mut case = Case::new();
    // With what is around them, 26 million sub-pixels: two bands.
    case.options.size = [12, 16_000];
    let tall = case.by_processor();
    assert_eq!(tall.height, 16_000);
    // The same picture without occlusion has fewer bands, at other rows.
    case.options.occlusion = neurotess_render::Occlusion::Off;
    let plain = case.by_processor();
    let covered =
        |image: &Image| -> Vec<bool> { image.pixels.chunks(4).map(|p| p != [255; 4]).collect() };
    assert!(covered(&tall) == covered(&plain));
}

#[neurotess_testing::test]
fn a_picture_can_be_stopped() {
    let case = Case::new();
    let watch = Watch::default();
    watch.stopped.store(true, Ordering::Relaxed);
    let view = case.view();
    let drawn = case.scene(|scene| {
        draw(scene, &view, &case.table, &case.options, &watch, |_, _| {
            Ok::<(), Infallible>(())
        })
    });
    assert_eq!(drawn.expect_err("stopped").to_string(), "stopped");
}

#[neurotess_testing::test]
fn nothing_at_all_is_the_background() {
    let case = Case::new().with(|case| case.instances.clear());
    let image = case.by_processor();
    assert!(image.pixels.iter().all(|&byte| byte == 255));
    assert_eq!(image.height, SIZE[1]);
}

/// Levels are by whole pixels, wherever a cell is.
#[neurotess_testing::test]
fn far_cells_are_where_near_ones_are() {
    let near = Case::new().by_processor();
    let away = DVec3::new(1e6, -3e6, 2e6);
    let far = Case::new().with(|case| {
        case.instances = vec![placed(0.0, 1.0, away, 0)];
        let eye = DVec3::new(60.0, 40.0, 140.0) + away;
        case.camera = Camera::new(eye, away, DVec3::Y, 0.5).expect("a camera");
    });
    let difference = Difference::between(&near, &far.by_processor());
    assert!(!difference.exceeds(0.02), "{difference}");
}
