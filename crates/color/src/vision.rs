//! Whether the colors of a legend can be told apart, also by the color-blind.
//!
//! **Theory.** What a dichromat sees of a color is simulated after Machado, Oliveira and Fernandes, A
//! physiologically-based model for simulation of color vision deficiency, IEEE TVCG 15 (2009) 1291–1298:
//! the matrices of severity 1.0, on linear light. How far two colors are apart is their distance in OKLab
//! (Ottosson, A perceptual color space for image processing, 2020), in which a distance is about as visible
//! wherever it is. **Practice.** All pairs of a legend in four kinds of vision: those of 100 colors take a
//! millisecond.

use std::fmt;

use neurotess_picture::color::{Rgb, linear};

/// Distance (OKLab, in which black and white are 1 apart) from which two colors can be told apart on thin
/// neurites. A difference is just noticeable at 0.02, side by side and over an area. The closest pair of the
/// palette that Okabe and Ito made for the color-blind, green and reddish purple in deuteranopia, is 0.076
/// apart, so that palette passes; pairs of NeuroMorpho.org's red and green (0.052) and of Tableau's ten
/// colors (down to 0.007) do not.
pub const MIN_DIFFERENCE: f32 = 0.07;

/// How colors are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vision {
    /// With three kinds of cones.
    Typical,
    /// Without long-wave cones.
    Protanopia,
    /// Without middle-wave cones.
    Deuteranopia,
    /// Without short-wave cones.
    Tritanopia,
}

impl Vision {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Typical,
        Self::Protanopia,
        Self::Deuteranopia,
        Self::Tritanopia,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Typical => "typical",
            Self::Protanopia => "protanopia",
            Self::Deuteranopia => "deuteranopia",
            Self::Tritanopia => "tritanopia",
        }
    }

    /// What is seen of a linear color: rows of the matrix give red, green and blue.
    fn seen(self, color: [f32; 3]) -> [f32; 3] {
        let matrix = match self {
            Self::Typical => return color,
            Self::Protanopia => [
                [0.152_286, 1.052_583, -0.204_868],
                [0.114_503, 0.786_281, 0.099_216],
                [-0.003_882, -0.048_116, 1.051_998],
            ],
            Self::Deuteranopia => [
                [0.367_322, 0.860_646, -0.227_968],
                [0.280_085, 0.672_501, 0.047_413],
                [-0.011_820, 0.042_940, 0.968_881],
            ],
            Self::Tritanopia => [
                [1.255_528, -0.076_749, -0.178_779],
                [-0.078_411, 0.930_809, 0.147_602],
                [0.004_733, 0.691_367, 0.303_900],
            ],
        };
        matrix.map(|row| dot(row, color).clamp(0.0, 1.0))
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Lightness, green to red and blue to yellow of a linear color.
fn oklab(color: [f32; 3]) -> [f32; 3] {
    let cones = [
        [0.412_221_46, 0.536_332_55, 0.051_445_995],
        [0.211_903_5, 0.680_699_5, 0.107_396_96],
        [0.088_302_46, 0.281_718_85, 0.629_978_7],
    ];
    let cones = cones.map(|row| dot(row, color).cbrt());
    let lab = [
        [0.210_454_26, 0.793_617_8, -0.004_072_047],
        [1.977_998_5, -2.428_592_2, 0.450_593_7],
        [0.025_904_037, 0.782_771_77, -0.808_675_77],
    ];
    lab.map(|row| dot(row, cones))
}

/// How far two colors are apart (OKLab) as they are seen.
pub fn difference(a: Rgb, b: Rgb, vision: Vision) -> f32 {
    distance(seen(a, vision), seen(b, vision))
}

fn seen(color: Rgb, vision: Vision) -> [f32; 3] {
    oklab(vision.seen(linear(color)))
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [l, m, s] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dot([l, m, s], [l, m, s]).sqrt()
}

/// The two colors of a legend that are closest to one another.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosestColors {
    /// Their names.
    pub names: [String; 2],
    /// The vision in which they are closest.
    pub vision: Vision,
    /// How far they are apart (OKLab).
    pub difference: f32,
    /// Number of pairs that are less than [`MIN_DIFFERENCE`] apart in some vision.
    pub alike: usize,
}

