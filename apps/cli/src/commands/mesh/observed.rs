//! A surface that measures how long its blocks take, and counts them for the progress bar.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;

use neurotess::mesh::{Faces, Format, Region, Soundness, Surface, SurfaceVertex, Unit};

use super::options::MeshOptions;
use crate::report::Progress;

/// A surface and a clock for its blocks.
pub(crate) struct Observed<'a> {
    surface: &'a dyn Surface,
    progress: Option<&'a Progress<'a>>,
    nanoseconds: AtomicU64,
    /// Blocks that the progress bar still expects: of some formats more are made than is foreseen.
    expected: AtomicUsize,
}

impl<'a> Observed<'a> {
    /// Measures a surface that goes into a file; the progress bar, if there is one, counts its blocks.
    pub(crate) fn new(
        surface: &'a dyn Surface,
        options: &MeshOptions,
        progress: Option<&'a Progress<'a>>,
    ) -> Self {
        let (vertices, faces) = passes(options);
        let expected = vertices * surface.vertex_blocks() + faces * surface.face_blocks();
        if let Some(progress) = progress {
            progress.expect(expected);
        }
        Self {
            surface,
            progress,
            nanoseconds: AtomicU64::new(0),
            expected: AtomicUsize::new(expected),
        }
    }

    /// Seconds that blocks took, summed over all threads.
    pub(crate) fn seconds(&self) -> f64 {
        self.nanoseconds.load(Ordering::Relaxed) as f64 * 1e-9
    }

    fn timed(&self, make: impl FnOnce()) {
        let clock = Instant::now();
        make();
        let nanoseconds = u64::try_from(clock.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.nanoseconds.fetch_add(nanoseconds, Ordering::Relaxed);
        let one_less = |left: usize| left.checked_sub(1);
        let order = Ordering::Relaxed;
        let foreseen = self.expected.fetch_update(order, order, one_less).is_ok();
        if let Some(progress) = self.progress.filter(|_| foreseen) {
            progress.done();
        }
    }
}

/// How often the blocks of vertices and of faces are made, about.
fn passes(options: &MeshOptions) -> (usize, usize) {
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
    fn origin(&self) -> glam::DVec3 {
        self.surface.origin()
    }

    fn unit(&self) -> Unit {
        self.surface.unit()
    }

    fn regions(&self) -> Vec<Region> {
        self.surface.regions()
    }

    fn soundness(&self) -> Option<Soundness> {
        self.surface.soundness()
    }

    fn vertex_count(&self) -> usize {
        self.surface.vertex_count()
    }

    fn triangle_count(&self) -> usize {
        self.surface.triangle_count()
    }

    fn quad_count(&self) -> usize {
        self.surface.quad_count()
    }

    fn vertex_blocks(&self) -> usize {
        self.surface.vertex_blocks()
    }

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        self.timed(|| self.surface.vertices(block, out));
    }

    fn face_blocks(&self) -> usize {
        self.surface.face_blocks()
    }

    fn faces(&self, block: usize, out: &mut Faces) {
        self.timed(|| self.surface.faces(block, out));
    }
}
