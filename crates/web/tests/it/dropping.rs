//! The page that takes tracings, in a browser: files are read and meshed there as here, and nothing is asked for.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use neurotess_color::ColorScheme;
use neurotess_mesh::Format;
use neurotess_render::Placement;
use neurotess_testing::{full, shared, shared_data};
use neurotess_wasm::{Answer, Calls};
use neurotess_web::{PageCell, PageMarkers, PageOptions, shared_page};
use serde_json::{Value, json};

use crate::browser::{Browser, chromium};
use crate::core::{bad_files, sample, too_many_points};
use crate::unpacked::base64;
use crate::written::Meshed;

const SIZE: [u32; 2] = [800, 420];
/// A place on the frame, and one beside it.
const PLACES: [[u32; 2]; 2] = [[560, 300], [150, 120]];

fn page_file() -> PathBuf {
    neurotess_testing::workspace().join("out/web/index.html")
}

/// The need of tests of the page.
pub(crate) fn page() -> Result<(), String> {
    let is_there = page_file().exists();
    is_there.then_some(()).ok_or_else(|| {
        "no page: cargo xtask web makes it, with Rust's library for WebAssembly".into()
    })
}

/// The page in a browser.
pub(crate) struct Opened {
    pub(crate) browser: Browser,
    folder: tempfile::TempDir,
}

impl Opened {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let browser = Browser::open(folder.path(), &page_file(), "", SIZE);
        Self { browser, folder }
    }

    pub(crate) fn without_graphics() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let browser = Browser::open_without_graphics(folder.path(), &page_file(), SIZE);
        Self { browser, folder }
    }

    pub(crate) fn file(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let file = self.folder.path().join(name);
        std::fs::write(&file, bytes).expect("written");
        file
    }

    /// When the last file is shown, or its fault.
    fn wait(&mut self, before: &str) -> Value {
        self.browser.evaluate(&format!(
            "(async () => {{
               while (neurotess.page.turns === {before}) await new Promise((r) => setTimeout(r, 10));
               await neurotess.page.turn;
             }})()"
        ));
        self.browser.evaluate(
            "({ fault: document.getElementById('fault').textContent, hidden: document.getElementById('fault').hidden,
                name: neurotess.page.cell?.name, took: neurotess.page.took })",
        )
    }

    fn turns(&mut self) -> String {
        self.browser.evaluate("neurotess.page.turns").to_string()
    }

    pub(crate) fn choose(&mut self, file: &Path) -> Value {
        let before = self.turns();
        self.browser.choose("#file", file);
        self.wait(&before)
    }

    fn drop_at(&mut self, place: [u32; 2], file: &Path) -> Value {
        let before = self.turns();
        self.browser.drop_file(place, file);
        self.wait(&before)
    }

    /// What the core in the browser answers.
    pub(crate) fn asked(&mut self, call: &Value) -> Answer {
        let text = self.browser.evaluate(&format!(
            "(async () => {{
               const {{ told, bytes }} = await neurotess.page.core.ask({call});
               let text = '';
               for (let k = 0; k < bytes.length; k += 4096) text += String.fromCharCode(...bytes.subarray(k, k + 4096));
               return [JSON.stringify(told), btoa(text)];
             }})()"
        ));
        let part = |k: usize| text[k].as_str().expect("text").to_owned();
        let told: Value = serde_json::from_str(&part(0)).expect("JSON");
        Answer {
            told: serde_json::to_vec(&told).expect("JSON"),
            bytes: base64(&part(1)),
        }
    }

    /// The file that a button saves.
    fn saved(&mut self, button: &str, file: &str) -> Vec<u8> {
        self.saved_by(
            &format!("document.getElementById('{button}').click()"),
            file,
        )
    }

    /// The file that an expression saves.
    pub(crate) fn saved_by(&mut self, expression: &str, file: &str) -> Vec<u8> {
        let folder = tempfile::tempdir().expect("a folder");
        self.browser.save_into(folder.path());
        self.browser.evaluate(expression);
        let file = folder.path().join(file);
        let clock = Instant::now();
        while !file.exists() {
            assert!(
                clock.elapsed().as_secs() < 60,
                "{} is not saved",
                file.display()
            );
            std::thread::sleep(Duration::from_millis(50));
        }
        std::fs::read(file).expect("a file")
    }

    /// Number of pixels of the cell's picture that are not of its background.
    fn drawn(&mut self) -> u64 {
        let count = self.browser.evaluate(
            "(async () => {
               const { app } = document.getElementById('frame').contentWindow.neurotess;
               await app.completed;
               await app.loop.settled();
               app.drawWhole();
               const copy = document.createElement('canvas');
               [copy.width, copy.height] = [app.canvas.width, app.canvas.height];
               const context = copy.getContext('2d');
               context.drawImage(app.canvas, 0, 0);
               const { data } = context.getImageData(0, 0, copy.width, copy.height);
               let drawn = 0;
               for (let k = 0; k < data.length; k += 4) {
                 if (Math.abs(data[k] - data[0]) + Math.abs(data[k + 1] - data[1]) + Math.abs(data[k + 2] - data[2]) > 60) drawn++;
               }
               return drawn;
             })()",
        );
        count.as_u64().expect("a number")
    }

    pub(crate) fn assert_silent(&self) {
        assert!(self.browser.said.is_empty(), "{:?}", self.browser.said);
    }
}

