//! Encoding and decoding by `draco-core`: the only file that knows it.

use draco_core::{
    DataType, DecodeLimits, DecoderBuffer, EncoderBuffer, EncoderOptions, FaceIndex,
    GeometryAttributeType, Mesh, MeshDecoder, MeshEncoder, PointAttribute, PointIndex,
};

use super::{Attribute, AttributeKind, Decoded, DecodedAttribute, DracoError, Encoded, Values};

/// Level of the encoder, 0 to 10: more is slower. A cell of 5,000 points has 1.54, 1.35, 1.12, 1.11 and 1.13 MB with 3, 6, 7, 8
/// and 10; 10 takes twice as long as 7, 3 half as long.
const LEVEL: i32 = 7;

/// Compresses what was checked.
pub(super) fn encode(
    triangles: &[[u32; 3]],
    attributes: &[Attribute<'_>],
    vertices: usize,
) -> Result<Encoded, DracoError> {
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

fn data_type(values: Values<'_>) -> DataType {
    match values {
        Values::F32(_) => DataType::Float32,
        Values::I32(_) => DataType::Int32,
        Values::I16(_) => DataType::Int16,
        Values::U8(_) => DataType::Uint8,
        Values::U16(_) => DataType::Uint16,
        Values::U32(_) => DataType::Uint32,
    }
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
    let data_type = data_type(attribute.values);
    made.try_init(kind, attribute.components as u8, data_type, false, vertices)
        .map_err(failed)?;
    made.buffer_mut().write(0, &bytes(attribute.values));
    Ok(made)
}

fn bytes(values: Values<'_>) -> Vec<u8> {
    match values {
        Values::F32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        Values::I32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        Values::I16(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        Values::U8(values) => values.to_vec(),
        Values::U16(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
        Values::U32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
    }
}

/// Most triangles for each byte of a stream, as of other files that are read. Plain ones have half of one.
const TRIANGLES_PER_BYTE: u64 = 8;
/// Most bytes of numbers for each byte of a stream: ten attributes of four bytes for each triangle.
const NUMBERS_PER_BYTE: u64 = 40 * TRIANGLES_PER_BYTE;

/// Reads a stream.
pub(super) fn decode(bytes: &[u8]) -> Result<Decoded, DracoError> {
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
