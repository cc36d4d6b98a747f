//! From tracings of neurons to closed surfaces.
#![forbid(unsafe_code)]

pub use neurotess_formats as formats;
pub use neurotess_generate as generate;
pub use neurotess_mesh as mesh;
pub use neurotess_morphology as morphology;
pub use neurotess_refine as refine;
pub use neurotess_synth as synth;
