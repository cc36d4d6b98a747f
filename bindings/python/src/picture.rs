//! Pictures, and drawings that are drawn again and again.

use std::cell::RefCell;
use std::io::Write;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use neurotess::circuit::{NodeRef, TimeAxis};
use neurotess::coloring::{CellSeries, CellValues, MeshValues, OwnNumbers, OwnSeries, OwnValues};
use neurotess::drawing::{self, Device, DrawError, DrawingInput, OwnData, Picked, Quiet};
use neurotess::mesh::SurfaceMesh;
use neurotess::picture::color::{ColorMap, Rgb};
use neurotess::picture::{Camera, Image, Lens, PngWriter};
use numpy::ndarray::{Array2, Array3};
use numpy::{Element, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::{PyMemoryError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::cell::Cell;
use crate::errors;
use crate::errors::bug;
use crate::options::draw_options;
use crate::surface::Surface;
use crate::work::{Stop, detached, is_forked, stoppable};

/// Adds what draws to the module.
pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Drawing>()?;
    module.add_function(wrap_pyfunction!(color_scale, module)?)?;
    module.add_function(wrap_pyfunction!(png, module)?)
}

/// Devices by the adapter that was asked for. They are kept: opening one takes a tenth of a second.
#[cfg(feature = "gpu")]
static DEVICES: Mutex<Option<std::collections::HashMap<Option<String>, Arc<Device>>>> =
    Mutex::new(None);

/// Whether the process that imported the package has opened a device, or is about to.
static OPENED: AtomicBool = AtomicBool::new(false);

/// An error where a driver's threads and connections have stayed in the process that this one was forked from: whatever
/// waits for them waits for ever.
fn usable() -> Result<(), String> {
    match is_forked() && OPENED.load(Ordering::Relaxed) {
        true => Err(
            "this process was forked from one that has opened a graphics device, which is of no use here: start \
             processes by multiprocessing.get_context(\"spawn\"), draw only in the new ones, or with adapter=\"cpu\""
                .into(),
        ),
        false => Ok(()),
    }
}

/// Opens an adapter, or has it open already.
#[cfg(feature = "gpu")]
fn device(adapter: Option<&str>) -> Result<Arc<Device>, String> {
    usable()?;
    if !is_forked() {
        OPENED.store(true, Ordering::Relaxed);
    }
    let mut devices = DEVICES.lock().unwrap_or_else(PoisonError::into_inner);
    let devices = devices.get_or_insert_with(std::collections::HashMap::new);
    let name = adapter.map(str::to_owned);
    if let Some(gpu) = devices.get(&name) {
        return Ok(Arc::clone(gpu));
    }
    let gpu = Arc::new(Device::open(adapter).map_err(|e| e.to_string())?);
    devices.insert(name, Arc::clone(&gpu));
    Ok(gpu)
}

/// Opens no adapter: this build has none.
#[cfg(not(feature = "gpu"))]
fn device(_adapter: Option<&str>) -> Result<Arc<Device>, String> {
    Err("this build draws by the processor alone: use adapter=\"cpu\", or none".into())
}

/// What is drawn; nothing when it is closed.
type Shared = Arc<Mutex<Option<drawing::Drawing>>>;

/// Cells that are drawn again and again.
#[pyclass(frozen, module = "neurotess._neurotess")]
pub(crate) struct Drawing {
    shared: Shared,
    /// Whether a graphics adapter draws.
    by_adapter: bool,
    /// What there was to say.
    #[pyo3(get)]
    messages: Vec<String>,
    /// How many pictures the options ask for.
    #[pyo3(get)]
    pictures: usize,
    /// Whether nothing is behind the cells.
    #[pyo3(get)]
    transparent: bool,
}

/// Eye, target, direction upwards (µm), vertical angle of view (radians), and whether there is no
/// perspective.
type View = ([f64; 3], [f64; 3], [f64; 3], f64, bool);

/// The title of a scale, the numbers at its ends, and its colors.
type Scale = (String, [f32; 2], Vec<Rgb>);

/// A circuit, and population and row of the nodes that are drawn, if not all are.
type GivenCircuit = (PathBuf, Option<Vec<(u32, u32)>>);

/// By cell the numbers of its points and that of its somata; what they are, and their unit.
pub(crate) type GivenValues<'py> = (Vec<(PyReadonlyArray1<'py, f32>, f32)>, String, String);

fn own_values((cells, title, unit): GivenValues<'_>) -> PyResult<OwnValues> {
    let of_cell = |(points, soma): &(PyReadonlyArray1<'_, f32>, f32)| {
        Ok(CellValues {
            points: points.as_slice()?.to_vec(),
            soma: *soma,
        })
    };
    let cells: PyResult<_> = cells.iter().map(of_cell).collect();
    Ok(OwnValues {
        cells: cells?,
        title,
        unit,
    })
}

