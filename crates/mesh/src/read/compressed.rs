//! The compressed triangles of a primitive of glTF (`KHR_draco_mesh_compression`).

use std::rc::Rc;

use serde_json::Value;

use super::{FilePosition, ReadError, malformed};
use crate::draco::Decoded;

/// A decoded stream, and which of its attributes is which.
pub(super) struct Compressed<'a> {
    decoded: Rc<Decoded>,
    /// Ids in the stream by names of glTF.
    ids: &'a Value,
}

impl<'a> Compressed<'a> {
    /// `ids`: those of attributes in the stream, by names of glTF.
    pub(super) fn new(decoded: Rc<Decoded>, ids: &'a Value) -> Self {
        Self { decoded, ids }
    }

    /// Its triangles.
    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.decoded.triangles
    }

    /// The numbers of an attribute, if it is in the stream.
    ///
    /// # Errors
    /// It has another number of components.
    pub(super) fn numbers(
        &self,
        name: &str,
        components: usize,
    ) -> Result<Option<Vec<f64>>, ReadError> {
        let Some(id) = self.ids[name].as_u64() else {
            return Ok(None);
        };
        let mut all = self.decoded.attributes.iter();
        let found = all.find(|a| u64::from(a.id) == id && a.components == components);
        let found = found.ok_or_else(|| {
            let found = format!("compressed numbers of {name}");
            malformed(FilePosition::File, found, "as many as it should have")
        })?;
        Ok(Some(found.values.clone()))
    }
}
