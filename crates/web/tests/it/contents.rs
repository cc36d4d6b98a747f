//! What is in a page: everything that it needs, and nothing that it would ask for.

use neurotess_refine::testing::naga;
use neurotess_testing::{shared, shared_data};
use neurotess_web::{PageMarkers, WebError, modules, packed_parts};

use crate::unpacked::Unpacked;
use crate::written::{Meshed, page_of, written};

/// Most bytes of what is the same in all pages: 88,522, of which 1,130 are where patches go over from one section to
/// another.
const HOST: usize = 88_600;

#[neurotess_testing::test]
fn a_page_asks_for_nothing() {
    let (_, page) = page_of(Meshed::sample("granule"));
    let script = Unpacked::of(&page.html, "host").bytes;
    let script = String::from_utf8(script).expect("text");
    let (before, rest) = page.html.split_once("id=\"host\">").expect("a host");
    let (_, loader) = rest.split_once("id=\"cells\">").expect("cells");
    let (_, loader) = loader.split_once('<').expect("an end");
    assert!(
        before.contains("default-src 'none'"),
        "browsers forbid all requests"
    );
    for text in [before, loader, &script] {
        for way in [
            "http://", "https://", "src=", "href=\"", "fetch(", "import(", "XMLHttp", "url(",
        ] {
            assert!(!text.contains(way), "{way}");
        }
        assert!(
            !text.contains("import ") && !text.contains("export "),
            "modules are functions"
        );
    }
}

#[neurotess_testing::test]
fn packed_meshes_are_those_of_the_library() {
    let cells = [Meshed::sample("granule"), Meshed::sample("motor")];
    let page = written(&cells, None, &PageMarkers::default(), "two").expect("a page");
    let read = Unpacked::of(&page.html, "cells");
    let mut first_key = 0;
    for (data, cell) in read.json["cells"]
        .as_array()
        .expect("cells")
        .iter()
        .zip(&cells)
    {
        assert_eq!(data["first_key"], first_key);
        let ours = packed_parts(&cell.cell(), first_key);
        let theirs = data["parts"].as_array().expect("parts");
        assert_eq!(ours.len(), theirs.len());
        for (our, their) in ours.iter().zip(theirs) {
            assert!(
                our.packed == read.records(&their["packed"]),
                "{}",
                cell.name
            );
            assert_eq!(their["slots"], our.patches.len());
        }
        first_key += cell.mesh.tracing.len();
    }
    assert_eq!(page.points, first_key);
}

#[neurotess_testing::test]
fn the_host_is_small() {
    let (_, page) = page_of(Meshed::sample("granule"));
    assert!(page.host_bytes < HOST, "{}", page.host_bytes);
}

#[neurotess_testing::test(needs(shared))]
fn five_thousand_points_take_200_kilobytes_at_most() {
    let (cell, page) = page_of(Meshed::read(&shared_data().join("swc/IF4_140201.CNG.swc")));
    let points = cell.morphology.points.len();
    assert!((4_500..=5_000).contains(&points), "{points}");
    assert!(page.html.len() <= 200_000, "{}", page.html.len());
}

#[neurotess_testing::test(needs(neurotess_testing::full, shared))]
fn twenty_thousand_points_take_700_kilobytes_at_most() {
    let (cell, page) = page_of(Meshed::read(&shared_data().join("swc/vd130423_idC.swc")));
    let points = cell.morphology.points.len();
    assert!((18_000..=20_000).contains(&points), "{points}");
    assert!(page.html.len() <= 700_000, "{}", page.html.len());
}

#[neurotess_testing::test]
fn shaders_of_a_page_are_valid_as_they_are_joined() {
    let (_, page) = page_of(Meshed::sample("granule"));
    let host = Unpacked::of(&page.html, "host").json;
    let pieces = host["pieces"].as_array().expect("pieces");
    let joined = host["modules"].as_object().expect("modules");
    assert_eq!(joined.len(), modules().len());
    for (name, indices) in joined {
        let indices = indices.as_array().expect("indices").iter();
        let texts = indices.map(|k| pieces[k.as_u64().expect("an index") as usize].as_str());
        let text: Option<Vec<&str>> = texts.collect();
        let text = text.expect("texts").join("\n");
        let module = naga::front::wgsl::parse_str(&text);
        let module = module.unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(&text)));
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::default(),
        );
        validator
            .validate(&module)
            .unwrap_or_else(|e| panic!("{name}: {e:?}"));
        // As many as WebGPU has without asking.
        let storage = text.matches("var<storage").count();
        assert!(
            storage <= 8 || !name.starts_with("draw"),
            "{name} binds {storage} buffers"
        );
    }
    for (name, program) in host["glsl"].as_object().expect("programs") {
        for stage in ["vertex", "fragment"] {
            let text = program[stage].as_str().expect("text");
            assert!(
                text.is_empty() || text.starts_with("#version 300 es\n"),
                "{name} {stage}"
            );
        }
    }
}

/// A title is joined with the page: in a replacement that is a text, `$&`, `$'` and their like stand for parts
/// of the page.
#[neurotess_testing::test]
fn scripts_replace_by_functions_or_by_fixed_texts() {
    let folder = neurotess_testing::workspace().join("crates/web");
    let mut seen = 0;
    for script in ["host", "drop"].map(|name| folder.join(name)) {
        for file in std::fs::read_dir(script).expect("scripts").flatten() {
            let path = file.path();
            if path.extension().is_none_or(|end| end != "js") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a script");
            for call in text.split(".replace").skip(1) {
                let call = call.strip_prefix("All").unwrap_or(call);
                let call = call.lines().next().unwrap_or_default();
                let Some((what, by)) = call.split_once(", ") else {
                    continue;
                };
                if !what.starts_with('(') || what.contains(");") {
                    continue;
                }
                let text = by.strip_prefix('\'').and_then(|by| by.split('\'').next());
                let fixed = text.is_some_and(|text| !text.contains('$'));
                assert!(by.starts_with("() =>") || fixed, "{}: {by}", path.display());
                seen += 1;
            }
        }
    }
    assert!(seen >= 3, "{seen}");
}

#[neurotess_testing::test]
fn titles_are_text() {
    let cells = [Meshed::sample("granule")];
    let title = "a<script>alert(\"1\")</script> & b";
    let page = written(&cells, None, &PageMarkers::default(), title).expect("a page");
    let title = "<title>a&lt;script>alert(&quot;1&quot;)&lt;/script> &amp; b</title>";
    assert!(page.html.contains(title));
    // What our own forms know means nothing in it.
    let title = "{cells} {title} {name} {host} $& $` $' $1 $$ ${x} \\";
    let page = written(&cells, None, &PageMarkers::default(), title).expect("a page");
    let shown = title.replace('&', "&amp;");
    assert!(page.html.contains(&format!("<title>{shown}</title>")));
    assert_eq!(
        page.html.matches("{name}").count(),
        2,
        "the title's, and the script's"
    );
}

#[neurotess_testing::test]
fn there_must_be_something_to_show() {
    let made = written(&[], None, &PageMarkers::default(), "none");
    assert!(matches!(made, Err(WebError::Empty)));
}
