//! Surfaces: how cells are meshed, and the arrays of meshes.

mod columns;
mod slices;

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use neurotess::mesh::{
    self, Format, OwnAttribute, SurfaceMesh, Unit, VertexAttribute, Watched, measure_surface,
};
use neurotess::morphology::Morphology;
use neurotess::recipe::{
    CellMesh, FileOptions, FileSurface, MeshError, MeshOptions, MeshReport, SaveError, Spelling,
    Watch, mesh_watched,
};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::cell::{Cell, existing};
use crate::options::mesh_options;
use crate::work::{Stop, detached, released, stoppable};
use crate::{arrays, errors, json};
pub(crate) use columns::{Columns, Untaken};
use slices::Slices;

/// How cells are meshed.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Recipe(pub(crate) MeshOptions);

#[pymethods]
impl Recipe {
    #[new]
    fn new(keywords: &Bound<'_, PyDict>) -> PyResult<Self> {
        mesh_options(keywords).map(Self)
    }

    /// The options as JSON, the same however they were written.
    #[getter]
    fn json(&self) -> PyResult<String> {
        serde_json::to_string(&self.0).map_err(errors::bug)
    }

    /// Meshes a cell: its surface, and what is known of it. `stop`: by which others can stop it.
    fn mesh<'py>(
        &self,
        py: Python<'py>,
        cell: &Cell,
        threads: Option<usize>,
        stop: Option<&Stop>,
    ) -> PyResult<(Surface, Bound<'py, PyAny>)> {
        let (options, morphology) = (self.0.clone(), cell.morphology.clone());
        let made = stoppable(py, threads, &Stop::of(stop), move |stopped| {
            let cell = meshed(morphology, &options, stopped)?;
            taken(&cell, |surface| Columns::of(surface, stopped))
        })?;
        of_made(py, made)
    }
}

/// The mesh of a cell, unless another thread sets `stopped`.
pub(crate) fn meshed(
    morphology: Arc<Morphology>,
    options: &MeshOptions,
    stopped: &AtomicBool,
) -> Result<CellMesh, Unmade> {
    let cell = mesh_watched(morphology, options, &Watch::stopped_by(stopped));
    cell.map_err(|e| {
        let told = e.told(Spelling::Keyword);
        match e {
            MeshError::Memory(_) => Unmade::Memory(told),
            _ => Unmade::Mesh(told),
        }
    })
}

/// Why there is no mesh.
pub(crate) enum Unmade {
    /// The cell, or the options.
    Mesh(String),
    /// There is too little memory.
    Memory(String),
}

impl From<String> for Unmade {
    fn from(told: String) -> Self {
        Self::Mesh(told)
    }
}

/// What is taken of a mesh's surface, and what is known of it; an error if it is no surface around its tracing, which is
/// a fault of ours.
pub(crate) fn taken<T>(
    cell: &CellMesh,
    take: impl FnOnce(&dyn mesh::Surface) -> T,
) -> Result<(T, MeshReport), Unmade> {
    let surface = cell.surface();
    let report = cell.report_of(&surface);
    let watched = Watched::new(surface.surface());
    let taken = take(&watched);
    watched.check().map_err(|e| e.to_string())?;
    Ok((taken, report))
}

/// A surface that was made, or why not.
pub(crate) fn of_made(
    py: Python<'_>,
    made: Result<(Result<Columns, Untaken>, MeshReport), Unmade>,
) -> PyResult<(Surface, Bound<'_, PyAny>)> {
    let made = made.and_then(|(columns, report)| match columns {
        Ok(columns) => Ok((columns, report)),
        Err(e @ Untaken::Memory(_)) => Err(Unmade::Memory(e.to_string())),
        Err(e) => Err(Unmade::Mesh(e.to_string())),
    });
    let (columns, report) = made.map_err(|e| match e {
        Unmade::Mesh(told) => errors::mesh(py, &told),
        Unmade::Memory(told) => PyMemoryError::new_err(told),
    })?;
    Ok((Surface::new(py, columns)?, json::serialized(py, &report)?))
}

