//! Values of edits.

use std::fmt;
use std::str::FromStr;

use glam::{DAffine3, DVec3};
use neurotess_morphology::NeuriteKind;
use neurotess_morphology::smoothing::SmoothingLength;

use super::{Positive, Types};
use crate::given::by_text;

/// A word for types of samples: as [`Types`], and soma.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EditedTypes(Types);

impl EditedTypes {
    /// The types that it means.
    pub fn kinds(&self) -> &[NeuriteKind] {
        self.0.kinds()
    }
}

impl FromStr for EditedTypes {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        match word.trim().to_ascii_lowercase().as_str() {
            "soma" => Ok(Self(Types::of_kinds("soma", vec![NeuriteKind::SOMA]))),
            other => other.parse().map(Self),
        }
    }
}

impl fmt::Display for EditedTypes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Types that become another one: FROM=TO.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Renamed {
    from: EditedTypes,
    to: EditedTypes,
}

impl Renamed {
    /// Each type with the one that it becomes.
    pub fn pairs(&self) -> impl Iterator<Item = (NeuriteKind, NeuriteKind)> + '_ {
        let to = self.to.kinds().iter().copied();
        let from = self.from.kinds().iter().copied();
        from.flat_map(move |from| to.clone().map(move |to| (from, to)))
    }
}

impl FromStr for Renamed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let needed = "FROM=TO is needed, as in 5=2 or undefined=basal";
        let (from, to) = text.split_once('=').ok_or(needed)?;
        let (from, to): (EditedTypes, EditedTypes) = (from.parse()?, to.parse()?);
        match to.kinds().len() {
            1 => Ok(Self { from, to }),
            _ => {
                Err("a single type must stand after =: basal or apical instead of dendrite".into())
            }
        }
    }
}

impl fmt::Display for Renamed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.from, self.to)
    }
}

/// The unit of a file: um, nm, or voxel=X,Y,Z with the sides of a voxel (µm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SourceUnit(DVec3);

impl SourceUnit {
    /// Factors on x, y and z (µm).
    pub fn factors(&self) -> DVec3 {
        self.0
    }
}

impl FromStr for SourceUnit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "um" | "µm" | "μm" => return Ok(Self(DVec3::ONE)),
            "nm" => return Ok(Self(DVec3::splat(0.001))),
            _ => {}
        }
        let sides = text.strip_prefix("voxel=").unwrap_or(text);
        let sides: Result<Vec<Positive>, String> = sides.split(',').map(str::parse).collect();
        match sides.as_deref() {
            Ok(&[x, y, z]) => Ok(Self(DVec3::new(x.0, y.0, z.0))),
            _ => Err("um, nm or voxel=X,Y,Z is needed, as in voxel=0.1,0.1,0.5".into()),
        }
    }
}

impl fmt::Display for SourceUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DVec3 { x, y, z } = self.0;
        write!(f, "voxel={x},{y},{z}")
    }
}

/// How many times thicker or thinner than those around it a radius is mended: above 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlierFactor(pub f64);

impl FromStr for OutlierFactor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            Ok(factor) if factor > 1.0 && f64::is_finite(factor) => Ok(Self(factor)),
            // As a switch it is the usual one.
            _ if text == "true" => Ok(Self(5.0)),
            _ => Err("a number above 1 is needed".into()),
        }
    }
}

impl fmt::Display for OutlierFactor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A distance (µm) above 0, perhaps infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance(pub f64);

impl FromStr for Distance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            Ok(distance) if distance > 0.0 => Ok(Self(distance)),
            _ => Err("a number above 0, or inf, is needed".into()),
        }
    }
}

impl fmt::Display for Distance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A length (µm) that is smoothed away, or one for each section: auto.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing(pub SmoothingLength);

impl FromStr for Smoothing {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.parse::<Positive>()) {
            ("auto", _) => Ok(Self(SmoothingLength::Auto)),
            (_, Ok(length)) => Ok(Self(SmoothingLength::Length(length.0))),
            _ => Err("a number above 0, or auto, is needed".into()),
        }
    }
}

impl fmt::Display for Smoothing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            SmoothingLength::Length(length) => length.fmt(f),
            _ => f.write_str("auto"),
        }
    }
}

/// An axis: x, y or z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisName(pub usize);

const AXES: [&str; 3] = ["x", "y", "z"];

impl FromStr for AxisName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let axis = AXES.iter().position(|name| text.eq_ignore_ascii_case(name));
        axis.map(Self).ok_or_else(|| "x, y or z is needed".into())
    }
}

