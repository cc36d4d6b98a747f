//! MSH, Gmsh's format, version 4.1 and, in `msh2.rs`, 2.2, text and binary:
//! <https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format>.
//!
//! Triangles and quads of first order are read. Points and lines are skipped, and so are volumes: of a
//! mesh of tetrahedra its surface is read, without the nodes inside. In files of our own the vertices
//! get type and section back from the faces around them (see `regions.rs`).

use std::collections::HashMap;

use glam::DVec3;

use super::builder::Builder;
use super::numbers::{Encoding, Numbers};
use super::regions::{Region, Regions};
use super::{FilePosition, ReadError, malformed, shown};
use crate::{SurfaceMesh, type_of_region};

pub(super) fn read(bytes: &[u8]) -> Result<SurfaceMesh, ReadError> {
    let mut file = File {
        input: Numbers::of(bytes),
        legacy: false,
        ours: false,
        codes: HashMap::new(),
        indices: HashMap::new(),
        positions: Vec::new(),
        faces: Vec::new(),
        solid: false,
    };
    file.read()?;
    file.finish()
}

pub(super) struct File<'a> {
    pub(super) input: Numbers<'a>,
    /// Of version 2.
    legacy: bool,
    /// Written by neurotess: entities are sections, physical groups are types.
    pub(super) ours: bool,
    /// Physical groups of surfaces, by the tag of the surface.
    codes: HashMap<i32, i32>,
    /// Indices of nodes by their tags.
    indices: HashMap<u64, u32>,
    positions: Vec<(FilePosition, DVec3)>,
    pub(super) faces: Vec<Face>,
    /// There are volumes.
    pub(super) solid: bool,
}

pub(super) struct Face {
    pub(super) at: FilePosition,
    /// Tags of nodes; three of a triangle.
    pub(super) corners: [u64; 4],
    pub(super) count: usize,
    pub(super) region: Option<Region>,
}

