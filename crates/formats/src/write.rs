//! Writing in any format.

use std::io::{self, Write};

use neurotess_morphology::Morphology;

#[cfg(feature = "asc")]
use crate::asc;
use crate::format::Format;
#[cfg(feature = "h5")]
use crate::h5;
use crate::losses::Losses;
#[cfg(feature = "neuroml")]
use crate::neuroml;
use crate::swc;
use crate::warning::Warning;

/// Writes a morphology, and tells what the format cannot say of it.
///
/// # Errors
/// Those of the writer; [`io::ErrorKind::Unsupported`] for a format that is only read, or that this build
/// has no feature for.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(
    morphology: &Morphology,
    format: Format,
    writer: impl Write,
) -> io::Result<Vec<Warning>> {
    match format {
        Format::Swc => swc::write(morphology, writer).map(|()| {
            let mut losses = Losses::default();
            losses.spines(morphology);
            losses.into_warnings()
        }),
        #[cfg(feature = "asc")]
        Format::Asc => asc::write(morphology, writer),
        #[cfg(feature = "h5")]
        Format::H5 => h5::write(morphology, writer),
        #[cfg(feature = "neuroml")]
        Format::NeuroMl => neuroml::write(morphology, writer),
        #[cfg(not(all(feature = "asc", feature = "h5", feature = "neuroml")))]
        other if Format::WRITTEN.contains(&other) => {
            Err(io::Error::new(io::ErrorKind::Unsupported, other.missing()))
        }
        _ => Err(io::ErrorKind::Unsupported.into()),
    }
}
