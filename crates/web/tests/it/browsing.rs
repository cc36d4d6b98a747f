//! Pages in a browser: the same surface, the same picture and the same answers as the library's.

use std::io::Write;
use std::process::Command;

use glam::DVec3;
use neurotess_color::{ColorBy, coloring};
use neurotess_mesh::{CoarseMesh, Format, Role, check, read_bytes, write};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_render::bounds::bounds;
use neurotess_render::color::ColorTable;
use neurotess_render::pick::{PickHit, PickTarget};
use neurotess_render::{
    Adaptive, AdaptiveSettings, BoundingSphere, Camera, Gpu, Image, Instance, Light, Look,
    Occlusion, PictureOptions, ProgressiveRenderer, Scene, Template, Templates, ViewParams,
    Viewpoint, render_still,
};
use neurotess_testing::full;
use serde_json::Value;

use crate::browser::{Browser, chromium};
use crate::unpacked::base64;
use crate::written::{Meshed, page_of, scheme};

const SIZE: [u32; 2] = [320, 240];

/// The need of tests that draw with the library, too.
fn gpu() -> Result<(), String> {
    let missing = || "no graphics adapter was found".to_owned();
    let adapters = neurotess_render::adapter::adapters();
    adapters.first().map(drop).ok_or_else(missing)
}

/// A page in a browser, and the cell in it.
struct Opened {
    browser: Browser,
    cell: Meshed,
    _folder: tempfile::TempDir,
}

fn opened(hash: &str) -> Opened {
    opened_with(Meshed::sample("granule"), hash)
}

fn opened_with(cell: Meshed, hash: &str) -> Opened {
    let (cell, page) = page_of(cell);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    let mut to = std::fs::File::create(&file).expect("a file");
    to.write_all(page.html.as_bytes()).expect("written");
    let mut browser = Browser::open(folder.path(), &file, hash, SIZE);
    browser.evaluate("window.app = neurotess.app; app.loop.settled()");
    Opened {
        browser,
        cell,
        _folder: folder,
    }
}

impl Opened {
    /// Saves the mesh at a level.
    fn saved(&mut self, level: u32) -> Vec<u8> {
        let text = self.browser.evaluate(&format!(
            "(async () => {{
               const {{ file }} = await app.mesh({level});
               const bytes = new Uint8Array(await file.arrayBuffer());
               return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''));
             }})()"
        ));
        base64(text.as_str().expect("text"))
    }

    /// The camera that the page has.
    fn camera(&mut self) -> Camera {
        let [eye, target] = ["app.camera.eye()", "app.camera.target"].map(|of| {
            let at = self.browser.evaluate(of);
            let number = |k: usize| at[k].as_f64().expect("a number");
            DVec3::new(number(0), number(1), number(2))
        });
        Camera::new(eye, target, DVec3::Y, 20.0_f64.to_radians()).expect("a camera")
    }

    /// The picture of the canvas, without what lies over it.
    fn picture(&mut self) -> Vec<u8> {
        self.browser.pixels("(app.drawWhole(), app.canvas)")
    }

    /// Hides or shows an entry of the legend, as a click does.
    fn click_legend(&mut self, index: usize) {
        self.browser.evaluate(&format!(
            "document.querySelectorAll('#legend button')[{index}].click(); app.loop.settled()"
        ));
    }

    fn assert_silent(&self) {
        assert!(self.browser.said.is_empty(), "{:?}", self.browser.said);
    }
}

fn assert_saves_what_the_library_exports(opened: &mut Opened) {
    for level in [1, 2, 5] {
        let options = RefineOptions::default();
        let lod = LodCriterion::Homogeneous(level);
        let ours = Refinement::new(&opened.cell.mesh, lod, &options);
        let mut file = std::io::Cursor::new(Vec::new());
        write(&ours, Format::Ply, &mut file).expect("written");
        let ours = read_bytes(&file.into_inner(), Format::Ply).expect("a mesh");
        let theirs = read_bytes(&opened.saved(level), Format::Ply).expect("a mesh");
        let [ours, theirs] = [ours, theirs].map(|mesh| check(&mesh));
        assert_eq!(
            (ours.vertices, ours.triangles, ours.euler),
            (theirs.vertices, theirs.triangles, theirs.euler),
            "level {level}"
        );
        assert!(
            theirs.closed && theirs.oriented && theirs.vertex_manifold,
            "level {level}"
        );
        let share = theirs.volume / ours.volume;
        assert!((share - 1.0).abs() < 2e-3, "level {level}: {share}");
    }
}

/// Whether a pixel has the color of a type: by its strongest component.
fn pixels_with(picture: &[u8], is: fn(&[u8]) -> bool) -> usize {
    picture.chunks_exact(4).filter(|pixel| is(pixel)).count()
}