/// By mesh beside the cells the numbers of its vertices, if it has any; what they are, and their unit.
type GivenMeshValues<'py> = (Vec<Option<PyReadonlyArray1<'py, f32>>>, String, String);

fn mesh_values((meshes, title, unit): GivenMeshValues<'_>) -> PyResult<MeshValues> {
    let of_mesh = |values: &Option<PyReadonlyArray1<'_, f32>>| {
        let values = values.as_ref().map(|v| v.as_slice().map(<[f32]>::to_vec));
        values.transpose()
    };
    let meshes: Result<_, _> = meshes.iter().map(of_mesh).collect();
    Ok(MeshValues {
        meshes: meshes?,
        title,
        unit,
    })
}

/// By cell the columns of its points and of its somata (−1: none) and the numbers of the columns by frame; start and step
/// of the frames (ms); what they are, and their unit; times of pictures, as ``0:10:0.5``.
pub(crate) type GivenSeries<'py> = (
    Vec<(PyReadonlyArray1<'py, i32>, i32, PyReadonlyArray2<'py, f32>)>,
    [f64; 2],
    String,
    String,
    Option<String>,
);

fn own_series(
    (cells, [start, step], title, unit, time): GivenSeries<'_>,
) -> PyResult<(OwnSeries, Option<String>)> {
    let column = |column: i32| u32::try_from(column).ok();
    let mut frames = 0;
    let of_cell =
        |(points, soma, values): &(PyReadonlyArray1<'_, i32>, i32, PyReadonlyArray2<'_, f32>)| {
            let (rows, columns) = values.as_array().dim();
            frames = rows as u64;
            Ok(CellSeries {
                points: points.as_slice()?.iter().copied().map(column).collect(),
                soma: column(*soma),
                columns,
                values: values.as_slice()?.to_vec(),
            })
        };
    let cells: PyResult<_> = cells.iter().map(of_cell).collect();
    let series = OwnSeries {
        cells: cells?,
        time: TimeAxis {
            start,
            end: start + frames as f64 * step,
            step,
            frames,
        },
        title,
        unit,
    };
    Ok((series, time))
}

/// Numbers of one's own, if there are any; times of pictures.
pub(crate) fn own_numbers(
    values: Option<GivenValues<'_>>,
    series: Option<GivenSeries<'_>>,
) -> PyResult<(Option<OwnNumbers>, Option<String>)> {
    if let Some(series) = series {
        let (series, time) = own_series(series)?;
        return Ok((Some(OwnNumbers::OverTime(series)), time));
    }
    let values = values.map(own_values).transpose()?;
    Ok((values.map(OwnNumbers::Still), None))
}

