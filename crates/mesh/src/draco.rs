//! Draco, [the compression of meshes](https://google.github.io/draco/spec/) that glTF and neuroglancer read: triangles by
//! EdgeBreaker, numbers predicted from their neighbors.
//!
//! The only file that knows the crate `draco-core`, which is young and by one author: it is pinned, and what is asked of
//! it is here.
//!
//! Integers come back as they were. Floats are rounded to the steps of their quantization, or kept as they are, which
//! compresses nothing. **The order changes**: EdgeBreaker walks over the surface, and numbers vertices and triangles by
//! its way. A vertex where several fans of triangles meet becomes several, one without triangles is lost; none are
//! merged, however close, so what was closed by its indices stays closed.

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, GeometryAttributeType, Mesh, MeshEncoder,
    PointAttribute,
};

/// What an attribute means to those who read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AttributeKind {
    /// Where vertices are. Each mesh has one.
    Position,
    /// Unit vectors. With quantization, their directions only.
    Normal,
    /// Colors.
    Color,
    /// Anything else.
    Generic,
}

/// Numbers of an attribute, those of a vertex one after another.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Values<'a> {
    /// Floats.
    F32(&'a [f32]),
    /// Signed integers.
    I32(&'a [i32]),
    /// Bytes.
    U8(&'a [u8]),
    /// Unsigned integers below 65,536.
    U16(&'a [u16]),
    /// Unsigned integers.
    U32(&'a [u32]),
}

impl Values<'_> {
    fn len(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::I32(values) => values.len(),
            Self::U8(values) => values.len(),
            Self::U16(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }

    fn data_type(&self) -> DataType {
        match self {
            Self::F32(_) => DataType::Float32,
            Self::I32(_) => DataType::Int32,
            Self::U8(_) => DataType::Uint8,
            Self::U16(_) => DataType::Uint16,
            Self::U32(_) => DataType::Uint32,
        }
    }

    fn bytes(&self) -> Vec<u8> {
        match self {
            Self::F32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::I32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::U8(values) => values.to_vec(),
            Self::U16(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::U32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        }
    }
}

/// Numbers of the vertices of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attribute<'a> {
    /// What it means.
    pub kind: AttributeKind,
    /// Numbers of a vertex, 1 to 4.
    pub components: usize,
    /// The numbers; `components` for each vertex.
    pub values: Values<'a>,
    /// Bits that floats are rounded to, 1 to 30: those of the longest side of their bounding box. `None` keeps floats as
    /// they are, and so it is for integers.
    pub quantization: Option<u8>,
}

/// A compressed mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Encoded {
    /// The stream, as in a `.drc` file.
    pub bytes: Vec<u8>,
    /// The id that each attribute has in the stream, in the order given; `KHR_draco_mesh_compression` names them.
    pub attribute_ids: Vec<u32>,
    /// Vertices that a decoder makes.
    pub vertices: usize,
    /// Triangles that a decoder makes.
    pub faces: usize,
}

/// Why a mesh could not be compressed.
#[derive(Debug, thiserror::Error)]
pub enum DracoError {
    /// There is nothing to compress.
    #[error("the mesh has no triangles")]
    Empty,
    /// Attributes are of different numbers of vertices, or of none.
    #[error("attribute {attribute} has {found} numbers, {expected} are needed")]
    Count {
        /// Its place in the list.
        attribute: usize,
        /// Its numbers.
        found: usize,
        /// Components times vertices.
        expected: usize,
    },
    /// An attribute cannot be as it is described.
    #[error("attribute {attribute}: {what}")]
    Attribute {
        /// Its place in the list.
        attribute: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// A triangle has a corner that is not there.
    #[error("triangle {triangle} has vertex {vertex}, there are {vertices}")]
    Index {
        /// Its place in the list.
        triangle: usize,
        /// The vertex.
        vertex: u32,
        /// Vertices that there are.
        vertices: usize,
    },
    /// The encoder failed.
    #[error("Draco: {0}")]
    Encoder(String),
}

/// Level of the encoder, 0 to 10: more is smaller and slower.
const LEVEL: i32 = 6;

/// Compresses a mesh of triangles. The result depends on nothing but what is given.
///
/// # Errors
/// If there are no triangles, no position, or what is given does not fit together.
pub fn encode(triangles: &[[u32; 3]], attributes: &[Attribute<'_>]) -> Result<Encoded, DracoError> {
    let vertices = checked(triangles, attributes)?;
    let mut mesh = Mesh::new();
    mesh.set_num_points(vertices);
    let mut options = EncoderOptions::new();
    options.set_compression_level(LEVEL);
    let mut attribute_ids = Vec::new();
    for attribute in attributes {
        let id = mesh.add_attribute(point_attribute(attribute, vertices)?);
        if let (Values::F32(_), Some(bits)) = (attribute.values, attribute.quantization) {
            options.set_attribute_quantization(id, i32::from(bits));
        }
        attribute_ids.push(mesh.attribute(id).unique_id());
    }
    // Without their number, faces are left out and nothing is said.
    mesh.try_set_num_faces(triangles.len()).map_err(failed)?;
    mesh.set_faces_from_flat_indices(triangles.as_flattened());
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut out = EncoderBuffer::new();
    let info = encoder
        .encode_with_info(&options, &mut out)
        .map_err(failed)?;
    Ok(Encoded {
        bytes: out.data().to_vec(),
        attribute_ids,
        vertices: info.num_encoded_points,
        faces: info.num_encoded_faces,
    })
}

/// The number of vertices.
fn checked(triangles: &[[u32; 3]], attributes: &[Attribute<'_>]) -> Result<usize, DracoError> {
    if triangles.is_empty() {
        return Err(DracoError::Empty);
    }
    let positions = attributes
        .iter()
        .position(|attribute| attribute.kind == AttributeKind::Position)
        .ok_or(DracoError::Attribute {
            attribute: 0,
            what: "there is none of positions",
        })?;
    let vertices = attributes[positions].values.len() / 3;
    for (number, attribute) in attributes.iter().enumerate() {
        let refused = |what| {
            Err(DracoError::Attribute {
                attribute: number,
                what,
            })
        };
        let three = matches!(
            attribute.kind,
            AttributeKind::Position | AttributeKind::Normal
        );
        if three && attribute.components != 3 {
            return refused("positions and normals have three components");
        }
        if !(1..=4).contains(&attribute.components) {
            return refused("it has 1 to 4 components");
        }
        if attribute
            .quantization
            .is_some_and(|bits| !(1..=30).contains(&bits))
        {
            return refused("floats are rounded to 1 to 30 bits");
        }
        if let Values::F32(values) = attribute.values
            && values.iter().any(|value| !value.is_finite())
            && attribute.quantization.is_some()
        {
            return refused("what is not finite cannot be rounded to bits");
        }
        let expected = attribute.components * vertices;
        if attribute.values.len() != expected {
            return Err(DracoError::Count {
                attribute: number,
                found: attribute.values.len(),
                expected,
            });
        }
    }
    for (number, triangle) in triangles.iter().enumerate() {
        if let Some(&vertex) = triangle.iter().find(|&&v| v as usize >= vertices) {
            return Err(DracoError::Index {
                triangle: number,
                vertex,
                vertices,
            });
        }
    }
    Ok(vertices)
}

fn point_attribute(
    attribute: &Attribute<'_>,
    vertices: usize,
) -> Result<PointAttribute, DracoError> {
    let kind = match attribute.kind {
        AttributeKind::Position => GeometryAttributeType::Position,
        AttributeKind::Normal => GeometryAttributeType::Normal,
        AttributeKind::Color => GeometryAttributeType::Color,
        AttributeKind::Generic => GeometryAttributeType::Generic,
    };
    let mut made = PointAttribute::new();
    let data_type = attribute.values.data_type();
    made.try_init(kind, attribute.components as u8, data_type, false, vertices)
        .map_err(failed)?;
    made.buffer_mut().write(0, &attribute.values.bytes());
    Ok(made)
}

#[expect(clippy::needless_pass_by_value, reason = "it goes to `map_err`")]
fn failed(error: draco_core::DracoError) -> DracoError {
    DracoError::Encoder(error.to_string())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use draco_core::{DecoderBuffer, FaceIndex, MeshDecoder, PointIndex};

    use super::*;

    /// A torus of 12 by 7 vertices: closed, and of a connectivity that EdgeBreaker must split.
    fn torus() -> (Vec<[u32; 3]>, Vec<f32>) {
        let (long, short) = (12_u32, 7_u32);
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..long {
            for j in 0..short {
                let around = f32::from(i as u8) * std::f32::consts::TAU / long as f32;
                let across = f32::from(j as u8) * std::f32::consts::TAU / short as f32;
                let far = 3.0 + across.cos();
                positions.extend([far * around.cos(), far * around.sin(), across.sin()]);
                let at = |i: u32, j: u32| (i % long) * short + j % short;
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        (triangles, positions)
    }

    fn decoded(bytes: &[u8]) -> Mesh {
        let mut mesh = Mesh::new();
        let mut buffer = DecoderBuffer::new(bytes);
        MeshDecoder::new().decode(&mut buffer, &mut mesh).unwrap();
        mesh
    }

    fn corners(mesh: &Mesh) -> Vec<[u32; 3]> {
        let face = |f| mesh.face(FaceIndex(f)).map(|point| point.0);
        (0..mesh.num_faces() as u32).map(face).collect()
    }

    /// Components of each point, as stored.
    fn numbers<const N: usize>(mesh: &Mesh, id: u32) -> Vec<[u8; N]> {
        let attribute = mesh.attribute_by_unique_id(id).unwrap();
        let of_point = |point| {
            let mut bytes = [0; N];
            let place = attribute.mapped_index(PointIndex(point)).0 as usize * N;
            attribute.buffer().read(place, &mut bytes);
            bytes
        };
        (0..mesh.num_points() as u32).map(of_point).collect()
    }

    /// Each triangle, from its smallest corner on.
    fn sorted(mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
        for triangle in &mut triangles {
            let least = (0..3).min_by_key(|&i| triangle[i]).unwrap();
            triangle.rotate_left(least);
        }
        triangles.sort_unstable();
        triangles
    }

    #[test]
    fn integers_and_triangles_come_back() {
        let (triangles, positions) = torus();
        let count = positions.len() / 3;
        let number: Vec<u32> = (0..count as u32).map(|v| v * 51_130_563).collect();
        let id: Vec<u16> = (0..count as u16).map(|v| v * 780).collect();
        let kind: Vec<u8> = (0..count as u8).map(|v| v % 5).collect();
        let signed: Vec<i32> = positions.iter().map(|p| (p * 1e5) as i32).collect();
        let generic = |values| Attribute {
            kind: AttributeKind::Generic,
            components: 1,
            values,
            quantization: None,
        };
        let encoded = encode(
            &triangles,
            &[
                generic(Values::U16(&id)),
                Attribute {
                    kind: AttributeKind::Position,
                    components: 3,
                    ..generic(Values::I32(&signed))
                },
                generic(Values::U8(&kind)),
                generic(Values::U32(&number)),
            ],
        )
        .unwrap();
        let mesh = decoded(&encoded.bytes);
        assert_eq!(
            (mesh.num_points(), mesh.num_faces()),
            (encoded.vertices, encoded.faces)
        );
        assert_eq!((encoded.vertices, encoded.faces), (count, triangles.len()));
        let [ids, places, kinds, own] = encoded.attribute_ids[..] else {
            panic!("four attributes");
        };
        let old: Vec<u32> = numbers::<2>(&mesh, ids)
            .into_iter()
            .map(|bytes| u32::from(u16::from_le_bytes(bytes)) / 780)
            .collect();
        for (new, &old) in old.iter().enumerate() {
            let old = old as usize;
            assert_eq!(numbers::<1>(&mesh, kinds)[new], [kind[old]]);
            assert_eq!(numbers::<4>(&mesh, own)[new], number[old].to_le_bytes());
            let place = signed[3 * old..3 * old + 3]
                .iter()
                .flat_map(|p| p.to_le_bytes());
            let place: Vec<u8> = place.collect();
            assert_eq!(numbers::<12>(&mesh, places)[new][..], place);
        }
        let renumbered = corners(&mesh)
            .into_iter()
            .map(|t| t.map(|corner| old[corner as usize]))
            .collect();
        assert_eq!(sorted(renumbered), sorted(triangles));
    }

    #[test]
    fn rounded_floats_are_near_and_the_surface_is_closed() {
        let (triangles, positions) = torus();
        let normals: Vec<f32> = positions.iter().map(|_| 1.0 / 3_f32.sqrt()).collect();
        let float = |kind, values, bits| Attribute {
            kind,
            components: 3,
            values: Values::F32(values),
            quantization: Some(bits),
        };
        let encoded = encode(
            &triangles,
            &[
                float(AttributeKind::Position, &positions, 16),
                float(AttributeKind::Normal, &normals, 10),
            ],
        )
        .unwrap();
        let mesh = decoded(&encoded.bytes);
        let places = numbers::<12>(&mesh, encoded.attribute_ids[0]);
        let step = 8.0 / 65_535.0;
        for place in places {
            let new: Vec<f32> = place
                .as_chunks::<4>()
                .0
                .iter()
                .map(|&bytes| f32::from_le_bytes(bytes))
                .collect();
            let near = |old: &[f32]| (0..3).all(|i| (old[i] - new[i]).abs() <= 0.51 * step);
            assert!(positions.as_chunks::<3>().0.iter().any(|old| near(old)));
        }
        let mut edges = BTreeMap::new();
        for [a, b, c] in corners(&mesh) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from, to)).or_insert(0) += 1;
            }
        }
        assert!(
            edges
                .iter()
                .all(|(&(from, to), &count)| count == 1 && edges.get(&(to, from)) == Some(&1))
        );
    }

    #[test]
    fn what_does_not_fit_together_is_refused() {
        let (triangles, positions) = torus();
        let place = Attribute {
            kind: AttributeKind::Position,
            components: 3,
            values: Values::F32(&positions),
            quantization: Some(14),
        };
        let error = |triangles: &[[u32; 3]], attributes: &[Attribute<'_>]| {
            encode(triangles, attributes).unwrap_err().to_string()
        };
        assert_eq!(error(&[], &[place]), "the mesh has no triangles");
        assert_eq!(
            error(&[[0, 1, 84]], &[place]),
            "triangle 0 has vertex 84, there are 84"
        );
        let short = Attribute {
            kind: AttributeKind::Generic,
            components: 1,
            values: Values::U8(&[1, 2]),
            quantization: None,
        };
        assert_eq!(
            error(&triangles, &[place, short]),
            "attribute 1 has 2 numbers, 84 are needed"
        );
        assert!(error(&triangles, &[]).contains("there is none of positions"));
        let lost = [f32::NAN; 252];
        let lost = Attribute {
            values: Values::F32(&lost),
            ..place
        };
        assert!(error(&triangles, &[lost]).contains("not finite"));
    }
}
