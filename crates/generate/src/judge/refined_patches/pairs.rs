//! Which patches are near one another, by their boxes.

use super::RefinedPatches;

impl RefinedPatches {
    /// Pairs of patches whose boxes overlap, each with itself too; none if there are more than `most`.
    pub(super) fn near_pairs(&self, most: usize) -> Option<Vec<[u32; 2]>> {
        let order = self.order_along_x();
        let mut pairs = Vec::with_capacity(12 * order.len());
        for (i, &a) in order.iter().enumerate() {
            pairs.push([a, a]);
            self.add_pairs(a, &order[i + 1..], &mut pairs);
            if pairs.len() > most {
                return None;
            }
        }
        Some(pairs)
    }

    /// Those of all pairs of patches whose boxes overlap that some patches have a part in, in the same order.
    pub(super) fn pairs_near(&self, concerned: &[bool]) -> Vec<[u32; 2]> {
        let order = self.order_along_x();
        let is_concerned = |patch: &u32| concerned[*patch as usize];
        let few: Vec<u32> = order.iter().copied().filter(is_concerned).collect();
        let mut pairs = Vec::with_capacity(16 * few.len());
        let mut next = 0;
        for (i, &a) in order.iter().enumerate() {
            if is_concerned(&a) {
                next += 1;
                pairs.push([a, a]);
                self.add_pairs(a, &order[i + 1..], &mut pairs);
            } else {
                self.add_pairs(a, &few[next..], &mut pairs);
            }
        }
        pairs
    }

    /// All patches by where their boxes begin along x.
    fn order_along_x(&self) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.boxes.len() as u32).collect();
        let low = |patch: u32| self.boxes[patch as usize].low.x;
        order.sort_by(|&a, &b| low(a).total_cmp(&low(b)).then(a.cmp(&b)));
        order
    }

    /// Adds the pairs of a patch with those of the ones after it, in that order, whose boxes overlap its own.
    fn add_pairs(&self, patch: u32, after: &[u32], pairs: &mut Vec<[u32; 2]>) {
        let own = &self.boxes[patch as usize];
        for &other in after {
            let bounds = &self.boxes[other as usize];
            if bounds.low.x > own.high.x {
                break;
            }
            if own.overlaps(bounds) {
                pairs.push([patch, other]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::hairpin;
    use super::*;

    #[test]
    fn pairs_near_some_patches_are_those_of_all_with_a_part_in_them() {
        let mesh = hairpin();
        let all = 0..mesh.patches.len() as u32;
        let refined = RefinedPatches::new(&mesh, all.clone().collect());
        let pairs = refined.near_pairs(usize::MAX).expect("there is no limit");
        for step in [1, 7, 1000] {
            let concerned: Vec<bool> = all.clone().map(|patch| patch % step == 3 % step).collect();
            let has_part = |pair: &&[u32; 2]| pair.iter().any(|&p| concerned[p as usize]);
            let expected: Vec<[u32; 2]> = pairs.iter().filter(has_part).copied().collect();
            assert_eq!(refined.pairs_near(&concerned), expected, "every {step}th");
        }
    }

    #[test]
    fn too_many_pairs_are_none() {
        let mesh = hairpin();
        let refined = RefinedPatches::new(&mesh, (0..mesh.patches.len() as u32).collect());
        let count = refined
            .near_pairs(usize::MAX)
            .map_or(0, |pairs| pairs.len());
        assert!(refined.near_pairs(count).is_some());
        assert!(refined.near_pairs(count - 1).is_none());
    }
}
