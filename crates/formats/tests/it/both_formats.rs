//! ASC and HDF5: written, read, and what comes back in both.

use neurotess_formats::{ReadOptions, Warning, asc, h5};
use neurotess_morphology::Morphology;

pub(crate) type Write = fn(&Morphology, &mut Vec<u8>) -> Vec<Warning>;
pub(crate) type Read = fn(&[u8]) -> Morphology;

pub(crate) fn as_asc(m: &Morphology, bytes: &mut Vec<u8>) -> Vec<Warning> {
    asc::write(m, bytes).expect("memory takes it")
}

pub(crate) fn as_h5(m: &Morphology, bytes: &mut Vec<u8>) -> Vec<Warning> {
    h5::write(m, bytes).expect("memory takes it")
}

pub(crate) fn from_asc(bytes: &[u8]) -> Morphology {
    let read = asc::read_bytes(bytes, "cell.asc", &ReadOptions::default());
    read.expect("our own file").morphology
}

pub(crate) fn from_h5(bytes: &[u8]) -> Morphology {
    let read = h5::read_bytes(bytes.to_vec(), "cell.h5", &ReadOptions::default());
    read.expect("our own file").morphology
}

pub(crate) const FORMATS: [(Write, Read); 2] = [(as_asc, from_asc), (as_h5, from_h5)];

/// What both formats can say comes back to the bit: positions, radii, sections and their types.
pub(crate) fn assert_same_neurites(a: &Morphology, b: &Morphology) {
    assert_eq!(a.points, b.points);
    let sections = |m: &Morphology| -> Vec<_> {
        let section = |s: &neurotess_morphology::Section| (s.kind, s.first, s.end, s.parent());
        m.sections.iter().map(section).collect()
    };
    assert_eq!(sections(a), sections(b));
}

/// What was lost, by code.
pub(crate) fn codes(losses: &[Warning]) -> Vec<&str> {
    losses.iter().map(|w| w.code).collect()
}
