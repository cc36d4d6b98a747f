//! The page: one HTML file that asks for nothing.
//!
//! ```text
//! cells, schemes, … ─▶ JSON and arrays ─┐
//! shaders, host/*.js ─▶ JSON and text ──┴─deflate, base 85─▶ page.html
//! ```

use neurotess_color::ColorBy;
use serde::Serialize;

use crate::base85::signs;
use crate::cell::PageCell;
use crate::content::{CellsText, PageOptions, cells_text, packed_text};
use crate::error::WebError;
use crate::host_script::host_script;
use crate::markers::PageMarkers;
use crate::minified;
use crate::recording::PageRecording;
use crate::schemes::PageScheme;
use crate::shaders::PageShaders;

/// The same in all pages.
#[derive(Serialize)]
struct HostData {
    #[serde(flatten)]
    shaders: PageShaders,
    style: String,
    body: &'static str,
}

/// A page's text, and what it consists of.
#[derive(Clone, Debug)]
pub struct Page {
    /// The HTML.
    pub html: String,
    /// Bytes of it that are the host and its shaders: the same in every page.
    pub host_bytes: usize,
    /// Number of tracing points.
    pub points: usize,
    /// What cells can be colored by, with the entries of each legend; scales of numbers have none.
    pub legends: Vec<(ColorBy, Vec<String>)>,
}

/// Pages are larger only if somebody insists: mail takes them, and browsers open them at once.
pub const MAX_PAGE_BYTES: usize = 2_000_000;

/// Makes a page. `schemes` color all cells in their order.
///
/// # Errors
/// There is nothing to show, or too much.
pub fn page(
    cells: &[PageCell<'_>],
    schemes: &[PageScheme<'_>],
    recording: Option<&PageRecording>,
    markers: &PageMarkers,
    options: &PageOptions,
) -> Result<Page, WebError> {
    let cells = cells_text(cells, schemes, recording, markers, options)?;
    Page::of(&options.title, &cells)
}

impl Page {
    /// The page of cells that are packed.
    ///
    /// # Errors
    /// A shader cannot be translated: a bug.
    pub fn of(title: &str, cells: &CellsText) -> Result<Self, WebError> {
        let form = page_form()?;
        let host_bytes = form.len() - TITLE.len() - CELLS.len();
        Ok(Self {
            html: form
                .replace(CELLS, &cells.text)
                .replace(TITLE, &escaped(title)),
            host_bytes,
            points: cells.points,
            legends: cells.legends.clone(),
        })
    }
}

/// What a page may do: nothing that asks a server for anything.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// What stands in a page's form for its title and its cells.
pub(crate) const TITLE: &str = "{title}";
pub(crate) const CELLS: &str = "{cells}";

/// A page without title and cells: the host, and where the two go.
pub(crate) fn page_form() -> Result<String, WebError> {
    let host = HostData {
        shaders: PageShaders::new()?,
        style: minified::css(include_str!("../host/page.css")),
        body: include_str!("../host/body.html"),
    };
    Ok(written(
        POLICY,
        &packed_text(&host, host_script().as_bytes()),
    ))
}

/// A page with this policy and host, without title and cells.
pub(crate) fn written(policy: &str, host: &str) -> String {
    let loader = minified::javascript(include_str!("../host/loader.js"));
    include_str!("../host/page.html")
        .replace("{policy}", policy)
        .replace("{loader}", &loader)
        .replace("{signs}", signs())
        .replace("{host}", host)
}

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('"', "&quot;")
}
