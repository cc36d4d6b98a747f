//! Pictures for windows: as saved ones, whatever the slices; ids name what is seen.
mod pictured;

use glam::{DQuat, DVec3};
use neurotess_mesh::{CoarseMesh, PatchKind, Role};
use neurotess_refine::LodCriterion;
use neurotess_render::{
    Adaptive, AdaptiveSettings, Camera, Clip, Exploration, Gpu, Image, Instance, Look, OUTLINED,
    Occlusion, Outlines, PickHit, PickTarget, PictureOptions, Placement, ProgressiveRenderer,
    Proxy, ProxyPickTargets, Scene, Steps, Template, Templates, VertexSource, ViewParams,
    WITHOUT_NEURITES, WITHOUT_SOMA, paint,
};
use pictured::{CELL, by_type, camera, gpu, mesh, spheres};

const SIZE: [u32; 2] = [200, 260];

fn source(gpu: &Gpu, mesh: &CoarseMesh, instances: &[Placement]) -> Adaptive {
    let (color_keys, _) = by_type(mesh);
    let mut templates = Templates::new();
    let template = Template {
        mesh,
        color_keys: &color_keys,
        values: &[],
    };
    let ids = templates.add(gpu, &[template]).expect("uploaded");
    let instances = instances.iter().map(|&placement| Instance {
        placement,
        ..Instance::new(ids[0])
    });
    let scene = Scene::new(templates, instances.collect()).expect("a scene");
    Adaptive::new(gpu, scene, AdaptiveSettings::default(), 1).expect("a source")
}

fn shot(mesh: &CoarseMesh) -> ViewParams {
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

fn live(gpu: &Gpu, mesh: &CoarseMesh) -> ProgressiveRenderer {
    let mut live = ProgressiveRenderer::new(gpu);
    live.set_colors(by_type(mesh).1);
    live
}

/// The texture's pixels; their width must be a multiple of 64.
fn pixels(gpu: &Gpu, live: &ProgressiveRenderer) -> Image {
    let texture = live.texture().expect("a picture");
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

fn picture(
    gpu: &Gpu,
    live: &mut ProgressiveRenderer,
    source: &mut Adaptive,
    shot: ViewParams,
    steps: Steps,
) -> Image {
    live.begin(shot, steps);
    while live.progress().is_some() {
        live.slice(gpu, source).expect("drawn");
    }
    pixels(gpu, live)
}

/// Mean difference of bytes.
fn difference(a: &Image, b: &Image) -> f64 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let sum: u64 = a
        .pixels
        .iter()
        .zip(&b.pixels)
        .map(|(a, b)| u64::from(a.abs_diff(*b)))
        .sum();
    sum as f64 / a.pixels.len() as f64
}

fn named(
    gpu: &Gpu,
    live: &mut ProgressiveRenderer,
    source: &mut Adaptive,
    shot: &ViewParams,
) -> Vec<Option<PickHit>> {
    live.identify(gpu, source, shot).expect("drawn");
    let namer = source.namer();
    gpu.wait().expect("done");
    let (size, ids) = live.ids().expect("no fault").expect("arrived");
    assert_eq!(size, shot.size);
    assert!(live.ids().expect("no fault").is_none(), "handed over once");
    ids.into_iter().map(|id| namer.name(id)).collect()
}

/// Whether a soma is named.
fn is_soma(mesh: &CoarseMesh, name: &PickHit) -> bool {
    match name.spot {
        PickTarget::Patch(patch) => mesh.patches[patch as usize].kind == PatchKind::Soma,
        PickTarget::Vertex(vertex) => {
            let tracing = mesh.vertices[vertex as usize].tracing;
            mesh.tracing[tracing as usize].role == Role::Soma
        }
        PickTarget::Point(_) => false,
        PickTarget::Soma(_) => true,
    }
}

#[test]
fn a_picture_at_rest_is_as_a_saved_one() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let shot = shot(&mesh);
    let mut made = source(&gpu, &mesh, &[Placement::default()]);
    let mut live = live(&gpu, &mesh);
    let steps = Steps {
        steps: 4,
        slices: 1,
    };
    let shown = picture(&gpu, &mut live, &mut made, shot, steps);
    let mut saved = Image::default();
    let options = PictureOptions {
        size: SIZE,
        ..PictureOptions::default()
    };
    let table = by_type(&mesh).1;
    paint(
        &gpu,
        &mut made,
        &shot.camera,
        shot.near,
        &table,
        &options,
        |_, band| {
            saved = band;
            Ok::<(), std::convert::Infallible>(())
        },
    )
    .expect("painted");
    let empty = Image {
        pixels: vec![255; saved.pixels.len()],
        ..saved.clone()
    };
    assert!(difference(&empty, &saved) > 3.0, "something is there");
    assert!(
        difference(&shown, &saved) < 0.6,
        "{}",
        difference(&shown, &saved)
    );
}

