//! PLY: text and binary of both byte orders, any elements and properties.

use glam::{DVec3, Vec3};

use super::builder::Builder;
use super::lines::{Lines, index, number, whole, words};
use super::own::{MOST_COMPONENTS, OwnAttribute};
use super::{FilePosition, ReadError, malformed, shown};
use crate::SurfaceVertex;

pub(super) fn read(bytes: &[u8], mesh: &mut Builder) -> Result<(), ReadError> {
    let mut lines = Lines::new(bytes);
    let header = Header::read(&mut lines)?;
    match header.encoding {
        Encoding::Text => {
            let mut text = Text {
                words: Vec::new(),
                lines,
            };
            for element in &header.elements {
                rows((element, &header.vectors), &mut text, mesh)?;
            }
        }
        Encoding::Little | Encoding::Big => {
            let big = matches!(header.encoding, Encoding::Big);
            let mut binary = Binary {
                bytes,
                at: lines.at.min(bytes.len()),
                big,
            };
            for element in &header.elements {
                rows((element, &header.vectors), &mut binary, mesh)?;
            }
        }
    }
    Ok(())
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    /// Names of numbers of one's own that several properties have together, and how many: a comment of our writer's.
    vectors: Vec<(String, usize)>,
}

enum Encoding {
    Text,
    Little,
    Big,
}

struct Element {
    name: Vec<u8>,
    count: u64,
    properties: Vec<Property>,
}

struct Property {
    name: Vec<u8>,
    /// Type of the number of entries, if it is a list.
    list: Option<Kind>,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Header {
    fn read(lines: &mut Lines<'_>) -> Result<Self, ReadError> {
        if lines.next().map(<[u8]>::trim_ascii) != Some(b"ply") {
            return Err(malformed(FilePosition::Line(1), "the first line", "'ply'"));
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut vectors = Vec::new();
        while let Some(line) = lines.next() {
            let at = lines.place();
            let mut words = words(line);
            match words.next().unwrap_or_default() {
                b"format" => encoding = Some(Self::encoding(words.next(), at)?),
                b"element" => elements.push(Element {
                    name: words.next().unwrap_or_default().to_vec(),
                    count: whole(words.next(), at)?,
                    properties: Vec::new(),
                }),
                b"property" => {
                    let Some(element) = elements.last_mut() else {
                        return Err(malformed(at, "a property", "an element before it"));
                    };
                    element.properties.push(Property::read(words, at)?);
                }
                b"end_header" => {
                    let missing = || malformed(at, "the end of the header", "a format before it");
                    return Ok(Self {
                        encoding: encoding.ok_or_else(missing)?,
                        elements,
                        vectors,
                    });
                }
                b"comment" => vectors.extend(vector(words)),
                b"" | b"obj_info" => {}
                word => return Err(malformed(at, shown(word), "a word of a PLY header")),
            }
        }
        Err(ReadError::Truncated {
            at: lines.place(),
            what: "the header",
        })
    }

    fn encoding(word: Option<&[u8]>, at: FilePosition) -> Result<Encoding, ReadError> {
        match word.unwrap_or_default() {
            b"ascii" => Ok(Encoding::Text),
            b"binary_little_endian" => Ok(Encoding::Little),
            b"binary_big_endian" => Ok(Encoding::Big),
            word => Err(malformed(
                at,
                shown(word),
                "ascii, binary_little_endian or binary_big_endian",
            )),
        }
    }
}

/// What a comment of our writer's says of several properties: their name together, and how many.
fn vector<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Option<(String, usize)> {
    words.next().filter(|word| *word == b"components:")?;
    let name = std::str::from_utf8(words.next()?).ok()?;
    let count = std::str::from_utf8(words.next()?).ok()?.parse().ok()?;
    (2..=MOST_COMPONENTS)
        .contains(&count)
        .then(|| (name.to_owned(), count))
}

impl Property {
    fn read<'a>(
        mut words: impl Iterator<Item = &'a [u8]>,
        at: FilePosition,
    ) -> Result<Self, ReadError> {
        let mut next = || words.next().unwrap_or_default();
        let first = next();
        let (list, kind) = if first == b"list" {
            (Some(Kind::read(next(), at)?), Kind::read(next(), at)?)
        } else {
            (None, Kind::read(first, at)?)
        };
        Ok(Self {
            name: next().to_vec(),
            list,
            kind,
        })
    }
}

impl Kind {
    /// Whether an `f32` holds all numbers of the type.
    fn is_single(self) -> bool {
        !matches!(self, Self::I32 | Self::U32 | Self::F64)
    }

    fn read(word: &[u8], at: FilePosition) -> Result<Self, ReadError> {
        Ok(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => {
                return Err(malformed(
                    at,
                    shown(word),
                    "a type such as uchar, int or float",
                ));
            }
        })
    }
}

/// Numbers one after the other.
trait Numbers {
    fn place(&self) -> FilePosition;
    fn next(&mut self, kind: Kind) -> Result<f64, ReadError>;
}

struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
    big: bool,
}

impl Binary<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], ReadError> {
        let found = self.bytes.get(self.at..).and_then(<[u8]>::first_chunk::<N>);
        let cut = ReadError::Truncated {
            at: FilePosition::Byte(self.at),
            what: "the elements",
        };
        let mut bytes = *found.ok_or(cut)?;
        self.at += N;
        if self.big {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl Numbers for Binary<'_> {
    fn place(&self) -> FilePosition {
        FilePosition::Byte(self.at)
    }

    fn next(&mut self, kind: Kind) -> Result<f64, ReadError> {
        Ok(match kind {
            Kind::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Kind::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Kind::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Kind::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Kind::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Kind::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Kind::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Kind::F64 => f64::from_le_bytes(self.take()?),
        })
    }
}

/// Words of a text, wherever its lines end.
struct Text<'a> {
    lines: Lines<'a>,
    /// Words left of the line, last first.
    words: Vec<&'a [u8]>,
}

