//! The options that edit a tracing, and the order in which their edits are applied.

use glam::DVec3;
use neurotess_morphology::edit::Edit;
use serde::{Deserialize, Serialize};

use crate::OptionError;
use crate::words::{
    Affine, AxisName, Distance, EditedTypes, OutlierFactor, Positive, Renamed, Rotation, Smoothing,
    SourceUnit, SpinePlacing,
};

/// Edits of the tracing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(
    feature = "clap",
    command(next_help_heading = "Edits, applied in this order")
)]
#[serde(default, deny_unknown_fields)]
pub struct EditOptions {
    /// Give samples other types: axon, basal, apical, dendrite, soma, undefined, custom_N or numbers, as in
    /// 5=2,undefined=basal
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "FROM=TO", value_delimiter = ',')
    )]
    pub types: Vec<Renamed>,
    /// Multiply coordinates and radii by F
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "F",
            allow_negative_numbers = true,
            conflicts_with = "units"
        )
    )]
    pub scale: Option<Positive>,
    /// Unit of the file's coordinates and radii, to be turned into µm: um, nm, or voxel=X,Y,Z with the sides of
    /// a voxel in µm (radii are scaled by √(X·Y))
    #[cfg_attr(feature = "clap", arg(long, value_name = "UNIT"))]
    pub units: Option<SourceUnit>,
    /// Interpolate radii along the path that are zero, negative or not finite, and those FACTOR times thicker or
    /// thinner than the samples before and after [default FACTOR: 5]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR", num_args = 0..=1, require_equals = true,
          default_missing_value = "5"))]
    pub mend_radii: Option<OutlierFactor>,
    /// Make this sample the root of its tree, which must have no soma; may be repeated for several trees
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "SAMPLE", allow_negative_numbers = true)
    )]
    pub reroot: Vec<i64>,
    /// Connect each piece without a soma to the nearest sample of another piece within this distance (µm; inf
    /// for any); a soma is as near as its surface
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "DISTANCE", allow_negative_numbers = true)
    )]
    pub join: Option<Distance>,
    /// Keep this sample and what hangs on it, and nothing else
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "SAMPLE", allow_negative_numbers = true)
    )]
    pub subtree: Option<i64>,
    /// Drop this sample and what hangs on it; may be repeated
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "SAMPLE", allow_negative_numbers = true)
    )]
    pub cut: Vec<i64>,
    /// Drop the samples of these types, named as in --types; what hung on them is a piece of its own then
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "TYPE,…", value_delimiter = ',')
    )]
    pub drop_types: Vec<EditedTypes>,
    /// Drop what is farther along the tree than DISTANCE (µm) from the soma's center, or without a soma from the
    /// root; neurites are cut at it
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "DISTANCE", allow_negative_numbers = true)
    )]
    pub within: Option<Positive>,
    /// Drop twigs, from an end up to the fork or soma before it, that are shorter than LENGTH (µm): once, so
    /// what becomes a twig by it stays
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "LENGTH", allow_negative_numbers = true)
    )]
    pub prune: Option<Positive>,
    /// Smooth noise that is shorter than LENGTH (µm) away, or than 1.5 median radii of each section (auto)
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "LENGTH", allow_negative_numbers = true)
    )]
    pub smooth: Option<Smoothing>,
    /// Replace the samples of each section by ones LENGTH (µm) apart, as nearly as equal parts allow; forks and
    /// ends stay, samples get new numbers
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "LENGTH", allow_negative_numbers = true)
    )]
    pub resample: Option<Positive>,
    /// Leave out samples without which the membrane moves by no more than TOLERANCE (µm), by Douglas and
    /// Peucker with radii; forks and ends stay
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "TOLERANCE", allow_negative_numbers = true)
    )]
    pub simplify: Option<Positive>,
    /// Grow spines, as far as there is room: so many on each µm of basal and apical dendrites, at random places (a number);
    /// those that an ASC or H5 file tells of (file); at places of a table, CSV or TSV, with x, y and z (µm) or section
    /// and position; or at the synapses that cells of a circuit get (synapses). Another SEED [default: 1] gives others.
    /// They are of type 7
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "WHERE[,SEED]", allow_negative_numbers = true)
    )]
    pub spines: Option<SpinePlacing>,
    /// Move the soma, or without one the first root, to the origin
    #[cfg_attr(feature = "clap", arg(long))]
    pub recenter: bool,
    /// Turn around an axis through the origin, x, y or z, by DEG degrees counterclockwise, as in z=90; may be
    /// repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXIS=DEG"))]
    pub rotate: Vec<Rotation>,
    /// Change the sign of the coordinates of this axis, x, y or z; may be repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "AXIS"))]
    pub mirror: Vec<AxisName>,
    /// Move by an affine map, as of a registration: three rows of four numbers, one after the other with commas, the last
    /// of each a shift (µm); radii are scaled by the cube root of the determinant
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "ROWS", allow_hyphen_values = true)
    )]
    pub matrix: Option<Affine>,
}