/// What was picked, as all views tell it.
pub(crate) fn picked_dict(py: Python<'_>, picked: Picked) -> PyResult<Bound<'_, PyDict>> {
    let told = PyDict::new(py);
    told.set_item("cell", picked.cell)?;
    told.set_item("name", picked.name)?;
    told.set_item("node_id", picked.node)?;
    // As in meshes: 0 is the soma.
    let section = picked.section.map_or(0, |section| section.0 + 1);
    told.set_item("section", section)?;
    told.set_item("section_index", i64::from(section) - 1)?;
    told.set_item("sample", picked.sample)?;
    told.set_item("position", picked.position.to_array())?;
    Ok(told)
}

#[pymethods]
impl Drawing {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "what a drawing is made of")]
    fn new(
        py: Python<'_>,
        cells: Vec<PyRef<'_, Cell>>,
        circuit: Option<GivenCircuit>,
        keywords: &Bound<'_, PyDict>,
        values: Option<GivenValues<'_>>,
        series: Option<GivenSeries<'_>>,
        surfaces: Vec<Option<PyRef<'_, Surface>>>,
        meshes: Option<GivenMeshValues<'_>>,
        scale: Option<Vec<Rgb>>,
    ) -> PyResult<Self> {
        let mut options = draw_options(keywords)?;
        options.scale = scale;
        let (numbers, time) = own_numbers(values, series)?;
        if let Some(time) = time {
            let time = options.picture.set("time", &time.into());
            time.map_err(|e| errors::draw_option(py, &e))?;
        }
        let surface = |surface: &Option<PyRef<'_, Surface>>| {
            let surface = surface.as_ref().map(|surface| surface.collected(py));
            surface.transpose()
        };
        let surfaces: PyResult<Vec<Option<SurfaceMesh>>> = surfaces.iter().map(surface).collect();
        let own = OwnData {
            numbers,
            surfaces: surfaces?,
            mesh_values: meshes.map(mesh_values).transpose()?,
        };
        let cells: Vec<_> = cells.iter().map(|c| Arc::clone(&c.morphology)).collect();
        let made = stoppable(py, None, &Stop::default(), move |stopped| {
            let named: Vec<_> = cells.iter().map(|c| (c.name.as_str(), &**c)).collect();
            let nodes = circuit.as_ref().and_then(|(_, nodes)| nodes.as_ref());
            let nodes: Option<Vec<NodeRef>> = nodes.map(|nodes| {
                let of = |&(population, row): &(u32, u32)| NodeRef { population, row };
                nodes.iter().map(of).collect()
            });
            let input = match &circuit {
                Some((path, _)) => DrawingInput::Circuit(path, nodes.as_deref()),
                None => DrawingInput::Cells(&named),
            };
            let host = Quiet::stopped_by(stopped);
            let made = drawing::Drawing::new(input, options, own, &device, &host);
            let messages = host.take_messages();
            match made {
                Ok(drawing) => Ok((drawing, messages)),
                Err(DrawError::Failed(why)) => {
                    let all: Vec<String> = messages.into_iter().chain([why]).collect();
                    Err(DrawError::Failed(all.join("; ")))
                }
                Err(e) => Err(e),
            }
        })?;
        let (drawing, messages) = made.map_err(|e| undrawn(py, &e))?;
        Ok(Self {
            pictures: drawing.pictures(),
            transparent: drawing.options().picture.look.transparent,
            by_adapter: drawing.by_adapter(),
            shared: Arc::new(Mutex::new(Some(drawing))),
            messages,
        })
    }

    /// Draws one of the pictures that the options ask for.
    fn draw(&self, py: Python<'_>, picture: usize) -> PyResult<Py<PyArray3<u8>>> {
        let image = self.with(py, move |drawing, stopped| drawing.draw(picture, stopped))?;
        pixels_of(py, image)
    }

    /// Draws from anywhere, with the colors of one of the pictures.
    fn draw_from(
        &self,
        py: Python<'_>,
        picture: usize,
        view: View,
        size: [u32; 2],
        samples: u32,
    ) -> PyResult<Py<PyArray3<u8>>> {
        let camera = camera(view)?;
        let image = self.with(py, move |drawing, stopped| {
            drawing.draw_from(picture, camera, (size, samples), stopped)
        })?;
        pixels_of(py, image)
    }

    /// How a picture is made, as PNG files tell it.
    fn recipe(&self, picture: usize) -> PyResult<String> {
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let drawing = shared.as_ref().ok_or_else(closed)?;
        Ok(drawing.recipe(picture))
    }

    /// The camera of a picture.
    fn camera(&self, py: Python<'_>, picture: usize) -> PyResult<View> {
        self.usable(py)?;
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let drawing = shared.as_ref().ok_or_else(closed)?;
        let missing = || PyValueError::new_err("no such picture");
        let camera = drawing.camera(picture).ok_or_else(missing)?;
        let [_, up, _] = camera.axes();
        let (eye, target) = (camera.eye().to_array(), camera.target().to_array());
        let orthographic = camera.is_orthographic();
        Ok((eye, target, up.to_array(), camera.fov(), orthographic))
    }

    /// The title of a picture's scale, the numbers at its ends, and its colors; none if colors tell kinds.
    fn scale(&self, picture: usize) -> PyResult<Option<Scale>> {
        let shared = self.shared.lock().unwrap_or_else(PoisonError::into_inner);
        let legend = shared.as_ref().ok_or_else(closed)?.legend(picture);
        let told = legend.scale();
        Ok(told.map(|(title, range, colors)| (title.to_owned(), range, colors.to_vec())))
    }

    /// What is at a pixel, or near it; none if nothing is.
    fn pick<'py>(
        &self,
        py: Python<'py>,
        view: View,
        size: [u32; 2],
        at: [f64; 2],
        reach: f64,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let camera = camera(view)?;
        let picked = self.with(py, move |drawing, stopped| {
            drawing.pick(&camera, size, at, reach, stopped)
        })?;
        picked.map(|picked| picked_dict(py, picked)).transpose()
    }

    /// What is at each pixel of the first picture: cells, sections, samples.
    fn ids<'py>(&self, py: Python<'py>) -> PyResult<Ids<'py>> {
        let ids = self.with(py, |drawing, stopped| drawing.ids(0, stopped))?;
        let shape = ids.size.map(|side| side as usize);
        let shape = (shape[1], shape[0]);
        Ok((
            array_of(py, shape, ids.cell)?,
            array_of(py, shape, ids.section)?,
            array_of(py, shape, ids.sample)?,
        ))
    }

    /// Gives back the memory on the device. Nothing can be drawn afterwards.
    fn close(&self, py: Python<'_>) {
        if self.is_lost() {
            return;
        }
        // A picture that is being drawn is waited for.
        py.detach(|| {
            drop(
                self.shared
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .take(),
            );
        });
    }
}

