//! What a worker asks: each call takes bytes, and answers with a document and bytes.

use serde::Serialize;

use crate::cell::DroppedCell;

/// Answers the calls of one worker, which has one cell at a time.
#[derive(Default)]
pub struct Calls {
    cell: Option<DroppedCell>,
}

/// An answer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answer {
    /// JSON.
    pub told: Vec<u8>,
    /// A page's cells, a file, or pixels.
    pub bytes: Vec<u8>,
}

impl Calls {
    /// Reads and meshes a file. Tells of the cell, and answers with the cells of a page.
    ///
    /// # Errors
    /// What the command line says of it; the cell before stays.
    pub fn open(&mut self, file: &str, bytes: Vec<u8>) -> Result<Answer, String> {
        let cell = DroppedCell::open(file, bytes)?;
        let packed = cell.cells()?;
        let answer = Answer::new(&cell.told(), packed.text.into_bytes());
        self.cell = Some(cell);
        Ok(answer)
    }

    /// The cell's surface at a level as a file of the format with this extension.
    ///
    /// # Errors
    /// There is no cell, or no such file of it.
    pub fn mesh(&self, format: &str, level: u32) -> Result<Answer, String> {
        let (counts, bytes) = self.cell()?.mesh_file(format, level)?;
        Ok(Answer::new(&counts, bytes))
    }

    /// The cell's tracing as SWC with its radii mended. Tells what SWC cannot say.
    ///
    /// # Errors
    /// There is no cell, or it cannot be mended.
    pub fn tracing(&self) -> Result<Answer, String> {
        let (lost, bytes) = self.cell()?.mended()?;
        Ok(Answer::new(&lost, bytes))
    }

    /// The cell's picture as pixels of four bytes: none if the colors are those of another cell, which was there before. Tells
    /// its size. `view`: JSON, see `Asked`; `colors`: red, green, blue and whether it shows, of each tracing point.
    ///
    /// # Errors
    /// There is no cell, or no such view.
    pub fn draw(&mut self, view: &str, colors: &[u8]) -> Result<Answer, String> {
        let asked = serde_json::from_str(view).map_err(|e| e.to_string())?;
        let image = self.cell_mut()?.image(&asked, colors)?;
        let size = [image.width, image.height];
        Ok(Answer::new(&size, image.pixels))
    }

    /// Tells the tracing point that shows at a pixel of such a picture, or next to it; null if there is none.
    ///
    /// # Errors
    /// There is no cell, or no such view.
    pub fn pick(&mut self, view: &str, colors: &[u8], at: [i64; 2]) -> Result<Answer, String> {
        let asked = serde_json::from_str(view).map_err(|e| e.to_string())?;
        let point = self.cell_mut()?.point_at(&asked, colors, at)?;
        Ok(Answer::new(&point, Vec::new()))
    }

    fn cell_mut(&mut self) -> Result<&mut DroppedCell, String> {
        self.cell.as_mut().ok_or_else(none)
    }

    fn cell(&self) -> Result<&DroppedCell, String> {
        self.cell.as_ref().ok_or_else(none)
    }
}

fn none() -> String {
    "there is no cell: open a file first".to_owned()
}

impl Answer {
    fn new(told: &impl Serialize, bytes: Vec<u8>) -> Self {
        Self {
            told: serde_json::to_vec(told).expect("our structs have string keys only"),
            bytes,
        }
    }

    /// The answer to what failed: a text instead of a document.
    #[cfg(target_arch = "wasm32")]
    pub(crate) fn fault(text: String) -> Self {
        Self {
            told: text.into_bytes(),
            bytes: Vec::new(),
        }
    }
}