impl Numbers for Text<'_> {
    fn place(&self) -> FilePosition {
        self.lines.place()
    }

    fn next(&mut self, _: Kind) -> Result<f64, ReadError> {
        while self.words.is_empty() {
            let cut = ReadError::Truncated {
                at: self.place(),
                what: "the elements",
            };
            self.words.extend(words(self.lines.next().ok_or(cut)?));
            self.words.reverse();
        }
        number(self.words.pop(), self.place())
    }
}

/// The properties of vertices that are kept, in the order of the slots.
const KEPT: [&[u8]; 10] = [
    b"x", b"y", b"z", b"nx", b"ny", b"nz", b"type", b"point", b"section", b"radius",
];

/// Reads the rows of one element.
fn rows(
    (element, vectors): (&Element, &[(String, usize)]),
    numbers: &mut impl Numbers,
    mesh: &mut Builder,
) -> Result<(), ReadError> {
    if element.properties.is_empty() {
        // Nothing stands in the file, whatever the count.
        return Ok(());
    }
    let vertex = element.name == b"vertex";
    let face = element.name == b"face";
    let slots: Vec<Option<usize>> = element
        .properties
        .iter()
        .map(|property| {
            KEPT.iter()
                .position(|kept| vertex && property.name == *kept)
        })
        .collect();
    if vertex && !(0..3).all(|axis| slots.contains(&Some(axis))) {
        return Err(malformed(
            FilePosition::File,
            "vertices without x, y or z",
            "these properties",
        ));
    }
    let kept = slots.iter().map(Option::is_some);
    let mut own = match vertex && mesh.wants_own() {
        true => own_properties(&element.properties, kept.collect()),
        false => Vec::new(),
    };
    let first = mesh.vertex_count();
    let mut corners = Vec::new();
    for _ in 0..element.count {
        let at = numbers.place();
        let mut slot = [0.0; KEPT.len()];
        let mut has_corners = false;
        let mut own_values = own.iter_mut();
        for (property, kept) in element.properties.iter().zip(&slots) {
            let Some(list) = property.list else {
                let value = numbers.next(property.kind)?;
                if let Some(kept) = *kept {
                    slot[kept] = value;
                } else if let Some(own) = own_values.next() {
                    own.values.push(value);
                }
                continue;
            };
            let is_corners =
                face && matches!(&property.name[..], b"vertex_indices" | b"vertex_index");
            has_corners |= is_corners;
            if is_corners {
                corners.clear();
            }
            for _ in 0..index(numbers.next(list)?, at)? {
                let value = numbers.next(property.kind)?;
                if is_corners {
                    corners.push(index(value, at)?);
                }
            }
        }
        if vertex {
            push_vertex(mesh, at, &slot)?;
        } else if has_corners {
            mesh.face(at, &corners)?;
        }
    }
    let at = numbers.place();
    for attribute in together(own, vectors) {
        mesh.own(at, first, attribute)?;
    }
    Ok(())
}

/// The properties of vertices that are numbers of one's own: all that are not kept, but for lists.
fn own_properties(properties: &[Property], kept: Vec<bool>) -> Vec<OwnAttribute> {
    let own = properties.iter().zip(kept);
    let own = own.filter(|(property, kept)| !kept && property.list.is_none());
    own.map(|(property, _)| OwnAttribute {
        name: String::from_utf8_lossy(&property.name).into_owned(),
        components: 1,
        values: Vec::new(),
        single: property.kind.is_single(),
    })
    .collect()
}

/// Joins properties that one attribute has together: `direction_0`, `direction_1`, `direction_2`.
fn together(own: Vec<OwnAttribute>, vectors: &[(String, usize)]) -> Vec<OwnAttribute> {
    let mut joined = Vec::with_capacity(own.len());
    let mut rest = own.into_iter();
    while !rest.as_slice().is_empty() {
        let vector = vectors.iter().find(|(name, count)| {
            let mut parts = (0..*count).zip(rest.as_slice());
            rest.len() >= *count && parts.all(|(n, part)| part.name == format!("{name}_{n}"))
        });
        let Some((name, count)) = vector else {
            joined.extend(rest.next());
            continue;
        };
        let parts: Vec<OwnAttribute> = rest.by_ref().take(*count).collect();
        let vertices = 0..parts[0].values.len();
        let values = vertices.flat_map(|vertex| parts.iter().map(move |part| part.values[vertex]));
        joined.push(OwnAttribute {
            name: name.clone(),
            components: *count,
            values: values.collect(),
            single: parts.iter().all(|part| part.single),
        });
    }
    joined
}

fn push_vertex(mesh: &mut Builder, at: FilePosition, slot: &[f64; 10]) -> Result<(), ReadError> {
    let [x, y, z, nx, ny, nz, kind, point, section, radius] = *slot;
    let vertex = SurfaceVertex {
        position: Vec3::ZERO,
        normal: DVec3::new(nx, ny, nz).as_vec3(),
        kind: kind as i32,
        point: point as i32,
        section: section as i32,
        radius: radius as f32,
    };
    mesh.vertex(at, DVec3::new(x, y, z), vertex)
}
