//! Sections: walks that are bent by tropism, wobble, and turn away from what is in their way.

use glam::DVec3;

use super::{Branch, Grower, OfFork};
use crate::room::{Capsule, Way, reach};
use crate::spec::Tropism;

/// Length (µm) over which the wobble forgets itself: between the 2 µm of jitter in tracings and
/// the 50 µm of bends. By eye.
const MEMORY: f64 = 9.0;
/// Inner points are thicker and thinner than their section by up to this factor.
const SWELL: (f64, f64) = (0.92, 1.08);
/// Steps that a branch looks ahead. Of 2, forks in Purkinje cells are as many and growth takes longer.
const AHEAD: f64 = 1.0;
/// Angles (radians) that a branch turns away by, the least first.
const TURNS: [f64; 4] = [0.3, 0.6, 0.9, 1.2];
/// Directions tried for each angle.
const SIDES: u32 = 6;
/// Widest angle (radians) between the first steps behind a fork, unless it is a T. Of the forks whose meshes crossed
/// themselves at level 4, in 240 cells, 45 of 46 were wider.
const WIDEST: f64 = 1.2;
/// Greatest angles (radians) between the last step before a fork and the first ones behind it, of the daughter with
/// more points and of the other. Of the 18 that still crossed themselves, 10 turned more.
const GREATER_TURN: f64 = 0.8;
const LESSER_TURN: f64 = 1.5;
/// How often a section that cannot go on backs off and tries again.
const BACK_OFFS: u32 = 8;

/// Where a walk is.
#[derive(Clone, Copy)]
pub(super) struct State {
    pub(super) at: DVec3,
    pub(super) heading: DVec3,
    /// Without what varies from point to point.
    pub(super) radius: f64,
    wobble: DVec3,
    /// How much of the radius is left.
    taper: f64,
}

/// A step that is not taken yet.
struct Step {
    from: DVec3,
    length: f64,
    radius: f64,
    /// Number of the capsule before.
    behind: Option<u32>,
    /// Distance from the origin that it leads to at least.
    clear_of: f64,
}

/// Directions near to one.
struct Cone {
    axis: DVec3,
    angle: f64,
}

impl Cone {
    fn new(axis: DVec3, angle: f64) -> Self {
        Self { axis, angle }
    }

    fn has(&self, direction: DVec3) -> bool {
        direction.dot(self.axis) >= libm::cos(self.angle)
    }

    /// The direction in it that is nearest to one.
    fn nearest(&self, direction: DVec3) -> DVec3 {
        if self.has(direction) {
            return direction;
        }
        let across = direction - self.axis * direction.dot(self.axis);
        let across = across.normalize_or(self.axis.any_orthonormal_vector());
        self.axis * libm::cos(self.angle) + across * libm::sin(self.angle)
    }
}

impl Step {
    fn toward(&self, direction: DVec3) -> Capsule {
        let to = self.from + direction * self.length;
        let is_clear = to.length() >= self.clear_of;
        Capsule {
            from: self.from,
            to: if is_clear {
                to
            } else {
                to.normalize_or(direction) * self.clear_of
            },
            radius: self.radius,
            parent: self.behind,
        }
    }
}

