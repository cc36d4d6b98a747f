//! From a table of nodes to a population: places, rotations, morphologies.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use rayon::prelude::*;

use crate::sonata::config::{NodeSource, PopulationSource};
use crate::sonata::finder::Finder;
use crate::sonata::nodes::Table;
use crate::sonata::notes::{Broken, Notes};
use crate::sonata::orientation;
use crate::sonata::places::{self, Placed};
use crate::template::TemplateId;
use crate::{Attribute, CircuitError, Fault, Population, Warning};

const QUATERNION: [&str; 4] = [
    "orientation_w",
    "orientation_x",
    "orientation_y",
    "orientation_z",
];
const ANGLES: [&str; 3] = [
    "rotation_angle_xaxis",
    "rotation_angle_yaxis",
    "rotation_angle_zaxis",
];

/// Reads a population from its table. `file` is the nodes' file.
pub(crate) fn read(
    name: &str,
    file: &str,
    table: &Table,
    source: &NodeSource,
    notes: &mut Notes,
) -> Result<Population, CircuitError> {
    let listed = source.populations.as_ref().and_then(|list| list.get(name));
    let unlisted = PopulationSource {
        kind: None,
        morphologies: source.morphologies.clone(),
    };
    let settings = listed.unwrap_or(&unlisted);
    let mut population = Population {
        name: name.into(),
        kind: settings.kind.clone().unwrap_or_default(),
        ids: table.ids.clone(),
        positions: vec![DVec3::NAN; table.len()],
        rotations: vec![DQuat::IDENTITY; table.len()],
        templates: vec![None; table.len()],
        ..Population::default()
    };
    let mut broken = Broken {
        file,
        rows: vec![false; table.len()],
    };
    let placed = places::read(table, &mut population, &mut broken, notes)?;
    rotations(table, &mut population, &mut broken, notes)?;
    recentering(table, &mut population)?;
    let names: Vec<String> = table
        .attributes()
        .into_iter()
        .filter(|name| !is_rotation(name) && !placed.read_from.contains(&name.as_str()))
        .collect();
    let columns: Vec<_> = names.par_iter().map(|name| table.attribute(name)).collect();
    for (name, column) in names.into_iter().zip(columns) {
        match column {
            Ok(Some(column)) => drop(population.attributes.insert(name, column)),
            Ok(None) => {}
            // One that cannot be read, like an array per node, does not keep the cells from showing.
            Err(e) if name != "morphology" => notes.warnings.push(Warning::new(
                file,
                table.key(&name),
                "attribute_left_out",
                e.fault.to_string(),
            )),
            Err(e) => return Err(e),
        }
    }
    morphologies(table, &mut population, settings, (&broken, &placed), notes);
    Ok(population)
}

/// Whether an attribute is read as a rotation.
fn is_rotation(name: &str) -> bool {
    QUATERNION.contains(&name) || ANGLES.contains(&name)
}

/// Each node by what its own group or type says: by its quaternion, or else by its angles.
fn rotations(
    table: &Table,
    population: &mut Population,
    broken: &mut Broken,
    notes: &mut Notes,
) -> Result<(), CircuitError> {
    let by_angles = quaternions(table, population, broken, notes)?;
    if !ANGLES.iter().any(|name| table.has(name)) {
        return Ok(());
    }
    let n = population.len();
    let columns = ANGLES.map(|name| table.numbers(name));
    let [x, y, z] = columns;
    let columns = [x?, y?, z?].map(|column| column.unwrap_or_else(|| vec![0.0; n]));
    let mut faulty = Vec::new();
    let rows = population.rotations.iter_mut().enumerate().zip(by_angles);
    for ((row, rotation), _) in rows.filter(|(_, by_angles)| *by_angles) {
        // NaN is what no value reads as, so a missing angle and a NaN one are alike: zero.
        let angles = [0, 1, 2].map(|axis: usize| match columns[axis][row] {
            angle if angle.is_nan() => 0.0,
            angle => angle,
        });
        match orientation::from_angles(angles) {
            Some(unit) => *rotation = unit,
            None => faulty.push((row, f64::INFINITY)),
        }
    }
    let named = ANGLES.iter().find(|name| table.has(name));
    let key = table.key(named.unwrap_or(&ANGLES[0]));
    broken.mark(key, &faulty, false, notes);
    Ok(())
}

