//! How a soma was traced, and the sphere that stands for it.
//!
//! The rules follow what readers do with files of NeuroMorpho.Org, Allen and Blue Brain; see
//! `docs/other-programs.md` for how they differ from MorphIO's and NeuroM's.
//!
//! **The sphere of an outline.** An outline of area A and perimeter P (its ends joined) that goes once
//! around something has the radius of equal area, √(A/π), about its centroid. One that is a needle, open or
//! crosses itself encloses next to nothing, and a sphere of that would be far too small: where
//! 4πA < P²/4 (a circle has 4πA = P², an ellipse of ten to one P²/4), and where it is not nearly flat, the
//! sphere is the mean of the samples with their mean distance from it, as in NeuroM. Outlines of some
//! width have about the same radius by either rule.
//!
//! Samples without any thickness, two or more, are an outline in whatever order they hang: cylinders of no
//! radius are none.

mod cones;
mod directions;
mod frusta;
mod marks;
mod outline;
mod shape;
mod smooth;
mod stack;
mod triangles;

pub(crate) use marks::{FEWEST_MARKS, THIN};
pub use shape::SomaShape;
pub use triangles::{Hidden, SomaMeshError};

use std::f64::consts::PI;

use glam::DVec3;

use marks::Marks;

use crate::{Soma, SomaKind, SomaSample};

/// Relative tolerance of the three-point soma: files round coordinates to two decimals.
const THREE_POINT_TOLERANCE: f64 = 0.01;
/// Greatest gap between a contour's ends, as a part of its length. By eye: 0.02 in C210401C.
const CONTOUR_GAP: f64 = 0.2;
/// An outline whose area is less than this part of that of a circle of its perimeter has no area worth the
/// name. By eye, between the held outlines of real cells (0.4 and more) and needles.
const CONTOUR_ROUNDNESS: f64 = 0.25;
/// Greatest distance of a contour from its plane, as a part of its radius. By eye.
const CONTOUR_BULGE: f64 = 0.25;
/// Outlines in one block are apart where z changes by more than this many of its usual steps.
const PLANE_JUMP: f64 = 4.0;
/// Greatest gap between the ends of an outline in such a block, as a part of its length: outlines of few samples have
/// gaps of 0.4 (`c05_stack_in_one_block.asc`), halves of one 0.8 (`c24_outline_not_flat.asc`).
const PLANE_GAP: f64 = 0.6;
/// Greatest distance of an outline from its plane that still has the silhouette of the soma: 0.6 in C220197A-P2.h5.
const TRACED_BULGE: f64 = 0.8;
/// A contour's constant radius is thinner than this part of its own radius. By eye.
const CONTOUR_THICKNESS: f64 = 0.05;

impl Soma {
    /// Recognizes how the samples trace a soma and finds its sphere.
    ///
    /// # Panics
    /// If there is no sample, or a parent is not among the samples.
    pub fn from_samples(samples: Vec<SomaSample>) -> Self {
        assert!(!samples.is_empty(), "a soma has at least one sample");
        let positions: Vec<DVec3> = samples.iter().map(|s| s.position.as_dvec3()).collect();
        let (kind, center, radius) = if samples.len() == 1 {
            (SomaKind::Point, positions[0], f64::from(samples[0].radius))
        } else if let Some(root) = three_point_root(&samples, &positions) {
            (
                SomaKind::ThreePoint,
                mean(&positions),
                f64::from(samples[root].radius),
            )
        } else if let Some((centroid, radius)) = contour(&samples, &positions) {
            (SomaKind::Contour, centroid, radius)
        } else if let Some(marked) = marked(&samples, &positions) {
            marked
        } else if let Some((center, radius)) = without_thickness(&samples, &positions) {
            (SomaKind::Contour, center, radius)
        } else {
            (
                SomaKind::Cylinders,
                mean(&positions),
                frusta::radius(&samples),
            )
        };
        Self {
            kind,
            samples,
            center: center.as_vec3(),
            radius: radius as f32,
        }
    }