impl fmt::Display for AxisName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(AXES[self.0])
    }
}

/// A turn around an axis through the origin: AXIS=DEG.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// The axis.
    pub axis: AxisName,
    /// Counterclockwise.
    pub degrees: f64,
}

impl FromStr for Rotation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once(['=', ',']);
        let turn = parts.and_then(|(axis, degrees)| {
            Some(Self {
                axis: axis.parse().ok()?,
                degrees: degrees.trim().parse().ok()?,
            })
        });
        let turn = turn.filter(|turn| turn.degrees.is_finite());
        turn.ok_or_else(|| "an axis and degrees are needed, as in z=90".into())
    }
}

impl fmt::Display for Rotation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.axis, self.degrees)
    }
}

/// An affine map: three rows of four numbers, the last of each a shift (µm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine(DAffine3);

impl Affine {
    /// The map.
    pub fn map(&self) -> DAffine3 {
        self.0
    }
}

impl FromStr for Affine {
    type Err = String;

    /// Reads its rows; a fourth one is that of homogeneous coordinates.
    fn from_str(text: &str) -> Result<Self, String> {
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
            true => Ok(Self(map)),
            false => Err(needed.into()),
        }
    }
}

impl fmt::Display for Affine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.0.to_cols_array_2d();
        let numbers = (0..12).map(|k| columns[k % 4][k / 4].to_string());
        f.write_str(&numbers.collect::<Vec<_>>().join(","))
    }
}

by_text!(
    EditedTypes,
    Renamed,
    SourceUnit,
    OutlierFactor,
    Distance,
    Smoothing,
    AxisName,
    Rotation,
    Affine
);

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads a text, and what is written of it again.
    fn read<T: FromStr<Err = String> + fmt::Display + PartialEq + fmt::Debug>(
        text: &str,
    ) -> Option<T> {
        let value: T = text.parse().ok()?;
        assert_eq!(value.to_string().parse().as_ref(), Ok(&value), "{text}");
        Some(value)
    }

    #[test]
    fn types_units_and_axes_are_understood() {
        let pairs = |text: &str| read::<Renamed>(text).map(|one| one.pairs().collect::<Vec<_>>());
        let basal = NeuriteKind::BASAL_DENDRITE;
        assert_eq!(
            pairs("undefined=basal"),
            Some(vec![(NeuriteKind(0), basal)])
        );
        assert_eq!(pairs("dendrite=7").map(|pairs| pairs.len()), Some(2));
        assert_eq!(
            pairs("0= Soma"),
            Some(vec![(NeuriteKind(0), NeuriteKind::SOMA)])
        );
        for wrong in ["3", "3=", "=3", "branch=2", "2=dendrite"] {
            assert!(pairs(wrong).is_none(), "{wrong}");
        }
        let unit = |text: &str| read::<SourceUnit>(text).map(|unit| unit.factors());
        assert_eq!(unit("nm"), Some(DVec3::splat(0.001)));
        assert_eq!(unit("voxel=0.1, 0.2,3"), Some(DVec3::new(0.1, 0.2, 3.0)));
        for wrong in ["mm", "voxel", "voxel=1,2", "voxel=1,2,0", "voxel=1,2,3,4"] {
            assert!(unit(wrong).is_none(), "{wrong}");
        }
        let turn = Rotation {
            axis: AxisName(2),
            degrees: -90.0,
        };
        assert_eq!(read("Z=-90"), Some(turn));
        for wrong in ["z", "w=1", "z=inf", "z="] {
            assert!(read::<Rotation>(wrong).is_none(), "{wrong}");
        }
        assert!(read::<OutlierFactor>("1").is_none() && read::<OutlierFactor>("nan").is_none());
        assert_eq!(read("inf"), Some(Distance(f64::INFINITY)));
        assert!(read::<Smoothing>("0").is_none() && read::<Smoothing>("auto").is_some());
    }

    #[test]
    fn maps_have_rows() {
        let map = read::<Affine>("0,-2,0,5, 2,0,0,6, 0,0,2,7").expect("a map");
        assert_eq!(
            map.map().transform_point3(DVec3::X),
            DVec3::new(5.0, 8.0, 7.0)
        );
        assert_eq!(read("0,-2,0,5,2,0,0,6,0,0,2,7,0,0,0,1"), Some(map));
        for wrong in [
            "1,2,3",
            "1,0,0,0,0,1,0,0,0,0,0,0",
            "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2",
            "a",
        ] {
            assert!(read::<Affine>(wrong).is_none(), "{wrong}");
        }
    }
}
