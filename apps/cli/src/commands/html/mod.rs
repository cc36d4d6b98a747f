//! `neurotess html`: cells as one HTML page that opens without a server.

mod args;
mod values;

use std::io::Write;

use itertools::Itertools;
use neurotess::coloring::Cell;
use neurotess::drawing::{
    CircuitInstances, MeshedCell, PageContent, PageError, PageValues, Scene, page, stem,
    tell_unused_types,
};
use neurotess::options::words::ColorWhat;
use neurotess::output::write_into;
use neurotess::web::{MAX_PAGE_BYTES, PageCell};
use serde::Serialize;

use crate::commands::render::{read_scene, told};
use crate::io::output;
use crate::report::{Failed, Reporter, count, usage};
pub(crate) use args::HtmlArgs;

/// What `--json` prints.
#[derive(Serialize)]
struct Document {
    out: String,
    bytes: usize,
    points: usize,
    cells: Vec<String>,
    failed: Vec<Failed>,
}

/// Runs the command.
pub(crate) fn run(args: &HtmlArgs, reporter: &Reporter) -> anyhow::Result<()> {
    output::reserve_standard(&args.out, reporter)?;
    output::check(&args.out, args.force)?;
    let colors = &args.colors;
    if colors.color_by == Some(ColorWhat::Value) && colors.report.is_none() && args.values.is_none()
    {
        return usage("--color-by value needs a --report or --values");
    }
    let options = args.options();
    let Scene {
        entries,
        placements,
        instances,
        ..
    } = read_scene(&args.inputs, &options, reporter)?;
    let (cells, failed): (Vec<MeshedCell>, Vec<_>) = entries.into_iter().partition_result();
    let failed = failed.into_iter().map(|unread| Failed {
        file: unread.file,
        error: unread.error,
    });
    tell_unused_types(&cells.iter().collect::<Vec<_>>(), &options, reporter);
    let mut document = Document {
        out: args.out.display().to_string(),
        bytes: 0,
        points: 0,
        cells: Vec::new(),
        failed: failed.collect(),
    };
    if placements.is_empty() {
        return reporter.document(&document);
    }
    let names = match &instances {
        Some(instances) => instances.names(),
        None => cells.iter().map(|cell| stem(&cell.file)).collect(),
    };
    let nodes = instances.as_ref().map(CircuitInstances::refs);
    let nodes = nodes.unwrap_or_default();
    let placed: Vec<PageCell<'_>> = placements
        .iter()
        .zip_eq(&names)
        .map(|(&(cell, placement), name)| PageCell {
            cell: Cell {
                name,
                morphology: &cells[cell].morphology,
                mesh: &cells[cell].mesh,
                radius_factor: options.picture.shape.factor(),
            },
            placement,
        })
        .collect();
    let colored: Vec<Cell<'_>> = placed.iter().map(|page| page.cell).collect();
    let values = match &args.values {
        Some(table) => Some(values::read(table, colors.range, &colored)?),
        None => None,
    };
    let content = PageContent {
        cells: &placed,
        circuit: instances.as_ref().map(|of| (&of.circuit, &nodes[..])),
        title: args.title.as_deref(),
    };
    let values = values.map(PageValues::Played);
    let made = page(&content, &options.picture, values, reporter).map_err(|e| match e {
        PageError::Draw(e) => told(e),
        // The message only: with its source, it would be printed twice.
        other => anyhow::anyhow!("{other}"),
    })?;
    let made = made.page;
    let bytes = made.html.len();
    if bytes > MAX_PAGE_BYTES && !args.force {
        let size = size_text(bytes);
        anyhow::bail!("the page would have {size}: leave out cells, or use --force");
    }
    let output = output::begin(&args.out, args.force)?;
    write_into(output, &args.out, |to| to.write_all(made.html.as_bytes()))?;
    let points = count(made.points, "tracing point");
    let (of, size) = (count(placements.len(), "cell"), size_text(bytes));
    reporter.result(&format!("{}: {of}, {points}, {size}", document.out));
    document.bytes = bytes;
    document.points = made.points;
    document.cells = names;
    reporter.document(&document)
}

/// A number of bytes as people write it.
fn size_text(bytes: usize) -> String {
    match bytes {
        0..1_000_000 => format!("{} kB", bytes.div_ceil(1000)),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}
