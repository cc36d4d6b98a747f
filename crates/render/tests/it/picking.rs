//! Ids name what is seen at a pixel: the instance, and what of it.

use crate::adapter::{device, gpu};
use crate::pictured::{CELL, by_type, mesh, spheres};
use crate::renderer::{SIZE, picks, renderer, source, view};
use glam::{DQuat, DVec3};
use neurotess_mesh::{CoarseMesh, PatchKind, Role, SectionNumber};
use neurotess_render::pick::{PickHit, PickTarget, ProxyPickTargets};
use neurotess_render::state::{WITHOUT_NEURITES, WITHOUT_SOMA};
use neurotess_render::{
    Clip, Exploration, Instance, Placement, Projection, Proxy, Template, ViewParams,
};
use neurotess_testing::note;

/// Whether it is a soma.
fn is_soma(mesh: &CoarseMesh, hit: &PickHit) -> bool {
    match hit.target {
        PickTarget::Patch(patch) => mesh.patches[patch as usize].kind == PatchKind::Soma,
        PickTarget::Vertex(vertex) => {
            let tracing = mesh.vertices[vertex as usize].tracing;
            mesh.tracing[tracing as usize].role == Role::Soma
        }
        PickTarget::Point(_) => false,
        PickTarget::Soma(_) => true,
    }
}

#[neurotess_testing::test(needs(gpu))]
fn ids_name_the_instance_and_the_patch_at_a_pixel() {
    let gpu = device();
    let mesh = mesh(CELL);
    let aside = Placement {
        translation: DVec3::X * 14.0,
        rotation: DQuat::from_rotation_y(0.3),
        ..Placement::default()
    };
    let mut source = source(&gpu, &mesh, &[Placement::default(), aside]);
    let mut renderer = renderer(&gpu, &mesh);
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let mut view = view(&mesh);
        view.camera = view.camera.with_projection(projection);
        view.near = view.camera.near(&spheres(&mesh));
        let hits = picks(&gpu, &mut renderer, &mut source, &view);
        check_ids(&mesh, &view, &hits);
    }
}