fn assert_hides_by_legend(opened: &mut Opened) {
    let is_red = |pixel: &[u8]| pixel[0] > 120 && pixel[1] < 90 && pixel[2] < 90;
    let names = opened.browser.evaluate(
        "Array.from(document.querySelectorAll('#legend button'), (button) => button.textContent)",
    );
    let dendrite = names.as_array().expect("names").iter();
    let dendrite = dendrite.clone().position(|name| name == "basal dendrite");
    let dendrite = dendrite.expect("granule cells have dendrites");
    let shown = pixels_with(&opened.picture(), is_red);
    opened.click_legend(dendrite);
    let hidden = pixels_with(&opened.picture(), is_red);
    opened.click_legend(dendrite);
    let again = pixels_with(&opened.picture(), is_red);
    assert!(shown > 100, "{shown}");
    assert_eq!(hidden, 0);
    assert_eq!(again, shown);
}

/// The cell as the renderer draws it.
struct Drawn {
    gpu: Gpu,
    source: Adaptive,
    table: ColorTable,
    spheres: Vec<BoundingSphere>,
}

impl Drawn {
    fn new(cell: &Meshed) -> Self {
        let gpu = Gpu::open(None).expect("a device");
        let cells = [cell.cell()];
        let coloring = coloring(&cells, ColorBy::Type, &scheme());
        let mut templates = Templates::new();
        let template = Template {
            mesh: &cell.mesh,
            color_keys: &coloring.color_keys[0],
            values: &[],
        };
        let ids = templates.add(&gpu, &[template]).expect("uploaded");
        let scene = Scene::new(templates, vec![Instance::new(ids[0])]).expect("a scene");
        let source = Adaptive::new(&gpu, scene, AdaptiveSettings::default(), 1);
        Self {
            source: source.expect("a source"),
            table: coloring.table,
            spheres: bounds(&cell.mesh),
            gpu,
        }
    }

    fn picture(&mut self, camera: Camera, occlusion: Occlusion) -> Vec<u8> {
        let options = PictureOptions {
            size: SIZE,
            // Sixteen steps of four.
            samples: 64,
            occlusion,
            look: LOOK,
            ..PictureOptions::default()
        };
        let near = camera.near(&self.spheres);
        let mut pixels = Vec::new();
        let take = |_, band: Image| {
            pixels.extend(band.pixels);
            Ok::<(), String>(())
        };
        let view = Viewpoint { camera, near };
        let (gpu, source) = (&self.gpu, &mut self.source);
        render_still(gpu, source, &view, &self.table, &options, take).expect("drawn");
        pixels
    }

    /// What is at each pixel.
    fn picks(&mut self, camera: Camera) -> Vec<Option<PickHit>> {
        let view = ViewParams {
            camera,
            near: camera.near(&self.spheres),
            size: SIZE,
            look: LOOK,
            occlusion: Occlusion::Off,
            background: [255; 3],
            frozen: None,
        };
        let mut renderer = ProgressiveRenderer::new(&self.gpu);
        renderer.set_colors(self.table.clone());
        let drawn = renderer.identify(&self.gpu, &mut self.source, &view);
        drawn.expect("drawn");
        let resolver = self.source.resolver();
        self.gpu.wait().expect("done");
        let (_, ids) = renderer.ids().expect("no fault").expect("arrived");
        ids.into_iter().map(|id| resolver.resolve(id)).collect()
    }
}

/// As pages draw.
const LOOK: Look = Look {
    light: Light::Soft,
    wire: 0.0,
    clip: None,
    highlighted: ([255, 160, 0], 0.0),
    ghosted: 0.25,
    contrast: None,
    least_width: 1.5,
};

/// Mean difference of bytes.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let sum: u64 = a
        .iter()
        .zip(b)
        .map(|(a, b)| u64::from(a.abs_diff(*b)))
        .sum();
    sum as f64 / a.len() as f64
}

fn assert_draws_what_the_renderer_draws(opened: &mut Opened, drawn: &mut Drawn) {
    let camera = opened.camera();
    for (occlusion, checked, most) in [(Occlusion::Off, false, 0.2), (Occlusion::Fit, true, 0.6)] {
        opened.browser.evaluate(&format!(
            "document.getElementById('occlusion').checked = {checked}; app.loop.refresh(); app.loop.settled()"
        ));
        let difference = difference(&opened.picture(), &drawn.picture(camera, occlusion));
        neurotess_testing::note!("mean difference with occlusion {checked}: {difference:.3}");
        assert!(difference < most, "{occlusion:?}: {difference}");
    }
}

