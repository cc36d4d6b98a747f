//! The weights of a whole picture, put together from tiles and steps, as a sparse matrix: rows are
//! pixels, columns are the color keys that show.

use std::collections::{BTreeMap, HashMap};

use bytemuck::{Pod, Zeroable};

use super::{Collected, Weighed};

/// A color key of an instance, of which something shows in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VisibleKey {
    /// Index of the instance in the scene.
    pub instance: u32,
    /// Color key of the instance's template.
    pub color_key: u32,
}

/// What a color adds to a pixel. Twin of the struct in recolor.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Weight {
    /// Index of the color key.
    pub color: u32,
    /// As in [`Weighed`](super::Weighed).
    pub low: u32,
    /// As in [`Weighed`](super::Weighed).
    pub high: u32,
}

/// The weights of all pixels of a picture, by [`MatrixBuilder`].
#[derive(Clone, Debug, Default)]
pub struct Matrix {
    /// What shows: each color key of each instance once, in order.
    pub keys: Vec<VisibleKey>,
    /// By pixel: its first weight, and what does not depend on colors. One more at the end.
    pub rows: Vec<[u32; 2]>,
    /// The weights, pixel by pixel.
    pub weights: Vec<Weight>,
}

/// What was collected of some rows of pixels: of all their samples, or of those of each of several
/// steps.
#[derive(Clone, Debug, Default)]
pub struct Weights {
    size: [u32; 2],
    fixed: Vec<[f32; 2]>,
    weighed: Vec<Weighed>,
}

impl Weights {
    /// Of rows in which nothing shows.
    pub fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            fixed: vec![[0.0; 2]; size[0] as usize * size[1] as usize],
            weighed: Vec::new(),
        }
    }

    /// Adds the pixels of a tile whose upper left pixel is at `[left, top]`.
    pub fn add(&mut self, [left, top]: [u32; 2], tile: &Collected) {
        let [width, height] = self.size;
        let tile_width = tile.size[0].max(1);
        let within = |pixel: u32| {
            let [x, y] = [left + pixel % tile_width, top + pixel / tile_width];
            (x < width && y < height).then(|| y * width + x)
        };
        for (&[white, coverage], pixel) in tile.fixed.iter().zip(0..) {
            if let Some(pixel) = within(pixel) {
                let sum = &mut self.fixed[pixel as usize];
                *sum = [sum[0] + white, sum[1] + coverage];
            }
        }
        let moved = tile.weighed.iter().filter_map(|one| {
            let pixel = within(one.pixel)?;
            Some(Weighed { pixel, ..*one })
        });
        self.weighed.extend(moved);
    }
}

/// Puts a matrix together from the top of the picture to its bottom.
#[derive(Default)]
pub struct MatrixBuilder {
    numbers: Numbers,
    rows: Vec<[u32; 2]>,
    weights: Vec<Weight>,
}

impl MatrixBuilder {
    /// Adds the next rows of pixels. `steps`: how often each pixel was collected; the mean of the steps
    /// is taken.
    pub fn add(&mut self, collected: &Weights, steps: u32) {
        let numbered = collected.weighed.iter().map(|one| {
            let key = VisibleKey {
                instance: one.instance,
                color_key: one.color_key,
            };
            (one.pixel, self.numbers.of(key), [one.low, one.high])
        });
        let mut sorted: Vec<(u32, u32, [u32; 2])> = numbered.collect();
        // Sums of whole numbers, so that the order in which the device wrote does not matter.
        sorted.sort_unstable_by_key(|&(pixel, number, _)| (pixel, number));
        let mut rest = sorted.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).peekable();
        for (&fixed, pixel) in collected.fixed.iter().zip(0..) {
            let fixed = fixed.map(|sum| sum / steps as f32);
            self.rows.push([self.weights.len() as u32, packed(fixed)]);
            while let Some(same) = rest.next_if(|same| same[0].0 == pixel) {
                let mean = |half: usize, shift: u32| -> u32 {
                    let all = same
                        .iter()
                        .map(|(_, _, bits)| (bits[half] >> shift) & 0xffff);
                    (all.sum::<u32>() + steps / 2) / steps
                };
                let both =
                    |half: usize| mean(half, 0).min(0xffff) | (mean(half, 16).min(0xffff) << 16);
                self.weights.push(Weight {
                    color: same[0].1,
                    low: both(0),
                    high: both(1),
                });
            }
        }
    }

    /// The matrix of all rows that were added. Keys are in order, and so are the weights of a pixel.
    pub fn finish(mut self) -> Matrix {
        self.rows.push([self.weights.len() as u32, 0]);
        let (keys, new) = self.numbers.sorted();
        for weight in &mut self.weights {
            weight.color = new[weight.color as usize];
        }
        for pair in self.rows.windows(2) {
            self.weights[pair[0][0] as usize..pair[1][0] as usize]
                .sort_unstable_by_key(|w| w.color);
        }
        Matrix {
            keys,
            rows: self.rows,
            weights: self.weights,
        }
    }
}

/// Numbers color keys as they come.
#[derive(Default)]
struct Numbers {
    all: HashMap<VisibleKey, u32>,
    last: Option<(VisibleKey, u32)>,
}

impl Numbers {
    fn of(&mut self, key: VisibleKey) -> u32 {
        // Neighboring pixels mostly show the same.
        if let Some((known, number)) = self.last
            && known == key
        {
            return number;
        }
        let next = self.all.len() as u32;
        let number = *self.all.entry(key).or_insert(next);
        self.last = Some((key, number));
        number
    }

