//! Simplified polylines of one chunk, each a subset of the next finer one.
//!
//! **Theory.** Ramer 1972, Douglas & Peucker 1973, run from the coarse end: start with the two end
//! points and add, again and again, the point that lies farthest from the polyline so far. So every
//! coarser polyline is a subset of the finer ones, and its error is known. A point's distance
//! includes the difference in radius: it bounds the distance of the tube's surface.

use glam::Vec3;

use super::layout::{LEVELS, MAX_SEGMENTS};

/// A polyline that leaves out points.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Simplified {
    /// Indices of the points that are kept, ascending.
    pub(crate) kept: Vec<u8>,
    /// Greatest distance (µm) of the surface at a point that was left out from the simplified
    /// surface.
    pub(crate) error: f32,
}

/// Coarser polylines of a chunk of 2 to [`MAX_SEGMENTS`] + 1 points, with half, a fourth, … of its
/// segments; nothing where that is no fewer than the polyline before.
pub(crate) fn simplify(points: &[(Vec3, f32)]) -> [Option<Simplified>; LEVELS - 1] {
    let last = points.len() - 1;
    assert!((1..=MAX_SEGMENTS).contains(&last), "{last} segments");
    let segments: [usize; LEVELS - 1] = std::array::from_fn(|k| (last >> (k + 1)).max(1));
    let mut lods: [Option<Simplified>; LEVELS - 1] = Default::default();
    let mut kept = vec![0, last];
    let mut gaps = vec![worst(points, 0, last)];
    loop {
        let widest = (0..gaps.len()).max_by(|&a, &b| gaps[a].1.total_cmp(&gaps[b].1));
        let Some(gap) = widest else { return lods };
        for (k, lod) in lods.iter_mut().enumerate() {
            let before = if k == 0 { last } else { segments[k - 1] };
            if gaps.len() == segments[k] && segments[k] < before {
                *lod = Some(Simplified {
                    kept: kept.iter().map(|&i| i as u8).collect(),
                    error: gaps[gap].1.max(0.0),
                });
            }
        }
        if gaps.len() >= segments[0] {
            return lods;
        }
        let (back, _) = gaps[gap];
        let (from, to) = (kept[gap], kept[gap + 1]);
        kept.insert(gap + 1, back);
        gaps[gap] = worst(points, from, back);
        gaps.insert(gap + 1, worst(points, back, to));
    }
}

/// The point between two others that lies farthest from the tube between them, and its distance
/// (µm).
fn worst(points: &[(Vec3, f32)], from: usize, to: usize) -> (usize, f32) {
    let between = (from + 1..to).map(|i| (i, apart(points[i], points[from], points[to])));
    // The first of several equal ones; an end, at distance −1, only if there is no point between.
    between.fold(
        (from, -1.0),
        |best, one| {
            if one.1 > best.1 { one } else { best }
        },
    )
}

fn apart(point: (Vec3, f32), from: (Vec3, f32), to: (Vec3, f32)) -> f32 {
    let way = to.0 - from.0;
    let along = (point.0 - from.0).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
    let t = along.clamp(0.0, 1.0);
    let radius = from.1 + (to.1 - from.1) * t;
    point.0.distance(from.0 + way * t) + (point.1 - radius).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(count: usize) -> Vec<(Vec3, f32)> {
        let at = |i: usize| {
            let t = i as f32 * 0.37;
            (
                Vec3::new(t, t.sin(), (1.7 * t).cos() * 0.3),
                0.2 + 0.1 * t.cos(),
            )
        };
        (0..count).map(at).collect()
    }

    #[test]
    fn coarser_lods_are_parts_of_finer_ones_and_keep_their_error() {
        for count in [2, 3, 4, 5, 17, 64, 65] {
            let points = wave(count);
            let lods = simplify(&points);
            let mut finer: Vec<u8> = (0..count as u8).collect();
            for lod in lods.into_iter().flatten() {
                assert!(lod.kept.len() < finer.len());
                assert!(lod.kept.iter().all(|point| finer.contains(point)));
                assert_eq!(
                    (lod.kept[0], *lod.kept.last().unwrap()),
                    (0, count as u8 - 1)
                );
                let off = lod.kept.windows(2).flat_map(|gap| {
                    let [a, b] = [gap[0], gap[1]].map(usize::from);
                    (a..=b).map(move |i| (i, a, b))
                });
                let off = off.map(|(i, a, b)| apart(points[i], points[a], points[b]));
                let off = off.fold(0.0, f32::max);
                assert!((off - lod.error).abs() < 1e-6, "{off} {}", lod.error);
                finer = lod.kept;
            }
            assert_eq!(finer.len(), 2, "{count} points end as one segment");
        }
    }

    #[test]
    fn a_straight_chunk_costs_nothing_to_simplify() {
        let points: Vec<(Vec3, f32)> = (0..33).map(|i| (Vec3::X * i as f32, 1.0)).collect();
        let coarsest = simplify(&points)
            .into_iter()
            .flatten()
            .last()
            .expect("simplified");
        assert_eq!(coarsest.kept, [0, 32]);
        assert!(coarsest.error < 1e-5);
    }
}
