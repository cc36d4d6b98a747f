//! Tracings that stay in memory: the edits of `neurotess convert` without its files.

use clap::Parser;
use glam::DVec3;
use neurotess::morphology::Morphology;
use neurotess::morphology::edit::{self, Edited};

use super::edits::EditArgs;
use super::spines::SpinesOption;
use crate::io::morphologies::OF_UNIT;

/// The options alone, without the program around them.
#[derive(Debug, Parser)]
struct Options {
    #[command(flatten)]
    edits: EditArgs,
}

/// How tracings are mended: the edits of `neurotess convert`, checked.
#[derive(Clone, Debug)]
pub struct EditRecipe {
    edits: EditArgs,
    spines: Option<SpinesOption>,
}

impl EditRecipe {
    /// Takes options as the command line does: `--scale=0.001`, `--mend-radii`. Their order does not matter.
    ///
    /// # Errors
    /// What is wrong with an option, in the words of the command line.
    pub fn new(options: impl IntoIterator<Item = String>) -> Result<Self, String> {
        let words = ["convert".to_owned()].into_iter().chain(options);
        let Options { edits } =
            Options::try_parse_from(words).map_err(|e| crate::report::first_paragraph(&e))?;
        Self::of(&edits)
    }

    /// Takes options that are read, and reads the table of places that they name.
    pub(super) fn of(edits: &EditArgs) -> Result<Self, String> {
        Ok(Self {
            spines: edits.spines().map(SpinesOption::read).transpose()?,
            edits: edits.clone(),
        })
    }

    /// Whether spines grow at synapses, whose places [`apply_to`](Self::apply_to) needs.
    pub fn needs_synapses(&self) -> bool {
        self.spines.as_ref().is_some_and(SpinesOption::of_synapses)
    }

    /// Whether places of spines are those of one cell.
    pub(super) fn is_of_one_cell(&self) -> bool {
        self.spines.as_ref().is_some_and(SpinesOption::of_one_cell)
    }

    /// Whether radii that are no numbers may be read (`ReadOptions::zero_for_bad_radii`), since they are mended.
    pub fn mends_radii(&self) -> bool {
        self.edits.mends_radii()
    }

    /// Whether a reader's warning of this code has no meaning any more, since the edits deal with what it is of.
    pub fn settles(&self, code: &str) -> bool {
        self.edits.changes_units() && OF_UNIT.contains(&code)
    }

    /// The edited tracing, and what each edit changed.
    ///
    /// # Errors
    /// Why an edit cannot be done.
    pub fn apply(&self, morphology: &Morphology) -> Result<Edited, String> {
        self.apply_to(morphology, None)
    }

    /// The same of a cell whose synapses are known. `synapses`: their places (µm, the file's coordinates).
    ///
    /// # Errors
    /// Why an edit cannot be done.
    pub fn apply_to(
        &self,
        morphology: &Morphology,
        synapses: Option<&[DVec3]>,
    ) -> Result<Edited, String> {
        let spines = self.spines.as_ref();
        let spines = spines.map(|spines| spines.edit(morphology, synapses));
        let (spines, left) = spines.transpose()?.unzip();
        let edits = self.edits.edits(spines);
        let edited = edit::apply(morphology, &edits);
        let mut edited = edited.map_err(|e| e.to_string())?;
        let mut reports = edited.reports.iter_mut();
        if let Some(report) = reports.find(|report| report.edit == "spines") {
            report.left += left.unwrap_or(0);
        }
        Ok(edited)
    }
}

#[cfg(test)]
mod tests {
    use neurotess::formats::{ReadOptions, swc};

    use super::*;

    fn recipe(options: &[&str]) -> Result<EditRecipe, String> {
        EditRecipe::new(options.iter().map(|&option| option.to_owned()))
    }

    #[test]
    fn edits_are_those_of_the_command_line() {
        let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n";
        let read = swc::read_bytes(text, "cell", &ReadOptions::default()).expect("a cell");
        let recipe = recipe(&["--mirror=y", "--scale=2"]).expect("options");
        assert!(recipe.settles("too_large") && !recipe.settles("zero_radius"));
        assert!(!recipe.mends_radii());
        let edited = recipe.apply(&read.morphology).expect("an edit");
        let names: Vec<&str> = edited.reports.iter().map(|report| report.edit).collect();
        assert_eq!(names, ["scale", "mirror"]);
        let last = edited.morphology.points.last().expect("a point");
        let at = edited.morphology.origin + last.position.as_dvec3();
        assert_eq!(at.to_array(), [0.0, -60.0, 0.0]);
    }

    #[test]
    fn wrong_options_are_told_as_on_the_command_line() {
        let told = |options: &[&str]| recipe(options).expect_err("wrong");
        assert_eq!(
            told(&["--rotate=z"]),
            "invalid value 'z' for '--rotate <AXIS=DEG>': an axis and degrees are needed, as in z=90"
        );
        assert!(told(&["--scale=2", "--units=nm"]).contains("cannot be used with"));
        assert!(told(&["cell.swc"]).contains("unexpected argument"));
    }
}
