//! The options that edit a tracing, and the order in which their edits are applied.

use clap::{ArgAction, Args};
use glam::{DAffine3, DVec3};
use neurotess::morphology::NeuriteKind;
use neurotess::morphology::edit::Edit;
use neurotess::morphology::smoothing::SmoothingLength;

use super::spines::{self, SpinesArg};
use crate::options::numbers::positive;
use neurotess::options::words::Types;

/// Edits of the tracing.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Edits, applied in this order")]
pub(crate) struct EditArgs {
    /// Give samples other types: axon, basal, apical, dendrite, soma, undefined, custom_N or numbers, as in
    /// 5=2,undefined=basal
    #[arg(long, value_name = "FROM=TO", value_delimiter = ',', value_parser = renamed)]
    types: Vec<Renamed>,
    /// Multiply coordinates and radii by F
    #[arg(long, value_name = "F", value_parser = positive, allow_negative_numbers = true,
          conflicts_with = "units")]
    scale: Option<f64>,
    /// Unit of the file's coordinates and radii, to be turned into µm: um, nm, or voxel=X,Y,Z with the sides of
    /// a voxel in µm (radii are scaled by √(X·Y))
    #[arg(long, value_name = "UNIT", value_parser = units)]
    units: Option<DVec3>,
    /// Interpolate radii along the path that are zero, negative or not finite, and those FACTOR times thicker or
    /// thinner than the samples before and after [default FACTOR: 5]
    #[arg(long, value_name = "FACTOR", num_args = 0..=1, require_equals = true,
          default_missing_value = "5", value_parser = factor)]
    mend_radii: Option<f64>,
    /// Make this sample the root of its tree, which must have no soma; may be repeated for several trees
    #[arg(long, value_name = "SAMPLE", allow_negative_numbers = true)]
    reroot: Vec<i64>,
    /// Connect each piece without a soma to the nearest sample of another piece within this distance (µm; inf
    /// for any); a soma is as near as its surface
    #[arg(long, value_name = "DISTANCE", value_parser = distance, allow_negative_numbers = true)]
    join: Option<f64>,
    /// Keep this sample and what hangs on it, and nothing else
    #[arg(long, value_name = "SAMPLE", allow_negative_numbers = true)]
    subtree: Option<i64>,
    /// Drop this sample and what hangs on it; may be repeated
    #[arg(long, value_name = "SAMPLE", allow_negative_numbers = true)]
    cut: Vec<i64>,
    /// Drop the samples of these types, named as in --types; what hung on them is a piece of its own then
    #[arg(long, value_name = "TYPE,…", value_delimiter = ',', value_parser = types)]
    drop_types: Vec<Types>,
    /// Drop what is farther along the tree than DISTANCE (µm) from the soma's center, or without a soma from the
    /// root; neurites are cut at it
    #[arg(long, value_name = "DISTANCE", value_parser = positive, allow_negative_numbers = true)]
    within: Option<f64>,
    /// Drop twigs, from an end up to the fork or soma before it, that are shorter than LENGTH (µm): once, so
    /// what becomes a twig by it stays
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    prune: Option<f64>,
    /// Smooth noise that is shorter than LENGTH (µm) away, or than 1.5 median radii of each section (auto)
    #[arg(long, value_name = "LENGTH", value_parser = smoothing, allow_negative_numbers = true)]
    smooth: Option<SmoothingLength>,
    /// Replace the samples of each section by ones LENGTH (µm) apart, as nearly as equal parts allow; forks and
    /// ends stay, samples get new numbers
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    resample: Option<f64>,
    /// Leave out samples without which the membrane moves by no more than TOLERANCE (µm), by Douglas and
    /// Peucker with radii; forks and ends stay
    #[arg(long, value_name = "TOLERANCE", value_parser = positive, allow_negative_numbers = true)]
    simplify: Option<f64>,
    /// Grow spines, as far as there is room: so many on each µm of basal and apical dendrites, at random places (a number);
    /// those that an ASC or H5 file tells of (file); at places of a table, CSV or TSV, with x, y and z (µm) or section
    /// and position; or at the synapses that cells of a circuit get (synapses). Another SEED [default: 1] gives others.
    /// They are of type 7
    #[arg(long, value_name = "WHERE[,SEED]", value_parser = spines::parse, allow_negative_numbers = true)]
    spines: Option<SpinesArg>,
    /// Move the soma, or without one the first root, to the origin
    #[arg(long)]
    recenter: bool,
    /// Turn around an axis through the origin, x, y or z, by DEG degrees counterclockwise, as in z=90; may be
    /// repeated
    #[arg(long, value_name = "AXIS=DEG", value_parser = rotation, action = ArgAction::Append)]
    rotate: Vec<(usize, f64)>,
    /// Change the sign of the coordinates of this axis, x, y or z; may be repeated
    #[arg(long, value_name = "AXIS", value_parser = axis, action = ArgAction::Append)]
    mirror: Vec<usize>,
    /// Move by an affine map, as of a registration: three rows of four numbers, one after the other with commas, the last
    /// of each a shift (µm); radii are scaled by the cube root of the determinant
    #[arg(long = "matrix", id = "place", value_name = "ROWS", value_parser = matrix, allow_hyphen_values = true)]
    place: Option<DAffine3>,
}

