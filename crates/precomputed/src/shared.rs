//! What all cells share: `info` files, properties and the view.

use std::io::Write;

use neurotess_batch::{read, workers};
use neurotess_formats::ReadOptions;
use neurotess_mesh::palette::Rgb;
use neurotess_output::OutputError;
use serde_json::{Value, json};

use crate::error::ExportError;
use crate::facts::{Facts, around};
use crate::multilod::mesh_info;
use crate::run::Run;
use crate::skeleton::{NM, skeleton_info};
use crate::table::Table;
use crate::view::View;

/// Most cells that are shown at first: the first view of a circuit is there soon, and its link is not too long.
const SHOWN: usize = 100;

impl<'r> Run<'r> {
    /// What is known of each tracing; none of those that no cell has, and of those that cannot be read, which are told of
    /// when their cells are made.
    pub(crate) fn facts(&self) -> Result<Vec<Option<Facts>>, ExportError> {
        let uses = self.source.uses();
        let order: Vec<usize> = (0..uses.len()).collect();
        let of = |&uses: &(usize, u32)| {
            let (template, uses) = uses;
            let tracing = (uses > 0 && !self.is_stopped())
                .then(|| read(self.source.file(template), None, &ReadOptions::default()).ok())??;
            Some(Facts::of(&tracing.morphology))
        };
        let items: Vec<(usize, u32)> = uses.into_iter().enumerate().collect();
        let facts = workers::run(&items, &order, self.threads, of)?;
        Ok(facts
            .into_iter()
            .map(|facts| facts.ok().flatten())
            .collect())
    }

    /// The cells that can be read.
    pub(crate) fn table<'t>(&self, facts: &'t [Option<Facts>]) -> Table<'t>
    where
        'r: 't,
    {
        Table::new(self.source, facts, self.ids)
    }

    /// Writes `info` files and properties.
    pub(crate) fn infos(&self, table: &Table<'_>) -> Result<(), OutputError> {
        // Names the others, for programs that open a volume.
        let volume = json!({
            "@type": "neuroglancer_multiscale_volume",
            "type": "segmentation",
            "data_type": "uint64",
            "num_channels": 1,
            "mesh": "mesh",
            "skeletons": "skeletons",
            "segment_properties": "properties",
            "scales": [{
                "key": "none",
                "size": [1, 1, 1],
                "resolution": [1, 1, 1],
                "voxel_offset": [0, 0, 0],
                "chunk_sizes": [[1, 1, 1]],
                "encoding": "raw",
            }],
        });
        let json =
            |name: &str, value: &Value| self.folder.shared(name, |to| writeln!(to, "{value:#}"));
        json("info", &volume)?;
        json("mesh/info", &mesh_info(self.sharding))?;
        json("skeletons/info", &skeleton_info(self.sharding))?;
        self.folder.shared("properties/info", |to| table.write(to))
    }

    /// Writes the view: up to a hundred cells, evenly from all.
    pub(crate) fn view(
        &self,
        table: &Table<'_>,
        url: &str,
        color: &dyn Fn(usize) -> Option<Rgb>,
        synapses: bool,
    ) -> Result<View, OutputError> {
        let rows = table.cells.len();
        let shown = rows.min(SHOWN);
        let shown: Vec<usize> = (0..shown).map(|n| n * rows / shown).collect();
        let boxes = shown.iter().filter_map(|&row| {
            let (facts, place) = table.row(row);
            facts.bounds_at(place)
        });
        let (min, max) = around(boxes.flat_map(|(min, max)| [min, max]));
        let bounds = match min.is_finite() && max.is_finite() {
            true => (min * NM, max * NM),
            false => (glam::DVec3::ZERO, glam::DVec3::ONE),
        };
        let view = View {
            url: url.to_owned(),
            segments: shown
                .iter()
                .map(|&row| (table.ids[row], color(table.cells[row])))
                .collect(),
            synapses,
            bounds,
        };
        self.folder
            .shared("view.json", |to| writeln!(to, "{:#}", view.state()))?;
        Ok(view)
    }
}
