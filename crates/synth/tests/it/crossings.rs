//! Branches keep clear of one another and of the soma, unless they may cross.

use glam::DVec3;
use neurotess_morphology::{Attachment, Measures, Morphology, shape};
use neurotess_synth::{Kind, Options, grow};

fn options(kind: Kind, seed: u64, points: Option<usize>) -> Options {
    Options {
        points,
        ..Options::new(kind, seed)
    }
}

fn crossing(options: &Options) -> Morphology {
    grow(&Options {
        may_cross: true,
        ..*options
    })
}

/// A link between two points, as thick as the thicker one.
struct Link {
    ends: [DVec3; 2],
    radius: f64,
    /// The point it leads to, and the one before; none at a soma.
    to: usize,
    from: Option<usize>,
}

/// The links of a cell's neurites, and the way from the soma to each point.
struct Links {
    links: Vec<Link>,
    parents: Vec<Option<usize>>,
    ways: Vec<f64>,
}

impl Links {
    fn of(cell: &Morphology) -> Self {
        let place = |point: usize| cell.points[point].position.as_dvec3();
        let radius = |point: usize| f64::from(cell.points[point].radius);
        let count = cell.points.len();
        let mut all = Self {
            links: Vec::with_capacity(count),
            parents: vec![None; count],
            ways: vec![0.0; count],
        };
        for section in &cell.sections {
            let mut before = match section.attachment {
                Attachment::Section(parent) => Some(cell.sections[parent.index()].end as usize - 1),
                _ => None,
            };
            for to in section.range() {
                let from = before.map_or(place(to), place);
                // A branch begins as thick as it is itself.
                let begins = before.filter(|&before| section.range().contains(&before));
                all.parents[to] = before;
                all.ways[to] =
                    before.map_or(0.0, |before| all.ways[before]) + from.distance(place(to));
                all.links.push(Link {
                    ends: [from, place(to)],
                    radius: radius(to).max(begins.map_or(0.0, radius)),
                    to,
                    from: before,
                });
                before = Some(to);
            }
        }
        all
    }

    /// The way along the tree between two links; infinite by way of the soma.
    fn between(&self, a: &Link, b: &Link) -> f64 {
        let (mut x, mut y) = (a.to, b.to);
        while x != y {
            let up = if x > y { &mut x } else { &mut y };
            let Some(parent) = self.parents[*up] else {
                return f64::INFINITY;
            };
            *up = parent;
        }
        let start = |link: &Link| {
            let at = if link.to == x { Some(x) } else { link.from };
            at.map_or(0.0, |at| self.ways[at] - self.ways[x])
        };
        start(a) + start(b)
    }

    /// Pairs of links that are nearer to each other than they are thick, those right behind forks and in bends
    /// aside: there the way along the tree is short.
    fn crossings(&self) -> usize {
        let low = |link: &Link| link.ends[0].x.min(link.ends[1].x) - link.radius;
        let high = |link: &Link| link.ends[0].x.max(link.ends[1].x) + link.radius;
        let mut order: Vec<&Link> = self.links.iter().collect();
        order.sort_by(|a, b| low(a).total_cmp(&low(b)));
        let mut found = 0;
        for (i, a) in order.iter().enumerate() {
            let beside = order[i + 1..].iter().take_while(|b| low(b) < high(a));
            let meet = beside.filter(|b| {
                let radii = a.radius + b.radius;
                distance(a.ends, b.ends) < radii && self.between(a, b) > 2.1 * radii + 0.2
            });
            found += meet.count();
        }
        found
    }

    /// Links that run into the soma.
    fn in_soma(&self, cell: &Morphology) -> usize {
        let soma = cell.soma().expect("a soma");
        let center = soma.center.as_dvec3();
        // Stems start on it, and may be thicker one point on.
        let is_in = |link: &&Link| {
            distance(link.ends, [center; 2]) < f64::from(soma.radius) + 0.9 * link.radius
        };
        self.links.iter().filter(is_in).count()
    }
}

/// Distance of two segments: the least along one of the distance to the other, which has one minimum.
fn distance(a: [DVec3; 2], b: [DVec3; 2]) -> f64 {
    let at = |part: f64| a[0].lerp(a[1], part);
    let to_other = |place: DVec3| {
        let along = b[1] - b[0];
        let part = (place - b[0]).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        place.distance(b[0] + along * part.clamp(0.0, 1.0))
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let (left, right) = ((2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0);
        if to_other(at(left)) < to_other(at(right)) {
            high = right;
        } else {
            low = left;
        }
    }
    to_other(at(low))
}

#[neurotess_testing::test]
fn no_branch_grows_through_another_or_through_the_soma() {
    for kind in Kind::ALL {
        for (seed, points) in [(1, 50), (2, 300), (3, 1000), (4, 2000), (5, 5000)] {
            let cell = grow(&options(kind, seed, Some(points)));
            let links = Links::of(&cell);
            let found = (links.crossings(), links.in_soma(&cell));
            assert_eq!(found, (0, 0), "{kind} {seed} {points}");
        }
    }
}

#[neurotess_testing::test]
fn branches_that_may_cross_do() {
    let purkinje = crossing(&options(Kind::Purkinje, 1, Some(3000)));
    assert!(Links::of(&purkinje).crossings() > 300);
    let count = |kind| Links::of(&crossing(&options(kind, 1, None))).crossings();
    let crossing = Kind::ALL.into_iter().filter(|&kind| count(kind) > 0);
    assert!(crossing.count() > 3);
}

#[neurotess_testing::test]
fn cells_without_crossings_are_like_those_with() {
    for kind in Kind::ALL {
        let (mut lengths, mut forks, mut tips, mut reaches) = ([0.0; 2], [0; 2], [0; 2], [0.0; 2]);
        for seed in 1..6 {
            let options = options(kind, seed, Some(3000));
            for (i, cell) in [grow(&options), crossing(&options)].iter().enumerate() {
                let measures = Measures::of(cell);
                lengths[i] += measures.length;
                forks[i] += measures.n_bifurcations;
                tips[i] += measures.n_ends;
                let ends = shape::end_distances(cell, DVec3::ZERO);
                reaches[i] += ends.iter().sum::<f64>() / ends.len() as f64;
            }
        }
        let ratio = |[a, b]: [f64; 2]| a / b;
        let of = |[a, b]: [usize; 2]| a as f64 / b as f64;
        let ratios = [ratio(lengths), of(forks), of(tips)];
        let are_alike = ratios.iter().all(|ratio| (0.9..1.1).contains(ratio));
        assert!(are_alike, "{kind}: length, forks, tips {ratios:?}");
        // The fan of a Purkinje cell needs more room where it is not grown into itself.
        let reach = ratio(reaches);
        assert!((0.8..1.35).contains(&reach), "{kind}: reach {reach}");
    }
}
