//! Cholesky factorization of dense columns: A = L Lᵀ with L lower triangular.
//!
//! **Practice.** Columns are halved until eight are left; each half is subtracted from the next by
//! tiles of 4 × 4 that stay in registers. Plain multiplications and additions in a fixed order, which
//! the compiler turns into the vector instructions that all processors of a kind have: the result does
//! not depend on the model of the processor.

use rayon::prelude::*;

/// Rows and columns of a tile.
const TILE: usize = 4;
/// Columns that are factored one by one.
const MIN_SPLIT: usize = 8;
/// Columns that are subtracted at once: their rows stay in the processor's cache.
const DEPTH: usize = 128;
/// Columns that a sweep takes at once.
const SWEPT: usize = 4;
/// Multiplications from which on columns are worth several threads: half a millisecond.
const SIDE_BY_SIDE: usize = 1 << 21;
/// A pivot below this share of its diagonal element is rounding: the matrix is singular. A guard.
const MIN_PIVOT: f64 = 1e-14;

/// Zeros to be added to. They are written here: pages that the system has yet to clear, and that are read first,
/// would be made twice, and all threads stopped for it.
pub(super) fn zeros(count: usize) -> Vec<f64> {
    std::iter::repeat_n(std::hint::black_box(0.0), count).collect()
}

/// The first columns of a symmetric matrix on and below the diagonal, one after the other; of their
/// factor, once they are factored. What lies above the diagonal is undefined.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Columns {
    /// Of zeros; `rows` ≥ `columns`.
    pub(crate) fn new(rows: usize, columns: usize) -> Self {
        assert!(rows >= columns);
        Self {
            rows,
            columns,
            values: zeros(rows * columns),
        }
    }

    /// A square matrix from its elements (row, column) on and below the diagonal.
    pub(crate) fn from_fn(size: usize, element: impl Fn(usize, usize) -> f64) -> Self {
        let mut matrix = Self::new(size, size);
        for column in 0..size {
            for row in column..size {
                matrix.column_mut(column)[row] = element(row, column);
            }
        }
        matrix
    }

    pub(crate) fn column_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.values[column * self.rows..][..self.rows]
    }

    fn column(&self, column: usize) -> &[f64] {
        &self.values[column * self.rows..][..self.rows]
    }

    /// Factors in place; `None` if the matrix is not positive definite.
    pub(crate) fn factor(mut self) -> Option<Self> {
        let diagonal: Vec<f64> = (0..self.columns).map(|k| self.column(k)[k]).collect();
        let mut packed = Vec::new();
        self.factor_range(0, self.columns, &diagonal, &mut packed)?;
        Some(self)
    }

    fn factor_range(
        &mut self,
        from: usize,
        to: usize,
        diagonal: &[f64],
        packed: &mut Vec<f64>,
    ) -> Option<()> {
        if to - from <= MIN_SPLIT {
            return self.factor_one_by_one(from, to, diagonal);
        }
        let middle = from + (to - from).div_ceil(2 * TILE) * TILE;
        self.factor_range(from, middle, diagonal, packed)?;
        for first in (from..middle).step_by(DEPTH) {
            let depth = DEPTH.min(middle - first);
            self.pack(middle, first, depth, packed);
            let rest = &mut self.values[middle * self.rows + middle..];
            let size = [self.rows - middle, to - middle];
            subtract_products(rest, self.rows, size, packed, depth);
        }
        self.factor_range(middle, to, diagonal, packed)
    }

    fn factor_one_by_one(&mut self, from: usize, to: usize, diagonal: &[f64]) -> Option<()> {
        for k in from..to {
            let (done, rest) = self.values.split_at_mut(k * self.rows);
            let column = &mut rest[k..self.rows];
            for earlier in from..k {
                let earlier = &done[earlier * self.rows..][k..self.rows];
                let factor = earlier[0];
                for (value, e) in column.iter_mut().zip(earlier) {
                    *value -= factor * e;
                }
            }
            let pivot = column[0];
            // Also false where the pivot is no number.
            let positive = pivot > MIN_PIVOT * diagonal[k];
            if !positive {
                return None;
            }
            let scale = 1.0 / pivot.sqrt();
            column.iter_mut().for_each(|value| *value *= scale);
        }
        Some(())
    }

    /// Subtracts what the factored columns give to the rows below them: `matrix` is square, of as many
    /// rows as there are more rows than columns.
    pub(crate) fn subtract_from(&self, matrix: &mut [f64]) {
        let size = self.rows - self.columns;
        let mut packed = Vec::new();
        for first in (0..self.columns).step_by(DEPTH) {
            let depth = DEPTH.min(self.columns - first);
            self.pack(self.columns, first, depth, &mut packed);
            subtract_products(matrix, size, [size, size], &packed, depth);
        }
    }

    /// Rows from `row` on of `depth` columns, in strips of [`TILE`] rows; the last one filled with zeros.
    fn pack(&self, row: usize, first: usize, depth: usize, packed: &mut Vec<f64>) {
        let strips = (self.rows - row).div_ceil(TILE);
        packed.clear();
        packed.resize(strips * depth * TILE, 0.0);
        for k in 0..depth {
            let column = &self.column(first + k)[row..];
            for (strip, values) in column.chunks(TILE).enumerate() {
                packed[(strip * depth + k) * TILE..][..values.len()].copy_from_slice(values);
            }
        }
    }

    /// Solves `L y = x` for the rows of the columns, and subtracts what `y` gives to the rows below;
    /// `x` has W right sides.
    pub(crate) fn forward<const W: usize>(&self, x: &mut [[f64; W]]) {
        let even = self.columns - self.columns % SWEPT;
        for k in (0..even).step_by(SWEPT) {
            self.forward_by::<W, SWEPT>(k, x);
        }
        for k in even..self.columns {
            self.forward_by::<W, 1>(k, x);
        }
    }

    fn forward_by<const W: usize, const K: usize>(&self, first: usize, x: &mut [[f64; W]]) {
        let columns: [&[f64]; K] = std::array::from_fn(|k| &self.column(first + k)[first..]);
        let (own, below) = x[first..].split_at_mut(K);
        let own: &mut [[f64; W]; K] = own.try_into().expect("K rows");
        for k in 0..K {
            for j in 0..k {
                let solved = own[j];
                subtract(&mut own[k], columns[j][k], &solved);
            }
            own[k].iter_mut().for_each(|x| *x /= columns[k][k]);
        }
        let own = *own;
        let columns = columns.map(|column| &column[K..][..below.len()]);
        for (row, x) in below.iter_mut().enumerate() {
            for k in 0..K {
                subtract(x, columns[k][row], &own[k]);
            }
        }
    }

    /// Solves `Lᵀ y = x` for the rows of the columns, where the rows below them are solved already.
    pub(crate) fn backward<const W: usize>(&self, x: &mut [[f64; W]]) {
        let even = self.columns - self.columns % SWEPT;
        for k in (even..self.columns).rev() {
            self.backward_by::<W, 1>(k, x);
        }
        for k in (0..even).step_by(SWEPT).rev() {
            self.backward_by::<W, SWEPT>(k, x);
        }
    }

    fn backward_by<const W: usize, const K: usize>(&self, first: usize, x: &mut [[f64; W]]) {
        let columns: [&[f64]; K] = std::array::from_fn(|k| &self.column(first + k)[first..]);
        let (own, below) = x[first..].split_at_mut(K);
        let mut sums = [[0.0; W]; K];
        let lower = columns.map(|column| &column[K..][..below.len()]);
        for (row, x) in below.iter().enumerate() {
            for k in 0..K {
                subtract(&mut sums[k], lower[k][row], x);
            }
        }
        for k in (0..K).rev() {
            for j in k + 1..K {
                let solved = own[j];
                subtract(&mut sums[k], columns[k][j], &solved);
            }
            for (x, sum) in own[k].iter_mut().zip(sums[k]) {
                *x = (*x + sum) / columns[k][k];
            }
        }
    }
}