/// The page that the library makes of a cell.
fn our_page(cell: &Meshed) -> String {
    let options = PageOptions::usual(cell.name.clone(), 1);
    let scheme = ColorScheme {
        palette: options.palette,
        own_colors: options.own_colors.clone(),
        background: None,
        scale: options.color_map.scale(),
        range: None,
    };
    let placed = PageCell {
        cell: cell.cell(),
        placement: Placement::default(),
    };
    let markers = PageMarkers::default();
    let page = shared_page(&[placed], &scheme, None, None, &markers, &options);
    page.expect("a page").html
}

#[neurotess_testing::test(needs(full, chromium, page, shared))]
fn a_dropped_tracing_is_shown_in_a_page_that_is_the_librarys_own() {
    let file = shared_data().join("swc/IF4_140201.CNG.swc");
    let text = std::fs::read(&file).expect("a cell");
    let clock = Instant::now();
    let mut opened = Opened::new();
    neurotess_testing::note!("opened in {:.1} s", clock.elapsed().as_secs_f64());
    for place in PLACES {
        let told = opened.drop_at(place, &file);
        neurotess_testing::note!("dropped at {place:?}: {told}");
        assert_eq!(told["hidden"], true, "{told}");
        assert_eq!(told["name"], "IF4_140201.CNG");
    }
    assert!(opened.drawn() > 1000);
    let mut calls = Calls::default();
    let ours = calls.open("IF4_140201.CNG.swc", text).expect("a cell");
    let cells = opened.browser.evaluate("neurotess.page.cell.cells");
    assert!(
        cells.as_str().map(str::as_bytes) == Some(&ours.bytes),
        "packed cells differ"
    );
    let theirs = opened
        .browser
        .evaluate("neurotess.page.frame.page(neurotess.page.cell.name, neurotess.page.cell.cells)");
    assert!(
        theirs.as_str() == Some(&our_page(&Meshed::read(&file))),
        "pages differ"
    );
    let warnings = opened.browser.evaluate(
        "Array.from(document.querySelectorAll('#warning-list li'), (li) => li.textContent)",
    );
    let told: Value = serde_json::from_slice(&ours.told).expect("JSON");
    assert_eq!(warnings, told["warnings"]);
    assert!(!told["warnings"].as_array().expect("a list").is_empty());
    opened.assert_silent();
}

