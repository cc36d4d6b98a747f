//! A tracing that was dropped: read and meshed as `neurotess html` does, in the words of the command.

use std::io::Cursor;
use std::path::Path;

use neurotess_color::{Cell, ColorScheme};
use neurotess_formats::{Format, ReadOptions, read_bytes, unpacked_name};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{CoarseMesh, Surface, write};
use neurotess_morphology::edit::{self, Edit};
use neurotess_morphology::{Measures, Morphology};
use neurotess_picture::{Image, Placement};
use neurotess_plot::{Measure, SHOLL_STEP, of_measure};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_web::{
    CellsText, MAX_KEYS, PageCell, PageMarkers, PageOptions, WebError, shared_cells,
};
use serde::Serialize;

use crate::drawing::{Asked, Drawing};

/// Most triangles of a mesh that is saved: its file is in memory, of which a module has 4 GB. As in saving.js.
const MAX_TRIANGLES: usize = 20_000_000;
/// Width and height (pixels) of the Sholl profile: what the page has room for.
const PLOT: [u32; 2] = [296, 190];
/// A radius so many times that of its neighbors is mended: the default of `neurotess convert --mend-radii`.
const OUTLIERS: f64 = 5.0;

/// A tracing, and its coarse mesh.
pub(crate) struct DroppedCell {
    /// The file's name.
    file: String,
    /// The name without its ending.
    name: String,
    format: &'static str,
    morphology: Morphology,
    mesh: CoarseMesh,
    warnings: Vec<String>,
    drawing: Drawing,
}

/// What the page tells of a cell.
#[derive(Serialize)]
pub(crate) struct Told<'c> {
    name: &'c str,
    format: &'static str,
    warnings: &'c [String],
    /// Names and values, as `neurotess info` prints them.
    measures: Vec<(&'static str, String)>,
    /// The Sholl profile as SVG; empty if there is none.
    sholl: String,
    sholl_step: f64,
}

/// What the page tells of a mesh that is saved.
#[derive(Serialize)]
pub(crate) struct Counts {
    vertices: usize,
    faces: usize,
}

impl DroppedCell {
    /// Reads and meshes a file.
    ///
    /// # Errors
    /// What `neurotess html` says of it.
    pub(crate) fn open(file: &str, bytes: Vec<u8>) -> Result<Self, String> {
        let format = unpacked_name(Path::new(file)).extension();
        let format =
            format.and_then(|extension| Format::of_extension(&extension.to_string_lossy()));
        let read = read_bytes(bytes, file, format, &ReadOptions::default());
        let read = read.map_err(|e| e.to_string())?;
        let points = read.morphology.points.len();
        if points > MAX_KEYS {
            // Before it is meshed: that would take more memory than there is.
            let most = MAX_KEYS;
            return Err(WebError::TooManyPoints { points, most }.to_string());
        }
        let made = generate(&read.morphology, &GenerateOptions::default());
        let made = made.map_err(|e| format!("{file}: {e}"))?;
        let of_file = read.warnings.iter().map(|warning| {
            let (message, code) = (&warning.message, warning.code);
            match warning.line {
                Some(line) => format!("{file}:{line}: {message} ({code})"),
                None => format!("{file}: {message} ({code})"),
            }
        });
        let of_mesh = made.warnings.iter();
        let of_mesh = of_mesh.map(|warning| format!("{file}: {warning} ({})", warning.code));
        Ok(Self {
            warnings: of_file.chain(of_mesh).collect(),
            name: stem(file),
            file: file.to_owned(),
            format: read.format,
            drawing: Drawing::new(&made.mesh),
            mesh: made.mesh,
            morphology: read.morphology,
        })
    }

    /// The cell as a page's text holds it.
    ///
    /// # Errors
    /// There is nothing to show, or too much.
    pub(crate) fn cells(&self) -> Result<CellsText, String> {
        let cell = Cell {
            name: &self.name,
            morphology: &self.morphology,
            mesh: &self.mesh,
            radius_factor: 1.0,
        };
        let options = PageOptions::usual(self.name.clone(), 1);
        let scheme = ColorScheme {
            palette: options.palette,
            own_colors: options.own_colors.clone(),
            background: None,
            scale: options.color_map.scale(),
            range: None,
        };
        let placed = PageCell {
            cell,
            placement: Placement::default(),
        };
        let markers = PageMarkers::default();
        let packed = shared_cells(&[placed], &scheme, None, None, &markers, &options);
        packed.map_err(|e| e.to_string())
    }

