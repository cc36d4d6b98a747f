//! What makes a fair surface of one that was cut, or that is not to be: pieces that are of no use are left out, sheets that
//! touch or cross a little parted, seams tidied and smoothed.

pub(crate) mod parts;
pub(crate) mod places;
pub(crate) mod press;
pub(crate) mod smooth;
pub(crate) mod tidy;
pub(crate) mod touch;
