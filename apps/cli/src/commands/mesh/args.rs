//! `neurotess mesh`: its options.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use neurotess::batch::Shard;
use neurotess::generate::Smooth;
use neurotess::mesh::{ColorBy, Compression, Format, Unit};

use crate::options::out::OutArgs;
use neurotess::options::groups::CellSelection;
use neurotess::options::groups::MissingRadii;
use neurotess::options::groups::Rings;
use neurotess::options::words::Soma;
use neurotess::options::words::Types;

/// `neurotess mesh`
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  neurotess mesh cell.swc -o cell.ply
  neurotess mesh cell.swc -o cell.glb --max-error 0.05
  neurotess mesh cell.swc -o cell.ply --poisson 0.1 --ring 1=0.5 --ring 2=1.5
  neurotess mesh cell.swc -o cell.ply --simulation
  neurotess mesh cells/ -o meshes/ --format stl --types axon,2,custom_9
  neurotess mesh cell.swc -o cell.glb --materials      (in the colors of types: for Blender)
  neurotess mesh cell.swc -o cell.glb --compress draco --color-by type      (small, for the web)
  neurotess mesh cell.swc -o cell.stl --parts      (cell_soma.stl, cell_axon.stl, …)
  neurotess mesh cells/ -o meshes/ --shard $SLURM_ARRAY_TASK_ID/100 --resume --log 1.jsonl
  neurotess mesh cell.swc -o cell.msh --unit m --table cell.csv
  neurotess mesh circuit/ -o meshes/ --node-set L4 --sample 20
  neurotess mesh circuit/ -o circuit.glb      (one file: each morphology once, each cell a node)

