//! Why a circuit, a scene or a report cannot be read, and what to do about it.

use std::fmt;
use std::io;
use std::path::Path;

use thiserror::Error;

/// A file of a circuit that cannot be read. Displays as `FILE:LINE: 'KEY': what: what to do`, line and key where
/// there are such.
#[derive(Debug, Error)]
pub struct CircuitError {
    /// The file as it was named.
    pub file: String,
    /// Line of a text, from 1 on.
    pub line: Option<u32>,
    /// Key within a JSON file (`networks.nodes[0].nodes_file`), path of an HDF5 dataset, element or column
    /// of a text; `None` if it is about the whole file or line.
    pub key: Option<String>,
    /// What is wrong.
    #[source]
    pub fault: Fault,
}

impl CircuitError {
    pub(crate) fn new(file: &str, key: impl Into<String>, fault: Fault) -> Self {
        Self {
            file: file.into(),
            line: None,
            key: Some(key.into()),
            fault,
        }
    }

    pub(crate) fn of_file(file: &str, fault: Fault) -> Self {
        Self {
            file: file.into(),
            line: None,
            key: None,
            fault,
        }
    }

    /// `key`: what of the line it is about; empty: all of it.
    pub(crate) fn at_line(file: &str, line: u64, key: &str, fault: Fault) -> Self {
        Self {
            file: file.into(),
            line: u32::try_from(line).ok(),
            key: (!key.is_empty()).then(|| key.into()),
            fault,
        }
    }

    pub(crate) fn io(path: &Path, error: io::Error) -> Self {
        Self::of_file(&path.display().to_string(), Fault::Io(error))
    }
}

impl fmt::Display for CircuitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.file)?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        if let Some(key) = &self.key {
            write!(f, " '{key}':")?;
        }
        write!(f, " {}", self.fault)
    }
}

