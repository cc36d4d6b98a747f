//! Meshes beside the cells of a scene: their layers against the closed form, whatever their order and angle; edges,
//! cuts, picking, and static pictures.

use std::convert::Infallible;
use std::sync::Arc;

use crate::adapter::{device, gpu};
use crate::pictured::{CELL, by_type, mesh};
use crate::renderer::source;
use glam::{DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Faces, SurfaceMesh, SurfaceVertex};
use neurotess_render::color::{ColorTable, Rgb, category, fraction, linear};
use neurotess_render::{
    Adaptive, Camera, Clip, Combined, Gpu, Image, KeyColors, Lens, Light, Look, MeshGeometry,
    MeshLook, Meshes, Occlusion, PictureOptions, Placement, StillRenderer, VertexSource, Viewpoint,
};

const SIZE: [u32; 2] = [160, 120];
const RED: Rgb = [200, 30, 30];
const BLUE: Rgb = [20, 60, 220];
/// Half the side (µm) of a square.
const HALF: f32 = 60.0;

/// The table of a cell's types with red and blue after them, and their keys.
fn table(mesh: &CoarseMesh) -> (ColorTable, [u32; 2]) {
    let (_, mut table) = by_type(mesh);
    let first = table.categories.len() as u32;
    table.categories.extend([RED, BLUE]);
    (table, [first, first + 1].map(category))
}

fn surface(positions: &[Vec3], triangles: Vec<[u32; 3]>, quads: Vec<[u32; 4]>) -> SurfaceMesh {
    let vertex = |&position: &Vec3| SurfaceVertex {
        position,
        ..SurfaceVertex::default()
    };
    SurfaceMesh {
        origin: DVec3::ZERO,
        vertices: positions.iter().map(vertex).collect(),
        faces: Faces { triangles, quads },
    }
}

/// A square across the z-axis.
fn square(z: f32) -> SurfaceMesh {
    let corner = |x: f32, y: f32| Vec3::new(x * HALF, y * HALF, z);
    let corners = [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ];
    surface(&corners, Vec::new(), vec![[0, 1, 2, 3]])
}

/// Squares that are triangulated finely, one behind the other.
fn folded(places: &[f32]) -> SurfaceMesh {
    const SIDE: u32 = 40;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for &z in places {
        let first = positions.len() as u32;
        for i in 0..=SIDE {
            for j in 0..=SIDE {
                let [x, y] = [i, j].map(|n| (2.0 * n as f32 / SIDE as f32 - 1.0) * HALF);
                positions.push(Vec3::new(x, y, z));
            }
        }
        for i in 0..SIDE {
            for j in 0..SIDE {
                let a = first + i * (SIDE + 1) + j;
                let b = a + SIDE + 1;
                triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
            }
        }
    }
    surface(&positions, triangles, Vec::new())
}

fn uploaded(gpu: &Gpu, meshes: &[(SurfaceMesh, MeshLook)]) -> Meshes {
    let made = meshes.iter().map(|(mesh, look)| {
        let geometry = MeshGeometry::new(gpu, mesh.clone()).expect("uploaded");
        (Arc::new(geometry), *look)
    });
    Meshes::new(gpu, made.collect())
}

fn look(color_key: u32, opacity: f32) -> MeshLook {
    MeshLook {
        color_key,
        opacity,
        edges: false,
        scale: 1.0,
    }
}

/// From this direction, with squares covering the whole picture.
fn view(from: DVec3, lens: Lens) -> Viewpoint {
    let up = if from.y.abs() > 0.9 {
        DVec3::Z
    } else {
        DVec3::Y
    };
    let camera = Camera::new(from * 200.0, DVec3::ZERO, up, lens).expect("a camera");
    let near = camera.near(&[(DVec3::ZERO, 100.0)]);
    Viewpoint { camera, near }
}

fn options() -> PictureOptions {
    PictureOptions {
        size: SIZE,
        look: Look {
            light: Light::Flat,
            ..Look::default()
        },
        occlusion: Occlusion::Off,
        ..PictureOptions::default()
    }
}

fn drawn(
    gpu: &Gpu,
    source: &mut dyn VertexSource,
    view: &Viewpoint,
    table: &ColorTable,
    options: &PictureOptions,
) -> Image {
    let mut whole = Image::new(SIZE[0], 0);
    StillRenderer::new()
        .render(gpu, source, view, table, options, |_, band| {
            whole.height += band.height;
            whole.pixels.extend(band.pixels);
            Ok::<(), Infallible>(())
        })
        .expect("drawn");
    whole
}

