//! A page with everything that cells can be colored by.

use neurotess_color::{Cell, ColorBy, ColorScheme, Coloring, coloring};

use crate::cell::PageCell;
use crate::content::{CellsText, PageOptions, cells_text};
use crate::error::WebError;
use crate::markers::PageMarkers;
#[cfg(feature = "host")]
use crate::page::Page;
use crate::recording::PageRecording;
use crate::schemes::PageScheme;

/// What readers can color cells by, in the order of the list.
const KINDS: [ColorBy; 7] = [
    ColorBy::Type,
    ColorBy::Neurite,
    ColorBy::Section,
    ColorBy::BranchOrder,
    ColorBy::PathDistance,
    ColorBy::Radius,
    ColorBy::Neuron,
];

/// Makes a page of cells that readers can color by type, neurite, section, branch order, path distance and radius, and
/// several by neuron. It begins with `first`; with the recording if that is none, or by type without a recording.
/// `options.scheme` is not used.
///
/// # Errors
/// There is nothing to show, or too much.
#[cfg(feature = "host")]
pub fn shared_page(
    cells: &[PageCell<'_>],
    scheme: &ColorScheme,
    first: Option<ColorBy>,
    recording: Option<&PageRecording>,
    markers: &PageMarkers,
    options: &PageOptions,
) -> Result<Page, WebError> {
    let packed = shared_cells(cells, scheme, first, recording, markers, options)?;
    Page::of(&options.title, &packed)
}

/// The cells of [`shared_page`], for a page whose host is there.
///
/// # Errors
/// There is nothing to show, or too much.
pub fn shared_cells(
    cells: &[PageCell<'_>],
    scheme: &ColorScheme,
    first: Option<ColorBy>,
    recording: Option<&PageRecording>,
    markers: &PageMarkers,
    options: &PageOptions,
) -> Result<CellsText, WebError> {
    // One neuron has one color.
    let kinds = &KINDS[..KINDS.len() - usize::from(cells.len() == 1)];
    let colored: Vec<Cell<'_>> = cells.iter().map(|page| page.cell).collect();
    let colorings: Vec<Coloring> = kinds
        .iter()
        .map(|&by| coloring(&colored, by, scheme))
        .collect();
    let schemes: Vec<PageScheme<'_>> = (kinds.iter().zip(&colorings))
        .map(|(&by, coloring)| PageScheme { by, coloring })
        .collect();
    let begins = match (first, recording) {
        (None, Some(_)) => None,
        (by, _) => {
            let by = by.unwrap_or_default();
            Some(kinds.iter().position(|&kind| kind == by).unwrap_or(0))
        }
    };
    let options = PageOptions {
        scheme: begins,
        ..options.clone()
    };
    cells_text(cells, &schemes, recording, markers, &options)
}

/// The title of a page of cells with these names: up to three of them, or how many there are.
pub fn usual_title(names: &[impl AsRef<str>]) -> String {
    match names.len() {
        0..=3 => names
            .iter()
            .map(AsRef::as_ref)
            .collect::<Vec<_>>()
            .join(", "),
        n => format!("{n} neurons"),
    }
}
