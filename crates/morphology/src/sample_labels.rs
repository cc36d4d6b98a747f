//! Numbers of samples as meshes hold them: 32 bits, as PLY and glTF have no wider whole numbers.

use crate::Morphology;

/// The number of each sample in meshes: its own, or where some sample of the tracing has one that 32 bits do not hold (ids of
/// 18 digits are usual in connectomes), its place, from 1 on: first the samples of somata, then the points.
#[derive(Clone, Copy, Debug)]
pub struct SampleLabels<'m> {
    morphology: &'m Morphology,
    /// Samples of somata.
    somata: usize,
    own: bool,
}

impl Morphology {
    /// The numbers of its samples in meshes. Takes time linear in the samples.
    pub fn sample_labels(&self) -> SampleLabels<'_> {
        let of_somata = self.somata.iter().flat_map(|soma| &soma.samples);
        let of_somata = of_somata.map(|sample| sample.id);
        let mut all = of_somata.chain(self.sample_ids.iter().copied());
        SampleLabels {
            morphology: self,
            somata: self.somata.iter().map(|soma| soma.samples.len()).sum(),
            own: all.all(|id| i32::try_from(id).is_ok()),
        }
    }
}

impl SampleLabels<'_> {
    /// Whether samples have their own numbers.
    pub fn are_own(&self) -> bool {
        self.own
    }

    /// The number of a point; −1 where the morphology numbers none.
    pub fn of_point(&self, point: usize) -> i32 {
        if self.own {
            let id = self.morphology.sample_ids.get(point);
            return id.map_or(-1, |&id| id as i32);
        }
        place(self.somata + point)
    }

    /// The number of a soma's sample.
    ///
    /// # Panics
    /// If there is no such sample.
    pub fn of_soma(&self, soma: usize, sample: usize) -> i32 {
        let somata = &self.morphology.somata;
        if self.own {
            return somata[soma].samples[sample].id as i32;
        }
        let before: usize = somata[..soma].iter().map(|s| s.samples.len()).sum();
        place(before + sample)
    }

    /// The file's own number of the sample with a number in meshes; the number itself where no sample has it.
    pub fn own_number(&self, label: i64) -> i64 {
        if self.own {
            return label;
        }
        let Some(mut place) = usize::try_from(label - 1).ok() else {
            return label;
        };
        for soma in &self.morphology.somata {
            if let Some(sample) = soma.samples.get(place) {
                return sample.id;
            }
            place -= soma.samples.len();
        }
        self.morphology
            .sample_ids
            .get(place)
            .copied()
            .unwrap_or(label)
    }
}

fn place(index: usize) -> i32 {
    i32::try_from(index + 1).unwrap_or(i32::MAX)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::{NeuriteKind, Node};

    #[test]
    fn long_numbers_become_places_and_come_back() {
        let cell = |first: i64| {
            let node = |(i, kind): (u32, i32)| Node {
                id: first + i64::from(i),
                kind: NeuriteKind(kind),
                position: DVec3::new(f64::from(i), 0.0, 0.0),
                radius: 1.0,
                parent: i.checked_sub(1),
                section: None,
            };
            let nodes: Vec<Node> = (0..).zip([1, 1, 3, 3]).map(node).collect();
            let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
            built.expect("a cell").morphology
        };
        let long = cell(155_636_373_412_120_721);
        let labels = long.sample_labels();
        assert!(!labels.are_own());
        let all = [
            labels.of_soma(0, 0),
            labels.of_soma(0, 1),
            labels.of_point(0),
            labels.of_point(1),
        ];
        assert_eq!(all, [1, 2, 3, 4]);
        let own = all.map(|label| labels.own_number(label.into()) - 155_636_373_412_120_721);
        assert_eq!(own, [0, 1, 2, 3]);
        assert_eq!(labels.own_number(9), 9);
        let short = cell(7);
        let labels = short.sample_labels();
        assert!(labels.are_own());
        assert_eq!([labels.of_soma(0, 1), labels.of_point(1)], [8, 10]);
        assert_eq!(labels.own_number(10), 10);
    }
}
