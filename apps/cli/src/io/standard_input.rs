//! Reads standard input as a whole.

use std::io::{self, Read};

use crate::report::Failure;

/// Number of bytes that decide whether the rest is worth reading.
const HEAD: u64 = 1 << 16;

/// Most bytes of standard input.
const MOST: u64 = 1 << 32;

/// All of standard input; or only its beginning, if `useless` returns true for that.
pub(crate) fn standard_input(useless: impl Fn(&[u8]) -> bool) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let mut input = io::stdin().lock();
    let mut read = input.by_ref().take(HEAD).read_to_end(&mut bytes);
    if read.is_ok() && !useless(&bytes) {
        read = input.take(MOST).read_to_end(&mut bytes);
    }
    match read {
        Ok(_) if (bytes.len() as u64) < MOST => Ok(bytes),
        Ok(_) => Err(Failure(
            "-: standard input has no end, or more than 4 GB: give a file".into(),
        )),
        Err(e) => Err(Failure(format!(
            "-: standard input cannot be read ({e}): check where it comes from"
        ))),
    }
}
