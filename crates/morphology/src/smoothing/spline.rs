//! Cubic smoothing splines, in linear time.
//!
//! Reinsch, Smoothing by Spline Functions, 1967; Green and Silverman, Nonparametric Regression and
//! Generalized Linear Models, 1994, chapter 2. Of all curves g, the spline makes
//! Σ wᵢ (yᵢ − g(tᵢ))² + α ∫ g″² least. Its second derivatives γ at the inner knots solve
//! (R + α Qᵀ W⁻¹ Q) γ = Qᵀ y, which has five diagonals, and g = y − α W⁻¹ Q γ. Qᵀ y are the jumps of the
//! slope of the polyline through y; Q γ are those of γ, which is 0 at both ends. A value that is held has
//! an infinite weight: W⁻¹ is 0 there.

/// The equations of a spline on its knots, ready for any values.
#[derive(Debug)]
pub(super) struct Spline {
    /// From each knot to the next.
    steps: Vec<f64>,
    /// α/w of each knot.
    give: Vec<f64>,
    /// The equations as L D Lᵀ: D, and the two entries of L below the diagonal in each column.
    pivots: Vec<f64>,
    below: Vec<[f64; 2]>,
}

/// A spline's values and second derivatives at its knots.
#[derive(Debug)]
pub(super) struct Fit {
    pub(super) values: Vec<f64>,
    pub(super) bends: Vec<f64>,
}

impl Spline {
    /// For knots that are `steps` apart, all above 0. `give`: α/w of each knot, 0 where the value is held.
    pub(super) fn new(steps: Vec<f64>, give: Vec<f64>) -> Self {
        let (pivots, below) = factors(&steps, &give);
        Self {
            steps,
            give,
            pivots,
            below,
        }
    }

    /// The spline of these values, one for each knot.
    pub(super) fn fit(&self, values: &[f64]) -> Fit {
        let inner = self.solve(jumps(&self.slopes(values)));
        let bends = [&[0.0], &*inner, &[0.0]].concat();
        let slopes = [&[0.0], &*self.slopes(&bends), &[0.0]].concat();
        let moved = values.iter().zip(jumps(&slopes)).zip(&self.give);
        Fit {
            values: moved
                .map(|((value, jump), give)| value - give * jump)
                .collect(),
            bends,
        }
    }

    fn slopes(&self, values: &[f64]) -> Vec<f64> {
        let pairs = values.windows(2).zip(&self.steps);
        pairs
            .map(|(pair, step)| (pair[1] - pair[0]) / step)
            .collect()
    }

    fn solve(&self, mut x: Vec<f64>) -> Vec<f64> {
        for i in 0..x.len() {
            let [first, second] = self.below[i];
            for (k, entry) in [(i + 1, first), (i + 2, second)] {
                if k < x.len() {
                    x[k] -= entry * x[i];
                }
            }
        }
        for i in (0..x.len()).rev() {
            let after = |k: usize| x.get(k).copied().unwrap_or(0.0);
            let [first, second] = self.below[i];
            x[i] = x[i] / self.pivots[i] - first * after(i + 1) - second * after(i + 2);
        }
        x
    }
}

impl Fit {
    /// The value at a place beside or between knots `left` and `left + 1`, `before` after the one and `after`
    /// before the other.
    pub(super) fn between(&self, left: usize, before: f64, after: f64) -> f64 {
        let step = before + after;
        let [from, to] = [self.values[left], self.values[left + 1]];
        let [bend_from, bend_to] = [self.bends[left], self.bends[left + 1]];
        let bend = (1.0 + before / step) * bend_to + (1.0 + after / step) * bend_from;
        (before * to + after * from) / step - before * after * bend / 6.0
    }
}

fn jumps(slopes: &[f64]) -> Vec<f64> {
    slopes.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// R + α Qᵀ W⁻¹ Q as L D Lᵀ.
fn factors(steps: &[f64], give: &[f64]) -> (Vec<f64>, Vec<[f64; 2]>) {
    let column = |pair: &[f64]| {
        let (before, after) = (1.0 / pair[0], 1.0 / pair[1]);
        [before, -before - after, after]
    };
    let q: Vec<[f64; 3]> = steps.windows(2).map(column).collect();
    let mut pivots: Vec<f64> = Vec::with_capacity(q.len());
    let mut below: Vec<[f64; 2]> = Vec::with_capacity(q.len());
    for i in 0..q.len() {
        let give = &give[i..i + 3];
        let own: f64 = (0..3).map(|k| give[k] * q[i][k] * q[i][k]).sum();
        let mut diagonal = (steps[i] + steps[i + 1]) / 3.0 + own;
        let [mut first, mut second] = [0.0; 2];
        if let Some(next) = q.get(i + 1) {
            first = steps[i + 1] / 6.0 + give[1] * q[i][1] * next[0] + give[2] * q[i][2] * next[1];
        }
        if let Some(next) = q.get(i + 2) {
            second = give[2] * q[i][2] * next[0];
        }
        if i >= 1 {
            let [near, far] = below[i - 1];
            diagonal -= pivots[i - 1] * near * near;
            first -= pivots[i - 1] * near * far;
        }
        if i >= 2 {
            let [_, far] = below[i - 2];
            diagonal -= pivots[i - 2] * far * far;
        }
        pivots.push(diagonal);
        below.push([first / diagonal, second / diagonal]);
    }
    (pivots, below)
}
