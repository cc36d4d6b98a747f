//! Tests that all shaders are valid in every language, and that their structs equal those of Rust.

mod bindings;

use neurotess_refine::{assert_layout, testing};

use crate::gpu::shader;
use crate::output::ids::ids_shader;
use crate::output::static_picture::collect::collect_shader;
use crate::output::static_picture::recolor::{Recolor, recolor_shader};
use crate::scene::templates::Base;
use crate::shading::finish::{Finish, Last, finish_shader};
use crate::shading::present::{Present, mask_shader, present_shader};
use crate::shading::shade::{PipelineKey, Shade, shade_shader};
use crate::sources::adaptive::batch::DrawIndexed;
use crate::sources::adaptive::expand::{ExpandedVertex, GridPoint, expand_shader};
use crate::sources::adaptive::grids::Bucket;
use crate::sources::adaptive::passes::modules;
use crate::sources::adaptive::refiner::Refiner;
use crate::sources::adaptive::settings::{BatchUniforms, FrameUniforms, Placed};
use crate::sources::adaptive::work::CoarsePoint;
use crate::sources::budgeted;
use crate::sources::budgeted::layout::{
    Chunk, Extent, Eye, GpuInstance, MAX_SWAY, Shape, Sums, VisibleChunk,
};
use crate::sources::budgeted::passes::{Arguments, Measured, VisibleCluster, select_shader};
use crate::sources::markers::{self, MarkerFrame, StoredMarker};
use crate::sources::meshes::{self, MeshFrame, MeshVertex};
use crate::sources::prerefined::{self, Placement, StoredVertex};
use neurotess_picture::recolor::Weighed;
use neurotess_picture::recolor::Weight;

#[test]
fn adaptive_shaders_are_valid_in_every_language_and_have_our_structs() {
    let [_, decide, _, coarse, scan, _, list] = modules().map(|shader| testing::check(&shader).0);
    assert_layout!(
        &coarse,
        "CoarsePoint",
        CoarsePoint,
        [x, y, z, radius, low, high, color_key, instance]
    );
    assert_layout!(
        &decide,
        "Frame",
        FrameUniforms,
        [
            planes,
            slope,
            flat,
            smallest,
            flat_indices,
            first_explicit,
            levels
        ]
    );
    assert_layout!(
        &decide,
        "Base",
        Base,
        [
            points,
            point_count,
            spheres,
            explicit_vertices,
            anchors,
            shaped,
            soma,
            soma_count,
            quads,
            caps,
            color_keys
        ]
    );
    assert_layout!(
        &decide,
        "Placed",
        Placed,
        [
            row_x,
            row_y,
            row_z,
            eye,
            scale,
            forward,
            near,
            base,
            first_slot,
            patches,
            instance,
            state,
            first_explicit
        ]
    );
    assert_layout!(
        &decide,
        "Batch",
        BatchUniforms,
        [first, placed, slots, clusters, sections, explicit_vertices]
    );
    let (expand, _) = testing::check(&expand_shader());
    for module in [&scan, &list, &expand] {
        assert_layout!(
            module,
            "Bucket",
            Bucket,
            [start, count, together, indices, first_index]
        );
    }
    assert_layout!(
        &scan,
        "DrawIndexed",
        DrawIndexed,
        [
            index_count,
            instance_count,
            first_index,
            base_vertex,
            first_instance
        ]
    );
    assert_layout!(&expand, "GridPoint", GridPoint, [slot, decided, i, j]);
    assert_layout!(
        &expand,
        "SurfaceVertex",
        ExpandedVertex,
        [position, normal, axis, radius, color_key, instance, grid]
    );
}

#[test]
fn shaders_of_static_pictures_are_valid_in_every_language_and_have_our_structs() {
    let (collect, _) = testing::check(&collect_shader(4));
    assert_layout!(
        &collect,
        "Weighed",
        Weighed,
        [pixel, color_key, instance, low, high]
    );
    let (recolor, _) = testing::check(&recolor_shader());
    assert_layout!(
        &recolor,
        "Recolor",
        Recolor,
        [background, edge, pixels, row, transparent, empty]
    );
    assert_layout!(&recolor, "Weight", Weight, [color, low, high]);
}

#[test]
fn picture_shaders_are_valid_in_every_language_and_have_our_structs() {
    for samples in [1, 4] {
        for barycentric in [false, true] {
            let key = PipelineKey {
                samples,
                valued: samples > 1,
                edged: barycentric,
                ..PipelineKey::default()
            };
            let source = prerefined::vertex_shader(barycentric);
            let (module, _) = testing::check(&shade_shader(&source, key));
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
                    least_half_width,
                    edge,
                    flat,
                    steps,
                    turn
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
        testing::check(&finish_shader(samples, Last::Accumulate));
        let (module, _) = testing::check(&finish_shader(samples, Last::Gather));
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
                tiled,
                clear,
                kept,
                spare,
                empty,
                background,
                flat,
                inset
            ]
        );
    }
}

