//! Tracings that stay in memory: the edits of `neurotess convert` without its files.

use clap::Parser;
use neurotess::morphology::Morphology;
use neurotess::morphology::edit::{self, Edit, Edited};

use super::edits::EditArgs;
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
    edits: Vec<Edit>,
    mends_radii: bool,
    changes_units: bool,
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
        Ok(Self {
            edits: edits.edits(),
            mends_radii: edits.mends_radii(),
            changes_units: edits.changes_units(),
        })
    }

    /// Whether radii that are no numbers may be read (`ReadOptions::zero_for_bad_radii`), since they are mended.
    pub fn mends_radii(&self) -> bool {
        self.mends_radii
    }

    /// Whether a reader's warning of this code has no meaning any more, since the edits deal with what it is of.
    pub fn settles(&self, code: &str) -> bool {
        self.changes_units && code == OF_UNIT
    }

    /// The edited tracing, and what each edit changed.
    ///
    /// # Errors
    /// Why an edit cannot be done.
    pub fn apply(&self, morphology: &Morphology) -> Result<Edited, String> {
        edit::apply(morphology, &self.edits).map_err(|e| e.to_string())
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