/// Types that become another one.
#[derive(Clone, Debug, PartialEq)]
struct Renamed {
    from: Vec<NeuriteKind>,
    to: NeuriteKind,
}

impl EditArgs {
    /// Where spines are to grow.
    pub(super) fn spines(&self) -> Option<&SpinesArg> {
        self.spines.as_ref()
    }

    /// The edits in their order; `spines`: the one that grows spines.
    pub(super) fn edits(&self, spines: Option<Edit>) -> Vec<Edit> {
        let mut edits = Vec::new();
        if !self.types.is_empty() {
            let pairs = |renamed: &Renamed| {
                let to = renamed.to;
                let pairs = renamed.from.iter().map(move |&from| (from, to));
                pairs.collect::<Vec<_>>()
            };
            edits.push(Edit::Types(self.types.iter().flat_map(pairs).collect()));
        }
        let factors = self.units.or(self.scale.map(DVec3::splat));
        edits.extend(factors.map(Edit::Scale));
        edits.extend(self.mend_radii.map(|factor| Edit::MendRadii {
            outliers: Some(factor),
        }));
        let reroot = self.reroot.iter();
        edits.extend(reroot.map(|&sample| Edit::Reroot { sample }));
        edits.extend(self.join.map(|distance| Edit::Join { distance }));
        edits.extend(self.subtree.map(|sample| Edit::Subtree { sample }));
        if !self.cut.is_empty() {
            let samples = self.cut.clone();
            edits.push(Edit::Cut { samples });
        }
        if !self.drop_types.is_empty() {
            let types = self.drop_types.iter().flat_map(Types::kinds);
            edits.push(Edit::DropTypes(types.copied().collect()));
        }
        edits.extend(self.within.map(|distance| Edit::Within { distance }));
        edits.extend(self.prune.map(|length| Edit::Prune { length }));
        edits.extend(self.smooth.map(Edit::Smooth));
        edits.extend(self.resample.map(|spacing| Edit::Resample { spacing }));
        edits.extend(self.simplify.map(|tolerance| Edit::Simplify { tolerance }));
        edits.extend(spines);
        edits.extend(self.recenter.then_some(Edit::Recenter));
        edits.extend(self.rotate.iter().map(|&(axis, degrees)| Edit::Rotate {
            axis: DVec3::AXES[axis],
            angle: degrees.to_radians(),
        }));
        let mirror = self.mirror.iter();
        edits.extend(mirror.map(|&axis| Edit::Mirror { axis }));
        edits.extend(self.place.map(Edit::Place));
        edits
    }

    /// Whether radii that are no numbers may be read, since they are mended.
    pub(super) fn mends_radii(&self) -> bool {
        self.mend_radii.is_some()
    }

    /// Whether the file's unit is told.
    pub(super) fn gives_unit(&self) -> bool {
        self.units.is_some()
    }

    /// Whether the unit of the file is dealt with.
    pub(super) fn changes_units(&self) -> bool {
        self.units.is_some() || self.scale.is_some()
    }
}

fn renamed(text: &str) -> Result<Renamed, String> {
    let of = |word: &str| types(word).map(|types| types.kinds().to_vec());
    let needed = "FROM=TO is needed, as in 5=2 or undefined=basal";
    let (from, to) = text.split_once('=').ok_or(needed)?;
    match of(to)?[..] {
        [to] => Ok(Renamed {
            from: of(from)?,
            to,
        }),
        _ => Err("a single type must stand after =: basal or apical instead of dendrite".into()),
    }
}

/// Types that a word names, the soma's among them.
fn types(word: &str) -> Result<Types, String> {
    match word.trim().to_ascii_lowercase().as_str() {
        "soma" => Ok(Types::of_kinds(word, vec![NeuriteKind::SOMA])),
        other => other.parse(),
    }
}

fn units(text: &str) -> Result<DVec3, String> {
    match text {
        "um" | "µm" | "μm" => return Ok(DVec3::ONE),
        "nm" => return Ok(DVec3::splat(0.001)),
        _ => {}
    }
    let sides = text.strip_prefix("voxel=").unwrap_or_default();
    let sides: Result<Vec<f64>, String> = sides.split(',').map(|s| positive(s.trim())).collect();
    match sides.as_deref() {
        Ok(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("um, nm or voxel=X,Y,Z is needed, as in voxel=0.1,0.1,0.5".into()),
    }
}

fn factor(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(factor) if factor > 1.0 && f64::is_finite(factor) => Ok(factor),
        _ => Err("a number above 1 is needed".into()),
    }
}