impl Drop for Drawing {
    /// In a forked process a device is not given back: that would wait for its driver's threads.
    fn drop(&mut self) {
        if self.is_lost() {
            std::mem::forget(Arc::clone(&self.shared));
        }
    }
}

impl Drawing {
    /// Whether its device was opened by the process that this one was forked from.
    fn is_lost(&self) -> bool {
        self.by_adapter && usable().is_err()
    }

    fn usable(&self, py: Python<'_>) -> PyResult<()> {
        match self.by_adapter {
            true => usable().map_err(|e| errors::render(py, &e)),
            false => Ok(()),
        }
    }

    /// Draws without the interpreter's lock; one picture at a time, which Ctrl-C stops.
    fn with<T: Send + 'static>(
        &self,
        py: Python<'_>,
        draw: impl FnOnce(&mut drawing::Drawing, &Arc<AtomicBool>) -> Result<T, DrawError>
        + Send
        + 'static,
    ) -> PyResult<T> {
        self.usable(py)?;
        let shared = Arc::clone(&self.shared);
        let drawn = stoppable(py, None, &Stop::default(), move |stopped| {
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let drawing = shared.as_mut();
            drawing.map(|drawing| draw(drawing, stopped))
        })?;
        drawn.ok_or_else(closed)?.map_err(|e| undrawn(py, &e))
    }
}

/// Cells, sections and samples by pixel.
type Ids<'py> = (
    Bound<'py, PyArray2<i32>>,
    Bound<'py, PyArray2<i32>>,
    Bound<'py, PyArray2<i64>>,
);

fn array_of<T: Element>(
    py: Python<'_>,
    shape: (usize, usize),
    values: Vec<T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let values = Array2::from_shape_vec(shape, values).map_err(bug)?;
    Ok(PyArray2::from_owned_array(py, values))
}

/// Pixels as an array: height, width, four bytes.
fn pixels_of(py: Python<'_>, image: Image) -> PyResult<Py<PyArray3<u8>>> {
    let shape = (image.height as usize, image.width as usize, 4);
    let pixels = Array3::from_shape_vec(shape, image.pixels).map_err(bug)?;
    Ok(PyArray3::from_owned_array(py, pixels).unbind())
}

/// The colors of a color map; none if there is none of this name.
#[pyfunction]
fn color_scale(name: &str) -> Option<Vec<Rgb>> {
    name.parse::<ColorMap>().ok().map(ColorMap::scale)
}

/// The bytes of a PNG file.
#[pyfunction]
fn png<'py>(
    py: Python<'py>,
    pixels: PyReadonlyArray3<'py, u8>,
    transparent: bool,
    recipe: Option<&str>,
) -> PyResult<Bound<'py, PyBytes>> {
    let view = pixels.as_array();
    let (height, width, four) = view.dim();
    if four != 4 {
        return Err(PyValueError::new_err("pixels are (height, width, 4)"));
    }
    let image = Image {
        width: width as u32,
        height: height as u32,
        pixels: pixels.as_slice()?.to_vec(),
    };
    let written = detached(py, || {
        let bytes = Bytes::default();
        let size = [image.width, image.height];
        let text = recipe.map(|recipe| (drawing::PNG_KEYWORD, recipe));
        let mut png = PngWriter::with_text(bytes.clone(), size, transparent, text)?;
        png.write(&image)?;
        png.finish()?;
        std::io::Result::Ok(bytes.0.take())
    })?;
    Ok(PyBytes::new(py, &written?))
}

/// Bytes that a writer, which keeps what it writes to, leaves.
#[derive(Clone, Default)]
struct Bytes(Rc<RefCell<Vec<u8>>>);

impl Write for Bytes {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn camera((eye, target, up, fov, orthographic): View) -> PyResult<Camera> {
    let [eye, target, up] = [eye, target, up].map(DVec3::from);
    let lens = match orthographic {
        true => Lens::orthographic(fov),
        false => Lens::from(fov),
    };
    let camera = Camera::new(eye, target, up, lens);
    camera.map_err(|e| PyValueError::new_err(e.to_string()))
}

fn closed() -> PyErr {
    PyRuntimeError::new_err("the view is closed")
}

pub(crate) fn undrawn(py: Python<'_>, error: &DrawError) -> PyErr {
    match error {
        DrawError::Option(wrong) => errors::draw_option(py, wrong),
        DrawError::Memory(message) => PyMemoryError::new_err(message.clone()),
        other => errors::render(py, &other.to_string()),
    }
}
