//! Colors: color keys, the table that they are looked up in, and color maps. Palettes are those of files of meshes, too
//! (`palette.rs` of `mesh`).
//!
//! A tracing point has a **color key**. It is a **category**, or a fraction of a **scale**. The
//! table has the colors of the scale, then those of the categories, so that another color map or
//! palette leaves the color keys as they are.

use std::str::FromStr;

pub use neurotess_mesh::palette::luminance;
pub use neurotess_mesh::palette::{Palette, Rgb, is_dark, linear};

/// Set in the color key of a category.
pub const CATEGORY_BIT: u32 = 1 << 31;

/// Color key of a category.
pub fn category(index: u32) -> u32 {
    CATEGORY_BIT | (index & (CATEGORY_BIT - 1))
}

/// Color key of a fraction of the scale, clamped to 0 to 1; NaN counts as 0.
pub fn fraction(value: f32) -> u32 {
    // 2³¹ − 128 is the greatest f32 below 2³¹.
    (value.clamp(0.0, 1.0).max(0.0) * (CATEGORY_BIT - 128) as f32) as u32
}

/// The colors of color keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColorTable {
    /// Colors of fractions, evenly spaced.
    pub scale: Vec<Rgb>,
    /// Colors of categories. Categories beyond the end have the last color.
    pub categories: Vec<Rgb>,
    /// If there are any, color keys that are not categories are indices of an instance's values.
    pub values: InstanceValues,
}

/// Values that differ between instances of one template, such as those of a simulation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InstanceValues {
    /// By instance: the index of its first four values.
    first: Vec<u32>,
    fours: Vec<[f32; 4]>,
}

impl InstanceValues {
    /// Adds the values of the next instance: fractions of the scale, 0 to 1. NaN has the color of
    /// the first category, and so has an instance without values.
    pub fn push(&mut self, values: &[f32]) {
        let first = self.fours.len() as u32;
        self.first
            .push(if values.is_empty() { NOWHERE } else { first });
        // Shaders cannot rely on NaN, so there is a value that stands for it.
        let value = |value: &f32| {
            if value.is_nan() {
                NO_VALUE
            } else {
                value.clamp(0.0, 1.0)
            }
        };
        self.fours.extend(values.chunks(4).map(|chunk| {
            let mut four = [NO_VALUE; 4];
            four.iter_mut()
                .zip(chunk)
                .for_each(|(to, from)| *to = value(from));
            four
        }));
    }

    /// Number of instances.
    pub fn instances(&self) -> usize {
        self.first.len()
    }

    /// The value of an instance at an index, as [`InstanceValues::push`] got it, clamped; none if
    /// there is none.
    pub fn value(&self, instance: u32, index: u32) -> Option<f32> {
        let first = *self.first.get(instance as usize)?;
        let four = self.fours.get(first as usize + index as usize / 4)?;
        Some(four[index as usize % 4]).filter(|&value| value >= 0.0)
    }
}

const NO_VALUE: f32 = -1.0;
/// Index of the first values of an instance that has none: beyond the end, so that shaders take the
/// last entry.
const NOWHERE: u32 = 1 << 24;

impl ColorTable {
    /// Linear colors, those of the scale first; never empty.
    pub fn linear(&self) -> Vec<[f32; 4]> {
        let all = self.scale.iter().chain(&self.categories);
        let mut entries: Vec<[f32; 4]> = all.map(|&rgb| extended(linear(rgb))).collect();
        if entries.is_empty() {
            entries.push([0.5, 0.5, 0.5, 1.0]);
        }
        entries
    }

    /// Linear color of a color key, and whether it is one of the scale. `linear`: that of [`ColorTable::linear`]; `value`: a
    /// fraction of the scale or NaN, instead of that of the instance.
    pub fn color(
        &self,
        linear: &[[f32; 4]],
        color_key: u32,
        instance: u32,
        value: Option<f32>,
    ) -> ([f32; 3], bool) {
        let last_color = linear.len() - 1;
        let rgb = |place: usize| {
            let [r, g, b, _] = linear[place.min(last_color)];
            [r, g, b]
        };
        let of_category = |category: u32| (rgb(self.scale.len() + category as usize), false);
        if color_key & CATEGORY_BIT != 0 {
            return of_category(color_key & !CATEGORY_BIT);
        }
        let valued = value.is_some() || self.values.instances() > 0;
        let share = match valued {
            false => color_key as f32 / CATEGORY_BIT as f32,
            true => {
                let known = value.or_else(|| self.values.value(instance, color_key));
                match known.filter(|share| !share.is_nan()) {
                    Some(share) => share.clamp(0.0, 1.0),
                    None => return of_category(0),
                }
            }
        };
        let last = self.scale.len().max(1) - 1;
        let place = share * last as f32;
        let (low, high) = (place as usize, (place as usize + 1).min(last));
        let (a, b) = (rgb(low), rgb(high));
        let mixed = [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * place.fract());
        (mixed, true)
    }

