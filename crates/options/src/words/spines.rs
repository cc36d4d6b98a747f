//! Where spines grow.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use super::Positive;
use crate::given::by_text;

/// Where spines grow: `WHERE[,SEED]`.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinePlacing {
    /// Where.
    pub places: Places,
    /// Another gives others.
    pub seed: u64,
}

/// Where spines grow.
#[derive(Clone, Debug, PartialEq)]
pub enum Places {
    /// So many on each µm.
    Density(f64),
    /// Those that the file tells of.
    File,
    /// Those of a table.
    Table(PathBuf),
    /// Synapses of the cell.
    Synapses,
}

impl FromStr for SpinePlacing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
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
            density => Places::Density(density.parse::<Positive>().map_err(|_| {
                "spines for each µm, file, synapses or a table (.csv, .tsv) are needed, and maybe a seed, as in 1.5 \
                 or 1.5,7"
            })?.0),
        };
        Ok(Self { places, seed })
    }
}

impl fmt::Display for SpinePlacing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.places {
            Places::Density(density) => density.fmt(f)?,
            Places::File => f.write_str("file")?,
            Places::Table(table) => table.display().fmt(f)?,
            Places::Synapses => f.write_str("synapses")?,
        }
        write!(f, ",{}", self.seed)
    }
}

by_text!(SpinePlacing);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_of_spines_have_a_seed() {
        let of = |text: &str| {
            let arg = text.parse::<SpinePlacing>()?;
            assert_eq!(arg.to_string().parse(), Ok(arg.clone()));
            Ok::<_, String>((arg.places, arg.seed))
        };
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
