//! Meshes that stay in memory: the options, surfaces and checks of `neurotess mesh` without its files.

use std::sync::atomic::AtomicBool;

use clap::Parser;
use neurotess::mesh::{Surface, Watched};
use neurotess::morphology::Morphology;
use neurotess::recipe::{CellMesh, MeshReport, Watch, mesh_watched};

use super::args::MeshArgs;
use super::options::MeshOptions;
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
        let meshed = mesh_watched(
            morphology,
            &self.options.recipe,
            &Watch::stopped_by(stopped),
        );
        meshed.map_err(|e| Failure::from(e).0)
    }

    /// The surface of a cell that was meshed by this recipe, and what is known of it.
    ///
    /// # Errors
    /// It is no surface around its tracing, which is a fault of ours.
    pub fn surface<T>(
        &self,
        meshed: &CellMesh,
        take: impl FnOnce(&dyn Surface) -> T,
    ) -> Result<(T, MeshReport), String> {
        let surface = meshed.surface();
        let report = meshed.report_of(&surface);
        let watched = Watched::new(surface.surface());
        let taken = take(&watched);
        watched.check().map_err(|e| e.to_string())?;
        Ok((taken, report))
    }
}

#[cfg(test)]
mod tests {
    use neurotess::formats::{ReadOptions, swc};
    use neurotess::mesh::{SurfaceMesh, measure_surface};
    use neurotess::recipe::MeshOptions;

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
            let (mesh, report) = recipe
                .surface(&cell, |surface| SurfaceMesh::collect(surface))
                .expect("sound");
            assert!(report.closed && report.components == 1);
            mesh.faces.triangles.len()
        };
        assert_eq!(triangles(&[]), triangles(&["--level=4"]));
        assert!(triangles(&["--level=8"]) > triangles(&[]));
        assert!(triangles(&["--level=2", "--quads"]) < triangles(&["--level=2"]) / 2);
    }

    #[test]
    fn the_library_has_the_same_defaults() {
        let of = |options: &[&str]| recipe(options).expect("options").options.recipe;
        assert_eq!(of(&[]), MeshOptions::default());
        assert_eq!(of(&["--level=0"]), MeshOptions::default().with_level(0));
        assert_eq!(of(&["--simulation"]), MeshOptions::simulation());
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

    /// Thick, thin and back to where it began; to and fro on a line: what their tubes hold, however it is meshed.
    #[test]
    fn paths_that_turn_back_have_their_volume_however_they_are_meshed() {
        let back = "1 2 0 5 0 8.45 -1\n2 2 0 0 0 2.29 1\n3 2 0 5 0 0.75 2\n4 2 0 -25 0 0.75 3\n5 2 0 -60 0 0.75 4\n";
        let to_and_fro = "1 3 0 0 0 2 -1\n2 3 10 0 0 2 1\n3 3 5 0.05 0 2 2\n4 3 40 0 0 2 3\n";
        for (text, volume) in [(back, 1900.0), (to_and_fro, 503.0)] {
            let read = swc::read_bytes(text.as_bytes(), "cell.swc", &ReadOptions::default());
            let cell = read.expect("a cell").morphology;
            // What is moved apart goes around itself, which is longer.
            for (options, most) in [
                (&["--level", "4"][..], 1.1),
                (&["--level", "8", "--crossings", "merge"], 1.1),
                (&["--simulation"], 1.25),
            ] {
                let recipe = recipe(options).expect("options");
                let stopped = AtomicBool::new(false);
                let meshed = recipe.mesh(&cell, &stopped).expect("meshed");
                let made = recipe.surface(&meshed, |surface| measure_surface(surface).volume);
                let (made, report) = made.expect("sound");
                assert!(report.closed && report.components == 1);
                let share = made / volume;
                assert!((0.9..most).contains(&share), "{options:?}: {made}");
            }
        }
    }
}
