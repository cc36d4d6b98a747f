//! Shaders of exploration are valid in every language, and their structs are ours.

use super::layout::{Eye, MOST_SWAY, Piece, Run, Shape, Standing, Sums};
use super::passes::{Arguments, Live, choose_wgsl, pieces_wgsl};
use crate::SURFACE_VERTEX_WGSL;
use crate::assert_layout;
use crate::shade::{Way, shader_text};
use crate::shader_tests::languages;

#[test]
fn shaders_are_valid_in_every_language_and_have_our_layouts() {
    let choose = languages::check("choose", &choose_wgsl());
    assert_layout!(
        &choose,
        "Eye",
        Eye,
        [
            planes, cell, slope, offset, near, forward, error, budget, instances, pad
        ]
    );
    assert_layout!(
        &choose,
        "Run",
        Run,
        [
            center, reach, low, step, counts, errors, first, words, flags, radius, length, carried,
            start, end
        ]
    );
    assert_layout!(
        &choose,
        "Shape",
        Shape,
        [center, reach, first_run, runs, pad]
    );
    assert_layout!(
        &choose,
        "Standing",
        Standing,
        [rotation, offset, scale, cell, shape, flags, state, pad]
    );
    assert_layout!(
        &choose,
        "Sums",
        Sums,
        [
            chunks, live, threshold, quads, pieces, wanted, instances, pad
        ]
    );
    assert_layout!(&choose, "Piece", Piece, [instance, run, form, first]);
    assert_layout!(&choose, "Live", Live, [chunk, quads, pieces]);
    assert_layout!(&choose, "Arguments", Arguments, [chunks, live, draws]);
    for samples in [1, 4] {
        languages::check(
            "pieces",
            &shader_text(
                &pieces_wgsl(),
                Way {
                    samples,
                    valued: samples > 1,
                    ..Way::default()
                },
            ),
        );
    }
    assert!(SURFACE_VERTEX_WGSL.contains("SurfaceVertex"));
}

#[test]
fn paths_sway_as_refined_ones_do() {
    let wanted = format!("const MOST_SWAY: f32 = {MOST_SWAY:?};");
    assert!(neurotess_refine::gpu::prelude().contains(&wanted));
}