#[test]
fn slices_change_nothing() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let mut made = source(&gpu, &mesh, &[Placement::default()]);
    let mut live = live(&gpu, &mesh);
    let mut with = |slices| {
        let steps = Steps { steps: 4, slices };
        picture(&gpu, &mut live, &mut made, shot(&mesh), steps)
    };
    let whole = with(1);
    assert_eq!(difference(&whole, &with(7)), 0.0);
}

#[test]
fn a_lod_that_is_kept_changes_nothing() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let mut anew = source(&gpu, &mesh, &[Placement::default()]);
    let mut kept = source(&gpu, &mesh, &[Placement::default()]);
    kept.set_keeping(true);
    let mut live = live(&gpu, &mesh);
    let steps = Steps {
        steps: 4,
        slices: 3,
    };
    let mut turned = shot(&mesh);
    turned.camera = turned.camera.turned(0.7);
    let coarse = AdaptiveSettings {
        lod: LodCriterion::Homogeneous(1),
        ..AdaptiveSettings::default()
    };
    let moved = Placement {
        translation: DVec3::Y * 4.0,
        ..Placement::default()
    };
    // Another view, another way of settings, another scene, ids between: each is noticed.
    for change in 0..4 {
        for source in [&mut anew, &mut kept] {
            match change {
                2 => source.set_settings(coarse),
                3 => {
                    let (templates, mut instances) = source.take_scene().into_parts();
                    instances[0].placement = moved;
                    source.set_scene(Scene::new(templates, instances).expect("a scene"));
                }
                _ => {}
            }
        }
        let shot = if change == 0 { shot(&mesh) } else { turned };
        let wanted = picture(&gpu, &mut live, &mut anew, shot, steps);
        let first = picture(&gpu, &mut live, &mut kept, shot, steps);
        assert_eq!(difference(&wanted, &first), 0.0, "change {change}");
        named(&gpu, &mut live, &mut kept, &shot);
        let again = picture(&gpu, &mut live, &mut kept, shot, steps);
        assert_eq!(difference(&wanted, &again), 0.0, "change {change}");
    }
}

#[test]
fn a_draft_shows_the_same_cell() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let mut made = source(&gpu, &mesh, &[Placement::default()]);
    let mut live = live(&gpu, &mesh);
    let fine = picture(
        &gpu,
        &mut live,
        &mut made,
        shot(&mesh),
        Steps {
            steps: 4,
            slices: 1,
        },
    );
    live.draft(&gpu, &mut made, &shot(&mesh)).expect("drawn");
    assert!(live.shows_draft() && live.progress().is_none());
    let apart = difference(&fine, &pixels(&gpu, &live));
    assert!(apart > 0.0 && apart < 3.0, "{apart}");
}

/// Number of pixels that are nearly of a color, left and right of the middle.
fn of_color(image: &Image, color: [u8; 3]) -> [usize; 2] {
    let near = |p: &[u8]| (0..3).all(|k| p[k].abs_diff(color[k]) < 40);
    let mut counts = [0; 2];
    for (i, pixel) in image.pixels.chunks(4).enumerate() {
        let right = i % image.width as usize >= image.width as usize / 2;
        counts[usize::from(right)] += usize::from(near(pixel));
    }
    counts
}

#[test]
fn drafts_have_outlines_round_what_is_outlined() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let aside = |x: f64| Placement {
        translation: DVec3::X * x,
        scale: 0.4,
        ..Placement::default()
    };
    // The picture's middle is at -9 µm.
    let both = [aside(-23.0), aside(5.0)];
    let mut refined = source(&gpu, &mesh, &both);
    let (color_keys, _) = by_type(&mesh);
    let mut explored = Exploration::new(&gpu, 1).expect("a source");
    let ids = explored
        .add(&gpu, &[Proxy::new(&mesh, &color_keys)])
        .expect("added");
    let instance = |&placement: &Placement| Instance {
        placement,
        ..Instance::new(ids[0])
    };
    explored
        .set_instances(&gpu, both.iter().map(instance).collect())
        .expect("placed");
    let orange = [255, 140, 0];
    let outlines = Outlines {
        width: 1,
        selected: orange,
        ..Outlines::default()
    };
    let sources: [&mut dyn VertexSource; 2] = [&mut refined, &mut explored];
    for (which, source) in sources.into_iter().enumerate() {
        let mut live = live(&gpu, &mesh);
        live.set_outlines(&gpu, outlines, None);
        let mut drawn = |states: [u32; 2]| {
            live.set_states(states.to_vec());
            live.draft(&gpu, source, &shot(&mesh)).expect("drawn");
            of_color(&pixels(&gpu, &live), orange)
        };
        assert_eq!(drawn([0, 0]), [0, 0], "source {which}");
        let [left, right] = drawn([0, OUTLINED]);
        assert!(left == 0 && right > 100, "source {which}: {left} {right}");
        let [left, right] = drawn([OUTLINED, 0]);
        assert!(left > 100 && right == 0, "source {which}: {left} {right}");
    }
}

