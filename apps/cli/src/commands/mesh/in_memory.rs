//! Meshes that stay in memory: the options, surfaces and checks of `neurotess mesh` without its files.

use std::sync::atomic::AtomicBool;

use clap::Parser;
use neurotess::mesh::{Quality, Surface};
use neurotess::morphology::Morphology;
use serde::Serialize;

use super::args::MeshArgs;
use super::cell::{soma_volume, warnings};
use super::meshed::Meshed;
use super::options::MeshOptions;
use super::smoothing::SmoothingReport;
use super::surface::{CrossingsReport, SeparationReport};
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

/// A meshed cell, of which a surface can be had.
pub struct CellMesh {
    meshed: Meshed,
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

    /// Meshes a cell. Ends soon after another thread sets `stopped`.
    ///
    /// # Errors
    /// If it cannot be meshed, the options leave nothing of it, what crosses cannot be merged, solvers could not
    /// take what was asked for as a simulation mesh, or it was stopped.
    pub fn mesh(&self, morphology: &Morphology, stopped: &AtomicBool) -> Result<CellMesh, String> {
        let meshed = Meshed::new(morphology, &self.options, || 0.0, stopped);
        let meshed = meshed.map_err(|Failure(what)| what)?;
        Ok(CellMesh { meshed })
    }

    /// The surface of a cell that was meshed by this recipe, and what is known of it.
    pub fn surface<T>(
        &self,
        CellMesh { meshed }: &CellMesh,
        take: impl FnOnce(&dyn Surface) -> T,
    ) -> (T, MeshReport) {
        let surface = meshed.surface(&self.options);
        let (generated, merged) = (&meshed.generated, surface.merged());
        let report = MeshReport {
            closed: surface.topology.closed,
            euler: surface.topology.euler,
            components: surface.topology.components,
            soma_volume: soma_volume(generated),
            smoothing: generated.smoothing.as_ref().map(SmoothingReport::from),
            crossings: merged.map(CrossingsReport::new),
            separation: generated.separation.as_ref().map(SeparationReport::from),
            quality: merged.and_then(|merged| merged.quality),
            warnings: warnings(&[], meshed, &surface),
        };
        (take(surface.surface()), report)
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
            let cell = recipe.mesh(&read.morphology, &running).expect("a mesh");
            let (mesh, report) = recipe.surface(&cell, |surface| SurfaceMesh::collect(surface));
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