    /// What is told of it.
    pub(crate) fn told(&self) -> Told<'_> {
        let cells = [(&*self.name, &self.morphology)];
        let sholl = of_measure(Measure::Sholl, &cells, SHOLL_STEP).ok();
        let sholl = sholl.filter(|plot| !plot.is_empty()).map(|mut plot| {
            // The page says what it is, and of what.
            plot.title.clear();
            plot.series.iter_mut().for_each(|line| line.name.clear());
            plot.svg(PLOT)
        });
        Told {
            name: &self.name,
            format: self.format,
            warnings: &self.warnings,
            measures: Measures::of(&self.morphology).rows(),
            sholl: sholl.unwrap_or_default(),
            sholl_step: SHOLL_STEP,
        }
    }

    /// The surface at a level as a file of the format with this extension, as `neurotess mesh` writes it.
    ///
    /// # Errors
    /// No format has the extension, the surface is too fine, or the format cannot hold it.
    pub(crate) fn mesh_file(&self, format: &str, level: u32) -> Result<(Counts, Vec<u8>), String> {
        let out = format!("{}.{format}", self.name);
        let format = neurotess_mesh::Format::from_extension(Path::new(&out));
        let format = format.map_err(|e| e.to_string())?;
        let options = RefineOptions::default();
        let surface = Refinement::new(&self.mesh, LodCriterion::Homogeneous(level), &options);
        let faces = surface.triangle_count() + surface.quad_count();
        if faces > MAX_TRIANGLES {
            return Err(format!(
                "level {level} has {faces} triangles, too many for a page: choose a lower one, or use neurotess mesh {} \
                 --level {level}",
                self.file
            ));
        }
        let mut bytes = Cursor::new(Vec::new());
        write(&surface, format, &mut bytes).map_err(|e| format!("{}: {e}", self.file))?;
        let counts = Counts {
            vertices: surface.vertex_count(),
            faces,
        };
        Ok((counts, bytes.into_inner()))
    }

    /// A picture; empty if there are not as many colors as tracing points: they are another cell's.
    ///
    /// # Errors
    /// There is no such view.
    pub(crate) fn image(&mut self, asked: &Asked, colors: &[u8]) -> Result<Image, String> {
        if !self.are_colors(colors) {
            return Ok(Image::new(0, 0));
        }
        self.drawing.image(&self.mesh, asked, colors)
    }

    /// The tracing point that shows at a pixel of a picture, or next to it.
    ///
    /// # Errors
    /// There is no such view.
    pub(crate) fn point_at(
        &mut self,
        asked: &Asked,
        colors: &[u8],
        at: [i64; 2],
    ) -> Result<Option<u32>, String> {
        if !self.are_colors(colors) {
            return Ok(None);
        }
        self.drawing.point_at(&self.mesh, asked, colors, at)
    }

    fn are_colors(&self, colors: &[u8]) -> bool {
        colors.len() == 4 * self.mesh.tracing.len()
    }

    /// The tracing as SWC with its radii mended, as `neurotess convert --mend-radii` writes it, and what SWC cannot say.
    ///
    /// # Errors
    /// It cannot be edited or written.
    pub(crate) fn mended(&self) -> Result<(Vec<String>, Vec<u8>), String> {
        let mend = Edit::MendRadii {
            outliers: Some(OUTLIERS),
        };
        let told = |e: &dyn std::fmt::Display| format!("{}: {e}", self.file);
        let edited = edit::apply(&self.morphology, &[mend]).map_err(|e| told(&e))?;
        let mut bytes = Vec::new();
        let lost = neurotess_formats::write(&edited.morphology, Format::Swc, &mut bytes);
        let lost = lost.map_err(|e| told(&e))?;
        Ok((lost.iter().map(|lost| told(lost)).collect(), bytes))
    }
}

/// A file's name without its ending, and without that of gzip.
fn stem(file: &str) -> String {
    let name = unpacked_name(Path::new(file)).file_stem();
    name.map_or_else(
        || file.to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}
