//! `neurotess mesh CIRCUIT -o FILE.glb`: one file, in which each morphology is once and each cell a
//! node.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use itertools::Itertools;
use neurotess::batch::{self, Inputs};
use neurotess::circuit::{Circuit, Instance, soma_center};
use neurotess::mesh::{Format, GlbNode, Surface, WriteError, write_glb};
use neurotess::recipe::{CellMesh, CellSurface, Spelling, Watch, mesh_watched};
use serde::Serialize;

use super::args::MeshArgs;
use super::options::MeshOptions;
use crate::io::output::{Output, OutputError, existing};
use crate::io::workers;
use crate::report::{Failure, Progress, Reporter, bug, count, usage};

/// The object of the JSON list.
#[derive(Serialize)]
struct GlbReport {
    file: String,
    out: String,
    /// Number of nodes, and of cells left out because their morphology failed.
    cells: usize,
    failed: usize,
    morphologies: usize,
    /// Number of vertices of all morphologies, each counted once.
    vertices: usize,
    triangles: usize,
    seconds: f64,
}

/// Whether OUT is one file, with a name that ends in .glb.
pub(super) fn is_one_file(args: &MeshArgs) -> bool {
    let out = &args.out.out;
    !out.is_dir() && Format::from_extension(out).is_ok_and(|format| format == Format::Glb)
}

/// Writes the selected cells of a circuit.
pub(super) fn run(
    args: &MeshArgs,
    circuit: &Circuit,
    instances: &[Instance],
    reporter: &Reporter,
) -> anyhow::Result<()> {
    let clock = Instant::now();
    if args.shard.is_some() || args.resume || args.log.is_some() {
        return usage("--shard, --resume and --log are for a file per cell: give a folder as OUT");
    }
    let out = &args.out.out;
    let one = Inputs {
        one_file: true,
        ..Inputs::default()
    };
    let options = MeshOptions::new(args, &one)?;
    if options.files.format != Format::Glb {
        return usage("only GLB holds a circuit in one file: leave out --format");
    }
    if options.files.parts {
        return usage("--parts writes files of one cell each: leave it out, or give a folder");
    }
    existing(options.force).check(out)?;
    let prepared = prepare_all(circuit, instances, &options, reporter)?;
    let shown: Vec<&Instance> = instances
        .iter()
        .filter(|instance| prepared.contains_key(&instance.template.0))
        .collect();
    if shown.is_empty() {
        anyhow::bail!("{}: no cell to write: choose others", circuit.file);
    }
    let surfaces: Vec<CellSurface<'_>> = prepared
        .values()
        .map(|cell| cell.meshed.surface_for(options.files.format))
        .collect();
    let surfaces: Vec<&dyn Surface> = surfaces.iter().map(CellSurface::surface).collect();
    let numbers: BTreeMap<u32, usize> = prepared.keys().copied().zip(0..).collect();
    let nodes: Vec<GlbNode> = shown
        .iter()
        .map(|instance| GlbNode {
            name: name(circuit, instance),
            surface: numbers[&instance.template.0],
            world_from_surface: options.files.unit.unit_from_um()
                * instance.world_from_cell(prepared[&instance.template.0].soma_center),
        })
        .collect();
    let mut output = Output::create(out, existing(options.force))?;
    let write_options = options.files.writing(None);
    write_glb(&surfaces, &nodes, &write_options, output.file()).map_err(|e| match e {
        WriteError::Io(e) => OutputError::broken(out, e),
        other => OutputError::broken(out, std::io::Error::other(other)),
    })?;
    output.finish()?;
    let report = GlbReport {
        file: circuit.file.clone(),
        out: out.display().to_string(),
        cells: nodes.len(),
        failed: instances.len() - nodes.len(),
        morphologies: surfaces.len(),
        vertices: surfaces.iter().map(|s| s.vertex_count()).sum(),
        triangles: surfaces.iter().map(|s| s.triangle_count()).sum(),
        seconds: clock.elapsed().as_secs_f64(),
    };
    reporter.result(&format!(
        "{} → {}: {} of {}, {} triangles, in {:.2} s",
        report.file,
        report.out,
        count(report.cells, "cell"),
        count(report.morphologies, "morphology file"),
        report.triangles,
        report.seconds
    ));
    reporter.document(&[report])
}

/// A morphology that was meshed.
struct Prepared {
    meshed: CellMesh,
    /// Center of the soma in the tracing's coordinates (µm).
    soma_center: DVec3,
}

fn prepare(input: &Path, options: &MeshOptions) -> Result<Prepared, Failure> {
    let read = batch::read(input, None, &options.read)?;
    let soma_center = soma_center(&read.morphology);
    let meshed = mesh_watched(
        Arc::new(read.morphology),
        &options.recipe,
        &Watch::default(),
    );
    let told = |what: String| Failure(format!("{}: {what}", input.display()));
    Ok(Prepared {
        meshed: meshed.map_err(|e| told(e.told(Spelling::Flag)))?,
        soma_center,
    })
}

/// Reads and generates each morphology once, on all cores; reports those that fail.
fn prepare_all(
    circuit: &Circuit,
    instances: &[Instance],
    options: &MeshOptions,
    reporter: &Reporter,
) -> anyhow::Result<BTreeMap<u32, Prepared>> {
    let mut templates: Vec<u32> = instances.iter().map(|i| i.template.0).collect();
    templates.sort_unstable();
    templates.dedup();
    let order: Vec<usize> = (0..templates.len()).collect();
    let progress = Progress::new(reporter, templates.len(), "morphologies");
    let results = workers::run(&templates, &order, reporter.threads(), |&template| {
        let prepared = prepare(&circuit.templates[template as usize].path, options);
        progress.done();
        prepared
    })?;
    drop(progress);
    let mut prepared = BTreeMap::new();
    for (&template, result) in templates.iter().zip_eq(results) {
        let path = &circuit.templates[template as usize].path;
        match result.unwrap_or_else(|panic| Err(bug(&path.display().to_string(), &panic))) {
            Ok(cell) => {
                prepared.insert(template, cell);
            }
            Err(failure) => reporter.failure(&failure),
        }
    }
    Ok(prepared)
}

fn name(circuit: &Circuit, instance: &Instance) -> String {
    let population = &circuit.populations[instance.node.population as usize].name;
    format!("{population} {}", instance.id)
}
