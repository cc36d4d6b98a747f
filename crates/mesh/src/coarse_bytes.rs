//! A coarse mesh as bytes and back, for caches: the same bits, and every index in range.
//!
//! Corners, numbers of tracing points, samples and sections mostly count up, so they are stored as differences;
//! coordinates as they are. A tracing point with its ring takes some 165 bytes.

use crate::bytes::{ByteReader, ByteWriter, BytesError};
use crate::{
    CoarseMesh, Patch, PatchKind, Role, SampleId, SectionNumber, SwcType, TracingPoint, Vertex,
};

/// Fewest bytes of a vertex: position and normal, and a difference.
const VERTEX: usize = 25;
/// Fewest bytes of a tracing point.
const TRACING: usize = 41;
/// Fewest bytes of a patch: its kind and four differences.
const PATCH: usize = 5;

impl CoarseMesh {
    /// Appends the mesh to bytes.
    pub fn write_bytes(&self, to: &mut ByteWriter) {
        to.dvec3(self.origin);
        to.number(self.tracing.len() as u64);
        let mut before = TracingPoint::default();
        for point in &self.tracing {
            write_point(point, &before, to);
            before = *point;
        }
        to.number(self.vertices.len() as u64);
        let mut tracing = 0;
        for vertex in &self.vertices {
            to.vec3(vertex.position);
            to.vec3(vertex.normal);
            to.difference(vertex.tracing.into(), tracing);
            tracing = vertex.tracing.into();
        }
        to.number(self.patches.len() as u64);
        let mut before = [0; 4];
        for patch in &self.patches {
            to.raw(&[patch.kind as u8]);
            for (corner, before) in patch.corners.iter().zip(&mut before) {
                to.difference((*corner).into(), *before);
                *before = (*corner).into();
            }
        }
    }

    /// Takes a mesh off bytes. All indices of the mesh are in range, and its coordinates finite; that it is closed
    /// is not checked.
    ///
    /// # Errors
    /// The bytes end early, or hold what no mesh has.
    pub fn read_bytes(from: &mut ByteReader<'_>) -> Result<Self, BytesError> {
        let origin = from.dvec3()?;
        let points = from.count(TRACING)?;
        let mut tracing = Vec::with_capacity(points);
        let mut before = TracingPoint::default();
        for _ in 0..points {
            before = read_point(&before, from)?;
            tracing.push(before);
        }
        let count = from.count(VERTEX)?;
        let mut vertices = Vec::with_capacity(count);
        let mut before = 0;
        for _ in 0..count {
            let (position, normal) = (from.vec3()?, from.vec3()?);
            before = from.difference(before)?;
            vertices.push(Vertex {
                position,
                normal,
                tracing: index(before, points)?,
            });
        }
        let patches = read_patches(count, from)?;
        Ok(Self {
            origin,
            vertices,
            tracing,
            patches,
        })
    }
}

fn write_point(point: &TracingPoint, before: &TracingPoint, to: &mut ByteWriter) {
    let TracingPoint {
        center,
        radius,
        tangent,
        role,
        collar,
        taper,
        border,
        kind,
        sample,
        section,
    } = *point;
    to.vec3(center);
    to.f32(radius);
    to.vec3(tangent);
    to.f32(collar);
    to.f32(taper);
    to.raw(&[role as u8, border.cast_unsigned()]);
    to.difference(kind.0.into(), before.kind.0.into());
    to.difference(sample.0.into(), before.sample.0.into());
    to.difference(section.0.into(), before.section.0.into());
}

fn read_point(
    before: &TracingPoint,
    from: &mut ByteReader<'_>,
) -> Result<TracingPoint, BytesError> {
    let number = |value: i64| i32::try_from(value).map_err(|_| BytesError::Invalid("a number"));
    Ok(TracingPoint {
        center: from.vec3()?,
        radius: from.f32()?,
        tangent: from.vec3()?,
        collar: from.f32()?,
        taper: from.f32()?,
        role: match from.raw(1)?[0] {
            0 => Role::Ordinary,
            1 => Role::End,
            2 => Role::Joint,
            3 => Role::Soma,
            4 => Role::Insertion,
            5 => Role::Inset,
            _ => return Err(BytesError::Invalid("a role that is none")),
        },
        border: from.raw(1)?[0].cast_signed(),
        kind: SwcType(number(from.difference(before.kind.0.into())?)?),
        sample: SampleId(number(from.difference(before.sample.0.into())?)?),
        section: SectionNumber(number(from.difference(before.section.0.into())?)?),
    })
}

