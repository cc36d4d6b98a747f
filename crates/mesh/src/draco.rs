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
    DataType, DecodeLimits, DecoderBuffer, EncoderBuffer, EncoderOptions, FaceIndex,
    GeometryAttributeType, Mesh, MeshDecoder, MeshEncoder, PointAttribute, PointIndex,
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
    /// Signed integers of 16 bits.
    I16(&'a [i16]),
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
            Self::I16(values) => values.len(),
            Self::U8(values) => values.len(),
            Self::U16(values) => values.len(),
            Self::U32(values) => values.len(),
        }
    }

    fn data_type(&self) -> DataType {
        match self {
            Self::F32(_) => DataType::Float32,
            Self::I32(_) => DataType::Int32,
            Self::I16(_) => DataType::Int16,
            Self::U8(_) => DataType::Uint8,
            Self::U16(_) => DataType::Uint16,
            Self::U32(_) => DataType::Uint32,
        }
    }

    fn bytes(&self) -> Vec<u8> {
        match self {
            Self::F32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::I32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::I16(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
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
#[derive(Clone, Debug, PartialEq)]
pub struct Encoded {
    /// The stream, as in a `.drc` file.
    pub bytes: Vec<u8>,
    /// The id that each attribute has in the stream, in the order given; `KHR_draco_mesh_compression` names them.
    pub attribute_ids: Vec<u32>,
    /// Vertices that a decoder makes.
    pub vertices: usize,
    /// Triangles that a decoder makes.
    pub faces: usize,
    /// Least and greatest coordinates that a decoder makes of positions that are floats.
    pub bounds: Option<[[f32; 3]; 2]>,
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
    /// A stream that cannot be read, or would be far larger than it is.
    #[error("Draco: {0}: compress the mesh anew")]
    Decoder(String),
}

/// What a stream holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Decoded {
    /// The triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Number of vertices.
    pub vertices: usize,
    /// The attributes, in the order of the stream.
    pub attributes: Vec<DecodedAttribute>,
}

/// Numbers of the vertices of a decoded mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodedAttribute {
    /// Its id in the stream.
    pub id: u32,
    /// Numbers of a vertex.
    pub components: usize,
    /// The numbers; `components` for each vertex.
    pub values: Vec<f64>,
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
    let corner = |bound: &Option<Vec<f64>>| {
        let bound = bound.as_ref()?.iter().map(|&coordinate| coordinate as f32);
        <[f32; 3]>::try_from(bound.collect::<Vec<_>>()).ok()
    };
    let mut bounds = info.attributes.iter();
    let bounds = bounds.find_map(|a| Some([corner(&a.position_min)?, corner(&a.position_max)?]));
    Ok(Encoded {
        bytes: out.data().to_vec(),
        attribute_ids,
        bounds,
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

/// Most triangles for each byte of a stream, as of other files that are read. Plain ones have half of one.
const TRIANGLES_PER_BYTE: u64 = 8;
/// Most bytes of numbers for each byte of a stream: ten attributes of four bytes for each triangle.
const NUMBERS_PER_BYTE: u64 = 40 * TRIANGLES_PER_BYTE;

/// Reads a stream, this crate's or another's.
///
/// # Errors
/// It is no stream of triangles, is cut off, or would give a mesh far larger than itself.
pub fn decode(bytes: &[u8]) -> Result<Decoded, DracoError> {
    let wrong = |error: draco_core::DracoError| DracoError::Decoder(error.to_string());
    let length = bytes.len() as u64;
    let limits = DecodeLimits::default()
        .with_max_faces(TRIANGLES_PER_BYTE.saturating_mul(length))
        .with_max_decoded_bytes(NUMBERS_PER_BYTE.saturating_mul(length));
    let mut mesh = Mesh::new();
    MeshDecoder::new()
        .decode(
            &mut DecoderBuffer::new(bytes).with_limits(limits),
            &mut mesh,
        )
        .map_err(wrong)?;
    let face = |number| mesh.face(FaceIndex(number)).map(|point| point.0);
    let mut attributes = Vec::new();
    for number in 0..mesh.num_attributes() {
        let attribute = mesh.try_attribute(number).map_err(wrong)?;
        attributes.push(DecodedAttribute {
            id: attribute.unique_id(),
            components: usize::from(attribute.num_components()),
            values: numbers(attribute, mesh.num_points())?,
        });
    }
    Ok(Decoded {
        triangles: (0..mesh.num_faces() as u32).map(face).collect(),
        vertices: mesh.num_points(),
        attributes,
    })
}

/// The numbers of all vertices.
fn numbers(attribute: &PointAttribute, vertices: usize) -> Result<Vec<f64>, DracoError> {
    let data_type = attribute.data_type();
    let (width, components) = (
        data_type.byte_length(),
        usize::from(attribute.num_components()),
    );
    let mut element = vec![0; width * components];
    let mut values = Vec::with_capacity(vertices.saturating_mul(components));
    for vertex in 0..vertices as u32 {
        let entry = attribute.mapped_index(PointIndex(vertex)).0 as usize;
        if !attribute
            .buffer()
            .try_read(entry.saturating_mul(element.len()), &mut element)
        {
            return Err(DracoError::Decoder("numbers are missing".into()));
        }
        for bytes in element.chunks_exact(width) {
            values.push(number(data_type, bytes)?);
        }
    }
    Ok(values)
}

/// A number from as many bytes as its type has.
fn number(data_type: DataType, bytes: &[u8]) -> Result<f64, DracoError> {
    let mut wide = [0; 8];
    wide[..bytes.len()].copy_from_slice(bytes);
    let bits = u64::from_le_bytes(wide);
    Ok(match data_type {
        DataType::Uint8 | DataType::Uint16 | DataType::Uint32 | DataType::Bool => bits as f64,
        DataType::Int8 => f64::from(bits as u8 as i8),
        DataType::Int16 => f64::from(bits as u16 as i16),
        DataType::Int32 => f64::from(bits as u32 as i32),
        DataType::Float32 => f64::from(f32::from_bits(bits as u32)),
        DataType::Float64 => f64::from_bits(bits),
        other => {
            return Err(DracoError::Decoder(format!("numbers of type {other:?}")));
        }
    })
}

#[expect(clippy::needless_pass_by_value, reason = "it goes to `map_err`")]
fn failed(error: draco_core::DracoError) -> DracoError {
    DracoError::Encoder(error.to_string())
}
