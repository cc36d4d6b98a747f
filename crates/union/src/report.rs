//! What a union did.

use glam::DVec3;

/// What a union did, and what it left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnionReport {
    /// Pairs of faces that crossed.
    pub pairs_before: usize,
    /// Pairs of faces that still cross. Anything but 0 is a failure that must be told.
    pub pairs: usize,
    /// Enclosed volume (µm³) before: what is enclosed twice counts twice.
    pub volume_before: f64,
    /// Enclosed volume (µm³).
    pub volume: f64,
    /// Components before.
    pub components_before: usize,
    /// Components.
    pub components: usize,
    /// Handles of all components together before: 0 for a tree.
    pub handles_before: i64,
    /// Handles of all components together; none if the result is not a closed manifold.
    pub handles: Option<i64>,
    /// Where surfaces crossed and were merged, in the order of the faces.
    pub places: Vec<Place>,
    /// Where surfaces crossed and were pressed in instead.
    pub pressed_places: Vec<Place>,
    /// Small holes that merging had made and that were filled, in the order in which they were.
    pub filled: Vec<Filled>,
    /// Components that were left out.
    pub dropped: Vec<Part>,
    /// Pieces that merging cut off and that were joined again, in the order in which they were.
    pub joined: Vec<Joined>,
    /// Components that hung together with others before, are too large to be left out, and could not be joined again.
    pub cut_off: Vec<Part>,
    /// How often the surface was cut and checked.
    pub rounds: u32,
    /// Faces of the input that are no longer there as they were.
    pub faces_changed: usize,
    /// Short edges at seams that were collapsed.
    pub collapsed: usize,
    /// Edges at seams that were flipped.
    pub flipped: usize,
    /// Vertices moved apart where sheets touched.
    pub parted: usize,
    /// Vertices at seams that were smoothed.
    pub smoothed: usize,
    /// Vertices pressed in where surfaces would have grown together.
    pub pressed: usize,
    /// Edges flipped, edges collapsed and vertices moved to make small angles larger, anywhere.
    pub improved: usize,
}

impl UnionReport {
    /// Handles that merging made: loops through two branches that grew together. For voltage or diffusion
    /// each is a short circuit.
    pub fn handles_made(&self) -> Option<i64> {
        Some(self.handles? - self.handles_before)
    }

    /// Volume after by volume before; 1 if there was none.
    pub fn volume_ratio(&self) -> f64 {
        if self.volume_before == 0.0 {
            1.0
        } else {
            self.volume / self.volume_before
        }
    }
}

/// Where surfaces crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The middle of the crossing faces (µm, in the tracing's own coordinates).
    pub position: DVec3,
    /// Pairs of faces that crossed there.
    pub pairs: usize,
    /// The file's own numbers of the tracing points of both surfaces, where they are deepest in one another.
    pub points: [i32; 2],
    /// Their sections.
    pub sections: [i32; 2],
    /// How deep (µm) one surface is within the other: an estimate, from the axes of the tubes whose
    /// skin the faces are. 0 if the vertices have no radius.
    pub depth: f64,
    /// That depth in radii of the thinner one.
    pub relative_depth: f64,
    /// Whether the surfaces belong together.
    pub kin: Kin,
}

/// Whether surfaces that cross belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kin {
    /// One section, or two that share an edge of the surface: a bend or a fork.
    Near,
    /// Sections that do not meet: branches traced through one another.
    Apart,
}

/// A hole that was filled: one handle less, or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filled {
    /// The middle of the loop around the hole (µm, in the tracing's own coordinates).
    pub position: DVec3,
    /// The file's own number of a tracing point beside it.
    pub point: i32,
    /// That point's section.
    pub section: i32,
    /// Length (µm) of the loop.
    pub girth: f64,
    /// Volume (µm³) that filling added; negative if the surface around was flattened by more.
    pub volume: f64,
}

/// Where a piece that was cut off was joined again: the surface was inside out there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joined {
    /// Between the piece and the rest (µm, in the tracing's own coordinates).
    pub position: DVec3,
    /// The file's own number of a tracing point of the piece.
    pub point: i32,
    /// That point's section.
    pub section: i32,
    /// The way (µm) over the surface that had been left out between the piece and the rest.
    pub gap: f64,
    /// Volume (µm³) that joining added.
    pub volume: f64,
}

/// A component of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The mean of its vertices (µm, in the tracing's own coordinates).
    pub position: DVec3,
    /// Its volume (µm³); negative if it bounds a cavity.
    pub volume: f64,
    /// The file's own number of a tracing point of it.
    pub point: i32,
    /// Why it is named.
    pub why: Why,
}

/// Why a component is named in a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Why {
    /// It lay inside another.
    Inside,
    /// It was turned inside out and enclosed nothing.
    Inverted,
    /// It bounded a cavity that merging had closed off.
    Cavity,
    /// A splinter of less volume than half a cube of the median radius.
    Tiny,
    /// A piece of the tracing that no longer hangs together with the rest.
    CutOff,
}