#[test]
fn levels_frozen_for_the_same_camera_change_nothing() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let mut made = source(&gpu, &mesh, &[Placement::default()]);
    let mut live = live(&gpu, &mesh);
    let shot = shot(&mesh);
    let steps = Steps {
        steps: 1,
        slices: 1,
    };
    let free = picture(&gpu, &mut live, &mut made, shot, steps);
    let turned = ViewParams {
        camera: shot.camera.turned(0.5),
        ..shot
    };
    let other = picture(&gpu, &mut live, &mut made, turned, steps);
    let frozen = ViewParams {
        frozen: Some((shot.camera.turned(0.5), shot.near)),
        ..shot
    };
    let frozen = picture(&gpu, &mut live, &mut made, frozen, steps);
    assert!(difference(&free, &other) > 2.0);
    assert!(
        difference(&free, &frozen) < 0.6,
        "{}",
        difference(&free, &frozen)
    );
}

#[test]
fn ids_name_the_instance_and_the_patch_at_a_pixel() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let aside = Placement {
        translation: DVec3::X * 14.0,
        rotation: DQuat::from_rotation_y(0.3),
        ..Placement::default()
    };
    let mut made = source(&gpu, &mesh, &[Placement::default(), aside]);
    let mut live = live(&gpu, &mesh);
    let shot = shot(&mesh);
    let names = named(&gpu, &mut live, &mut made, &shot);
    let at = |place: DVec3| {
        let [x, y] = shot.camera.pixel_of(place, SIZE).expect("in front");
        names[y as usize * SIZE[0] as usize + x as usize]
    };
    let soma = at(DVec3::new(-1.0, 0.0, 0.0)).expect("the first soma");
    assert_eq!(soma.instance, 0);
    assert!(is_soma(&mesh, &soma));
    assert_eq!(at(DVec3::X * 15.0).expect("the second soma").instance, 1);
    assert_eq!(names[0], None);
    // Every pixel of a tube lies near the tracing points of the patch that it names.
    let mut tubes = 0;
    for (pixel, name) in names.iter().enumerate() {
        let Some(name) = name.filter(|name| name.instance == 0) else {
            continue;
        };
        if is_soma(&mesh, &name) {
            continue;
        }
        tubes += 1;
        let [x, y] = [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize].map(|n| n as f64);
        // Of a flat patch a vertex is named: one of its corners, however long it is.
        let corners: Vec<_> = match name.spot {
            PickTarget::Patch(patch) => mesh.patches[patch as usize].corners.to_vec(),
            PickTarget::Vertex(vertex) => {
                let around = mesh.patches.iter().filter(|p| p.corners.contains(&vertex));
                around.flat_map(|p| p.corners).collect()
            }
            PickTarget::Point(_) | PickTarget::Soma(_) => panic!("names of exploration"),
        };
        let corners = corners.iter().map(|&v| &mesh.vertices[v as usize]);
        let reach: Vec<[f64; 2]> = corners
            .map(|v| {
                let place = mesh.origin + v.position.as_dvec3();
                shot.camera.pixel_of(place, SIZE).expect("in front")
            })
            .collect();
        let (low, high) = reach
            .iter()
            .fold(([f64::MAX; 2], [f64::MIN; 2]), |(l, h), p| {
                (
                    [l[0].min(p[0]), l[1].min(p[1])],
                    [h[0].max(p[0]), h[1].max(p[1])],
                )
            });
        let inside = |v: f64, k: usize| v > low[k] - 8.0 && v < high[k] + 8.0;
        assert!(inside(x, 0) && inside(y, 1), "{x} {y} {reach:?}");
    }
    assert!(tubes > 300, "{tubes}");
}

#[test]
fn states_and_cuts_leave_out_what_they_say() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let mut made = source(&gpu, &mesh, &[Placement::default()]);
    let mut live = live(&gpu, &mesh);
    let mut kinds = |state: u32, clip: Option<Clip>| {
        live.set_states(vec![state]);
        let mut shot = shot(&mesh);
        shot.look.clip = clip;
        let names = named(&gpu, &mut live, &mut made, &shot);

        let somata = names.iter().flatten().filter(|name| is_soma(&mesh, name));
        (somata.count(), names.iter().flatten().count())
    };
    let (soma, all) = kinds(0, None);
    assert!(soma > 100 && all > soma);
    let only_soma = kinds(WITHOUT_NEURITES, None);
    assert!(only_soma.0 >= soma && only_soma.0 == only_soma.1);
    let (rest, neurites) = kinds(WITHOUT_SOMA, None);
    assert!(
        rest < 8 && neurites > 200,
        "only quads between rings: {rest} {neurites}"
    );
    let upper = Clip {
        // The soma is pulled out to 6.75 µm.
        point: DVec3::Y * 8.0,
        normal: DVec3::Y,
    };
    let (no_soma, some) = kinds(0, Some(upper));
    assert!(no_soma == 0 && some > 50 && some < all, "{no_soma} {some}");
}