/// Turns nodes that have a quaternion, and tells which have none.
fn quaternions(
    table: &Table,
    population: &mut Population,
    broken: &mut Broken,
    notes: &mut Notes,
) -> Result<Vec<bool>, CircuitError> {
    let components = QUATERNION.map(|name| table.has(name));
    let mut without = vec![true; population.len()];
    if !components.contains(&true) {
        return Ok(without);
    }
    if let Some(missing) = components.iter().position(|there| !there) {
        let key = format!("{}: {}", table.path(), QUATERNION[missing]);
        return Err(CircuitError::new(
            broken.file,
            key,
            Fault::PartialQuaternion,
        ));
    }
    let columns = QUATERNION.map(|name| table.numbers(name).map(Option::unwrap_or_default));
    let [w, x, y, z] = columns;
    let columns = [w?, x?, y?, z?];
    let (mut zero, mut not_finite) = (Vec::new(), Vec::new());
    for (row, rotation) in population.rotations.iter_mut().enumerate() {
        let q = [0, 1, 2, 3].map(|c: usize| columns[c][row]);
        // A node of a group without orientations.
        if q.iter().all(|c| c.is_nan()) {
            continue;
        }
        without[row] = false;
        match orientation::from_components(q) {
            Some(unit) => *rotation = unit,
            None if q == [0.0; 4] => zero.push((row, 0.0)),
            None => {
                let value = q.into_iter().find(|c| !c.is_finite());
                not_finite.push((row, value.unwrap_or(f64::NAN)));
            }
        }
    }
    broken.mark(table.key(QUATERNION[0]), &zero, true, notes);
    broken.mark(table.key(QUATERNION[0]), &not_finite, false, notes);
    Ok(without)
}

/// `recenter`: 0 leaves the morphology where its file has it.
fn recentering(table: &Table, population: &mut Population) -> Result<(), CircuitError> {
    if let Some(recenter) = table.numbers("recenter")?
        && recenter.contains(&0.0)
    {
        population.recentered = recenter.iter().map(|&r| r != 0.0).collect();
    }
    Ok(())
}

/// Finds the file of each distinct name once.
fn morphologies(
    table: &Table,
    population: &mut Population,
    settings: &PopulationSource,
    (broken, placed): (&Broken, &Placed),
    notes: &mut Notes,
) {
    let Some(Attribute::Text { library, indices }) = population.attributes.get("morphology") else {
        return;
    };
    let folders = &settings.morphologies;
    let swc = folders.swc.iter().map(|folder| (&**folder, "swc"));
    let others = folders.others.iter().map(|(e, folder)| (&**folder, *e));
    // Some circuits keep other formats in the folder for SWC.
    let mixed = folders
        .swc
        .iter()
        .flat_map(|folder| [(&**folder, "asc"), (&**folder, "h5")]);
    let finder = Finder::new(swc.chain(others).chain(mixed), notes.failures);
    let mut uses: BTreeMap<u32, u64> = BTreeMap::new();
    for &index in indices {
        *uses.entry(index).or_default() += 1;
    }
    let mut missing: Vec<(&str, u64)> = Vec::new();
    let mut templates: Vec<Option<TemplateId>> = vec![None; library.len()];
    for (&index, &count) in &uses {
        let Some(name) = library.get(index as usize) else {
            continue;
        };
        if ["NULL", "NONE", ""].contains(&name.as_str()) {
            continue;
        }
        match finder.find(name) {
            Some(path) => templates[index as usize] = Some((notes.template)(path)),
            None => missing.push((name, count)),
        }
    }
    let (mut unplaced, mut at_origin) = (0, 0);
    for (row, &index) in indices.iter().enumerate() {
        let template = templates.get(index as usize).copied().flatten();
        if template.is_none() || broken.rows[row] {
            continue;
        }
        if population.positions[row].is_finite() {
            population.templates[row] = template;
        } else if placed.has_place[row] {
            unplaced += 1;
        } else {
            at_origin += 1;
            population.positions[row] = DVec3::ZERO;
            population.templates[row] = template;
        }
    }
    tell_missing(table, broken.file, &missing, settings, notes);
    let mut tell = |count: u64, code, what: &str| {
        if count > 0 {
            let message = format!("{count} nodes have a morphology but no place: {what}");
            let warning = Warning::new(broken.file, table.path(), code, message);
            notes.warnings.push(warning.times(count));
        }
    };
    tell(unplaced, "position_missing", "they are not shown");
    let at = "they are shown at the origin";
    tell(at_origin, "placed_at_origin", at);
}

fn tell_missing(
    table: &Table,
    file: &str,
    missing: &[(&str, u64)],
    settings: &PopulationSource,
    notes: &mut Notes,
) {
    if let Some((name, _)) = missing.first() {
        let nodes = missing.iter().map(|(_, count)| count).sum::<u64>();
        let folders = &settings.morphologies;
        let others = folders.others.iter().map(|(_, folder)| folder);
        let searched: Vec<String> = folders
            .swc
            .iter()
            .chain(others)
            .map(|folder| folder.display().to_string())
            .collect();
        let place = match &searched[..] {
            [] => "the configuration names no folder of morphologies".into(),
            some => format!("searched {}", some.join(", ")),
        };
        let message = format!(
            "{} morphologies of {nodes} nodes are not there, the first is {name}: {place}",
            missing.len()
        );
        let key = table.key("morphology");
        let warning = Warning::new(file, key, "morphology_missing", message);
        notes.warnings.push(warning.times(nodes));
    }
}
