//! Draco, [the compression of meshes](https://google.github.io/draco/spec/) that glTF and neuroglancer read: triangles by
//! EdgeBreaker, numbers predicted from their neighbors.
//!
//! What others read and write by is in the crate `draco-core`, which is young and by one author: it is pinned, and one file
//! knows it (`coder.rs`). Without the feature `draco`, nothing is compressed, and what is cannot be read.
//!
//! Integers come back as they were. Floats are rounded to the steps of their quantization, or kept as they are, which
//! compresses nothing. **The order changes**: EdgeBreaker walks over the surface, and numbers vertices and triangles by
//! its way. A vertex where several fans of triangles meet becomes several, one without triangles is lost; none are
//! merged, however close, so what was closed by its indices stays closed.

#[cfg(feature = "draco")]
mod coder;
#[cfg(not(feature = "draco"))]
#[path = "absent.rs"]
mod coder;

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
    /// The feature `draco` is off.
    #[error("this build has no Draco: use one that has")]
    Absent,
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

/// Compresses a mesh of triangles. The result depends on nothing but what is given.
///
/// # Errors
/// If there are no triangles, no position, or what is given does not fit together.
pub fn encode(triangles: &[[u32; 3]], attributes: &[Attribute<'_>]) -> Result<Encoded, DracoError> {
    let vertices = checked(triangles, attributes)?;
    coder::encode(triangles, attributes, vertices)
}

/// Reads a stream, this crate's or another's.
///
/// # Errors
/// It is no stream of triangles, is cut off, or would give a mesh far larger than itself.
pub fn decode(bytes: &[u8]) -> Result<Decoded, DracoError> {
    coder::decode(bytes)
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
