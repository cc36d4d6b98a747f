//! The cells of a page, and what it shows of them: the text between its host and its end.

use std::io::Write;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use neurotess_color::{ColorBy, OwnColors};
use neurotess_picture::color::{ColorMap, Palette, Rgb};
use neurotess_picture::usual_least_width;
use serde::Serialize;

use crate::arrays::Arrays;
use crate::base85::base85;
use crate::cell::{CellData, MAX_PATCHES, PageCell};
use crate::error::WebError;
use crate::markers::{MarkerData, PageMarkers};
use crate::recording::{PageRecording, RecordingData};
use crate::schemes::{ColorMapData, PageScheme, PaletteData, SchemeData, color_maps, palettes};

/// What a page shows at first; all of it can be changed there.
#[derive(Clone, Debug)]
pub struct PageOptions {
    /// Its title.
    pub title: String,
    /// The background; none: as the reader's system is set, light or dark.
    pub background: Option<Rgb>,
    /// Colors of types and categories.
    pub palette: Palette,
    /// Colors of one's own, over those of the palette.
    pub own_colors: OwnColors,
    /// Colors of numbers.
    pub color_map: ColorMap,
    /// Index of the scheme that it begins with; none: the recording.
    pub scheme: Option<usize>,
    /// Least width (pixels) of neurites.
    pub least_width: f32,
}

/// All that a page's host reads of its cells.
#[derive(Serialize)]
struct PageData {
    title: String,
    background: Option<Rgb>,
    palette: &'static str,
    color_map: &'static str,
    scheme: Option<usize>,
    least_width: f32,
    cells: Vec<CellData>,
    schemes: Vec<SchemeData>,
    recording: Option<RecordingData>,
    markers: Option<MarkerData>,
    palettes: Vec<PaletteData>,
    color_maps: Vec<ColorMapData>,
}

impl PageOptions {
    /// What a page of so many cells begins with: colors of the usual palette, light or dark as the reader's system is.
    pub fn usual(title: String, cells: usize) -> Self {
        Self {
            title,
            background: None,
            palette: Palette::default(),
            own_colors: OwnColors::default(),
            color_map: ColorMap::default(),
            scheme: None,
            least_width: usual_least_width(cells),
        }
    }
}

/// Cells as the text of a page holds them.
#[derive(Clone, Debug)]
pub struct CellsText {
    /// Packed: the host unpacks it.
    pub text: String,
    /// Number of tracing points.
    pub points: usize,
    /// What they can be colored by, with the entries of each legend; scales of numbers have none.
    pub legends: Vec<(ColorBy, Vec<String>)>,
}

/// Slower than what is usual for the best, and a hundredth smaller.
const BEST: u32 = 10;

/// Most tracing points of a page. Color keys are below: they and the kind of a patch fit an f32 (shaders/even.wgsl).
pub const MAX_KEYS: usize = 1 << 20;

/// Packs the cells of a page. `schemes` color all cells in their order.
///
/// # Errors
/// There is nothing to show, or too much.
pub(crate) fn cells_text(
    cells: &[PageCell<'_>],
    schemes: &[PageScheme<'_>],
    recording: Option<&PageRecording>,
    markers: &PageMarkers,
    options: &PageOptions,
) -> Result<CellsText, WebError> {
    let points: usize = cells.iter().map(|c| c.cell.mesh.tracing.len()).sum();
    if cells.iter().all(|cell| cell.cell.mesh.patches.is_empty()) {
        return Err(WebError::Empty);
    }
    if points > MAX_KEYS {
        let most = MAX_KEYS;
        return Err(WebError::TooManyPoints { points, most });
    }
    let mut arrays = Arrays::default();
    let mut first_key = 0;
    let cells: Vec<CellData> = cells
        .iter()
        .map(|cell| {
            let data = CellData::new(cell, first_key, &mut arrays);
            first_key += cell.cell.mesh.tracing.len();
            data
        })
        .collect();
    let patches: usize = cells.iter().map(CellData::slots).sum();
    if patches > MAX_PATCHES {
        let most = MAX_PATCHES;
        return Err(WebError::TooManyPatches { patches, most });
    }
    let legends = schemes.iter().map(PageScheme::entries).collect();
    let schemes = schemes.iter();
    let data = PageData {
        title: options.title.clone(),
        background: options.background,
        palette: options.palette.name(),
        color_map: options.color_map.name(),
        scheme: options.scheme,
        least_width: options.least_width,
        cells,
        schemes: schemes
            .map(|scheme| SchemeData::new(scheme, &options.own_colors, &mut arrays))
            .collect(),
        recording: recording.map(|recording| RecordingData::new(recording, &mut arrays)),
        markers: MarkerData::new(markers, &mut arrays),
        palettes: palettes(),
        color_maps: color_maps(),
    };
    Ok(CellsText {
        text: packed_text(&data, &arrays.bytes),
        points,
        legends,
    })
}

/// JSON with its length before it and bytes behind it, compressed.
pub(crate) fn packed_text(json: &impl Serialize, bytes: &[u8]) -> String {
    let mut json = serde_json::to_vec(json).expect("our structs have string keys only");
    // What follows are numbers of 32 bits.
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::new(BEST));
    let length = (json.len() as u32).to_le_bytes();
    let written = [&length[..], &json, bytes].map(|part| encoder.write_all(part));
    debug_assert!(written.iter().all(Result::is_ok));
    let packed = encoder.finish().expect("memory takes all bytes");
    // How many bytes there are: what follows the end of a stream is an error.
    let length = (packed.len() as u32).to_be_bytes();
    base85(&[&length[..], &packed].concat())
}
