//! Points with numbers and segments (`neuroglancer_annotations_v1`): by id, by the segments that they belong to, by place.
//!
//! The numbers of a point are those of four bytes first, then bytes, then zeros up to four: readers disagree about every
//! other order. `POINT` is in capitals, as the format says and as all readers take it.

use std::collections::BTreeMap;
use std::io::{BufWriter, Write};

use glam::DVec3;
use neurotess_output::OutputError;
use serde_json::{Value, json};

use crate::facts::around;
use crate::folder::Folder;
use crate::shards::{ShardWriter, Sharding};
use neurotess_formats::precomputed::murmur;

/// Most points of a cell of the grid that a view fetches at once.
const LIMIT: usize = 5000;

/// Halvings of the grid. A guard against points in one place.
const MOST_LEVELS: u32 = 12;

/// Numbers of points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PointValues {
    /// Floating-point numbers.
    F32(Vec<f32>),
    /// Bytes, each of which stands for a text.
    Enum(Vec<u8>, Vec<String>),
}

/// Points, each with its id: its index and 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Points {
    /// Places (nm).
    pub(crate) places: Vec<DVec3>,
    /// Numbers by name, for each point.
    pub(crate) values: Vec<(String, PointValues)>,
    /// By name: the segment that each point belongs to, 0 for none.
    pub(crate) segments: Vec<(String, Vec<u64>)>,
}

impl Points {
    /// The same with numbers in the order of files.
    fn in_order(mut self) -> Self {
        self.values.sort_by_key(|(_, values)| match values {
            PointValues::F32(_) => 0,
            PointValues::Enum(..) => 1,
        });
        self
    }

    /// Appends a point's place and numbers.
    fn push(&self, point: usize, bytes: &mut Vec<u8>) {
        let place = self.places[point].to_array();
        bytes.extend(
            place
                .map(|along| (along as f32).to_le_bytes())
                .as_flattened(),
        );
        let mut own = 0;
        for (_, values) in &self.values {
            match values {
                PointValues::F32(values) => bytes.extend(values[point].to_le_bytes()),
                PointValues::Enum(values, _) => {
                    bytes.push(values[point]);
                    own += 1;
                }
            }
        }
        bytes.extend(std::iter::repeat_n(
            0,
            usize::next_multiple_of(own, 4) - own,
        ));
    }

    /// A point by itself: with the segments of each relationship.
    fn one(&self, point: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.push(point, &mut bytes);
        for (_, segments) in &self.segments {
            let segment = Some(segments[point]).filter(|&segment| segment > 0);
            bytes.extend(u32::from(segment.is_some()).to_le_bytes());
            bytes.extend(segment.into_iter().flat_map(u64::to_le_bytes));
        }
        bytes
    }

    /// Several points: how many, the points, their ids.
    fn several(&self, points: &[usize]) -> Vec<u8> {
        let mut bytes = (points.len() as u64).to_le_bytes().to_vec();
        for &point in points {
            self.push(point, &mut bytes);
        }
        bytes.extend(points.iter().flat_map(|&point| id(point).to_le_bytes()));
        bytes
    }

    /// A box around all, of whole numbers, and of whole cells at all levels: with others cloud-volume finds nothing.
    fn bounds(&self) -> (DVec3, DVec3) {
        let (min, max) = around(self.places.iter().copied());
        let min = min.floor();
        let most = f64::from(1_u32 << MOST_LEVELS);
        (min, min + ((max - min + DVec3::ONE) / most).ceil() * most)
    }

    /// Points by cell of a grid, level by level, each of which has twice as many cells along each axis. A cell gets the
    /// first of the points that no coarser one has, in an order without any meaning.
    fn by_place(&self) -> Vec<BTreeMap<[u32; 3], Vec<usize>>> {
        let (min, max) = self.bounds();
        let mut left: Vec<usize> = (0..self.places.len()).collect();
        left.sort_by_key(|&point| murmur(&id(point).to_le_bytes()));
        let mut levels = Vec::new();
        while !left.is_empty() {
            let level = levels.len() as u32;
            let cells = f64::from(1_u32 << level);
            let mut grid: BTreeMap<[u32; 3], Vec<usize>> = BTreeMap::new();
            left.retain(|&point| {
                let share = (self.places[point] - min) / (max - min) * cells;
                let cell = share
                    .to_array()
                    .map(|along| along.clamp(0.0, cells - 1.0) as u32);
                let there = grid.entry(cell).or_default();
                let is_full = there.len() >= LIMIT && level < MOST_LEVELS;
                if !is_full {
                    there.push(point);
                }
                is_full
            });
            levels.push(grid);
        }
        levels
    }
}

/// The id of a point.
fn id(point: usize) -> u64 {
    point as u64 + 1
}

/// Writes points into a folder of the folder.
pub(crate) fn write_points(folder: &Folder, name: &str, points: Points) -> Result<(), OutputError> {
    let points = points.in_order();
    let by_place = points.by_place();
    for (level, grid) in by_place.iter().enumerate() {
        for ([x, y, z], there) in grid {
            let file = format!("{name}/place{level}/{x}_{y}_{z}");
            folder.shared(&file, |to| to.write_all(&points.several(there)))?;
        }
    }
    let all: Vec<u64> = (0..points.places.len()).map(id).collect();
    let of_ids = write_shards(folder, &format!("{name}/by_id"), all, |id| {
        points.one(id as usize - 1)
    })?;
    let mut related = Vec::new();
    for (relationship, segments) in &points.segments {
        let mut of_segment: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        for (point, &segment) in segments
            .iter()
            .enumerate()
            .filter(|(_, segment)| **segment > 0)
        {
            of_segment.entry(segment).or_default().push(point);
        }
        let key = format!("{name}/{relationship}");
        let ids = of_segment.keys().copied().collect();
        let sharding = write_shards(folder, &key, ids, |segment| {
            points.several(&of_segment[&segment])
        })?;
        related.push(json!({"id": relationship, "key": relationship, "sharding": sharding.json()}));
    }
    let info = info(&points, &by_place, of_ids, &related);
    folder.shared(&format!("{name}/info"), |to| writeln!(to, "{info:#}"))
}