#[test]
fn window_shaders_are_valid_in_every_language_and_have_our_structs() {
    let id = shader::file("surface_id.wgsl");
    for shader in 0..Refiner::SHADERS {
        testing::check(&ids_shader(&Refiner::vertex_shader(shader), id));
    }
    let id = shader::file("visible_chunks_id.wgsl");
    testing::check(&ids_shader(&budgeted::passes::vertex_shader(), id));
    for samples in [1, 4] {
        testing::check(&mask_shader(samples));
    }
    let (module, _) = testing::check(&present_shader());
    assert_layout!(
        &module,
        "Present",
        Present,
        [size, width, opacity, selected, hovered]
    );
}

#[test]
fn marker_shaders_are_valid_in_every_language_and_have_our_structs() {
    let source = markers::vertex_shader();
    for samples in [1, 4] {
        let key = PipelineKey {
            samples,
            valued: samples > 1,
            edged: samples > 1,
            ..PipelineKey::default()
        };
        let (module, _) = testing::check(&shade_shader(&source, key));
        assert_layout!(
            &module,
            "StoredMarker",
            StoredMarker,
            [x, y, z, color_key, outwards]
        );
        assert_layout!(
            &module,
            "MarkerFrame",
            MarkerFrame,
            [
                relative_from_block,
                radius,
                right,
                near,
                up,
                least,
                backward,
                first,
                pixel_slope,
                pixel_flat
            ]
        );
    }
}

#[test]
fn mesh_shaders_are_valid_in_every_language_and_have_our_structs() {
    let source = meshes::vertex_shader();
    for samples in [1, 4] {
        let key = PipelineKey {
            samples,
            valued: samples > 1,
            edged: samples > 1,
            ..PipelineKey::default()
        };
        let (module, _) = testing::check(&shade_shader(&source, key));
        assert_layout!(&module, "MeshVertex", MeshVertex, [x, y, z, normal]);
        assert_layout!(
            &module,
            "MeshFrame",
            MeshFrame,
            [
                relative_from_mesh,
                opacity,
                color_key,
                number,
                edges,
                first_half,
                scale,
                keyed
            ]
        );
    }
}

#[test]
fn budgeted_shaders_are_valid_in_every_language_and_have_our_structs() {
    let (select, _) = testing::check(&select_shader());
    assert_layout!(
        &select,
        "Eye",
        Eye,
        [
            planes, cell, slope, offset, near, forward, error, budget, instances, flat, pad
        ]
    );
    assert_layout!(
        &select,
        "Chunk",
        Chunk,
        [
            center, reach, low, step, counts, errors, first, color_keys, flags, radius, length,
            carried, start, end
        ]
    );
    assert_layout!(
        &select,
        "Shape",
        Shape,
        [
            center,
            reach,
            first_chunk,
            chunks,
            somata,
            soma_radius,
            before_twigs,
            twig_length,
            pad
        ]
    );
    assert_layout!(
        &select,
        "GpuInstance",
        GpuInstance,
        [rotation, offset, scale, cell, shape, flags, state, pad]
    );
    assert_layout!(
        &select,
        "Sums",
        Sums,
        [
            chunks,
            visible,
            threshold,
            quads,
            visible_chunks,
            wanted,
            instances,
            floor,
            rounds,
            open,
            pad
        ]
    );
    assert_layout!(
        &select,
        "VisibleChunk",
        VisibleChunk,
        [instance, chunk, lod, first]
    );
    assert_layout!(
        &select,
        "VisibleCluster",
        VisibleCluster,
        [
            cluster,
            first_instance,
            last_instance,
            quads,
            visible_chunks
        ]
    );
    assert_layout!(&select, "Extent", Extent, [first, chunks]);
    assert_layout!(&select, "Measured", Measured, [instance, best]);
    assert_layout!(
        &select,
        "Arguments",
        Arguments,
        [clusters, visible, draws, again]
    );
    for samples in [1, 4] {
        testing::check(&shade_shader(
            &budgeted::passes::vertex_shader(),
            PipelineKey {
                samples,
                valued: samples > 1,
                edged: samples > 1,
                ..PipelineKey::default()
            },
        ));
    }
}

#[test]
fn paths_sway_as_refined_ones_do() {
    let mut wanted = neurotess_refine::wgsl::Constants::default();
    wanted.f32("MAX_SWAY", MAX_SWAY);
    assert!(neurotess_refine::gpu::constants().contains(&wanted));
}

#[test]
fn shaders_for_other_hosts_are_valid_in_every_language() {
    use crate::output::host;
    let all = host::drawing_shaders()
        .into_iter()
        .chain(host::id_shaders());
    for shader in all.chain([host::marker_shader(), host::finishing_shader()]) {
        testing::check(&shader);
    }
    let numbers = host::numbers();
    for name in [
        "CLUSTER",
        "SECTION",
        "BUCKETS",
        "POINT_KIND_SHIFT",
        "CATEGORY_BIT",
    ] {
        assert!(numbers.iter().any(|(known, _)| known == name), "{name}");
    }
}
