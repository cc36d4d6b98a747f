//! A page instead of a picture: cells as HTML, with what the same options say of colors, recordings and markers.

mod markers;
mod recording;

use neurotess_circuit::{Circuit, NodeRef};
use neurotess_color::{Cell, ColorScheme, OwnNumbers, Recording};
use neurotess_options::words::ColorWhat;
use neurotess_options::{OptionError, Picture};
use neurotess_picture::Look;
use neurotess_web::{
    self as web, PageCell, PageOptions, PageRecording, WebError, shared_page, usual_title,
};

use crate::error::DrawError;
use crate::host::Host;
use recording::page_recording;

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// Options, or what they name, as of a picture.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// Cells that a page cannot show.
    #[error(transparent)]
    Page(#[from] WebError),
}

impl From<OptionError> for PageError {
    fn from(error: OptionError) -> Self {
        Self::Draw(error.into())
    }
}

/// What a page shows.
#[derive(Clone, Copy, Debug)]
pub struct PageContent<'a> {
    /// Meshed cells at their places.
    pub cells: &'a [PageCell<'a>],
    /// The circuit that they are of, and their nodes.
    pub circuit: Option<(&'a Circuit, &'a [NodeRef])>,
    /// The title; none: their names.
    pub title: Option<&'a str>,
}

/// Values that a page shows instead of those of a report.
#[derive(Clone, Debug)]
pub enum PageValues {
    /// Numbers of the cells.
    Own(OwnNumbers),
    /// As they are played.
    Played(PageRecording),
}

/// A page, and what is played on it.
#[derive(Debug)]
pub struct MadePage {
    /// The page.
    pub page: web::Page,
    /// Whether it shows values.
    pub has_values: bool,
    /// Times (ms) of the frames that are played.
    pub times: Vec<f64>,
}

/// Makes a page: of a picture, it takes colors, background, least width, report and time, synapses and points.
///
/// # Errors
/// Wrong options; a report, synapses or points that are invalid; cells that a page cannot show.
pub fn page(
    content: &PageContent<'_>,
    picture: &Picture,
    values: Option<PageValues>,
    host: &dyn Host,
) -> Result<MadePage, PageError> {
    let (colors, look) = (&picture.colors, &picture.look);
    if colors.color_by_attribute.is_some() {
        let why = "pages have no --color-by-attribute: use neurotess render";
        return Err(OptionError::together(why).into());
    }
    picture.markers.check()?;
    let cells: Vec<Cell<'_>> = content.cells.iter().map(|page| page.cell).collect();
    let recording = played(content, picture, (&cells, values), host)?;
    let scheme = ColorScheme {
        background: None,
        scale: colors.colormap.scale(),
        range: colors.range.filter(|_| recording.is_none()),
        ..picture.scheme(None)
    };
    let names: Vec<&str> = cells.iter().map(|cell| cell.name).collect();
    let width = look.least_width.map(|width| width.0 as f32);
    let options = PageOptions {
        title: (content.title).map_or_else(|| usual_title(&names), str::to_owned),
        background: colors.background.map(|color| color.0),
        palette: colors.base_palette(),
        own_colors: colors.own_colors(),
        color_map: colors.colormap,
        scheme: None,
        least_width: width.unwrap_or_else(|| Look::usual_least_width(cells.len())),
    };
    let markers = markers::read(&picture.markers, content.circuit, &scheme, host)?;
    let first = colors.color_by.and_then(ColorWhat::by);
    let (cells, values) = (content.cells, recording.as_ref());
    let page = shared_page(cells, &scheme, first, values, &markers, &options)?;
    Ok(MadePage {
        page,
        has_values: recording.is_some(),
        times: recording.map(|played| played.times).unwrap_or_default(),
    })
}

/// The values that are played, if there are any.
fn played(
    content: &PageContent<'_>,
    picture: &Picture,
    (cells, values): (&[Cell<'_>], Option<PageValues>),
    host: &dyn Host,
) -> Result<Option<PageRecording>, DrawError> {
    let range = picture.colors.range;
    match (values, &picture.colors.report, content.circuit) {
        (Some(PageValues::Played(recording)), ..) => Ok(Some(recording)),
        (Some(PageValues::Own(OwnNumbers::Still(values))), ..) => {
            Ok(Some(PageRecording::still(cells, &values, range)))
        }
        (Some(PageValues::Own(OwnNumbers::OverTime(series))), ..) => {
            let all: Vec<usize> = (0..cells.len()).collect();
            let recording = Recording::of_series(series, cells, &all);
            let played = page_recording(&recording, None, range, cells.len());
            played.map(Some).map_err(DrawError::failed)
        }
        (None, Some(report), Some(of)) => {
            let asked = (&**report, picture.camera.time);
            recording::read(asked, of, cells, range, host).map(Some)
        }
        (None, Some(_), None) => {
            let needed = "--report needs a circuit, whose cells have its values";
            Err(OptionError::together(needed).into())
        }
        (None, None, _) => Ok(None),
    }
}
