//! Why a file cannot be read, and what to do about it.

use std::fmt;
use std::io;

use thiserror::Error;

/// A file that cannot be read. Displays as `FILE:LINE: what: what to do`.
#[derive(Debug, Error)]
pub struct ReadError {
    /// The file as it was named.
    pub file: String,
    /// Line, from 1 on; `None` where the fault has none.
    pub line: Option<u64>,
    /// What is wrong.
    #[source]
    pub fault: Fault,
}

impl ReadError {
    /// A fault with its line in a file.
    pub(crate) fn at(file: &str, (line, fault): (u64, Fault)) -> Self {
        Self {
            file: file.into(),
            line: Some(line),
            fault,
        }
    }

    /// A fault of a file that has no lines.
    pub(crate) fn of_file(file: &str, fault: Fault) -> Self {
        Self {
            file: file.into(),
            line: None,
            fault,
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.fault),
            None => write!(f, "{}: {}", self.file, self.fault),
        }
    }
}

/// What is wrong with a file. Displays as `what: what to do`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Fault {
    /// The system would not read it.
    #[error("cannot be read ({0}): check the path and its permissions")]
    Io(io::Error),
    /// Neither name nor content tell the format.
    #[error(
        "not a format known by its name or content: give SWC (.swc, .eswc), Neurolucida (.asc, .xml), H5 (.h5), \
         NeuroML (.nml), SNT (.traces), KNOSSOS (.nml), or MouseLight's or CATMAID's JSON (.json)"
    )]
    UnknownFormat,
    /// A format of tracings that is not read.
    #[error("the file is {format}, which is not read: {remedy}")]
    Foreign {
        /// Its name.
        format: &'static str,
        /// The way out.
        remedy: &'static str,
    },
    /// XML of another kind.
    #[error(
        "the XML is <{root}>, no tracing: give NeuroML (<neuroml>), SNT's traces (<tracings>), webKnossos' or \
         KNOSSOS' skeletons (<things>) or Neurolucida XML (<mbf>)"
    )]
    OtherXml {
        /// Name of its outermost element.
        root: String,
    },
    /// JSON of another kind.
    #[error(
        "the JSON is no tracing that is known: give a neuron as MouseLight exports it, or a skeleton of CATMAID \
         (compact-skeleton)"
    )]
    OtherJson,
    /// The format is known, but this build was made without it.
    #[error("this build of neurotess has no '{feature}': build it with that feature")]
    NotBuiltIn {
        /// The feature.
        feature: &'static str,
    },
    /// Packed by gzip, and not whole.
    #[error("the gzip is broken ({reason}): fetch or pack the file again")]
    Packed {
        /// What the library says.
        reason: String,
    },
    /// Packed, and far larger than any tracing.
    #[error(
        "it unpacks to more than {most} bytes, which no tracing does: if you trust it, use --allow-large (in Python \
         allow_large=True), or unpack it by hand"
    )]
    PackedTooLarge {
        /// Bytes that were allowed.
        most: u64,
    },
    /// Not a byte.
    #[error("the file is empty: fetch or export it again")]
    Empty,
    /// Comments or blanks and nothing else.
    #[error("no sample in the file: check whether the export or the download was complete")]
    NoSample,
    /// Two bytes a letter.
    #[error("the text is UTF-16: save it as UTF-8 or plain ASCII")]
    Utf16,
    /// A NUL byte.
    #[error("the file is binary where text was expected: check which format this is")]
    Binary,
    /// A web page.
    #[error("the file is a web page, not a morphology: the download failed, fetch it again")]
    Html,
    /// A row is too short.
    #[error(
        "{found} columns instead of 7 (number, type, x, y, z, radius, parent): \
         add the missing ones"
    )]
    Columns {
        /// How many there are.
        found: usize,
    },
    /// A field is not a number at all.
    #[error("{column} is not a number but {text:?}: correct it or remove the row")]
    NotANumber {
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// A field is a number but has no place in an integer column.
    #[error("{column} is not a whole number in range but {text:?}: number the samples anew")]
    NotWhole {
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// NaN, infinite, or beyond what the model holds.
    #[error("{column} is {text}, not finite or out of range: correct it or remove the row")]
    OutOfRange {
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// Commas within numbers.
    #[error("commas seem to be decimal marks: write numbers with points")]
    DecimalComma,
    /// Two samples have the same number.
    #[error("sample {id} stands in line {first_line} already: number the samples anew")]
    RepeatedId {
        /// The number.
        id: i64,
        /// Line of the first.
        first_line: u64,
    },
    /// The sample hangs on itself.
    #[error("sample {id} is its own parent: give its parent, or -1 for a root")]
    SelfParent {
        /// Its number.
        id: i64,
    },
    /// The parent is not in the file.
    #[error("sample {id} has parent {parent}, which is not in the file: add it, or use -1")]
    UnknownParent {
        /// Number of the child.
        id: i64,
        /// Number that no sample has.
        parent: i64,
    },
    /// The sample is its own ancestor.
    #[error("sample {id} is its own ancestor: break the cycle of parents")]
    Cycle {
        /// Number of the first sample in the cycle.
        id: i64,
    },
    /// A point is its own ancestor, in a format that does not number points.
    #[error("the point is its own ancestor: break the cycle of parents")]
    OwnAncestor,
    /// Something that begins has no end.
    #[error("a {what} is not closed: check whether the file was cut short")]
    Unclosed {
        /// What begins in this line.
        what: &'static str,
    },
    /// A sign has no place here.
    #[error("{found:?} stands where {expected} was expected: check the brackets above")]
    Unexpected {
        /// What stands there.
        found: String,
        /// What should.
        expected: &'static str,
    },
    /// Points or children after the end of a branch.
    #[error("a branch goes on after {after}: close it, or begin the next one with |")]
    BranchGoesOn {
        /// What ended it.
        after: &'static str,
    },
    /// A point has too few numbers.
    #[error("a point of {found} numbers instead of 4 (x, y, z, diameter): add the missing ones")]
    PointNumbers {
        /// How many there are.
        found: usize,
    },
    /// XML itself is broken.
    #[error("the XML is broken ({reason}): export the file again")]
    Xml {
        /// What the library says.
        reason: String,
    },
    /// JSON itself is broken, or lacks what a tracing has.
    #[error("the JSON is not what it should be ({reason}): export the file again")]
    Json {
        /// What the library says.
        reason: String,
    },
    /// An attribute is missing or not what it should be.
    #[error("<{element}> has {attribute}={text:?}, which is missing or out of range: correct it")]
    Attribute {
        /// The element's name.
        element: String,
        /// The attribute's name.
        attribute: &'static str,
        /// What stands there; empty if nothing.
        text: String,
    },
    /// A unit of length that is none.
    #[error("{unit:?} is no unit of length that is known: write nanometer or micrometer")]
    Unit {
        /// What stands there.
        unit: String,
    },
    /// XML without a cell.
    #[error("no <morphology> or <segments> with a <segment>: look for the file that has the cell")]
    NoMorphology,
    /// XML of a tracing without one.
    #[error("the <{root}> has no <{element}> with points: look for the file that has the tracing")]
    NoElement {
        /// Its outermost element.
        root: &'static str,
        /// What should be in it.
        element: &'static str,
    },
    /// Two paths have the same number.
    #[error("path {id} stands in line {first_line} already: number the paths anew")]
    RepeatedPath {
        /// The number.
        id: i64,
        /// Line of the first.
        first_line: u64,
    },
    /// A path starts on another that is not in the file.
    #[error("path {id} starts on path {parent}, which is not in the file: add it")]
    UnknownPath {
        /// Number of the path.
        id: i64,
        /// Number that no path has.
        parent: i64,
    },
    /// An edge between nodes that are not in the file.
    #[error("an edge names node {id}, which is not in the file: add the node or remove the edge")]
    UnknownEnd {
        /// Number that no node has.
        id: i64,
    },
    /// Two segments have the same number.
    #[error("segment {id} stands in line {first_line} already: number the segments anew")]
    RepeatedSegment {
        /// The number.
        id: i64,
        /// Line of the first.
        first_line: u64,
    },
    /// The parent is not in the cell.
    #[error("segment {id} has parent {parent}, which is not in the cell: add it")]
    UnknownSegment {
        /// Number of the child.
        id: i64,
        /// Number that no segment has.
        parent: i64,
    },
    /// A segment has no end where it needs one.
    #[error("segment {id} has no <{end}>: add it")]
    NoEnd {
        /// Its number.
        id: i64,
        /// Which end.
        end: &'static str,
    },
    /// HDF5 itself is broken, or a dataset is not there.
    #[error("{place} cannot be read as HDF5 ({reason}): fetch or export the file again")]
    Hdf5 {
        /// The file, or the dataset's path.
        place: String,
        /// What the library says.
        reason: String,
    },
    /// HDF5 without the datasets of a morphology.
    #[error(
        "the file has no datasets 'points' and 'structure': it is HDF5, but not a morphology; \
         check which file this is"
    )]
    NoTables,
    /// A dataset of another shape.
    #[error(
        "dataset '{dataset}' has shape {found:?} instead of rows of {columns}: export it again"
    )]
    Shape {
        /// Its path.
        dataset: String,
        /// Its shape.
        found: Vec<u64>,
        /// How many columns there should be.
        columns: usize,
    },
    /// A dataset declares more than there is.
    #[error(
        "dataset '{dataset}' declares {declared} bytes, but the file can hold {possible} at most: \
         fetch or export the file again"
    )]
    Declared {
        /// Its path.
        dataset: String,
        /// What its header says.
        declared: u64,
        /// What the file has room for.
        possible: u64,
    },
    /// More would be made of the file than is likely.
    #[error(
        "dataset '{dataset}' would become {made} bytes of a file of {file}, more than the {most} that are allowed: if the file is right, use \
         --allow-large (in Python allow_large=True)"
    )]
    Large {
        /// The dataset's path.
        dataset: String,
        /// Bytes that are made, with those of the datasets before.
        made: u64,
        /// Bytes of the file.
        file: u64,
        /// Bytes that are allowed.
        most: u64,
    },
    /// A row of a dataset is wrong.
    #[error("dataset '{dataset}', row {row}: {fault}")]
    Row {
        /// The dataset's path.
        dataset: String,
        /// The row, from 0 on, as HDF5 counts.
        row: u64,
        /// What is wrong with it.
        fault: Box<Fault>,
    },
    /// A number in a table of sections points nowhere.
    #[error("the {column} points nowhere or is not allowed: export the file again")]
    Reference {
        /// The column.
        column: &'static str,
    },
    /// Many morphologies in one file.
    #[error(
        "the file is a container of {count} morphologies: name one after the file's name and a #, \
         as in FILE#{first}"
    )]
    Container {
        /// How many.
        count: usize,
        /// Path of the first.
        first: String,
    },
    /// A container without the morphology that is asked for.
    #[error(
        "no morphology '{member}' is in the file, which has {count}: name another one, as in \
         FILE#{first}"
    )]
    NoMember {
        /// What was asked for.
        member: String,
        /// How many there are.
        count: usize,
        /// Path of the first; empty if there is none.
        first: String,
    },
    /// Skeletons of neuroglancer that are broken.
    #[error("the precomputed skeletons are not what they should be ({reason}): export them again")]
    Precomputed {
        /// What is wrong.
        reason: String,
    },
    /// A skeleton that no shard has.
    #[error("no shard has skeleton {id}: check the id, and whether all shards were fetched")]
    NoSkeleton {
        /// Its id.
        id: u64,
    },
    /// Blood vessels.
    #[error("the file is a vasculature, not a neuron: vessels are graphs and cannot be read")]
    Vasculature,
    /// More samples than 32 bits can count.
    #[error("more than 4 billion samples: split the file")]
    TooMany,
    /// A warning, read strictly.
    #[error("{message} ({code}): mend the file, or read without --strict")]
    Strict {
        /// The warning's code.
        code: &'static str,
        /// Its message.
        message: String,
    },
}
