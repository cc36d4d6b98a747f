//! VTU: pieces of triangles, quads and polygons; arrays as text, base64 or appended, uncompressed.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::builder::Builder;
use super::lines::{index, number, words};
use super::own::{MOST_COMPONENTS, OwnAttribute};
use super::xml::{Tag, find};
use super::{FilePosition, ReadError, base64, malformed};
use crate::SurfaceVertex;

pub(super) fn read(bytes: &[u8], mesh: &mut Builder) -> Result<(), ReadError> {
    let file = File::read(bytes)?;
    for piece in &file.pieces {
        file.read_piece(piece, mesh)?;
    }
    Ok(())
}

struct File<'a> {
    bytes: &'a [u8],
    /// Counts of bytes have 64 bits.
    wide: bool,
    big: bool,
    appended: Option<Appended>,
    pieces: Vec<Piece<'a>>,
}

struct Appended {
    /// Offset of what follows the `_`.
    start: usize,
    raw: bool,
}

/// Arrays by where they stand: `Points`, `Cells/types`, `PointData/radius`.
type Piece<'a> = HashMap<String, Array<'a>>;

struct Array<'a> {
    kind: &'a str,
    format: &'a str,
    /// Numbers of a point.
    components: usize,
    offset: Option<usize>,
    /// Offset of the text within the tags.
    text: usize,
}

/// Numbers of an array.
struct Numbers {
    values: Vec<f64>,
    at: FilePosition,
}

impl<'a> File<'a> {
    fn read(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let mut file = Self {
            bytes,
            wide: false,
            big: false,
            appended: None,
            pieces: Vec::new(),
        };
        let mut at = 0;
        let mut within = "";
        let mut known = false;
        while let Some(tag) = Tag::next(bytes, at)? {
            at = tag.end;
            match tag.name {
                "VTKFile" => {
                    known = tag.get("type") == Some("UnstructuredGrid");
                    file.wide = tag.get("header_type") == Some("UInt64");
                    file.big = tag.get("byte_order") == Some("BigEndian");
                    if let Some(compressor) = tag.get("compressor") {
                        return Err(unsupported(at, compressor, "write the file uncompressed"));
                    }
                }
                "Piece" => file.pieces.push(Piece::new()),
                "Points" | "Cells" | "PointData" | "CellData" => within = tag.name,
                "DataArray" => {
                    let name = match within {
                        "Points" => within.to_owned(),
                        _ => format!("{within}/{}", tag.get("Name").unwrap_or_default()),
                    };
                    let array = Array {
                        kind: tag.get("type").unwrap_or_default(),
                        format: tag.get("format").unwrap_or("ascii"),
                        components: tag
                            .get("NumberOfComponents")
                            .map_or(Some(1), |count| count.trim().parse().ok())
                            .unwrap_or(0),
                        offset: tag.get("offset").and_then(|offset| offset.parse().ok()),
                        text: tag.end,
                    };
                    if let Some(piece) = file.pieces.last_mut() {
                        piece.insert(name, array);
                    }
                }
                "AppendedData" => {
                    let raw = tag.get("encoding") == Some("raw");
                    let start = find(bytes, at, b"_").map(|at| at + 1);
                    file.appended = start.map(|start| Appended { start, raw });
                    break;
                }
                _ => {}
            }
        }
        if known {
            Ok(file)
        } else {
            Err(malformed(
                FilePosition::File,
                "XML",
                "a VTK unstructured grid",
            ))
        }
    }

