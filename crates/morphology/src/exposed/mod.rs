//! What shows of the cones of sections: the area that a surface around the tracing is to have.
//!
//! Each link is a frustum with the radii of its own ends; one whose ends are in one place is none. A **path** is a
//! section with the child that continues it, and so on; the other children are side branches, which begin at the fork
//! with the radius of their own first point. Of each frustum goes what is within a round cone (the frustum with the
//! spheres at its ends) of another path, or within a soma. Links of one path take nothing off one another: where a tube
//! bends, as much comes to its outer side as goes on its inner one.
//!
//! Each frustum is [`LINES`] straight lines from end to end, cut exactly: a round cone is convex, so a line is within it
//! between two places. The boxes of all round cones in a tree find those that are near, in O(n log n).

use std::f64::consts::TAU;

use glam::DVec3;

use crate::{Attachment, Morphology, Point, SomaShape, shape};
use boxes::Boxes;
use round_cone::RoundCone;

mod boxes;
mod round_cone;

/// Lines of a frustum. With 512, 3,922 sections of 17 real cells have areas that differ by 2·10⁻⁶ in the median and by 0.2 %
/// at the 95th percentile.
const LINES: u32 = 64;
/// Places of a line that are looked for in somata, which are not convex.
const PLACES: u32 = 64;
/// How much the bend counts against the radius, in which child continues a section.
const STRAIGHT: f64 = 0.5;

/// Area (µm²) that shows of each section's cones, without caps.
///
/// ```
/// # use glam::Vec3;
/// # use neurotess_morphology::{Attachment, exposed_areas, Morphology, NeuriteKind, Point, Section};
/// let mut cable = Morphology::default();
/// cable.points = [0.0, 20.0].map(|x| Point { position: Vec3::X * x, radius: 0.5 }).to_vec();
/// cable.sections = vec![Section { kind: NeuriteKind::AXON, attachment: Attachment::Free, first: 0, end: 2 }];
/// assert!((exposed_areas(&cable)[0] - std::f64::consts::PI * 20.0).abs() < 1e-9);
/// ```
pub fn exposed_areas(morphology: &Morphology) -> Vec<f64> {
    let links = links(morphology);
    let boxes = Boxes::new(links.iter().map(|link| link.cone.bounds()));
    let somata: Vec<SomaShape> = morphology.somata.iter().map(SomaShape::of).collect();
    let (mut near, mut areas) = (Vec::new(), vec![0.0; morphology.sections.len()]);
    for link in &links {
        let bounds = link.cone.bounds();
        boxes.overlapping(bounds, &mut near);
        let others = near.iter().map(|&other| &links[other as usize]);
        let others: Vec<&RoundCone> = (others.filter(|other| other.path != link.path))
            .map(|other| &other.cone)
            .collect();
        let somata: Vec<&SomaShape> = (somata.iter())
            .filter(|soma| {
                let nearest = soma.center().clamp(bounds[0], bounds[1]);
                nearest.distance(soma.center()) < soma.farthest()
            })
            .collect();
        areas[link.section] += shown(&link.cone, &others, &somata);
    }
    areas
}

/// A link of a section.
struct Link {
    cone: RoundCone,
    section: usize,
    path: usize,
}

fn links(morphology: &Morphology) -> Vec<Link> {
    let continued = continued(morphology);
    let mut paths: Vec<usize> = Vec::with_capacity(morphology.sections.len());
    let mut all = Vec::new();
    for (section, id) in shape::ids(morphology).enumerate() {
        let parent = morphology.sections[section].parent();
        let parent = parent.filter(|parent| continued[parent.index()] == Some(section));
        let path = parent.map_or(section, |parent| paths[parent.index()]);
        paths.push(path);
        let branches = matches!(
            morphology.sections[section].attachment,
            Attachment::Section(_)
        );
        for (k, (from, to)) in shape::links(morphology, id).enumerate() {
            let of_branch = k == 0 && branches && parent.is_none();
            let first = if of_branch { to } else { from };
            let cone = RoundCone {
                from: from.position.as_dvec3(),
                to: to.position.as_dvec3(),
                radii: [first, to].map(|point| f64::from(point.radius).max(0.0)),
            };
            if cone.from != cone.to {
                all.push(Link {
                    cone,
                    section,
                    path,
                });
            }
        }
    }
    all
}

