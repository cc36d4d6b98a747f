//! What exploration keeps of a coarse mesh: runs of its paths with simplified forms, and its somata.
//!
//! A **run** is up to 64 segments of a path: what is culled, chosen and listed as one. Its positions
//! and radii are counted in 65,535 steps of its own extent: 8 bytes a point, and a byte for each
//! point of a simplified form, at most one a point in all.

use std::ops::Range;

use glam::{DVec3, Vec2, Vec3};
use neurotess_mesh::{CoarseMesh, Role};

use super::layout::{
    ERROR_OFFSET, ERROR_STEPS, LEVELS, MOST_SEGMENTS, MOST_SWAY, NO_FORM, RUN_FREE_END,
    RUN_FREE_START, RUN_ONE_WORD, Run,
};
use super::nested::simplify;
use super::paths::{PathPoint, TubePath, tube_paths};
use super::somata;
use crate::framing::Ball;

/// Steps of a stored coordinate.
const STEPS: f32 = 65_535.0;

/// A template for exploration, made on the host, ready to be uploaded.
#[derive(Clone, Debug, Default)]
pub struct Sketch {
    pub(crate) origin: DVec3,
    pub(crate) runs: Vec<Run>,
    pub(crate) heap: Vec<u32>,
    pub(crate) words: Vec<u32>,
    /// By run: tracing points that its words are of.
    pub(super) colors: Vec<Vec<u32>>,
    pub(crate) center: Vec3,
    pub(crate) reach: f32,
    points: usize,
}

impl Sketch {
    /// Sketches a mesh. `words`: one per tracing point for whoever shades; missing ones are 0.
    pub fn new(mesh: &CoarseMesh, words: &[u32]) -> Self {
        let mut sketch = Self {
            origin: mesh.origin,
            points: mesh
                .tracing
                .iter()
                .filter(|point| point.role != Role::Soma)
                .count(),
            ..Self::default()
        };
        somata::add(&mut sketch, mesh);
        let mut carriers = Carriers::new(mesh, sketch.runs.len());
        for path in tube_paths(mesh) {
            let directions = directions(&path.points);
            let segments = path.points.len() - 1;
            let pieces = segments.div_ceil(MOST_SEGMENTS);
            let cut = |piece: usize| piece * segments / pieces;
            for piece in 0..pieces {
                let (from, to) = (cut(piece), cut(piece + 1));
                let mut flags = 0;
                if piece == 0 && path.starts_free {
                    flags |= RUN_FREE_START;
                }
                if piece + 1 == pieces {
                    flags |= RUN_FREE_END;
                }
                carriers.add(&path, from..to, sketch.runs.len());
                sketch.add_run(&path.points[from..=to], &directions[from..=to], flags);
            }
        }
        carriers.carry(&mut sketch.runs);
        sketch.set_words(words);
        (sketch.center, sketch.reach) = ball_around(&sketch.runs);
        sketch
    }

    /// Other colors: words of the tracing points of the mesh that it was made of.
    pub fn set_words(&mut self, words: &[u32]) {
        self.words.clear();
        for (run, colors) in self.runs.iter_mut().zip(&self.colors) {
            let word = |&tracing: &u32| words.get(tracing as usize).copied().unwrap_or(0);
            let first = colors.first().map_or(0, word);
            if colors.iter().all(|tracing| word(tracing) == first) {
                run.flags |= RUN_ONE_WORD;
                run.words = first;
            } else {
                run.flags &= !RUN_ONE_WORD;
                run.words = self.words.len() as u32;
                self.words.extend(colors.iter().map(word));
            }
        }
    }

    /// Number of tracing points, those of somata aside.
    pub fn point_count(&self) -> usize {
        self.points
    }

    /// Ball around all of it, in the tracing's own coordinates (µm).
    pub fn ball(&self) -> Ball {
        (self.origin + self.center.as_dvec3(), f64::from(self.reach))
    }

