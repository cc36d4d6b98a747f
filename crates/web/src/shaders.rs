//! The shaders of pages: those of the renderer as they are, a few of our own, and GLSL for WebGL.

use std::collections::BTreeMap;

use neurotess_refine::wgsl::{Shader, WgslFile};
use neurotess_render::host;
use serde::Serialize;

use crate::error::WebError;
use crate::glsl::{GlslProgram, glsl};
use crate::layout::{Layout, layout};
use crate::minified::wgsl;
use crate::shortened::{Language, shortened};
use crate::texture_source::packed_in_texture;

/// A file of this crate.
macro_rules! file {
    ($name:literal) => {
        WgslFile {
            name: $name,
            text: include_str!(concat!("../shaders/", $name)),
        }
    };
}

const EVEN: WgslFile = file!("even.wgsl");
const EXPAND: WgslFile = file!("expand.wgsl");
const CAPTURED: WgslFile = file!("captured.wgsl");
const NOTHING: WgslFile = file!("nothing.wgsl");
const KEPT: WgslFile = file!("kept.wgsl");
const SHADOWS: WgslFile = file!("shadows.wgsl");
const PRESENTED: WgslFile = file!("presented.wgsl");

/// All that the host needs to make pipelines.
#[derive(Debug, Serialize)]
pub(crate) struct PageShaders {
    /// Pieces of WGSL that modules are joined of: most modules share most of them.
    pieces: Vec<String>,
    /// By name of the module: indices of its pieces.
    modules: BTreeMap<String, Vec<usize>>,
    /// Entry points of the selection: module, name, number of buffers in group 2.
    selection: Vec<(String, &'static str, u32)>,
    /// Uniforms, by name of the struct.
    layouts: BTreeMap<&'static str, Layout>,
    numbers: BTreeMap<String, f64>,
    grid_sizes: &'static [u32],
    key_light: [f32; 3],
    glsl: BTreeMap<&'static str, GlslProgram>,
}

/// Structs of uniforms and buffers that the host writes, each with a module that has it.
const LAYOUTS: [(&str, &str); 7] = [
    ("MarkerFrame", "markers"),
    ("Frame", "classify"),
    ("Placed", "classify"),
    ("Shade", "draw2"),
    ("Finish", "finish"),
    ("Even", "expand"),
    ("Presented", "present"),
];

/// All WGSL of a page by the name of the module.
pub fn modules() -> Vec<(String, Shader)> {
    let named = |shader: Shader| (shader.name.trim_end_matches(".wgsl").to_owned(), shader);
    let mut all: Vec<(String, Shader)> = host::selection_shaders().into_iter().map(named).collect();
    let kinds = [
        ("draw", host::drawing_shaders()),
        ("id", host::id_shaders()),
    ];
    for (name, shaders) in kinds {
        let numbered = shaders.into_iter().enumerate();
        all.extend(numbered.map(|(kind, shader)| (format!("{name}{kind}"), shader)));
    }
    all.push(("markers".to_owned(), host::marker_shader()));
    all.push(("finish".to_owned(), host::finishing_shader()));
    all.push(named(host::composed("expand", &[EVEN, EXPAND])));
    all.push(named(host::composed("present", &[PRESENTED])));
    all
}

/// GLSL ES 3.00 of the programs of WebGL, from WGSL: vertices at one level, their drawing, soft shadows.
fn programs() -> Result<[(&'static str, GlslProgram); 8], WebError> {
    let capture = host::composed("captured", &[EVEN, CAPTURED]);
    let text = packed_in_texture(&capture.text);
    let kept = host::composed("kept", &[KEPT]).text;
    let shadows = host::composed("shadows", &[SHADOWS]).text;
    let shadow = |entry| glsl("shadows", [&shadows; 2], ["corner", entry]);
    Ok([
        (
            "facing",
            glsl("kept", [&kept; 2], ["vertex", "fragment_facing"])?,
        ),
        ("occlude", shadow("occlude")?),
        ("blur", shadow("blur_rows")?),
        ("darken", shadow("darken")?),
        (
            "capture",
            glsl("captured", [&text, NOTHING.text], ["capture", "nothing"])?,
        ),
        ("kept", glsl("kept", [&kept; 2], ["vertex", "fragment"])?),
        ("dots", glsl("kept", [&kept; 2], ["marker", "fragment"])?),
        ("ids", glsl("kept", [&kept; 2], ["vertex", "fragment_id"])?),
    ])
}

/// Names of WGSL that the host uses.
fn entry_points() -> Vec<&'static str> {
    let selection = host::selection_entries().iter().map(|&(_, name, _)| name);
    let others = "vertex fragment vertex_id fragment_id find_blocks copy_depths occlude blur_rows blur_columns accumulate \
                  expand corner show";
    selection.chain(others.split_whitespace()).collect()
}

/// Stages that are in the page once: the vertex stages of `kept` (or else `occlude`) and the fragment stage of `kept`.
const SHARED: [(&str, bool); 5] = [
    ("ids", true),
    ("facing", true),
    ("blur", true),
    ("darken", true),
    ("dots", false),
];

impl PageShaders {
    pub(crate) fn new() -> Result<Self, WebError> {
        let all = modules();
        let mut pieces = Vec::new();
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        let mut piece = |text: String| {
            *known.entry(text.clone()).or_insert_with(|| {
                pieces.push(text);
                pieces.len() - 1
            })
        };
        let mut joined = BTreeMap::new();
        for (name, shader) in &all {
            let texts = shader.pieces().into_iter().map(|text| wgsl(&text));
            let texts = texts.filter(|text| !text.is_empty());
            joined.insert(name.clone(), texts.map(&mut piece).collect());
        }
        let kept = entry_points();
        let pieces = shortened(&pieces, Language::Wgsl, |name| kept.contains(&name));
        let mut layouts = BTreeMap::new();
        for (of, module) in LAYOUTS {
            let shader = all.iter().find(|(name, _)| name == module);
            let (_, shader) = shader.expect("modules() names it");
            layouts.insert(of, layout(shader, of)?);
        }
        let mut programs = BTreeMap::from(programs()?);
        let kept = host::composed("kept", &[KEPT]);
        layouts.insert("Kept", layout(&kept, "Kept")?);
        let shadows = host::composed("shadows", &[SHADOWS]);
        layouts.insert("Shadows", layout(&shadows, "Shadows")?);
        // Stages that others have: see `SHARED`.
        for (name, is_vertex) in SHARED {
            if let Some(program) = programs.get_mut(name) {
                let stage = if is_vertex {
                    &mut program.vertex
                } else {
                    &mut program.fragment
                };
                stage.clear();
            }
        }
        let entries = host::selection_entries().iter();
        let entries =
            entries.map(|&(module, entry, buffers)| (all[module].0.clone(), entry, buffers));
        Ok(Self {
            pieces,
            modules: joined,
            selection: entries.collect(),
            layouts,
            numbers: host::numbers().into_iter().collect(),
            grid_sizes: host::grid_sizes(),
            key_light: host::key_light(),
            glsl: programs,
        })
    }
}