fn check_ids(mesh: &CoarseMesh, view: &ViewParams, hits: &[Option<PickHit>]) {
    let at = |position: DVec3| {
        let [x, y] = view.camera.pixel_of(position, SIZE).expect("in front");
        hits[y as usize * SIZE[0] as usize + x as usize]
    };
    let soma = at(DVec3::new(-1.0, 0.0, 0.0)).expect("the first soma");
    assert_eq!(soma.instance, 0);
    assert!(is_soma(mesh, &soma));
    assert_eq!(at(DVec3::X * 15.0).expect("the second soma").instance, 1);
    assert_eq!(hits[0], None);
    // Every pixel of a tube lies near the corners of the patch that its id names.
    let mut tubes = 0;
    for (pixel, hit) in hits.iter().enumerate() {
        let Some(hit) = hit.filter(|hit| hit.instance == 0) else {
            continue;
        };
        if is_soma(mesh, &hit) {
            continue;
        }
        tubes += 1;
        let [x, y] = [pixel % SIZE[0] as usize, pixel / SIZE[0] as usize].map(|n| n as f64);
        // For a flat patch the hit is a vertex: one of its corners, however long it is.
        let corners: Vec<_> = match hit.target {
            PickTarget::Patch(patch) => mesh.patches[patch as usize].corners.to_vec(),
            PickTarget::Vertex(vertex) => {
                let around = mesh.patches.iter().filter(|p| p.corners.contains(&vertex));
                around.flat_map(|p| p.corners).collect()
            }
            PickTarget::Point(_) | PickTarget::Soma(_) => panic!("hits of exploration"),
        };
        let corners = corners.iter().map(|&v| &mesh.vertices[v as usize]);
        let reach: Vec<[f64; 2]> = corners
            .map(|v| {
                let position = mesh.origin + v.position.as_dvec3();
                view.camera.pixel_of(position, SIZE).expect("in front")
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

#[neurotess_testing::test(needs(gpu))]
fn states_and_cuts_leave_out_what_they_say() {
    let gpu = device();
    let mesh = mesh(CELL);
    let mut source = source(&gpu, &mesh, &[Placement::default()]);
    let mut renderer = renderer(&gpu, &mesh);
    let mut kinds = |state: u32, clip: Option<Clip>| {
        renderer.set_states(vec![state]);
        let mut view = view(&mesh);
        view.look.clip = clip;
        let hits = picks(&gpu, &mut renderer, &mut source, &view);

        let somata = hits.iter().flatten().filter(|hit| is_soma(&mesh, hit));
        (somata.count(), hits.iter().flatten().count())
    };
    let (soma, all) = kinds(0, None);
    assert!(soma > 100 && all > soma);
    let only_soma = kinds(WITHOUT_NEURITES, None);
    assert!(
        only_soma.0 >= soma && only_soma.1 < only_soma.0 + 8,
        "but for quads between rings: {soma} {only_soma:?}"
    );
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

#[neurotess_testing::test(needs(gpu))]
fn a_replaced_template_shows_its_new_mesh() {
    let gpu = device();
    let first = mesh(CELL);
    let thick = mesh(&CELL.replace("0 0 0 5 -1", "0 0 0 8 -1"));
    let mut source = source(&gpu, &first, &[Placement::default()]);
    let mut renderer = renderer(&gpu, &first);
    let seen = |hits: Vec<Option<PickHit>>| hits.iter().flatten().count();
    let before = seen(picks(&gpu, &mut renderer, &mut source, &view(&first)));
    let mut scene = source.take_scene();
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
    source.set_scene(scene);
    let after = seen(picks(&gpu, &mut renderer, &mut source, &view(&first)));
    assert!(after > before + 50, "{before} {after}");
}

#[neurotess_testing::test(needs(gpu))]
fn ids_of_exploration_name_what_those_of_patches_do() {
    let gpu = device();
    let mesh = mesh(CELL);
    let both = [
        Placement::default(),
        Placement {
            translation: DVec3::X * 14.0,
            ..Placement::default()
        },
    ];
    let mut refined = source(&gpu, &mesh, &both);
    let mut renderer = renderer(&gpu, &mesh);
    let view = view(&mesh);
    let patches = picks(&gpu, &mut renderer, &mut refined, &view);
    let proxy = Proxy::new(&mesh, &[]);
    let hits = [ProxyPickTargets::default(), ProxyPickTargets::new(&proxy)];
    let mut explored = Exploration::new(&gpu, 1).expect("a source");
    // Of another template before it there are chunks too.
    let ids = explored.add(&gpu, &[proxy.clone(), proxy]).expect("added");
    let instance = |&placement: &Placement| Instance {
        placement,
        ..Instance::new(ids[1])
    };
    let instances = both.iter().map(instance).collect();
    explored.set_instances(&gpu, instances).expect("placed");
    renderer
        .identify(&gpu, &mut explored, &view)
        .expect("drawn");
    let resolver = explored.resolver(hits.into());
    gpu.wait().expect("done");
    let (_, ids) = renderer.ids().expect("no fault").expect("arrived");
    let chunks = ids.into_iter().map(|id| resolver.resolve(id));
    let section = |hit: &PickHit| match hit.target {
        _ if is_soma(&mesh, hit) => SectionNumber::SOMA,
        PickTarget::Point(point) | PickTarget::Soma(point) => mesh.tracing[point as usize].section,
        PickTarget::Patch(patch) => {
            let corner = mesh.patches[patch as usize].corners[2];
            mesh.tracing[mesh.vertices[corner as usize].tracing as usize].section
        }
        PickTarget::Vertex(vertex) => {
            mesh.tracing[mesh.vertices[vertex as usize].tracing as usize].section
        }
    };
    let known = patches.iter().filter(|hit| hit.is_some()).count();
    let both = patches.iter().zip(chunks);
    let both: Vec<_> = both.filter_map(|(a, b)| Some(((*a)?, b?))).collect();
    let same = |(a, b): &&(PickHit, PickHit)| a.instance == b.instance && section(a) == section(b);
    let same = both.iter().filter(same).count();
    note!("{known} pixels, {} in both, {same} the same", both.len());
    assert!(known > 1000 && 10 * both.len() > 9 * known);
    assert!(10 * same > 9 * both.len());
}
