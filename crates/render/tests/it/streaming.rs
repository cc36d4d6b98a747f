//! Templates that do not fit the device: what shows is there, and pictures are those of scenes that fit.

use std::convert::Infallible;
use std::sync::Arc;

use crate::adapter::{device, gpu};
use crate::common::cell;
use glam::DVec3;
use neurotess_mesh::CoarseMesh;
use neurotess_render::color::{ColorTable, fraction};
use neurotess_render::pick::ProxyPickTargets;
use neurotess_render::{
    Camera, DeviceError, Exploration, Frame, Gpu, Image, Instance, Look, Occlusion, PictureOptions,
    Placement, ProgressiveRenderer, Proxy, TemplateId, VertexSource, ViewParams, Viewpoint,
    render_still,
};
use neurotess_testing::note;

/// Distance (µm) between two cells.
const APART: f64 = 1000.0;

/// Cells of their own, each with many colors.
struct Cells {
    proxies: Vec<Arc<Proxy>>,
    instances: Vec<Instance>,
    table: ColorTable,
}

impl Cells {
    /// A row of cells, each behind the other.
    fn row(count: u64) -> Self {
        let meshes: Vec<CoarseMesh> = (0..count).map(|seed| cell(seed, 120)).collect();
        let proxies = meshes.iter().map(|mesh| {
            // A color for every point, so that each detail has its own.
            let last = mesh.tracing.len() as f32;
            let color_keys = (0..mesh.tracing.len()).map(|point| fraction(point as f32 / last));
            Arc::new(Proxy::new(mesh, &color_keys.collect::<Vec<u32>>()))
        });
        let table = ColorTable {
            scale: vec![[20, 40, 220], [230, 30, 30], [30, 180, 40]],
            ..ColorTable::default()
        };
        let instances = (0..count).map(|index| Instance {
            placement: Placement {
                translation: DVec3::new(0.3, 0.0, -1.0) * APART * index as f64,
                ..Placement::default()
            },
            ..Instance::new(TemplateId(index as u32))
        });
        Self {
            proxies: proxies.collect(),
            instances: instances.collect(),
            table,
        }
    }

    fn bytes(&self) -> u64 {
        self.proxies.iter().map(|proxy| proxy.bytes()).sum()
    }

    /// With this memory (bytes) for templates.
    fn within(&self, gpu: &Gpu, memory: Option<u64>) -> Result<Exploration, DeviceError> {
        let mut source = Exploration::new(gpu, 1)?;
        source.add_streamed(gpu, &self.proxies, memory)?;
        let placed = source.set_instances(gpu, self.instances.clone());
        placed.expect("instances of what was added");
        Ok(source)
    }

    fn picture(&self, gpu: &Gpu, source: &mut Exploration, camera: &Camera) -> Image {
        let options = PictureOptions {
            size: SIZE,
            samples: 4,
            occlusion: Occlusion::Off,
            ..PictureOptions::default()
        };
        let viewpoint = Viewpoint {
            camera: *camera,
            near: NEAR,
        };
        let mut whole = Image::default();
        let take = |_: u32, band: Image| {
            whole = band;
            Ok::<(), Infallible>(())
        };
        render_still(gpu, source, &viewpoint, &self.table, &options, take).expect("drawn");
        whole
    }
}

const SIZE: [u32; 2] = [400, 300];
const NEAR: f64 = 1.0;

/// A camera in front of one of the cells of a row, by their distance.
fn in_front_of(cell: f64) -> Camera {
    let target = DVec3::new(0.3, 0.0, -1.0) * APART * cell;
    let eye = target + DVec3::new(12.0, 6.0, 70.0);
    Camera::new(eye, target, DVec3::Y, 0.7).expect("a camera")
}

/// Bytes of templates on the device.
fn resident(source: &Exploration) -> u64 {
    let templates = ["chunks", "points", "color_keys"];
    let bytes = source.bytes().into_iter();
    let bytes = bytes.filter(|(name, _)| templates.contains(name));
    bytes.map(|(_, bytes)| bytes).sum()
}

