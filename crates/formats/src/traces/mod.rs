//! SNT's traces, the format of Fiji's tracer: paths of points in XML, which gzip packs or not
//! (<https://imagej.net/plugins/snt/traces-file-format>).
//!
//! A path may start on another one, at a place rather than at a point: it hangs on the point that is nearest. Where a
//! path has a **fitted** version, with radii, and says to use it, that is read instead. Coordinates `xd`, `yd`, `zd`
//! are in the unit of `<samplespacing>`; files without them have voxels, `x`, `y`, `z`, and the spacing. All paths of a
//! file are one cell. Fills are left out.

mod paths;

use std::collections::HashMap;

use neurotess_morphology::NeuriteKind;

use crate::forest::Forest;
use crate::text::Located;
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text, xml};
use paths::{Path, Place};

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_text(Format::Traces, name, options, |name, warnings| {
        let text = xml::text(bytes)?;
        let paths = paths::paths(&text, warnings)?;
        if paths.iter().all(|path| path.points.is_empty()) {
            let (root, element) = ("tracings", "path");
            return Err((1, Fault::NoElement { root, element }));
        }
        forest(&paths)?.build(name, warnings)
    })
}

/// The points of all paths, hung on one another.
fn forest(paths: &[Path]) -> Located<Forest> {
    let shown = Shown::of(paths)?;
    let mut forest = Forest::default();
    // Of each path the points that stand for its own.
    let mut points: Vec<Vec<u32>> = vec![Vec::new(); paths.len()];
    for i in shown.order()? {
        let path = &paths[i];
        let drawn = &paths[shown.drawn[i]];
        let kind = match (path.kind, drawn.kind) {
            (NeuriteKind::UNDEFINED, fitted) => fitted,
            (own, _) => own,
        };
        let mut here = shown.parents[i].and_then(|p| {
            let (place, first) = (path.starts.as_ref()?, drawn.points.first()?);
            nearest(
                &forest,
                &points[p],
                place.at.unwrap_or(Place::Beside(first.position)),
            )
        });
        for (k, sample) in drawn.points.iter().enumerate() {
            let on = here.filter(|_| k == 0).map(|on| forest.node(on));
            // A path mostly begins with the point that it branches from. One from the soma keeps it: the way from there
            // to the second point is traced.
            let repeats = on.is_some_and(|on| {
                on.position.distance(sample.position) <= REPEATED
                    && (on.kind != NeuriteKind::SOMA || kind == NeuriteKind::SOMA)
            });
            if !(repeats && drawn.points.len() > 1) {
                let id = forest.len() as i64 + 1;
                here = Some(forest.push(id, kind, *sample, here));
            }
            points[i].extend(here);
        }
    }
    Ok(forest)
}

/// A point as near as this (µm) to the one that it hangs on repeats it: coordinates have about six digits.
const REPEATED: f64 = 1e-4;

/// The point of a path at a place.
fn nearest(forest: &Forest, points: &[u32], place: Place) -> Option<u32> {
    let at = match place {
        Place::Index(index) => return points.get(index).or(points.last()).copied(),
        Place::Beside(at) => at,
    };
    let off = |&&point: &&u32| forest.node(point).position.distance_squared(at);
    let nearest = points.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.copied()
}

/// Which paths are read, and how they hang on one another, by index.
struct Shown<'a> {
    paths: &'a [Path],
    /// The path whose points are read for it: itself, or its fitted version.
    drawn: Vec<usize>,
    parents: Vec<Option<usize>>,
    /// Whether it is a fitted version of another.
    hidden: Vec<bool>,
}

impl<'a> Shown<'a> {
    fn of(paths: &'a [Path]) -> Located<Self> {
        let mut index = HashMap::new();
        for (i, path) in paths.iter().enumerate() {
            if let Some(first) = index.insert(path.id, i) {
                let (id, first_line) = (path.id, paths[first].line);
                return Err((path.line, Fault::RepeatedPath { id, first_line }));
            }
        }
        let find = |id: Option<i64>| id.and_then(|id| index.get(&id)).copied();
        let hidden: Vec<bool> = paths.iter().map(|p| find(p.version_of).is_some()).collect();
        let mut parents = Vec::with_capacity(paths.len());
        for path in paths {
            let Some(place) = &path.starts else {
                parents.push(None);
                continue;
            };
            let Some(on) = find(Some(place.on)) else {
                let (id, parent) = (path.id, place.on);
                return Err((path.line, Fault::UnknownPath { id, parent }));
            };
            // What starts on a fitted version starts on the path that it is of.
            parents.push(Some(find(paths[on].version_of).unwrap_or(on)));
        }
        let drawn = |(i, path): (usize, &Path)| match path.uses_fitted {
            true => find(path.fitted).unwrap_or(i),
            false => i,
        };
        Ok(Self {
            drawn: paths.iter().enumerate().map(drawn).collect(),
            paths,
            parents,
            hidden,
        })
    }

    /// Paths that are read, those that others start on first.
    fn order(&self) -> Located<Vec<usize>> {
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); self.paths.len()];
        for (i, parent) in self.parents.iter().enumerate() {
            if let (Some(parent), false) = (parent, self.hidden[i]) {
                children[*parent].push(i);
            }
        }
        let is_root = |i: &usize| self.parents[*i].is_none() && !self.hidden[*i];
        let mut open: Vec<usize> = (0..self.paths.len()).rev().filter(is_root).collect();
        let mut order = Vec::new();
        while let Some(i) = open.pop() {
            order.push(i);
            open.extend(children[i].iter().rev());
        }
        let mut reached = self.hidden.clone();
        order.iter().for_each(|&i| reached[i] = true);
        match reached.iter().position(|reached| !reached) {
            Some(lost) => Err((self.paths[lost].line, Fault::OwnAncestor)),
            None => Ok(order),
        }
    }
}
