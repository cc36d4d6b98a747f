//! What a frame of exploration drew, read back on request: for statistics and for tests.

use super::Exploration;
use super::layout::{Piece, Sums};
use crate::device::Gpu;
use crate::error::DeviceError;
use crate::readback::read;

/// Sums of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExplorationStats {
    /// Triangles drawn.
    pub triangles: u64,
    /// The most that may be.
    pub budget: u64,
    /// Triangles that half a pixel everywhere would take.
    pub wanted: u64,
    /// Runs and somata drawn.
    pub pieces: u64,
    /// Instances that may show: not hidden, in the picture.
    pub instances: u64,
    /// All instances.
    pub all_instances: u64,
}

/// A run or a soma that was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownPiece {
    /// Place of the instance.
    pub instance: u32,
    /// Run, among those of its template.
    pub run: u32,
    /// What was drawn, in the words of `explore.wgsl`.
    pub form: u32,
    /// Quads.
    pub quads: u32,
}

impl Exploration {
    /// What the picture that was prepared last takes. Chooses once more and waits: for statistics, not
    /// for every frame.
    ///
    /// # Errors
    /// What the device complained of.
    pub fn stats(&self, gpu: &Gpu) -> Result<ExplorationStats, DeviceError> {
        let sums = self.sums(gpu)?;
        Ok(ExplorationStats {
            triangles: 2 * u64::from(sums.quads),
            budget: u64::from(self.budget),
            wanted: 2 * u64::from(sums.wanted),
            pieces: u64::from(sums.pieces),
            instances: u64::from(sums.instances),
            all_instances: self.instances.len() as u64,
        })
    }

    /// The pieces themselves, in the order in which they are drawn, as [`Exploration::stats`].
    ///
    /// # Errors
    /// What the device complained of.
    pub fn shown(&self, gpu: &Gpu) -> Result<Vec<ShownPiece>, DeviceError> {
        let sums = self.sums(gpu)?;
        let count = sums.pieces as usize;
        let pieces: Vec<Piece> = read(gpu, &self.work.pieces, count)?;
        let ends = pieces.iter().skip(1).map(|next| next.first);
        let ends = ends.chain([sums.quads]);
        Ok(pieces
            .iter()
            .zip(ends)
            .map(|(piece, end)| ShownPiece {
                instance: piece.instance,
                run: piece.run - self.first_run(piece.instance as usize),
                form: piece.form,
                quads: end - piece.first,
            })
            .collect())
    }

    fn first_run(&self, instance: usize) -> u32 {
        self.known[self.instances[instance].template.0 as usize].first_run
    }

    fn sums(&self, gpu: &Gpu) -> Result<Sums, DeviceError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let (groups, instances) = (self.groups.as_ref(), self.instances.len());
        self.passes
            .record(&mut encoder, &self.work, groups, instances, None);
        gpu.queue.submit([encoder.finish()]);
        let sums = read(gpu, &self.work.book, 1)?;
        Ok(sums.first().copied().unwrap_or_default())
    }
}
