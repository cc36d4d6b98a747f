//! Numbers of one's own that files have for their vertices, beside those of every mesh.

use super::{FilePosition, ReadError};

/// Numbers of each vertex that a file has beside those of every mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnAttribute {
    /// Its name in the file; what is no letter or digit is `_`.
    pub name: String,
    /// Numbers of a vertex: 1 to 4.
    pub components: usize,
    /// Those of all vertices, in their order. NaN where a part of the file has none.
    pub values: Vec<f64>,
    /// Whether the file has them as numbers that an `f32` holds.
    pub single: bool,
}

/// Most numbers of a vertex in one attribute: what writers write.
pub(super) const MOST_COMPONENTS: usize = 4;

/// Collects numbers of one's own, if they are wanted: those who judge a mesh have no use for them.
#[derive(Default)]
pub(super) struct OwnColumns {
    pub(super) wanted: bool,
    columns: Vec<OwnAttribute>,
    /// Numbers of all of them together.
    count: usize,
}

impl OwnColumns {
    /// Adds numbers of the vertices from `first` on. Those of a name that these vertices have already are left out, as
    /// those of another number of components.
    ///
    /// # Errors
    /// There would be more than `limit` numbers: parts of a file without numbers that others have are filled up.
    pub(super) fn add(
        &mut self,
        (first, at): (usize, FilePosition),
        added: OwnAttribute,
        limit: usize,
    ) -> Result<(), ReadError> {
        let OwnAttribute {
            name,
            components,
            values,
            single,
        } = added;
        let name = cleaned(&name);
        let known = self.columns.iter().position(|column| column.name == name);
        let index = known.unwrap_or(self.columns.len());
        let start = first * components;
        let before = self.columns.get(index).map_or(0, |c| c.values.len());
        let same = |c: &OwnAttribute| c.components == components && before <= start;
        if name.is_empty() || !self.columns.get(index).is_none_or(same) {
            return Ok(());
        }
        self.count = (self.count + start - before).saturating_add(values.len());
        if self.count > limit {
            return Err(too_many(at));
        }
        if known.is_none() {
            self.columns.push(OwnAttribute {
                name,
                components,
                values: Vec::new(),
                single,
            });
        }
        let column = &mut self.columns[index];
        column.single &= single;
        column.values.resize(start, f64::NAN);
        if column.values.is_empty() {
            column.values = values;
        } else {
            column.values.extend(values);
        }
        Ok(())
    }

    /// All of them, for so many vertices.
    ///
    /// # Errors
    /// As [`add`](Self::add).
    pub(super) fn finish(
        self,
        vertices: usize,
        limit: usize,
    ) -> Result<Vec<OwnAttribute>, ReadError> {
        let components: usize = self.columns.iter().map(|c| c.components).sum();
        if components.saturating_mul(vertices) > limit {
            return Err(too_many(FilePosition::File));
        }
        let mut columns = self.columns;
        for column in &mut columns {
            column.values.resize(vertices * column.components, f64::NAN);
        }
        Ok(columns)
    }
}

fn too_many(at: FilePosition) -> ReadError {
    ReadError::Unsupported {
        at,
        what: "attributes this much larger than the file".to_owned(),
        remedy: "give all its parts the same attributes",
    }
}

/// A name of letters, digits and `_` that begins with none of the digits.
fn cleaned(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let clean: String = name.chars().map(plain).collect();
    match clean.starts_with(|c: char| c.is_ascii_digit()) {
        true => format!("_{clean}"),
        false => clean,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, values: &[f64]) -> OwnAttribute {
        OwnAttribute {
            name: name.into(),
            components: 1,
            values: values.to_vec(),
            single: true,
        }
    }

    #[test]
    fn parts_without_numbers_have_nan() {
        let mut own = OwnColumns::default();
        let at = FilePosition::File;
        own.add((1, at), of("von Mises", &[2.0]), 10).expect("room");
        own.add((0, at), of("von Mises", &[9.0]), 10)
            .expect("left out");
        let read = own.finish(3, 10).expect("room");
        assert_eq!(read[0].name, "von_Mises");
        assert!(read[0].values[0].is_nan() && read[0].values[1] == 2.0);
        assert!(read[0].values[2].is_nan() && read.len() == 1);
    }

    #[test]
    fn a_small_file_gives_no_large_columns() {
        let mut own = OwnColumns::default();
        let far = (1_000_000, FilePosition::File);
        assert!(own.add(far, of("a", &[0.0]), 1000).is_err());
        let mut own = OwnColumns::default();
        let at = (0, FilePosition::File);
        own.add(at, of("a", &[0.0]), 1000).expect("room");
        assert!(own.finish(1_000_000, 1000).is_err());
    }
}
