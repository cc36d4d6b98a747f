//! Shaders of exploration are valid in every language, and their structs are ours.

use super::layout::{Chunk, Eye, GpuInstance, MOST_SWAY, Shape, Sums, VisibleChunk};
use super::passes::{Arguments, VisibleCluster, select_wgsl, visible_chunks_wgsl};
use crate::SURFACE_VERTEX_WGSL;
use crate::assert_layout;
use crate::shader_tests::languages;
use crate::shading::shade::{PipelineKey, shader_text};

#[test]
fn shaders_are_valid_in_every_language_and_have_our_layouts() {
    let choose = languages::check("choose", &select_wgsl());
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
        "Chunk",
        Chunk,
        [
            center, reach, low, step, counts, errors, first, color_keys, flags, radius, length,
            carried, start, end
        ]
    );
    assert_layout!(
        &choose,
        "Shape",
        Shape,
        [center, reach, first_chunk, chunks, pad]
    );
    assert_layout!(
        &choose,
        "GpuInstance",
        GpuInstance,
        [rotation, offset, scale, cell, shape, flags, state, pad]
    );
    assert_layout!(
        &choose,
        "Sums",
        Sums,
        [
            clusters,
            visible,
            threshold,
            quads,
            visible_chunks,
            wanted,
            instances,
            pad
        ]
    );
    assert_layout!(
        &choose,
        "VisibleChunk",
        VisibleChunk,
        [instance, chunk, lod, first]
    );
    assert_layout!(
        &choose,
        "VisibleCluster",
        VisibleCluster,
        [cluster, quads, visible_chunks]
    );
    assert_layout!(&choose, "Arguments", Arguments, [clusters, visible, draws]);
    for samples in [1, 4] {
        languages::check(
            "visible_chunks",
            &shader_text(
                &visible_chunks_wgsl(),
                PipelineKey {
                    samples,
                    valued: samples > 1,
                    ..PipelineKey::default()
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
