//! Area of each section's surface beside that of its traced frusta.

use neurotess::mesh::{FaceLabel, SurfaceMesh};
use neurotess::morphology::{Attachment, Morphology};

/// By how much the area of sections is off, as a share of their frusta: the median, and the 95th percentile. What a
/// neurite has before its first traced point is no part of its section.
pub(crate) fn area_off(surface: &SurfaceMesh, morphology: &Morphology) -> [f64; 2] {
    let traced = traced_areas(morphology);
    let mut meshed = vec![0.0; traced.len()];
    for corners in &surface.faces.triangles {
        let [a, b, c] = corners.map(|v| &surface.vertices[v as usize]);
        let section = FaceLabel::of([a, b, c]).section;
        if let Ok(section) = usize::try_from(section - 1) {
            let area = (b.position - a.position)
                .cross(c.position - a.position)
                .length();
            meshed[section] += 0.5 * f64::from(area);
        }
    }
    let sections = traced
        .iter()
        .zip(&meshed)
        .filter(|(traced, _)| **traced > 0.0);
    let mut off: Vec<f64> = sections
        .map(|(traced, meshed)| (meshed / traced - 1.0).abs())
        .collect();
    off.sort_by(f64::total_cmp);
    let quantile = |share: f64| {
        let place = share * off.len().saturating_sub(1) as f64;
        off.get(place.round() as usize).copied().unwrap_or(0.0)
    };
    [quantile(0.5), quantile(0.95)]
}

/// Area of each section's frusta (µm²), from where it leaves its parent section.
fn traced_areas(morphology: &Morphology) -> Vec<f64> {
    let point = |index: usize| morphology.points[index];
    let sections = morphology.sections.iter();
    let area = |section: &neurotess::morphology::Section| {
        let before = match section.attachment {
            Attachment::Section(parent) => {
                Some(morphology.sections[parent.index()].end as usize - 1)
            }
            Attachment::Soma { .. } | Attachment::Free => None,
        };
        let points: Vec<usize> = before.into_iter().chain(section.range()).collect();
        let frusta = points.windows(2).map(|ends| {
            let [a, b] = [point(ends[0]), point(ends[1])];
            let [length, widens] = [a.position.distance(b.position), a.radius - b.radius];
            std::f64::consts::PI * f64::from((a.radius + b.radius) * length.hypot(widens))
        });
        frusta.sum()
    };
    sections.map(area).collect()
}
