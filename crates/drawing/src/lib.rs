//! Pictures and films of cells and circuits: one value of options ([`Picture`]), read or meshed cells, and whatever draws
//! them, the processor or a graphics adapter.
//!
//! ```text
//! files, cells, a circuit ─scene─▶ meshes, placements ─▶ cameras, colors ─painter─▶ bands ─▶ an image, a file
//! ```
//!
//! `neurotess render`, Python's `render` and `film`, and the library's `draw` are faces of it.
#![forbid(unsafe_code)]

mod cameras;
mod colors;
mod draw;
mod drawing;
mod error;
mod film;
mod host;
mod job;
mod meshed;
mod options;
mod overlay;
#[cfg(feature = "pages")]
mod page;
mod painter;
mod png;
mod scene;
mod shown;
mod text;

pub use colors::{stem, tell_unused_types};
pub use draw::draw;
pub use drawing::{Drawing, DrawingInput, DrawingSeconds, IdImage, Picked};
pub use error::DrawError;
pub use film::FilmStats;
pub use host::{Host, Quiet, Work};
pub use meshed::{MeshedCell, Unread};
pub use neurotess_options::{OptionError, Picture};
pub use options::{DrawOptions, OwnData};
#[cfg(feature = "pages")]
pub use page::{MadePage, PageContent, PageError, PageValues, page};
pub use painter::{
    BudgetStats, Cost, Device, Open, Recolored, SourceStats, StreamStats, Take, Wanted, open,
    wanted,
};
pub use png::{DrawnImage, KEYWORD as PNG_KEYWORD, Recipe, begin_png, picture_of_png, recipe_of};
pub use scene::markers::read_markers;
pub use scene::{CircuitInstances, Scene, of_memory, read_circuit, read_files};
