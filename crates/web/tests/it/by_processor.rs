//! The page that takes tracings where there is neither WebGPU nor WebGL 2: its core draws, as the library does.

use neurotess_mesh::Role;
use neurotess_testing::full;
use neurotess_wasm::Calls;
use serde_json::{Value, json};

use crate::browser::{Browser, chromium};
use crate::core::sample;
use crate::dropping::{Opened, page};
use crate::unpacked::base64;
use crate::written::{Meshed, page_of};

const SIZE: [u32; 2] = [240, 180];

/// A view of a soma and some neurites, and the cell.
fn viewed(name: &str) -> (Value, Meshed) {
    let cell = Meshed::sample(name);
    // Somata of samples are at the origin.
    let view = json!({
        "size": SIZE, "eye": [0, 0, 600], "target": [0, 0, 0], "up": [0, 1, 0], "fov": 0.35,
        "orthographic": false, "near": 100, "level": 0, "error": 0.5, "samples": 16, "occlusion": true, "wire": 0,
        "least_width": 1.5, "background": [255, 255, 255], "draft": false,
    });
    (view, cell)
}

/// Somata red, all else blue; `shown`: what of it shows.
fn colors(cell: &Meshed, shown: impl Fn(Role) -> bool) -> Vec<u8> {
    let of = |role: Role| match role {
        Role::Soma => [200, 40, 40, u8::from(shown(role))],
        _ => [40, 60, 200, u8::from(shown(role))],
    };
    let points = cell.mesh.tracing.iter();
    points.flat_map(|point| of(point.role)).collect()
}

fn drawn(calls: &mut Calls, view: &Value, colors: &[u8]) -> Vec<u8> {
    calls.draw(&view.to_string(), colors).expect("drawn").bytes
}

fn count(pixels: &[u8], is: fn(&[u8]) -> bool) -> usize {
    pixels.chunks_exact(4).filter(|pixel| is(pixel)).count()
}

fn is_red(pixel: &[u8]) -> bool {
    pixel[0] > pixel[2].saturating_add(40)
}

fn is_blue(pixel: &[u8]) -> bool {
    pixel[2] > pixel[0].saturating_add(40)
}

fn opened(name: &str) -> Calls {
    let mut calls = Calls::default();
    let file = format!("{name}.swc");
    calls.open(&file, sample(name)).expect("a cell");
    calls
}

#[neurotess_testing::test]
fn what_is_hidden_does_not_show_and_is_not_picked() {
    let (view, cell) = viewed("pyramidal");
    let mut calls = opened("pyramidal");
    let all = colors(&cell, |_| true);
    let whole = drawn(&mut calls, &view, &all);
    let [red, blue] = [is_red, is_blue].map(|is| count(&whole, is));
    assert!(red > 20 && blue > 200, "{red} {blue}");
    let place = |is: fn(&[u8]) -> bool| {
        let at = whole.chunks_exact(4).position(is).expect("a pixel") as i64;
        [at % i64::from(SIZE[0]), at / i64::from(SIZE[0])]
    };
    let mut pick = |colors: &[u8], at: [i64; 2]| -> Value {
        let told = calls
            .pick(&view.to_string(), colors, at)
            .expect("an answer");
        serde_json::from_slice(&told.told).expect("JSON")
    };
    for is_soma in [true, false] {
        let is = if is_soma { is_red } else { is_blue };
        let point = pick(&all, place(is)).as_u64().expect("a point") as usize;
        assert_eq!(cell.mesh.tracing[point].role == Role::Soma, is_soma);
    }
    assert_eq!(pick(&all, [0, 0]), Value::Null);
    let bare = colors(&cell, |role| role == Role::Soma);
    assert_eq!(pick(&bare, place(is_blue)), Value::Null);
    let bare = drawn(&mut calls, &view, &bare);
    assert_eq!(count(&bare, is_blue), 0);
    // Where neurites begin, colors are mixed.
    assert!(count(&bare, is_red) > red / 2);
    let of_another = calls.draw(&view.to_string(), &all[4..]).expect("none");
    assert!(of_another.bytes.is_empty());
}

#[neurotess_testing::test]
fn other_colors_of_a_kept_picture_are_as_if_it_were_drawn_anew() {
    let (view, cell) = viewed("pyramidal");
    let mut calls = opened("pyramidal");
    let all = colors(&cell, |_| true);
    let swapped: Vec<u8> = all
        .chunks_exact(4)
        .flat_map(|c| [c[2], c[1], c[0], c[3]])
        .collect();
    drawn(&mut calls, &view, &swapped);
    let again = drawn(&mut calls, &view, &all);
    assert!(again == drawn(&mut opened("pyramidal"), &view, &all));
    let mut draft = view;
    draft["draft"] = json!(true);
    let apart = |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max();
    // Weights have sixteen bits.
    assert!(apart(&again, &drawn(&mut calls, &draft, &all)) <= Some(2));
    draft["wire"] = json!(1);
    assert!(apart(&again, &drawn(&mut calls, &draft, &all)) > Some(5));
}

