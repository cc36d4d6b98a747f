//! Searches for the places where surfaces cross themselves, in the background.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use neurotess::generate::Generated;
use neurotess::mesh::{SurfaceMesh, Watch};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
use neurotess::union::crossing_places;

use super::Viewer;
use crate::io::task::Progress;
use crate::model::crossings::Crossing;
use crate::model::ids::SourceId;

/// The level of the surface that is searched: that of meshes if nothing else is said.
const LEVEL: u32 = 4;

impl Viewer {
    /// Takes what was found, and searches for what is missing.
    pub(super) fn update_crossings(&mut self) {
        if let Some((of, found)) = self.crossing_search.take() {
            self.state.crossings.found = Some((of, found.map(Arc::new)));
            self.state.crossings.pointed = None;
        }
        let Some(key) = self.state.crossing_key() else {
            self.crossing_search.cancel();
            return;
        };
        let known = self.state.crossings.found.as_ref();
        if known.is_some_and(|(of, _)| *of == key) || self.crossing_search.is_of(&key) {
            return;
        }
        let source = |id| Some((id, Arc::clone(&self.state.sources.get(id)?.generated)));
        let cells: Vec<_> = key.sources.iter().filter_map(|&id| source(id)).collect();
        let progress = Progress::new("searching crossings", "cells", cells.len());
        self.crossing_search
            .start(key, progress, move |progress| search(&cells, progress));
    }
}

fn search(
    cells: &[(SourceId, Arc<Generated>)],
    progress: &Progress,
) -> Result<Vec<Crossing>, String> {
    let mut list = Vec::new();
    for (source, generated) in cells {
        let watch = Watch::stopped_by(&progress.canceled);
        let level = LodCriterion::Homogeneous(LEVEL);
        let surface = Refinement::new(&generated.mesh, level, &RefineOptions::default());
        let mesh = SurfaceMesh::collect_watched(&surface, &watch).map_err(|e| e.to_string())?;
        let places = crossing_places(&mesh, &watch).map_err(|e| e.to_string())?;
        list.extend(places.into_iter().map(|place| Crossing {
            source: *source,
            place,
        }));
        progress.done.fetch_add(1, Ordering::Relaxed);
    }
    Crossing::sort(&mut list);
    Ok(list)
}
