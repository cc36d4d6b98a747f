//! How large a spine is.
//!
//! | | mean | range |
//! | --- | ---: | ---: |
//! | length of the neck (µm) | 0.45 | 0.08–1.6 |
//! | diameter of the neck (µm) | 0.15 | 0.04–0.46 |
//! | volume of the head (µm³) | 0.051 | 0.003–0.55 |
//!
//! (Harris and Stevens 1989, stratum radiatum of CA1). Sizes are skewed, so logarithms are drawn from normal
//! distributions with these means, and what is beyond the range is drawn to its end.

use std::f64::consts::PI;

use super::room::GAP;
use crate::random::Random;

/// A twig with a head. Distances (µm) are from the center line of its dendrite.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spine {
    /// Distance and radius (µm) of its samples, outwards.
    samples: Vec<(f64, f64)>,
}

/// Necks are at most this share of their dendrite's radius and of their head's.
const NECK_OF_DENDRITE: f64 = 0.5;
const NECK_OF_HEAD: f64 = 0.6;
/// The nearer sample of a head is so many of its radii before its center.
const NEAR: f64 = 0.52;
/// Samples nearer to one another than this share of the larger radius are left out by meshing.
const SPACING: f64 = 0.5;

/// Room (µm) from the membrane that a spine of known length needs: the smallest head and a neck that is outside.
const LEAST: f64 = 0.5;
/// Gap (µm) between the dendrite and what has left it.
const OUTSIDE: f64 = 1.5 * GAP;

impl Spine {
    /// One for a dendrite of this radius (µm). `tip`: how far (µm) from the dendrite's center line it ends, if that is
    /// known and beyond the membrane; neck and head are smaller then, if there is no room for more.
    pub(super) fn new(dendrite: f64, tip: Option<f64>, random: &mut Random) -> Self {
        let mut length = skewed(random, (0.45, 0.29), (0.08, 1.6));
        let mut neck = skewed(random, (0.15, 0.06), (0.04, 0.46)) / 2.0;
        let volume = skewed(random, (0.051, 0.08), (0.003, 0.55));
        let mut head = (0.75 * volume / PI).cbrt();
        let room = tip.map(|tip| tip - dendrite);
        let room = room.filter(|room| *room >= LEAST);
        if let Some(room) = room {
            neck = neck.min(0.15 * room);
            // Half of the neck's length takes it outside; the head is as far from the dendrite as its near sample.
            head = head.min(room / 2.0 - OUTSIDE - neck);
            head = head.min((room - OUTSIDE) / (1.0 + NEAR + (1.0 - NEAR * NEAR).sqrt()));
        }
        let neck = neck
            .min(NECK_OF_DENDRITE * dendrite)
            .min(NECK_OF_HEAD * head);
        // The neck ends in the sphere of the head, whose far half is the round end of the twig.
        let rise = (head * head - neck * neck).sqrt();
        if let Some(room) = room {
            length = room - head - rise;
        }
        let mut samples = vec![(dendrite + 0.5 * length, neck), (dendrite + length, neck)];
        let center = dendrite + length + rise;
        for before in [NEAR, 0.0] {
            let radius = head * (1.0 - before * before).sqrt();
            let distance = center - before * head;
            let near = samples
                .last()
                .is_some_and(|&(last, _)| distance - last < SPACING * radius);
            if before == 0.0 || (radius > neck && !near) {
                samples.push((distance, radius));
            }
        }
        Self { samples }
    }

    /// Distance and radius (µm) of its samples, outwards.
    pub(super) fn samples(&self) -> &[(f64, f64)] {
        &self.samples
    }

    /// Moves it outwards as far as a dendrite that is this thick (µm) close by needs.
    pub(super) fn begin_outside(&mut self, dendrite: f64) {
        let missing = |&(distance, radius): &(f64, f64)| dendrite + radius + OUTSIDE - distance;
        let more = self.samples.iter().map(missing).fold(0.0, f64::max);
        for (distance, _) in &mut self.samples {
            *distance += more;
        }
    }

    /// Spheres that cover it: distances and radii (µm). Those of the neck begin where it has left its dendrite.
    pub(super) fn spheres(&self) -> Vec<(f64, f64)> {
        let mut spheres = Vec::new();
        for pair in self.samples.windows(2) {
            let [(from, thin), (to, thick)] = [pair[0], pair[1]];
            let steps = ((to - from) / thin.max(0.02)).ceil().clamp(1.0, 64.0);
            for step in 0..steps as u32 {
                let share = f64::from(step) / steps;
                spheres.push((from + share * (to - from), thin + share * (thick - thin)));
            }
        }
        spheres.extend(self.samples.last());
        spheres
    }
}

/// A number whose logarithm is normally distributed, by its own mean and standard deviation.
fn skewed(random: &mut Random, (mean, deviation): (f64, f64), (least, most): (f64, f64)) -> f64 {
    let ratio: f64 = deviation / mean;
    let variance = libm::log(1.0 + ratio * ratio);
    let drawn = libm::log(mean) - variance / 2.0 + variance.sqrt() * random.normal_pair().0;
    libm::exp(drawn).clamp(least, most)
}
