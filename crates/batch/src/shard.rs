//! A part of many inputs, for one of many machines.

use std::str::FromStr;

/// The I-th of N parts, I counted from 1; as text `I/N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Index of the part, from 0.
    index: usize,
    /// Number of parts.
    count: usize,
}

/// No part of anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("two numbers I/N with 1 ≤ I ≤ N are needed, as in 3/8")]
pub struct ShardError;

impl Shard {
    /// Part `number` of `count`.
    ///
    /// # Errors
    /// `number` is not from 1 to `count`.
    pub fn new(number: usize, count: usize) -> Result<Self, ShardError> {
        match (1..=count).contains(&number) {
            true => Ok(Self {
                index: number - 1,
                count,
            }),
            false => Err(ShardError),
        }
    }

    /// Whether it is the first of the parts, which does what is to be done once.
    pub fn is_first(self) -> bool {
        self.index == 0
    }

    /// Every N-th item, from the I-th on.
    pub fn of<T>(self, items: Vec<T>) -> Vec<T> {
        items
            .into_iter()
            .skip(self.index)
            .step_by(self.count)
            .collect()
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let (number, count) = text.split_once('/').ok_or(ShardError)?;
        let whole = |text: &str| text.parse().map_err(|_| ShardError);
        Self::new(whole(number)?, whole(count)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_partition() {
        let all: Vec<usize> = (0..10).collect();
        let mut seen: Vec<usize> = (1..=3)
            .flat_map(|i| Shard::of(format!("{i}/3").parse().expect("a shard"), all.clone()))
            .collect();
        seen.sort_unstable();
        assert_eq!(seen, all);
        for wrong in ["0/3", "4/3", "1", "a/b", "1/0"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
