//! Markers beside the cells of a scene: drawn, colored, thinned out, picked, and in static pictures.

use std::convert::Infallible;

use crate::adapter::{device, gpu};
use crate::pictured::{CELL, by_type, camera, mesh};
use crate::renderer::source;
use glam::DVec3;
use neurotess_mesh::CoarseMesh;
use neurotess_render::color::{ColorTable, category};
use neurotess_render::{
    Camera, Combined, Frame, Gpu, Image, KeyColors, Look, Marker, MarkerSettings, MarkerShape,
    Markers, PictureOptions, Placement, StillRenderer, VertexSource, Viewpoint,
};

const SIZE: [u32; 2] = [320, 240];

/// The table of a cell's types with two more categories, and the key of the first.
fn table(mesh: &CoarseMesh) -> (ColorTable, u32) {
    let (_, mut table) = by_type(mesh);
    let first = category(table.categories.len() as u32);
    table.categories.extend([[255, 0, 255], [0, 255, 0]]);
    (table, first)
}

fn options() -> PictureOptions {
    PictureOptions {
        size: SIZE,
        look: Look {
            light: neurotess_render::Light::Flat,
            ..Look::default()
        },
        occlusion: neurotess_render::Occlusion::Off,
        ..PictureOptions::default()
    }
}

fn drawn(gpu: &Gpu, source: &mut dyn VertexSource, view: &Viewpoint, table: &ColorTable) -> Image {
    let mut whole = Image::new(SIZE[0], 0);
    StillRenderer::new()
        .render(gpu, source, view, table, &options(), |_, band| {
            whole.height += band.height;
            whole.pixels.extend(band.pixels);
            Ok::<(), Infallible>(())
        })
        .expect("drawn");
    whole
}

fn pixels_of(image: &Image, color: [u8; 3]) -> usize {
    let pixels = image.pixels.chunks(4);
    pixels.filter(|pixel| pixel[..3] == color).count()
}

fn viewpoint(mesh: &CoarseMesh) -> Viewpoint {
    Viewpoint {
        camera: camera(mesh, SIZE),
        near: 0.1,
    }
}

/// Markers in front of a view's middle, in a row, of two colors in turn.
fn row(view: &Viewpoint, key: u32, count: u32) -> Vec<Marker> {
    let [right, _, backward] = view.camera.axes();
    let near = view.camera.target() + 0.3 * view.camera.depth(view.camera.target()) * backward;
    let marker = |i: u32| Marker {
        position: near + (f64::from(i) - 0.5 * f64::from(count)) * 4.0 * right,
        color_key: key + i % 2,
        ..Marker::default()
    };
    (0..count).map(marker).collect()
}

#[neurotess_testing::test(needs(gpu))]
fn markers_are_drawn_in_their_colors_and_leave_the_cells_as_they_are() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (table, key) = table(&mesh);
    let view = viewpoint(&mesh);
    let mut cells = source(&gpu, &mesh, &[Placement::default()]);
    let without = drawn(&gpu, &mut cells, &view, &table);
    let empty = drawn(
        &gpu,
        &mut Combined::new(&mut cells).with_markers(None),
        &view,
        &table,
    );
    assert_eq!(without, empty);
    let radius = 6.0 * 0.7 * view.camera.pixel_at_target(f64::from(SIZE[1]));
    let settings = MarkerSettings {
        radius,
        ..MarkerSettings::default()
    };
    let mut markers = Markers::new(&gpu, &row(&view, key, 4), settings).expect("uploaded");
    let with = drawn(
        &gpu,
        &mut Combined::new(&mut cells).with_markers(Some(&mut markers)),
        &view,
        &table,
    );
    // Discs of six pixels' radius, whose edges are mixed with what is behind.
    for color in [[255, 0, 255], [0, 255, 0]] {
        let found = pixels_of(&with, color);
        assert!((2 * 80..2 * 125).contains(&found), "{found} pixels");
    }
    let changed = without.pixels.chunks(4).zip(with.pixels.chunks(4));
    let changed = changed.filter(|(a, b)| a != b).count();
    assert!(changed < 4 * 160, "{changed} pixels");
}