    /// The buffer that shaders look colors up in, and the number of colors. The colors come first,
    /// then the index of each instance's first values, then the values, four to an entry.
    pub fn entries(&self) -> (Vec<[f32; 4]>, u32) {
        let mut entries = self.linear();
        let colors = entries.len() as u32;
        let InstanceValues { first, fours } = &self.values;
        // An index is stored as an f32, which is exact up to 2²⁴: enough for 67 million values.
        let behind = first.len().div_ceil(4) as u32 + colors;
        entries.extend(first.chunks(4).map(|chunk| {
            let mut entry = [0.0; 4];
            let places = chunk
                .iter()
                .map(|&place| (behind + place).min(NOWHERE) as f32);
            entry
                .iter_mut()
                .zip(places)
                .for_each(|(to, from)| *to = from);
            entry
        }));
        entries.extend(fours);
        if !first.is_empty() {
            entries.push([NO_VALUE; 4]);
        }
        (entries, colors)
    }
}

fn extended([r, g, b]: [f32; 3]) -> [f32; 4] {
    [r, g, b, 1.0]
}

/// Entries of a scale: neighbors differ by less than a step of 8 bits.
pub const SCALE_ENTRIES: usize = 256;

/// Perceptually uniform color maps, dark to light: those of matplotlib, from the crate `colorous`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMap {
    /// Blue, green, yellow.
    #[default]
    Viridis,
    /// Black, purple, white.
    Magma,
    /// Black, red, yellow.
    Inferno,
    /// Blue, red, yellow.
    Plasma,
    /// Blue to yellow, the same for the color-blind.
    Cividis,
}

impl ColorMap {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Viridis,
        Self::Magma,
        Self::Inferno,
        Self::Plasma,
        Self::Cividis,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Viridis => "viridis",
            Self::Magma => "magma",
            Self::Inferno => "inferno",
            Self::Plasma => "plasma",
            Self::Cividis => "cividis",
        }
    }

    /// Color at a fraction, 0 to 1.
    pub fn at(self, fraction: f64) -> Rgb {
        let map = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Magma => colorous::MAGMA,
            Self::Inferno => colorous::INFERNO,
            Self::Plasma => colorous::PLASMA,
            Self::Cividis => colorous::CIVIDIS,
        };
        map.eval_continuous(fraction.clamp(0.0, 1.0)).as_array()
    }

    /// The whole map, evenly spaced. Colors close to the background's stand out by the edges that
    /// [`Look::contrast`](crate::Look::contrast) draws.
    pub fn scale(self) -> Vec<Rgb> {
        self.spaced(0.0, 1.0)
    }

    /// The map without the end that is close to this background's color; the rest stays uniform.
    pub fn scale_before(self, background: Rgb) -> Vec<Rgb> {
        match is_dark(background) {
            true => self.spaced(0.15, 1.0),
            false => self.spaced(0.0, 0.93),
        }
    }

    fn spaced(self, low: f64, high: f64) -> Vec<Rgb> {
        let last = (SCALE_ENTRIES - 1) as f64;
        (0..SCALE_ENTRIES)
            .map(|i| self.at(low + (high - low) * i as f64 / last))
            .collect()
    }
}

impl FromStr for ColorMap {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|map| map.name() == name);
        found.ok_or_else(|| "use viridis, magma, inferno, plasma or cividis".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn color_keys_tell_categories_from_fractions() {
        assert_eq!(category(3) & !CATEGORY_BIT, 3);
        assert_eq!(fraction(f32::NAN), 0);
        assert!(fraction(2.0) < CATEGORY_BIT && fraction(1.0) > CATEGORY_BIT - 512);
        assert!(fraction(0.2) < fraction(0.3));
    }

    #[test]
    fn an_instance_without_values_has_not_those_of_the_next() {
        let mut values = InstanceValues::default();
        values.push(&[]);
        values.push(&[0.5; 5]);
        let table = ColorTable {
            scale: vec![[0; 3]; 2],
            values,
            ..ColorTable::default()
        };
        let (entries, colors) = table.entries();
        let value = |instance: usize, color_key: usize| {
            let first = entries[colors as usize + instance / 4][instance % 4] as usize;
            entries[(first + color_key / 4).min(entries.len() - 1)][color_key % 4]
        };
        assert_eq!([0, 4].map(|color_key| value(0, color_key)), [NO_VALUE; 2]);
        assert_eq!([0, 4].map(|color_key| value(1, color_key)), [0.5; 2]);
    }

    #[test]
    fn maps_rise_in_lightness() {
        for map in ColorMap::ALL {
            let light = |i: u8| {
                let [r, g, b] = linear(map.at(f64::from(i) / 20.0));
                (0.2126 * r + 0.7152 * g + 0.0722 * b).cbrt()
            };
            assert!((1..=20).all(|i| light(i) > light(i - 1)), "{}", map.name());
            assert_eq!(map.name().parse(), Ok(map));
        }
        // matplotlib's first and last of viridis.
        let viridis = ColorMap::Viridis;
        assert_eq!(
            (viridis.at(0.0), viridis.at(1.0)),
            ([68, 1, 84], [253, 231, 37])
        );
        // The whole map whatever the background; scale_before leaves out an end.
        let scale = viridis.scale();
        assert_eq!((scale[0], scale[255]), ([68, 1, 84], [253, 231, 37]));
        assert_ne!(viridis.scale_before([255; 3])[255], [253, 231, 37]);
        assert_ne!(viridis.scale_before([0; 3])[0], [68, 1, 84]);
    }
}
