//! What is to be done: files, and the cells in each; and what they are made of, as text.

use std::fs;
use std::time::UNIX_EPOCH;

use neurotess_batch::Shard;
use neurotess_formats as formats;
use neurotess_recipe::MESHES;
use serde_json::json;

use crate::folder::Files;
use crate::levels::LevelOptions;
use crate::shards::Sharding;
use crate::source::Source;
use neurotess_formats::precomputed::murmur;

/// Raised when files of the same cells and options are others than before.
const FORMAT: u32 = 2;

/// Files that are written at once, and the cells in them.
pub(crate) struct Unit {
    pub(crate) files: Files,
    /// In the order of the file.
    pub(crate) cells: Vec<usize>,
}

/// The units of a part of the work, in the order of their numbers. Every process that has the same cells divides them the
/// same way, by whole shards, so that two never write the same file.
pub(crate) fn units(ids: &[u64], sharding: Option<Sharding>, part: Option<Shard>) -> Vec<Unit> {
    let units = match sharding {
        None => {
            let cells = ids.iter().enumerate();
            let unit = |(cell, &id)| Unit {
                files: Files::Cell(id),
                cells: vec![cell],
            };
            cells.map(unit).collect()
        }
        Some(sharding) => {
            let mut order: Vec<usize> = (0..ids.len()).collect();
            order.sort_by_key(|&cell| (sharding.place(ids[cell]), ids[cell]));
            let shard = |cell: &usize| sharding.place(ids[*cell]).shard;
            let chunks = order.chunk_by(|a, b| shard(a) == shard(b));
            let unit = |cells: &[usize]| Unit {
                files: Files::Shard(shard(&cells[0])),
                cells: cells.to_vec(),
            };
            chunks.map(unit).collect()
        }
    };
    match part {
        None => units,
        Some(part) => part.of(units),
    }
}

/// What files depend on, as text that is the same for the same files only: options, and for each cell its id, its tracing's
/// file with length and time, and its place.
pub(crate) fn text(
    source: &Source,
    ids: &[u64],
    levels: LevelOptions,
    sharding: Option<Sharding>,
) -> String {
    let stamps: Vec<u64> = source
        .uses()
        .iter()
        .enumerate()
        .map(|(template, &uses)| if uses > 0 { stamp(source, template) } else { 0 })
        .collect();
    let mut hash = 0;
    for (cell, id) in ids.iter().enumerate() {
        // Where the soma's center is depends on the tracing alone.
        let place = source.placement(cell, glam::DVec3::ZERO).to_cols_array();
        let words = [hash, *id, stamps[source.template(cell)]];
        let words = words.into_iter().chain(place.map(f64::to_bits));
        hash = murmur(&words.flat_map(u64::to_le_bytes).collect::<Vec<_>>());
    }
    let plan = json!({
        "precomputed": FORMAT,
        "meshes": MESHES,
        "max_error": levels.max_error,
        "levels": levels.count,
        "sharding": sharding.map(Sharding::json),
        "cells": ids.len(),
        "hash": format!("{hash:016x}"),
    });
    format!("{plan:#}\n")
}

/// A hash of a tracing's file: its name, and its length and time.
fn stamp(source: &Source, template: usize) -> u64 {
    let path = source.file(template);
    let data = fs::metadata(formats::member(path).0).ok();
    let modified = data.as_ref().and_then(|data| data.modified().ok());
    let since = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    let numbers = [
        u128::from(data.map_or(0, |data| data.len())),
        since.map_or(0, |since| since.as_nanos()),
    ];
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    murmur(&[numbers.map(u128::to_le_bytes).as_flattened(), name].concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_whole_shards_in_the_order_of_files() {
        let ids: Vec<u64> = (1..=2000).collect();
        let sharding = Sharding::for_count(ids.len());
        let all = units(&ids, Some(sharding), None);
        assert_eq!(all.len(), 4);
        assert_eq!(all.iter().map(|unit| unit.cells.len()).sum::<usize>(), 2000);
        for unit in &all {
            let order = unit
                .cells
                .iter()
                .map(|&cell| (sharding.place(ids[cell]), ids[cell]));
            assert!(order.is_sorted());
        }
        let part = |text: &str| {
            let units = units(&ids, Some(sharding), text.parse().ok());
            units.iter().map(|unit| unit.files).collect::<Vec<_>>()
        };
        let (first, second) = (part("1/2"), part("2/2"));
        assert_eq!(first, [Files::Shard(0), Files::Shard(2)]);
        assert_eq!(second, [Files::Shard(1), Files::Shard(3)]);
    }
}