fn read_patches(vertices: usize, from: &mut ByteReader<'_>) -> Result<Vec<Patch>, BytesError> {
    let count = from.count(PATCH)?;
    let mut patches = Vec::with_capacity(count);
    let mut before = [0; 4];
    for _ in 0..count {
        let kind = match from.raw(1)?[0] {
            0 => PatchKind::Lateral,
            1 => PatchKind::Cap,
            2 => PatchKind::Soma,
            3 => PatchKind::Loft,
            _ => return Err(BytesError::Invalid("a kind of patch that is none")),
        };
        let mut corners = [0; 4];
        for (corner, before) in corners.iter_mut().zip(&mut before) {
            *before = from.difference(*before)?;
            *corner = index(*before, vertices)?;
        }
        patches.push(Patch { corners, kind });
    }
    Ok(patches)
}

/// An index below a count.
fn index(value: i64, count: usize) -> Result<u32, BytesError> {
    let index = u32::try_from(value).ok();
    let index = index.filter(|&index| (index as usize) < count);
    index.ok_or(BytesError::Invalid("an index that is out of range"))
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;

    fn mesh() -> CoarseMesh {
        let roles = [Role::Ordinary, Role::End, Role::Joint, Role::Soma];
        let roles = roles.into_iter().chain([Role::Insertion, Role::Inset]);
        let tracing = roles.zip(0..).map(|(role, i)| TracingPoint {
            center: Vec3::new(i as f32, -0.0, 1e-30),
            radius: 0.1 * i as f32,
            tangent: Vec3::Y,
            role,
            collar: i as f32 / 3.0,
            taper: -0.1 * i as f32,
            border: 3 - i as i8,
            kind: SwcType(i - 2),
            sample: SampleId(i32::MAX - i),
            section: SectionNumber(i32::MIN + 7 * i),
        });
        let vertices = (0..9_u32).map(|i| Vertex {
            position: Vec3::splat(i as f32),
            normal: Vec3::NEG_Z,
            tracing: i % 6,
        });
        let kinds = [
            PatchKind::Lateral,
            PatchKind::Cap,
            PatchKind::Soma,
            PatchKind::Loft,
        ];
        let patches = kinds.into_iter().zip(0..).map(|(kind, i)| Patch {
            corners: [i, i + 1, 8, 8 - i],
            kind,
        });
        CoarseMesh {
            origin: DVec3::new(1e7, -3.0, 0.25),
            vertices: vertices.collect(),
            tracing: tracing.collect(),
            patches: patches.collect(),
        }
    }

    fn bytes(mesh: &CoarseMesh) -> Vec<u8> {
        let mut writer = ByteWriter::default();
        mesh.write_bytes(&mut writer);
        writer.into_bytes()
    }

    #[test]
    fn a_mesh_comes_back_with_the_same_bits() {
        for mesh in [mesh(), CoarseMesh::default()] {
            let written = bytes(&mesh);
            let mut reader = ByteReader::new(&written);
            let read = CoarseMesh::read_bytes(&mut reader).expect("a mesh");
            assert_eq!((&read, reader.end()), (&mesh, Ok(())));
            // Also where bits differ that are equal as numbers.
            assert_eq!(bytes(&read), written);
        }
    }

    #[test]
    fn bytes_that_end_early_are_an_error() {
        let written = bytes(&mesh());
        for length in 0..written.len() {
            let read = CoarseMesh::read_bytes(&mut ByteReader::new(&written[..length]));
            assert_eq!(read, Err(BytesError::Short), "{length}");
        }
    }

    #[test]
    fn changed_bytes_give_an_error_or_a_mesh_whose_indices_are_in_range() {
        let written = bytes(&mesh());
        let mut errors = 0;
        for at in 0..written.len() {
            for value in [0x00, 0x01, 0x7f, 0x80, 0xff] {
                let mut changed = written.clone();
                changed[at] = value;
                let Ok(read) = CoarseMesh::read_bytes(&mut ByteReader::new(&changed)) else {
                    errors += 1;
                    continue;
                };
                let mut corners = read.patches.iter().flat_map(|p| p.corners);
                assert!(corners.all(|c| (c as usize) < read.vertices.len()));
                let mut points = read.vertices.iter().map(|v| v.tracing as usize);
                assert!(points.all(|point| point < read.tracing.len()));
            }
        }
        assert!(errors > 100, "{errors}");
    }

    #[test]
    fn coordinates_that_are_not_finite_are_an_error() {
        let mut broken = mesh();
        broken.vertices[3].position.y = f32::NAN;
        let written = bytes(&broken);
        let read = CoarseMesh::read_bytes(&mut ByteReader::new(&written));
        assert!(matches!(read, Err(BytesError::Invalid(_))));
    }
}