#[neurotess_testing::test(needs(gpu))]
fn contacts_are_discs_across_their_direction() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (table, key) = table(&mesh);
    let view = viewpoint(&mesh);
    let [right, _, backward] = view.camera.axes();
    let place = row(&view, key, 1)[0].position;
    let radius = 20.0 * 0.7 * view.camera.pixel_at_target(f64::from(SIZE[1]));
    let mut cells = source(&gpu, &mesh, &[]);
    let mut picture = |outwards: glam::Vec3, shape: MarkerShape| {
        let settings = MarkerSettings {
            shape,
            radius,
            ..MarkerSettings::default()
        };
        let marker = Marker {
            position: place,
            outwards,
            color_key: key,
        };
        let mut markers = Markers::new(&gpu, &[marker], settings).expect("uploaded");
        let mut both = Combined::new(&mut cells).with_markers(Some(&mut markers));
        drawn(&gpu, &mut both, &view, &table)
    };
    let covered = |image: &Image| {
        let is = |p: &&[u8]| p[..3] != [255; 3];
        image.pixels.chunks(4).filter(is).count() as f64
    };
    let sphere = picture(backward.as_vec3(), MarkerShape::Sphere);
    let one = covered(&sphere);
    // From above, a disc of twice the sphere's radius; from the side, the sphere and the disc's edge.
    let above = covered(&picture(backward.as_vec3(), MarkerShape::Contact)) / one;
    assert!((3.7..4.3).contains(&above), "{above} of the sphere");
    let aside = picture(right.as_vec3(), MarkerShape::Contact);
    let share = covered(&aside) / one;
    assert!((1.1..1.5).contains(&share), "{share} of the sphere");
    // Without a direction it stays a sphere; points are dots.
    assert_eq!(picture(glam::Vec3::ZERO, MarkerShape::Contact), sphere);
    let dot = covered(&picture(backward.as_vec3(), MarkerShape::Point));
    assert!((1.0..12.0).contains(&dot), "{dot} pixels");
}

#[neurotess_testing::test(needs(gpu))]
fn far_markers_keep_a_least_size_and_are_thinned_out_to_the_budget() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (_, key) = table(&mesh);
    let view = viewpoint(&mesh);
    let [right, up, _] = view.camera.axes();
    let pixel = view.camera.pixel_at_target(f64::from(SIZE[1]));
    // 100,000 within 60 by 60 pixels.
    let all: Vec<Marker> = (0..100_000_u32)
        .map(|i| {
            let [x, y] = [i % 316, i / 316].map(|n| (f64::from(n) / 316.0 - 0.5) * 60.0 * pixel);
            Marker {
                position: view.camera.target() + x * right + y * up,
                color_key: key,
                ..Marker::default()
            }
        })
        .collect();
    let settings = MarkerSettings {
        radius: 1e-6,
        least: 1.0,
        ..MarkerSettings::default()
    };
    let mut markers = Markers::new(&gpu, &all, settings).expect("uploaded");
    let frame = Frame::whole(view.camera, view.near, SIZE);
    let [shown, in_view] = markers.shown(&frame);
    assert_eq!(in_view, 100_000);
    // Some for each of 3,600 pixels, whatever their number.
    assert!((3_600..90_000).contains(&shown), "{shown}");
    markers.set_settings(MarkerSettings {
        most_triangles: 2_000,
        ..settings
    });
    let [shown, _] = markers.shown(&frame);
    assert!((1_000..1_100).contains(&shown), "{shown}");
    // They cover the square evenly.
    let (table, _) = table(&mesh);
    let mut cells = source(&gpu, &mesh, &[]);
    let image = drawn(
        &gpu,
        &mut Combined::new(&mut cells).with_markers(Some(&mut markers)),
        &view,
        &table,
    );
    let mut quarters = [0; 4];
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            if image.at(x, y) != [255; 4] {
                let [right, low] = [x >= SIZE[0] / 2, y >= SIZE[1] / 2].map(usize::from);
                quarters[right + 2 * low] += 1;
            }
        }
    }
    let covered: usize = quarters.iter().sum();
    assert!((1_500..3_600).contains(&covered), "{covered} pixels");
    let even = |part: &usize| (15 * covered..35 * covered).contains(&(100 * part));
    assert!(quarters.iter().all(even), "{quarters:?}");
    let away = Frame::whole(
        Camera::new(
            view.camera.eye(),
            view.camera.eye() + view.camera.axes()[2],
            DVec3::Y,
            0.5,
        )
        .expect("a camera"),
        view.near,
        SIZE,
    );
    assert_eq!(markers.shown(&away), [0, 0]);
}

