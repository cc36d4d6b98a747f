//! Formats of tracings that are not read, so that errors call them by their names.

use crate::Fault;
use crate::text::begin;

/// The name of a format and the way out.
struct Foreign(&'static str, &'static str);

/// How the content of a file begins, or what is near its beginning.
enum Sign {
    Begins(&'static [u8]),
    Has(&'static [u8]),
}

const SIGNS: [(Sign, Foreign); 12] = [
    (
        Sign::Begins(b"PK\x03\x04"),
        Foreign("a zip archive", "unpack it and give the file that is in it"),
    ),
    (
        Sign::Begins(b"# AmiraMesh"),
        Foreign("an Amira graph", "export SWC from Amira"),
    ),
    (
        Sign::Begins(b"# Avizo"),
        Foreign("an Avizo graph", "export SWC from Avizo"),
    ),
    (
        Sign::Begins(b"MATLAB 5.0 MAT-file"),
        Foreign(
            "MATLAB data, as the TREES toolbox has it",
            "export SWC by its swc_tree",
        ),
    ),
    (
        Sign::Begins(b"//genesis"),
        Foreign(
            "a cell of GENESIS",
            "convert it to SWC by NLMorphologyConverter",
        ),
    ),
    (
        Sign::Has(b"*cartesian"),
        Foreign(
            "a cell of GENESIS",
            "convert it to SWC by NLMorphologyConverter",
        ),
    ),
    (
        Sign::Has(b"neuroglancer_"),
        Foreign(
            "the description of skeletons or meshes of neuroglancer",
            "give FOLDER/ID, or the folder for all of its skeletons",
        ),
    ),
    (Sign::Has(b"pt3dadd("), HOC),
    (Sign::Has(b"load_file("), HOC),
    (Sign::Has(b"create soma"), HOC),
    (Sign::Has(b"begintemplate "), HOC),
    (Sign::Begins(b"{create"), HOC),
];

const HOC: Foreign = Foreign(
    "hoc, a program for NEURON",
    "export SWC or NeuroML from NEURON, as by its ModelView",
);

/// Bytes in which signs are looked for.
const BEGINNING: usize = 1 << 16;

/// The fault of a file of a known format that is not read.
pub(crate) fn of_content(bytes: &[u8]) -> Option<Fault> {
    let text = begin(bytes);
    let start = &text[..text.len().min(BEGINNING)];
    let shows = |sign: &Sign| match *sign {
        Sign::Begins(with) => text.starts_with(with),
        Sign::Has(part) => memchr::memmem::find(start, part).is_some(),
    };
    let (_, Foreign(format, remedy)) = SIGNS.iter().find(|(sign, _)| shows(sign))?;
    Some(Fault::Foreign { format, remedy })
}
