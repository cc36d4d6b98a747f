//! Where a first ring goes: on the ray to the first point, at it, or on the path beyond it.

use glam::DVec3;

use crate::tracing::{Children, Skeleton, SomaSphere};

/// Least way from position 1 to 2, in radii of the soma: many tracings begin on its sphere, where
/// twice nothing is nothing.
const MIN_BEYOND: f64 = 0.5;
/// Least way between a ring and a fork or an end beyond it, in radii of the thicker one.
pub(super) const MIN_WAY: f64 = 1.5;
/// Where a ring is before a first point that is a fork, as a share of the way to it. Half-way, 8 pairs cross in 75 forks near
/// somata of the tests.
const BEFORE_FORK: f64 = 0.4;
/// A neurite whose radius is below this share of its soma's leaves it through an inset: pulled to a
/// ring this small, a quad of the soma creases like a star. Thicker ones pull the soma out towards them,
/// as in García-Cantero et al. 2017; at 0.2 most real somata would stay plain spheres.
pub(super) const THIN: f64 = 0.1;
/// Least height of an inset's corners over the soma, in radii of the neurite.
const SOMA_LIFT: f64 = 0.4;
/// Height of a hillock over the traced surface, in radii of the neurite: of thin and of thick ones, by their share of the
/// soma's radius. Lower ones end in a hard line, higher ones are stalks; by eye, and by the angles at necks of
/// `cargo xtask quality`.
const HILLOCK: [f64; 2] = [2.0, 1.0];
const THICK: f64 = 0.3;
/// Greatest height of a hillock in radii of the soma: neurites may be thicker than their soma.
pub(super) const HIGHEST: f64 = 0.35;
/// A path that turns back towards the soma ends a ring's way: least cosine to the ray.
const MIN_OUTWARDS: f64 = 0.5;

/// Share of its height over which an inset's lofts run along the branch.
const COLLAR: f64 = 0.7;

/// Length (µm) over which lofts run along a branch whose ring stands so high over the surface that it leaves.
pub(crate) fn collar(height: f64, radius: f64) -> f64 {
    COLLAR * height.max(0.2 * radius)
}

/// Longest way along a path that is looked for the end of a hillock, in radii of the soma.
pub(super) const MAX_WAY: f64 = 2.0;

/// Height (µm) of the hillock of a neurite.
pub(super) fn hillock(radius: f64, soma: &SomaSphere) -> f64 {
    let thickness = ((radius / soma.radius - THIN) / (THICK - THIN)).clamp(0.0, 1.0);
    let height = radius * (HILLOCK[0] + thickness * (HILLOCK[1] - HILLOCK[0]));
    height.min(HIGHEST * soma.radius) * soma.hillocks()
}

/// Distance of an inset's ring from the soma's center, whose corners stand over a surface at such a distance.
pub(crate) fn over_surface(surface: f64, radius: f64) -> f64 {
    let corners = surface + SOMA_LIFT * radius;
    (corners * corners - radius * radius).max(0.0).sqrt()
}

/// Where a ring goes on its neurite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    pub(super) soma: u32,
    /// The first node that stays: the ring itself, or what follows it.
    pub(super) next: u32,
    /// Center and radius of a node to be added for the ring; none: `next` is the ring.
    pub(super) added: Option<(DVec3, f64)>,
    pub(super) position: f64,
    pub(super) requested: Option<f64>,
    pub(super) farther: bool,
    /// Whether the ring stands over the soma's surface as an inset.
    pub(super) inset: bool,
}

/// A neurite as it leaves its soma.
pub(super) struct Stem<'a> {
    skeleton: &'a Skeleton,
    children: &'a Children,
    root: u32,
    soma_sphere: &'a SomaSphere,
    /// From the soma's center to the first point.
    direction: DVec3,
    distance: f64,
    /// Distance of the soma's surface in that direction.
    pub(super) surface: f64,
    /// Least distance of the ring from that surface, if the path gets there.
    hillock: f64,
    branches: usize,
}

