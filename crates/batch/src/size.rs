//! How large a file will be, before it is written.

use std::path::{Path, PathBuf};

use neurotess_mesh::{Format, Surface};
use neurotess_output::temporary_folder;
use neurotess_recipe::memory::{self, TooLittleMemory};
use neurotess_recipe::{FileOptions, MeshOption, Spelling};

use crate::standard::is_standard;

/// Size (bytes) from which on it is told beforehand.
const LARGE: u64 = 1 << 30;

/// Bytes of a vertex whose place is kept.
const BYTES_OF_CORNER: u64 = 12;

/// Bytes of a vertex and its triangles while they are compressed: measured 380, of 352,000 vertices.
const BYTES_OF_COMPRESSED: u64 = 400;

/// How many times as small a file is at least that is compressed: measured 18.
const COMPRESSED: u64 = 12;

/// A file that will be large.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct LargeFile {
    /// The file.
    pub out: PathBuf,
    /// What it will have, about.
    pub bytes: u64,
    /// Number of its faces.
    pub faces: usize,
}

/// Why there is no room for a file.
pub(crate) enum Crowded {
    /// In memory.
    Memory(TooLittleMemory),
    /// On the disk: bytes that are free, and where.
    Disk {
        bytes: u64,
        free: u64,
        folder: PathBuf,
    },
}

impl LargeFile {
    /// What it is, and what to do, with options named as whoever set them wrote them.
    pub fn told(&self, spelling: Spelling) -> String {
        format!(
            "{} will have about {} ({} faces): a lower {} or {} makes it smaller",
            self.out.display(),
            gigabytes(self.bytes),
            self.faces,
            MeshOption::Level.spelled(spelling),
            MeshOption::MaxError.spelled(spelling)
        )
    }
}

/// Whether there is room for a file, and what is to be said of it.
pub(crate) fn check(
    surface: &dyn Surface,
    files: &FileOptions,
    out: &Path,
) -> Result<Option<LargeFile>, Crowded> {
    let in_memory = match (files.format, files.compress) {
        // Its faces hold corners, so that all of these are in memory.
        (Format::Stl, _) => BYTES_OF_CORNER,
        (_, Some(_)) => BYTES_OF_COMPRESSED,
        _ => 0,
    };
    let needed = (surface.vertex_count() as u64).saturating_mul(in_memory);
    memory::check(needed).map_err(Crowded::Memory)?;
    let mut bytes = estimate(surface, files.format);
    if files.compress.is_some() {
        bytes /= COMPRESSED;
    }
    if bytes < LARGE {
        return Ok(None);
    }
    // What standard output gets at the end is in a temporary file until then.
    let temporary = temporary_folder();
    let folder = match is_standard(out) {
        true => &*temporary,
        false => folder_of(out),
    };
    match fs4::available_space(folder) {
        Ok(free) if free < bytes => Err(Crowded::Disk {
            bytes,
            free,
            folder: folder.to_path_buf(),
        }),
        _ => Ok(Some(LargeFile {
            out: out.to_path_buf(),
            bytes,
            faces: surface.triangle_count() + surface.quad_count(),
        })),
    }
}

/// Estimates the bytes of a file, within some tenths, since numbers in text have different lengths.
fn estimate(surface: &dyn Surface, format: Format) -> u64 {
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

/// Bytes as text.
pub(crate) fn gigabytes(bytes: u64) -> String {
    format!("{:.1} GB", bytes as f64 / 1e9)
}

#[cfg(test)]
mod tests {
    use neurotess_generate::{GenerateOptions, generate};
    use neurotess_mesh::write;
    use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
    use neurotess_synth::{Kind, Options, grow};

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
