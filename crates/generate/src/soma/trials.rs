//! What is tried in turn until a soma's surface has no folds: requested rings nearer, as far out as the
//! surface allows; then all rings nearer.

/// Shares of the way from the sphere to the farthest first ring that are tried in turn until the
/// surface has no fold: close neurites that pull far out would make spikes through one another.
const REACHES: [f64; 5] = [1.0, 0.6, 0.35, 0.15, 0.03];
/// Limits (radii of the soma) of requested rings, where the surface folds with the rings as requested. The
/// same for all requests, so that a ring that is dragged farther and farther out comes to a stop.
const FARTHEST: [f64; 14] = [
    1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.2, 2.4, 2.7, 3.0, 3.5, 4.0, 5.0,
];

/// What is tried for a soma at present.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trial {
    /// Limit of requested rings (radii of the soma).
    pub(crate) farthest: f64,
    /// While a limit is searched for: the indices in [`FARTHEST`] that are left to try.
    search: Option<(usize, usize)>,
    /// Index in [`REACHES`].
    reach: usize,
}

impl Trial {
    pub(crate) fn new() -> Self {
        Self {
            farthest: f64::INFINITY,
            search: None,
            reach: 0,
        }
    }

    /// Goes on to the next thing to try; whether there is one. `sound`: whether the surface has no folds.
    /// `requested`: distance (radii) of the ring that a request took farthest out. `most`: the largest
    /// distance of rings without a request.
    pub(crate) fn advance(&mut self, sound: bool, requested: Option<f64>, most: f64) -> bool {
        match self.search {
            None if sound => return false,
            None => {
                let Some(requested) = requested.filter(|_| self.farthest == f64::INFINITY) else {
                    return self.go_nearer(most);
                };
                let below = FARTHEST.partition_point(|&f| f < requested - 1e-9);
                self.search = Some((0, below));
            }
            Some((low, high)) => {
                let middle = usize::midpoint(low, high);
                self.search = Some(if sound {
                    (middle + 1, high)
                } else {
                    (low, middle)
                });
            }
        }
        // Limits before `low` give a sound surface, those from `high` on do not.
        let (low, high) = self.search.unwrap_or_default();
        if low < high {
            self.farthest = FARTHEST[usize::midpoint(low, high)];
            return true;
        }
        self.search = None;
        // No request is too far any more: from now on all rings move nearer.
        let best = low.checked_sub(1).map_or(0.0, |best| FARTHEST[best]);
        let known = sound && self.farthest == best;
        self.farthest = best;
        !known
    }

    /// Share of the way to the farthest first ring.
    pub(crate) fn share(&self) -> f64 {
        REACHES[self.reach]
    }

    /// Whether rings are nearer than usual.
    pub(crate) fn is_nearer(&self) -> bool {
        self.reach > 0
    }

    /// Whether rings are as near as they may be.
    pub(crate) fn is_nearest(&self) -> bool {
        self.reach + 1 == REACHES.len()
    }

    /// Whether a limit of requested rings is searched for.
    pub(crate) fn searches(&self) -> bool {
        self.search.is_some()
    }

    fn go_nearer(&mut self, most: f64) -> bool {
        let nearer = !self.is_nearest() && most > 1.0;
        self.reach += usize::from(nearer);
        nearer
    }
}
