//! Long lists whose copies share what is equal: a copy takes nothing, and a change of an entry copies the entries beside
//! it only.

use std::ops::Index;
use std::sync::Arc;

/// Most entries of a piece. Small, since a change copies a piece; large, since a copy of the list that changes has an own
/// list of pieces: 100,000 neurons are 20 kB of pieces, and a moved one takes 23 kB more.
const PIECE: usize = 128;

/// A list, which copies share.
#[derive(Clone, Debug)]
pub struct SharedList<T> {
    pieces: Arc<Vec<Piece<T>>>,
    len: usize,
}

/// Entries that follow one another; at least one.
#[derive(Clone, Debug)]
struct Piece<T> {
    /// Index of the first.
    start: usize,
    entries: Arc<Vec<T>>,
}

impl<T> Default for SharedList<T> {
    fn default() -> Self {
        Self {
            pieces: Arc::default(),
            len: 0,
        }
    }
}

impl<T: PartialEq> PartialEq for SharedList<T> {
    fn eq(&self, other: &Self) -> bool {
        if self.is_shared_with(other) {
            return true;
        }
        let mut pairs = self.pieces.iter().zip(other.pieces.iter());
        self.len == other.len
            && match pairs.clone().all(|(a, b)| a.start == b.start) {
                true => pairs
                    .all(|(a, b)| Arc::ptr_eq(&a.entries, &b.entries) || a.entries == b.entries),
                false => self.iter().eq(other.iter()),
            }
    }
}

impl<T> Index<usize> for SharedList<T> {
    type Output = T;

    fn index(&self, index: usize) -> &T {
        let piece = &self.pieces[self.piece_of(index)];
        &piece.entries[index - piece.start]
    }
}

impl<T> SharedList<T> {
    /// Number of entries.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// An entry.
    pub fn get(&self, index: usize) -> Option<&T> {
        (index < self.len).then(|| &self[index])
    }

    /// The entries in their order.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.pieces.iter().flat_map(|piece| piece.entries.iter())
    }

    /// Whether both take the memory of one.
    pub(crate) fn is_shared_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.pieces, &other.pieces)
    }

    /// The piece that has an index, if there is any.
    fn piece_of(&self, index: usize) -> usize {
        let after = self.pieces.partition_point(|piece| piece.start <= index);
        after.saturating_sub(1)
    }
}

impl<T: Clone> SharedList<T> {
    /// An entry that will be changed: copied first, with those beside it, if other lists share it.
    pub(crate) fn get_mut(&mut self, index: usize) -> Option<&mut T> {
        if index >= self.len {
            return None;
        }
        let at = self.piece_of(index);
        let piece = &mut Arc::make_mut(&mut self.pieces)[at];
        Arc::make_mut(&mut piece.entries).get_mut(index - piece.start)
    }

    /// Adds an entry at the end.
    pub(crate) fn push(&mut self, entry: T) {
        let pieces = Arc::make_mut(&mut self.pieces);
        match pieces.last_mut() {
            Some(last) if last.entries.len() < PIECE => {
                Arc::make_mut(&mut last.entries).push(entry);
            }
            _ => pieces.push(Piece {
                start: self.len,
                entries: Arc::new(vec![entry]),
            }),
        }
        self.len += 1;
    }

    /// Adds the entries of another list, which both share then.
    pub(crate) fn append(&mut self, other: &Self) {
        if self.is_empty() {
            *self = other.clone();
            return;
        }
        if let [one] = &other.pieces[..]
            && one.entries.len() == 1
        {
            // Pieces of one entry each would add up.
            self.push(other[0].clone());
            return;
        }
        let start = self.len;
        let added = other.pieces.iter().map(|piece| Piece {
            start: start + piece.start,
            entries: Arc::clone(&piece.entries),
        });
        Arc::make_mut(&mut self.pieces).extend(added);
        self.len += other.len;
    }

    /// The list without the entries whose index is `removed`.
    pub(crate) fn without(&self, removed: impl Fn(usize) -> bool) -> Self {
        let mut pieces = Vec::with_capacity(self.pieces.len());
        let mut len = 0;
        for Piece { start, entries } in self.pieces.iter() {
            let indices = *start..start + entries.len();
            let entries = match indices.clone().any(&removed) {
                false => Arc::clone(entries),
                true => {
                    let kept = entries.iter().zip(indices).filter(|(_, i)| !removed(*i));
                    Arc::new(kept.map(|(entry, _)| entry.clone()).collect())
                }
            };
            if !entries.is_empty() {
                let start = len;
                len += entries.len();
                pieces.push(Piece { start, entries });
            }
        }
        Self {
            pieces: pieces.into(),
            len,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(count: usize) -> SharedList<usize> {
        let mut list = SharedList::default();
        (0..count).for_each(|entry| list.push(entry));
        list
    }

    /// Number of pieces that two lists share.
    fn shared(a: &SharedList<usize>, b: &SharedList<usize>) -> usize {
        let is_shared = |piece: &&Piece<usize>| {
            let mut others = b.pieces.iter();
            others.any(|other| Arc::ptr_eq(&piece.entries, &other.entries))
        };
        a.pieces.iter().filter(is_shared).count()
    }

    #[test]
    fn lists_are_as_vectors_are() {
        let mut whole = list(1000);
        let mut vector: Vec<usize> = (0..1000).collect();
        for step in [3, 7, 100] {
            let removed = |i: usize| i % step == 1 || (300..700).contains(&i);
            whole = whole.without(removed);
            let mut index = 0..;
            vector.retain(|_| !index.next().is_some_and(removed));
            whole.append(&list(step));
            vector.extend(0..step);
            whole.push(step);
            vector.push(step);
            assert!(whole.iter().eq(&vector));
            assert!((0..vector.len()).all(|i| whole.get(i) == vector.get(i)));
            assert_eq!((whole.len(), whole.get(whole.len())), (vector.len(), None));
        }
        let mut same = SharedList::default();
        vector.iter().for_each(|&entry| same.push(entry));
        assert_eq!(same, whole, "in other pieces");
        *same.get_mut(vector.len() - 1).expect("the last") += 1;
        assert_ne!(same, whole);
        assert!(whole.without(|_| true).is_empty());
    }

    #[test]
    fn a_change_copies_one_piece() {
        let before = list(10 * PIECE);
        let mut list = before.clone();
        *list.get_mut(5 * PIECE).expect("it is there") = 0;
        assert_eq!((shared(&list, &before), list.len()), (9, before.len()));
        let left = before.without(|i| i == 3);
        assert_eq!((shared(&left, &before), left.get(3)), (9, Some(&4)));
        let mut both = before.clone();
        both.append(&list);
        assert_eq!((shared(&both, &before), shared(&both, &list)), (19, 19));
        assert_eq!(before[5 * PIECE], 5 * PIECE);
    }
}