impl File<'_> {
    fn read(&mut self) -> Result<(), ReadError> {
        while let Some(section) = self.input.next_section() {
            match section {
                b"$MeshFormat" => self.format()?,
                b"$Comments" => self.ours = self.input.rest_of_section().contains("neurotess"),
                b"$Entities" => self.entities()?,
                b"$Nodes" if self.legacy => self.nodes_2()?,
                b"$Elements" if self.legacy => self.elements_2()?,
                b"$Nodes" => self.nodes()?,
                b"$Elements" => self.elements()?,
                _ => {}
            }
            self.input.leave(section)?;
        }
        Ok(())
    }

    fn format(&mut self) -> Result<(), ReadError> {
        let at = self.input.place();
        let version = self.input.word()?;
        self.legacy = matches!(version, b"2" | b"2.0" | b"2.1" | b"2.2");
        if version != b"4.1" && !self.legacy {
            let what = format!("MSH version {}", shown(version));
            return Err(ReadError::Unsupported {
                at,
                what,
                remedy: "write version 4.1 or 2.2 (in Gmsh, -format msh41 or msh22)",
            });
        }
        let binary = self.input.word()?;
        let at = self.input.place();
        let width = self.input.word()?;
        if width != b"8" {
            return Err(malformed(at, shown(width), "8, the bytes of a number"));
        }
        if binary == b"0" {
            return Ok(());
        }
        self.input.end_of_line();
        let at = self.input.place();
        self.input.encoding = match self.input.take(4, "the binary header")? {
            [1, 0, 0, 0] => Encoding::Little,
            [0, 0, 0, 1] => Encoding::Big,
            other => return Err(malformed(at, shown(other), "the number 1 in 4 bytes")),
        };
        Ok(())
    }

    fn entities(&mut self) -> Result<(), ReadError> {
        let input = &mut self.input;
        let counts = [input.size()?, input.size()?, input.size()?, input.size()?];
        for (dimension, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                let tag = input.int()?;
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    input.real()?;
                }
                for group in 0..input.size()? {
                    let code = input.int()?;
                    if dimension == 2 && group == 0 {
                        self.codes.insert(tag, code);
                    }
                }
                if dimension > 0 {
                    for _ in 0..input.size()? {
                        input.int()?;
                    }
                }
            }
        }
        Ok(())
    }

    fn nodes(&mut self) -> Result<(), ReadError> {
        let blocks = self.input.size()?;
        for _ in 0..3 {
            self.input.size()?;
        }
        let mut tags = Vec::new();
        for _ in 0..blocks {
            let dimension = self.input.int()?;
            self.input.int()?;
            let parameters = match self.input.int()? {
                0 => 0,
                _ => dimension.clamp(0, 3),
            };
            tags.clear();
            for _ in 0..self.input.size()? {
                tags.push(self.input.size()?);
            }
            for &tag in &tags {
                let at = self.input.place();
                let position =
                    DVec3::new(self.input.real()?, self.input.real()?, self.input.real()?);
                for _ in 0..parameters {
                    self.input.real()?;
                }
                self.node(at, tag, position)?;
            }
        }
        Ok(())
    }

    pub(super) fn node(
        &mut self,
        at: FilePosition,
        tag: u64,
        position: DVec3,
    ) -> Result<(), ReadError> {
        let index = self.positions.len() as u32;
        if self.indices.insert(tag, index).is_some() {
            let found = format!("node {tag} a second time");
            return Err(malformed(at, found, "another tag for each node"));
        }
        self.positions.push((at, position));
        Ok(())
    }

    fn elements(&mut self) -> Result<(), ReadError> {
        let blocks = self.input.size()?;
        for _ in 0..3 {
            self.input.size()?;
        }
        for _ in 0..blocks {
            let at = self.input.place();
            let dimension = self.input.int()?;
            let tag = self.input.int()?;
            let kind = self.input.int()?;
            let nodes = nodes_of(kind, at)?;
            self.solid |= dimension == 3;
            let region = self.codes.get(&tag).filter(|_| self.ours);
            let region = region.map(|&code| region_of(tag, code));
            for _ in 0..self.input.size()? {
                let at = self.input.place();
                self.input.size()?;
                let mut corners = [0; 4];
                for n in 0..nodes {
                    let node = self.input.size()?;
                    if let Some(corner) = corners.get_mut(n) {
                        *corner = node;
                    }
                }
                if dimension == 2 {
                    if nodes > 4 {
                        return Err(curved(at));
                    }
                    self.faces.push(Face {
                        at,
                        corners,
                        count: nodes,
                        region,
                    });
                }
            }
        }
        Ok(())
    }

    fn finish(self) -> Result<SurfaceMesh, ReadError> {
        let mut faces = Vec::with_capacity(self.faces.len());
        for face in &self.faces {
            let mut corners = [0; 4];
            for (corner, tag) in corners.iter_mut().zip(&face.corners[..face.count]) {
                let missing = || malformed(face.at, format!("node {tag}"), "a node of the file");
                *corner = *self.indices.get(tag).ok_or_else(missing)?;
            }
            faces.push(corners);
        }
        let corners = || faces.iter().zip(&self.faces);
        let mut used = vec![!self.solid; self.positions.len()];
        let mut regions = Regions::of(self.positions.len());
        for (corners, face) in corners() {
            for &corner in &corners[..face.count] {
                used[corner as usize] = true;
                regions.add(corner, face.region);
            }
        }
        let mut builder = Builder::new(self.input.bytes.len());
        let mut index = vec![0; self.positions.len()];
        for (n, &(at, position)) in self.positions.iter().enumerate() {
            index[n] = builder.vertex_count() as u32;
            if used[n] {
                let vertex = regions.vertex(n);
                builder.vertex(at, position, vertex)?;
            }
        }
        for (corners, face) in corners() {
            let corners = corners.map(|corner| index[corner as usize]);
            builder.face(face.at, &corners[..face.count])?;
        }
        builder.finish()
    }
}

/// What a surface and its physical group say in files of our own.
pub(super) fn region_of(surface: i32, code: i32) -> Region {
    Region {
        section: Some(surface.saturating_sub(1)),
        kind: type_of_region(code),
    }
}

pub(super) fn curved(at: FilePosition) -> ReadError {
    ReadError::Unsupported {
        at,
        what: "a face with nodes between its corners".into(),
        remedy: "save the mesh with elements of first order (in Gmsh, -order 1)",
    }
}

/// The number of nodes of a type of elements.
pub(super) fn nodes_of(kind: i32, at: FilePosition) -> Result<usize, ReadError> {
    Ok(match kind {
        1 => 2,
        2 => 3,
        3 | 4 => 4,
        5 => 8,
        6 => 6,
        7 => 5,
        8 => 3,
        9 => 6,
        10 => 9,
        11 => 10,
        12 => 27,
        13 => 18,
        14 => 14,
        15 => 1,
        16 => 8,
        17 => 20,
        18 => 15,
        19 => 13,
        _ => {
            return Err(ReadError::Unsupported {
                at,
                what: format!("element type {kind}"),
                remedy: "save the mesh with elements of first order (in Gmsh, -order 1)",
            });
        }
    })
}
