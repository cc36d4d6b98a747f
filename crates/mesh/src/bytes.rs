//! Values as bytes, little-endian, for caches: not a file format, since nothing says what the bytes mean.
//!
//! What comes back is checked: no count is believed that the bytes left could not hold, so that bytes of any
//! origin give a value or an error, and never more memory than they take themselves.

use glam::{DVec3, Vec3};
use thiserror::Error;

/// Why bytes are no value.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum BytesError {
    /// They end within a value, or a count is larger than what is left could hold.
    #[error("the bytes end early")]
    Short,
    /// More follow after the last value.
    #[error("bytes are left over")]
    Long,
    /// A value that cannot be: an index beyond what it points into, a coordinate that is not finite.
    #[error("{0}")]
    Invalid(&'static str),
}

/// Appends values.
#[derive(Clone, Debug, Default)]
pub struct ByteWriter(Vec<u8>);

impl ByteWriter {
    /// The bytes of all values.
    pub fn into_bytes(self) -> Vec<u8> {
        self.0
    }

    /// Appends bytes as they are.
    pub fn raw(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    /// Appends a number in as few bytes as it takes, seven bits in each (LEB128).
    pub fn number(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
    }

    /// Appends what a number differs by from the one before it: a byte for those that count up or down.
    pub fn difference(&mut self, value: i64, before: i64) {
        let by = value.wrapping_sub(before);
        self.number(((by << 1) ^ (by >> 63)) as u64);
    }

    /// Appends text with its length.
    pub fn text(&mut self, text: &str) {
        self.number(text.len() as u64);
        self.raw(text.as_bytes());
    }

    /// Appends a number.
    pub fn f32(&mut self, value: f32) {
        self.raw(&value.to_le_bytes());
    }

    /// Appends a number.
    pub fn f64(&mut self, value: f64) {
        self.raw(&value.to_le_bytes());
    }

    /// Appends three numbers.
    pub fn vec3(&mut self, value: Vec3) {
        value.to_array().into_iter().for_each(|x| self.f32(x));
    }

    /// Appends three numbers.
    pub fn dvec3(&mut self, value: DVec3) {
        value.to_array().into_iter().for_each(|x| self.f64(x));
    }
}

/// Takes values off bytes, in the order in which a [`ByteWriter`] appended them.
#[derive(Clone, Debug)]
pub struct ByteReader<'b>(&'b [u8]);

impl<'b> ByteReader<'b> {
    /// Begins with the first byte.
    pub fn new(bytes: &'b [u8]) -> Self {
        Self(bytes)
    }

    /// An error unless all bytes are taken.
    ///
    /// # Errors
    /// [`BytesError::Long`].
    pub fn end(&self) -> Result<(), BytesError> {
        match self.0.is_empty() {
            true => Ok(()),
            false => Err(BytesError::Long),
        }
    }

