//! What the shaders of exploration mode share with the host: constants, and structs that are twins
//! of those in budgeted.wgsl and selection.wgsl.

use bytemuck::{Pod, Zeroable};
use neurotess_refine::wgsl::Constants;

/// Most segments of a chunk.
pub(crate) const MAX_SEGMENTS: usize = 64;
/// Polylines that a chunk is stored as: one of all its points, and ever coarser ones.
pub(crate) const LEVELS: usize = 7;
/// Number of chunks that one workgroup handles, a lane for each.
pub(crate) const CLUSTER: usize = 64;
/// Size of the workgroups that compute sums.
pub(crate) const WIDE: usize = 256;
/// Bins of the histogram of quads by worth.
pub(crate) const BINS: usize = 4096;
/// Bins of the histogram per octave of worth.
pub(crate) const BINS_OF_OCTAVE: f32 = 96.0;
/// Binary logarithm of the worth (square pixels per quad) at which the bins begin.
pub(crate) const LOWEST_OCTAVE: f32 = -20.0;
/// Quads of a full block of the draw.
pub(crate) const BLOCK: usize = 1024;
/// Groups side by side in a dispatch: some devices take no more than 65,535.
pub(crate) const ROW: usize = 32_768;
/// An error is stored as a byte that means `2^(byte / ERROR_STEPS - ERROR_OFFSET)` µm.
pub(crate) const ERROR_STEPS: f32 = 8.0;
pub(crate) const ERROR_OFFSET: f32 = 20.0;
/// Error byte of a level of detail that a chunk does not have.
pub(crate) const NO_LOD: u8 = 255;
/// Edge (µm) of the cells that positions in the world are relative to.
pub(crate) const CELL: f64 = 1024.0;
/// Equal to [`neurotess_refine`]'s constant of the same name: a path sways by no more than this
/// share of the radius.
pub(crate) const MAX_SWAY: f32 = 0.12;

/// Flags of a chunk: it is a soma; nothing closes it at its start; nothing closes it at its end.
pub(crate) const CHUNK_SOMA: u32 = 1;
pub(crate) const CHUNK_FREE_START: u32 = 2;
pub(crate) const CHUNK_FREE_END: u32 = 4;
/// Flag of a chunk that has a single color key; others have one per point.
pub(crate) const CHUNK_ONE_COLOR_KEY: u32 = 8;

/// Flag of a **twig**: a short branch that carries nothing, such as a spine. Where it is short in the picture it is left
/// out, and the chunk that it leaves is as much wider as its twigs have area.
pub(crate) const CHUNK_TWIG: u32 = 16;
/// First bits of what a chunk knows of its twigs: how much wider it is without them, `2^(bits / TWIG_STEPS)` times, and
/// their mean length, `2^(bits / TWIG_STEPS - TWIG_OFFSET)` µm. It has none if the latter is 0.
pub(crate) const CHUNK_WIDER_SHIFT: u32 = 5;
pub(crate) const CHUNK_TWIGS_SHIFT: u32 = 10;
const WIDER_BITS: u32 = CHUNK_TWIGS_SHIFT - CHUNK_WIDER_SHIFT;
const TWIGS_BITS: u32 = 16 - CHUNK_TWIGS_SHIFT;
pub(crate) const TWIG_STEPS: f32 = 8.0;
pub(crate) const TWIG_OFFSET: f32 = 4.0;
/// Longest twig (µm): longer than all spines that were measured.
pub(crate) const LONGEST_TWIG: f32 = 5.0;
/// Length (pixels) up to which a twig is left out, and from which on it has its whole width.
pub(crate) const TWIG_FADES: [f32; 2] = [0.4, 0.8];

impl Chunk {
    /// Notes twigs that leave the chunk: how many there are, and their length and area (µm, µm²) in all. Areas are as
    /// seen from the side.
    pub(super) fn note_twigs(&mut self, count: u32, length: f32, area: f32) {
        let own = (2.0 * self.mean() * self.length).max(f32::MIN_POSITIVE);
        let bits = |exponent: f32, least: u32, bits: u32| {
            let most = (1 << bits) - 1;
            ((exponent * TWIG_STEPS).round().max(0.0) as u32).clamp(least, most)
        };
        let wider = bits((1.0 + area / own).log2(), 0, WIDER_BITS);
        let mean = length / count.max(1) as f32;
        let long = bits(mean.log2() + TWIG_OFFSET, 1, TWIGS_BITS);
        self.flags |= (wider << CHUNK_WIDER_SHIFT) | (long << CHUNK_TWIGS_SHIFT);
    }

