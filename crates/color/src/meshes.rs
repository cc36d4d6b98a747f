//! Colors of meshes beside the cells.

use neurotess_picture::color::{Rgb, category, fraction};
use neurotess_picture::overlay::Legend;

use crate::scheme::{ColorScheme, Coloring, NOTHING};

/// The color of the index-th mesh that has none of its own: pale, so that cells stand out from it.
pub fn mesh_color(index: usize) -> Rgb {
    const COLORS: [Rgb; 6] = [
        [132, 156, 190],
        [190, 162, 116],
        [132, 176, 140],
        [178, 140, 182],
        [120, 176, 180],
        [196, 142, 136],
    ];
    COLORS[index % COLORS.len()]
}

/// Numbers of the vertices of meshes beside the cells, and what the legend says of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshValues {
    /// By mesh: a number for each vertex, NaN where there is none. Meshes without numbers have a color.
    pub meshes: Vec<Option<Vec<f32>>>,
    /// What they are.
    pub title: String,
    /// Their unit; empty if they have none.
    pub unit: String,
}

impl MeshValues {
    /// Numbers at both ends of a scale: those of `range`, or the least and the greatest.
    fn ends(&self, range: Option<[f32; 2]>) -> [f32; 2] {
        let finite = || {
            let all = self.meshes.iter().flatten().flatten().copied();
            all.filter(|value| value.is_finite())
        };
        let [low, high] = range.unwrap_or_else(|| {
            let least = finite().reduce(f32::min).unwrap_or(0.0);
            [least, finite().reduce(f32::max).unwrap_or(0.0)]
        });
        [low, if high > low { high } else { low + 1.0 }]
    }
}

impl Coloring {
    /// Adds the colors of numbers of meshes: of the scheme's scale, which cells that are colored by numbers have, too. What
    /// has none is gray. `told`: the legend has the same numbers of cells, and says no more. Returns the color keys of the
    /// vertices of each mesh that has numbers.
    ///
    /// Cells must not be colored by a recording, whose keys mean something else.
    pub fn add_mesh_values(
        &mut self,
        values: &MeshValues,
        scheme: &ColorScheme,
        told: bool,
    ) -> Vec<Option<Vec<u32>>> {
        let [low, high] = values.ends(scheme.range);
        let first = self.categories();
        let own = &mut self.table.categories;
        let last = own.last().copied().unwrap_or(NOTHING);
        own.resize(first, last);
        own.push(NOTHING);
        self.table.scale.clone_from(&scheme.scale);
        if !told {
            let (title, scale) = (&values.title, scheme.scale.clone());
            let bar = Legend::bar(title, &values.unit, scale, [low, high], false);
            self.legend = match self.color_keys.is_empty() {
                true => bar,
                false => self.legend.clone().with_below(bar),
            };
        }
        let key = |&value: &f32| match value.is_nan() {
            true => category(first as u32),
            false => fraction((value - low) / (high - low)),
        };
        let keys = values.meshes.iter().map(|values| {
            let values = values.as_ref()?;
            Some(values.iter().map(key).collect())
        });
        keys.collect()
    }

    /// Adds the colors of meshes to the table, and their names below the legend. Returns the color key of each.
    pub fn add_meshes(&mut self, meshes: &[(Rgb, String)]) -> Vec<u32> {
        if meshes.is_empty() {
            return Vec::new();
        }
        let first = self.categories();
        let own = &mut self.table.categories;
        let last = own.last().copied().unwrap_or(NOTHING);
        own.resize(first, last);
        own.extend(meshes.iter().map(|(color, _)| *color));
        let swatches = Legend::swatches("", meshes.iter().cloned());
        self.legend = self.legend.clone().with_below(swatches);
        let keys = (first as u32..).map(category);
        keys.take(meshes.len()).collect()
    }
}

#[cfg(test)]
mod tests {
    use neurotess_picture::color::{ColorTable, Palette};

    use super::*;

    #[test]
    fn colors_of_meshes_follow_all_others() {
        let mut coloring = Coloring {
            color_keys: vec![vec![category(0), category(3)]],
            table: ColorTable {
                categories: vec![[1; 3], [2; 3]],
                ..ColorTable::default()
            },
            legend: Legend::swatches("", []),
            things: Vec::new(),
        };
        let meshes = [
            (mesh_color(0), "region".to_owned()),
            ([9; 3], "pipette".to_owned()),
        ];
        let keys = coloring.add_meshes(&meshes);
        assert_eq!(keys, [category(4), category(5)]);
        let categories = &coloring.table.categories;
        assert_eq!(categories[3..], [[2; 3], mesh_color(0), [9; 3]]);
    }

    #[test]
    fn numbers_of_meshes_have_the_scale_and_nan_is_gray() {
        let scheme = ColorScheme {
            palette: Palette::NeuroM,
            own_colors: Default::default(),
            background: None,
            scale: vec![[0; 3], [255; 3]],
            range: None,
        };
        let values = MeshValues {
            meshes: vec![Some(vec![-1.0, f32::NAN, 3.0]), None, Some(vec![1.0])],
            title: "calcium".into(),
            unit: "µM".into(),
        };
        let mut coloring = Coloring {
            color_keys: vec![vec![category(0), category(2)]],
            table: ColorTable {
                categories: vec![[1; 3]],
                ..ColorTable::default()
            },
            legend: Legend::swatches("type", []),
            things: Vec::new(),
        };
        let keys = coloring.add_mesh_values(&values, &scheme, false);
        let first = vec![fraction(0.0), category(3), fraction(1.0)];
        assert_eq!(keys, [Some(first), None, Some(vec![fraction(0.5)])]);
        assert_eq!(coloring.table.categories[3], NOTHING);
        assert_eq!(coloring.table.scale, scheme.scale);
        assert_eq!(coloring.legend.title(), "type");

        coloring.color_keys.clear();
        let ranged = ColorScheme {
            range: Some([0.0, 10.0]),
            ..scheme
        };
        let keys = coloring.add_mesh_values(&values, &ranged, false);
        assert_eq!(keys[2], Some(vec![fraction(0.1)]));
        assert_eq!(coloring.legend.title(), "calcium (µM)");
        assert_eq!(coloring.legend.range(), Some(([0.0, 10.0], false)));
    }
}
