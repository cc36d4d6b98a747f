//! The surface of a soma from a file.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use neurotess_formats::Format;
use neurotess_generate::GenerateOptions;
use neurotess_mesh::SurfaceMesh;
use neurotess_morphology::{Morphology, SomaShape};

use crate::{MeshError, MeshOptions};

/// Options of the coarse mesh, with the soma of the file that they name.
pub(crate) fn generate_options(
    options: &MeshOptions,
    morphology: &Morphology,
) -> Result<GenerateOptions, MeshError> {
    let mut generate = options.generate_options();
    if let Some(file) = &options.soma_mesh {
        let shape = shape(file, morphology).map_err(|found| MeshError::SomaMesh {
            file: file.clone(),
            found,
        })?;
        generate.soma_shape = Some(Arc::new(shape));
    }
    Ok(generate)
}

/// The shape of the surface in a file, or what is wrong with it.
fn shape(file: &Path, morphology: &Morphology) -> Result<SomaShape, String> {
    if morphology.somata.is_empty() {
        return Err(
            "the tracing has no soma that it could stand for: add a sample of type 1".into(),
        );
    }
    let (vertices, triangles) = surface(file, morphology.origin)?;
    let shape = SomaShape::from_mesh(&vertices, &triangles).map_err(|e| e.to_string())?;
    let is_near = morphology.somata.iter().any(|soma| {
        let off = soma.center.as_dvec3().distance(shape.center());
        off <= shape.farthest() + f64::from(soma.radius.max(0.0))
    });
    if is_near {
        return Ok(shape);
    }
    let traced = place(morphology.somata[0].center.as_dvec3() + morphology.origin);
    let meshed = place(shape.center() + morphology.origin);
    Err(format!(
        "it goes around {meshed} µm and no soma is there, the first is at {traced} µm: both must be in µm and in the same \
         coordinates"
    ))
}

/// The surface of a file: of a mesh, or of the soma that an H5 file has beside its cell. Vertices are about the origin of
/// the morphology.
fn surface(file: &Path, origin: DVec3) -> Result<(Vec<DVec3>, Vec<[u32; 3]>), String> {
    let (path, _) = neurotess_formats::member(file);
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    if Format::of_extension(&extension) == Some(Format::H5) {
        let (vertices, triangles) =
            neurotess_formats::soma_mesh(file).map_err(|e| e.to_string())?;
        let vertices = vertices.into_iter().map(|vertex| vertex - origin);
        return Ok((vertices.collect(), triangles));
    }
    let surface = neurotess_mesh::read(file).map_err(|e| e.to_string())?;
    Ok(triangles(&surface, origin))
}

/// Vertices about the origin of the morphology, and triangles.
fn triangles(surface: &SurfaceMesh, origin: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let shift = surface.origin - origin;
    let vertices = surface.vertices.iter();
    let vertices = vertices.map(|vertex| vertex.position.as_dvec3() + shift);
    let faces = &surface.faces;
    let of_quads = faces.quads.iter();
    let of_quads = of_quads.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let triangles = faces.triangles.iter().copied().chain(of_quads);
    (vertices.collect(), triangles.collect())
}

fn place(place: DVec3) -> String {
    format!("({:.2}, {:.2}, {:.2})", place.x, place.y, place.z)
}
