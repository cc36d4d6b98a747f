//! Instead of the encoder and decoder, where the feature `draco` is off.

use super::{Attribute, Decoded, DracoError, Encoded};

pub(super) fn encode(_: &[[u32; 3]], _: &[Attribute<'_>], _: usize) -> Result<Encoded, DracoError> {
    Err(DracoError::Absent)
}

pub(super) fn decode(_: &[u8]) -> Result<Decoded, DracoError> {
    Err(DracoError::Absent)
}
