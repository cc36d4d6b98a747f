// What a vertex of pieces.wgsl is drawn for. Called by ids.wgsl; Rust twin: names.rs.

const POINT_BITS: u32 = 7u;

// First: the instance. Second: the run, and the point of it that the segment leads to.
fn surface_id(vertex_index: u32, instance_index: u32) -> vec2<u32> {
    let place = quad_place(vertex_index, instance_index);
    if (place >= quads[0]) {
        return vec2<u32>(0u);
    }
    let piece = pieces[quads[place + 1u]];
    return vec2<u32>(piece.instance, (piece.run << POINT_BITS) | leads_to(piece, place - piece.first));
}

fn leads_to(piece: Piece, index: u32) -> u32 {
    if ((piece.form & 7u) != WHAT_TUBE) {
        return 0u;
    }
    let run = runs[piece.run];
    let level = (piece.form >> 3u) & 7u;
    let halvings = (piece.form >> 6u) & 3u;
    let strips = max((piece.form >> 8u) & 0xffu, 1u);
    let tube_quads = (segments(run, level) << halvings) * strips;
    if (index < tube_quads) {
        return stored(run, level, ((index / strips) >> halvings) + 1u).point;
    }
    let of_start = index - tube_quads < DOME_QUADS && (run.flags & RUN_FREE_START) != 0u;
    return select(segments(run, 0u), 0u, of_start);
}
