//! Many neurons: circuits, scenes and simulation reports.
//!
//! # A tour
//!
//! A **circuit** is opened by its configuration, or by the folder that has one; one of Snudda by its HDF5 file. It holds
//! **populations** of **nodes**, each with a place, a rotation and the name of a morphology, and
//! **templates**: the distinct morphology files, which are read when they are first asked for, and
//! once.
//!
//! ```no_run
//! use neurotess_circuit::{Circuit, Groups, Selection, read_all, soma_center};
//!
//! let circuit = Circuit::open("circuit_config.json")?;
//! for failure in &circuit.failures {
//!     eprintln!("{failure}"); // parts that could not be opened; the rest is there
//! }
//!
//! // A **selection** chooses nodes: by id, node set, box, or a sample.
//! let selection = Selection { sample: Some((1000, 1)), ..Selection::default() };
//! let nodes = circuit.select(&selection)?;
//!
//! // **Instances** are what a renderer needs: template, place, id, group for the color.
//! let groups = Groups::by(&circuit.populations, "layer");
//! let instances = circuit.instances(&nodes, Some(&groups));
//! read_all(instances.iter().map(|i| &circuit.templates[i.template.index()]));
//! for instance in &instances {
//!     let Ok(read) = circuit.templates[instance.template.index()].read() else { continue };
//!     let world_from_cell = instance.world_from_cell(soma_center(&read.morphology));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A **report** has values of a simulation for **compartments**, pieces of sections, frame by frame; of a
//! file far larger than memory only what is asked for is read. **Spikes** flash and decay.
//!
//! ```no_run
//! use neurotess_circuit::{Report, Spikes};
//!
//! let report = Report::open("voltage.h5")?;
//! let values = &report.populations[0];
//! let frame = values.time.frame_at(12.5).ok_or("no frame at 12.5 ms")?;
//! let compartments: Vec<u64> = values.compartment_range(0).collect();
//! for (value, compartment) in values.values(frame, &compartments)?.iter().zip(values.compartments(0)?) {
//!     println!("section {} at {}: {value} {}", compartment.section, compartment.along, values.units);
//! }
//! for (node, brightness) in Spikes::open("spikes.h5")?.populations[0].flashes(12.5, 5.0) {
//!     println!("{node} flashes: {brightness}");
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Coordinates of circuits are `f64`: at 10⁴ µm `f32` resolves 0.001 µm only.
#![forbid(unsafe_code)]

mod blue_config;
mod compartment_sets;
mod declared;
mod edges;
mod error;
mod groups;
mod hdf5;
mod inputs;
mod json;
mod listed;
mod manifest;
mod membranes;
mod model;
mod node_sets;
mod nsol;
mod open;
mod placed;
mod places;
mod points;
mod population;
mod report;
mod scene;
mod sections;
mod select;
mod snudda;
mod sonata;
mod table;
mod template;
mod transform;
mod warning;
pub mod write;

pub use compartment_sets::{CompartmentSet, SetPlace};
pub use declared::{DeclaredReport, Elements};
pub use edges::{Edges, SynapseSide, Synapses};
pub use error::{CircuitError, Fault};
pub use groups::{Groups, natural};
pub use membranes::CellMembrane;
pub use model::{Circuit, Instance};
pub use node_sets::NodeSets;
pub use open::is_circuit;
pub use places::PlaceTable;
pub use points::{PointTable, is_point_table};
pub use population::{Attribute, NodeRef, Population};
pub use report::{
    RecordingFile, Report, ReportKind, ReportPopulation, SpikePopulation, Spikes, TimeAxis,
    is_recording,
};
pub use scene::color;
pub use sections::Compartment;
pub use select::Selection;

pub use template::{Template, TemplateId, read_all, soma_center};
pub use warning::Warning;
