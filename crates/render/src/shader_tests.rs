//! Our shaders are valid in every language, and their structs are ours.

#[path = "../../refine/tests/languages/mod.rs"]
pub(crate) mod languages;

use crate::assert_layout;
use crate::expand::{ExpandedVertex, Wanted, expand_wgsl};
use crate::grids::Bucket;
use crate::passes::modules;
use crate::refiner::DrawIndexed;
use crate::refining::{Base, BatchWords, FrameWords, Placed};
use crate::work::CoarsePoint;

#[test]
fn shaders_are_valid_in_every_language_and_have_our_layouts() {
    let [_, decide, _, coarse, scan, _, list] =
        modules().map(|(name, text)| languages::check(name, &text));
    assert_layout!(
        &coarse,
        "CoarsePoint",
        CoarsePoint,
        [x, y, z, radius, low, high, word, instance]
    );
    assert_layout!(
        &decide,
        "Frame",
        FrameWords,
        [planes, slope, flat, smallest, wires, first_loose, levels]
    );
    assert_layout!(
        &decide,
        "Base",
        Base,
        [
            points,
            point_count,
            balls,
            loose,
            anchors,
            soma,
            soma_count,
            quads,
            quad_count,
            caps,
            words
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
            first_loose
        ]
    );
    assert_layout!(
        &decide,
        "Batch",
        BatchWords,
        [first, placed, slots, clusters, sections, loose]
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
    assert_layout!(&expand, "Wanted", Wanted, [slot, word, i, j]);
    assert_layout!(
        &expand,
        "SurfaceVertex",
        ExpandedVertex,
        [position, normal, axis, radius, word, instance, grid]
    );
}
