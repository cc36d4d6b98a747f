//! `--spines`: where spines grow.

use std::path::PathBuf;

use glam::DVec3;
use neurotess::circuit::{Compartment, PlaceTable};
use neurotess::morphology::edit::{Edit, SpinePlaces};
use neurotess::morphology::{Morphology, Program, SectionNumbers, SectionPlace};

use crate::options::numbers::positive;

/// A value of the option.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SpinesArg {
    places: Places,
    seed: u64,
}

#[derive(Clone, Debug, PartialEq)]
enum Places {
    /// So many on each µm.
    Density(f64),
    /// Those that the file tells of.
    File,
    /// Those of a table.
    Table(PathBuf),
    /// Synapses of the cell.
    Synapses,
}

pub(super) fn parse(text: &str) -> Result<SpinesArg, String> {
    let with_seed = text
        .rsplit_once(',')
        .and_then(|(places, seed)| Some((places.trim(), seed.trim().parse().ok()?)));
    let (places, seed) = with_seed.unwrap_or((text, 1));
    let is_table = [".csv", ".tsv"]
        .iter()
        .any(|end| places.to_ascii_lowercase().ends_with(end));
    let places = match places {
        "file" => Places::File,
        "synapses" => Places::Synapses,
        table if is_table => Places::Table(table.into()),
        density => Places::Density(positive(density).map_err(|_| {
            "spines for each µm, file, synapses or a table (.csv, .tsv) are needed, and maybe a seed, as in 1.5 or \
             1.5,7"
        })?),
    };
    Ok(SpinesArg { places, seed })
}

/// The option with what its files hold.
#[derive(Clone, Debug)]
pub(super) struct SpinesOption {
    arg: SpinesArg,
    table: Option<PlaceTable>,
}

impl SpinesOption {
    /// # Errors
    /// What is wrong with the table.
    pub(super) fn read(arg: &SpinesArg) -> Result<Self, String> {
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
    pub(super) fn of_synapses(&self) -> bool {
        self.arg.places == Places::Synapses
    }

    /// Whether they are places on one cell.
    pub(super) fn of_one_cell(&self) -> bool {
        self.table.is_some()
    }

    /// The edit of a tracing, and how many places are on no neurite of it. `synapses`: places (µm) of its synapses.
    ///
    /// # Errors
    /// Synapses are needed and there are none.
    pub(super) fn edit(
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
    use super::*;

    #[test]
    fn places_of_spines_have_a_seed() {
        let of = |text: &str| parse(text).map(|arg| (arg.places, arg.seed));
        assert_eq!(of("0.5"), Ok((Places::Density(0.5), 1)));
        assert_eq!(of("2, 7"), Ok((Places::Density(2.0), 7)));
        assert_eq!(of("file"), Ok((Places::File, 1)));
        assert_eq!(of("synapses,3"), Ok((Places::Synapses, 3)));
        assert_eq!(of("a,b.CSV,3"), Ok((Places::Table("a,b.CSV".into()), 3)));
        for wrong in ["0", "-1", "1,", "1,-2", "1,2,3", "", "files", "a.swc"] {
            assert!(of(wrong).is_err(), "{wrong}");
        }
    }
}
