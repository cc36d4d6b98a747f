//! Colors of meshes beside the cells.

use neurotess_render::color::{Rgb, category};
use neurotess_render::overlay::Legend;

use crate::scheme::{Coloring, NOTHING};

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

impl Coloring {
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
    use neurotess_render::color::ColorTable;

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
}