    fn read_piece(&self, piece: &Piece<'_>, mesh: &mut Builder) -> Result<(), ReadError> {
        let numbers = |name: &str| piece.get(name).map(|array| self.numbers(array)).transpose();
        let need = |name: &'static str| {
            numbers(name)?
                .ok_or_else(|| malformed(FilePosition::File, "a piece without an array", name))
        };
        let points = need("Points")?;
        let normals = numbers("PointData/Normals")?;
        let attributes = [
            numbers("PointData/type")?,
            numbers("PointData/point")?,
            numbers("PointData/section")?,
            numbers("PointData/radius")?,
        ];
        let first = mesh.vertex_count() as u64;
        let three = |numbers: &Numbers, n: usize| {
            let values = numbers.values.get(3 * n..3 * n + 3).unwrap_or(&[0.0; 3]);
            DVec3::new(values[0], values[1], values[2])
        };
        for n in 0..points.values.len() / 3 {
            let value = |slot: &Option<Numbers>| {
                slot.as_ref()
                    .and_then(|numbers| numbers.values.get(n))
                    .copied()
                    .unwrap_or_default()
            };
            let [kind, point, section, radius] = attributes.each_ref().map(value);
            let vertex = SurfaceVertex {
                position: Vec3::ZERO,
                normal: normals
                    .as_ref()
                    .map_or(DVec3::ZERO, |all| three(all, n))
                    .as_vec3(),
                kind: kind as i32,
                point: point as i32,
                section: section as i32,
                radius: radius as f32,
            };
            mesh.vertex(points.at, three(&points, n), vertex)?;
        }
        if mesh.wants_own() {
            self.read_own(piece, first as usize, mesh)?;
        }