#[neurotess_testing::test(needs(full, chromium, page))]
fn every_format_is_read_and_every_file_saved_as_the_library_does() {
    let mut opened = Opened::new();
    let swc = sample("pyramidal");
    let read = neurotess_formats::swc::read_bytes(&swc, "cell.swc", &Default::default());
    let morphology = read.expect("a cell").morphology;
    for format in neurotess_formats::Format::WRITTEN {
        let mut bytes = Vec::new();
        neurotess_formats::write(&morphology, format, &mut bytes).expect("written");
        let name = format!("cell.{}", format.extensions()[0]);
        let file = opened.file(&name, &bytes);
        let told = opened.choose(&file);
        assert_eq!(
            (&told["hidden"], &told["name"]),
            (&json!(true), &json!("cell")),
            "{name}: {told}"
        );
        let ours = Calls::default().open(&name, bytes).expect("a cell");
        let cells = opened.browser.evaluate("neurotess.page.cell.cells");
        assert!(
            cells.as_str().map(str::as_bytes) == Some(&ours.bytes),
            "{name}"
        );
    }
    let file = opened.file("cell.swc", &swc);
    opened.choose(&file);
    let mut calls = Calls::default();
    calls.open("cell.swc", swc).expect("a cell");
    for format in [Format::Ply, Format::Obj, Format::Stl, Format::Glb] {
        let extension = format.extension();
        let theirs = opened.asked(&json!({"mesh": extension, "level": 2}));
        let ours = calls.mesh(extension, 2).expect("a file");
        let told = |answer: &Answer| serde_json::from_slice::<Value>(&answer.told).expect("JSON");
        assert_eq!(told(&theirs), told(&ours), "{extension}");
        assert!(theirs.bytes == ours.bytes, "{extension}");
    }
    let theirs = opened.asked(&json!({"tracing": true}));
    let tracing = calls.tracing().expect("a file").bytes;
    assert!(theirs.bytes == tracing);
    let page = opened
        .browser
        .evaluate("neurotess.page.frame.page(neurotess.page.cell.name, neurotess.page.cell.cells)");
    assert!(opened.saved("save-page", "cell.html") == page.as_str().expect("text").as_bytes());
    assert!(opened.saved("save-tracing", "cell.swc") == tracing);
    assert!(opened.saved("save-mesh", "cell.ply").starts_with(b"ply\n"));
    opened.assert_silent();
}

#[neurotess_testing::test(needs(full, chromium, page))]
fn what_cannot_be_shown_is_told_in_the_commands_words() {
    let mut opened = Opened::new();
    for (name, bytes) in bad_files() {
        let file = opened.file(name, &bytes);
        let told = opened.choose(&file);
        let ours = Calls::default().open(name, bytes).expect_err(name);
        assert_eq!(told["fault"], ours);
        assert_eq!(told["hidden"], false);
    }
    // 200 MB of nothing, and a cell of more points than a page can have.
    let large = opened.file("large.swc", b"");
    let nothing = std::fs::OpenOptions::new().write(true).open(&large);
    nothing
        .and_then(|file| file.set_len(200 << 20))
        .expect("a large file");
    let told = opened.choose(&large);
    let ours = Calls::default().open("large.swc", vec![0; 200 << 20]);
    assert_eq!(told["fault"], ours.expect_err("no cell"));
    let long = opened.file("long.swc", &too_many_points());
    let told = opened.choose(&long);
    let ours = Calls::default().open("long.swc", too_many_points());
    assert_eq!(told["fault"], ours.expect_err("too many"));
    // The sample is there, and other files are taken.
    assert_eq!(told["name"], "granule");
    let file = opened.file("star.swc", &sample("star"));
    let told = opened.choose(&file);
    assert_eq!(
        (&told["hidden"], &told["name"]),
        (&json!(true), &json!("star"))
    );
    opened.assert_silent();
}

#[neurotess_testing::test(needs(full, chromium, page))]
fn all_controls_have_names_and_are_reached_by_keys() {
    let mut opened = Opened::new();
    let nameless = opened.browser.evaluate(
        "(() => {
           const frame = document.getElementById('frame').contentDocument;
           const all = [document, frame].flatMap((of) => [...of.querySelectorAll('input, select, button, iframe, canvas[tabindex]')]);
           const named = (element) => element.labels?.[0]?.textContent.trim() || element.getAttribute('aria-label') || element.title || element.textContent.trim();
           return all.filter((element) => !named(element)).map((element) => element.outerHTML);
         })()",
    );
    assert_eq!(nameless, json!([]));
    let mut reached = Vec::new();
    for _ in 0..6 {
        opened.browser.press("Tab");
        let id = opened.browser.evaluate("document.activeElement.id");
        reached.push(id.as_str().unwrap_or_default().to_owned());
    }
    for id in [
        "file",
        "format",
        "level",
        "save-mesh",
        "save-page",
        "save-tracing",
    ] {
        assert!(reached.iter().any(|other| other == id), "{id}: {reached:?}");
    }
    opened.assert_silent();
}