/// The child that continues each section: the thick and straight one.
fn continued(morphology: &Morphology) -> Vec<Option<usize>> {
    let mut best: Vec<Option<(f64, usize)>> = vec![None; morphology.sections.len()];
    for (child, section) in morphology.sections.iter().enumerate() {
        let Some(parent) = section.parent() else {
            continue;
        };
        let own = &morphology.points[section.range()];
        let before = morphology.section_points(parent);
        let (Some(fork), Some(first)) = (before.last(), own.first()) else {
            continue;
        };
        let [back, on] = [away(before.iter().rev(), fork), away(own.iter(), fork)];
        let straight = -back.dot(on);
        let thick = f64::from(first.radius) / f64::from(fork.radius).max(1e-9);
        let worth = thick + STRAIGHT * straight;
        let best = &mut best[parent.index()];
        if best.is_none_or(|(most, _)| worth > most) {
            *best = Some((worth, child));
        }
    }
    best.into_iter().map(|best| Some(best?.1)).collect()
}

/// Unit direction to the first point that is elsewhere.
fn away<'p>(mut points: impl Iterator<Item = &'p Point>, from: &Point) -> DVec3 {
    let next = points.find(|point| point.position != from.position);
    let way = next.map_or(DVec3::ZERO, |next| {
        (next.position - from.position).as_dvec3()
    });
    way.normalize_or_zero()
}