    /// All keys in order, and the place of each by its number.
    fn sorted(self) -> (Vec<VisibleKey>, Vec<u32>) {
        let ordered: BTreeMap<VisibleKey, u32> = self.all.into_iter().collect();
        let mut new = vec![0; ordered.len()];
        for (&old, place) in ordered.values().zip(0..) {
            new[old as usize] = place;
        }
        (ordered.into_keys().collect(), new)
    }
}

/// Two numbers from 0 to 2, as WGSL's `pack2x16unorm` packs their halves.
pub fn packed(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|n| (n.clamp(0.0, 2.0) * 0.5 * 65535.0 + 0.5) as u32);
    low | (high << 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weighed(pixel: u32, color_key: u32, instance: u32, weight: f32) -> Weighed {
        Weighed {
            pixel,
            color_key,
            instance,
            low: packed([weight, 0.0]),
            high: 0,
        }
    }

    fn of_one_step(weights: &Weights) -> Matrix {
        let mut builder = MatrixBuilder::default();
        builder.add(weights, 1);
        builder.finish()
    }

    fn factor(weight: &Weight) -> f32 {
        (weight.low & 0xffff) as f32 / 65535.0 * 2.0
    }

    #[test]
    fn steps_are_averaged_by_key_and_keys_are_in_order() {
        let mut weights = Weights::new([2, 1]);
        let first = [weighed(0, 7, 1, 1.0)];
        let second = [
            weighed(0, 3, 0, 1.5),
            weighed(0, 7, 1, 0.6),
            weighed(0, 3, 0, 0.5),
        ];
        for step in [&first[..], &second[..]] {
            let tile = Collected {
                size: [1, 1],
                fixed: vec![[0.5, 1.0]],
                weighed: step.to_vec(),
            };
            weights.add([1, 0], &tile);
        }
        let mut builder = MatrixBuilder::default();
        builder.add(&weights, 2);
        let matrix = builder.finish();
        let key = |instance, color_key| VisibleKey {
            instance,
            color_key,
        };
        assert_eq!(matrix.keys, [key(0, 3), key(1, 7)]);
        let firsts: Vec<u32> = matrix.rows.iter().map(|row| row[0]).collect();
        assert_eq!(firsts, [0, 0, 2]);
        let found: Vec<_> = matrix
            .weights
            .iter()
            .map(|w| (w.color, factor(w)))
            .collect();
        for ((color, factor), expected) in found.iter().zip([(0, 1.0), (1, 0.8)]) {
            assert!(
                *color == expected.0 && (factor - expected.1).abs() < 1e-4,
                "{found:?}"
            );
        }
        assert_eq!(matrix.rows[1][1], packed([0.5, 1.0]));
    }

    #[test]
    fn the_order_of_what_was_collected_does_not_matter() {
        let all: Vec<Weighed> = (0..40)
            .map(|k| weighed(k % 4, k % 3, k % 2, 0.01 * k as f32))
            .collect();
        let made = |all: Vec<Weighed>| {
            let mut weights = Weights::new([2, 2]);
            let fixed = vec![[0.0, 1.0]; 4];
            let size = [2, 2];
            weights.add(
                [0, 0],
                &Collected {
                    size,
                    fixed,
                    weighed: all,
                },
            );
            of_one_step(&weights)
        };
        let backward: Vec<Weighed> = all.iter().rev().copied().collect();
        let (a, b) = (made(all), made(backward));
        assert_eq!((a.keys, a.rows, a.weights), (b.keys, b.rows, b.weights));
    }

    #[test]
    fn rows_follow_one_another_and_share_keys() {
        let band = |key: u32, instance: u32| {
            let mut weights = Weights::new([2, 1]);
            let tile = Collected {
                size: [2, 1],
                fixed: vec![[0.0, 1.0]; 2],
                weighed: vec![weighed(1, key, instance, 1.0), weighed(1, 2, 5, 0.5)],
            };
            weights.add([0, 0], &tile);
            weights
        };
        let mut builder = MatrixBuilder::default();
        builder.add(&band(9, 6), 1);
        builder.add(&band(9, 1), 1);
        let matrix = builder.finish();
        let instances: Vec<u32> = matrix.keys.iter().map(|key| key.instance).collect();
        assert_eq!(instances, [1, 5, 6]);
        let firsts: Vec<u32> = matrix.rows.iter().map(|row| row[0]).collect();
        assert_eq!(firsts, [0, 0, 2, 2, 4]);
        let colors: Vec<u32> = matrix.weights.iter().map(|weight| weight.color).collect();
        assert_eq!(colors, [1, 2, 0, 1]);
    }

    #[test]
    fn what_lies_beyond_the_picture_is_left_out() {
        let mut weights = Weights::new([2, 2]);
        let tile = Collected {
            size: [4, 4],
            fixed: vec![[0.0, 1.0]; 16],
            weighed: (0..16).map(|pixel| weighed(pixel, 0, 0, 1.0)).collect(),
        };
        weights.add([1, 1], &tile);
        let covered: Vec<bool> = weights.fixed.iter().map(|fixed| fixed[1] > 0.0).collect();
        assert_eq!(covered, [false, false, false, true]);
        assert_eq!(of_one_step(&weights).weights.len(), 1);
    }
}
