//! The paths of a file of SNT.

use glam::DVec3;
use neurotess_morphology::NeuriteKind;

use crate::sample::Sample;
use crate::text::Located;
use crate::unit::micrometers;
use crate::warning::Warnings;
use crate::xml::{Document, Element, Part};

/// A run of points.
pub(super) struct Path {
    pub(super) id: i64,
    pub(super) line: u64,
    pub(super) kind: NeuriteKind,
    pub(super) points: Vec<Sample>,
    /// Where it starts, if that is on another path.
    pub(super) starts: Option<Start>,
    /// Number of its fitted version.
    pub(super) fitted: Option<i64>,
    /// Whether that is to be read instead.
    pub(super) uses_fitted: bool,
    /// Number of the path that it is a fitted version of.
    pub(super) version_of: Option<i64>,
    /// Whether the file has it from its end to its start.
    reversed: bool,
}

/// Where a path starts on another one.
pub(super) struct Start {
    pub(super) on: i64,
    /// Nothing: where it is nearest.
    pub(super) at: Option<Place>,
}

#[derive(Clone, Copy)]
pub(super) enum Place {
    /// At a point by its index.
    Index(usize),
    /// At the point that is nearest (µm).
    Beside(DVec3),
}

/// What a file counts lengths by.
struct Spacing {
    /// Size of a voxel in the file's unit.
    voxel: DVec3,
    /// Micrometers in the file's unit.
    unit: f64,
}

/// Reads all paths.
pub(super) fn paths(text: &str, warnings: &mut Warnings) -> Located<Vec<Path>> {
    let mut document = Document::new(text);
    let mut paths: Vec<Path> = Vec::new();
    let mut spacing = Spacing {
        voxel: DVec3::ONE,
        unit: 1.0,
    };
    while let Some(part) = document.next_part()? {
        let Part::Begin(element) = part else {
            continue;
        };
        let [_, parent] = document.parents();
        match (parent, &*element.name) {
            (_, "samplespacing") => spacing = self::spacing(&element, warnings)?,
            (_, "path") => paths.push(path(&element, &spacing, warnings)?),
            ("path", "point") => {
                let point = point(&element, &spacing)?;
                if let Some(path) = paths.last_mut() {
                    path.points.push(point);
                }
            }
            _ => {}
        }
    }
    for path in paths.iter_mut().filter(|path| path.reversed) {
        path.points.reverse();
    }
    Ok(paths)
}

fn spacing(element: &Element, warnings: &mut Warnings) -> Located<Spacing> {
    let side = |key| element.real_if_any(key).map(|side| side.unwrap_or(1.0));
    let voxel = DVec3::new(side("x")?, side("y")?, side("z")?);
    let unit = element.attribute("units").unwrap_or_default();
    let unit = micrometers(&unit).unwrap_or_else(|| {
        // Images that nobody calibrated have pixels.
        warnings.add(
            element.line,
            "unknown_unit",
            "the unit of lengths is none that is known: taken as micrometers",
        );
        1.0
    });
    Ok(Spacing { voxel, unit })
}

fn path(element: &Element, spacing: &Spacing, warnings: &mut Warnings) -> Located<Path> {
    let starts = start(
        element,
        spacing,
        "startson",
        // Older versions left out an s.
        [
            ["startsx", "startsy", "startsz"],
            ["startx", "starty", "startz"],
        ],
        "startsindex",
    )?;
    let ends = start(
        element,
        spacing,
        "endson",
        [["endsx", "endsy", "endsz"], ["endx", "endy", "endz"]],
        "endsindex",
    )?;
    if starts.is_some() && ends.is_some() {
        warnings.add(
            element.line,
            "ends_left_out",
            "a path that also ends on another one: not joined there, for trees have no loops",
        );
    }
    let kind = element.whole_if_any("swctype")?.unwrap_or(0);
    let kind = i32::try_from(kind).map_err(|_| element.fault("swctype", kind.to_string()))?;
    Ok(Path {
        id: element.whole("id")?,
        line: element.line,
        kind: NeuriteKind(kind),
        points: Vec::new(),
        // One that was drawn toward the path that it hangs on starts at its end.
        reversed: starts.is_none() && ends.is_some(),
        starts: starts.or(ends),
        fitted: element.whole_if_any("fitted")?,
        uses_fitted: element
            .attribute("usefitted")
            .is_some_and(|uses| uses == "true"),
        version_of: element.whole_if_any("fittedversionof")?,
    })
}

fn start(
    element: &Element,
    spacing: &Spacing,
    on: &'static str,
    places: [[&'static str; 3]; 2],
    index: &'static str,
) -> Located<Option<Start>> {
    let Some(on) = element.whole_if_any(on)? else {
        return Ok(None);
    };
    let named = |place: &[&str; 3]| element.attribute(place[0]).is_some();
    let at = match places.into_iter().find(named) {
        Some(place) => Some(Place::Beside(element.reals(place)? * spacing.unit)),
        None => {
            let index = element.whole_if_any(index)?;
            index.map(|i| Place::Index(usize::try_from(i).unwrap_or(0)))
        }
    };
    Ok(Some(Start { on, at }))
}

fn point(element: &Element, spacing: &Spacing) -> Located<Sample> {
    let position = match element.attribute("xd") {
        Some(_) => element.reals(["xd", "yd", "zd"])?,
        None => element.reals(["x", "y", "z"])? * spacing.voxel,
    };
    Ok(Sample {
        position: position * spacing.unit,
        radius: element.radius_if_any("r")?.unwrap_or(0.0) * spacing.unit,
        line: element.line,
    })
}
