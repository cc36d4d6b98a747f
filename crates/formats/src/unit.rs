//! Units of length by the names that files give them.

/// Micrometers in a nanometer.
pub(crate) const NANOMETER: f64 = 1e-3;

/// Micrometers in a unit; `None` if the name is none of a length.
pub(crate) fn micrometers(unit: &str) -> Option<f64> {
    Some(match unit.trim().to_lowercase().as_str() {
        "nm" | "nanometer" | "nanometers" | "nanometre" | "nanometres" => NANOMETER,
        // Micro has two code points, and programs that know neither write u.
        "um" | "\u{b5}m" | "\u{3bc}m" | "micron" | "microns" | "micrometer" | "micrometers"
        | "micrometre" | "micrometres" => 1.0,
        "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => 1e3,
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => 1e4,
        "m" | "meter" | "meters" | "metre" | "metres" => 1e6,
        "\u{e5}" | "angstrom" | "angstroms" | "\u{e5}ngstr\u{f6}m" => 1e-4,
        "inch" | "inches" | "in" => 25_400.0,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn micro_is_written_in_many_ways() {
        for unit in [
            "\u{b5}m",
            "\u{3bc}m",
            "um",
            "micron",
            "Micrometers",
            " micrometer ",
        ] {
            assert_eq!(micrometers(unit), Some(1.0), "{unit}");
        }
        assert_eq!(micrometers("nanometer"), Some(1e-3));
        assert_eq!(micrometers("pixel"), None);
    }
}