fn subtract<const W: usize>(from: &mut [f64; W], factor: f64, values: &[f64; W]) {
    for (from, value) in from.iter_mut().zip(values) {
        *from -= factor * value;
    }
}

/// Subtracts P Pᵀ from a matrix of `rows` × `columns`, on and below the diagonal. Its columns are
/// `stride` apart; the strips of P are `depth` deep.
fn subtract_products(
    matrix: &mut [f64],
    stride: usize,
    [rows, columns]: [usize; 2],
    packed: &[f64],
    depth: usize,
) {
    let strip = |index: usize| &packed[index * depth * TILE..][..depth * TILE];
    let subtract = |(number, matrix): (usize, &mut [f64])| {
        let across = number * TILE;
        let width = TILE.min(columns - across);
        for down in (across..rows).step_by(TILE) {
            let height = TILE.min(rows - down);
            let products = product(strip(down / TILE), strip(number));
            for (column, products) in products.iter().enumerate().take(width) {
                let values = &mut matrix[column * stride + down..][..height];
                for (value, product) in values.iter_mut().zip(products) {
                    *value -= product;
                }
            }
        }
    };
    if matrix.is_empty() {
        return;
    }
    let (strips, length) = (columns.div_ceil(TILE), TILE * stride);
    if rows * columns * depth < SIDE_BY_SIDE {
        let strips = matrix.chunks_mut(length).take(strips);
        strips.enumerate().for_each(subtract);
    } else {
        let strips = matrix.par_chunks_mut(length).take(strips);
        strips.enumerate().for_each(subtract);
    }
}

/// Products of two strips, summed along their depth: by column of the second, then row of the first.
fn product(rows: &[f64], columns: &[f64]) -> [[f64; TILE]; TILE] {
    let mut sums = [[0.0; TILE]; TILE];
    let (rows, columns) = (rows.as_chunks::<TILE>().0, columns.as_chunks::<TILE>().0);
    for (row, column) in rows.iter().zip(columns) {
        for j in 0..TILE {
            for i in 0..TILE {
                sums[j][i] += row[i] * column[j];
            }
        }
    }
    sums
}
