//! Some columns of many rows: each chunk is read once, and none is kept, so that frames which are played meanwhile
//! keep theirs.

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;

use super::{Access, Number, Table};
use crate::CircuitError;

impl Table {
    /// How many rows are stored together. Blocks of a multiple of it, from a multiple of it on, read each chunk once.
    pub(crate) fn rows_together(&self) -> u64 {
        match &self.access {
            Access::Chunked { shape, .. } => shape[0],
            Access::Contiguous(_) | Access::Rows => 1,
        }
    }

    /// Numbers of rows at these columns, row by row.
    ///
    /// Takes time for the chunks that hold them, not for the rows.
    pub(crate) fn pick_rows(
        &self,
        rows: Range<u64>,
        columns: &[u64],
    ) -> Result<Vec<f32>, CircuitError> {
        if !rows.is_empty() {
            self.beyond("frame", rows.end - 1, self.rows)?;
        }
        for &column in columns {
            self.beyond("compartment", column, self.columns)?;
        }
        let (Access::Chunked { shape, .. }, Some(number)) = (&self.access, self.number) else {
            let row = |row| self.pick(row, columns);
            return Ok(rows.map(row).collect::<Result<Vec<_>, _>>()?.concat());
        };
        let first = rows.start / shape[0];
        let blocks: Vec<Range<u64>> = (first..rows.end.div_ceil(shape[0]).max(first))
            .map(|block| {
                let from = block * shape[0];
                from.max(rows.start)..(from + shape[0]).min(rows.end)
            })
            .collect();
        let read = |block: &Range<u64>| self.block(*shape, number, block.clone(), columns);
        let parts: Result<Vec<_>, CircuitError> = blocks.par_iter().map(read).collect();
        Ok(parts?.concat())
    }

    /// Rows of one row of chunks.
    fn block(
        &self,
        shape: [u64; 2],
        number: Number,
        rows: Range<u64>,
        columns: &[u64],
    ) -> Result<Vec<f32>, CircuitError> {
        let mut wanted: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        for (i, column) in columns.iter().enumerate() {
            wanted.entry(column / shape[1]).or_default().push(i);
        }
        let mut values = vec![0.0; (rows.end - rows.start) as usize * columns.len()];
        for (column, places) in wanted {
            let Some(chunk) = self.stored([rows.start / shape[0], column])? else {
                // A chunk that was never written reads as the fill value, which hdf5-pure knows.
                let row = |row| self.whole_row(row, columns);
                return Ok(rows.map(row).collect::<Result<Vec<_>, _>>()?.concat());
            };
            for (k, row) in rows.clone().enumerate() {
                for &i in &places {
                    let within = (row % shape[0]) * shape[1] + columns[i] % shape[1];
                    values[k * columns.len() + i] = number.read(&chunk, within as usize);
                }
            }
        }
        Ok(values)
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use crate::write::{ReportLayout, report};
    use crate::{Report, TimeAxis};

    #[test]
    fn a_series_has_the_values_of_its_frames() {
        let folder = tempfile::tempdir().expect("a folder");
        for (chunk, compressed) in [([4, 64], true), ([1, 3], false), ([10, 1], true)] {
            let layout = ReportLayout {
                population: "cells".into(),
                time: TimeAxis::of_frames(5.0, 0.5, 10).expect("an axis"),
                units: "mV".into(),
                nodes: vec![2, 7],
                sections: vec![vec![0, 1, 1], vec![0, 1]],
                chunk,
                compressed,
            };
            let data: Vec<f32> = (0..50).map(|i| i as f32 * 1.25).collect();
            let path = folder.path().join("report.h5");
            let file = File::create(&path).expect("a file");
            report(&layout, &data, file).expect("written");
            let read = Report::open(&path).expect("a report");
            let cells = &read.populations[0];
            let columns = [4, 1];
            for frames in [0..10, 3..8, 9..10, 4..4] {
                let each = frames.clone().map(|frame| {
                    let values = cells.values(frame, &columns);
                    values.expect("values")
                });
                let expected: Vec<f32> = each.flatten().collect();
                let series = cells.series(frames, &columns).expect("values");
                assert_eq!(series, expected, "{chunk:?}");
            }
            assert_eq!(cells.frames_together(), chunk[0].min(10));
            assert!(cells.series(3..11, &columns).is_err());
            assert!(cells.series(0..2, &[5]).is_err());
        }
    }
}
