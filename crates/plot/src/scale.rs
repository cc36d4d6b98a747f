//! Where numbers of an axis are in a figure, and its ticks.

use crate::{digits, step, ticks};

/// From the least to the greatest number of an axis.
pub(crate) struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
}

impl Scale {
    /// One that is never empty. `rounded`: up to the next tick, of so many.
    pub(crate) fn new([low, high]: [f64; 2], logarithmic: bool, rounded: Option<usize>) -> Self {
        // Of a logarithmic axis, the exponents.
        let of = |n: f64| if logarithmic { n.log10() } else { n };
        let (mut low, mut high) = (of(low), of(high));
        if low >= high {
            (low, high) = (low - 0.5, high + 0.5);
        }
        if let Some(most) = rounded.filter(|_| !logarithmic) {
            let step = step(high - low, most);
            (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
        }
        Self {
            low,
            high,
            logarithmic,
        }
    }

    /// Least and greatest number.
    pub(crate) fn bounds(&self) -> [f64; 2] {
        [self.low, self.high].map(|n| if self.logarithmic { 10f64.powf(n) } else { n })
    }

    /// Where a number is, from 0 to 1; no number where a logarithm has none.
    pub(crate) fn share(&self, n: f64) -> f64 {
        let n = if self.logarithmic { n.log10() } else { n };
        (n - self.low) / (self.high - self.low)
    }

    /// Numbers with their labels, at most about so many.
    pub(crate) fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        if self.logarithmic {
            return self.powers(most);
        }
        let step = step(self.high - self.low, most);
        let label = |n: f64| {
            let text = format!("{n:.*}", digits(step));
            // A multiple of a step may be a negative zero.
            if text == "-0" { "0".to_owned() } else { text }
        };
        let ticks = ticks([self.low, self.high], most).into_iter();
        ticks.map(|n| (n, label(n))).collect()
    }

    /// Powers of ten, also twice and five times these where there is room.
    fn powers(&self, most: usize) -> Vec<(f64, String)> {
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let all = |times: &[f64], every: usize| -> Vec<f64> {
            let powers = (first..=last)
                .filter(|power| (power.unsigned_abs() as usize).is_multiple_of(every));
            let numbers = powers.flat_map(|power| times.iter().map(move |t| t * 10f64.powi(power)));
            numbers
                .filter(|&n| (-1e-9..=1.0 + 1e-9).contains(&self.share(n)))
                .collect()
        };
        let every = (self.high - self.low) as usize / most.max(1) + 1;
        let choices = [
            all(&[1.0, 2.0, 5.0], 1),
            all(&[1.0, 3.0], 1),
            all(&[1.0], every),
        ];
        let mut fitting = choices.into_iter().skip_while(|all| all.len() > most);
        let numbers = fitting.next().unwrap_or_default();
        numbers.into_iter().map(|n| (n, format!("{n}"))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten_are_evenly_apart() {
        let labels = |scale: &Scale, most| -> Vec<String> {
            scale
                .ticks(most)
                .into_iter()
                .map(|(_, label)| label)
                .collect()
        };
        let scale = Scale::new([0.5, 200.0], true, None);
        assert!(
            (scale.share(10.0) - scale.share(1.0) - scale.share(100.0) + scale.share(10.0)).abs()
                < 1e-12
        );
        assert_eq!(
            labels(&scale, 9),
            ["0.5", "1", "2", "5", "10", "20", "50", "100", "200"]
        );
        assert_eq!(labels(&scale, 5), ["1", "3", "10", "30", "100"]);
        assert_eq!(
            labels(&Scale::new([1.0, 1e9], true, None), 4),
            ["1", "1000", "1000000", "1000000000"]
        );
        let even = Scale::new([0.2, 9.7], false, Some(6));
        assert_eq!((even.bounds(), even.share(5.0)), ([0.0, 10.0], 0.5));
        assert!(scale.share(-1.0).is_nan());
    }
}
