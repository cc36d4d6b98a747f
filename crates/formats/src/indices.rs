//! Whole numbers of HDF5: ids, sections, rows of other data sets.
//!
//! The library turns whatever number a data set has into the type that is asked for, and clamps: −1 becomes 0, 1.9
//! becomes 1. An index must not become another one, so what is stored is read as what it is, and looked at.

use std::fmt;

use hdf5_pure::{Dataset, Datatype, Error};

/// Why a data set gives no indices.
#[derive(Debug)]
pub enum IndexError {
    /// What the library says.
    Hdf5(Error),
    /// A number that is none.
    Number {
        /// Its place among all numbers that were asked for.
        place: u64,
        /// What stands there.
        value: String,
        /// What should.
        expected: &'static str,
    },
}

/// What indices are.
pub const NATURAL: &str = "a whole number of 0 or more";
/// What ids are that may be negative.
pub const WHOLE: &str = "a whole number";

/// Whole numbers up to this one are exact in a floating-point number.
const EXACT: f64 = (1_u64 << 53) as f64;

/// Numbers of 0 or more: all of a data set, or those of `rows` (first, count).
///
/// # Errors
/// One of them is negative, has a fraction, or is none.
pub fn naturals(dataset: &Dataset, rows: Option<(u64, u64)>) -> Result<Vec<u64>, IndexError> {
    let wrong = |place: usize, value: &dyn fmt::Display| IndexError::number(place, value, NATURAL);
    match stored(dataset, rows)? {
        Stored::Unsigned(values) => Ok(values),
        Stored::Signed(values) => converted(&values, |&v| u64::try_from(v).ok(), wrong),
        Stored::Real(values) => {
            let natural = |&v: &f64| (is_whole(v) && v >= 0.0).then_some(v as u64);
            converted(&values, natural, wrong)
        }
    }
}

/// Whole numbers, which may be negative: all of a data set, or those of `rows` (first, count).
///
/// # Errors
/// One of them has a fraction, or is none.
pub fn wholes(dataset: &Dataset, rows: Option<(u64, u64)>) -> Result<Vec<i64>, IndexError> {
    let wrong = |place: usize, value: &dyn fmt::Display| IndexError::number(place, value, WHOLE);
    match stored(dataset, rows)? {
        Stored::Unsigned(values) => converted(&values, |&v| i64::try_from(v).ok(), wrong),
        Stored::Signed(values) => Ok(values),
        Stored::Real(values) => converted(&values, |&v| is_whole(v).then_some(v as i64), wrong),
    }
}

/// Numbers as a file has them.
enum Stored {
    Unsigned(Vec<u64>),
    Signed(Vec<i64>),
    Real(Vec<f64>),
}

fn stored(dataset: &Dataset, rows: Option<(u64, u64)>) -> Result<Stored, IndexError> {
    let datatype = dataset.datatype()?;
    let of = match &datatype {
        Datatype::Enumeration { base_type, .. } => base_type,
        other => other,
    };
    let read = match (of, rows) {
        (Datatype::FloatingPoint { .. }, None) => Stored::Real(dataset.read_f64()?),
        (Datatype::FloatingPoint { .. }, Some((first, count))) => {
            Stored::Real(dataset.read_f64_rows(first, count)?)
        }
        (Datatype::FixedPoint { layout, .. }, rows) if layout.signed => {
            Stored::Signed(match rows {
                None => dataset.read_i64()?,
                Some((first, count)) => dataset.read_i64_rows(first, count)?,
            })
        }
        (_, None) => Stored::Unsigned(dataset.read_u64()?),
        (_, Some((first, count))) => Stored::Unsigned(dataset.read_u64_rows(first, count)?),
    };
    Ok(read)
}

fn converted<T: fmt::Display, U>(
    values: &[T],
    convert: impl Fn(&T) -> Option<U>,
    wrong: impl Fn(usize, &dyn fmt::Display) -> IndexError,
) -> Result<Vec<U>, IndexError> {
    let numbers = values.iter().enumerate();
    numbers
        .map(|(place, value)| convert(value).ok_or_else(|| wrong(place, value)))
        .collect()
}

fn is_whole(value: f64) -> bool {
    value.fract() == 0.0 && value.abs() <= EXACT
}

impl IndexError {
    fn number(place: usize, value: &dyn fmt::Display, expected: &'static str) -> Self {
        Self::Number {
            place: place as u64,
            value: value.to_string(),
            expected,
        }
    }
}

impl From<Error> for IndexError {
    fn from(error: Error) -> Self {
        Self::Hdf5(error)
    }
}