/// What shows of a link's frustum beside others.
fn shown(cone: &RoundCone, others: &[&RoundCone], somata: &[&SomaShape]) -> f64 {
    let [a, b] = cone.radii;
    let way = cone.to - cone.from;
    let (u, v) = way.normalize_or(DVec3::X).any_orthonormal_pair();
    let slant = way.length().hypot(b - a);
    // Share of the area of a strip from its start on.
    let up_to = |t: f64| t * (a + 0.5 * t * (b - a));
    let mut hidden = Vec::new();
    let mut sum = 0.0;
    for k in 0..LINES {
        let angle = TAU * (f64::from(k) + 0.5) / f64::from(LINES);
        let out = u * libm::cos(angle) + v * libm::sin(angle);
        let start = cone.from + out * a;
        let along = cone.to + out * b - start;
        hidden.clear();
        hidden.extend(others.iter().filter_map(|other| other.inside(start, along)));
        for soma in somata {
            let step = 1.0 / f64::from(PLACES);
            hidden.extend((0..PLACES).map(f64::from).filter_map(|k| {
                let place = start + along * (k + 0.5) * step - soma.center();
                (place.length() < soma.distance(place.normalize_or_zero()))
                    .then_some([k * step, (k + 1.0) * step])
            }));
        }
        hidden.sort_by(|[a, _], [b, _]| a.total_cmp(b));
        let mut reached = 0.0;
        sum += up_to(1.0);
        for &[from, to] in &hidden {
            let [from, to] = [from, to].map(|t| t.clamp(reached, 1.0));
            sum -= up_to(to) - up_to(from);
            reached = to.max(reached);
        }
    }
    sum * slant * TAU / f64::from(LINES)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::Vec3;

    use super::*;
    use crate::{NeuriteKind, Section, SectionEnds, SectionId, SectionPart};

    /// Sections by their parents, with centers and radii.
    type Sections<'s> = &'s [(Option<u32>, &'s [(Vec3, f32)])];

    fn cell(sections: Sections<'_>) -> Morphology {
        let mut cell = Morphology::default();
        for (parent, points) in sections {
            let first = cell.points.len() as u32;
            let point = |&(position, radius): &(Vec3, f32)| Point { position, radius };
            cell.points.extend(points.iter().map(point));
            cell.sections.push(Section {
                kind: NeuriteKind::AXON,
                attachment: parent.map_or(Attachment::Free, |p| Attachment::Section(SectionId(p))),
                first,
                end: cell.points.len() as u32,
            });
        }
        cell.sample_ids = (0..cell.points.len() as i64).collect();
        cell
    }

    /// A trunk of radius 1 along x, which goes on, and a branch of radius 0.2 across it, 4 µm long.
    fn fork() -> Morphology {
        cell(&[
            (None, &[(Vec3::X * -5.0, 1.0), (Vec3::ZERO, 1.0)]),
            (Some(0), &[(Vec3::X * 5.0, 1.0)]),
            (Some(0), &[(Vec3::Y * 4.0, 0.2)]),
        ])
    }

    #[test]
    fn branches_and_trunks_take_off_one_another_what_they_share() {
        let [before, behind, branch] = exposed_areas(&fork())[..] else {
            panic!("three sections");
        };
        let trunk = 2.0 * PI * 5.0;
        let under = trunk - before;
        // The footprint is a disk on a curved surface; both halves of it are of one size.
        assert!((2.0 * under / (PI * 0.04) - 1.0).abs() < 0.05, "{under}");
        assert!((before - behind).abs() < 1e-9);
        // With the branch's own radius from the axis on, less what is within the trunk.
        let depths =
            (0..1000).map(|k| (1.0 - (0.2 * (TAU * f64::from(k) / 1e3).cos()).powi(2)).sqrt());
        let out = 4.0 - depths.sum::<f64>() / 1e3;
        let expected = TAU * 0.2 * out;
        assert!(
            (branch / expected - 1.0).abs() < 1e-3,
            "{branch} {expected}"
        );
    }

    #[test]
    fn bends_take_nothing_off_their_own_path() {
        let bent = [Vec3::ZERO, Vec3::X * 3.0, Vec3::new(3.0, 3.0, 0.0)].map(|at| (at, 0.5));
        let areas = exposed_areas(&cell(&[(None, &bent[..2]), (Some(0), &bent[2..])]));
        for area in areas {
            assert!((area - PI * 3.0).abs() < 1e-9, "{area}");
        }
    }

    #[test]
    fn two_radii_at_one_place_are_no_ring() {
        let points = [(Vec3::X * 3.0, 0.5), (Vec3::X * 6.0, 0.5)];
        let stepped = cell(&[
            (None, &[(Vec3::ZERO, 1.0), (Vec3::X * 3.0, 1.0)]),
            (Some(0), &points),
        ]);
        assert!((exposed_areas(&stepped)[1] - PI * 3.0).abs() < 1e-9);
        assert!(shape::section_areas(&stepped)[1] > PI * 3.7);
    }

    #[test]
    fn what_is_within_a_soma_does_not_show() {
        let mut stem = cell(&[(None, &[(Vec3::X * 2.0, 0.5), (Vec3::X * 8.0, 0.5)])]);
        let sample = crate::SomaSample {
            id: 1,
            position: Vec3::ZERO,
            radius: 5.0,
            parent: None,
        };
        stem.somata = vec![crate::Soma::from_samples(vec![sample])];
        stem.sections[0].attachment = Attachment::Soma { soma: 0, sample: 0 };
        let out = 8.0 - (25.0_f64 - 0.25).sqrt();
        let area = exposed_areas(&stem)[0];
        assert!((area / (PI * out) - 1.0).abs() < 0.02, "{area}");
    }

    #[test]
    fn caps_are_beyond_ends_without_branches() {
        let ends = SectionEnds::new(&fork());
        let part = |section, place: Vec3| ends.part(section, 0, place.as_dvec3());
        assert_eq!(part(0, Vec3::new(-5.5, 0.0, 0.5)), SectionPart::Cap);
        assert_eq!(part(0, Vec3::new(0.5, 1.0, 0.0)), SectionPart::Side);
        assert_eq!(part(2, Vec3::new(0.0, 4.1, 0.1)), SectionPart::Cap);
        assert_eq!(part(2, Vec3::new(0.0, 3.9, 0.2)), SectionPart::Side);
        assert_eq!(part(2, Vec3::new(0.0, 9.0, 0.0)), SectionPart::Side);
    }
}
