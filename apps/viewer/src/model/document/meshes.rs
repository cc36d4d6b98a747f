//! Meshes beside the cells.

use std::path::{Path, PathBuf};

use neurotess::coloring::mesh_color;
use serde::{Deserialize, Serialize};

/// A mesh that is no cell, such as a brain region or a pipette, and how it looks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshEntry {
    /// Its file.
    #[serde(rename = "path")]
    pub file: PathBuf,
    /// Its color.
    #[serde(default = "usual_color")]
    pub color: [u8; 3],
    /// Share of what lies behind that each of its layers hides, 0 to 1.
    #[serde(default = "one")]
    pub opacity: f32,
    /// Whether only the edges of its faces are drawn.
    #[serde(default)]
    pub edges: bool,
    /// Micrometers of a unit of the file.
    #[serde(default = "one")]
    pub scale: f32,
    /// Whether it is hidden.
    #[serde(default)]
    pub hidden: bool,
}

fn usual_color() -> [u8; 3] {
    mesh_color(0)
}

fn one() -> f32 {
    1.0
}

impl MeshEntry {
    /// The mesh of a file, opaque; `index`: how many there are already, which decides its color.
    pub fn new(file: PathBuf, index: usize) -> Self {
        Self {
            file,
            color: mesh_color(index),
            opacity: one(),
            edges: false,
            scale: one(),
            hidden: false,
        }
    }

    /// Whether one can see through it.
    pub fn is_translucent(&self) -> bool {
        self.edges || self.opacity < 1.0
    }

    /// Its name in lists.
    pub fn name(&self) -> String {
        let stem = self.file.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }

    /// Micrometers of a unit of the file.
    pub(crate) fn um(&self) -> f64 {
        // The number that was typed: 0.001 is no number of 32 bits.
        let shortest = self.scale.to_string().parse().unwrap_or(1.0);
        if shortest > 0.0 { shortest } else { 1.0 }
    }
}

/// Whether a file has the extension of a mesh.
pub fn is_mesh(path: &Path) -> bool {
    neurotess::mesh::Format::from_extension(path).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_alone_is_an_opaque_mesh() {
        let read: MeshEntry = toml::from_str("path = 'region.obj'").expect("a mesh");
        assert_eq!(read, MeshEntry::new("region.obj".into(), 0));
        assert!(!read.is_translucent() && is_mesh(&read.file));
        let glass = MeshEntry {
            opacity: 0.2,
            scale: 0.001,
            ..read
        };
        assert!(glass.is_translucent());
        assert_eq!((glass.um(), glass.name().as_str()), (0.001, "region"));
        let text = toml::to_string(&glass).expect("written");
        assert_eq!(toml::from_str(&text), Ok(glass));
        assert!(toml::from_str::<MeshEntry>("path = 'a.obj'\nopaque = 1").is_err());
    }
}
