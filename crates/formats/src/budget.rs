//! How much may be made of a file.
//!
//! A packed file of some kilobytes can hold gigabytes of equal numbers: 165 kB of deflated zeros became 10 million points and
//! took 3.2 GB. So what is made of a file has a budget: 20 times its size and 100 MB. Tracings become five times smaller by
//! packing, circuits of a million nodes with constant columns ten times. Whoever knows that a file is right says so.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Bytes that may be made of one of the file.
const FACTOR: u64 = 20;
/// Bytes that may be made of any file.
const FREE: u64 = 100_000_000;

static ALLOWED: AtomicBool = AtomicBool::new(false);

/// From now on, this process makes of files whatever they hold.
pub fn allow_large() {
    ALLOWED.store(true, Ordering::Relaxed);
}

/// Most bytes that may be made of a file of this size.
pub fn most(file: u64) -> u64 {
    match ALLOWED.load(Ordering::Relaxed) {
        true => u64::MAX,
        false => file.saturating_mul(FACTOR).saturating_add(FREE),
    }
}

/// What has been made of a file so far.
#[derive(Debug)]
pub struct Budget {
    file: u64,
    made: AtomicU64,
}

/// More would be made of a file than is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overdrawn {
    /// Bytes that would be made of it in all.
    pub made: u64,
    /// Bytes of the file.
    pub file: u64,
    /// Most bytes that may be made of it.
    pub most: u64,
}

impl Budget {
    /// Of a file of this size.
    pub fn new(file: u64) -> Self {
        Self {
            file,
            made: AtomicU64::new(0),
        }
    }

    /// Takes so many bytes.
    ///
    /// # Errors
    /// They are more than what is left.
    pub fn take(&self, bytes: u64) -> Result<(), Overdrawn> {
        let before = self.made.fetch_add(bytes, Ordering::Relaxed);
        self.allows(before.saturating_add(bytes))
    }

    /// Whether so many bytes may be made at a time, which are not kept.
    ///
    /// # Errors
    /// They are more than may be made in all.
    pub fn allows(&self, made: u64) -> Result<(), Overdrawn> {
        let (file, most) = (self.file, most(self.file));
        match made <= most {
            true => Ok(()),
            false => Err(Overdrawn { made, file, most }),
        }
    }
}