    /// Balls that together hold all of it, in the tracing's own coordinates (µm): one for each run.
    pub fn balls(&self) -> Vec<Ball> {
        let ball = |run: &Run| {
            let center = Vec3::from_array(run.center).as_dvec3();
            (self.origin + center, f64::from(run.reach))
        };
        self.runs.iter().map(ball).collect()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&*self.runs) + size_of_val(&*self.heap) + size_of_val(&*self.words)) as u64
    }

    /// Adds a run whose points and simplified forms are packed here.
    fn add_run(&mut self, points: &[PathPoint], directions: &[Vec3], flags: u32) {
        let tube: Vec<(Vec3, f32)> = points.iter().map(|p| (p.center, p.radius)).collect();
        let length: f32 = tube.windows(2).map(|w| w[0].0.distance(w[1].0)).sum();
        let radius = tube.iter().map(|p| p.1).fold(0.0, f32::max);
        let mean = tube.iter().map(|p| p.1).sum::<f32>() / tube.len() as f32;
        let sway = sway(&tube, directions);
        let mut counts = [0_u8; 8];
        let mut errors = [NO_FORM; 8];
        counts[0] = (points.len() - 1) as u8;
        errors[0] = error_byte(sway);
        let mut lists: Vec<u8> = Vec::new();
        for (k, form) in (1..LEVELS).zip(simplify(&tube)) {
            let Some(form) = form else { continue };
            counts[k] = (form.kept.len() - 1) as u8;
            errors[k] = error_byte(form.error + sway);
            lists.extend(form.kept);
        }
        lists.resize(lists.len().next_multiple_of(4), 0);
        let (low, step) = grid(tube.iter().map(|p| p.0));
        let first = self.heap.len() as u32;
        for &(center, r) in &tube {
            let share = r / radius.max(f32::MIN_POSITIVE);
            self.heap
                .extend(packed(center, low, step, (share * STEPS).round() as u32));
        }
        self.heap.extend(
            lists
                .chunks_exact(4)
                .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        );
        let balls = tube.iter().map(|&(center, r)| (center, r + sway));
        let (center, reach) = ball(balls);
        self.push(
            Run {
                center: center.to_array(),
                reach,
                low: low.to_array(),
                step,
                counts: words_of(counts),
                errors: words_of(errors),
                first,
                flags: Run::marks(flags, mean, radius),
                radius,
                length,
                carried: length * mean.sqrt(),
                start: packed_direction(directions[0]),
                end: packed_direction(directions[directions.len() - 1]),
                ..Run::default()
            },
            points.iter().map(|p| p.tracing).collect(),
        );
    }

    /// Adds a run with the tracing points that color it.
    pub(super) fn push(&mut self, run: Run, colors: Vec<u32>) {
        self.runs.push(run);
        self.colors.push(colors);
    }
}

/// Which run hangs on which.
struct Carriers {
    /// By tracing point: the run that leads to it.
    run_of: Vec<usize>,
    /// By run: the one that it hangs on.
    carriers: Vec<usize>,
}

impl Carriers {
    /// Somata carry nothing, and nothing them.
    fn new(mesh: &CoarseMesh, somata: usize) -> Self {
        Self {
            run_of: vec![usize::MAX; mesh.tracing.len()],
            carriers: vec![usize::MAX; somata],
        }
    }

    /// Adds the run of some segments of a path. Paths come after those that they start from.
    fn add(&mut self, path: &TubePath, segments: Range<usize>, run: usize) {
        let start = match segments.start {
            0 => path.fork,
            first => Some(path.points[first].tracing),
        };
        let carrier = start.map_or(usize::MAX, |point| self.run_of[point as usize]);
        self.carriers.push(carrier);
        for point in &path.points[segments.start + 1..=segments.end] {
            self.run_of[point.tracing as usize] = run;
        }
    }

    /// Gives every run the greatest worth of what hangs on it.
    fn carry(&self, runs: &mut [Run]) {
        for run in (0..runs.len()).rev() {
            let carried = runs[run].carried;
            if let Some(carrier) = runs.get_mut(self.carriers[run]) {
                carrier.carried = carrier.carried.max(carried);
            }
        }
    }
}

/// A run whose heap and words begin elsewhere.
pub(super) fn moved(run: &Run, (heap, words): (usize, usize)) -> Run {
    let mut run = *run;
    run.first += heap as u32;
    if run.flags & RUN_ONE_WORD == 0 {
        run.words += words as u32;
    }
    run
}