    /// The soma that one outline or several, stacked, trace.
    ///
    /// An outline begins at the first sample, at each that does not hang on the one before, and where z jumps.
    /// The sphere is that of the outline with the greatest one. Where none is nearly flat, it is the mean
    /// of the samples with their mean distance from it. A single sample is a sphere.
    ///
    /// # Panics
    /// If there is no sample.
    pub fn from_outlines(samples: Vec<SomaSample>) -> Self {
        if samples.len() < 2 {
            return Self::from_samples(samples);
        }
        let positions: Vec<DVec3> = samples.iter().map(|s| s.position.as_dvec3()).collect();
        let (center, radius) =
            largest(&blocks(&samples, &positions)).unwrap_or_else(|| spread(&positions));
        Self {
            kind: SomaKind::Contour,
            samples,
            center: center.as_vec3(),
            radius: radius as f32,
        }
    }

    /// The outlines that it was traced by and that go around something; none of other somata. They need not be flat:
    /// whoever traces follows the focus.
    pub fn outlines(&self) -> Vec<Vec<DVec3>> {
        if self.kind != SomaKind::Contour {
            return Vec::new();
        }
        let positions: Vec<DVec3> = self.samples.iter().map(|s| s.position.as_dvec3()).collect();
        if let Some(Marks::Outline(outline)) = Marks::of(&self.samples, &positions) {
            return vec![outline];
        }
        let mut outlines = blocks(&self.samples, &positions);
        if outlines.iter().all(|outline| outline.len() < 3) {
            // Without thickness, and linked in another way.
            let order = chain(&self.samples).unwrap_or_else(|| (0..self.samples.len()).collect());
            outlines = vec![order.into_iter().map(|i| positions[i]).collect()];
        }
        outlines.retain(|outline| encloses(outline, TRACED_BULGE).is_some());
        outlines
    }

    /// Whether it was traced by samples one after another.
    pub(crate) fn is_chain(&self) -> bool {
        frusta::is_chain(&self.samples)
    }

    /// Whether samples of it have no radius of their own, and are no balls or frusta: see [`marks`].
    pub(crate) fn is_marked(&self) -> bool {
        let positions: Vec<DVec3> = self.samples.iter().map(|s| s.position.as_dvec3()).collect();
        Marks::of(&self.samples, &positions).is_some()
    }

    /// The first sample that two others hang on, if any.
    pub(crate) fn fork(&self) -> Option<u32> {
        let counts = child_counts(&self.samples);
        counts.iter().position(|&count| count > 1).map(|i| i as u32)
    }
}

/// Area (µm²) and volume (µm³) of a soma: of its sphere, but of cylinders the sum of their frusta
/// without caps.
pub fn soma_area_volume(soma: &Soma) -> (f64, f64) {
    if soma.kind == SomaKind::Cylinders {
        return frusta::area_volume(&soma.samples);
    }
    let r = f64::from(soma.radius).max(0.0);
    (4.0 * PI * r * r, 4.0 / 3.0 * PI * r * r * r)
}

/// Kind, center and radius of samples of which only one has a radius of its own.
fn marked(samples: &[SomaSample], positions: &[DVec3]) -> Option<(SomaKind, DVec3, f64)> {
    Some(match Marks::of(samples, positions)? {
        Marks::Outline(outline) => {
            let (center, radius) = flat_outline(&outline)?;
            (SomaKind::Contour, center, radius)
        }
        Marks::Surface(center, radius) => (SomaKind::Surface, center, radius),
        Marks::LeftOut(middle) => {
            let radius = f64::from(samples[middle].radius);
            (SomaKind::Point, positions[middle], radius)
        }
    })
}

/// Samples in a row, divided where z jumps.
fn blocks(samples: &[SomaSample], positions: &[DVec3]) -> Vec<Vec<DVec3>> {
    let follows = |i: usize| i > 0 && samples[i].parent == Some(i as u32 - 1);
    let starts = (0..samples.len()).filter(|&i| !follows(i));
    let starts: Vec<usize> = starts.chain([samples.len()]).collect();
    let blocks = starts.windows(2).map(|ends| &positions[ends[0]..ends[1]]);
    blocks
        .flat_map(|block| planes(block).into_iter().map(<[DVec3]>::to_vec))
        .collect()
}

