//! The mesh of a soma that [morph-spines](https://github.com/openbraininstitute/morph-spines) 1.1 has beside a cell:
//! `/soma/meshes/NAME/vertices` (µm) and `triangles`, where NAME is the cell's.

use std::path::Path;

use glam::DVec3;

use crate::hdf5::Store;
use crate::text::stem;
use crate::{Fault, Format, ReadError, SomaMesh, member, regular};

const MESHES: &str = "soma/meshes";

/// Whether the file has a mesh of a cell's soma.
pub(super) fn is_there(store: &Store, name: &str) -> bool {
    store.has(&format!("{MESHES}/{name}/vertices"))
}

/// The mesh of the soma that a file has beside a cell, which may be one of many: `FILE#NAME`.
///
/// # Errors
/// There is none, or it is broken: [`ReadError`] with file and dataset.
pub fn soma_mesh(path: impl AsRef<Path>) -> Result<SomaMesh, ReadError> {
    let path = path.as_ref();
    let (file, inner) = member(path);
    let shown = path.display().to_string();
    let of_file = |fault| ReadError::of_file(&shown, fault);
    regular(file).map_err(|e| of_file(Fault::Io(e)))?;
    let store = Store::open(file).map_err(of_file)?;
    let last = inner.and_then(|inner| inner.rsplit('/').next());
    let name = match last.unwrap_or_default() {
        "" => stem(&file.display().to_string(), Format::H5.extensions()).to_owned(),
        last => last.to_owned(),
    };
    read(&store, &name).map_err(of_file)
}

fn read(store: &Store, name: &str) -> Result<SomaMesh, Fault> {
    let there = store.groups(MESHES);
    let name = match &there[..] {
        [only] if only != name => only,
        _ => name,
    };
    let [vertices_path, triangles_path] =
        ["vertices", "triangles"].map(|part| format!("{MESHES}/{name}/{part}"));
    let vertices = store.reals(&vertices_path, 3)?;
    let triangles = store.wholes(&triangles_path, 3)?;
    let place = |row: usize| {
        let row = vertices.row(row);
        DVec3::new(row[0], row[1], row[2])
    };
    let corner = |row: usize| {
        let row = triangles.row(row);
        let index = |corner: i64| {
            u32::try_from(corner)
                .ok()
                .filter(|&c| (c as usize) < vertices.rows)
        };
        let corners = [index(row[0]), index(row[1]), index(row[2])];
        match corners {
            [Some(a), Some(b), Some(c)] => Ok([a, b, c]),
            _ => Err(()),
        }
    };
    let corners = (0..triangles.rows).map(|row| {
        corner(row).map_err(|()| Fault::Row {
            dataset: triangles_path.clone(),
            row: row as u64,
            fault: Box::new(Fault::Reference { column: "a corner" }),
        })
    });
    let corners = corners.collect::<Result<_, _>>()?;
    Ok(((0..vertices.rows).map(place).collect(), corners))
}
