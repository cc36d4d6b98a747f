//! A surface that measures how long its blocks take, and counts them for whoever is told how far writing is.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use neurotess_mesh::{Faces, Format, Surface, SurfaceVertex, forward_surface};

use super::options::FileOptions;
use crate::{Stage, Watch};

/// A surface and a clock for its blocks.
pub(super) struct Observed<'a> {
    surface: &'a dyn Surface,
    watch: &'a Watch<'a>,
    nanoseconds: AtomicU64,
    made: AtomicUsize,
    /// Blocks in all, about: of some formats more are made than is foreseen.
    expected: usize,
}

impl<'a> Observed<'a> {
    /// Measures a surface that goes into files.
    pub(super) fn new(
        surface: &'a dyn Surface,
        options: &FileOptions,
        watch: &'a Watch<'a>,
    ) -> Self {
        let (vertices, faces) = passes(options);
        let expected = vertices * surface.vertex_blocks() + faces * surface.face_blocks();
        watch.tell(Stage::Write, 0, expected);
        Self {
            surface,
            watch,
            nanoseconds: AtomicU64::new(0),
            made: AtomicUsize::new(0),
            expected,
        }
    }

    /// Seconds that blocks took, summed over all threads.
    pub(super) fn seconds(&self) -> f64 {
        self.nanoseconds.load(Ordering::Relaxed) as f64 * 1e-9
    }

    fn timed(&self, make: impl FnOnce()) {
        let start = self.watch.seconds();
        make();
        let nanoseconds = (self.watch.seconds() - start) * 1e9;
        self.nanoseconds
            .fetch_add(nanoseconds as u64, Ordering::Relaxed);
        let made = self.made.fetch_add(1, Ordering::Relaxed) + 1;
        if made <= self.expected {
            self.watch.tell(Stage::Write, made, self.expected);
        }
    }
}

/// How often the blocks of vertices and of faces are made, about.
fn passes(options: &FileOptions) -> (usize, usize) {
    let (vertices, faces) = match options.format {
        Format::Glb if options.materials => (1, 2),
        Format::Msh | Format::Msh2 => (4, 2),
        Format::Poly | Format::Smesh => (3, 1),
        _ => (1, 1),
    };
    match options.parts {
        // Most cells have three parts or four, which are found first.
        true => (1 + 3 * vertices, 1 + 3 * faces),
        false => (vertices, faces),
    }
}

impl Surface for Observed<'_> {
    forward_surface!(
        surface: origin unit regions soundness attributes vertex_count
        triangle_count quad_count vertex_blocks face_blocks
    );

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        self.timed(|| self.surface.vertices(block, out));
    }

    fn faces(&self, block: usize, out: &mut Faces) {
        self.timed(|| self.surface.faces(block, out));
    }
}