impl Grower<'_> {
    /// Appends up to `points` points of one section; gives where it ends. There are fewer points where no way is
    /// left.
    pub(super) fn walk(&mut self, branch: &Branch, points: usize, clear_of: f64) -> State {
        let first = State {
            at: branch.from,
            heading: branch.heading,
            radius: branch.radius,
            wobble: DVec3::ZERO,
            taper: 1.0,
        };
        let before = self.grown.nodes.len();
        let mut states = vec![first];
        let mut back_offs = 0;
        while states.len() <= points {
            let state = states[states.len() - 1];
            let placed = states.len() - 1;
            if let Some(next) = self.step(branch, &state, placed, points, clear_of) {
                states.push(next);
            } else if back_offs < BACK_OFFS {
                back_offs += 1;
                let keep = placed.saturating_sub(1 << back_offs.min(5));
                states.truncate(keep + 1);
                self.grown.keep(before + keep);
            } else {
                break;
            }
        }
        let last = states[states.len() - 1];
        if states.len() > 1 {
            self.grown.set_last_radius(last.radius);
        }
        last
    }

    /// Appends the point after `placed` ones; `None` if there is no way.
    fn step(
        &mut self,
        branch: &Branch,
        before: &State,
        placed: usize,
        points: usize,
        clear_of: f64,
    ) -> Option<State> {
        let is_first = placed == 0;
        let parent = if is_first {
            branch.parent
        } else {
            self.grown.last()
        };
        let widest = if is_first {
            before.radius.max(branch.inside)
        } else {
            before.radius
        };
        let length = (self.spacing * self.random.between((0.8, 1.2))).max(1.1 * widest);
        let step = Step {
            from: before.at,
            length,
            radius: before.radius * SWELL.1,
            behind: self.grown.capsule_to(parent),
            clear_of: if is_first {
                clear_of + before.radius
            } else {
                0.0
            },
        };
        let mut heading = self.bent(before.heading, before.at, length);
        let mut wobble = self.wobbled(before.wobble, length);
        let mut sideways = wobble - heading * wobble.dot(heading);
        if self.tree.flat {
            sideways.z *= 0.2;
        }
        let wanted = (heading + sideways).normalize_or(heading);
        let cones = if is_first && self.grown.room.is_some() {
            self.cones(branch)
        } else {
            Vec::new()
        };
        let direction = self.free_direction(&step, wanted, &cones)?;
        if direction != wanted {
            (heading, wobble) = (direction, DVec3::ZERO);
        }
        let capsule = step.toward(direction);
        let thinnest = self.tree.thinnest.min(branch.radius);
        let taper = if is_first {
            1.0
        } else {
            before.taper * libm::exp(-length / (self.tree.taper * self.stretch))
        };
        let radius = thinnest + (branch.radius - thinnest) * taper;
        let is_inner = !is_first && placed + 1 < points;
        let swell = if is_inner {
            self.random.between(SWELL)
        } else {
            1.0
        };
        self.grown
            .push(self.tree.kind, parent, radius * swell, &capsule);
        Some(State {
            at: capsule.to,
            heading,
            radius,
            wobble,
            taper,
        })
    }

    /// What the first step behind a fork keeps to.
    fn cones(&self, branch: &Branch) -> Vec<Cone> {
        let trunk = |angle| Some(Cone::new(self.grown.step_to(branch.parent)?, angle));
        let sibling = || {
            Some(Cone::new(
                self.grown.first_step_from(branch.parent)?,
                WIDEST,
            ))
        };
        let cones = match branch.of_fork {
            OfFork::Not => [None, None],
            OfFork::Greater => [trunk(GREATER_TURN), None],
            OfFork::Lesser => [trunk(LESSER_TURN), sibling()],
        };
        cones.into_iter().flatten().collect()
    }

    /// The wanted direction, or the one nearest to it that leads past everything; if none does, one that leads
    /// past it for this step.
    fn free_direction(&mut self, step: &Step, wanted: DVec3, cones: &[Cone]) -> Option<DVec3> {
        let wanted = cones
            .iter()
            .fold(wanted, |wanted, cone| cone.nearest(wanted));
        let ahead = AHEAD * step.length;
        let Some(room) = &self.grown.room else {
            return Some(wanted);
        };
        let way = room.way(&step.toward(wanted), ahead);
        if way == Way::Free {
            return Some(wanted);
        }
        let far = step.length.max(step.clear_of) + ahead + reach(step.radius);
        room.near(step.from, far, &mut self.near);
        let mut best = (way == Way::Ends).then_some(wanted);
        let phase = std::f64::consts::TAU * self.random.unit();
        let (u, v) = wanted.any_orthonormal_pair();
        for turn in TURNS {
            for side in 0..SIDES {
                let angle = phase + std::f64::consts::TAU * f64::from(side) / f64::from(SIDES);
                let across = u * libm::cos(angle) + v * libm::sin(angle);
                let direction = wanted * libm::cos(turn) + across * libm::sin(turn);
                if !cones.iter().all(|cone| cone.has(direction)) {
                    continue;
                }
                match room.way_among(&step.toward(direction), ahead, &self.near) {
                    Way::Free => return Some(direction),
                    Way::Ends => best = best.or(Some(direction)),
                    Way::Blocked => {}
                }
            }
        }
        best
    }

    /// The heading after tropism, what keeps a flat tree flat, and what keeps it out of the soma.
    fn bent(&self, heading: DVec3, at: DVec3, step: f64) -> DVec3 {
        let away = at.normalize_or(heading);
        let (to, strength) = match self.tree.tropism {
            Tropism::Away(strength) => (away, strength),
            Tropism::To(to, strength) => (to, strength),
        };
        let mut bent = heading + to * (strength / self.stretch * step);
        if at.length() < 1.5 * self.soma_radius {
            bent += away * 0.3;
        }
        if self.tree.flat {
            // Branches that keep clear of one another need some depth to pass.
            let (keep, back) = match self.grown.room {
                None => (0.5, 0.01),
                Some(_) => (0.8, 0.004),
            };
            bent.z = keep * bent.z - back * at.z;
        }
        bent.normalize_or(heading)
    }

    /// One step of an Ornstein-Uhlenbeck process in space.
    fn wobbled(&mut self, wobble: DVec3, step: f64) -> DVec3 {
        let keep = libm::exp(-step / MEMORY);
        let ((x, y), (z, _)) = (self.random.normal_pair(), self.random.normal_pair());
        let kick = self.tree.wobble * (1.0 - keep * keep).sqrt();
        wobble * keep + DVec3::new(x, y, z) * kick
    }
}
