//! Colors of whole neurons: a color for each, by an attribute, or those given in a scene. Neurons
//! that share a template have a value each, which determines their color.

use std::collections::BTreeMap;

use neurotess_circuit::{Attribute, Circuit, NodeRef, color, natural};
use neurotess_picture::color::{InstanceValues, Rgb};
use neurotess_picture::overlay::Legend;
use thiserror::Error;

use crate::categorical::{Distinct, categorical, first_values, painted};
use crate::own_colors::{ColorTarget, ColoredThing};
use crate::scheme::{Cell, ColorScheme, Coloring};

/// A node and its circuit.
#[derive(Clone, Copy, Debug)]
pub struct Node<'c> {
    /// The circuit.
    pub circuit: &'c Circuit,
    /// The node in it.
    pub node: NodeRef,
}

impl<'c> Node<'c> {
    fn attribute(&self, name: &str) -> Option<&'c Attribute> {
        let populations = &self.circuit.populations;
        populations
            .get(self.node.population as usize)?
            .attributes
            .get(name)
    }

    fn number(&self, attribute: &str) -> Option<f64> {
        self.attribute(attribute)?.number(self.node.row as usize)
    }

    /// The node's value of an attribute; numbers as text.
    pub fn text(&self, attribute: &str) -> Option<String> {
        let row = self.node.row as usize;
        match self.attribute(attribute) {
            Some(column @ Attribute::Text { .. }) => column.text(row).map(str::to_owned),
            Some(column) => column.number(row).map(|number| number.to_string()),
            None if attribute == POPULATION => {
                let populations = &self.circuit.populations;
                let own = populations.get(self.node.population as usize)?;
                Some(own.name.clone())
            }
            None => None,
        }
    }
}

/// The attribute that all nodes have.
const POPULATION: &str = "population";

/// No neuron has such an attribute.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("no cell has an attribute '{attribute}': there are {}", there.join(", "))]
pub struct NoAttribute {
    /// The name that was given.
    pub attribute: String,
    /// The attributes that exist.
    pub there: Vec<String>,
}

/// Attributes that nodes of these circuits can be colored by, sorted.
pub fn attributes<'c>(circuits: impl IntoIterator<Item = &'c Circuit>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for circuit in circuits {
        let of_all = circuit.populations.iter().flat_map(|p| &p.attributes);
        names.extend(of_all.map(|(name, _)| name.clone()));
        names.push(POPULATION.into());
    }
    names.sort();
    names.dedup();
    names
}

