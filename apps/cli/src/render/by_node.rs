//! Colours that cells of a circuit have as a whole: each its own, those of an attribute, or those that a
//! scene gives them. Cells of one morphology share it; a value for each says its colour.

use std::collections::BTreeMap;

use neurotess::circuit::{Attribute, Circuit, Groups, Instance, color};
use neurotess::render::{ColourTable, InstanceValues, Legend, Rgb};

use super::cells::Cell;
use super::colouring::{Colouring, NOTHING, Paint};
use super::values::Shown;

/// Every cell its own colour.
pub(crate) fn each(cells: &[&Cell], shown: &Shown, paint: &Paint) -> Colouring {
    let name = |instance: &Instance| {
        let population = &shown.circuit.populations[instance.node.population as usize];
        format!("{} {}", population.name, instance.id)
    };
    let names: Vec<String> = shown.instances.iter().map(name).collect();
    let own: Vec<usize> = (0..names.len()).collect();
    told_apart(cells, &own, &names, "neuron", paint)
}

/// Cells of equal attribute have one colour.
pub(crate) fn by_attribute(
    cells: &[&Cell],
    shown: &Shown,
    attribute: &str,
    paint: &Paint,
) -> anyhow::Result<Colouring> {
    let circuit = &shown.circuit;
    let known = attributes(circuit);
    if !known.iter().any(|name| name == attribute) {
        anyhow::bail!(
            "{}: no cell has an attribute '{attribute}': there are {}",
            circuit.file,
            known.join(", ")
        );
    }
    let groups = Groups::by(circuit, attribute);
    let own: Vec<usize> = shown
        .instances
        .iter()
        .map(|i| groups.of(i.node) as usize)
        .collect();
    let named = |word: &String| {
        if word.is_empty() {
            "none"
        } else {
            word.as_str()
        }
        .to_owned()
    };
    // Only those that show.
    let mut used: BTreeMap<usize, usize> = own.iter().map(|&group| (group, 0)).collect();
    used.values_mut()
        .zip(0..)
        .for_each(|(place, number)| *place = number);
    let names: Vec<String> = used
        .keys()
        .map(|&group| named(&groups.words[group]))
        .collect();
    let own: Vec<usize> = own.iter().map(|group| used[group]).collect();
    Ok(told_apart(cells, &own, &names, attribute, paint))
}

/// The colours that a scene gives its cells; none if it gives no cell any.
pub(crate) fn given(cells: &[&Cell], shown: &Shown) -> Option<Colouring> {
    let word = |instance: &Instance, attribute: &str| {
        let population = &shown.circuit.populations[instance.node.population as usize];
        let word = population
            .attributes
            .get(attribute)?
            .word(instance.node.row as usize)?;
        Some(word.to_owned())
    };
    let mut colours: Vec<Rgb> = vec![NOTHING];
    let mut names: BTreeMap<String, Rgb> = BTreeMap::new();
    let mut own = Vec::new();
    for instance in &shown.instances {
        let rgb = word(instance, "color").as_deref().and_then(color);
        let place = rgb.map_or(0, |rgb| {
            let known = colours.iter().skip(1).position(|&other| other == rgb);
            known.map_or(colours.len(), |place| place + 1)
        });
        colours.extend(rgb.filter(|_| place == colours.len()));
        own.push(place);
        if let (Some(rgb), Some(group)) = (rgb, word(instance, "group")) {
            names.entry(group).or_insert(rgb);
        }
    }
    let swatches = names.into_iter().map(|(name, rgb)| (rgb, name));
    let legend = Legend::swatches("", swatches);
    (colours.len() > 1).then(|| painted(cells, &own, colours, legend))
}

/// Attributes that cells can be told apart by.
fn attributes(circuit: &Circuit) -> Vec<String> {
    let of_all = circuit.populations.iter().flat_map(|p| &p.attributes);
    let named = |(name, attribute): (&String, &Attribute)| {
        let words = matches!(attribute, Attribute::Words { .. } | Attribute::Numbers(_));
        words.then(|| name.clone())
    };
    let mut names: Vec<String> = of_all.filter_map(named).collect();
    names.push("population".into());
    names.sort();
    names.dedup();
    names
}

fn told_apart(
    cells: &[&Cell],
    own: &[usize],
    names: &[String],
    thing: &str,
    paint: &Paint,
) -> Colouring {
    let count = names.len().min(paint.palette.distinct_count()).max(1);
    let colours: Vec<Rgb> = (0..count).map(|i| paint.palette.distinct(i)).collect();
    let legend = if names.len() > count {
        let title = format!("{} {thing}s, colours repeat", names.len());
        Legend::swatches(&title, Vec::new())
    } else {
        let title = if thing == "neuron" { "" } else { thing };
        Legend::swatches(title, colours.iter().copied().zip(names.iter().cloned()))
    };
    let own: Vec<usize> = own.iter().map(|&place| place % count).collect();
    painted(cells, &own, colours, legend)
}

fn painted(cells: &[&Cell], own: &[usize], colours: Vec<Rgb>, legend: Legend) -> Colouring {
    let last = (colours.len() - 1).max(1) as f32;
    let mut values = InstanceValues::default();
    own.iter()
        .for_each(|&place| values.push(&[place as f32 / last]));
    Colouring {
        // The first value of whichever cell shows the morphology.
        words: cells
            .iter()
            .map(|cell| vec![0; cell.mesh.tracing.len()])
            .collect(),
        legend,
        table: ColourTable {
            scale: colours,
            categories: vec![NOTHING],
            values,
        },
    }
}
