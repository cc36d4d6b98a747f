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
use crate::swc::{self, SampleNumbers};
use crate::warning::Warning;
use crate::{ReadOptions, read_bytes};

/// Writes a morphology as [`write_numbered`] does, the samples of SWC with numbers that ascend.
///
/// # Errors
/// As [`write_numbered`].
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(
    morphology: &Morphology,
    format: Format,
    writer: impl Write,
) -> io::Result<Vec<Warning>> {
    write_numbered(morphology, format, SampleNumbers::default(), writer)
}

/// Writes a morphology, and tells what the format cannot say of it. What was written is read back, and where its
/// measures (points, forks, length, the soma's radius) are others, or NEURON's numbers of sections, that is told with the
/// numbers: nothing is lost in silence. Needs memory for the whole file. `numbers`: of samples, in SWC alone.
///
/// # Errors
/// Those of the writer; [`io::ErrorKind::Unsupported`] for a format that is only read, or that this build
/// has no feature for.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write_numbered(
    morphology: &Morphology,
    format: Format,
    numbers: SampleNumbers,
    mut writer: impl Write,
) -> io::Result<Vec<Warning>> {
    let mut bytes = Vec::new();
    let mut lost = write_unchecked(morphology, format, numbers, &mut bytes)?;
    let mut losses = Losses::default();
    match read_bytes(bytes.clone(), "copy", Some(format), &ReadOptions::default()) {
        Ok(copy) => {
            losses.between(&Measures::of(morphology), &Measures::of(&copy.morphology));
            losses.sections(morphology, &copy.morphology);
        }
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
    numbers: SampleNumbers,
    writer: impl Write,
) -> io::Result<Vec<Warning>> {
    match format {
        Format::Swc => swc::write_numbered(morphology, numbers, writer),
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