/// Mean linear color of the pixels around the middle, and the greatest deviation of one.
fn middle(image: &Image) -> ([f64; 3], f64) {
    let [left, top] = SIZE.map(|n| n / 4);
    let mut all: Vec<[f64; 3]> = Vec::new();
    for y in top..SIZE[1] - top {
        for x in left..SIZE[0] - left {
            let [r, g, b, _] = image.at(x, y);
            all.push(linear([r, g, b]).map(f64::from));
        }
    }
    let mean = [0, 1, 2].map(|k| all.iter().map(|c| c[k]).sum::<f64>() / all.len() as f64);
    let deviation = |c: &[f64; 3]| (0..3).map(|k| (c[k] - mean[k]).abs()).fold(0.0, f64::max);
    (mean, all.iter().map(deviation).fold(0.0, f64::max))
}

/// What blending layers gives, from the nearest to the farthest, on white.
fn blended(layers: &[(Rgb, f64)]) -> [f64; 3] {
    layers.iter().rev().fold([1.0; 3], |behind, &(color, a)| {
        let color = linear(color).map(f64::from);
        [0, 1, 2].map(|k| a * color[k] + (1.0 - a) * behind[k])
    })
}

fn assert_close(found: [f64; 3], expected: [f64; 3], what: &str) {
    for k in 0..3 {
        let apart = (found[k] - expected[k]).abs();
        assert!(apart < 0.012, "{what}: {found:?}, expected {expected:?}");
    }
}