/// What is wrong with a file of a circuit. Displays as `what: what to do`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Fault {
    /// The system would not read it.
    #[error("cannot be read ({0}): check the path and its permissions")]
    Io(io::Error),
    /// A path that a configuration names does not exist.
    #[error("{path} does not exist: correct the path, or fetch the missing part")]
    NoFile {
        /// The path after variables are replaced.
        path: String,
    },
    /// A folder without a configuration, or with several.
    #[error(
        "no circuit in this folder that could be told from others ({found}): name its \
         configuration, like circuit_config.json"
    )]
    NoConfig {
        /// What was found instead.
        found: String,
    },
    /// JSON, but neither circuit nor simulation.
    #[error("neither 'networks' nor 'network' is in it: give the configuration of a circuit")]
    NotACircuit,
    /// Text that is no JSON.
    #[error("not JSON ({reason}): correct it there")]
    Json {
        /// What the library says.
        reason: String,
    },
    /// Text that is no scene.
    #[error("not a scene ({reason}): correct it, see docs/circuits.md")]
    Scene {
        /// What the library says.
        reason: String,
    },
    /// XML itself is broken.
    #[error("the XML is broken ({reason}): export the file again")]
    Xml {
        /// What the library says.
        reason: String,
    },
    /// A key is not there.
    #[error("is missing: add it")]
    Missing,
    /// A value of another type.
    #[error("is {found} instead of {expected}: correct it")]
    Type {
        /// What is there.
        found: String,
        /// What should be.
        expected: &'static str,
    },
    /// A variable that the manifest does not define.
    #[error("variable ${name} is not in the manifest: define it there, or correct its name")]
    UnknownVariable {
        /// Its name without the dollar sign.
        name: String,
    },
    /// A variable, or a node set, is defined by itself.
    #[error("is defined by itself ({way}): break the cycle")]
    Cycle {
        /// The way around.
        way: String,
    },
    /// HDF5 is broken, or an object is not there.
    #[error("cannot be read as HDF5 ({reason}): fetch or export the file again")]
    Hdf5 {
        /// What the library says.
        reason: String,
    },
    /// A file where a folder of morphologies, or a container of them, is expected.
    #[error(
        "neither a folder of morphologies nor an HDF5 file that has each in a group with 'points' and \
         'structure' ({reason}): correct the configuration, or fetch the file again"
    )]
    NotAContainer {
        /// What it is instead.
        reason: String,
    },
    /// A dataset of another shape.
    #[error("has shape {found:?} instead of {expected}: export the file again")]
    Shape {
        /// Its shape.
        found: Vec<u64>,
        /// What it should be.
        expected: String,
    },
    /// A dataset declares more than there is.
    #[error(
        "declares {declared} bytes, but the file can hold {possible} at most: fetch or export the \
         file again"
    )]
    Declared {
        /// What its header says.
        declared: u64,
        /// What the file has room for.
        possible: u64,
    },
    /// More would be made of the file than is likely.
    #[error(
        "would become {made} bytes of a file of {file}, more than the {most} that are allowed: if the file is right, use \
         --allow-large (in Python allow_large=True)"
    )]
    Large {
        /// Bytes that are made, with those of the datasets before.
        made: u64,
        /// Bytes of the file.
        file: u64,
        /// Bytes that are allowed.
        most: u64,
    },
    /// A number that points beyond an array.
    #[error("row {row} is {value}, but only {limit} are there: export the file again")]
    Range {
        /// The row, from 0 on.
        row: u64,
        /// What stands there.
        value: i64,
        /// How many there are.
        limit: u64,
    },
    /// A number that is none of those that can stand there.
    #[error("row {row} is {value} instead of {expected}: correct it, or export the file again")]
    Row {
        /// The row, from 0 on.
        row: u64,
        /// What stands there.
        value: String,
        /// What should.
        expected: &'static str,
    },
    /// NaN or infinite numbers where a place should be.
    #[error("row {row} is {value}, as are {count} in all: these cells are left out, correct them")]
    NotFinite {
        /// The first such row, from 0 on.
        row: u64,
        /// What stands there.
        value: f64,
        /// How many there are.
        count: u64,
    },
    /// A quaternion of no length.
    #[error(
        "row {row} is a zero quaternion, as are {count} in all: these cells are left out, correct them"
    )]
    ZeroQuaternion {
        /// The first such row, from 0 on.
        row: u64,
        /// How many there are.
        count: u64,
    },
    /// Matrices that turn nothing rigidly.
    #[error(
        "row {row} is no rotation, as are {count} in all: these cells are left out, correct them"
    )]
    NotARotation {
        /// The first such row, from 0 on.
        row: u64,
        /// How many there are.
        count: u64,
    },
    /// HDF5 without the neurons of a network of Snudda.
    #[error(
        "is not in this HDF5 file: give Snudda's network-synapses.hdf5, or of SONATA the configuration, like \
         circuit_config.json"
    )]
    NotANetwork,
    /// A configuration of Blue Brain's before SONATA.
    #[error(
        "a BlueConfig, which is not read: its cells are in {cells}; {way} a circuit_config.json that names \
         them and open that, see docs/circuits.md#blueconfig"
    )]
    BlueConfig {
        /// The file of its cells.
        cells: String,
        /// How those become SONATA's nodes.
        way: &'static str,
    },
    /// Cells in Blue Brain's formats before SONATA.
    #[error(
        "{format} is not read: {way} a circuit_config.json that names the cells and open that, see \
         docs/circuits.md#blueconfig"
    )]
    Mvd {
        /// MVD2 or MVD3.
        format: &'static str,
        /// How they become SONATA's nodes.
        way: &'static str,
    },
    /// One to three of a quaternion's four components.
    #[error("is missing while other components of the quaternion are there: add it")]
    PartialQuaternion,
    /// A transform that a rigid cell cannot follow.
    #[error("is no rotation, translation and uniform scale: correct it")]
    Transform,
    /// A population that the file does not have.
    #[error("population '{name}' is not there, only {there}: correct its name")]
    NoPopulation {
        /// Its name.
        name: String,
        /// Those that are there.
        there: String,
    },
    /// An id that several populations have.
    #[error(
        "populations '{}' and '{}' both have a node {id}: name the population, too",
        populations[0], populations[1]
    )]
    AmbiguousId {
        /// The id.
        id: u64,
        /// Names of two of them.
        populations: [String; 2],
    },
    /// Nothing to show.
    #[error("no population of nodes could be read: see the errors above")]
    NothingRead,
    /// A node set that is not defined.
    #[error("node set '{name}' is not defined, only {there}: correct its name")]
    NoNodeSet {
        /// Its name.
        name: String,
        /// Those that are defined.
        there: String,
    },
    /// A rule about an attribute that no population has.
    #[error("no population has the attribute '{name}': correct it")]
    NoAttribute {
        /// Its name.
        name: String,
    },
    /// A regular expression that is none.
    #[error("not a regular expression ({reason}): correct it")]
    Regex {
        /// What the library says.
        reason: String,
    },
    /// HDF5 without the groups of a report.
    #[error("neither a report nor spikes: it is HDF5, but has no '/report', '/data' or '/spikes'")]
    NotAReport,
    /// A time axis that makes no sense.
    #[error(
        "start {start}, end {end} and step {step} make no axis of time: export the report again"
    )]
    Time {
        /// First frame (ms).
        start: f64,
        /// End, excluded (ms).
        end: f64,
        /// Step (ms).
        step: f64,
    },
    /// Pointers that do not grow or leave the data.
    #[error("pointer {index} is {value}, outside of [{from}, {to}]: export the report again")]
    Pointer {
        /// Which, from 0 on.
        index: u64,
        /// What stands there.
        value: u64,
        /// The one before.
        from: u64,
        /// How many elements there are.
        to: u64,
    },
    /// A frame or an element beyond the report's end.
    #[error("{what} {asked} does not exist, there are {count}: ask for another")]
    Beyond {
        /// Frame or element.
        what: &'static str,
        /// Which was asked for.
        asked: u64,
        /// How many there are.
        count: u64,
    },
    /// A report whose nodes the circuit does not have.
    #[error(
        "{missing} nodes of population '{population}' are not in {circuit}, the first is {first}: \
         give the report of this circuit"
    )]
    OtherCircuit {
        /// The report's population.
        population: String,
        /// The circuit's file.
        circuit: String,
        /// How many nodes are missing.
        missing: u64,
        /// Id of the first.
        first: u64,
    },
    /// A report that is neither a file nor a name of the configuration.
    #[error("no such report: {there}: give one of these, or a file")]
    NoReport {
        /// What there is.
        there: String,
    },
    /// A report of something else than compartments.
    #[error(
        "is of type '{type_name}': its values are those of {elements}s, which membranes do not show; choose a \
         report of compartments, or write a table of it with 'neurotess report'"
    )]
    NotOfSections {
        /// Its type as the configuration has it.
        type_name: String,
        /// What has values, in the singular.
        elements: &'static str,
    },
    /// A row of a table has too few or too many fields.
    #[error("{found} fields instead of {expected}: correct it")]
    Fields {
        /// How many there are.
        found: usize,
        /// How many the header has.
        expected: usize,
    },
    /// A field of a table or an attribute of XML is no number.
    #[error("is not {expected} but {text:?}: correct it")]
    NotANumber {
        /// What was expected.
        expected: &'static str,
        /// What stands there.
        text: String,
    },
    /// More than 32 bits can count.
    #[error("{count} are more than 4 billion: split the file")]
    TooMany {
        /// How many there are.
        count: u64,
    },
}
