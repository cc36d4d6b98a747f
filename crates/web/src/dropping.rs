//! The page that takes tracings: drop a file, and the core, as WebAssembly in a worker, makes a cell's page of it.
//!
//! ```text
//! drop/*, the form of a page, a sample ─▶ JSON and text ───┐
//! bindings/wasm as a module, licenses ──▶ JSON and bytes ──┴─deflate, base 85─▶ page.html
//! ```
//!
//! It is the same file as a cell's page, with another host, and with the core where that has its cells.

use serde::Serialize;

use crate::content::packed_text;
use crate::error::WebError;
use crate::host_script::dropping_script;
use crate::minified;
use crate::page::{CELLS, TITLE, page_form, written};

/// What the page may do: nothing that asks a server for anything.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval'; worker-src blob:; \
                      style-src 'unsafe-inline'; img-src data: blob:";

/// What the page's script reads, beside itself.
#[derive(Serialize)]
struct DroppingData<'s> {
    style: String,
    body: &'static str,
    form: String,
    worker: String,
    sample_name: &'s str,
    sample: &'s str,
}

/// What stands before the core.
#[derive(Serialize)]
struct CoreData<'l> {
    licenses: &'l str,
}

/// Makes the page. `core`: the module of `bindings/wasm`; `licenses`: of all that is in it; `sample`: name and text of an
/// SWC file that shows before another is dropped, so that all is compiled when one comes.
///
/// # Errors
/// A shader cannot be translated: a bug.
pub fn dropping_page(
    core: &[u8],
    licenses: &str,
    sample: (&str, &str),
) -> Result<String, WebError> {
    let data = DroppingData {
        style: minified::css(include_str!("../drop/page.css")),
        body: include_str!("../drop/body.html"),
        form: page_form()?,
        worker: minified::javascript(include_str!("../drop/worker.js")),
        sample_name: sample.0,
        sample: sample.1,
    };
    let host = packed_text(&data, dropping_script().as_bytes());
    let core = packed_text(&CoreData { licenses }, core);
    Ok(written(POLICY, &host)
        .replace(CELLS, &core)
        .replace(TITLE, "neurotess"))
}
