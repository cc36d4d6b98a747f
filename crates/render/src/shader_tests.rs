//! Our shaders are valid in every language, and their structs are ours.

#[path = "../../refine/tests/languages/mod.rs"]
pub(crate) mod languages;

use crate::assert_layout;
use crate::scene::templates::Base;
use crate::sources::adaptive::batch::DrawIndexed;
use crate::sources::adaptive::expand::{ExpandedVertex, GridPoint, expand_wgsl};
use crate::sources::adaptive::grids::Bucket;
use crate::sources::adaptive::passes::modules;
use crate::sources::adaptive::settings::{BatchUniforms, FrameUniforms, Placed};
use crate::sources::adaptive::work::CoarsePoint;

#[test]
fn shaders_are_valid_in_every_language_and_have_our_layouts() {
    let [_, decide, _, coarse, scan, _, list] =
        modules().map(|(name, text)| languages::check(name, &text));
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
            wireframe,
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
            soma,
            soma_count,
            quads,
            quad_count,
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
    let expand = languages::check("expand", &expand_wgsl());
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
