//! The shaders of pictures are valid in every language, and their structs are ours.

use crate::assert_layout;
use crate::output::ids::ids_text;
use crate::shader_tests::languages;
use crate::shading::finish::{Finish, Last, finish_text};
use crate::shading::present::{Present, mask_text};
use crate::shading::shade::{PipelineKey, Shade, shader_text};
use crate::sources::adaptive::refiner::Refiner;
use crate::sources::prerefined::{Placement, StoredVertex, WGSL};

#[test]
fn picture_shaders_are_valid_in_every_language_and_have_our_layouts() {
    for samples in [1, 4] {
        for barycentric in [false, true] {
            let source = format!("const BARYCENTRIC: bool = {barycentric};\n{WGSL}");
            let module = languages::check(
                "shade",
                &shader_text(
                    &source,
                    PipelineKey {
                        samples,
                        valued: samples > 1,
                        ..PipelineKey::default()
                    },
                ),
            );
            assert_layout!(
                &module,
                "Shade",
                Shade,
                [
                    clip_from_relative,
                    right,
                    near,
                    up,
                    slope,
                    backward,
                    half_width,
                    key,
                    wire,
                    size,
                    tile_origin,
                    viewport_origin,
                    viewport_size,
                    lit,
                    scale_entries,
                    colors,
                    valued,
                    shift,
                    ghosted,
                    clip,
                    highlighted,
                    jitter,
                    batch,
                    pad,
                    edge
                ]
            );
            assert_layout!(
                &module,
                "StoredVertex",
                StoredVertex,
                [x, y, z, radius, normal, color_key]
            );
            assert_layout!(
                &module,
                "Placement",
                Placement,
                [relative_from_mesh, instance]
            );
        }
        languages::check("live", &finish_text(samples, Last::Accumulate));
        let module = languages::check("finish", &finish_text(samples, Last::Gather));
        assert_layout!(
            &module,
            "Finish",
            Finish,
            [
                tile_size,
                tile_origin,
                half_size,
                slope,
                scale,
                radius,
                most,
                margin,
                clear,
                kept,
                spare,
                empty,
                background
            ]
        );
    }
}

#[test]
fn window_shaders_are_valid_in_every_language_and_have_our_layouts() {
    let id = include_str!("sources/adaptive/surface_id.wgsl");
    for shader in 0..Refiner::SHADERS {
        languages::check("ids", &ids_text(&Refiner::vertex_wgsl(shader), id));
    }
    for samples in [1, 4] {
        languages::check("mask of a draft", &mask_text(samples));
    }
    let module = languages::check("present", include_str!("shading/present.wgsl"));
    assert_layout!(
        &module,
        "Present",
        Present,
        [size, width, spare, selected, hovered]
    );
}