PLY, GLB and VTU carry normals and, per vertex, type (SWC), point (number of the sample), section
and radius (µm). OBJ has a group for each type. In MSH (Gmsh) each section is a
surface and each type a physical group; in POLY and SMESH (TetGen) facets are marked by type.")]
pub(crate) struct MeshArgs {
    /// Morphology files, folders (searched recursively) or globs, - for standard input; or one
    /// circuit, whose cells are written in its coordinates
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) out: OutArgs,
    /// Subdivisions per coarse edge, 1 to 64; 0 writes the coarse quads themselves [default: 4]
    #[arg(
        long,
        value_name = "N",
        help_heading = "Refinement",
        allow_negative_numbers = true
    )]
    pub(crate) level: Option<i64>,
    /// As fine as keeps the surface within E µm of the level-64 one, instead of --level
    #[arg(
        long,
        value_name = "E",
        allow_negative_numbers = true,
        help_heading = "Refinement"
    )]
    pub(crate) max_error: Option<f64>,
    /// Course between traced points
    #[arg(long, value_enum, default_value_t = PathArg::Hermite, value_name = "COURSE",
          help_heading = "Refinement")]
    pub(crate) path: PathArg,
    /// Shape of the ends of neurites
    #[arg(long, value_enum, default_value_t = CapsArg::Round, value_name = "SHAPE",
          help_heading = "Refinement")]
    pub(crate) caps: CapsArg,
    /// Subdivisions per coarse edge along neurites; --level is then for the edges around them
    #[arg(
        long,
        value_name = "N",
        help_heading = "Refinement",
        allow_negative_numbers = true
    )]
    pub(crate) level_along: Option<i64>,
    /// Edges about F times as long as the local radius, instead of --level [default of F: 1]
    #[arg(long, value_name = "F", num_args = 0..=1, default_missing_value = "1",
          allow_negative_numbers = true, help_heading = "Refinement")]
    pub(crate) isotropic: Option<f64>,
    /// With --isotropic: longest edge (µm)
    #[arg(
        long,
        value_name = "UM",
        allow_negative_numbers = true,
        help_heading = "Refinement"
    )]
    pub(crate) max_edge: Option<f64>,
    /// With --isotropic: shortest edge (µm) that is asked for
    #[arg(
        long,
        value_name = "UM",
        allow_negative_numbers = true,
        help_heading = "Refinement"
    )]
    pub(crate) min_edge: Option<f64>,
    /// With --isotropic: how many times F radii long edges along neurites may be [default: 1; with
    /// --simulation 2.6]
    #[arg(
        long,
        value_name = "A",
        allow_negative_numbers = true,
        help_heading = "Refinement"
    )]
    pub(crate) max_aspect: Option<f64>,
    /// What becomes of places where the surface crosses itself [default: keep; with --simulation
    /// separate]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Crossings")]
    pub(crate) crossings: Option<CrossingsArg>,
    /// Which radius rings of neurites have [default: traced; with --simulation equal-area]
    #[arg(long, value_enum, value_name = "WHICH", help_heading = "Surface")]
    pub(crate) radii: Option<RadiiArg>,
    /// Factor on the radii of neurites, as for printing in three dimensions
    #[arg(
        long,
        default_value_t = 1.0,
        value_name = "FACTOR",
        allow_negative_numbers = true,
        help_heading = "Surface"
    )]
    pub(crate) radius_factor: f64,
    #[command(flatten)]
    pub(crate) radius: MissingRadii,
    /// A mesh that solvers take: --crossings separate --isotropic --max-aspect 2.6 --radii equal-area,
    /// or an error that says where it fails
    #[arg(long, help_heading = "Crossings")]
    pub(crate) simulation: bool,
    /// How the soma is made
    #[arg(long, value_enum, default_value_t = Soma::Fem, value_name = "METHOD",
          help_heading = "Soma")]
    pub(crate) soma: Soma,
    /// Poisson's ratio ν of the soma's material, 0 ≤ ν < 0.5
    #[arg(
        long,
        default_value_t = 0.3,
        value_name = "NU",
        allow_negative_numbers = true,
        help_heading = "Soma"
    )]
    pub(crate) poisson: f64,
    /// What of the soma stays as it was traced, while neurites draw it out [default: volume]
    #[arg(long, value_enum, value_name = "WHAT", help_heading = "Soma")]
    pub(crate) soma_keep: Option<SomaKeepArg>,
    /// The soma's surface from a mesh (ply, obj, stl, off, …; µm, in the tracing's coordinates), as from a stack of
    /// images or electron microscopy, instead of what was traced of it; `file` for the one that an H5 file of morph-spines
    /// has beside its cell
    #[arg(long, value_name = "FILE", help_heading = "Soma")]
    pub(crate) soma_mesh: Option<PathBuf>,
    /// Factor on the soma's size
    #[arg(
        long,
        default_value_t = 1.0,
        value_name = "S",
        allow_negative_numbers = true,
        help_heading = "Soma"
    )]
    pub(crate) soma_scale: f64,
    /// Reference sphere [default: cube]
    #[arg(long, value_enum, value_name = "SPHERE", help_heading = "Soma")]
    pub(crate) soma_sphere: Option<SphereArg>,
    /// Resolution of the sphere: octahedron 1 to 5, cube 2 to 32 [default: what fits the neurites]
    #[arg(
        long,
        value_name = "N",
        allow_negative_numbers = true,
        help_heading = "Soma"
    )]
    pub(crate) soma_level: Option<i64>,
    #[command(flatten)]
    pub(crate) rings: Rings,
    /// Smooth the noise of the tracing away: half-width (µm) of what each point is averaged over; auto:
    /// 1.5 radii; 0: none. Forks and ends stay
    #[arg(long, value_name = "LENGTH", value_parser = smooth, allow_negative_numbers = true)]
    pub(crate) smooth: Option<Smooth>,
    /// Keep only these: axon, basal, apical, dendrite (both), undefined, custom_N, SWC numbers
    #[arg(long, value_delimiter = ',', value_name = "TYPE,…")]
    pub(crate) types: Vec<Types>,
    /// Format, where OUT's extension does not tell: ply, obj, stl, glb, off, vtu, msh
    /// (Gmsh 4.1), msh2 (2.2, in files that end in .msh), poly, smesh
    #[arg(long, value_name = "FORMAT", help_heading = "Output")]
    pub(crate) format: Option<Format>,
    /// Quads instead of triangles (ply, obj, off, vtu)
    #[arg(long, help_heading = "Output")]
    pub(crate) quads: bool,
    /// Unit of coordinates and radii in OUT
    #[arg(long, value_enum, default_value_t = UnitArg::Um, value_name = "UNIT",
          help_heading = "Output")]
    pub(crate) unit: UnitArg,
    /// Materials in the colors of types: in glb, and of obj in a file beside it that ends in .mtl. Some
    /// programs, as trimesh, then read a mesh for each material, none of which is closed
    #[arg(long, help_heading = "Output")]
    pub(crate) materials: bool,
    /// Colors of vertices (glb, ply, vtu): type, as pictures have them. The mesh stays one and closed
    #[arg(long, value_name = "WHAT", help_heading = "Output")]
    pub(crate) color_by: Option<ColorBy>,
    /// Compress a glb: draco makes it a tenth as large or less. Whole numbers stay exact, floats are rounded, vertices and
    /// triangles get another order. Some programs do not read it, see docs/mesh.md
    #[arg(
        long,
        value_name = "HOW",
        conflicts_with = "table",
        help_heading = "Output"
    )]
    pub(crate) compress: Option<Compression>,
    /// A file for each type instead of one: OUT_soma, OUT_axon, OUT_basal_dendrite, … Each is open where it
    /// was cut from the next, unless --walls close it
    #[arg(long, conflicts_with = "table", help_heading = "Output")]
    pub(crate) parts: bool,
    /// Walls inside, between the soma and each neurite, so that tetrahedra get regions (msh, msh2, poly, smesh;
    /// all with --parts)
    #[arg(long, help_heading = "Output")]
    pub(crate) walls: bool,
    /// Also write a row for each triangle: its sample, section, place along the section and SWC type
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["quads", "resume", "shard"],
          help_heading = "Output")]
    pub(crate) table: Option<PathBuf>,
    /// Also write a row for each section: SWC type, samples, length, and the area of its frusta beside that on the mesh
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["resume", "shard"],
          help_heading = "Output")]
    pub(crate) areas: Option<PathBuf>,
    /// Do every N-th input only, from the I-th on, 1 ≤ I ≤ N
    #[arg(long, value_name = "I/N", help_heading = "Many inputs")]
    pub(crate) shard: Option<Shard>,
    /// Skip inputs whose output is there, newer than they are and made with the same options;
    /// outputs of other options are made again. Several runs may share a folder
    #[arg(long, help_heading = "Many inputs")]
    pub(crate) resume: bool,
    /// Append one JSON line per cell to this file as it finishes
    #[arg(long, value_name = "FILE.jsonl", help_heading = "Many inputs")]
    pub(crate) log: Option<PathBuf>,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) cells: CellSelection,
}