/// The outlines of a block that holds a stack of them: it is divided where z jumps, if each part goes nearly around by
/// itself at a height of its own. Else the block is one outline.
fn planes(block: &[DVec3]) -> Vec<&[DVec3]> {
    let whole = || vec![block];
    let steps: Vec<f64> = block.windows(2).map(|w| (w[1].z - w[0].z).abs()).collect();
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(most) = sorted.last().filter(|most| **most > 0.0) else {
        return whole();
    };
    let usual = sorted[sorted.len() / 2];
    let jump = (PLANE_JUMP * usual).max(0.1 * most);
    let starts = (1..block.len()).filter(|&i| steps[i - 1] > jump);
    let starts: Vec<usize> = [0].into_iter().chain(starts).chain([block.len()]).collect();
    let parts = starts.windows(2).map(|ends| &block[ends[0]..ends[1]]);
    let parts: Vec<&[DVec3]> = parts.collect();
    let mut heights: Vec<f64> = parts.iter().map(|part| mean(part).z).collect();
    heights.sort_by(f64::total_cmp);
    let apart = heights.windows(2).all(|w| w[1] - w[0] > jump);
    let around = |part: &&[DVec3]| {
        let length: f64 = part.windows(2).map(|w| w[0].distance(w[1])).sum();
        part.len() > 2 && part[0].distance(part[part.len() - 1]) <= PLANE_GAP * length
    };
    match parts.len() > 1 && apart && parts.iter().all(around) {
        true => parts,
        false => whole(),
    }
}

/// The greatest sphere of outlines that are nearly flat.
fn largest(outlines: &[Vec<DVec3>]) -> Option<(DVec3, f64)> {
    let spheres = outlines.iter().filter_map(|outline| flat_outline(outline));
    spheres.reduce(|best, other| if other.1 > best.1 { other } else { best })
}

fn mean(positions: &[DVec3]) -> DVec3 {
    positions.iter().copied().sum::<DVec3>() / positions.len() as f64
}

/// The mean of the positions and their mean distance from it.
fn spread(positions: &[DVec3]) -> (DVec3, f64) {
    let center = mean(positions);
    let distances = positions.iter().map(|p| p.distance(center));
    (center, distances.sum::<f64>() / positions.len() as f64)
}

fn child_counts(samples: &[SomaSample]) -> Vec<u32> {
    let mut counts = vec![0; samples.len()];
    for parent in samples.iter().filter_map(|s| s.parent) {
        counts[parent as usize] += 1;
    }
    counts
}

/// NeuroMorpho.Org's convention: two samples on opposite sides of the root, one radius away.
/// The direction is free: files have been turned and scaled since.
fn three_point_root(samples: &[SomaSample], positions: &[DVec3]) -> Option<usize> {
    if samples.len() != 3 {
        return None;
    }
    let root = samples.iter().position(|s| s.parent.is_none())?;
    let (a, b) = ((root + 1) % 3, (root + 2) % 3);
    let linked = [a, b]
        .iter()
        .all(|&i| samples[i].parent == Some(root as u32));
    let r = f64::from(samples[root].radius);
    let near = |x: f64, y: f64| (x - y).abs() <= THREE_POINT_TOLERANCE * r;
    let center = positions[root];
    let fits = linked
        && r > 0.0
        && [a, b]
            .iter()
            .all(|&i| near(f64::from(samples[i].radius), r))
        && [a, b]
            .iter()
            .all(|&i| near(positions[i].distance(center), r))
        && near((positions[a] + positions[b]).distance(2.0 * center), 0.0);
    fits.then_some(root)
}

/// Centroid and radius of equal area, if the samples are a closed, thin outline.
fn contour(samples: &[SomaSample], positions: &[DVec3]) -> Option<(DVec3, f64)> {
    let outline: Vec<DVec3> = chain(samples)?.into_iter().map(|i| positions[i]).collect();
    let (first, last) = (*outline.first()?, *outline.last()?);
    let length: f64 = outline.windows(2).map(|w| w[0].distance(w[1])).sum();
    if outline.len() < 4 || first.distance(last) > CONTOUR_GAP * length {
        return None;
    }
    flat_outline(&outline).filter(|&(_, radius)| thin(samples, radius))
}