/// The arrays of a mesh.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Surface {
    #[pyo3(get)]
    vertices: Py<PyArray2<f64>>,
    #[pyo3(get)]
    normals: Py<PyArray2<f32>>,
    #[pyo3(get)]
    types: Py<PyArray1<i32>>,
    #[pyo3(get)]
    points: Py<PyArray1<i32>>,
    #[pyo3(get)]
    sections: Py<PyArray1<i32>>,
    #[pyo3(get)]
    radii: Py<PyArray1<f32>>,
    #[pyo3(get)]
    faces: Py<PyArray2<u32>>,
    #[pyo3(get)]
    quads: Py<PyArray2<u32>>,
    #[pyo3(get)]
    origin: [f64; 3],
}

impl Surface {
    /// Moves columns into arrays.
    pub(crate) fn new(py: Python<'_>, columns: Columns) -> PyResult<Self> {
        Ok(Self {
            vertices: arrays::rows(py, columns.vertices)?,
            normals: arrays::rows(py, columns.normals)?,
            types: arrays::column(py, columns.types)?,
            points: arrays::column(py, columns.points)?,
            sections: arrays::column(py, columns.sections)?,
            radii: arrays::column(py, columns.radii)?,
            faces: arrays::rows(py, columns.faces.triangles)?,
            quads: arrays::rows(py, columns.faces.quads)?,
            origin: columns.origin.to_array(),
        })
    }

    /// Number of vertices.
    fn count(&self, py: Python<'_>) -> usize {
        self.types.bind(py).len().unwrap_or(0)
    }

    /// Does something with the arrays, without the interpreter's lock.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Slices<'_>) -> T + Send,
    ) -> PyResult<T> {
        self.with_own(py, Vec::new(), work)
    }

    /// The same with numbers of one's own.
    fn with_own<T: Send>(
        &self,
        py: Python<'_>,
        own: Vec<VertexAttribute<'_>>,
        work: impl FnOnce(&Slices<'_>) -> T + Send,
    ) -> PyResult<T> {
        let vertices = self.vertices.bind(py).readonly();
        let normals = self.normals.bind(py).readonly();
        let types = self.types.bind(py).readonly();
        let points = self.points.bind(py).readonly();
        let sections = self.sections.bind(py).readonly();
        let radii = self.radii.bind(py).readonly();
        let faces = self.faces.bind(py).readonly();
        let quads = self.quads.bind(py).readonly();
        let slices = Slices {
            origin: self.origin.into(),
            vertices: vertices.as_slice()?.as_chunks().0,
            normals: normals.as_slice()?.as_chunks().0,
            types: types.as_slice()?,
            points: points.as_slice()?,
            sections: sections.as_slice()?,
            radii: radii.as_slice()?,
            triangles: faces.as_slice()?.as_chunks().0,
            quads: quads.as_slice()?.as_chunks().0,
            own,
        };
        detached(py, || work(&slices))
    }
}

#[pymethods]
impl Surface {
    /// A mesh of arrays of one's own.
    #[staticmethod]
    fn from_arrays(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        faces: PyReadonlyArray2<'_, u32>,
    ) -> PyResult<Self> {
        let vertices = vertices.as_slice()?.as_chunks().0;
        let faces = faces.as_slice()?.as_chunks().0;
        let count = vertices.len();
        let outside = |face: &&[u32; 3]| face.iter().any(|&corner| corner as usize >= count);
        if let Some(face) = faces.iter().find(outside) {
            return Err(PyValueError::new_err(format!(
                "face {face:?} has a corner that is none of the {count} vertices"
            )));
        }
        Self::new(py, Columns::of_arrays(vertices, faces))
    }