fn distance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(distance) if distance > 0.0 => Ok(distance),
        _ => Err("a number above 0, or inf, is needed".into()),
    }
}

fn smoothing(text: &str) -> Result<SmoothingLength, String> {
    match text {
        "auto" => Ok(SmoothingLength::Auto),
        _ => positive(text)
            .map(SmoothingLength::Length)
            .map_err(|_| "a number above 0, or auto, is needed".into()),
    }
}

fn axis(text: &str) -> Result<usize, String> {
    let axes = ["x", "y", "z"].iter();
    let mut named = axes
        .enumerate()
        .filter(|(_, name)| text.eq_ignore_ascii_case(name));
    let (axis, _) = named.next().ok_or("x, y or z is needed")?;
    Ok(axis)
}

fn rotation(text: &str) -> Result<(usize, f64), String> {
    let parts = text.split_once('=');
    let rotation =
        parts.and_then(|(name, degrees)| Some((axis(name).ok()?, degrees.parse().ok()?)));
    rotation
        .filter(|(_, degrees)| f64::is_finite(*degrees))
        .ok_or_else(|| "an axis and degrees are needed, as in z=90".into())
}

/// An affine map by its rows; a fourth one is that of homogeneous coordinates.
fn matrix(text: &str) -> Result<DAffine3, String> {
    let needed = "three rows of four numbers are needed, as in 1,0,0,5,0,1,0,0,0,0,1,0, with a determinant that is not 0";
    let numbers: Option<Vec<f64>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    let numbers = numbers.ok_or(needed)?;
    let rows: &[f64; 12] = match &numbers[..] {
        [rows @ .., 0.0, 0.0, 0.0, 1.0] if rows.len() == 12 => rows.try_into(),
        rows => rows.try_into(),
    }
    .map_err(|_| needed)?;
    let column = |k: usize| DVec3::new(rows[k], rows[k + 4], rows[k + 8]);
    let map = DAffine3::from_cols(column(0), column(1), column(2), column(3));
    let size = map.matrix3.determinant().abs();
    match map.is_finite() && size.is_finite() && size > 0.0 {
        true => Ok(map),
        false => Err(needed.into()),
    }
}

#[cfg(test)]
mod tests {
    use neurotess::morphology::edit::SpinePlaces;

    use super::*;

    #[test]
    fn types_units_and_axes_are_understood() {
        let basal = NeuriteKind::BASAL_DENDRITE;
        let one = renamed("undefined=basal").expect("types");
        assert_eq!((one.from, one.to), (vec![NeuriteKind(0)], basal));
        assert_eq!(renamed("dendrite=7").expect("types").from.len(), 2);
        assert_eq!(renamed("0=soma").expect("types").to, NeuriteKind::SOMA);
        assert_eq!(
            types(" Soma").map(|types| types.kinds().to_vec()),
            Ok(vec![NeuriteKind::SOMA])
        );
        for wrong in ["3", "3=", "=3", "branch=2", "2=dendrite"] {
            assert!(renamed(wrong).is_err(), "{wrong}");
        }
        assert_eq!(units("nm"), Ok(DVec3::splat(0.001)));
        assert_eq!(units("voxel=0.1, 0.2,3"), Ok(DVec3::new(0.1, 0.2, 3.0)));
        for wrong in ["mm", "voxel", "voxel=1,2", "voxel=1,2,0", "voxel=1,2,3,4"] {
            assert!(units(wrong).is_err(), "{wrong}");
        }
        assert_eq!(rotation("Z=-90"), Ok((2, -90.0)));
        for wrong in ["z", "w=1", "z=inf", "z="] {
            assert!(rotation(wrong).is_err(), "{wrong}");
        }
        let map = matrix("0,-2,0,5, 2,0,0,6, 0,0,2,7").expect("a map");
        assert_eq!(map.transform_point3(DVec3::X), DVec3::new(5.0, 8.0, 7.0));
        assert_eq!(matrix("0,-2,0,5,2,0,0,6,0,0,2,7,0,0,0,1"), Ok(map));
        for wrong in [
            "1,2,3",
            "1,0,0,0,0,1,0,0,0,0,0,0",
            "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2",
            "a",
        ] {
            assert!(matrix(wrong).is_err(), "{wrong}");
        }
        assert!(factor("1").is_err() && factor("nan").is_err());
        assert_eq!(distance("inf"), Ok(f64::INFINITY));
        assert!(smoothing("0").is_err());
    }

    #[test]
    fn edits_stand_in_the_order_of_the_help() {
        use clap::CommandFactory;

        #[derive(clap::Parser)]
        struct All {
            #[command(flatten)]
            edits: EditArgs,
        }
        let command = All::command();
        let arguments = command.get_arguments().map(|a| a.get_id().to_string());
        let helped: Vec<String> = arguments
            .filter(|name| !["help", "units"].contains(&name.as_str()))
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