#[test]
fn a_replaced_template_shows_its_new_mesh() {
    let Some(gpu) = gpu() else { return };
    let first = mesh(CELL);
    let thick = mesh(&CELL.replace("0 0 0 5 -1", "0 0 0 8 -1"));
    let mut made = source(&gpu, &first, &[Placement::default()]);
    let mut live = live(&gpu, &first);
    let seen = |names: Vec<Option<PickHit>>| names.iter().flatten().count();
    let before = seen(named(&gpu, &mut live, &mut made, &shot(&first)));
    let mut scene = made.take_scene();
    let color_keys = by_type(&thick).0;
    let template = Template {
        mesh: &thick,
        color_keys: &color_keys,
        values: &[],
    };
    let id = scene.instances()[0].template;
    for _ in 0..3 {
        scene.replace(&gpu, id, &template).expect("uploaded");
    }
    made.set_scene(scene);
    let after = seen(named(&gpu, &mut live, &mut made, &shot(&first)));
    assert!(after > before + 50, "{before} {after}");
}

#[test]
fn nothing_is_drawn_of_an_empty_scene() {
    let Some(gpu) = gpu() else { return };
    let scene = Scene::new(Templates::new(), Vec::new()).expect("empty");
    let mut made = Adaptive::new(&gpu, scene, AdaptiveSettings::default(), 1).expect("a source");
    let mesh = mesh(CELL);
    let mut live = live(&gpu, &mesh);
    let camera = Camera::new(DVec3::Z, DVec3::ZERO, DVec3::Y, 0.5).expect("a camera");
    let shot = ViewParams {
        camera,
        near: 0.1,
        size: [1, 1],
        ..shot(&mesh)
    };
    let shown = picture(
        &gpu,
        &mut live,
        &mut made,
        shot,
        Steps {
            steps: 16,
            slices: 4,
        },
    );
    assert_eq!(shown.pixels, [255; 4]);
}

#[test]
fn ids_of_exploration_name_what_those_of_patches_do() {
    let Some(gpu) = gpu() else { return };
    let mesh = mesh(CELL);
    let both = [
        Placement::default(),
        Placement {
            translation: DVec3::X * 14.0,
            ..Placement::default()
        },
    ];
    let mut refined = source(&gpu, &mesh, &both);
    let mut live = live(&gpu, &mesh);
    let shot = shot(&mesh);
    let patches = named(&gpu, &mut live, &mut refined, &shot);
    let proxy = Proxy::new(&mesh, &[]);
    let names = [ProxyPickTargets::default(), ProxyPickTargets::new(&proxy)];
    let mut explored = Exploration::new(&gpu, 1).expect("a source");
    // Of another template before it there are runs too.
    let ids = explored.add(&gpu, &[proxy.clone(), proxy]).expect("added");
    let instance = |&placement: &Placement| Instance {
        placement,
        ..Instance::new(ids[1])
    };
    let instances = both.iter().map(instance).collect();
    explored.set_instances(&gpu, instances).expect("placed");
    live.identify(&gpu, &mut explored, &shot).expect("drawn");
    let namer = explored.namer(names.into());
    gpu.wait().expect("done");
    let (_, ids) = live.ids().expect("no fault").expect("arrived");
    let pieces = ids.into_iter().map(|id| namer.name(id));
    let section = |name: &PickHit| match name.spot {
        _ if is_soma(&mesh, name) => 0,
        PickTarget::Point(point) | PickTarget::Soma(point) => mesh.tracing[point as usize].section,
        PickTarget::Patch(patch) => {
            let corner = mesh.patches[patch as usize].corners[2];
            mesh.tracing[mesh.vertices[corner as usize].tracing as usize].section
        }
        PickTarget::Vertex(vertex) => {
            mesh.tracing[mesh.vertices[vertex as usize].tracing as usize].section
        }
    };
    let known = patches.iter().filter(|name| name.is_some()).count();
    let both = patches.iter().zip(pieces);
    let both: Vec<_> = both.filter_map(|(a, b)| Some(((*a)?, b?))).collect();
    let same = |(a, b): &&(PickHit, PickHit)| a.instance == b.instance && section(a) == section(b);
    let same = both.iter().filter(same).count();
    println!("{known} pixels, {} in both, {same} the same", both.len());
    assert!(known > 1000 && 10 * both.len() > 9 * known);
    assert!(10 * same > 9 * both.len());
}
