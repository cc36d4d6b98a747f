//! Meshes that stay in memory: the options, surfaces and checks of `neurotess mesh` without its files.

use std::sync::atomic::AtomicBool;

use clap::Parser;
use neurotess::generate::{Generated, generate_stoppable};
use neurotess::mesh::{Quality, Surface};
use neurotess::morphology::Morphology;
use serde::Serialize;

use super::args::MeshArgs;
use super::cell::{soma_volume, something_left, warnings};
use super::options::MeshOptions;
use super::smoothing::SmoothingReport;
use super::surface::{CellSurface, CrossingsReport, SeparationReport};
use super::verdict;
use super::warning::CellWarning;
use crate::io::inputs::Inputs;
use crate::report::Failure;

/// The options alone, without the program around them.
#[derive(Debug, Parser)]
struct Options {
    #[command(flatten)]
    args: MeshArgs,
}

/// How a cell is meshed: the options of `neurotess mesh`, checked.
#[derive(Clone, Debug)]
pub struct MeshRecipe {
    options: MeshOptions,
}

/// A cell's coarse mesh, of which a surface can be made.
#[derive(Debug)]
pub struct CellMesh {
    generated: Generated,
}

/// What is known of a surface, under the names that `neurotess mesh --json` has.
#[derive(Clone, Debug, Serialize)]
pub struct MeshReport {
    closed: bool,
    euler: i64,
    components: usize,
    /// µm³.
    soma_volume: f64,
    smoothing: Option<SmoothingReport>,
    crossings: Option<CrossingsReport>,
    separation: Option<SeparationReport>,
    quality: Option<Quality>,
    warnings: Vec<CellWarning>,
}

impl MeshRecipe {
    /// Takes options as the command line does: `--level=4`, `--quads`. Those of files (`--out`, `--table`,
    /// `--resume` and the like) have no meaning here.
    ///
    /// # Errors
    /// What is wrong with an option, in the words of the command line.
    pub fn new(options: impl IntoIterator<Item = String>) -> Result<Self, String> {
        // The format is one that holds quads; of files nothing else is used.
        let command = ["mesh", "-", "--out=-", "--format=ply"].map(str::to_owned);
        let args = Options::try_parse_from(command.into_iter().chain(options));
        let Options { args } = args.map_err(|e| crate::report::first_paragraph(&e))?;
        let options = MeshOptions::new(&args, &Inputs::default(), false);
        let options = options.map_err(|e| format!("{e:#}"))?;
        Ok(Self { options })
    }

    /// Generates the coarse mesh of a cell. Ends soon after another thread sets `stopped`.
    ///
    /// # Errors
    /// If it cannot be meshed, the options leave nothing of it, or it was stopped.
    pub fn generate(
        &self,
        morphology: &Morphology,
        stopped: &AtomicBool,
    ) -> Result<CellMesh, String> {
        let options = &self.options.generate;
        let generated = generate_stoppable(morphology, options, || 0.0, stopped);
        let generated = generated.map_err(|e| e.to_string())?;
        something_left(&generated).map_err(|Failure(what)| what)?;
        Ok(CellMesh { generated })
    }

    /// Makes a cell's surface and hands it to `take`; tells what is known of it. Merging ends soon after another
    /// thread sets `stopped`.
    ///
    /// # Errors
    /// If it was stopped, what crosses cannot be merged, or solvers could not take what was asked for as a simulation mesh.
    pub fn surface<T>(
        &self,
        cell: &CellMesh,
        stopped: &AtomicBool,
        take: impl FnOnce(&dyn Surface) -> T,
    ) -> Result<(T, MeshReport), String> {
        let CellMesh { generated } = cell;
        let told = |Failure(what)| what;
        let surface =
            CellSurface::stoppable(&generated.mesh, &self.options, stopped).map_err(told)?;
        if self.options.simulation {
            verdict::check(&surface, generated).map_err(told)?;
        }
        let report = MeshReport {
            closed: surface.topology.closed,
            euler: surface.topology.euler,
            components: surface.topology.components,
            soma_volume: soma_volume(generated),
            smoothing: generated.smoothing.as_ref().map(SmoothingReport::from),
            crossings: surface.merging.as_ref().map(CrossingsReport::new),
            separation: generated.separation.as_ref().map(SeparationReport::from),
            quality: surface.quality,
            warnings: warnings(&[], generated, &surface),
        };
        Ok((take(&*surface.surface), report))
    }
}

#[cfg(test)]
mod tests {
    use neurotess::formats::{ReadOptions, swc};
    use neurotess::mesh::SurfaceMesh;

    use super::*;

    fn recipe(options: &[&str]) -> Result<MeshRecipe, String> {
        MeshRecipe::new(options.iter().map(|&option| option.to_owned()))
    }

    #[test]
    fn options_are_those_of_the_command_line() {
        let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n";
        let read = swc::read_bytes(text, "cell", &ReadOptions::default()).expect("a cell");
        let triangles = |options: &[&str]| {
            let recipe = recipe(options).expect("options");
            let running = AtomicBool::new(false);
            let cell = recipe.generate(&read.morphology, &running).expect("a mesh");
            let made = recipe.surface(&cell, &running, |surface| SurfaceMesh::collect(surface));
            let (mesh, report) = made.expect("a surface");
            assert!(report.closed && report.components == 1);
            mesh.faces.triangles.len()
        };
        assert_eq!(triangles(&[]), triangles(&["--level=4"]));
        assert!(triangles(&["--level=8"]) > triangles(&[]));
        assert!(triangles(&["--level=2", "--quads"]) < triangles(&["--level=2"]) / 2);
    }

    #[test]
    fn wrong_options_are_told_as_on_the_command_line() {
        let told = |options: &[&str]| recipe(options).expect_err("wrong");
        assert_eq!(
            told(&["--level=99"]),
            "invalid value '99' for '--level <N>': 99 is not in 0..=64"
        );
        assert!(told(&["--soma=x"]).ends_with("[possible values: fem, sphere, profile, none]"));
        let needs = told(&["--max-edge=2"]);
        assert!(needs.starts_with("--max-edge, --min-edge"), "{needs}");
        assert!(recipe(&["--help"]).is_err());
    }
}