    /// A mesh file, and numbers of one's own that it has: name, components, and all numbers in a row, of 32 bits where these
    /// hold them.
    #[staticmethod]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        format: Option<String>,
    ) -> PyResult<(Self, Vec<OwnArray>)> {
        let format = format.map(|name| format_named(&name)).transpose()?;
        let file = path.display().to_string();
        let read = stoppable(py, None, &Stop::default(), move |stopped| {
            let read = mesh::read_with_attributes(&path, format);
            read.map(|(surface, own)| (Columns::of(&surface, stopped), own))
        })?;
        match read {
            Ok((columns, own)) => {
                let columns = columns.map_err(|e| match e {
                    Untaken::Memory(_) => PyMemoryError::new_err(e.to_string()),
                    Untaken::Stopped => errors::bug(e),
                })?;
                let surface = Self::new(py, columns)?;
                let own: PyResult<_> = own.into_iter().map(|a| own_array(py, a)).collect();
                Ok((surface, own?))
            }
            Err(mesh::ReadError::Io(e)) => Err(errors::read_io(py, &file, &e)),
            Err(e) => {
                let line = match e.place() {
                    mesh::FilePosition::Line(line) => Some(line as u64),
                    mesh::FilePosition::Byte(_) | mesh::FilePosition::File => None,
                };
                Err(errors::read_of(py, &file, line, &e.to_string()))
            }
        }
    }

    /// The whole judgment.
    fn check<'py>(&self, py: Python<'py>, merge: bool) -> PyResult<Bound<'py, PyAny>> {
        let mut surface = self.with(py, |slices| SurfaceMesh::collect(slices))?;
        let report = released(py, None, move || {
            if merge {
                mesh::merge_identical(&mut surface);
            }
            mesh::check(&surface)
        })?;
        json::serialized(py, &report)
    }

    /// Whether it is closed, its Euler characteristic and the number of its parts.
    fn topology(&self, py: Python<'_>) -> PyResult<(bool, i64, usize)> {
        let surface = self.with(py, |slices| SurfaceMesh::collect(slices))?;
        let topology = released(py, None, move || surface.topology())?;
        Ok((topology.closed, topology.euler, topology.components))
    }

    /// Volume (µm³) and area (µm²).
    fn measure(&self, py: Python<'_>) -> PyResult<(f64, f64)> {
        let measure = self.with(py, |slices| measure_surface(slices))?;
        Ok((measure.volume, measure.area))
    }

    /// Writes a file, whole or not at all, and one of materials beside an OBJ that has them. `own`: by name the components
    /// and numbers of one's own.
    #[expect(clippy::too_many_arguments, reason = "the options of a file")]
    fn write(
        &self,
        py: Python<'_>,
        path: PathBuf,
        format: Option<String>,
        unit: &str,
        overwrite: bool,
        materials: bool,
        color_by: Option<&str>,
        compress: Option<&str>,
        own: Vec<(String, usize, PyReadonlyArray1<'_, f32>)>,
    ) -> PyResult<()> {
        let format = match format {
            Some(name) => format_named(&name)?,
            None => format_named(&path.extension().unwrap_or_default().to_string_lossy())?,
        };
        let unit = match unit {
            "um" => Unit::Micrometer,
            "m" => Unit::Meter,
            other => {
                return Err(PyValueError::new_err(format!(
                    "unit='{other}' is not 'um' or 'm'"
                )));
            }
        };
        let mut options = FileOptions::new(format);
        (options.unit, options.materials) = (unit, materials);
        options.color_by = named("color_by", color_by)?;
        options.compress = named("compress", compress)?;
        // Quads are halved where a format has none.
        options
            .check(&MeshOptions::default())
            .map_err(|e| PyValueError::new_err(e.told(Spelling::Keyword)))?;
        let mut attributes = Vec::with_capacity(own.len());
        for (name, components, values) in &own {
            let values = values.as_slice()?;
            if !(1..=4).contains(components) || values.len() != components * self.count(py) {
                return Err(PyValueError::new_err(
                    "these numbers are not of the vertices",
                ));
            }
            attributes.push(VertexAttribute {
                name,
                components: *components,
                values,
            });
        }
        self.with_own(py, attributes, |slices| {
            let watch = Watch::default();
            let surface = FileSurface::new(slices, &options, &watch);
            let saved = surface.and_then(|s| s.save(&path, existing(overwrite), &watch));
            saved.map(drop).map_err(|e| unsaved(&e))
        })?
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let py = slf.py();
        let restore = py.get_type::<Self>().getattr("restore")?;
        let s = slf.get();
        let state = (
            &s.vertices,
            &s.normals,
            &s.types,
            &s.points,
            &s.sections,
            &s.radii,
            &s.faces,
            &s.quads,
            s.origin,
        );
        Ok((restore, state.into_pyobject(py)?))
    }

    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "the arrays of a mesh")]
    fn restore(
        py: Python<'_>,
        vertices: PyReadonlyArray2<'_, f64>,
        normals: PyReadonlyArray2<'_, f32>,
        types: PyReadonlyArray1<'_, i32>,
        points: PyReadonlyArray1<'_, i32>,
        sections: PyReadonlyArray1<'_, i32>,
        radii: PyReadonlyArray1<'_, f32>,
        faces: PyReadonlyArray2<'_, u32>,
        quads: PyReadonlyArray2<'_, u32>,
        origin: [f64; 3],
    ) -> PyResult<Self> {
        let slices = Slices {
            origin: origin.into(),
            vertices: vertices.as_slice()?.as_chunks().0,
            normals: normals.as_slice()?.as_chunks().0,
            types: types.as_slice()?,
            points: points.as_slice()?,
            sections: sections.as_slice()?,
            radii: radii.as_slice()?,
            triangles: faces.as_slice()?.as_chunks().0,
            quads: quads.as_slice()?.as_chunks().0,
            own: Vec::new(),
        };
        if !slices.agree() {
            return Err(PyValueError::new_err("these arrays are no mesh"));
        }
        Self::new(py, slices.to_columns())
    }
}