impl<'a> Stem<'a> {
    pub(super) fn new(
        skeleton: &'a Skeleton,
        children: &'a Children,
        root: u32,
        soma_sphere: &'a SomaSphere,
        hillock: f64,
    ) -> Self {
        let offset = skeleton.node(root).center - soma_sphere.center;
        let direction = offset.try_normalize().unwrap_or(DVec3::Y);
        Self {
            skeleton,
            children,
            root,
            soma_sphere,
            direction,
            distance: offset.length(),
            surface: soma_sphere.surface(direction),
            hillock,
            branches: children.of(root).len(),
        }
    }

    /// Way (µm) from position 0 to 1.
    fn gap(&self) -> f64 {
        (self.distance - self.surface).max(1e-6 * self.surface)
    }

    fn usual(&self) -> Site {
        let reach = self.soma_sphere.reach * self.surface;
        match self.branches {
            1 if self.distance < self.surface + self.hillock => self.beyond(self.hillock),
            1 if self.distance <= reach => self.at_node(self.root, 1.0),
            0 if self.distance <= reach => self.on_ray(self.distance),
            0 | 1 => self.on_ray(reach),
            _ => self.on_ray(reach.min(self.surface + BEFORE_FORK * self.gap())),
        }
    }

    /// `farthest`: distance (µm) from the soma's center beyond which requests are limited.
    pub(super) fn site(&self, requested: Option<f64>, farthest: f64) -> Site {
        let usual = self.usual();
        let Some(requested) = requested else {
            return usual;
        };
        let farther = requested > usual.position + 1e-6;
        let at = self.surface + requested.min(1.0) * self.gap();
        let site = if farther && farthest <= self.surface + usual.position * self.gap() {
            usual
        } else if farther && farthest < at {
            self.on_ray(self.before_fork(farthest))
        } else if requested >= 1.0 && self.branches == 1 {
            self.on_path(requested, farthest)
        } else {
            self.on_ray(self.before_fork(at))
        };
        Site {
            requested: Some(requested),
            farther,
            ..site
        }
    }

    fn at_node(&self, next: u32, position: f64) -> Site {
        Site {
            soma: 0,
            next,
            added: None,
            position,
            requested: None,
            farther: false,
            inset: false,
        }
    }

    /// An inset over the surface, as high as a hillock if there is room, if the neurite is thin and leads away from it.
    pub(super) fn over_soma(&self) -> Option<Site> {
        let radius = self.skeleton.node(self.root).radius;
        if radius >= THIN * self.soma_sphere.radius {
            return None;
        }
        let [least, most] = [
            over_surface(self.surface, radius),
            self.surface + self.hillock,
        ];
        let most = most.max(least);
        let over = |site: Site| Site {
            inset: true,
            ..site
        };
        let on_ray = || over(self.on_ray(most.min(self.distance - radius)));
        if self.distance >= most + radius {
            return Some(on_ray());
        }
        // The first points are too near: along the path to where it is free.
        let on_path = (self.branches == 1).then(|| self.beyond(most + 0.5 * radius - self.surface));
        let height = |site: &Site| {
            let added = site.added.map(|(center, _)| center);
            let center = added.unwrap_or(self.skeleton.node(site.next).center);
            center.distance(self.soma_sphere.center) - self.soma_sphere.towards(center)
        };
        let on_path = on_path.filter(|site| height(site) >= least - self.surface);
        let fallback = (self.distance >= least + radius).then(on_ray);
        match (on_path, fallback) {
            (Some(path), Some(ray)) if height(&path) < height(&ray) => Some(ray),
            (Some(path), _) => Some(over(path)),
            (None, ray) => ray,
        }
    }