    /// Mean radius (µm).
    pub(crate) fn mean(&self) -> f32 {
        self.radius * ((self.flags >> 16) as f32 / 65_535.0)
    }

    /// Flags, with the mean radius in the upper 16 bits.
    pub(crate) fn marks(flags: u32, mean: f32, radius: f32) -> u32 {
        let share = mean / radius.max(f32::MIN_POSITIVE);
        flags | (((share * 65_535.0).round().clamp(0.0, 65_535.0) as u32) << 16)
    }
}

/// Flag of an instance that is not drawn.
pub(crate) const HIDDEN: u32 = 1;

/// What a chunk is drawn as: the lowest bits of a packed level of detail.
const WHAT_TUBE: u32 = 0;
const WHAT_DOT: u32 = 1;
const WHAT_DISC: u32 = 2;
const WHAT_DOME: u32 = 3;
const WHAT_SOMA: u32 = 4;
/// First bits of the other fields of a packed level of detail: index of the polyline, halvings of
/// its segments, strips around it, and the share of its width that is drawn.
const LOD_LEVEL_SHIFT: u32 = 3;
const LOD_HALVINGS_SHIFT: u32 = 6;
const LOD_STRIPS_SHIFT: u32 = 8;
const LOD_WIDTH_SHIFT: u32 = 16;
/// All of the width.
const FULL_WIDTH: u32 = 63;

/// Up to 64 segments of a path, or a soma.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Chunk {
    /// Bounding sphere of its surface (µm, in the template).
    pub(crate) center: [f32; 3],
    pub(crate) reach: f32,
    /// Stored positions are counted from here, in steps of this length (µm).
    pub(crate) low: [f32; 3],
    pub(crate) step: f32,
    /// A byte for each of the polylines 0 to 6: number of segments. Of a soma: numbers of quads and
    /// of vertices.
    pub(crate) counts: [u32; 2],
    /// A byte for each polyline: its error.
    pub(crate) errors: [u32; 2],
    /// Index in the packed buffer at which its points begin; lists of kept points follow.
    pub(crate) first: u32,
    /// Its single color key, or the index of its first one.
    pub(crate) color_keys: u32,
    /// Flags, and from bit 16 on the mean radius in 65,535 steps of the greatest.
    pub(crate) flags: u32,
    /// Greatest radius (µm).
    pub(crate) radius: f32,
    /// Length of the path (µm).
    pub(crate) length: f32,
    /// The greatest product of length and square root of the mean radius (µm^1.5) among it and all
    /// chunks that branch off behind it: the shading draws thin lines with an opacity that grows
    /// with the root.
    pub(crate) carried: f32,
    /// Packed directions of the path at its ends.
    pub(crate) start: u32,
    pub(crate) end: u32,
}

/// A template: its bounding sphere and its chunks, somata first, then by what they carry.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Shape {
    pub(crate) center: [f32; 3],
    pub(crate) reach: f32,
    pub(crate) first_chunk: u32,
    pub(crate) chunks: u32,
    /// Number of chunks that are somata, and the greatest radius (µm) of them.
    pub(crate) somata: u32,
    pub(crate) soma_radius: f32,
    /// Number of chunks before those that are twigs up to the last one, and the greatest length (µm) of these.
    pub(crate) before_twigs: u32,
    pub(crate) twig_length: f32,
    pub(crate) pad: [u32; 2],
}

/// An instance with its placement. A point p, relative to the template's origin, is in the world at
/// `cell · CELL + offset + scale · rotation · p`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct GpuInstance {
    pub(crate) rotation: [f32; 4],
    pub(crate) offset: [f32; 3],
    pub(crate) scale: f32,
    pub(crate) cell: [i32; 3],
    pub(crate) shape: u32,
    pub(crate) flags: u32,
    pub(crate) state: u32,
    pub(crate) pad: [u32; 2],
}

/// The camera and the limits of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Eye {
    /// Planes of the frustum, relative to the eye.
    pub(crate) planes: [[f32; 4]; 5],
    pub(crate) cell: [i32; 3],
    /// What each µm of depth adds to the size (µm) of a pixel.
    pub(crate) slope: f32,
    pub(crate) offset: [f32; 3],
    pub(crate) near: f32,
    pub(crate) forward: [f32; 3],
    /// Greatest distance (pixels) of what is drawn from the true surface.
    pub(crate) error: f32,
    /// Most quads of the frame.
    pub(crate) budget: u32,
    pub(crate) instances: u32,
    /// Size (µm) of a pixel at every depth: 0 with perspective.
    pub(crate) flat: f32,
    pub(crate) pad: u32,
}

