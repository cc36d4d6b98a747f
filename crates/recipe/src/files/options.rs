//! Options of a surface's files.

use std::path::{Path, PathBuf};

use neurotess_mesh::{ColorBy, Compression, Format, Unit, WriteOptions};

use crate::{Levels, MeshOptions, OptionsError};

/// How a surface goes into files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FileOptions {
    /// The format.
    pub format: Format,
    /// The unit of coordinates and radii.
    pub unit: Unit,
    /// Whether walls part the soma from neurites.
    pub walls: bool,
    /// Whether faces have the material of their type: in a GLB, and of an OBJ in a file beside it.
    pub materials: bool,
    /// What the colors of vertices tell: in a PLY, VTU or GLB.
    pub color_by: Option<ColorBy>,
    /// How a GLB is compressed. It is whole in memory while it is made, and has its triangles in another order.
    pub compress: Option<Compression>,
    /// Whether each type gets a file of its own, named after the whole.
    pub parts: bool,
}

impl FileOptions {
    /// One file of this format, in µm, without walls, materials, colors and compression.
    pub fn new(format: Format) -> Self {
        Self {
            format,
            unit: Unit::Micrometer,
            walls: false,
            materials: false,
            color_by: None,
            compress: None,
            parts: false,
        }
    }

    /// Where the file of materials of a mesh is, if it has one.
    pub fn materials_of(&self, out: &Path) -> Option<PathBuf> {
        let has_one = self.format == Format::Obj && self.materials;
        has_one.then(|| out.with_extension("mtl"))
    }

    /// How a surface is written so. `material_file`: the name of the file that an OBJ refers to.
    pub fn writing(&self, material_file: Option<String>) -> WriteOptions {
        WriteOptions {
            material_file,
            glb_materials: self.materials && self.format == Format::Glb,
            color_by: self.color_by,
            compression: self.compress,
        }
    }

    /// Whether files of such meshes can be as they are asked for.
    ///
    /// # Errors
    /// What the format does not hold.
    pub fn check(&self, options: &MeshOptions) -> Result<(), OptionsError> {
        let format = self.format;
        if options.refine.quads && !format.has_quads() {
            return Err(OptionsError::NoQuads(format));
        }
        if self.walls && !format.has_regions() && !self.parts {
            return Err(OptionsError::NoRegions(format));
        }
        let has_coarse_quads =
            options.levels == Levels::Coarse && format.has_quads() && !options.merges();
        if self.walls && (options.refine.quads || has_coarse_quads) {
            return Err(OptionsError::WalledQuads);
        }
        if self.materials && !matches!(format, Format::Obj | Format::Glb) {
            return Err(OptionsError::NoMaterials(format));
        }
        if self.color_by.is_some() && !format.has_colors() {
            return Err(OptionsError::NoColors(format));
        }
        if self.compress.is_some() && format != Format::Glb {
            return Err(OptionsError::NoCompression(format));
        }
        if self.compress.is_some() && self.materials {
            return Err(OptionsError::CompressedMaterials);
        }
        Ok(())
    }
}

/// The file of a part: the name of the type behind that of the whole, as in `cell_axon.ply`.
pub fn part_file(out: &Path, name: &str) -> PathBuf {
    let mut file = out.file_stem().unwrap_or_default().to_owned();
    file.push(format!("_{name}"));
    if let Some(extension) = out.extension() {
        file.push(".");
        file.push(extension);
    }
    out.with_file_name(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Crossings;

    #[test]
    fn a_format_holds_what_is_asked_for() {
        let check = |options: FileOptions, mesh: MeshOptions| options.check(&mesh);
        let of = FileOptions::new;
        let quads = MeshOptions::default().with_quads(true);
        assert_eq!(check(of(Format::Ply), quads.clone()), Ok(()));
        let refused = Err(OptionsError::NoQuads(Format::Stl));
        assert_eq!(check(of(Format::Stl), quads), refused);
        let walls = |format| FileOptions {
            walls: true,
            ..of(format)
        };
        let usual = MeshOptions::default;
        assert_eq!(check(walls(Format::Msh), usual()), Ok(()));
        let refused = Err(OptionsError::NoRegions(Format::Ply));
        assert_eq!(check(walls(Format::Ply), usual()), refused);
        let parts = FileOptions {
            parts: true,
            ..walls(Format::Ply)
        };
        let refused = Err(OptionsError::WalledQuads);
        assert_eq!(check(parts, usual().with_level(0)), refused);
        let merged = usual().with_level(0).with_crossings(Crossings::Merge);
        assert_eq!(check(parts, merged), Ok(()));
        let materials = FileOptions {
            materials: true,
            ..of(Format::Off)
        };
        let refused = Err(OptionsError::NoMaterials(Format::Off));
        assert_eq!(check(materials, usual()), refused);
        let colored = |format| FileOptions {
            color_by: Some(ColorBy::Type),
            ..of(format)
        };
        assert_eq!(check(colored(Format::Vtu), usual()), Ok(()));
        let refused = Err(OptionsError::NoColors(Format::Obj));
        assert_eq!(check(colored(Format::Obj), usual()), refused);
        let compressed = |options| FileOptions {
            compress: Some(Compression::Draco),
            ..options
        };
        assert_eq!(check(compressed(colored(Format::Glb)), usual()), Ok(()));
        let refused = Err(OptionsError::NoCompression(Format::Ply));
        assert_eq!(check(compressed(of(Format::Ply)), usual()), refused);
        let materials = FileOptions {
            format: Format::Glb,
            ..materials
        };
        let refused = Err(OptionsError::CompressedMaterials);
        assert_eq!(check(compressed(materials), usual()), refused);
    }

    #[test]
    fn parts_have_names_after_that_of_the_whole() {
        let part = |out: &str| part_file(Path::new(out), "axon");
        assert_eq!(part("a/cell.ply"), Path::new("a/cell_axon.ply"));
        assert_eq!(part("cell.v2.ply"), Path::new("cell.v2_axon.ply"));
        assert_eq!(part("cell"), Path::new("cell_axon"));
    }
}