/// A source without cells.
fn nothing(gpu: &Gpu, mesh: &CoarseMesh) -> Adaptive {
    source(gpu, mesh, &[])
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn layers_blend_as_if_they_were_sorted_from_either_side() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (table, [red, blue]) = table(&mesh);
    let mut cells = nothing(&gpu, &mesh);
    for lens in [Lens::from(0.3), Lens::orthographic(0.3)] {
        for (a, b) in [(0.5, 0.5), (0.2, 0.3), (0.37, 0.62), (1.0, 0.5)] {
            let layers = [(square(10.0), look(red, a)), (square(-10.0), look(blue, b))];
            let (a, b) = (f64::from(a), f64::from(b));
            for (from, near_to_far) in [
                (DVec3::Z, [(RED, a), (BLUE, b)]),
                (DVec3::NEG_Z, [(BLUE, b), (RED, a)]),
                // Far from head-on.
                (DVec3::new(0.4, 0.2, 0.9), [(RED, a), (BLUE, b)]),
                (DVec3::new(-0.4, 0.2, -0.9), [(BLUE, b), (RED, a)]),
            ] {
                // Whichever is drawn first.
                let orders: &[bool] = if a == b { &[false, true] } else { &[a < 0.4] };
                for &turned in orders {
                    let mut layers = layers.clone();
                    if turned {
                        layers.reverse();
                    }
                    let mut meshes = uploaded(&gpu, &layers);
                    let mut source = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
                    let view = view(from, lens);
                    let image = drawn(&gpu, &mut source, &view, &table, &options());
                    let what = format!("{a}, {b} from {from}, {turned}");
                    assert_close(middle(&image).0, blended(&near_to_far), &what);
                }
            }
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn two_layers_of_a_half_hide_three_quarters_and_four_of_one_mesh_still_more() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (mut table, [red, _]) = table(&mesh);
    *table.categories.iter_mut().rev().nth(1).expect("red") = [0; 3];
    let mut cells = nothing(&gpu, &mesh);
    for (places, left) in [
        (&[0.0][..], 0.5),
        (&[-20.0, 20.0], 0.25),
        (&[-30.0, -10.0, 10.0, 30.0], 0.0625),
    ] {
        let mut meshes = uploaded(&gpu, &[(folded(places), look(red, 0.5))]);
        let mut source = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
        let view = view(DVec3::Z, 0.3.into());
        let image = drawn(&gpu, &mut source, &view, &table, &options());
        let (mean, most) = middle(&image);
        assert_close(mean, [left; 3], &format!("{} layers", places.len()));
        if places.len() == 1 {
            assert!(most < 1e-9, "a single layer has no grain: {most}");
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn cells_show_through_and_opaque_meshes_hide_them() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (table, [red, _]) = table(&mesh);
    let view = Viewpoint {
        camera: crate::pictured::camera(&mesh, SIZE),
        near: 0.1,
    };
    let mut cells = source(&gpu, &mesh, &[Placement::default()]);
    let without = drawn(&gpu, &mut cells, &view, &table, &options());
    let before = view.camera.eye().z as f32 - 60.0;
    for opacity in [0.3_f64, 1.0] {
        let layer = (square(before), look(red, opacity as f32));
        let mut meshes = uploaded(&gpu, &[layer]);
        let mut both = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
        let with = drawn(&gpu, &mut both, &view, &table, &options());
        let mut sums = [[0.0; 3]; 2];
        for (a, b) in without.pixels.chunks(4).zip(with.pixels.chunks(4)) {
            let behind = linear([a[0], a[1], a[2]]).map(f64::from);
            let found = linear([b[0], b[1], b[2]]).map(f64::from);
            let red = linear(RED).map(f64::from);
            for k in 0..3 {
                sums[0][k] += opacity * red[k] + (1.0 - opacity) * behind[k];
                sums[1][k] += found[k];
            }
        }
        let count = f64::from(SIZE[0] * SIZE[1]);
        let [expected, found] = sums.map(|sum| sum.map(|s| s / count));
        assert_close(found, expected, &format!("{opacity}"));
        if opacity == 1.0 {
            assert!(with.pixels.chunks(4).all(|p| p[..3] == RED));
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn edges_of_quads_have_no_diagonals_and_what_is_between_is_empty() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (table, [red, _]) = table(&mesh);
    let mut cells = nothing(&gpu, &mesh);
    let edges = MeshLook {
        edges: true,
        ..look(red, 1.0)
    };
    // The whole square, and four times as many pixels around it.
    let view = view(DVec3::Z, Lens::from(1.0));
    let mut count = |mesh: SurfaceMesh, look: MeshLook| {
        let mut meshes = uploaded(&gpu, &[(mesh, look)]);
        let mut source = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
        let image = drawn(&gpu, &mut source, &view, &table, &options());
        let inked = image.pixels.chunks(4).filter(|p| p[..3] != [255; 3]);
        (inked.count(), image.at(SIZE[0] / 2, SIZE[1] / 2))
    };
    let (all, _) = count(square(0.0), look(red, 1.0));
    let (outline, center) = count(square(0.0), edges);
    let side = (all as f64).sqrt();
    assert!(outline as f64 > 3.0 * side, "{outline} of {all}");
    assert!((outline as f64) < 9.0 * side, "{outline} of {all}");
    assert_eq!(center, [255; 4]);
    // As two triangles, it has a diagonal through the middle.
    let SurfaceMesh { vertices, .. } = square(0.0);
    let corners: Vec<Vec3> = vertices.iter().map(|v| v.position).collect();
    let halves = surface(&corners, vec![[0, 1, 2], [0, 2, 3]], Vec::new());
    let (with_diagonal, center) = count(halves, edges);
    assert!(with_diagonal as f64 > outline as f64 + 0.7 * side);
    assert!(center[1] < 200, "{center:?}");
}

#[neurotess_testing::test(needs(gpu))]
fn cuts_cut_meshes_and_tiles_fit_together() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (table, [red, blue]) = table(&mesh);
    let mut cells = nothing(&gpu, &mesh);
    let layers = [
        (folded(&[20.0]), look(red, 0.4)),
        (folded(&[-20.0]), look(blue, 0.7)),
    ];
    let mut meshes = uploaded(&gpu, &layers);
    let mut source = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
    let view = view(DVec3::new(0.3, 0.2, 0.93), 0.3.into());
    let whole = drawn(&gpu, &mut source, &view, &table, &options());
    let tiled = PictureOptions {
        tile: 96,
        ..options()
    };
    let tiled = drawn(&gpu, &mut source, &view, &table, &tiled);
    let other = whole.pixels.chunks(4).zip(tiled.pixels.chunks(4));
    let other = other.filter(|(a, b)| a != b).count();
    assert!(other < 20, "{other} pixels depend on the tiles");
    let mut cut = options();
    cut.look.clip = Some(Clip {
        point: DVec3::ZERO,
        normal: DVec3::X,
    });
    let cut = drawn(&gpu, &mut source, &view, &table, &cut);
    let left = |image: &Image| {
        let rows = (0..SIZE[1]).flat_map(|y| (0..SIZE[0] / 4).map(move |x| (x, y)));
        rows.filter(|&(x, y)| image.at(x, y) != [255; 4]).count()
    };
    assert!(left(&whole) > 1000 && left(&cut) == 0, "{}", left(&cut));
    assert!(cut.at(SIZE[0] - 20, SIZE[1] / 2) != [255; 4]);
}

#[neurotess_testing::test(needs(gpu))]
fn vertices_have_colors_of_their_own() {
    let gpu = device();
    let cell = mesh(CELL);
    let (mut table, [red, _]) = table(&cell);
    table.scale = vec![RED, BLUE];
    let view = view(DVec3::Z, Lens::from(0.3));
    let mut cells = source(&gpu, &cell, &[]);
    let look = look(red, 1.0);
    // From red on the left to blue on the right.
    let across = |mesh: &SurfaceMesh| -> Vec<u32> {
        let place = |v: &SurfaceVertex| fraction((v.position.x + HALF) / (2.0 * HALF));
        mesh.vertices.iter().map(place).collect()
    };
    let sheet = folded(&[20.0]);
    for edges in [false, true] {
        let keys = across(&sheet);
        let geometry = MeshGeometry::with_keys(&gpu, sheet.clone(), &keys).expect("uploaded");
        let bytes = geometry.bytes();
        let plain = MeshGeometry::new(&gpu, sheet.clone()).expect("uploaded");
        assert_eq!(bytes, plain.bytes() + 4 * sheet.vertices.len() as u64);
        let look = MeshLook { edges, ..look };
        let mut meshes = Meshes::new(&gpu, vec![(Arc::new(geometry), look)]);
        let mut both = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
        let image = drawn(&gpu, &mut both, &view, &table, &options());
        // Mean red less blue of the quarters, from left to right.
        let quarter = |n: u32| {
            let columns = n * SIZE[0] / 4..(n + 1) * SIZE[0] / 4;
            let all = columns.flat_map(|x| (0..SIZE[1]).map(move |y| (x, y)));
            all.map(|(x, y)| {
                let [r, _, b, _] = image.at(x, y);
                i64::from(r) - i64::from(b)
            })
            .sum::<i64>()
        };
        let quarters = [0, 1, 2, 3].map(quarter);
        assert!(
            quarters.is_sorted_by(|a, b| a > b),
            "{quarters:?}, edges: {edges}"
        );
        assert!(quarters[0] > 0 && quarters[3] < 0, "{quarters:?}");
    }
}

#[neurotess_testing::test(needs(gpu))]
fn static_pictures_have_meshes_too() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (mut table, [red, blue]) = table(&mesh);
    let view = Viewpoint {
        camera: crate::pictured::camera(&mesh, SIZE),
        near: 0.1,
    };
    let mut cells = source(&gpu, &mesh, &[Placement::default()]);
    let edges = MeshLook {
        edges: true,
        ..look(blue, 0.8)
    };
    let layers = [(square(20.0), look(red, 0.4)), (folded(&[-30.0]), edges)];
    let mut meshes = uploaded(&gpu, &layers);
    let mut both = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
    let options = PictureOptions {
        size: SIZE,
        ..PictureOptions::default()
    };
    let picture = StillRenderer::new()
        .render_static(&gpu, &mut both, &view, &table, &options)
        .expect("a static picture");
    let last = table.categories.len() - 1;
    table.categories[last - 1] = [0, 160, 80];
    let colors = KeyColors {
        table: &table,
        states: &[],
        values: None,
    };
    picture.recolor(&gpu, &colors).expect("recolored");
    let found = picture.image(&gpu).expect("read");
    let expected = drawn(&gpu, &mut both, &view, &table, &options);
    let pixels = expected.pixels.iter().zip(&found.pixels);
    let worst = pixels.map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(2), "{worst:?} of 255");
    let greenish = expected.pixels.chunks(4);
    let greenish = greenish.filter(|p| p[1] > p[0] && p[1] > p[2]).count();
    assert!(greenish > 1000, "{greenish}");
}

#[neurotess_testing::test(needs(gpu))]
fn opaque_meshes_are_picked_and_translucent_ones_are_not() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (table, [red, _]) = table(&mesh);
    let view = crate::renderer::view(&mesh);
    let view = neurotess_render::ViewParams { near: 0.1, ..view };
    let mut cells = source(&gpu, &mesh, &[Placement::default()]);
    let mut drawer = crate::renderer::renderer(&gpu, &mesh);
    drawer.set_colors(table);
    let before = crate::renderer::picks(&gpu, &mut drawer, &mut cells, &view);
    let behind = (square(-40.0), look(red, 1.0));
    let in_front = |opacity| (square(40.0), look(red, opacity));
    for (opacity, picked) in [(0.99, 0), (1.0, 1)] {
        let mut meshes = uploaded(&gpu, &[behind.clone(), in_front(opacity)]);
        let mut both = Combined::new(&mut cells).with_meshes(Some(&mut meshes));
        drawer.identify(&gpu, &mut both, &view).expect("drawn");
        gpu.wait().expect("done");
        let (size, ids) = drawer.ids().expect("no fault").expect("arrived");
        let resolver = cells.resolver();
        let center = ids[(size[1] / 2 * size[0] + size[0] / 2) as usize];
        if picked == 1 {
            assert_eq!(meshes.picked(center), Some(1));
            assert_eq!(resolver.resolve(center), None, "it is no cell");
            continue;
        }
        // Cells as if nothing were before them, and the mesh behind where they are not.
        for (&id, before) in ids.iter().zip(&before) {
            assert_eq!(resolver.resolve(id), *before);
            assert_eq!(meshes.picked(id), before.is_none().then_some(0));
        }
    }
}