impl EditOptions {
    /// Refuses options that do not go together.
    ///
    /// # Errors
    /// Two that say the unit.
    pub fn check(&self) -> Result<(), OptionError> {
        match (self.scale, self.units.as_ref()) {
            (Some(_), Some(_)) => Err(OptionError::together(
                "'--scale' cannot be used with '--units': leave out one of them",
            )),
            _ => Ok(()),
        }
    }

    /// The edits in their order; `spines`: the one that grows spines.
    pub fn edits(&self, spines: Option<Edit>) -> Vec<Edit> {
        let mut edits = Vec::new();
        if !self.types.is_empty() {
            let pairs = self.types.iter().flat_map(Renamed::pairs);
            edits.push(Edit::Types(pairs.collect()));
        }
        let factors = self.units.as_ref().map(SourceUnit::factors);
        let factors = factors.or(self.scale.map(|factor| DVec3::splat(factor.0)));
        edits.extend(factors.map(Edit::Scale));
        edits.extend(self.mend_radii.map(|factor| Edit::MendRadii {
            outliers: Some(factor.0),
        }));
        let reroot = self.reroot.iter();
        edits.extend(reroot.map(|&sample| Edit::Reroot { sample }));
        edits.extend(self.join.map(|distance| Edit::Join {
            distance: distance.0,
        }));
        edits.extend(self.subtree.map(|sample| Edit::Subtree { sample }));
        if !self.cut.is_empty() {
            let samples = self.cut.clone();
            edits.push(Edit::Cut { samples });
        }
        if !self.drop_types.is_empty() {
            let types = self.drop_types.iter().flat_map(EditedTypes::kinds);
            edits.push(Edit::DropTypes(types.copied().collect()));
        }
        edits.extend(self.within.map(|distance| Edit::Within {
            distance: distance.0,
        }));
        edits.extend(self.prune.map(|length| Edit::Prune { length: length.0 }));
        edits.extend(self.smooth.map(|smooth| Edit::Smooth(smooth.0)));
        edits.extend(
            self.resample
                .map(|spacing| Edit::Resample { spacing: spacing.0 }),
        );
        edits.extend(self.simplify.map(|tolerance| Edit::Simplify {
            tolerance: tolerance.0,
        }));
        edits.extend(spines);
        edits.extend(self.recenter.then_some(Edit::Recenter));
        edits.extend(self.rotate.iter().map(|turn| Edit::Rotate {
            axis: DVec3::AXES[turn.axis.0],
            angle: turn.degrees.to_radians(),
        }));
        let mirror = self.mirror.iter();
        edits.extend(mirror.map(|axis| Edit::Mirror { axis: axis.0 }));
        edits.extend(self.matrix.as_ref().map(|map| Edit::Place(map.map())));
        edits
    }

    /// Whether radii that are no numbers may be read, since they are mended.
    pub fn mends_radii(&self) -> bool {
        self.mend_radii.is_some()
    }

    /// Whether the file's unit is told.
    pub fn gives_unit(&self) -> bool {
        self.units.is_some()
    }

    /// Whether the unit of the file is dealt with.
    pub fn changes_units(&self) -> bool {
        self.units.is_some() || self.scale.is_some()
    }
}

#[cfg(all(test, feature = "clap"))]
mod tests {
    use neurotess_morphology::edit::SpinePlaces;

    use super::*;

    #[test]
    fn edits_stand_in_the_order_of_the_help() {
        use clap::CommandFactory;

        #[derive(clap::Parser)]
        struct All {
            #[command(flatten)]
            edits: EditOptions,
        }
        let command = All::command();
        let arguments = command.get_arguments().map(|a| a.get_id().to_string());
        let helped: Vec<String> = arguments
            .filter(|name| !["help", "units"].contains(&name.as_str()))
            // The edit that a matrix is.
            .map(|name| name.replace("matrix", "place"))
            .collect();
        let all = "x --matrix 1,0,0,0,0,1,0,0,0,0,1,0 --mirror x --rotate z=1 --recenter --spines 1 --simplify 1 --resample 1 --smooth auto --prune 1 --within 1 \
                   --drop-types 7 --cut 1 --subtree 1 \
                   --join 1 --reroot 1 --mend-radii --scale 2 --types 1=2";
        let all: All = clap::Parser::parse_from(all.split_whitespace());
        let spines = Edit::Spines {
            places: SpinePlaces::File,
            seed: 1,
        };
        let edits: Vec<&str> = all
            .edits
            .edits(Some(spines))
            .iter()
            .map(Edit::name)
            .collect();
        assert_eq!(edits, helped);
    }
}