/// Sums of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Sums {
    /// Chunks that are measured.
    pub(crate) chunks: u32,
    /// Those of which anything is drawn.
    pub(crate) visible: u32,
    /// Least bin of the histogram that is drawn.
    pub(crate) threshold: u32,
    /// Quads drawn, and the visible chunks that they belong to.
    pub(crate) quads: u32,
    pub(crate) visible_chunks: u32,
    /// Quads that would be drawn without a budget.
    pub(crate) wanted: u32,
    /// Instances that may show.
    pub(crate) instances: u32,
    /// Least bin that must be measured in the next frame, or the next round of this one.
    pub(crate) floor: u32,
    /// Times that the selection was repeated with a lower floor.
    pub(crate) rounds: u32,
    /// 1 until the selection is complete.
    pub(crate) open: u32,
    pub(crate) pad: [u32; 2],
}

/// What is selected from an instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Extent {
    /// Index of its first chunk among all that are measured.
    pub(crate) first: u32,
    /// Number of its chunks that may be worth the floor.
    pub(crate) chunks: u32,
}

/// A chunk or soma that is drawn.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct VisibleChunk {
    pub(crate) instance: u32,
    pub(crate) chunk: u32,
    /// Its level of detail, as `packed_lod` in budgeted.wgsl packs it.
    pub(crate) lod: u32,
    /// Index of its first quad.
    pub(crate) first: u32,
}

/// Constants that the shaders of exploration mode share with Rust.
pub(crate) fn constants() -> Constants {
    let mut constants = Constants::default();
    for (name, value) in [
        ("LEVELS", LEVELS as u32),
        ("CLUSTER", CLUSTER as u32),
        ("WIDE", WIDE as u32),
        ("BINS", BINS as u32),
        ("BLOCK", BLOCK as u32),
        ("ROW", ROW as u32),
        ("NO_LOD", u32::from(NO_LOD)),
        ("CHUNK_SOMA", CHUNK_SOMA),
        ("CHUNK_FREE_START", CHUNK_FREE_START),
        ("CHUNK_FREE_END", CHUNK_FREE_END),
        ("CHUNK_ONE_COLOR_KEY", CHUNK_ONE_COLOR_KEY),
        ("CHUNK_TWIG", CHUNK_TWIG),
        ("CHUNK_WIDER_SHIFT", CHUNK_WIDER_SHIFT),
        ("WIDER_BITS", WIDER_BITS),
        ("CHUNK_TWIGS_SHIFT", CHUNK_TWIGS_SHIFT),
        ("TWIGS_BITS", TWIGS_BITS),
        ("HIDDEN", HIDDEN),
        ("LOD_LEVEL_SHIFT", LOD_LEVEL_SHIFT),
        ("LOD_HALVINGS_SHIFT", LOD_HALVINGS_SHIFT),
        ("LOD_STRIPS_SHIFT", LOD_STRIPS_SHIFT),
        ("LOD_WIDTH_SHIFT", LOD_WIDTH_SHIFT),
        ("FULL_WIDTH", FULL_WIDTH),
        ("WHAT_TUBE", WHAT_TUBE),
        ("WHAT_DOT", WHAT_DOT),
        ("WHAT_DISC", WHAT_DISC),
        ("WHAT_DOME", WHAT_DOME),
        ("WHAT_SOMA", WHAT_SOMA),
    ] {
        constants.u32(name, value);
    }
    for (name, value) in [
        ("BINS_OF_OCTAVE", BINS_OF_OCTAVE),
        ("LOWEST_OCTAVE", LOWEST_OCTAVE),
        ("ERROR_STEPS", ERROR_STEPS),
        ("ERROR_OFFSET", ERROR_OFFSET),
        ("TWIG_STEPS", TWIG_STEPS),
        ("TWIG_OFFSET", TWIG_OFFSET),
        ("TWIG_FADES_FROM", TWIG_FADES[0]),
        ("TWIG_FADES_TO", TWIG_FADES[1]),
        ("CELL", CELL as f32),
    ] {
        constants.f32(name, value);
    }
    constants
}