/// Unit direction of a path at each of its points: between those of the segments before and after.
fn directions(points: &[PathPoint]) -> Vec<Vec3> {
    let way = |i: usize| (points[i + 1].center - points[i].center).normalize_or_zero();
    let last = points.len() - 1;
    (0..=last)
        .map(|i| {
            let before = if i == 0 { Vec3::ZERO } else { way(i - 1) };
            let after = if i == last { Vec3::ZERO } else { way(i) };
            (before + after).normalize_or(before.normalize_or(Vec3::X))
        })
        .collect()
}

/// How far (µm) the curved path is from the straight one at most.
fn sway(tube: &[(Vec3, f32)], directions: &[Vec3]) -> f32 {
    let of = |i: usize| {
        let way = tube[i + 1].0 - tube[i].0;
        let along = way.normalize_or_zero();
        let across = |d: Vec3| (d - along * d.dot(along)).length() * way.length() * (4.0 / 27.0);
        let most = MOST_SWAY * tube[i].1.min(tube[i + 1].1);
        across(directions[i]).min(most) + across(directions[i + 1]).min(most)
    };
    (0..tube.len() - 1).map(of).fold(0.0, f32::max)
}

/// Rounded up, so that no error is understated.
fn error_byte(error: f32) -> u8 {
    if error <= 0.0 {
        return 0;
    }
    let step = ((error.log2() + ERROR_OFFSET) * ERROR_STEPS).ceil();
    step.clamp(1.0, f32::from(NO_FORM - 1)) as u8
}

fn words_of(bytes: [u8; 8]) -> [u32; 2] {
    let [a, b, c, d, e, f, g, h] = bytes;
    [[a, b, c, d], [e, f, g, h]].map(u32::from_le_bytes)
}

/// What positions are counted from, and in steps of.
pub(super) fn grid(positions: impl Iterator<Item = Vec3> + Clone) -> (Vec3, f32) {
    let low = positions.clone().fold(Vec3::MAX, Vec3::min);
    let high = positions.fold(Vec3::MIN, Vec3::max);
    let extent = (high - low).max_element();
    (low, (extent / STEPS).max(1e-9))
}

/// A position in steps, and 16 bits more.
pub(super) fn packed(position: Vec3, low: Vec3, step: f32, more: u32) -> [u32; 2] {
    let [x, y, z] = ((position - low) / step)
        .round()
        .clamp(Vec3::ZERO, Vec3::splat(STEPS))
        .to_array()
        .map(|v| v as u32);
    [x | (y << 16), z | (more << 16)]
}

/// A unit vector in two times 16 bits.
pub(super) fn packed_direction(v: Vec3) -> u32 {
    let p = octahedral(v);
    let whole = |x: f32| u32::from((x * 32_767.0).round() as i16 as u16);
    whole(p.x) | (whole(p.y) << 16)
}

/// Place of a unit vector on an unfolded octahedron (Meyer et al., On floating-point normal vectors,
/// 2010), −1 to 1.
pub(super) fn octahedral(v: Vec3) -> Vec2 {
    let size = v.abs().element_sum();
    if size <= 0.0 {
        return Vec2::ZERO;
    }
    let p = v.truncate() / size;
    if v.z >= 0.0 {
        return p;
    }
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    Vec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y))
}

/// A ball that holds balls: around the middle of their box.
pub(super) fn ball(balls: impl Iterator<Item = (Vec3, f32)> + Clone) -> (Vec3, f32) {
    let low = balls.clone().map(|(c, r)| c - r).fold(Vec3::MAX, Vec3::min);
    let high = balls.clone().map(|(c, r)| c + r).fold(Vec3::MIN, Vec3::max);
    let center = (low + high) / 2.0;
    let reach = balls
        .map(|(c, r)| c.distance(center) + r)
        .fold(0.0, f32::max);
    // Positions are stored rounded.
    (center, reach * 1.0001)
}

fn ball_around(runs: &[Run]) -> (Vec3, f32) {
    if runs.is_empty() {
        return (Vec3::ZERO, 0.0);
    }
    ball(
        runs.iter()
            .map(|run| (Vec3::from_array(run.center), run.reach)),
    )
}
