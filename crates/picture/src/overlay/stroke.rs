//! Lines over a picture.

use crate::color::Rgb;
use crate::image::Image;

/// Draws a line over a band of a picture, whose first row is `top`. Where its segments meet it is as opaque as elsewhere.
pub(crate) fn stroke(
    band: &mut Image,
    top: u32,
    points: &[[f64; 2]],
    width: f32,
    color: Rgb,
    opacity: f32,
) {
    let reach = f64::from(width) / 2.0 + 1.0;
    let size = [band.width, band.height].map(f64::from);
    let points = points.iter().map(|[x, y]| [*x, y - f64::from(top)]);
    let points: Vec<[f64; 2]> = points.collect();
    let Some(whole) = points
        .iter()
        .try_fold([f64::MAX, f64::MAX, f64::MIN, f64::MIN], |b, p| {
            let known = p.iter().all(|n| n.is_finite());
            known.then(|| {
                [
                    b[0].min(p[0]),
                    b[1].min(p[1]),
                    b[2].max(p[0]),
                    b[3].max(p[1]),
                ]
            })
        })
    else {
        return;
    };
    let [left, upper, right, lower] = inside(whole, reach, size);
    if left >= right || upper >= lower {
        return;
    }
    let row = right - left;
    let mut covered = vec![0.0_f32; row * (lower - upper)];
    for ends in points.windows(2) {
        let [a, b] = [ends[0], ends[1]];
        let bounds = [
            a[0].min(b[0]),
            a[1].min(b[1]),
            a[0].max(b[0]),
            a[1].max(b[1]),
        ];
        let [x0, y0, x1, y1] = inside(bounds, reach, size);
        for y in y0..y1 {
            for x in x0..x1 {
                let away = distance([x as f64 + 0.5, y as f64 + 0.5], a, b) as f32;
                let share = (width / 2.0 + 0.5 - away).clamp(0.0, 1.0);
                let there = &mut covered[(y - upper) * row + x - left];
                *there = there.max(share);
            }
        }
    }
    for (i, share) in covered.into_iter().enumerate() {
        let (x, y) = (left + i % row, upper + i / row);
        band.blend(x as i64, y as i64, color, share * opacity);
    }
}

/// The pixels of an image of this size that are within `reach` of a box: left, top, right, bottom.
fn inside([left, top, right, bottom]: [f64; 4], reach: f64, size: [f64; 2]) -> [usize; 4] {
    [
        (left - reach).clamp(0.0, size[0]) as usize,
        (top - reach).clamp(0.0, size[1]) as usize,
        (right + reach).clamp(0.0, size[0]).ceil() as usize,
        (bottom + reach).clamp(0.0, size[1]).ceil() as usize,
    ]
}

/// Distance of a point from a segment.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let share = match square > 0.0 {
        true => ((from[0] * along[0] + from[1] * along[1]) / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    (from[0] - share * along[0]).hypot(from[1] - share * along[1])
}
