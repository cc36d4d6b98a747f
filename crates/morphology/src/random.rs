//! Random numbers that are the same on every platform: for synthetic cells, spines, circuits.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;

/// A stream of random numbers (PCG XSH RR 64/32; M. O'Neill, 2014).
#[derive(Debug, Clone)]
pub struct Random(Pcg32);

impl Random {
    /// The numbers that `seed` gives in one of its 2⁶³ independent streams.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        Self(Pcg32::new(seed, stream))
    }

    /// In [0, 1), 32 bits of it.
    pub fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / 4_294_967_296.0
    }

    /// In [from, to).
    pub fn between(&mut self, (from, to): (f64, f64)) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Normally distributed, mean 0 and variance 1 (Box and Muller, 1958), two at a time.
    pub fn normal_pair(&mut self) -> (f64, f64) {
        let distance = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
        let angle = std::f64::consts::TAU * self.unit();
        (distance * libm::cos(angle), distance * libm::sin(angle))
    }
}