#[neurotess_testing::test(needs(gpu))]
fn static_pictures_have_markers_too() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (mut table, key) = table(&mesh);
    let view = viewpoint(&mesh);
    let settings = MarkerSettings {
        radius: 3.0,
        ..MarkerSettings::default()
    };
    let mut cells = source(&gpu, &mesh, &[Placement::default()]);
    let mut markers = Markers::new(&gpu, &row(&view, key, 4), settings).expect("uploaded");
    let mut both = Combined::new(&mut cells).with_markers(Some(&mut markers));
    let picture = StillRenderer::new()
        .render_static(&gpu, &mut both, &view, &table, &options())
        .expect("a static picture");
    let last = table.categories.len() - 1;
    table.categories[last] = [0, 0, 255];
    let colors = KeyColors {
        table: &table,
        states: &[],
        values: None,
    };
    picture.recolor(&gpu, &colors).expect("recolored");
    let found = picture.image(&gpu).expect("read");
    let expected = drawn(&gpu, &mut both, &view, &table);
    let pixels = expected.pixels.iter().zip(&found.pixels);
    let worst = pixels.map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(2), "{worst:?} of 255");
    assert!(pixels_of(&found, [0, 0, 255]) > 20);
}

#[neurotess_testing::test(needs(gpu))]
fn markers_are_picked_and_what_is_beside_them_as_before() {
    let gpu = device();
    let mesh = mesh(CELL);
    let (_, key) = table(&mesh);
    let view = crate::renderer::view(&mesh);
    let viewpoint = Viewpoint {
        camera: view.camera,
        near: 0.1,
    };
    let mut cells = source(&gpu, &mesh, &[Placement::default()]);
    let all = row(&viewpoint, key, 4);
    let settings = MarkerSettings {
        radius: 1.5,
        ..MarkerSettings::default()
    };
    let mut markers = Markers::new(&gpu, &all, settings).expect("uploaded");
    let mut drawer = crate::renderer::renderer(&gpu, &mesh);
    let view = neurotess_render::ViewParams { near: 0.1, ..view };
    let before = crate::renderer::picks(&gpu, &mut drawer, &mut cells, &view);
    let mut both = Combined::new(&mut cells).with_markers(Some(&mut markers));
    drawer.identify(&gpu, &mut both, &view).expect("drawn");
    gpu.wait().expect("done");
    let (size, ids) = drawer.ids().expect("no fault").expect("arrived");
    let resolver = cells.resolver();
    for (index, marker) in all.iter().enumerate() {
        let at = view
            .camera
            .pixel_of(marker.position, size)
            .expect("in front");
        let [x, y] = at.map(|n| n as usize);
        let id = ids[y * size[0] as usize + x];
        assert_eq!(markers.picked(id), Some(index));
        assert_eq!(resolver.resolve(id), None, "it is no cell");
    }
    // Where no marker is, the cell is what it was.
    let beside = ids.iter().zip(&before);
    let beside = beside.filter(|(id, _)| markers.picked(**id).is_none());
    let mut found = 0;
    for (&id, before) in beside {
        assert_eq!(resolver.resolve(id), *before);
        found += usize::from(before.is_some());
    }
    assert!(found > 100, "{found} pixels");
}