impl MeshArgs {
    /// The files of tables about one cell, each with its flag.
    pub(super) fn tables(&self) -> impl Iterator<Item = (&'static str, &PathBuf)> {
        let files = [("--table", &self.table), ("--areas", &self.areas)];
        files
            .into_iter()
            .filter_map(|(flag, file)| Some((flag, file.as_ref()?)))
    }
}

/// `--path`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PathArg {
    /// A smooth curve
    Hermite,
    /// Straight
    Linear,
}

/// `--crossings`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CrossingsArg {
    /// They stay: the surface is made block by block, in little memory
    Keep,
    /// The exact union: no two triangles cross, and branches traced through one another grow together
    Merge,
    /// Branches traced through one another are moved apart; what crosses at forks and bends is merged
    Separate,
}

/// `--radii`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum RadiiArg {
    /// The traced one: vertices lie on the circle, and the polygon within it
    Traced,
    /// As much larger as gives the polygon the area of the circle, so that neurites keep their volume
    EqualArea,
    /// As much larger as gives the polygon the perimeter of the circle, so that neurites keep the area of their membrane
    EqualPerimeter,
}

/// `--caps`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum CapsArg {
    /// Half spheres
    Round,
    /// Disks
    Flat,
}

/// `--soma-keep`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SomaKeepArg {
    /// Its volume, closed by the first rings of neurites
    Volume,
    /// Its area, for electrical properties
    Area,
    /// The size of the shape that neurites draw out
    Scale,
}

/// `--soma-sphere`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SphereArg {
    /// The paper's
    Octahedron,
    /// Six faces of quads
    Cube,
}

/// `--unit`
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UnitArg {
    /// Micrometers, as in the tracing
    Um,
    /// Meters: SI, as STEPS wants them
    M,
}

impl UnitArg {
    pub(crate) fn unit(self) -> Unit {
        match self {
            Self::Um => Unit::Micrometer,
            Self::M => Unit::Meter,
        }
    }
}

fn smooth(text: &str) -> Result<Smooth, String> {
    match text.parse() {
        _ if text == "auto" => Ok(Smooth::Auto),
        // What no `--smooth` gives, to its fingerprint.
        Ok(0.0) => Ok(Smooth::None),
        Ok(length) => Ok(Smooth::Length(length)),
        Err(_) => Err("a length of 0 or more (µm) or auto is needed".into()),
    }
}
