//! `neurotess html`: cells as one HTML page that opens without a server.

mod args;
mod in_memory;
mod markers;
mod recording;
mod values;

use std::io::Write;

use itertools::Itertools;
use neurotess::circuit::NodeRef;
use neurotess::coloring::{Cell, ColorScheme, OwnColors};
use neurotess::output::write_into;
use neurotess::render::{Look, Placement};
use neurotess::web::{
    MAX_PAGE_BYTES, PageCell, PageOptions, PageRecording, shared_page, usual_title,
};
use serde::Serialize;

use crate::commands::render::{
    CircuitInstances, ColorBy as CliColorBy, MeshedCell, RenderArgs, RenderScene, read_scene, stem,
    tell_unused_types,
};
use crate::io::output;
use crate::report::{Entry, Failed, Reporter, count, usage};
pub(crate) use args::HtmlArgs;
pub use in_memory::PageContent;
pub use recording::page_recording;

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
    if args.color_by == Some(CliColorBy::Value) && args.report.is_none() && args.values.is_none() {
        return usage("--color-by value needs a --report or --values");
    }
    let render = args.render_args();
    let RenderScene {
        entries,
        placements,
        instances,
        ..
    } = read_scene(&render, reporter)?;
    let mut cells = Vec::new();
    let mut failed = Vec::new();
    for entry in entries {
        match entry {
            Entry::Done(cell) => cells.push(cell),
            Entry::Failed(entry) => failed.push(entry),
        }
    }
    tell_unused_types(cells.iter(), &render, reporter);
    let mut document = Document {
        out: args.out.display().to_string(),
        bytes: 0,
        points: 0,
        cells: Vec::new(),
        failed,
    };
    if placements.is_empty() {
        return reporter.document(&document);
    }
    let names = match &instances {
        Some(instances) => instances.names(),
        None => cells.iter().map(|cell| stem(&cell.file)).collect(),
    };
    let made = Content {
        args,
        render: &render,
        cells: &cells,
        placements: &placements,
        names: &names,
        instances: instances.as_ref(),
    }
    .page(reporter)?;
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

/// What a page is made of.
struct Content<'a> {
    args: &'a HtmlArgs,
    render: &'a RenderArgs,
    cells: &'a [MeshedCell],
    placements: &'a [(usize, Placement)],
    names: &'a [String],
    instances: Option<&'a CircuitInstances>,
}

impl Content<'_> {
    fn page(&self, reporter: &Reporter) -> anyhow::Result<neurotess::web::Page> {
        let cells = self.cells();
        let scheme = self.scheme();
        let nodes = self.instances.map(CircuitInstances::refs);
        let nodes = nodes.unwrap_or_default();
        let recording = self.recording(&cells, &nodes, reporter)?;
        let page_cells: Vec<PageCell<'_>> = cells
            .iter()
            .zip_eq(self.placements)
            .map(|(&cell, &(_, placement))| PageCell { cell, placement })
            .collect();
        let of = self.instances.map(|of| (&of.circuit, &nodes[..]));
        let markers = markers::read(&self.args.markers, of, &scheme, reporter)?;
        let made = shared_page(
            &page_cells,
            &scheme,
            self.args.color_by.and_then(crate::commands::render::by),
            recording.as_ref(),
            &markers,
            &self.options(),
        );
        // The message only: with its source, it would be printed twice.
        made.map_err(|e| anyhow::anyhow!("{e}"))
    }

    fn cells(&self) -> Vec<Cell<'_>> {
        let named = self.placements.iter().zip_eq(self.names);
        named
            .map(|(&(cell, _), name)| Cell {
                name,
                morphology: &self.cells[cell].morphology,
                mesh: &self.cells[cell].mesh,
                radius_factor: self.render.radius_factor(),
            })
            .collect()
    }

    fn recording(
        &self,
        cells: &[Cell<'_>],
        nodes: &[NodeRef],
        reporter: &Reporter,
    ) -> anyhow::Result<Option<PageRecording>> {
        let (args, range) = (self.args, self.args.range);
        match (&args.report, &args.values, self.instances) {
            (Some(report), _, Some(instances)) => {
                let of = (&instances.circuit, nodes);
                recording::read((report, args.time), of, cells, range, reporter).map(Some)
            }
            (_, Some(table), _) => values::read(table, range, cells).map(Some),
            _ => Ok(None),
        }
    }

    fn own_colors(&self) -> OwnColors {
        self.render.own_colors()
    }

    fn scheme(&self) -> ColorScheme {
        ColorScheme {
            palette: self.render.base_palette(),
            own_colors: self.own_colors(),
            background: None,
            scale: self.args.colormap.scale(),
            range: self
                .args
                .range
                .filter(|_| self.args.report.is_none() && self.args.values.is_none()),
        }
    }

    fn options(&self) -> PageOptions {
        let neurons = self.placements.len();
        let least_width = self.args.least_width.map(|width| width as f32);
        PageOptions {
            title: self
                .args
                .title
                .clone()
                .unwrap_or_else(|| usual_title(self.names)),
            background: self.args.background.map(|color| color.0),
            palette: self.render.base_palette(),
            own_colors: self.own_colors(),
            color_map: self.args.colormap,
            scheme: None,
            least_width: least_width.unwrap_or_else(|| Look::usual_least_width(neurons)),
        }
    }
}

/// A number of bytes as people write it.
fn size_text(bytes: usize) -> String {
    match bytes {
        0..1_000_000 => format!("{} kB", bytes.div_ceil(1000)),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}
