//! Stamps of contents: equal stamps, equal contents. What is derived from something keeps its stamp and
//! need not look at it again until that is another one.

use std::cell::{Cell, RefCell};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

static NEXT: AtomicU64 = AtomicU64::new(1);

/// The stamp of a content. A copy of the content has the same one, so an undo brings the old stamp back.
/// The default is that of what is empty.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Revision(u64);

impl Revision {
    /// One that nothing has had before.
    pub fn next() -> Self {
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// A value whose stamp changes whenever it may have been changed.
#[derive(Clone, Debug, Default)]
pub struct Tracked<T> {
    value: T,
    revision: Revision,
}

impl<T> Tracked<T> {
    /// The stamp of the value.
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

impl<T> DerefMut for Tracked<T> {
    fn deref_mut(&mut self) -> &mut T {
        self.revision = Revision::next();
        &mut self.value
    }
}

impl<T: PartialEq> PartialEq for Tracked<T> {
    fn eq(&self, other: &Self) -> bool {
        self.revision == other.revision || self.value == other.value
    }
}

/// Something derived, kept until what it is derived from has another stamp.
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
    /// What is derived from `key`.
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

    /// How often it was derived.
    pub(crate) fn derived(&self) -> u64 {
        self.derived.get()
    }
}
