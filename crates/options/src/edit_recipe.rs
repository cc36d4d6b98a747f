//! Edits of tracings: the options with what their files hold, applied.

use glam::DVec3;
use neurotess_circuit::{Compartment, PlaceTable};
use neurotess_morphology::edit::{self, Edit, Edited, SpinePlaces};
use neurotess_morphology::{Morphology, Program, SectionNumbers, SectionPlace};

use crate::groups::EditOptions;
use crate::words::{Places, SpinePlacing};

/// Codes of the reader's warnings about cells whose unit is likely not the micrometer.
pub const OF_UNIT: [&str; 2] = ["too_large", "too_small"];

/// How tracings are mended: the edits of `neurotess convert`, checked.
#[derive(Clone, Debug)]
pub struct EditRecipe {
    edits: EditOptions,
    spines: Option<SpinesOption>,
}

impl EditRecipe {
    /// Takes options, and reads the table of places that they name.
    ///
    /// # Errors
    /// Options that do not go together, or what is wrong with the table.
    pub fn of(edits: &EditOptions) -> Result<Self, String> {
        edits.check().map_err(|e| e.to_string())?;
        Ok(Self {
            spines: edits.spines.as_ref().map(SpinesOption::read).transpose()?,
            edits: edits.clone(),
        })
    }

    /// Whether spines grow at synapses, whose places [`apply_to`](Self::apply_to) needs.
    pub fn needs_synapses(&self) -> bool {
        self.spines.as_ref().is_some_and(SpinesOption::of_synapses)
    }

    /// Whether places of spines are those of one cell.
    pub fn is_of_one_cell(&self) -> bool {
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

/// The option with what its files hold.
#[derive(Clone, Debug)]
struct SpinesOption {
    arg: SpinePlacing,
    table: Option<PlaceTable>,
}

impl SpinesOption {
    /// # Errors
    /// What is wrong with the table.
    fn read(arg: &SpinePlacing) -> Result<Self, String> {
        let table = match &arg.places {
            Places::Table(file) => Some(PlaceTable::read(file).map_err(|e| e.to_string())?),
            _ => None,
        };
        Ok(Self {
            arg: arg.clone(),
            table,
        })
    }

    /// Whether places of synapses are needed.
    fn of_synapses(&self) -> bool {
        self.arg.places == Places::Synapses
    }

    /// Whether they are places on one cell.
    fn of_one_cell(&self) -> bool {
        self.table.is_some()
    }

    /// The edit of a tracing, and how many places are on no neurite of it. `synapses`: places (µm) of its synapses.
    ///
    /// # Errors
    /// Synapses are needed and there are none.
    fn edit(
        &self,
        morphology: &Morphology,
        synapses: Option<&[DVec3]>,
    ) -> Result<(Edit, usize), String> {
        let seed = self.arg.seed;
        let (places, left) = match (&self.arg.places, &self.table) {
            (Places::Density(density), _) => (SpinePlaces::Density(*density), 0),
            (Places::Table(_), Some(PlaceTable::Along(shares))) => {
                let numbers = SectionNumbers::of(morphology, Program::Neuron);
                let share = |place: Compartment| match place.place(&numbers) {
                    Some(SectionPlace::Section(section, along)) => {
                        Some((section, f64::from(along)))
                    }
                    _ => None,
                };
                let found: Vec<_> = shares.iter().copied().filter_map(share).collect();
                let left = shares.len() - found.len();
                (SpinePlaces::Along(found), left)
            }
            (Places::Table(_), Some(PlaceTable::Points(points))) => {
                (SpinePlaces::At(points.clone()), 0)
            }
            (Places::File | Places::Table(_), _) => (SpinePlaces::File, 0),
            (Places::Synapses, _) => {
                let synapses = synapses.ok_or(
                    "--spines synapses is of the cells of a circuit: name one, or give a table of places",
                )?;
                (SpinePlaces::At(synapses.to_vec()), 0)
            }
        };
        Ok((Edit::Spines { places, seed }, left))
    }
}

#[cfg(test)]
mod tests {
    use neurotess_formats::{ReadOptions, swc};
    use serde_json::json;

    use super::*;
    use crate::set_option;

    #[test]
    fn edits_are_applied_in_their_order() {
        let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n";
        let read = swc::read_bytes(text, "cell", &ReadOptions::default()).expect("a cell");
        let mut options = EditOptions::default();
        set_option(&mut options, "mirror", &json!("y")).expect("an axis");
        set_option(&mut options, "scale", &json!(2)).expect("a factor");
        let recipe = EditRecipe::of(&options).expect("options");
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
    fn wrong_options_are_told() {
        let mut options = EditOptions::default();
        let told = set_option(&mut options, "rotate", &json!("z")).expect_err("wrong");
        assert_eq!(
            told.to_string(),
            "rotate=z: an axis and degrees are needed, as in z=90"
        );
        for (name, value) in [("scale", json!(2)), ("units", json!([0.1, 0.1, 0.5]))] {
            set_option(&mut options, name, &value).expect(name);
        }
        let told = EditRecipe::of(&options).expect_err("both");
        assert!(told.contains("cannot be used with"), "{told}");
    }
}
