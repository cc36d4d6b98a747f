//! Colors by numbers of one's own.

use std::collections::HashMap;

use itertools::Itertools;
use neurotess_mesh::{Role, TracingPoint};
use neurotess_picture::color::{category, fraction};

use crate::scheme::{Cell, ColorScheme, Coloring};

/// Numbers of a cell; NaN where there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct CellValues {
    /// Of each point of its tracing.
    pub points: Vec<f32>,
    /// Of its somata.
    pub soma: f32,
}

/// Numbers of cells, and what the legend says of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OwnValues {
    /// By cell.
    pub cells: Vec<CellValues>,
    /// What they are.
    pub title: String,
    /// Their unit; empty if they have none.
    pub unit: String,
}

impl OwnValues {
    /// The number of each tracing point by cell, NaN where there is none; and the numbers at both ends of a scale: those of
    /// `range`, or the least and the greatest.
    pub fn spread(&self, cells: &[Cell<'_>], range: Option<[f32; 2]>) -> (Vec<Vec<f32>>, [f32; 2]) {
        let pairs = cells.iter().zip_eq(&self.cells);
        let shown: Vec<Vec<f32>> = pairs
            .map(|(cell, values)| on_mesh(cell, &values.points, values.soma, f32::NAN))
            .collect();
        let finite = || shown.iter().flatten().copied().filter(|v| v.is_finite());
        let [low, high] = range.unwrap_or_else(|| {
            let least = finite().reduce(f32::min).unwrap_or(0.0);
            [least, finite().reduce(f32::max).unwrap_or(0.0)]
        });
        let high = if high > low { high } else { low + 1.0 };
        (shown, [low, high])
    }
}

/// Colors of cells by numbers of one's own: of the scheme's range, or from the least to the greatest number. What has
/// none is gray.
pub fn by_values(cells: &[Cell<'_>], values: &OwnValues, scheme: &ColorScheme) -> Coloring {
    let (shown, [low, high]) = values.spread(cells, scheme.range);
    let key = |&value: &f32| match value.is_nan() {
        true => category(0),
        false => fraction((value - low) / (high - low)),
    };
    let keys = shown.iter().map(|values| values.iter().map(key).collect());
    scheme.scaled(keys.collect(), &values.title, &values.unit, [low, high])
}

/// What each tracing point of a cell's mesh has, of what the points of its tracing and its somata have; `none` where the mesh
/// has none of either. Points have the file's numbers there, which may repeat in other sections.
pub(crate) fn on_mesh<T: Copy>(cell: &Cell<'_>, points: &[T], soma: T, none: T) -> Vec<T> {
    let morphology = cell.morphology;
    let labels = morphology.sample_labels();
    let mut of_sample: HashMap<(usize, i32), T> = HashMap::new();
    for (index, section) in morphology.sections.iter().enumerate() {
        for point in section.range() {
            of_sample.insert((index, labels.of_point(point)), points[point]);
        }
    }
    let of_point = |point: &TracingPoint| match (point.role, point.section.index()) {
        (Role::Soma, _) => soma,
        (_, Some(section)) => {
            let own = of_sample.get(&(section, point.sample.0));
            own.copied().unwrap_or(none)
        }
        (_, None) => none,
    };
    cell.mesh.tracing.iter().map(of_point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use neurotess_picture::color::{CATEGORY_BIT, Palette};

    use crate::own_colors::OwnColors;

    #[test]
    fn points_have_their_numbers_and_the_rest_is_gray() {
        let text = b"1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 20 0 1 2\n4 3 0 40 0 1 3\n";
        let read = neurotess_formats::swc::read_bytes(text, "cell", &Default::default());
        let morphology = read.expect("a cell").morphology;
        let generated = neurotess_generate::generate(&morphology, &Default::default());
        let mesh = generated.expect("meshed").mesh;
        let cell = Cell {
            name: "",
            morphology: &morphology,
            mesh: &mesh,
            radius_factor: 1.0,
        };
        let values = OwnValues {
            cells: vec![CellValues {
                points: vec![-1.0, f32::NAN, 3.0],
                soma: 1.0,
            }],
            title: "current".into(),
            unit: "nA".into(),
        };
        let scheme = ColorScheme {
            palette: Palette::NeuroM,
            own_colors: OwnColors::default(),
            background: None,
            scale: vec![[0; 3], [255; 3]],
            range: None,
        };
        let coloring = by_values(&[cell], &values, &scheme);
        for (point, &key) in mesh.tracing.iter().zip(&coloring.color_keys[0]) {
            let expected = match (point.role, point.sample.0) {
                (Role::Soma, _) => fraction(0.5),
                (_, 2) => fraction(0.0),
                (_, 3) => category(0),
                _ => fraction(1.0),
            };
            assert_eq!(key, expected, "{point:?}");
        }
        let kinds = |is_category: bool| {
            let keys = coloring.color_keys[0].iter();
            keys.filter(|&key| (key & CATEGORY_BIT != 0) == is_category)
                .count()
        };
        assert!(kinds(true) > 0 && kinds(false) > 2);
    }
}
