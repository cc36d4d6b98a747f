//! Palettes: the colors of types and of categories, the same in pictures and in files of meshes.

use std::str::FromStr;

/// An sRGB color.
pub type Rgb = [u8; 3];

/// Linear light of an sRGB color (IEC 61966-2-1).
pub fn linear(rgb: Rgb) -> [f32; 3] {
    rgb.map(|byte| {
        let c = f32::from(byte) / 255.0;
        if c <= 0.040_45 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    })
}

/// Whether light things stand out better than dark ones against this background.
pub fn is_dark(rgb: Rgb) -> bool {
    luminance(rgb) < 0.2
}

/// Relative luminance, 0 to 1 (IEC 61966-2-1).
pub fn luminance(rgb: Rgb) -> f32 {
    let [r, g, b] = linear(rgb);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Colors of the parts of a cell, by SWC type, and of categories.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Palette {
    /// NeuroM's: soma black, axon blue, basal dendrites red, apical ones purple.
    #[default]
    NeuroM,
    /// NeuroMorpho.org's: soma red, axon gray, basal dendrites green, apical ones magenta.
    NeuroMorpho,
    /// Okabe and Ito's, distinct for the color-blind too: axon blue, basal dendrites vermilion,
    /// apical ones reddish purple.
    OkabeIto,
}

impl Palette {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::NeuroM, Self::NeuroMorpho, Self::OkabeIto];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::NeuroM => "neurom",
            Self::NeuroMorpho => "neuromorpho",
            Self::OkabeIto => "okabe-ito",
        }
    }

    /// Undefined, soma, axon, basal and apical dendrites.
    ///
    /// Shading does not show on pure primaries, so blue, red and purple are those used in print,
    /// and black is the darkest gray on which shading still shows a shape.
    fn types(self) -> [Rgb; 5] {
        match self {
            Self::NeuroM => [
                [120, 120, 120],
                [70, 71, 76],
                [32, 84, 214],
                [214, 40, 40],
                [134, 46, 168],
            ],
            Self::NeuroMorpho => [
                [70, 70, 70],
                [210, 40, 40],
                [140, 140, 140],
                [52, 160, 62],
                [206, 54, 190],
            ],
            Self::OkabeIto => [
                [110, 110, 110],
                [62, 62, 64],
                [0, 114, 178],
                [213, 94, 0],
                [204, 121, 167],
            ],
        }
    }

    /// Color of an SWC type. Types from 5 on have eight colors, which repeat.
    pub fn of_type(self, kind: i32) -> Rgb {
        match usize::try_from(kind) {
            Ok(kind @ 0..=4) => self.types()[kind],
            Ok(kind) => CUSTOM[(kind - 5) % CUSTOM.len()],
            Err(_) => self.types()[0],
        }
    }

    /// Color of somata on this background: light gray where a dark soma would not show.
    pub fn of_soma(self, background: Option<Rgb>) -> Rgb {
        let soma = self.of_type(1);
        if background.is_some_and(is_dark) && is_dark(soma) && self != Self::NeuroMorpho {
            return [190, 190, 190];
        }
        soma
    }

    /// Number of different colors of categories.
    pub fn distinct_count(self) -> usize {
        match self {
            Self::OkabeIto => OKABE_ITO.len(),
            Self::NeuroM | Self::NeuroMorpho => DISTINCT.len(),
        }
    }

    /// Color of the index-th category; colors repeat after [`Palette::distinct_count`].
    pub fn distinct(self, index: usize) -> Rgb {
        if self == Self::OkabeIto {
            return OKABE_ITO[index % OKABE_ITO.len()];
        }
        DISTINCT[index % DISTINCT.len()]
    }
}

impl FromStr for Palette {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|palette| palette.name() == name);
        found.ok_or_else(|| "use neurom, neuromorpho or okabe-ito".into())
    }
}

/// Types from 5 on: colors unlike those of the types below.
const CUSTOM: [Rgb; 8] = [
    [230, 140, 20],
    [20, 150, 110],
    [30, 170, 200],
    [150, 100, 50],
    [220, 110, 160],
    [140, 170, 30],
    [90, 90, 160],
    [200, 170, 40],
];

/// Tableau's ten colors, a shade darker, for white backgrounds.
const DISTINCT: [Rgb; 10] = [
    [62, 105, 156],
    [226, 124, 34],
    [208, 66, 72],
    [88, 166, 160],
    [72, 146, 62],
    [214, 180, 40],
    [160, 106, 146],
    [240, 130, 144],
    [142, 104, 82],
    [130, 124, 120],
];

/// Okabe & Ito, Color universal design, 2008; without black, and with a yellow that is a shade darker, for
/// white backgrounds. A darker one looks like the orange with deuteranopia.
const OKABE_ITO: [Rgb; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
    [220, 208, 60],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_have_different_colors() {
        for palette in Palette::ALL {
            assert_eq!(palette.name().parse(), Ok(palette));
            let colors: Vec<Rgb> = (0..13).map(|kind| palette.of_type(kind)).collect();
            for (i, a) in colors.iter().enumerate() {
                assert!(!colors[..i].contains(a), "{} {i}", palette.name());
            }
        }
    }
}
