//! Writing in any format.

use std::io::{self, Write};

use neurotess_morphology::{Measures, Morphology};

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
use crate::{ReadOptions, read_bytes};

/// Writes a morphology, and tells what the format cannot say of it. What was written is read back, and where its
/// measures (points, forks, length, the soma's radius) are others, that is told with the numbers: nothing is lost in
/// silence. Needs memory for the whole file.
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
    mut writer: impl Write,
) -> io::Result<Vec<Warning>> {
    let mut bytes = Vec::new();
    let mut lost = write_unchecked(morphology, format, &mut bytes)?;
    let mut losses = Losses::default();
    match read_bytes(bytes.clone(), "copy", Some(format), &ReadOptions::default()) {
        Ok(copy) => losses.between(&Measures::of(morphology), &Measures::of(&copy.morphology)),
        Err(e) => losses.add(
            "not_read_back",
            &format!("what was written cannot be read: {e}"),
            1,
        ),
    }
    writer.write_all(&bytes)?;
    writer.flush()?;
    lost.extend(losses.into_warnings());
    Ok(lost)
}

fn write_unchecked(
    morphology: &Morphology,
    format: Format,
    writer: impl Write,
) -> io::Result<Vec<Warning>> {
    match format {
        Format::Swc => swc::write(morphology, writer),
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