/// The sections of the corners around what was hit.
fn sections(mesh: &CoarseMesh, hit: &PickHit) -> Vec<i64> {
    let section = |vertex: u32| {
        let point = &mesh.tracing[mesh.vertices[vertex as usize].tracing as usize];
        let section = point.section.index().filter(|_| point.role != Role::Soma);
        section.map_or(-1, |section| section as i64)
    };
    match hit.target {
        PickTarget::Patch(patch) => mesh.patches[patch as usize].corners.map(section).to_vec(),
        PickTarget::Vertex(vertex) => vec![section(vertex)],
        PickTarget::Point(_) | PickTarget::Soma(_) => panic!("hits of exploration"),
    }
}

fn assert_picks_what_the_renderer_picks(opened: &mut Opened, drawn: &mut Drawn) {
    // Near the soma, where neurites are more than a pixel wide: elsewhere several share one.
    opened.browser.evaluate(
        "app.camera.target = app.scene.place(app.scene.section.indexOf(0xffff)).center;
         app.camera.distance = 90;
         app.loop.change();
         app.loop.settled()",
    );
    let picks = drawn.picks(opened.camera());
    let [width, height] = SIZE.map(|n| n as usize);
    let inside = |&pixel: &usize| {
        // Beside nothing and beside other things, neighbors are found first by one and not by the other.
        let around = [pixel - 1, pixel + 1, pixel - width, pixel + width];
        around.iter().all(|&other| picks[other].is_some())
    };
    let hits: Vec<usize> = (width..width * (height - 1) - 1)
        .filter(|&pixel| picks[pixel].is_some())
        .filter(inside)
        .collect();
    let chosen: Vec<usize> = hits
        .iter()
        .copied()
        .step_by(hits.len().div_ceil(12))
        .collect();
    assert!(chosen.len() > 4, "{}", hits.len());
    for pixel in chosen {
        let (x, y) = (pixel % width, pixel / width);
        let place = opened
            .browser
            .evaluate(&format!("app.pick({x} + 0.5, {y} + 0.5)"));
        let ours = sections(&opened.cell.mesh, &picks[pixel].expect("chosen"));
        let theirs = place["section"].as_i64();
        assert!(
            theirs.is_some_and(|section| ours.contains(&section)),
            "{x}, {y}: {ours:?} {place}"
        );
    }
    // Farther from everything than a page looks.
    let is_far = |&pixel: &usize| {
        let (x, y) = (pixel % width, pixel / width);
        let around = |at: usize| at.saturating_sub(6)..at + 7;
        let near = around(y).flat_map(|row| around(x).map(move |column| row * width + column));
        let mut near = near.filter_map(|other| picks.get(other));
        near.all(Option::is_none)
    };
    let far = (0..width * height)
        .find(is_far)
        .expect("a place with nothing");
    let (x, y) = (far % width, far / width);
    let nothing = opened
        .browser
        .evaluate(&format!("app.pick({x} + 0.5, {y} + 0.5)"));
    assert_eq!(nothing, Value::Null);
}

#[neurotess_testing::test(needs(full, chromium, gpu))]
fn a_page_draws_picks_and_saves_what_the_library_does() {
    let mut opened = opened("");
    assert_eq!(opened.browser.evaluate("app.renderer.name"), "WebGPU");
    let mut drawn = Drawn::new(&opened.cell);
    assert_draws_what_the_renderer_draws(&mut opened, &mut drawn);
    assert_picks_what_the_renderer_picks(&mut opened, &mut drawn);
    assert_hides_by_legend(&mut opened);
    assert_saves_what_the_library_exports(&mut opened);
    opened.assert_silent();
}

#[neurotess_testing::test(needs(full, chromium, gpu))]
fn without_webgpu_a_page_draws_picks_and_saves_the_same() {
    let mut opened = opened("#renderer=webgl");
    let said = opened.browser.evaluate("app.message.textContent");
    assert!(
        said.as_str().is_some_and(|said| said.contains("WebGL 2")),
        "{said}"
    );
    let mut drawn = Drawn::new(&opened.cell);
    // At one level, and edges are smoothed otherwise.
    let ours = drawn.picture(opened.camera(), Occlusion::Fit);
    let difference = difference(&opened.picture(), &ours);
    neurotess_testing::note!("mean difference: {difference:.3}");
    assert!(difference < 2.0, "{difference}");
    assert_picks_what_the_renderer_picks(&mut opened, &mut drawn);
    assert_hides_by_legend(&mut opened);
    assert_saves_what_the_library_exports(&mut opened);
    opened.assert_silent();
}

