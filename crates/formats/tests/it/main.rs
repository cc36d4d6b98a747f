//! Readers and writers of tracings.

#[cfg(all(feature = "asc", feature = "h5"))]
mod both_formats;
mod conventions;
mod faults;
mod foreign;
mod fuzz_swc;
#[cfg(feature = "asc")]
mod growth;
#[cfg(feature = "h5")]
mod h5_files;
#[cfg(feature = "asc")]
mod headers;
#[cfg(feature = "json")]
mod json;
#[cfg(feature = "xml")]
mod knossos;
#[cfg(all(feature = "asc", feature = "h5", feature = "neuroml"))]
mod losses;
#[cfg(all(feature = "neuroml", feature = "xml", feature = "json"))]
mod mutated;
#[cfg(feature = "xml")]
mod neurolucida_xml;
#[cfg(feature = "neuroml")]
mod neuroml;
#[cfg(all(feature = "asc", feature = "h5"))]
mod outlined_round_trip;
mod precomputed;
#[cfg(all(feature = "asc", feature = "h5", feature = "neuroml"))]
mod reference;
mod round_trip;
#[cfg(all(feature = "asc", feature = "h5", feature = "neuroml"))]
mod sections;
#[cfg(all(feature = "asc", feature = "h5"))]
mod spines;
#[cfg(feature = "xml")]
mod traces;
mod variants;

neurotess_testing::main!();