#[cfg(feature = "render")]
impl Surface {
    /// The mesh as pictures take it.
    pub(crate) fn collected(&self, py: Python<'_>) -> PyResult<SurfaceMesh> {
        self.with_own(py, Vec::new(), |slices| SurfaceMesh::collect(slices))
    }
}

/// Numbers of one's own as Python has them: name, components, and an array of all in a row.
type OwnArray = (String, usize, Py<PyAny>);

fn own_array(py: Python<'_>, attribute: OwnAttribute) -> PyResult<OwnArray> {
    let OwnAttribute {
        name,
        components,
        values,
        single,
    } = attribute;
    let array = match single {
        true => {
            let values = values.into_iter().map(|value| value as f32).collect();
            arrays::column(py, values)?.into_any()
        }
        false => arrays::column::<f64>(py, values)?.into_any(),
    };
    Ok((name, components, array))
}

fn unsaved(error: &SaveError) -> PyErr {
    match error {
        SaveError::Output(e) => errors::output(e),
        other => PyValueError::new_err(other.to_string()),
    }
}

/// A format by its name or an extension.
/// What a keyword names, if it is given.
fn named<T: FromStr<Err = String>>(keyword: &str, name: Option<&str>) -> PyResult<Option<T>> {
    let wrong =
        |name: &str, told: String| PyValueError::new_err(format!("{keyword}='{name}': {told}"));
    let of = |name: &str| name.parse().map_err(|told| wrong(name, told));
    name.map(of).transpose()
}

fn format_named(name: &str) -> PyResult<Format> {
    let plain = name.trim_start_matches('.');
    plain
        .parse()
        .map_err(|e: mesh::UnknownFormat| PyValueError::new_err(e.to_string()))
}
