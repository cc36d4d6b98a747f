//! Arrays of glTF: buffers, views of them, accessors.

use std::borrow::Cow;

use serde_json::Value;

use super::{FilePosition, ReadError, base64, malformed};

/// The buffers of a file, and the JSON that says what is in them.
pub(super) struct Arrays<'a> {
    pub(super) root: &'a Value,
    buffers: Vec<Cow<'a, [u8]>>,
}

impl<'a> Arrays<'a> {
    /// `binary`: the chunk of a GLB.
    pub(super) fn new(root: &'a Value, binary: Option<&'a [u8]>) -> Result<Self, ReadError> {
        let buffers = items(root, "buffers")
            .iter()
            .enumerate()
            // Only the first buffer may be the binary chunk.
            .map(|(n, buffer)| data(buffer, binary.filter(|_| n == 0)))
            .collect::<Result<_, _>>()?;
        Ok(Self { root, buffers })
    }

    /// The bytes of a buffer view, and what the JSON says of it.
    pub(super) fn view(&self, number: u64) -> Result<(&[u8], &Value), ReadError> {
        let view = item(items(self.root, "bufferViews"), number, "buffer view")?;
        let buffer = view["buffer"].as_u64().unwrap_or(0);
        let buffer: &[u8] = self.buffers.get(buffer as usize).map_or(&[], AsRef::as_ref);
        let (start, length) = (whole(&view["byteOffset"]), whole(&view["byteLength"]));
        let cut = ReadError::Truncated {
            at: FilePosition::File,
            what: "a buffer view",
        };
        let data = buffer.get(start..start.saturating_add(length)).ok_or(cut)?;
        Ok((data, view))
    }

    /// The numbers of an accessor.
    pub(super) fn numbers(&self, number: u64, components: usize) -> Result<Vec<f64>, ReadError> {
        let accessor = item(items(self.root, "accessors"), number, "accessor")?;
        let Some(view) = accessor["bufferView"]
            .as_u64()
            .filter(|_| accessor["sparse"].is_null())
        else {
            let (what, remedy) = (
                "a sparse accessor",
                "write the model without sparse accessors",
            );
            return Err(ReadError::Unsupported {
                at: FilePosition::File,
                what: what.to_owned(),
                remedy,
            });
        };
        let (data, view) = self.view(view)?;
        let kind = whole(&accessor["componentType"]);
        let width = match kind {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            _ => {
                return Err(malformed(
                    FilePosition::File,
                    format!("component type {kind}"),
                    "5120–5126",
                ));
            }
        };
        let size = width * components;
        let stride = match whole(&view["byteStride"]) {
            0 => size,
            stride if stride >= size => stride,
            stride => {
                return Err(malformed(
                    FilePosition::File,
                    format!("stride {stride}"),
                    "a longer one",
                ));
            }
        };
        let count = whole(&accessor["count"]);
        let data = data
            .get(whole(&accessor["byteOffset"])..)
            .unwrap_or_default();
        // The last element needs no padding up to the stride.
        let held = (data.len() + stride - size) / stride;
        if held < count {
            return Err(ReadError::Truncated {
                at: FilePosition::File,
                what: "an accessor",
            });
        }
        let mut numbers = Vec::with_capacity(count * components);
        for element in data.chunks(stride).take(count) {
            numbers.extend(
                element[..size]
                    .chunks_exact(width)
                    .map(|bytes| component(kind, bytes)),
            );
        }
        Ok(numbers)
    }
}

/// The bytes of a buffer.
fn data<'a>(buffer: &Value, binary: Option<&'a [u8]>) -> Result<Cow<'a, [u8]>, ReadError> {
    let Some(uri) = buffer["uri"].as_str() else {
        return Ok(Cow::Borrowed(binary.unwrap_or_default()));
    };
    let Some((_, text)) = uri
        .split_once(";base64,")
        .filter(|_| uri.starts_with("data:"))
    else {
        let what = format!(
            "the separate file '{}'",
            uri.chars().take(40).collect::<String>()
        );
        let remedy = "write the model as GLB, with its data inside";
        return Err(ReadError::Unsupported {
            at: FilePosition::File,
            what,
            remedy,
        });
    };
    let decoded = base64::decode(text.as_bytes(), usize::MAX).map(Cow::Owned);
    decoded.ok_or_else(|| malformed(FilePosition::File, "a data URI", "base64"))
}

/// A number of a component type, from as many bytes as it has.
fn component(kind: usize, bytes: &[u8]) -> f64 {
    let mut wide = [0; 4];
    wide[..bytes.len()].copy_from_slice(bytes);
    let bits = u32::from_le_bytes(wide);
    match kind {
        5120 => f64::from(bits as u8 as i8),
        5122 => f64::from(bits as u16 as i16),
        5126 => f64::from(f32::from_bits(bits)),
        _ => f64::from(bits),
    }
}

/// A whole number; 0 if it is none.
pub(super) fn whole(value: &Value) -> usize {
    value.as_u64().unwrap_or(0) as usize
}

/// A list of an object; empty if it is not there.
pub(super) fn items<'a>(value: &'a Value, name: &str) -> &'a [Value] {
    value
        .get(name)
        .and_then(Value::as_array)
        .map(Vec::as_slice)
        .unwrap_or_default()
}

pub(super) fn item<'a>(
    list: &'a [Value],
    number: u64,
    what: &'static str,
) -> Result<&'a Value, ReadError> {
    list.get(number as usize).ok_or_else(|| {
        let found = format!("{what} {number} of {}", list.len());
        malformed(FilePosition::File, found, "one that is there")
    })
}
