//! Sets of indices, a bit for each: 100,000 neurons take 12.5 kB, and a copy takes nothing until one of the two changes.

use std::sync::Arc;

use fixedbitset::FixedBitSet;

/// A set of indices, which copies share.
#[derive(Clone, Debug, Default)]
pub struct IndexSet {
    bits: Arc<FixedBitSet>,
    len: usize,
}

impl PartialEq for IndexSet {
    fn eq(&self, other: &Self) -> bool {
        self.len == other.len
            && (Arc::ptr_eq(&self.bits, &other.bits) || self.bits.is_subset(&other.bits))
    }
}

impl FromIterator<usize> for IndexSet {
    fn from_iter<I: IntoIterator<Item = usize>>(indices: I) -> Self {
        Self::from(FixedBitSet::from_iter(indices))
    }
}

impl From<FixedBitSet> for IndexSet {
    fn from(bits: FixedBitSet) -> Self {
        let len = bits.count_ones(..);
        Self {
            bits: bits.into(),
            len,
        }
    }
}

impl IndexSet {
    /// All indices below `count`.
    pub(crate) fn below(count: usize) -> Self {
        let mut bits = FixedBitSet::with_capacity(count);
        bits.insert_range(..);
        bits.into()
    }

    /// Number of indices.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Whether it has an index.
    pub fn contains(&self, index: usize) -> bool {
        self.bits.contains(index)
    }

    /// The indices, ascending.
    pub fn iter(&self) -> impl Iterator<Item = usize> {
        self.bits.ones()
    }

    /// The indices, ascending.
    pub fn to_vec(&self) -> Vec<usize> {
        self.iter().collect()
    }

    /// The least index.
    pub fn first(&self) -> Option<usize> {
        self.bits.minimum()
    }

    /// The index, if it is the only one.
    pub fn only(&self) -> Option<usize> {
        self.first().filter(|_| self.len == 1)
    }

    /// Adds an index.
    pub(crate) fn insert(&mut self, index: usize) {
        if !self.contains(index) {
            Arc::make_mut(&mut self.bits).grow_and_insert(index);
            self.len += 1;
        }
    }

    /// Those of both.
    pub(crate) fn with(&self, other: &Self) -> Self {
        if other.is_empty() {
            return self.clone();
        }
        let mut bits = (*self.bits).clone();
        bits.union_with(&other.bits);
        bits.into()
    }

    /// Those that the other does not have.
    pub(crate) fn without(&self, other: &Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return self.clone();
        }
        let mut bits = (*self.bits).clone();
        bits.difference_with(&other.bits);
        bits.into()
    }

    /// Whether it has all of the other.
    pub(crate) fn has_all(&self, other: &Self) -> bool {
        other.bits.is_subset(&self.bits)
    }

    /// Each index greater by `by`.
    pub(crate) fn moved(&self, by: usize) -> Self {
        self.iter().map(|index| index + by).collect()
    }

    /// What an index is in a list that these are taken out of; none if it is one of them.
    pub(crate) fn renumbered(&self, index: usize) -> Option<usize> {
        let end = index.min(self.bits.len());
        (!self.contains(index)).then(|| index - self.bits.count_ones(..end))
    }

    /// What the indices are in a list that those of `removed` are taken out of.
    pub(crate) fn after_removal(&self, removed: &Self) -> Self {
        let mut gone = removed.iter().peekable();
        let mut before = 0;
        let left = self.iter().filter_map(|index| {
            while gone.next_if(|&other| other < index).is_some() {
                before += 1;
            }
            (gone.peek() != Some(&index)).then_some(index - before)
        });
        left.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(indices: &[usize]) -> IndexSet {
        indices.iter().copied().collect()
    }

    #[test]
    fn sets_are_equal_by_what_they_have() {
        let long = set(&[1, 900]).without(&set(&[900]));
        assert_eq!((&long, long.only()), (&set(&[1]), Some(1)));
        assert_ne!(long, set(&[2]));
        assert_eq!(set(&[3]).without(&set(&[3])), IndexSet::default());
        assert_eq!(IndexSet::below(3).to_vec(), [0, 1, 2]);
        assert_eq!((set(&[4, 7]).only(), set(&[4, 7]).first()), (None, Some(4)));
        assert_eq!(set(&[4]).with(&set(&[700])).to_vec(), [4, 700]);
        assert!(set(&[4, 700]).has_all(&set(&[4])) && !set(&[4]).has_all(&set(&[4, 700])));
        assert_eq!(set(&[0, 5]).moved(70).to_vec(), [70, 75]);
    }

    #[test]
    fn a_copy_is_shared_until_one_changes() {
        let mut set = IndexSet::below(100);
        let copy = set.clone();
        set.insert(7);
        assert!(Arc::ptr_eq(&set.bits, &copy.bits), "it was there already");
        set.insert(300);
        assert_eq!((set.len(), copy.len()), (101, 100));
        assert!(!copy.contains(300) && !copy.contains(5_000));
    }

    #[test]
    fn indices_move_up_where_others_are_removed() {
        let left = set(&[0, 2, 3, 9]).after_removal(&set(&[1, 3, 4, 20]));
        assert_eq!(left.to_vec(), [0, 1, 6]);
        let numbers = [0, 1, 2, 3, 900].map(|index| set(&[1, 3]).renumbered(index));
        assert_eq!(numbers, [Some(0), None, Some(1), None, Some(898)]);
    }
}
