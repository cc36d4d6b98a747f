//! From tracings of neurons to closed surfaces.
//!
//! # A tour
//!
//! A **morphology** is a traced cell: somata, sections and points with radii, in micrometers. It is
//! read from a file, or grown by [`synth`].
//!
//! ```
//! use neurotess::formats::{ReadOptions, swc};
//!
//! let tracing = b"# a soma, an axon, a dendrite that forks
//! 1 1  0   0  0  5   -1
//! 2 2  0  -9  0  1    1
//! 3 2  0 -30  2  0.8  2
//! 4 3  0   9  0  1.2  1
//! 5 3  2  25  0  1    4
//! 6 3 12  40  3  0.7  5
//! 7 3 -9  42 -4  0.7  5
//! ";
//! let read = swc::read_bytes(tracing, "cell.swc", &ReadOptions::default())?;
//! assert!(read.warnings.is_empty());
//!
//! // How long is it? The way through the soma is not counted.
//! use neurotess::morphology::Measures;
//! let measures = Measures::of(&read.morphology);
//! assert_eq!((measures.n_neurites, measures.n_ends), (2, 3));
//!
//! // The coarse mesh: quads around the tracing, closed by their indices.
//! use neurotess::generate::{GenerateOptions, generate};
//! let generated = generate(&read.morphology, &GenerateOptions::default())?;
//! let shape = generated.mesh.topology();
//! assert!(shape.closed && shape.oriented && shape.euler == 2);
//!
//! // Refined to level 4: a surface that is made block by block when it is asked for.
//! use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
//! let surface =
//!     Refinement::new(&generated.mesh, LodCriterion::Homogeneous(4), &RefineOptions::default());
//! let (volume, area) = surface.volume_and_area();
//! assert!(volume > generated.somata[0].volume && area > 0.0);
//!
//! // To a file, or to memory, and back.
//! use neurotess::mesh::{Format, check, read_bytes, write};
//! let mut ply = std::io::Cursor::new(Vec::new());
//! write(&surface, Format::Ply, &mut ply)?;
//! let report = check(&read_bytes(&ply.into_inner(), Format::Ply)?);
//! assert!(report.closed && report.vertex_manifold && report.self_intersections == 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! One value of options does the same, and more: [`read`], [`mesh()`] and, with the feature `render`, `draw` are
//! meshes and pictures in a line each; see [`recipe`]. [`Batch`] meshes a folder of tracings into another.
//!
//! The **coarse mesh** is small and is what a renderer needs; the **surface** may be far larger than
//! memory. For a surface as fine as an error asks for, use
//! [`LodCriterion::MaxError`](refine::LodCriterion::MaxError). What is in doubt comes back as **warnings**, of
//! the reader and of the generator; libraries print nothing.
//!
//! # Where things are
//!
//! | module | what | feature |
//! | --- | --- | --- |
//! | [`morphology`] | the traced cell, its measures, edits and comparisons | |
//! | [`formats`] | morphology files, there and back | SWC; `asc`, `h5`, `neuroml`, `xml`, `json` |
//! | [`circuit`] | many neurons: circuits, scenes, reports | `circuit` |
//! | [`cache`] | what opening a circuit leaves for the next time | `circuit` |
//! | [`synth`] | synthetic neurons and circuits | `synth` |
//! | [`generate`] | from a morphology to a coarse mesh | |
//! | [`refine`] | from a coarse mesh to a surface | |
//! | [`options`] | options of pictures as values: of flags, keywords, files | `options` |
//! | [`drawing`] | pictures and films by one value of options | `render` |
//! | [`picture`] | what a picture is: cameras, colors, looks, legends | `options` |
//! | [`raster`] | pictures by the processor | `render` |
//! | [`render`] | pictures by graphics hardware | `gpu` |
//! | [`coloring`] | what the colors of pictures tell | `options` |
//! | [`web`] | cells as one HTML page | `gpu` |
//! | [`union`] | the exact union of a surface with itself: nothing crosses | |
//! | [`mesh`](mod@mesh) | coarse meshes, surfaces, checks, mesh files | |
//! | [`recipe`] | from a tracing to the mesh that a purpose needs, and its files: all stages by one value of options | |
//! | [`batch`] | many tracings, or the cells of a circuit, meshed into a folder | cells of circuits: `circuit` |
//! | [`precomputed`] | tracings and circuits as neuroglancer opens them | `precomputed` |
//! | [`output`] | files that are there whole or not at all | |
//! | [`plot`] | plots of numbers and of measures, as SVG and CSV | |
//!
//! All features are on by default. Without any, the crate meshes SWC files and needs neither wgpu nor HDF5.
#![forbid(unsafe_code)]

pub use neurotess_batch as batch;
pub use neurotess_batch::Batch;
#[cfg(feature = "circuit")]
pub use neurotess_cache as cache;
#[cfg(feature = "circuit")]
pub use neurotess_circuit as circuit;
#[cfg(feature = "options")]
pub use neurotess_color as coloring;
#[cfg(feature = "render")]
pub use neurotess_drawing as drawing;
#[cfg(feature = "render")]
pub use neurotess_drawing::draw;
pub use neurotess_formats as formats;
pub use neurotess_generate as generate;
pub use neurotess_mesh as mesh;
pub use neurotess_morphology as morphology;
#[cfg(feature = "options")]
pub use neurotess_options as options;
pub use neurotess_output as output;
#[cfg(feature = "options")]
pub use neurotess_picture as picture;
pub use neurotess_plot as plot;
#[cfg(feature = "precomputed")]
pub use neurotess_precomputed as precomputed;
#[cfg(feature = "render")]
pub use neurotess_raster as raster;
pub use neurotess_recipe as recipe;
pub use neurotess_recipe::{mesh, read, read_with};
pub use neurotess_refine as refine;
#[cfg(feature = "gpu")]
pub use neurotess_render as render;
#[cfg(feature = "synth")]
pub use neurotess_synth as synth;
pub use neurotess_union as union;
#[cfg(feature = "gpu")]
pub use neurotess_web as web;

/// The code of docs/library.md.
#[cfg(all(doctest, feature = "gpu"))]
#[doc = include_str!("../../../docs/library.md")]
struct LibraryPage;