/// Writes objects by id, in shards.
fn write_shards(
    folder: &Folder,
    key: &str,
    mut ids: Vec<u64>,
    object: impl Fn(u64) -> Vec<u8>,
) -> Result<Sharding, OutputError> {
    let sharding = Sharding::for_count(ids.len());
    ids.sort_unstable_by_key(|&id| (sharding.place(id), id));
    for shard in ids.chunk_by(|&a, &b| sharding.place(a).shard == sharding.place(b).shard) {
        let file = sharding.file_name(sharding.place(shard[0]).shard);
        let path = folder.path(key).join(file);
        let broken = |error| OutputError::broken(&path, error);
        let mut output = Folder::output(&path)?;
        let to = BufWriter::new(output.file());
        let mut writer = ShardWriter::begin(to, sharding).map_err(broken)?;
        for &id in shard {
            writer.add(id, &[], &object(id)).map_err(broken)?;
        }
        writer.finish().map_err(broken)?;
        output.finish()?;
    }
    Ok(sharding)
}

fn info(
    points: &Points,
    by_place: &[BTreeMap<[u32; 3], Vec<usize>>],
    of_ids: Sharding,
    related: &[Value],
) -> Value {
    let (min, max) = points.bounds();
    let property = |(name, values): &(String, PointValues)| match values {
        PointValues::F32(_) => json!({"id": name, "type": "float32"}),
        PointValues::Enum(_, texts) => {
            let values: Vec<usize> = (0..texts.len()).collect();
            json!({"id": name, "type": "uint8", "enum_values": values, "enum_labels": texts})
        }
    };
    let places = by_place.iter().enumerate().map(|(level, grid)| {
        let cells = 1_u32 << level;
        json!({
            "key": format!("place{level}"),
            "grid_shape": [cells, cells, cells],
            "chunk_size": ((max - min) / f64::from(cells)).to_array(),
            "limit": grid.values().map(Vec::len).max().unwrap_or(1).max(1),
        })
    });
    json!({
        "@type": "neuroglancer_annotations_v1",
        "annotation_type": "POINT",
        "dimensions": {"x": [1e-9, "m"], "y": [1e-9, "m"], "z": [1e-9, "m"]},
        "lower_bound": min.to_array(),
        "upper_bound": max.to_array(),
        "properties": points.values.iter().map(property).collect::<Vec<_>>(),
        "relationships": related,
        "by_id": {"key": "by_id", "sharding": of_ids.json()},
        "spatial": places.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> Points {
        let texts = vec!["local".to_owned(), "far".to_owned()];
        Points {
            places: vec![DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)],
            values: vec![
                ("edges".into(), PointValues::Enum(vec![1, 0], texts)),
                ("weight".into(), PointValues::F32(vec![0.5, f32::NAN])),
            ],
            segments: vec![("pre".into(), vec![0, 9]), ("post".into(), vec![7, 7])],
        }
    }

    #[test]
    fn numbers_of_four_bytes_come_first_and_the_end_is_padded() {
        let points = points().in_order();
        let bytes = points.one(0);
        let expected: Vec<u8> = [1.0_f32, 2.0, 3.0, 0.5]
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .chain([1, 0, 0, 0])
            // No segment before it, one behind it.
            .chain([0, 0, 0, 0])
            .chain([1, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0])
            .collect();
        assert_eq!(bytes, expected);
    }

    #[test]
    fn several_points_are_a_number_points_and_ids() {
        let points = points().in_order();
        let bytes = points.several(&[1, 0]);
        assert_eq!(bytes.len(), 8 + 2 * 20 + 2 * 8);
        assert_eq!(bytes[..8], 2_u64.to_le_bytes());
        assert_eq!(bytes[8..12], 4_f32.to_le_bytes());
        assert_eq!(bytes[48..], [2_u64, 1].map(u64::to_le_bytes).concat());
    }

    #[test]
    fn the_type_is_in_capitals() {
        let points = points().in_order();
        let info = info(&points, &points.by_place(), Sharding::for_count(2), &[]);
        assert_eq!(info["annotation_type"], "POINT");
        assert_eq!(info["properties"][0]["type"], "float32");
        assert_eq!(info["properties"][1]["type"], "uint8");
    }

    #[test]
    fn each_point_is_in_one_cell_of_one_level() {
        let count = 3 * LIMIT;
        let at = |n: usize| DVec3::new(n as f64, (n % 100) as f64, 0.0);
        let points = Points {
            places: (0..count).map(at).collect(),
            ..Points::default()
        };
        let levels = points.by_place();
        assert!(levels.len() > 1);
        let mut seen: Vec<usize> = levels
            .iter()
            .flat_map(BTreeMap::values)
            .flatten()
            .copied()
            .collect();
        seen.sort_unstable();
        assert_eq!(seen, (0..count).collect::<Vec<_>>());
        assert!(
            levels
                .iter()
                .flat_map(BTreeMap::values)
                .all(|there| there.len() <= LIMIT)
        );
        // All in one place end, too.
        let one = Points {
            places: vec![DVec3::ZERO; 15 * LIMIT],
            ..Points::default()
        };
        assert_eq!(one.by_place().len(), MOST_LEVELS as usize + 1);
    }
}