        let (corners, ends) = (need("Cells/connectivity")?, need("Cells/offsets")?);
        let types = need("Cells/types")?;
        let mut start = 0;
        let mut cell = Vec::new();
        for (end, kind) in ends.values.iter().zip(&types.values) {
            let end = index(*end, ends.at)? as usize;
            let Some(range) = corners.values.get(start..end) else {
                return Err(malformed(
                    ends.at,
                    format!("offset {end}"),
                    "offsets that rise, within \
                     the connectivity",
                ));
            };
            if ![5.0, 7.0, 9.0].contains(kind) {
                let remedy = "extract the surface, as triangles, quads or polygons";
                return Err(unsupported_at(
                    types.at,
                    format!("a cell of type {kind}"),
                    remedy,
                ));
            }
            cell.clear();
            for &corner in range {
                let corner = u64::from(index(corner, corners.at)?) + first;
                cell.push(u32::try_from(corner).unwrap_or(u32::MAX));
            }
            mesh.face(corners.at, &cell)?;
            start = end;
        }
        Ok(())
    }

    /// Reads numbers of one's own of the points of a piece; texts and matrices are skipped.
    fn read_own(
        &self,
        piece: &Piece<'_>,
        first: usize,
        mesh: &mut Builder,
    ) -> Result<(), ReadError> {
        let own = piece.iter().filter_map(|(name, array)| {
            let name = name.strip_prefix("PointData/")?;
            let single = is_single(array.kind)?;
            let own = !KEPT.contains(&name) && (1..=MOST_COMPONENTS).contains(&array.components);
            own.then_some((array, name, single))
        });
        let mut own: Vec<_> = own.collect();
        own.sort_by_key(|(array, ..)| array.text);
        for (array, name, single) in own {
            let Numbers { values, at } = self.numbers(array)?;
            let (components, points) = (array.components, mesh.vertex_count() - first);
            if values.len() != components * points {
                let found = format!("{} numbers of '{name}' for {points} points", values.len());
                return Err(malformed(at, found, "as many as NumberOfComponents says"));
            }
            let attribute = OwnAttribute {
                name: name.to_owned(),
                components,
                values,
                single,
            };
            mesh.own(at, first, attribute)?;
        }
        Ok(())
    }

    fn numbers(&self, array: &Array<'_>) -> Result<Numbers, ReadError> {
        let text_end = find(self.bytes, array.text, b"<").unwrap_or(self.bytes.len());
        let text = self.bytes.get(array.text..text_end).unwrap_or_default();
        let at = FilePosition::Byte(array.text);
        match array.format {
            "ascii" => {
                let values = words(text)
                    .map(|word| number(Some(word), at))
                    .collect::<Result<_, _>>()?;
                Ok(Numbers { values, at })
            }
            "binary" => self.decode(&self.unpack(text.trim_ascii(), at)?, array.kind, at),
            "appended" => self.appended_numbers(array, at),
            format => Err(unsupported_at(
                at,
                format!("format '{format}'"),
                "write it as appended",
            )),
        }
    }

    fn appended_numbers(&self, array: &Array<'_>, at: FilePosition) -> Result<Numbers, ReadError> {
        let (Some(appended), Some(offset)) = (&self.appended, array.offset) else {
            return Err(malformed(
                at,
                "an appended array",
                "an offset and <AppendedData>",
            ));
        };
        let start = appended.start.saturating_add(offset);
        let at = FilePosition::Byte(start);
        let data = self.bytes.get(start..).unwrap_or_default();
        if appended.raw {
            self.decode(self.counted(data, at)?, array.kind, at)
        } else {
            self.decode(&self.unpack(data, at)?, array.kind, at)
        }
    }

    /// The bytes behind a count of bytes.
    fn counted<'b>(&self, data: &'b [u8], at: FilePosition) -> Result<&'b [u8], ReadError> {
        let width = if self.wide { 8 } else { 4 };
        let cut = || ReadError::Truncated {
            at,
            what: "an array",
        };
        let (count, data) = data.split_at_checked(width).ok_or_else(cut)?;
        let mut wide = [0; 8];
        wide[..width].copy_from_slice(count);
        if self.big {
            wide[..width].reverse();
        }
        let count = usize::try_from(u64::from_le_bytes(wide)).unwrap_or(usize::MAX);
        data.get(..count).ok_or_else(cut)
    }

    fn unpack(&self, text: &[u8], at: FilePosition) -> Result<Vec<u8>, ReadError> {
        let length = text
            .iter()
            .position(|&byte| byte == b'<')
            .unwrap_or(text.len());
        let wrong = || malformed(at, "an array", "base64");
        let width = if self.wide { 8 } else { 4 };
        // First the count alone, then no more than it asks for: other arrays may follow.
        let head = base64::decode(&text[..length.min(16)], width).ok_or_else(wrong)?;
        let mut padded = [0; 8];
        padded[..head.len()].copy_from_slice(&head);
        if self.big {
            padded[..width].reverse();
        }
        let limit = u64::from_le_bytes(padded).saturating_add(width as u64);
        let limit = usize::try_from(limit).unwrap_or(usize::MAX);
        let bytes = base64::decode(&text[..length], limit).ok_or_else(wrong)?;
        Ok(self.counted(&bytes, at)?.to_vec())
    }

    fn decode(&self, bytes: &[u8], kind: &str, at: FilePosition) -> Result<Numbers, ReadError> {
        macro_rules! numbers {
            ($kind:ty) => {
                bytes
                    .as_chunks()
                    .0
                    .iter()
                    .map(|&chunk| {
                        let big = self.big;
                        let number = if big {
                            <$kind>::from_be_bytes
                        } else {
                            <$kind>::from_le_bytes
                        };
                        number(chunk) as f64
                    })
                    .collect()
            };
        }
        let values = match kind {
            "Int8" => numbers!(i8),
            "UInt8" => numbers!(u8),
            "Int16" => numbers!(i16),
            "UInt16" => numbers!(u16),
            "Int32" => numbers!(i32),
            "UInt32" => numbers!(u32),
            "Int64" => numbers!(i64),
            "UInt64" => numbers!(u64),
            "Float32" => numbers!(f32),
            "Float64" => numbers!(f64),
            _ => {
                return Err(malformed(
                    at,
                    format!("type '{kind}'"),
                    "a type such as Float32",
                ));
            }
        };
        Ok(Numbers { values, at })
    }
}

/// Arrays of points that every mesh has.
const KEPT: [&str; 5] = ["Normals", "type", "point", "section", "radius"];

/// Whether an `f32` holds all numbers of a type; none if it has no numbers.
fn is_single(kind: &str) -> Option<bool> {
    match kind {
        "Int8" | "UInt8" | "Int16" | "UInt16" | "Float32" => Some(true),
        "Int32" | "UInt32" | "Int64" | "UInt64" | "Float64" => Some(false),
        _ => None,
    }
}

fn unsupported(at: usize, what: &str, remedy: &'static str) -> ReadError {
    unsupported_at(FilePosition::Byte(at), what.to_owned(), remedy)
}

fn unsupported_at(at: FilePosition, what: String, remedy: &'static str) -> ReadError {
    ReadError::Unsupported { at, what, remedy }
}