/// The canvas of the frame, without what lies over it.
fn picture(opened: &mut Opened) -> Vec<u8> {
    opened.browser.pixels(
        "document.getElementById('frame').contentWindow.neurotess.app.loop.settled()
           .then(() => document.getElementById('frame').contentWindow.neurotess.app.canvas)",
    )
}

/// What of the frame's app.
fn app(opened: &mut Opened, expression: &str) -> Value {
    opened.browser.evaluate(&format!(
        "(() => {{ const {{ app }} = document.getElementById('frame').contentWindow.neurotess; return {expression}; }})()"
    ))
}

#[neurotess_testing::test(needs(full, chromium, page))]
fn a_browser_without_graphics_shows_turns_hides_picks_and_saves() {
    let mut page = Opened::without_graphics();
    let said = app(&mut page, "app.message.textContent");
    assert_eq!(
        said,
        "Drawn by the processor, since there is neither WebGPU nor WebGL 2 here."
    );
    let file = page.file("pyramidal.swc", &sample("pyramidal"));
    assert_eq!(page.choose(&file)["name"], "pyramidal");
    let whole = picture(&mut page);
    let shown = |pixels: &[u8]| {
        let behind = &pixels[..4];
        pixels
            .chunks_exact(4)
            .filter(|pixel| *pixel != behind)
            .count()
    };
    assert!(shown(&whole) > 3000, "{}", shown(&whole));
    // What it is made of has the bytes that this program makes.
    let view = app(
        &mut page,
        "app.renderer.view(app.camera, app.look(false), false, 1)",
    );
    let colors = app(&mut page, "[...app.renderer.colors]");
    let bytes: Vec<u8> = serde_json::from_value(colors.clone()).expect("bytes");
    let mut calls = opened("pyramidal");
    assert!(drawn(&mut calls, &view, &bytes) == whole);
    for (name, value) in [
        ("draft", json!(true)),
        ("wire", json!(1)),
        ("orthographic", json!(true)),
    ] {
        let mut other = view.clone();
        other[name] = value;
        let theirs = page.asked(&json!({"view": other, "colors": colors}));
        assert!(theirs.bytes == drawn(&mut calls, &other, &bytes), "{name}");
    }
    // A soma and the end of a neurite are found where they are.
    let found = app(
        &mut page,
        "(async () => {
           const { scene, camera, canvas } = app, found = [];
           const most = scene.distance.indexOf(Math.max(...scene.distance)), soma = scene.section.indexOf(0xffff);
           for (const key of [soma, most]) {
             const wanted = scene.place(key), at = camera.project(wanted.center, canvas.clientWidth, canvas.clientHeight);
             const place = await app.pick(...at);
             found.push([wanted.section === place?.section, scene.straight(wanted, place)]);
           }
           return found;
         })()",
    );
    for found in found.as_array().expect("places") {
        assert_eq!(found[0], true, "{found}");
        assert!(
            found[1].as_f64().is_some_and(|apart| apart < 30.0),
            "{found}"
        );
    }
    app(&mut page, "(app.camera.turn(1, 0), app.loop.change())");
    let turned = picture(&mut page);
    assert!(turned != whole && shown(&turned) > 1000);
    app(
        &mut page,
        "[...document.getElementById('frame').contentDocument.querySelectorAll('#legend button')].at(-1).click()",
    );
    let hidden = picture(&mut page);
    assert!(
        shown(&hidden) < shown(&turned),
        "{} {}",
        shown(&hidden),
        shown(&turned)
    );
    let saved = page.saved_by(
        "document.getElementById('frame').contentWindow.neurotess.app.savePicture()",
        "pyramidal.png",
    );
    assert!(saved.starts_with(b"\x89PNG"));
    let text = app(
        &mut page,
        "app.mesh(2).then(async ({ file }) => btoa(Array.from(new Uint8Array(await file.arrayBuffer()), (byte) => String.fromCharCode(byte)).join('')))",
    );
    let ours = calls.mesh("ply", 2).expect("a file").bytes;
    assert!(
        base64(text.as_str().expect("text")) == ours,
        "meshes differ"
    );
    page.assert_silent();
}

#[neurotess_testing::test(needs(full, chromium))]
fn a_page_without_a_core_tells_what_is_needed() {
    let (_, page) = page_of(Meshed::sample("granule"));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("page.html");
    std::fs::write(&file, page.html).expect("written");
    let mut browser = Browser::open_without_graphics(folder.path(), &file, SIZE);
    let said = browser.evaluate("neurotess.app.message.textContent");
    let said = said.as_str().expect("text");
    assert!(
        said.contains("No WebGPU and no WebGL 2") && said.contains("neurotess render"),
        "{said}"
    );
    assert!(browser.said.is_empty(), "{:?}", browser.said);
}