    /// Takes so many bytes.
    ///
    /// # Errors
    /// [`BytesError::Short`].
    pub fn raw(&mut self, count: usize) -> Result<&'b [u8], BytesError> {
        let (taken, left) = self.0.split_at_checked(count).ok_or(BytesError::Short)?;
        self.0 = left;
        Ok(taken)
    }

    /// Takes a number of as many bytes as it took.
    ///
    /// # Errors
    /// [`BytesError::Short`]; [`BytesError::Invalid`] if it takes more than 64 bits.
    pub fn number(&mut self) -> Result<u64, BytesError> {
        let mut value = 0;
        for shift in (0..64).step_by(7) {
            let (&byte, left) = self.0.split_first().ok_or(BytesError::Short)?;
            self.0 = left;
            let bits = u64::from(byte & 0x7f);
            if bits << shift >> shift != bits {
                break;
            }
            value |= bits << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(BytesError::Invalid("a number of more than 64 bits"))
    }

    /// Takes a number that was stored as its difference from the one before it.
    ///
    /// # Errors
    /// As [`number`](Self::number).
    pub fn difference(&mut self, before: i64) -> Result<i64, BytesError> {
        let by = self.number()?;
        Ok(before.wrapping_add((by >> 1) as i64 ^ -((by & 1) as i64)))
    }

    /// Takes a count of things that take at least so many bytes each.
    ///
    /// # Errors
    /// [`BytesError::Short`] if fewer bytes are left than so many things take.
    pub fn count(&mut self, least: usize) -> Result<usize, BytesError> {
        let count = usize::try_from(self.number()?).map_err(|_| BytesError::Short)?;
        match count.checked_mul(least) {
            Some(bytes) if bytes <= self.0.len() => Ok(count),
            _ => Err(BytesError::Short),
        }
    }

    /// Takes text.
    ///
    /// # Errors
    /// [`BytesError::Short`]; [`BytesError::Invalid`] if it is not UTF-8.
    pub fn text(&mut self) -> Result<&'b str, BytesError> {
        let count = self.count(1)?;
        std::str::from_utf8(self.raw(count)?).map_err(|_| BytesError::Invalid("not UTF-8"))
    }

    /// Takes a number.
    ///
    /// # Errors
    /// [`BytesError::Short`].
    pub fn f32(&mut self) -> Result<f32, BytesError> {
        let bytes = self.raw(4)?;
        Ok(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    /// Takes a number.
    ///
    /// # Errors
    /// [`BytesError::Short`].
    pub fn f64(&mut self) -> Result<f64, BytesError> {
        let bytes = self.raw(8)?;
        Ok(f64::from_le_bytes(std::array::from_fn(|i| bytes[i])))
    }

    /// Takes three numbers, which are finite.
    ///
    /// # Errors
    /// [`BytesError::Short`]; [`BytesError::Invalid`] if one is not finite.
    pub fn vec3(&mut self) -> Result<Vec3, BytesError> {
        let value = Vec3::new(self.f32()?, self.f32()?, self.f32()?);
        match value.is_finite() {
            true => Ok(value),
            false => Err(NOT_FINITE),
        }
    }

    /// Takes three numbers, which are finite.
    ///
    /// # Errors
    /// [`BytesError::Short`]; [`BytesError::Invalid`] if one is not finite.
    pub fn dvec3(&mut self) -> Result<DVec3, BytesError> {
        let value = DVec3::new(self.f64()?, self.f64()?, self.f64()?);
        match value.is_finite() {
            true => Ok(value),
            false => Err(NOT_FINITE),
        }
    }
}

const NOT_FINITE: BytesError = BytesError::Invalid("a coordinate that is not finite");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_sizes_come_back() {
        let numbers = [0, 1, 127, 128, 16_384, u64::from(u32::MAX), u64::MAX];
        let mut writer = ByteWriter::default();
        numbers.into_iter().for_each(|number| writer.number(number));
        let ends = [i64::MIN, -70, 0, 3, i64::MAX];
        ends.into_iter()
            .for_each(|value| writer.difference(value, -7));
        writer.text("µm");
        let bytes = writer.into_bytes();
        let mut reader = ByteReader::new(&bytes);
        assert_eq!(numbers.map(|_| reader.number().expect("there")), numbers);
        assert_eq!(ends.map(|_| reader.difference(-7).expect("there")), ends);
        assert_eq!(reader.clone().end(), Err(BytesError::Long));
        assert_eq!(reader.text(), Ok("µm"));
        assert_eq!(
            (reader.end(), reader.number()),
            (Ok(()), Err(BytesError::Short))
        );
    }

    #[test]
    fn counts_that_the_bytes_cannot_hold_are_not_believed() {
        let mut writer = ByteWriter::default();
        writer.number(u64::MAX);
        writer.raw(&[0; 20]);
        let bytes = writer.into_bytes();
        assert_eq!(ByteReader::new(&bytes).count(8), Err(BytesError::Short));
        assert_eq!(ByteReader::new(&[3, 0, 0]).count(1), Err(BytesError::Short));
        assert_eq!(ByteReader::new(&[2, 0, 0]).count(1), Ok(2));
        let endless = [0xff; 11];
        assert!(matches!(
            ByteReader::new(&endless).number(),
            Err(BytesError::Invalid(_))
        ));
    }
}
