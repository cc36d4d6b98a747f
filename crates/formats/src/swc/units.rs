//! What a header says of the unit and the origin: navis writes `# Meta: {…, "units": "8 nanometer", …}`, for cells in
//! voxels, too; SNT that positions are in pixels, with the voxel's sides; MouseLight an offset.

use super::rows::Records;
use crate::unit::micrometers;
use crate::warning::Warnings;

/// What the header says of the unit, in a warning: code, line.
const READ: &str = "units_in_header";

/// Takes positions and radii to micrometers if the header's metadata names another unit. What is kept of the header then
/// names the micrometer, so that a copy is not taken for the other unit again. A unit that is named elsewhere is told, and so
/// is an offset. `given`: the caller knows the unit, and takes the lengths to micrometers; that of the header is told.
pub(super) fn apply(records: &mut Records, given: bool, warnings: &mut Warnings) {
    tell_offset(&records.header, warnings);
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
        if given {
            let message =
                "the header names another unit than the one that is given: the given one is taken";
            warnings.add(1, "unit_not_applied", message);
            return;
        }
        for node in &mut records.nodes {
            node.position *= factor;
            node.radius *= factor;
        }
        warnings.add(1, READ, &message);
        return;
    }
    let spoken = records.header.iter().find_map(|line| spoken(line));
    if let Some(unit) = spoken.filter(|_| !given) {
        let voxel = records.header.iter().find_map(|line| voxel(line));
        let remedy = match voxel {
            Some([x, y, z]) => format!("--units voxel={x},{y},{z} changes that"),
            None => "--units changes that".into(),
        };
        let message = format!(
            "the header speaks of {unit}, and the numbers are taken as micrometers: {remedy}"
        );
        warnings.add(1, "unit_not_applied", &message);
    }
}

/// Tells of an offset, as `OFFSET x y z` of MouseLight: positions stay as the rows have them.
fn tell_offset(header: &[String], warnings: &mut Warnings) {
    let offset = header.iter().find_map(|line| {
        let rest = line.trim_start().strip_prefix("OFFSET")?;
        numbers(rest).filter(|offset| *offset != [0.0; 3])
    });
    if let Some([x, y, z]) = offset {
        let message = format!(
            "the header gives an offset of {x}, {y}, {z}, which other readers do not add either: positions are those of the \
             rows; --matrix 1,0,0,{x},0,1,0,{y},0,0,1,{z} adds it"
        );
        warnings.add(1, "offset_not_added", &message);
    }
}

/// The sides of a voxel, as in `Voxel separation (x,y,z): 0.3, 0.3, 1.0`.
fn voxel(line: &str) -> Option<[f64; 3]> {
    let lower = line.to_ascii_lowercase();
    let speaks = ["voxel separation", "voxel size", "voxel spacing"];
    let at = speaks.iter().find_map(|words| lower.find(words))?;
    let (_, rest) = line[at..].split_once([':', '='])?;
    numbers(rest).filter(|sides| sides.iter().all(|side| *side > 0.0))
}

/// Three finite numbers, parted by blanks or commas.
fn numbers(text: &str) -> Option<[f64; 3]> {
    let mut words = text
        .split(|c: char| c.is_whitespace() || c == ',')
        .filter(|w| !w.is_empty());
    let mut next = || {
        let number: f64 = words.next()?.parse().ok()?;
        number.is_finite().then_some(number)
    };
    Some([next()?, next()?, next()?])
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

/// A unit other than the micrometer in a comment like `units: nm`, `unit = pixels` or `positions in pixels`.
fn spoken(line: &str) -> Option<&str> {
    let lower = line.to_ascii_lowercase();
    let Some(at) = lower.find("unit") else {
        return in_unit(line);
    };
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

/// A unit other than the micrometer in a comment of what lengths are in.
fn in_unit(line: &str) -> Option<&str> {
    let lower = line.to_ascii_lowercase();
    let of_lengths = [
        "position",
        "coordinate",
        "radi",
        "length",
        "diameter",
        "distance",
    ];
    if !of_lengths.iter().any(|what| lower.contains(what)) {
        return None;
    }
    let mut words =
        line.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '(' | ')' | '.'));
    words.find(|word| word.eq_ignore_ascii_case("in"))?;
    let word = words.find(|word| !word.is_empty())?;
    let lower = word.to_ascii_lowercase();
    let is_picture = ["pixel", "pixels", "voxel", "voxels"].contains(&lower.as_str());
    // Abbreviations are words of other languages, too.
    let is_other = lower.len() > 3 && micrometers(word).is_some_and(|factor| factor != 1.0);
    (is_picture || is_other).then_some(word)
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
        let snt = "All positions and radii in pixels";
        assert_eq!(spoken(snt), Some("pixels"));
        assert_eq!(spoken("Coordinates are in nanometers."), Some("nanometers"));
        let separation = voxel("Voxel separation (x,y,z): 0.3, 0.3, 1.0");
        assert_eq!(separation, Some([0.3, 0.3, 1.0]));
        assert_eq!(voxel("Voxel separation (x,y,z): 0, 0.3, 1.0"), None);
        for none in [
            "units: um",
            "unit",
            "community: nm",
            "scale 1 1 1",
            "positions in micrometers",
            "traced in Meters Lab",
            "units:",
        ] {
            assert_eq!(spoken(none), None, "{none}");
        }
    }
}
