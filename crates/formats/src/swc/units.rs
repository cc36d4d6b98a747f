//! The unit that a header names: navis writes `# Meta: {…, "units": "8 nanometer", …}`, for cells in voxels, too.

use super::rows::Records;
use crate::unit::micrometers;
use crate::warning::Warnings;

/// What the header says of the unit, in a warning: code, line.
const READ: &str = "units_in_header";

/// Takes positions and radii to micrometers if the header's metadata names another unit. What is kept of the header then
/// names the micrometer, so that a copy is not taken for the other unit again. A unit that is named elsewhere is told.
pub(super) fn apply(records: &mut Records, warnings: &mut Warnings) {
    let said = records
        .header
        .iter()
        .enumerate()
        .find_map(|(place, line)| Some((place, Metadata::of(line)?)));
    if let Some((place, metadata)) = said {
        let line = &records.header[place];
        let unit = &line[metadata.value.clone()];
        let Some(factor) = factor(unit).filter(|&factor| factor != 1.0) else {
            return;
        };
        let message =
            format!("the header gives lengths in units of \"{unit}\": read in micrometers");
        let after = format!(
            "{}1 micrometer{}",
            &line[..metadata.value.start],
            &line[metadata.value.end..]
        );
        records.header[place] = after;
        for node in &mut records.nodes {
            node.position *= factor;
            node.radius *= factor;
        }
        warnings.add(1, READ, &message);
        return;
    }
    let spoken = records.header.iter().find_map(|line| spoken(line));
    if let Some(unit) = spoken {
        let message = format!(
            "the header speaks of {unit}, and the numbers are taken as micrometers: --units changes that"
        );
        warnings.add(1, "unit_not_applied", &message);
    }
}

/// Where a line of metadata names its unit.
struct Metadata {
    /// The unit, without its quotes.
    value: std::ops::Range<usize>,
}

impl Metadata {
    /// Of `Meta: {… "units": "8 nanometer" …}`.
    fn of(line: &str) -> Option<Self> {
        if !line.trim_start().to_ascii_lowercase().starts_with("meta:") {
            return None;
        }
        let key = line.find("\"units\"")? + "\"units\"".len();
        let rest = line[key..].trim_start().strip_prefix(':')?.trim_start();
        let value = rest.strip_prefix('"')?;
        let start = line.len() - value.len();
        let end = start + value.find('"')?;
        Some(Self { value: start..end })
    }
}

/// Micrometers in a unit like `nm`, `8 nanometer` or `0.5 um`; none where it is none of lengths.
fn factor(unit: &str) -> Option<f64> {
    let unit = unit.trim();
    let letters = unit.find(|c: char| c.is_alphabetic() || c == 'µ' || c == 'μ')?;
    let (count, name) = unit.split_at(letters);
    let count = match count.trim() {
        "" => 1.0,
        count => count.parse::<f64>().ok()?,
    };
    let factor = count * micrometers(name)?;
    (factor.is_finite() && factor > 0.0).then_some(factor)
}

/// A unit other than the micrometer in a comment like `units: nm` or `unit = pixels`.
fn spoken(line: &str) -> Option<&str> {
    let lower = line.to_ascii_lowercase();
    let at = lower.find("unit")?;
    if line[..at].ends_with(char::is_alphabetic) {
        return None;
    }
    let rest = line[at..].trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let rest = rest.trim_start().strip_prefix([':', '='])?.trim();
    let word = rest
        .split(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | ')'))
        .find(|word| word.chars().any(char::is_alphabetic))?;
    let is_unknown_length =
        ["pixel", "pixels", "voxel", "voxels", "px"].contains(&word.to_ascii_lowercase().as_str());
    let is_other = micrometers(word).is_some_and(|factor| factor != 1.0);
    (is_other || is_unknown_length).then_some(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_their_micrometers() {
        for (unit, um) in [
            ("8 nanometer", 0.008),
            ("nm", 0.001),
            ("1 micrometer", 1.0),
            ("microns", 1.0),
            ("0.5 µm", 0.5),
            ("2 mm", 2000.0),
        ] {
            let found = factor(unit).expect(unit);
            assert!((found / um - 1.0).abs() < 1e-12, "{unit}: {found}");
        }
        for none in [
            "",
            "8",
            "dimensionless",
            "voxel",
            "-1 nm",
            "nan nm",
            "8 parsecs",
        ] {
            assert_eq!(factor(none), None, "{none}");
        }
    }

    #[test]
    fn comments_that_speak_of_another_unit_are_found() {
        assert_eq!(spoken("Units: nm"), Some("nm"));
        assert_eq!(spoken("unit = pixels, isotropic"), Some("pixels"));
        for none in [
            "units: um",
            "unit",
            "community: nm",
            "scale 1 1 1",
            "units:",
        ] {
            assert_eq!(spoken(none), None, "{none}");
        }
    }
}