#[neurotess_testing::test(needs(gpu))]
fn what_is_streamed_is_drawn_as_if_all_were_there() {
    let gpu = device();
    let cells = Cells::row(24);
    // Enough for what shows.
    let memory = cells.bytes() * 3 / 4;
    let mut whole = cells.within(&gpu, None).expect("fits");
    let mut streamed = cells.within(&gpu, Some(memory)).expect("fits in part");
    assert_eq!(whole.stats(&gpu).expect("counted").streamed, None);
    assert!(resident(&streamed) <= memory);
    // Forth and back, so that details go and come again.
    for place in [0.0, 2.0, 9.0, 16.0, 23.0, 3.0, 0.0] {
        let camera = in_front_of(place);
        let expected = cells.picture(&gpu, &mut whole, &camera);
        let image = cells.picture(&gpu, &mut streamed, &camera);
        let drawn = whole.stats(&gpu).expect("counted");
        let stats = streamed.stats(&gpu).expect("counted");
        let there = stats.streamed.expect("not all fits");
        note!("at {place}: {there:?}");
        assert!(
            there.whole >= 1 && there.finer < there.templates,
            "{there:?}"
        );
        assert_eq!(
            (stats.triangles, stats.requested),
            (drawn.triangles, drawn.requested)
        );
        assert!(image == expected, "to the bit, at {place}");
        assert!(!streamed.is_pending());
        assert!(resident(&streamed) <= memory);
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn what_shows_most_is_there_first_where_memory_is_short() {
    let gpu = device();
    let cells = Cells::row(24);
    let all = cells.bytes();
    let mut whole = cells.within(&gpu, None).expect("fits");
    let (mut before, mut most) = (f64::MAX, cells.proxies.len());
    for memory in [all / 40, all / 8, all / 2] {
        let mut streamed = cells.within(&gpu, Some(memory)).expect("fits in part");
        let camera = in_front_of(6.0);
        let expected = cells.picture(&gpu, &mut whole, &camera);
        let image = cells.picture(&gpu, &mut streamed, &camera);
        assert!(
            resident(&streamed) <= memory,
            "{} {memory}",
            resident(&streamed)
        );
        let off = image.pixels.iter().zip(&expected.pixels);
        let off: f64 = off.map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
        let off = off / image.pixels.len() as f64;
        let there = streamed.stats(&gpu).expect("counted").streamed;
        let coarser = there.expect("not all fits").coarser;
        assert!(coarser > 0 && coarser < most, "fewer and fewer: {coarser}");
        most = coarser;
        note!("{memory} of {all} bytes: {off:.3} of 255 off in the mean, {there:?}");
        assert!(off < before, "the more memory, the finer: {off} {before}");
        before = off;
    }
    assert!(
        before < 0.05,
        "half of the memory is enough for half of the cells"
    );
    let refused = cells.within(&gpu, Some(2000)).map(drop);
    let why = refused.expect_err("too little for anything").to_string();
    assert!(
        why.contains("bytes at least, but there are") && why.contains("allow more"),
        "{why}"
    );
}

#[neurotess_testing::test(needs(gpu))]
fn uploads_are_spread_over_pictures() {
    let gpu = device();
    let cells = Cells::row(24);
    let memory = cells.bytes() * 4 / 5;
    let mut at_once = cells.within(&gpu, Some(memory)).expect("fits in part");
    let mut spread = cells.within(&gpu, Some(memory)).expect("fits in part");
    spread.set_most_upload(Some(1));
    let frame = Frame::whole(in_front_of(1.0), NEAR, SIZE);
    at_once.prepare(&gpu, &frame).expect("prepared");
    assert!(!at_once.is_pending());
    let expected = at_once.stats(&gpu).expect("counted");
    let wanted = expected.streamed.expect("not all fits");
    for pictures in 1.. {
        spread.prepare(&gpu, &frame).expect("prepared");
        let there = spread
            .stats(&gpu)
            .expect("counted")
            .streamed
            .expect("not all fits");
        assert!(there.finer <= pictures, "one with each picture");
        if !spread.is_pending() {
            assert_eq!(there, wanted);
            break;
        }
        assert!(there.finer == pictures && pictures < 24, "{there:?}");
    }
    assert_eq!(spread.stats(&gpu).expect("counted"), expected);
    // Nothing is uploaded for the same picture.
    spread.prepare(&gpu, &frame).expect("prepared");
    assert_eq!(spread.stats(&gpu).expect("counted"), expected);
}

#[neurotess_testing::test(needs(gpu))]
fn hidden_cells_and_those_beside_the_picture_need_no_memory() {
    let gpu = device();
    let cells = Cells::row(12);
    let memory = cells.bytes() * 4 / 5;
    let mut source = cells.within(&gpu, Some(memory)).expect("fits in part");
    let finer = |source: &mut Exploration, camera: Camera| {
        let frame = Frame::whole(camera, NEAR, SIZE);
        source.prepare(&gpu, &frame).expect("prepared");
        let streamed = source.stats(&gpu).expect("counted").streamed;
        streamed.expect("not all fits").finer
    };
    let away = Camera::new(DVec3::Z * 200.0, DVec3::Z * 400.0, DVec3::Y, 0.7).expect("a camera");
    assert_eq!(finer(&mut source, away), 0);
    for index in 0..12 {
        source.set_hidden(index, true);
    }
    assert_eq!(finer(&mut source, in_front_of(0.0)), 0);
    source.set_hidden(0, false);
    assert_eq!(
        finer(&mut source, in_front_of(0.0)),
        1,
        "the one that shows"
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn picked_points_are_those_of_the_tracing() {
    let gpu = device();
    let cells = Cells::row(24);
    let memory = cells.bytes() * 4 / 5;
    let targets: Arc<[ProxyPickTargets]> = cells
        .proxies
        .iter()
        .map(|proxy| ProxyPickTargets::new(proxy))
        .collect();
    let mut seen = Vec::new();
    for memory in [None, Some(memory)] {
        let mut source = cells.within(&gpu, memory).expect("fits in part");
        let mut renderer = ProgressiveRenderer::new(&gpu);
        renderer.set_colors(cells.table.clone());
        let mut hits = Vec::new();
        for place in [20.0, 0.0] {
            let view = ViewParams {
                camera: in_front_of(place),
                near: NEAR,
                size: SIZE,
                look: Look::default(),
                occlusion: Occlusion::Off,
                background: [255; 3],
                frozen: None,
            };
            renderer.identify(&gpu, &mut source, &view).expect("drawn");
            let resolver = source.resolver(Arc::clone(&targets));
            gpu.wait().expect("done");
            let (_, ids) = renderer.ids().expect("no fault").expect("arrived");
            hits.extend(ids.into_iter().map(|id| resolver.resolve(id)));
        }
        seen.push(hits);
    }
    let known = seen[0].iter().flatten().count();
    note!("{known} pixels");
    assert!(known > 1000);
    let differ = seen[0].iter().zip(&seen[1]).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "pixels that name something else");
}
