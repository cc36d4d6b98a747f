//! Revisions: equal revisions mean equal contents. Whatever is derived from a content keeps its
//! revision, and is derived again only when that has changed.

use std::cell::{Cell, RefCell};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

static NEXT: AtomicU64 = AtomicU64::new(1);

/// The revision of a content. A copy has the same revision, so an undo brings the old one back. The
/// default is the revision of an empty content.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Revision(u64);

impl Revision {
    /// A revision that has not been used before.
    pub fn next() -> Self {
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// A value whose revision changes whenever the value may have been changed. Copies share it until then.
#[derive(Clone, Debug, Default)]
pub struct Tracked<T> {
    value: Arc<T>,
    revision: Revision,
}

impl<T> Tracked<T> {
    /// The revision of the value.
    pub fn revision(&self) -> Revision {
        self.revision
    }
}

impl<T> Deref for Tracked<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T: Clone> DerefMut for Tracked<T> {
    fn deref_mut(&mut self) -> &mut T {
        self.revision = Revision::next();
        Arc::make_mut(&mut self.value)
    }
}

impl<T: PartialEq> PartialEq for Tracked<T> {
    fn eq(&self, other: &Self) -> bool {
        self.revision == other.revision || self.value == other.value
    }
}

/// A derived value, kept until its key (the revisions that it is derived from) changes.
#[derive(Debug)]
pub(crate) struct Memo<K, V> {
    kept: RefCell<Option<(K, Arc<V>)>>,
    derived: Cell<u64>,
}

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self {
            kept: RefCell::default(),
            derived: Cell::default(),
        }
    }
}

impl<K: PartialEq, V> Memo<K, V> {
    /// The value for `key`; `derive` is called if the last one was for another key.
    pub(crate) fn get(&self, key: K, derive: impl FnOnce() -> V) -> Arc<V> {
        if let Some((known, value)) = &*self.kept.borrow()
            && *known == key
        {
            return Arc::clone(value);
        }
        let value = Arc::new(derive());
        self.derived.set(self.derived.get() + 1);
        *self.kept.borrow_mut() = Some((key, Arc::clone(&value)));
        value
    }

    /// How many times it was derived.
    pub(crate) fn derived(&self) -> u64 {
        self.derived.get()
    }
}
