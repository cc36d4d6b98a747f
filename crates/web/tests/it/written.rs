//! Pages of cells of the samples and of the reference data.

use std::path::Path;

use neurotess_color::{Cell, ColorBy, ColorScheme, OwnColors, coloring};
use neurotess_formats::{ReadOptions, swc};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::CoarseMesh;
use neurotess_morphology::Morphology;
use neurotess_render::Placement;
use neurotess_render::color::{ColorMap, Palette};
use neurotess_web::{
    Page, PageCell, PageMarkers, PageOptions, PageRecording, PageScheme, WebError, page,
};

/// A cell that is meshed.
pub(crate) struct Meshed {
    pub(crate) name: String,
    pub(crate) morphology: Morphology,
    pub(crate) mesh: CoarseMesh,
}

impl Meshed {
    pub(crate) fn read(path: &Path) -> Self {
        let text = std::fs::read(path).expect("a sample");
        let name = path
            .file_stem()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let read = swc::read_bytes(&text, &name, &ReadOptions::default()).expect("a cell");
        let generated = generate(&read.morphology, &GenerateOptions::default()).expect("meshed");
        Self {
            name,
            morphology: read.morphology,
            mesh: generated.mesh,
        }
    }

    pub(crate) fn sample(name: &str) -> Self {
        let samples = neurotess_testing::workspace().join("samples");
        Self::read(&samples.join(format!("{name}.swc")))
    }

    pub(crate) fn cell(&self) -> Cell<'_> {
        Cell {
            name: &self.name,
            morphology: &self.morphology,
            mesh: &self.mesh,
            radius_factor: 1.0,
        }
    }
}

/// The schemes of the tests' pages.
pub(crate) const SCHEMES: [ColorBy; 3] = [ColorBy::Type, ColorBy::Section, ColorBy::PathDistance];

pub(crate) fn scheme() -> ColorScheme {
    ColorScheme {
        palette: Palette::NeuroM,
        own_colors: OwnColors::default(),
        background: None,
        scale: ColorMap::Viridis.scale(),
        range: None,
    }
}

/// A page of cells on white, colored by type.
pub(crate) fn written(
    cells: &[Meshed],
    recording: Option<&PageRecording>,
    markers: &PageMarkers,
    title: &str,
) -> Result<Page, WebError> {
    let all: Vec<Cell<'_>> = cells.iter().map(Meshed::cell).collect();
    let colorings = SCHEMES.map(|by| coloring(&all, by, &scheme()));
    let schemes: Vec<PageScheme<'_>> = SCHEMES
        .iter()
        .zip(&colorings)
        .map(|(&by, coloring)| PageScheme { by, coloring })
        .collect();
    let placed: Vec<PageCell<'_>> = all
        .iter()
        .map(|&cell| PageCell {
            cell,
            placement: Placement::default(),
        })
        .collect();
    let options = PageOptions {
        title: title.to_owned(),
        background: Some([255; 3]),
        palette: Palette::NeuroM,
        own_colors: OwnColors::default(),
        color_map: ColorMap::Viridis,
        scheme: Some(0),
        least_width: 1.5,
    };
    page(&placed, &schemes, recording, markers, &options)
}

/// A page of one sample.
pub(crate) fn page_of(cell: Meshed) -> (Meshed, Page) {
    let cells = [cell];
    let made = written(&cells, None, &PageMarkers::default(), &cells[0].name);
    let [cell] = cells;
    (cell, made.expect("a page"))
}
