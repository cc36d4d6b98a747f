//! Lines of as many points as a picture can show.

use std::ops::Range;

/// A line that looks the same with at most four points in each of so many columns of a range: the first, the least, the
/// greatest and the last of each. Points beyond the range are left out, but the nearest on both sides. `points`: x
/// ascending; where y is no number there is a gap, which stays.
pub fn thinned(points: &[[f64; 2]], [low, high]: [f64; 2], columns: usize) -> Vec<[f64; 2]> {
    let first = points.partition_point(|p| p[0] < low).saturating_sub(1);
    let end = (points.partition_point(|p| p[0] <= high) + 1).min(points.len());
    let shown = &points[first.min(end)..end];
    if shown.len() <= 4 * columns.max(1) || high <= low {
        return shown.to_vec();
    }
    let width = (high - low) / columns as f64;
    let column = |point: &[f64; 2]| ((point[0] - low) / width).floor();
    let mut thin = Vec::new();
    let mut from = 0;
    while from < shown.len() {
        let of = column(&shown[from]);
        let own = from + shown[from..].partition_point(|point| column(point) <= of);
        push(&mut thin, shown, from..own.max(from + 1));
        from = own.max(from + 1);
    }
    thin
}

/// Adds what is kept of a column, in the order of the line.
fn push(thin: &mut Vec<[f64; 2]>, shown: &[[f64; 2]], own: Range<usize>) {
    let numbers = || own.clone().filter(|&i| !shown[i][1].is_nan());
    let by = |a: &usize, b: &usize| shown[*a][1].total_cmp(&shown[*b][1]);
    let gap = own.clone().find(|&i| shown[i][1].is_nan());
    let kept = [
        Some(own.start),
        numbers().min_by(by),
        numbers().max_by(by),
        gap,
        Some(own.end - 1),
    ];
    let mut kept: Vec<usize> = kept.into_iter().flatten().collect();
    kept.sort_unstable();
    kept.dedup();
    thin.extend(kept.into_iter().map(|i| shown[i]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spikes_and_gaps_stay_and_few_points_are_left() {
        let mut points: Vec<[f64; 2]> = (0..100_000).map(|i| [f64::from(i), 0.0]).collect();
        points[12_345][1] = 40.0;
        points[54_321][1] = -70.0;
        points[77_777][1] = f64::NAN;
        let thin = thinned(&points, [0.0, 99_999.0], 200);
        assert!(thin.len() <= 5 * 201, "{}", thin.len());
        assert!(thin.is_sorted_by(|a, b| a[0] < b[0]));
        for i in [0, 12_345, 54_321, 99_999] {
            assert!(thin.contains(&points[i]), "{i}");
        }
        assert!(thin.iter().any(|p| p[1].is_nan()));
        // Zoomed in all points are there, and their neighbors, so that the line goes on to the border.
        let near = thinned(&points, [12_340.0, 12_350.5], 200);
        assert_eq!((near.len(), near[0][0]), (13, 12_339.0));
        assert!(thinned(&points, [2e5, 3e5], 200).len() <= 1);
        assert!(thinned(&[], [0.0, 1.0], 10).is_empty());
    }
}
