//! How large a file will be, before it is written.

use std::path::Path;

use neurotess::mesh::{Format, Surface};
use neurotess::output::temporary_folder;
use neurotess::recipe::memory;

use crate::io::output::is_standard;
use crate::report::{Failure, Reporter};

/// Size (bytes) from which on it is reported beforehand.
const LARGE: u64 = 1 << 30;

/// Bytes of a vertex whose place is kept.
const BYTES_OF_CORNER: u64 = 12;

/// Reports that a file will be large.
///
/// # Errors
/// The disk has too little room for it.
pub(super) fn tell(
    surface: &dyn Surface,
    format: Format,
    out: &Path,
    reporter: &Reporter,
) -> Result<(), Failure> {
    if format == Format::Stl {
        // Its faces hold corners, so that all of these are in memory.
        let needed = (surface.vertex_count() as u64).saturating_mul(BYTES_OF_CORNER);
        memory::check(needed)
            .map_err(|e| Failure(format!("{e}: choose a lower --level, or write ply")))?;
    }
    let bytes = estimate(surface, format);
    if bytes < LARGE {
        return Ok(());
    }
    // What standard output gets at the end is in a temporary file until then.
    let temporary = temporary_folder();
    let (folder, remedy) = match is_standard(out) {
        true => (&*temporary, "set TMPDIR to a folder with more room"),
        false => (folder_of(out), "another disk"),
    };
    let out = out.display();
    let faces = surface.triangle_count() + surface.quad_count();
    if let Ok(free) = fs4::available_space(folder)
        && free < bytes
    {
        return Err(Failure(format!(
            "{out} would have about {}, but only {} are free in {}: choose a lower --level, or {remedy}",
            gigabytes(bytes),
            gigabytes(free),
            folder.display()
        )));
    }
    reporter.warning(&format!(
        "{out} will have about {} ({faces} faces): a lower --level or --max-error makes it smaller",
        gigabytes(bytes)
    ));
    Ok(())
}

/// Estimates the bytes of a file, within some tenths, since numbers in text have different lengths.
pub(super) fn estimate(surface: &dyn Surface, format: Format) -> u64 {
    let [vertices, triangles, quads] = [
        surface.vertex_count(),
        surface.triangle_count(),
        surface.quad_count(),
    ]
    .map(|n| n as u64);
    let [vertex, triangle, quad] = match format {
        Format::Ply => [40, 13, 17],
        Format::Stl => [0, 50, 100],
        Format::Glb => [40, 12, 24],
        Format::Vtu => [40, 21, 25],
        Format::Msh => [32, 32, 64],
        // Measured on a cell with a million faces.
        Format::Obj => [64, 48, 64],
        Format::Off => [30, 26, 34],
        Format::Msh2 => [36, 34, 68],
        Format::Poly => [36, 30, 60],
        Format::Smesh => [36, 26, 52],
    };
    vertices * vertex + triangles * triangle + quads * quad
}

fn folder_of(out: &Path) -> &Path {
    let folder = out.parent().unwrap_or(Path::new("."));
    // The folder has been made when the file was claimed.
    match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    }
}

fn gigabytes(bytes: u64) -> String {
    format!("{:.1} GB", bytes as f64 / 1e9)
}

#[cfg(test)]
mod tests {
    use neurotess::generate::{GenerateOptions, generate};
    use neurotess::mesh::write;
    use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
    use neurotess::synth::{Kind, Options, grow};

    use super::*;

    #[test]
    fn estimates_are_near_what_is_written() {
        let cell = grow(&Options {
            points: Some(100),
            ..Options::new(Kind::Star, 1)
        });
        let mesh = generate(&cell, &GenerateOptions::default())
            .expect("meshed")
            .mesh;
        for format in Format::ALL {
            let options = RefineOptions {
                quads: format.has_quads(),
                ..RefineOptions::default()
            };
            let surface = Refinement::new(&mesh, LodCriterion::Homogeneous(8), &options);
            let mut file = std::io::Cursor::new(Vec::new());
            write(&surface, format, &mut file).expect("written");
            let ratio = estimate(&surface, format) as f64 / file.into_inner().len() as f64;
            assert!((0.7..1.4).contains(&ratio), "{format}: {ratio}");
        }
    }
}
