//! The weights of a whole picture, put together from tiles or steps, as a sparse matrix: rows are
//! pixels, columns are the color keys that show.

use std::collections::{BTreeMap, HashMap};

use bytemuck::{Pod, Zeroable};

use super::collect::{Collected, Span, Weighed};

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
pub(crate) struct Weight {
    pub(crate) color: u32,
    pub(crate) low: u32,
    pub(crate) high: u32,
}

/// The weights of all pixels of a picture.
#[derive(Clone, Debug, Default)]
pub(crate) struct Matrix {
    pub(crate) keys: Vec<VisibleKey>,
    /// By pixel: its first weight, and what does not depend on colors. One more at the end.
    pub(crate) rows: Vec<[u32; 2]>,
    pub(crate) weights: Vec<Weight>,
}

/// One picture of the samples: all of them, or those of one step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layer {
    size: [u32; 2],
    spans: Vec<Span>,
    weighed: Vec<Weighed>,
}

impl Layer {
    /// A layer in which nothing shows.
    pub(crate) fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            spans: vec![Span::default(); size[0] as usize * size[1] as usize],
            weighed: Vec::new(),
        }
    }

    /// Adds the pixels of a tile whose upper left pixel is at `[left, top]`.
    pub(crate) fn add(&mut self, [left, top]: [u32; 2], tile: &Collected) {
        let before = self.weighed.len() as u32;
        self.weighed.extend_from_slice(&tile.weighed);
        let width = self.size[0].saturating_sub(left).min(tile.size[0]) as usize;
        let rows = tile.spans.chunks(tile.size[0].max(1) as usize);
        for (y, row) in (top..self.size[1]).zip(rows) {
            let at = y as usize * self.size[0] as usize + left as usize;
            for (to, from) in self.spans[at..at + width].iter_mut().zip(row) {
                *to = Span {
                    first: from.first + before,
                    ..*from
                };
            }
        }
    }

    fn of_pixel(&self, pixel: usize) -> (Span, &[Weighed]) {
        let span = self.spans[pixel];
        let first = span.first as usize;
        (span, &self.weighed[first..first + span.count as usize])
    }
}

impl Matrix {
    /// The mean of layers of the same size.
    pub(crate) fn new(layers: &[Layer]) -> Self {
        let share = 1.0 / layers.len().max(1) as f32;
        let mut numbers = Numbers::default();
        let mut made = Self::default();
        let mut sums: Vec<(u32, [f32; 4])> = Vec::new();
        for pixel in 0..layers.first().map_or(0, |layer| layer.spans.len()) {
            sums.clear();
            let mut fixed = [0.0; 2];
            for layer in layers {
                let (span, weighed) = layer.of_pixel(pixel);
                fixed = [
                    fixed[0] + span.white * share,
                    fixed[1] + span.coverage * share,
                ];
                for one in weighed {
                    let number = numbers.of(VisibleKey {
                        instance: one.instance,
                        color_key: one.color_key,
                    });
                    let [[a, b], [c, d]] = [unpacked(one.low), unpacked(one.high)];
                    let add = [a, b, c, d].map(|weight| weight * share);
                    match sums.iter_mut().find(|(known, _)| *known == number) {
                        Some((_, sum)) => *sum = [0, 1, 2, 3].map(|k| sum[k] + add[k]),
                        None => sums.push((number, add)),
                    }
                }
            }
            made.rows.push([made.weights.len() as u32, packed(fixed)]);
            made.weights
                .extend(sums.iter().map(|&(color, [a, b, c, d])| Weight {
                    color,
                    low: packed([a, b]),
                    high: packed([c, d]),
                }));
        }
        made.rows.push([made.weights.len() as u32, 0]);
        made.keys = numbers.sorted(&mut made.weights);
        // On the device neither the threads nor their order decide on anything.
        for row in made.rows.windows(2) {
            made.weights[row[0][0] as usize..row[1][0] as usize].sort_unstable_by_key(|w| w.color);
        }
        made
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

    /// All keys in order, by which the weights are numbered from then on.
    fn sorted(self, weights: &mut [Weight]) -> Vec<VisibleKey> {
        let ordered: BTreeMap<VisibleKey, u32> = self.all.into_iter().collect();
        let mut new = vec![0; ordered.len()];
        for (&old, number) in ordered.values().zip(0..) {
            new[old as usize] = number;
        }
        for weight in weights {
            weight.color = new[weight.color as usize];
        }
        ordered.into_keys().collect()
    }
}

/// Two numbers from 0 to 2, as WGSL's `pack2x16unorm` packs their halves.
fn packed(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|n| (n.clamp(0.0, 2.0) * 0.5 * 65535.0 + 0.5) as u32);
    low | (high << 16)
}

fn unpacked(bits: u32) -> [f32; 2] {
    [bits & 0xffff, bits >> 16].map(|n| n as f32 / 65535.0 * 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weighed(color_key: u32, instance: u32, weights: [f32; 4]) -> Weighed {
        Weighed {
            color_key,
            instance,
            low: packed([weights[0], weights[1]]),
            high: packed([weights[2], weights[3]]),
        }
    }

    fn one_pixel(all: &[Weighed]) -> Layer {
        let mut layer = Layer::new([2, 1]);
        let tile = Collected {
            size: [1, 1],
            spans: vec![Span {
                first: 0,
                count: all.len() as u32,
                white: 0.5,
                coverage: 1.0,
            }],
            weighed: all.to_vec(),
        };
        layer.add([1, 0], &tile);
        layer
    }

    #[test]
    fn layers_are_averaged_by_key_and_keys_are_in_order() {
        let a = weighed(7, 1, [1.0, 0.0, 0.5, 0.25]);
        let b = weighed(3, 0, [2.0, 0.0, 0.0, 0.0]);
        let matrix = Matrix::new(&[one_pixel(&[a]), one_pixel(&[b, a])]);
        let key = |instance, color_key| VisibleKey {
            instance,
            color_key,
        };
        assert_eq!(matrix.keys, [key(0, 3), key(1, 7)]);
        let firsts: Vec<u32> = matrix.rows.iter().map(|row| row[0]).collect();
        assert_eq!(firsts, [0, 0, 2]);
        let sums: Vec<_> = matrix
            .weights
            .iter()
            .map(|w| (w.color, unpacked(w.low)[0]))
            .collect();
        assert!(
            sums.iter().all(|(_, sum)| (sum - 1.0).abs() < 1e-4),
            "{sums:?}"
        );
        assert_eq!(
            sums.iter().map(|(color, _)| *color).collect::<Vec<_>>(),
            [0, 1]
        );
        let fixed = unpacked(matrix.rows[1][1]);
        assert!((fixed[0] - 0.5).abs() < 1e-4 && (fixed[1] - 1.0).abs() < 1e-4);
    }

    #[test]
    fn what_lies_beyond_the_picture_is_left_out() {
        let mut layer = Layer::new([2, 2]);
        let span = Span {
            first: 0,
            count: 1,
            white: 0.0,
            coverage: 1.0,
        };
        let tile = Collected {
            size: [4, 4],
            spans: vec![span; 16],
            weighed: vec![Weighed::default()],
        };
        layer.add([1, 1], &tile);
        let covered: Vec<bool> = layer.spans.iter().map(|s| s.coverage > 0.0).collect();
        assert_eq!(covered, [false, false, false, true]);
    }
}