/// A color for each neuron; `names`: a name for each, for the legend.
pub fn each(cells: &[Cell<'_>], names: &[String], scheme: &ColorScheme) -> Coloring {
    let own: Vec<Option<usize>> = (0..names.len()).map(Some).collect();
    categorical(cells, &own, names, "neuron", scheme)
}

/// Neurons with equal values of an attribute have the same color. If there are more different
/// numbers than colors, they are on the scale. `neurons`: in the order of the instances; none for
/// those of no circuit.
///
/// # Errors
/// No neuron's circuit has such an attribute.
pub fn by_attribute(
    cells: &[Cell<'_>],
    neurons: &[Option<Node<'_>>],
    attribute: &str,
    scheme: &ColorScheme,
) -> Result<Coloring, NoAttribute> {
    // Many neurons belong to few circuits.
    let mut circuits: Vec<&Circuit> = neurons.iter().flatten().map(|n| n.circuit).collect();
    circuits.dedup_by_key(|circuit| std::ptr::from_ref(*circuit));
    let there = attributes(circuits);
    if !there.iter().any(|name| name == attribute) {
        return Err(NoAttribute {
            attribute: attribute.to_owned(),
            there,
        });
    }
    let texts: Vec<Option<String>> = neurons
        .iter()
        .map(|neuron| neuron.and_then(|node| node.text(attribute)))
        .collect();
    let mut names: Vec<String> = texts.iter().flatten().cloned().collect();
    names.sort_by(|a, b| natural(a, b));
    names.dedup();
    if names.len() > scheme.palette.distinct_count() {
        let number = |n: &Option<Node<'_>>| n.and_then(|node| node.number(attribute));
        let numbers: Vec<Option<f64>> = neurons.iter().map(number).collect();
        let all = numbers.iter().zip(&texts);
        if all
            .into_iter()
            .all(|(number, text)| number.is_some() == text.is_some())
        {
            return Ok(on_scale(cells, &numbers, attribute, scheme));
        }
    }
    let number: BTreeMap<&str, usize> = names.iter().map(String::as_str).zip(0..).collect();
    let own: Vec<Option<usize>> = texts
        .iter()
        .map(|text| text.as_deref().map(|text| number[text]))
        .collect();
    Ok(categorical(cells, &own, &names, attribute, scheme))
}

/// The colors given in a scene, or those that were chosen for its groups; none if no cell has one.
pub fn given(
    cells: &[Cell<'_>],
    neurons: &[Option<Node<'_>>],
    scheme: &ColorScheme,
) -> Option<Coloring> {
    let mut colors = Distinct::default();
    let mut groups: BTreeMap<String, Rgb> = BTreeMap::new();
    let mut own = Vec::new();
    for neuron in neurons {
        let text = |attribute| neuron.and_then(|node| node.text(attribute));
        let rgb = text("color").as_deref().and_then(color);
        let group = text("group");
        let chosen = group
            .as_ref()
            .and_then(|group| scheme.own_colors.categories.get(group));
        let rgb = rgb.map(|rgb| chosen.copied().unwrap_or(rgb));
        own.push(rgb.map(|rgb| colors.index(rgb)));
        if let (Some(rgb), Some(group)) = (rgb, group) {
            groups.entry(group).or_insert(rgb);
        }
    }
    let things = groups.into_iter().map(|(group, color)| ColoredThing {
        target: ColorTarget::Category(group),
        color,
    });
    let things: Vec<ColoredThing> = things.collect();
    let entries = things
        .iter()
        .map(|thing| (thing.color, thing.target.to_string()));
    let legend = Legend::swatches("", entries);
    let colored = Coloring {
        things,
        ..painted(cells, &own, colors.colors, legend)
    };
    (!colored.table.scale.is_empty()).then_some(colored)
}

fn on_scale(
    cells: &[Cell<'_>],
    numbers: &[Option<f64>],
    attribute: &str,
    scheme: &ColorScheme,
) -> Coloring {
    let (low, high) = numbers
        .iter()
        .flatten()
        .fold((f64::MAX, f64::MIN), |(low, high), &n| {
            (low.min(n), high.max(n))
        });
    let [low, high] = scheme.range.unwrap_or([low as f32, high as f32]);
    let high = if high > low { high } else { low + 1.0 };
    let mut values = InstanceValues::default();
    for number in numbers {
        let share = |n: f64| ((n - f64::from(low)) / f64::from(high - low)) as f32;
        values.push(&[number.map_or(f32::NAN, share)]);
    }
    let mut coloring = scheme.scaled(first_values(cells), attribute, "", [low, high]);
    coloring.table.values = values;
    coloring
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::own_colors::OwnColors;
    use crate::scheme::NOTHING;
    use neurotess_circuit::Population;
    use neurotess_picture::color::Palette;

    /// Thirty nodes with these attributes.
    fn circuit(attributes: Vec<(&str, Attribute)>) -> Circuit {
        let own = attributes.into_iter().map(|(n, a)| (n.to_owned(), a));
        Circuit {
            file: "c".into(),
            format: "scene",
            populations: vec![Population {
                name: "p".into(),
                ids: (0..30).collect(),
                attributes: own.collect(),
                ..Population::default()
            }],
            templates: Vec::new(),
            node_sets: Default::default(),
            edges: Vec::new(),
            compartment_sets: BTreeMap::new(),
            declared_reports: Vec::new(),
            reports: BTreeMap::new(),
            warnings: Vec::new(),
            failures: Vec::new(),
        }
    }

    fn neurons(circuit: &Circuit) -> Vec<Option<Node<'_>>> {
        let node = |row| NodeRef { population: 0, row };
        let known = (0..30).map(|row| {
            Some(Node {
                circuit,
                node: node(row),
            })
        });
        // A tracing that was opened beside.
        known.chain([None]).collect()
    }

    fn values(shares: impl IntoIterator<Item = f32>) -> InstanceValues {
        let mut values = InstanceValues::default();
        shares.into_iter().for_each(|share| values.push(&[share]));
        values
    }

    fn scheme() -> ColorScheme {
        ColorScheme {
            palette: Palette::NeuroM,
            own_colors: OwnColors::default(),
            background: None,
            scale: vec![[0; 3], [255; 3]],
            range: None,
        }
    }

    #[test]
    fn neurons_of_equal_attributes_have_one_color_and_those_without_none() {
        let library = vec!["b".to_owned(), "a".to_owned()];
        let indices = (0..30)
            .map(|i| if i == 3 { Attribute::NONE } else { i % 2 })
            .collect();
        let circuit = circuit(vec![("kind", Attribute::Text { library, indices })]);
        let coloring = by_attribute(&[], &neurons(&circuit), "kind", &scheme()).expect("there");
        let share = |i: usize| match i {
            3 | 30 => f32::NAN,
            i => 1.0 - (i % 2) as f32,
        };
        assert_eq!(coloring.table.values, values((0..31).map(share)));
        let name = |n: &str, rgb| (rgb, n.to_owned());
        let distinct = |i| Palette::NeuroM.distinct(i);
        let expected = [
            name("a", distinct(0)),
            name("b", distinct(1)),
            name("none", NOTHING),
        ];
        assert_eq!(coloring.legend, Legend::swatches("kind", expected));
        let error = by_attribute(&[], &neurons(&circuit), "layer", &scheme());
        assert_eq!(error.expect_err("none").there, ["kind", "population"]);
    }

    #[test]
    fn many_numbers_are_on_a_scale_and_few_are_kinds() {
        let numbers =
            |most: u32| Attribute::Numbers((0..30).map(|i| f64::from(i % most)).collect());
        let circuit = circuit(vec![("depth", numbers(30)), ("layer", numbers(3))]);
        let neurons = neurons(&circuit);
        let coloring = |name, range| {
            let scheme = ColorScheme { range, ..scheme() };
            by_attribute(&[], &neurons, name, &scheme).expect("there")
        };
        let shares = |high: f32| (0..30).map(move |i| i as f32 / high).chain([f32::NAN]);
        assert_eq!(coloring("depth", None).table.values, values(shares(29.0)));
        let wider = coloring("depth", Some([0.0, 58.0]));
        assert_eq!(wider.table.values, values(shares(58.0)));
        assert_eq!(coloring("layer", None).table.scale.len(), 3);
    }

    #[test]
    fn each_neuron_has_its_own_color() {
        let names: Vec<String> = (0..4).map(|i| format!("n{i}")).collect();
        let four = each(&[], &names, &scheme());
        let shares = (0..4).map(|i| i as f32 / 3.0);
        assert_eq!(four.table.values, values(shares));
        assert_eq!(four.table.scale.len(), 4);
        let one = each(&[], &names[..1], &scheme());
        assert_eq!(one.table.values, values([0.0]));
    }

    #[test]
    fn colors_of_a_scene_are_taken_as_they_are() {
        let library = vec!["#102030".to_owned()];
        let indices = (0..30).map(|i| if i == 2 { 0 } else { Attribute::NONE });
        let indices = indices.collect();
        let circuit = circuit(vec![("color", Attribute::Text { library, indices })]);
        let given = given(&[], &neurons(&circuit), &scheme()).expect("colors");
        assert_eq!(given.table.scale, [[16, 32, 48]]);
        let share = |i| if i == 2 { 0.0 } else { f32::NAN };
        assert_eq!(given.table.values, values((0..31).map(share)));
    }
    fn with_own(own: &[(&str, Rgb)]) -> ColorScheme {
        let mut scheme = scheme();
        for &(name, color) in own {
            scheme.own_colors.set_named(name, color);
        }
        scheme
    }

    #[test]
    fn own_colors_stand_out_of_those_that_repeat() {
        let names: Vec<String> = (0..30).map(|i| format!("n{i}")).collect();
        let scheme = with_own(&[("n17", [1, 2, 3])]);
        let coloring = each(&[], &names, &scheme);
        assert_eq!(coloring.things.len(), 30);
        let entries = [([1, 2, 3], "n17".to_owned())];
        let title = "30 neurons, colors repeat";
        assert_eq!(coloring.legend, Legend::swatches(title, entries));
        let count = Palette::NeuroM.distinct_count();
        assert_eq!(coloring.table.scale.len(), count + 1);
        let share = |i: usize| if i == 17 { count } else { i % count } as f32 / count as f32;
        assert_eq!(coloring.table.values, values((0..30).map(share)));
        // None repeats once all are chosen.
        let own: Vec<(&str, Rgb)> = names
            .iter()
            .zip(0..)
            .map(|(n, i)| (n.as_str(), [i, 0, 9]))
            .collect();
        assert_eq!(
            each(&[], &names, &with_own(&own)).legend.entries().len(),
            30
        );
    }

    #[test]
    fn kinds_and_groups_have_own_colors() {
        let library = vec!["b".to_owned(), "a".to_owned(), "#102030".to_owned()];
        let column = |of: fn(u32) -> u32| Attribute::Text {
            library: library.clone(),
            indices: (0..30).map(of).collect(),
        };
        let circuit = circuit(vec![("group", column(|i| i % 2)), ("color", column(|_| 2))]);
        let scheme = with_own(&[("a", [1, 2, 3]), ("none", [4, 5, 6])]);
        let kinds = by_attribute(&[], &neurons(&circuit), "group", &scheme).expect("there");
        let listed = |coloring: &Coloring| -> Vec<(Rgb, String)> {
            let things = coloring.things.iter();
            things
                .map(|thing| (thing.color, thing.target.to_string()))
                .collect()
        };
        let name = |n: &str, rgb| (rgb, n.to_owned());
        let b = name("b", Palette::NeuroM.distinct(1));
        assert_eq!(
            listed(&kinds),
            [name("a", [1, 2, 3]), b, name("none", [4, 5, 6])]
        );
        assert_eq!(kinds.legend.entries(), listed(&kinds));
        assert_eq!(kinds.table.categories, [[4, 5, 6]]);
        let given = given(&[], &neurons(&circuit), &scheme).expect("colors");
        assert_eq!(
            listed(&given),
            [name("a", [1, 2, 3]), name("b", [16, 32, 48])]
        );
        assert_eq!(given.table.scale, [[16, 32, 48], [1, 2, 3]]);
    }
}