/// The two colors of a legend that are closest to one another. Things of equal color are taken as meant to
/// be the same. None if there are no two different colors.
pub fn closest(entries: &[(Rgb, String)]) -> Option<ClosestColors> {
    let colors = entries
        .iter()
        .map(|(color, _)| Vision::ALL.map(|vision| seen(*color, vision)));
    let colors: Vec<[[f32; 3]; 4]> = colors.collect();
    let mut closest: Option<(f32, Vision, [usize; 2])> = None;
    let mut alike = 0;
    for (second, (color, _)) in entries.iter().enumerate() {
        for (first, (other, _)) in entries[..second].iter().enumerate() {
            if color == other {
                continue;
            }
            let mut least = f32::INFINITY;
            for (index, vision) in Vision::ALL.into_iter().enumerate() {
                let apart = distance(colors[first][index], colors[second][index]);
                least = least.min(apart);
                if closest.is_none_or(|(before, ..)| apart < before) {
                    closest = Some((apart, vision, [first, second]));
                }
            }
            alike += usize::from(least < MIN_DIFFERENCE);
        }
    }
    let (difference, vision, pair) = closest?;
    Some(ClosestColors {
        names: pair.map(|index| entries[index].1.clone()),
        vision,
        difference,
        alike,
    })
}

/// What there is to say about them, as in `axon and soma look alike with deuteranopia`.
impl fmt::Display for ClosestColors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = &self.names;
        if self.alike > 1 {
            write!(f, "{} pairs of colors look alike, most of all ", self.alike)?;
        }
        write!(f, "'{a}' and '{b}'")?;
        match (self.alike, self.vision) {
            (0, _) => f.write_str(" are closest"),
            (1, _) => f.write_str(" look alike"),
            _ => Ok(()),
        }?;
        match self.vision {
            Vision::Typical => Ok(()),
            vision => write!(f, " with {}", vision.name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use neurotess_picture::color::Palette;

    fn named(colors: &[Rgb]) -> Vec<(Rgb, String)> {
        let colors = colors.iter().copied().enumerate();
        colors.map(|(i, color)| (color, i.to_string())).collect()
    }

    #[test]
    fn red_and_green_of_equal_lightness_are_alike_to_deuteranopes_only() {
        let (red, green) = ([208, 66, 72], [72, 146, 62]);
        assert!(difference(red, green, Vision::Typical) > 0.2);
        assert!(difference(red, green, Vision::Deuteranopia) < 0.01);
        let closest = closest(&named(&[red, green, [0, 0, 255]])).expect("a pair");
        assert_eq!((closest.vision, closest.alike), (Vision::Deuteranopia, 1));
        assert_eq!(
            closest.to_string(),
            "'0' and '1' look alike with deuteranopia"
        );
        assert!((difference([0; 3], [255; 3], Vision::Typical) - 1.0).abs() < 1e-3);
    }

    /// The numbers that the threshold follows from.
    #[test]
    fn the_palette_for_the_color_blind_passes() {
        let okabe_ito = [
            [0, 114, 178],
            [213, 94, 0],
            [0, 158, 115],
            [204, 121, 167],
            [86, 180, 233],
            [230, 159, 0],
            [240, 228, 66],
            [0, 0, 0],
        ];
        let pair = closest(&named(&okabe_ito)).expect("a pair");
        assert!((pair.difference - 0.076).abs() < 1e-3, "{pair:?}");
        assert_eq!((pair.vision, pair.alike), (Vision::Deuteranopia, 0));
        let types = |palette: Palette| {
            let colors: Vec<Rgb> = (1..5).map(|kind| palette.of_type(kind)).collect();
            closest(&named(&colors)).expect("a pair")
        };
        assert_eq!(types(Palette::OkabeIto).alike, 0);
        assert_eq!(types(Palette::NeuroM).alike, 0);
        let palette = Palette::OkabeIto;
        let kinds: Vec<Rgb> = (0..palette.distinct_count())
            .map(|i| palette.distinct(i))
            .collect();
        assert_eq!(closest(&named(&kinds)).map(|pair| pair.alike), Some(0));
        let pair = types(Palette::NeuroMorpho);
        assert!((pair.difference - 0.052).abs() < 1e-3, "{pair:?}");
        assert_eq!((pair.names, pair.alike), (["0".into(), "2".into()], 1));
    }

    #[test]
    fn equal_colors_are_meant() {
        assert_eq!(closest(&named(&[[1, 2, 3]; 2])), None);
        assert_eq!(closest(&[]), None);
        let pair = closest(&named(&[[9, 9, 9], [9, 9, 9], [255, 0, 0]])).expect("a pair");
        assert_eq!((pair.alike, pair.vision == Vision::Typical), (0, false));
    }
}
