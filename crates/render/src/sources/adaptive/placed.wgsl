// What the shaders of a frame share: the frame's settings, placed parts and the bits of decisions.
//
// Imported by all shaders of refiner.rs. The Rust twins of the structs and the constants are in
// settings.rs.

#import plan.wgsl

// One for the whole frame. Lengths in micrometers; planes are relative to the eye.
struct Frame {
    planes: array<vec4<f32>, 5>,
    slope: f32,
    flat: f32,
    smallest: f32,
    // What the indices of flat patches say: see FlatIndices in settings.rs.
    flat_indices: u32,
    // Index of the first explicit vertex, the same in every batch: behind the slots of the largest.
    first_explicit: u32,
    @align(16) levels: LodCriterion,
}

// One part of a template where an instance puts it.
struct Placed {
    // Rows of the transform from the part's coordinates to those relative to the eye.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    // The eye in the part's coordinates.
    eye: vec3<f32>,
    scale: f32,
    forward: vec3<f32>,
    near: f32,
    base: Base,
    first_slot: u32,
    patches: u32,
    instance: u32,
    state: u32,
    // Index of its first explicit vertex.
    first_explicit: u32,
}

// Placed parts that are drawn together.
struct Batch {
    first: u32,
    placed: u32,
    slots: u32,
    clusters: u32,
    sections: u32,
    explicit_vertices: u32,
}

fn view_of(frame: Frame, place: Placed) -> LodView {
    return LodView(place.eye, frame.slope, place.forward, frame.flat / place.scale, place.near);
}

// Coordinates relative to the eye.
fn relative(place: Placed, p: vec3<f32>) -> vec3<f32> {
    let q = vec4<f32>(p, 1.0);
    return vec3<f32>(dot(place.row_x, q), dot(place.row_y, q), dot(place.row_z, q));
}

fn turned(place: Placed, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(place.row_x.xyz, v), dot(place.row_y.xyz, v), dot(place.row_z.xyz, v));
}

// A decision: the levels of a patch's four sides and its kind; 0 if it is not drawn.
fn decision(kind: u32, levels: vec4<u32>) -> u32 {
    let sides = levels.x | (levels.y << 7u) | (levels.z << 14u) | (levels.w << 21u);
    return sides | (kind << DECISION_KIND_SHIFT);
}

fn decided_levels(decided: u32) -> vec4<u32> {
    return (vec4<u32>(decided) >> vec4<u32>(0u, 7u, 14u, 21u)) & vec4<u32>(0x7fu);
}

fn decided_kind(decided: u32) -> u32 {
    return (decided >> DECISION_KIND_SHIFT) & 7u;
}

// Whether a patch is drawn as one coarse quad.
fn is_flat(decided: u32) -> bool {
    return decided != 0u && (decided & ((1u << DECISION_KIND_SHIFT) - 1u)) == FLAT_LEVELS;
}

// Index of a corner among the corners of a batch: by the ring's slot, or behind all slots for an
// explicit vertex.
fn coarse_place(place: Placed, vertex: u32) -> u32 {
    if ((vertex & EXPLICIT) != 0u) {
        return place.first_explicit + (vertex & ~EXPLICIT);
    }
    return place.first_slot + vertex;
}

// Index of the smallest grid size that holds a level.
fn size_class(level: u32) -> u32 {
    for (var k = 0u; k < GRID_SIZES; k += 1u) {
        if (GRID_SIZE[k] >= level) {
            return k;
        }
    }
    return GRID_SIZES - 1u;
}

fn bucket_of(decided: u32, caps: u32) -> u32 {
    let kind = decided_kind(decided);
    let grid = patch_grid(kind, caps, decided_levels(decided));
    let size = size_class(grid.ny) * GRID_SIZES + size_class(grid.nx);
    if (kind == DECIDED_TUBE) {
        return size;
    }
    return size + select(2u, 1u, kind == PATCH_LATERAL) * GRID_SIZES * GRID_SIZES;
}