/// Shows another sample in the place of what there is. Returns what the page is called, and whether it measures.
fn replace(opened: &mut Opened, sample: &str) -> Value {
    let (cell, page) = page_of(Meshed::sample(sample));
    let (_, cells) = page.html.split_once("id=\"cells\">").expect("cells");
    let (cells, _) = cells.split_once('<').expect("an end");
    let cells = serde_json::to_string(cells).expect("JSON");
    opened.browser.evaluate(&format!(
        "app.replace({cells}).then(() => app.completed).then(() => app.loop.settled())"
    ));
    opened.cell = cell;
    opened.browser.evaluate(
        "[document.title, document.querySelector('h1').textContent, app.canvas.ariaLabel.split(',')[0], app.measuring.active]",
    )
}

#[neurotess_testing::test(needs(full, chromium, gpu))]
fn other_cells_take_the_place_of_those_that_are_there() {
    let mut opened = opened("#renderer=webgl");
    opened.browser.evaluate("app.act('m')");
    for name in ["star", "granule"] {
        let told = replace(&mut opened, name);
        assert_eq!(told, serde_json::json!([name, name, name, false]));
        let mut drawn = Drawn::new(&opened.cell);
        assert_picks_what_the_renderer_picks(&mut opened, &mut drawn);
        // The star has two parts, the granule cell one.
        assert_saves_what_the_library_exports(&mut opened);
    }
    assert_hides_by_legend(&mut opened);
    opened.assert_silent();
}

/// The need of the test of types.
fn typescript() -> Result<(), String> {
    let there = Command::new("tsc").arg("--version").output();
    let there = there.is_ok_and(|output| output.status.success());
    there
        .then_some(())
        .ok_or_else(|| "no TypeScript: npm install -g typescript".into())
}

#[neurotess_testing::test(needs(full, typescript))]
fn types_of_the_host_are_right() {
    let host = neurotess_testing::workspace().join("crates/web/host");
    let checked = Command::new("tsc")
        .arg("-p")
        .arg(host)
        .output()
        .expect("tsc");
    let said = String::from_utf8_lossy(&checked.stdout);
    assert!(checked.status.success(), "{said}");
}

#[neurotess_testing::test(needs(full, chromium))]
fn a_second_click_shows_an_entry_alone_and_a_third_and_fourth_show_all() {
    let mut opened = opened("#renderer=webgl");
    let mut hidden_after = |detail: u32| {
        opened.browser.evaluate(&format!(
            "(() => {{
               const button = document.querySelectorAll('#legend button')[1];
               button.dispatchEvent(new MouseEvent('click', {{ detail: {detail} }}));
               return [...app.colors.hiddenNow()].sort();
             }})()"
        ))
    };
    let all = [1, 2, 1, 2].map(&mut hidden_after);
    let others: Vec<i64> = vec![0, 2];
    assert_eq!(all[0], serde_json::json!([1]));
    assert_eq!(all[1].as_array().map(Vec::len), Some(others.len()));
    assert!(
        all[1]
            .as_array()
            .is_some_and(|hidden| !hidden.contains(&1.into()))
    );
    assert_eq!(all[3], serde_json::json!([]));
}

/// Every character that a replacement, a template or HTML knows means itself in a title.
#[neurotess_testing::test(needs(full, chromium, gpu))]
fn a_page_shows_its_title_as_it_is() {
    let title = "a$` b$' c$& d$1 e$$ ${f} {name} {title} {cells} <b>&amp; \"g\" 'h' \\ `i`";
    let mut cell = Meshed::sample("granule");
    cell.name = title.to_owned();
    let mut opened = opened_with(cell, "#renderer=webgl");
    let told = opened.browser.evaluate(
        "[document.title, document.querySelector('h1').textContent, app.canvas.ariaLabel.split(', in three')[0]]",
    );
    assert_eq!(told, serde_json::json!([title, title, title]));
    opened.assert_silent();
}

#[neurotess_testing::test(needs(full, chromium))]
fn a_link_holds_the_view_and_keys_move_it() {
    let mut opened =
        opened("#renderer=webgl&view=0.5,0.25,300,1,2,3&colors=distance&level=8&flags=o");
    let state = "[app.camera.yaw, app.camera.pitch, app.camera.distance, app.colors.scheme.id, app.look(false).lod.level]";
    let read = opened.browser.evaluate(state);
    assert_eq!(read, serde_json::json!([0.5, 0.25, 300, "distance", 8]));
    for key in ["ArrowLeft", "+", "f", "1"] {
        let press = format!(
            "dispatchEvent(new KeyboardEvent('keydown', {{ key: '{key}' }})); app.loop.settled()"
        );
        let before = opened.browser.evaluate("location.hash");
        opened.browser.evaluate(&press);
        let after = opened.browser.evaluate("location.hash");
        assert_ne!(before, after, "{key}");
    }
    opened.assert_silent();
}