/// The sphere of samples that have no thickness at all: their outline if they are in a row, else what
/// they spread over. None if they are in one place.
fn without_thickness(samples: &[SomaSample], positions: &[DVec3]) -> Option<(DVec3, f64)> {
    if samples.iter().any(|sample| sample.radius > 0.0) {
        return None;
    }
    let outline = chain(samples).map(|order| order.into_iter().map(|i| positions[i]).collect());
    let outline: Option<Vec<DVec3>> = outline;
    let sphere = outline.and_then(|outline| flat_outline(&outline));
    let sphere = sphere.unwrap_or_else(|| spread(positions));
    (sphere.1 > 0.0).then_some(sphere)
}

/// The sphere of an outline that is nearly flat: see the head of the file.
fn flat_outline(outline: &[DVec3]) -> Option<(DVec3, f64)> {
    match encloses(outline, CONTOUR_BULGE) {
        None if is_needle(outline)? => Some(spread(outline)),
        sphere => sphere,
    }
}

/// Whether an outline encloses next to nothing; none if it has no area at all.
fn is_needle(outline: &[DVec3]) -> Option<bool> {
    let (_, radius, _) = vector_area(outline)?;
    let round = 2.0 * PI * radius / perimeter(outline);
    Some(round * round < CONTOUR_ROUNDNESS)
}

fn perimeter(outline: &[DVec3]) -> f64 {
    let corners = outline.iter().zip(outline.iter().cycle().skip(1));
    corners.map(|(&a, &b)| a.distance(b)).sum()
}

/// Mean of the samples, radius of equal area and unit normal.
fn vector_area(outline: &[DVec3]) -> Option<(DVec3, f64, DVec3)> {
    let middle = mean(outline);
    let corners = outline.iter().zip(outline.iter().cycle().skip(1));
    let normal: DVec3 = corners.map(|(&a, &b)| (a - middle).cross(b - middle)).sum();
    let radius = (normal.length() / 2.0 / PI).sqrt();
    Some((middle, radius, normal.try_normalize()?))
}

/// Centroid and radius of equal area of an outline that goes around something and is no farther from its plane than
/// this share of the radius.
fn encloses(outline: &[DVec3], most: f64) -> Option<(DVec3, f64)> {
    let (middle, radius, normal) = vector_area(outline)?;
    let corners = || outline.iter().zip(outline.iter().cycle().skip(1));
    let bulge = outline
        .iter()
        .map(|&p| (p - middle).dot(normal).abs())
        .fold(0.0, f64::max);
    if is_needle(outline)? || bulge > most * radius {
        return None;
    }
    let weighted = |(&a, &b): (&DVec3, &DVec3)| {
        let twice_area = (a - middle).cross(b - middle).dot(normal);
        (a + b - 2.0 * middle) / 3.0 * twice_area
    };
    let moment: DVec3 = corners().map(weighted).sum();
    Some((middle + moment / (2.0 * PI * radius * radius), radius))
}

/// Whether (nearly) all radii are zero, or all the same and tiny.
fn thin(samples: &[SomaSample], contour_radius: f64) -> bool {
    let zero = samples.iter().filter(|s| s.radius == 0.0).count();
    let same = samples.iter().all(|s| s.radius == samples[0].radius);
    let thickest = samples
        .iter()
        .map(|s| f64::from(s.radius))
        .fold(0.0, f64::max);
    let tiny = thickest <= CONTOUR_THICKNESS * contour_radius;
    tiny && (same || zero * 10 >= samples.len() * 9)
}

/// The samples from the root on, if none has two children.
fn chain(samples: &[SomaSample]) -> Option<Vec<usize>> {
    let mut next = vec![None; samples.len()];
    for (i, sample) in samples.iter().enumerate() {
        if let Some(parent) = sample.parent
            && next[parent as usize].replace(i).is_some()
        {
            return None;
        }
    }
    let root = samples.iter().position(|s| s.parent.is_none());
    let chain: Vec<usize> = std::iter::successors(root, |&i| next[i]).collect();
    (chain.len() == samples.len()).then_some(chain)
}

#[cfg(test)]
mod tests;
