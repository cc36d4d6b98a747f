//! Spines that a file tells of: postsynaptic densities on the sections of a cell, and the table of spines that
//! [morph-spines](https://github.com/openbraininstitute/morph-spines) has beside a cell.
//!
//! A density is so many µm along a segment of a section. (In a file that is itself a spine, it lies on that spine and
//! tells of no other.) A row of the table has the place on the membrane, the direction and the length: together the
//! spine's end.

use glam::DVec3;

use super::Tables;
use crate::Fault;
use crate::hdf5::{Store, Table};
use crate::traced::SPINES_LEFT_OUT;
use crate::warning::Warnings;

/// Value of `cell_family` of files that are a spine.
const SPINE: i64 = 2;
/// Group of densities.
const DENSITIES: &str = "organelles/postsynaptic_density";

/// Places (µm) of spines. `member`: path of the cell's group with a slash at its end; empty for the root.
pub(super) fn spines(
    store: &Store,
    member: &str,
    tables: &Tables,
    warnings: &mut Warnings,
) -> Result<Vec<DVec3>, Fault> {
    let mut spines = densities(store, member, tables, warnings)?;
    spines.extend(tips(store, member)?);
    let found = spines.len() as u64;
    if found > 0 {
        warnings.add_many(1, SPINES_LEFT_OUT.0, SPINES_LEFT_OUT.1, found);
    }
    Ok(spines)
}

/// Whether a cell has organelles of which nothing is read.
pub(super) fn has_other_organelles(store: &Store, member: &str) -> bool {
    let organelles = format!("{member}organelles");
    let groups = store.groups(&organelles);
    let is_read = groups == ["postsynaptic_density"] && !is_spine(store, member);
    store.has_group(&organelles) && !is_read
}

fn is_spine(store: &Store, member: &str) -> bool {
    store.whole_attribute(&format!("{member}metadata"), "cell_family") == [SPINE]
}

fn densities(
    store: &Store,
    member: &str,
    tables: &Tables,
    warnings: &mut Warnings,
) -> Result<Vec<DVec3>, Fault> {
    let path = |name: &str| format!("{member}{DENSITIES}/{name}");
    let columns = ["section_id", "segment_id", "offset"].map(path);
    if is_spine(store, member) || !columns.iter().all(|path| store.has(path)) {
        return Ok(Vec::new());
    }
    let [sections, segments, offsets] = &columns;
    let (sections, segments) = (store.wholes(sections, 1)?, store.wholes(segments, 1)?);
    let offsets = store.reals(offsets, 1)?;
    let rows = sections.rows.min(segments.rows).min(offsets.rows);
    let mut places = Vec::new();
    for row in 0..rows {
        let at = [sections.row(row)[0], segments.row(row)[0]];
        match place(tables, at, offsets.row(row)[0]) {
            Some(place) => places.push(place),
            None => warnings.add(
                row as u64 + 1,
                "density_off_tree",
                "a postsynaptic density on no segment: left out",
            ),
        }
    }
    Ok(places)
}

/// The place that is `offset` (µm) along a segment, no farther than its end.
fn place(tables: &Tables, [section, segment]: [i64; 2], offset: f64) -> Option<DVec3> {
    let section = usize::try_from(section).ok()?;
    let segment = usize::try_from(segment).ok()?;
    let points = (section < tables.sections.len()).then(|| tables.range(section).ok())??;
    let first = points.start.checked_add(segment)?;
    if first.checked_add(1)? >= points.end || !offset.is_finite() {
        return None;
    }
    let [from, to] = [first, first + 1].map(|point| tables.sample(point).ok());
    let (from, to) = (from?.position, to?.position);
    let length = from.distance(to).max(f64::MIN_POSITIVE);
    Some(from.lerp(to, (offset / length).clamp(0.0, 1.0)))
}

/// Ends of spines in the table of a cell `morphology/NAME`, which is `edges/NAME`.
fn tips(store: &Store, member: &str) -> Result<Vec<DVec3>, Fault> {
    let name = member.trim_matches('/').strip_prefix("morphology/");
    let Some(name) = name else {
        return Ok(Vec::new());
    };
    let columns = |what: &str| ["x", "y", "z"].map(|axis| format!("edges/{name}/{what}_{axis}"));
    let bases = columns("afferent_surface");
    let directions = columns("spine_orientation_vector");
    let length = format!("edges/{name}/spine_length");
    let mut all = bases.iter().chain(&directions).chain([&length]);
    if !all.all(|path| store.has(path)) {
        return Ok(Vec::new());
    }
    let (bases, directions) = (vectors(store, &bases)?, vectors(store, &directions)?);
    let lengths = store.reals(&length, 1)?;
    let lengths = (0..lengths.rows).map(|row| lengths.row(row)[0]);
    let rows = bases.into_iter().zip(directions).zip(lengths);
    let tips = rows.map(|((base, direction), length)| base + length * direction);
    Ok(tips.filter(|tip| tip.is_finite()).collect())
}

fn vectors(store: &Store, [x, y, z]: &[String; 3]) -> Result<Vec<DVec3>, Fault> {
    let [x, y, z]: [Table<f64>; 3] = [store.reals(x, 1)?, store.reals(y, 1)?, store.reals(z, 1)?];
    let rows = x.rows.min(y.rows).min(z.rows);
    let vector = |row: usize| DVec3::new(x.row(row)[0], y.row(row)[0], z.row(row)[0]);
    Ok((0..rows).map(vector).collect())
}