    /// On the path where it is so far (µm) beyond the soma's surface, or as far as a ring may go.
    fn beyond(&self, height: f64) -> Site {
        let unit = self.gap().max(MIN_BEYOND * self.surface);
        let way = self.way_beyond(height);
        let farthest = self.soma_sphere.farthest() + height;
        self.on_path(1.0 + way / unit, farthest)
    }

    /// Way (µm) along the path from the first point to where it is so far beyond the surface.
    fn way_beyond(&self, height: f64) -> f64 {
        let beyond = |place: DVec3| {
            place.distance(self.soma_sphere.center) - self.soma_sphere.towards(place) - height
        };
        let (mut here, mut way) = (self.root, 0.0);
        let mut from = beyond(self.skeleton.node(here).center);
        while from < 0.0
            && let [next] = *self.children.of(here)
        {
            let [a, b] = [here, next].map(|node| self.skeleton.node(node).center);
            let to = beyond(b);
            if to >= 0.0 {
                return way + a.distance(b) * from / (from - to);
            }
            (here, from) = (next, to);
            way += a.distance(b);
            if way > MAX_WAY * self.soma_sphere.radius {
                break;
            }
        }
        way
    }

    fn on_ray(&self, at: f64) -> Site {
        let center = self.soma_sphere.center + self.direction * at;
        Site {
            added: Some((center, self.skeleton.node(self.root).radius)),
            ..self.at_node(self.root, (at - self.surface) / self.gap())
        }
    }

    /// A ring cannot be on a fork.
    fn before_fork(&self, at: f64) -> f64 {
        let free = self.distance - MIN_WAY * self.skeleton.node(self.root).radius;
        match self.branches {
            0 | 1 => at,
            _ => at.min(free.max(self.surface + BEFORE_FORK * self.gap())),
        }
    }

    /// Beyond the first point, but not up to the next fork or end, nor where the path turns back.
    fn on_path(&self, position: f64, farthest: f64) -> Site {
        let unit = self.gap().max(MIN_BEYOND * self.surface);
        let most = (position - 1.0) * unit;
        let mut left = most.min(self.free_way(most, farthest));
        let reached = 1.0 + left / unit;
        let mut here = self.root;
        while let [next] = *self.children.of(here) {
            let (a, b) = (self.skeleton.node(here), self.skeleton.node(next));
            let length = a.center.distance(b.center);
            if left < 1e-3 * length {
                break;
            }
            if left < 0.999 * length {
                let t = left / length;
                let radius = a.radius + t * (b.radius - a.radius);
                return Site {
                    added: Some((a.center.lerp(b.center, t), radius)),
                    ..self.at_node(next, reached)
                };
            }
            left -= length;
            here = next;
        }
        self.at_node(here, reached)
    }

    /// Way (µm) from the first point that a ring may go, up to `most`.
    fn free_way(&self, most: f64, farthest: f64) -> f64 {
        let (mut here, mut way, mut thickest) = (self.root, 0.0, 0.0_f64);
        loop {
            let node = self.skeleton.node(here);
            thickest = thickest.max(node.radius);
            let [next] = *self.children.of(here) else {
                return (way - MIN_WAY * thickest).max(0.5 * way);
            };
            if way > most + MIN_WAY * thickest {
                return way;
            }
            let from = node.center - self.soma_sphere.center;
            let step = self.skeleton.node(next).center - node.center;
            let outwards = step.normalize_or_zero().dot(from.normalize_or_zero());
            if outwards < MIN_OUTWARDS {
                return way;
            }
            if (from + step).length() > farthest {
                return way + until(from, step, farthest);
            }
            way += step.length();
            here = next;
        }
    }
}

/// Way along `step` from `from` until the distance from the origin is `far`, which it passes.
fn until(from: DVec3, step: DVec3, far: f64) -> f64 {
    let along = from.dot(step.normalize_or_zero());
    let lack = far * far - from.length_squared();
    // The positive root of x² + 2 x along − lack.
    (lack + along * along).max(0.0).sqrt() - along
}
