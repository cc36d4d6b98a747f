//! Progress of a picture, and a way to stop it, for another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Shared by the thread that draws and another one.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// Tiles that are done.
    pub tiles: Arc<AtomicUsize>,
    /// Set to end the picture at once, in the middle of a tile.
    pub stopped: Arc<AtomicBool>,
}

impl Watch {
    /// Whether it is to end.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Counts a tile that is done.
    pub fn note_tile(&self) {
        self.tiles.fetch_add(1, Ordering::Relaxed);
    }
}
