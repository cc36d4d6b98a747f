//! What is said of a cell's mesh.

use glam::DAffine3;
use neurotess_mesh::{CoarseMesh, Format, Quality, Role, Walled};
use neurotess_union::{Kin, UnionReport};

use crate::merged::Merged;
use crate::pieces;

/// Solvers lose accuracy, and mesh generators time, where one in a hundred triangles has a smaller angle
/// (degrees).
const THIN_TRIANGLES: f64 = 10.0;
/// From this share of the radius on, rounding is told: surfaces become rough, and lose volume.
const ROUNDED: f64 = 0.02;
/// Most pieces that are named.
const NAMED_PIECES: usize = 8;

/// What is said of a cell: of its file, its coarse mesh or its surface.
#[derive(Clone, Debug)]
pub enum Warning {
    /// The file.
    File(neurotess_formats::Warning),
    /// The coarse mesh.
    Mesh(neurotess_generate::Warning),
    /// The surface.
    Surface(SurfaceWarning),
}

/// What is said of a surface that was merged with itself, or that has walls. Samples are the file's numbers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SurfaceWarning {
    /// Branches that cross grew together.
    BranchesMerged {
        /// Where.
        places: usize,
        /// Of the deepest place.
        samples: [i32; 2],
        /// µm, of the deepest place.
        depth: f64,
    },
    /// Branches that cross were pressed in.
    BranchesPressed {
        /// Where.
        places: usize,
        /// Of the first place.
        samples: [i32; 2],
    },
    /// Holes that merging left were filled.
    HolesFilled {
        /// Holes.
        places: usize,
        /// Of the first.
        sample: i32,
        /// µm³ that this added; negative if surfaces were flattened by more.
        volume: f64,
    },
    /// Places where a tube was inside out were filled.
    Joined {
        /// Where.
        places: usize,
        /// Of the first.
        sample: i32,
        /// µm³ that this added.
        volume: f64,
    },
    /// Merging closed loops.
    Handles {
        /// Loops.
        loops: i64,
        /// Of the first place that was merged; −1 where none is known.
        sample: i32,
    },
    /// Pieces inside others, and splinters, were left out.
    PartsDropped {
        /// Pieces.
        parts: usize,
        /// Of the first.
        sample: i32,
    },
    /// Pieces no longer hang together with the rest.
    PartsCutOff {
        /// Pieces.
        parts: usize,
        /// Of the first.
        sample: i32,
    },
    /// A mesh for solvers has several pieces.
    SeveralPieces {
        /// One of each.
        samples: Vec<i32>,
    },
    /// One in a hundred triangles is narrow.
    ThinTriangles {
        /// Their largest angle (degrees).
        angle: f64,
    },
    /// Tubes that would close loops are thinner than traced.
    Thinned {
        /// Where.
        samples: Vec<i64>,
    },
    /// A wall between soma and neurite was left out.
    WallLeftOut {
        /// Walls.
        walls: usize,
        /// Of the first.
        sample: i32,
    },
    /// No neurite leaves a soma, so that there are no walls.
    NoWalls,
    /// The file's coordinates are so large that rounding changes the shape.
    Rounded {
        /// The largest coordinate (µm).
        at: f64,
        /// By how much it moves points (µm).
        by: f64,
        /// The median radius (µm).
        radius: f64,
    },
}

impl SurfaceWarning {
    /// A short name, the same in all versions.
    pub fn code(&self) -> &'static str {
        match self {
            Self::BranchesMerged { .. } => "branches_merged",
            Self::BranchesPressed { .. } => "branches_pressed",
            Self::HolesFilled { .. } => "holes_filled",
            Self::Joined { .. } => "joined",
            Self::Handles { .. } => "handles",
            Self::PartsDropped { .. } => "parts_dropped",
            Self::PartsCutOff { .. } => "parts_cut_off",
            Self::SeveralPieces { .. } => "several_pieces",
            Self::ThinTriangles { .. } => "thin_triangles",
            Self::Thinned { .. } => "thinned",
            Self::WallLeftOut { .. } | Self::NoWalls => "no_wall",
            Self::Rounded { .. } => "coordinates_rounded",
        }
    }

    /// The file's number of the sample where it is first; −1 where a place is not known; none where there is no place.
    pub fn sample(&self) -> Option<i64> {
        let sample = match self {
            Self::BranchesMerged { samples, .. } | Self::BranchesPressed { samples, .. } => {
                samples[0]
            }
            Self::HolesFilled { sample, .. }
            | Self::Joined { sample, .. }
            | Self::Handles { sample, .. }
            | Self::PartsDropped { sample, .. }
            | Self::PartsCutOff { sample, .. }
            | Self::WallLeftOut { sample, .. } => *sample,
            Self::SeveralPieces { samples } => *samples.first()?,
            Self::Thinned { samples } => return samples.first().copied(),
            Self::ThinTriangles { .. } | Self::NoWalls | Self::Rounded { .. } => return None,
        };
        Some(i64::from(sample))
    }

    /// How often.
    pub fn count(&self) -> u64 {
        let count = match self {
            Self::BranchesMerged { places, .. }
            | Self::BranchesPressed { places, .. }
            | Self::HolesFilled { places, .. }
            | Self::Joined { places, .. } => *places,
            Self::Handles { loops, .. } => return u64::try_from(*loops).unwrap_or(0),
            Self::PartsDropped { parts, .. } | Self::PartsCutOff { parts, .. } => *parts,
            Self::SeveralPieces { samples } => samples.len(),
            Self::Thinned { samples } => samples.len(),
            Self::WallLeftOut { walls, .. } => *walls,
            Self::ThinTriangles { .. } | Self::NoWalls | Self::Rounded { .. } => 1,
        };
        count as u64
    }

    /// What merging changed, and what is said of the triangles and pieces of a mesh for simulators.
    pub(crate) fn of_merged(merged: &Merged) -> Vec<Self> {
        let mut warnings = of_crossings(&merged.report);
        warnings.extend(merged.quality.as_ref().and_then(of_triangles));
        // Of a mesh for simulators alone: others may show several cells.
        if merged.quality.is_some() {
            let samples = pieces::samples(&merged.mesh);
            warnings.extend((samples.len() > 1).then_some(Self::SeveralPieces { samples }));
        }
        warnings
    }

    /// What is said of a file whose coordinates are so large that rounding shows: of numbers of 32 bits in STL, of 64 bits
    /// in other formats. None where it moves points by less than a fiftieth of the median radius.
    pub fn of_rounding(
        mesh: &CoarseMesh,
        format: Format,
        world_from_cell: Option<DAffine3>,
    ) -> Option<Self> {
        let place = world_from_cell.unwrap_or(DAffine3::IDENTITY);
        let scale = place.matrix3.determinant().abs().cbrt();
        let of_neurites = mesh.tracing.iter().filter(|t| t.role != Role::Soma);
        let mut radii: Vec<f64> = of_neurites.map(|t| f64::from(t.radius) * scale).collect();
        if radii.is_empty() {
            radii.extend(mesh.tracing.iter().map(|t| f64::from(t.radius) * scale));
        }
        let middle = radii.len() / 2;
        let (_, &mut radius, _) = radii
            .get_mut(..)
            .filter(|all| !all.is_empty())?
            .select_nth_unstable_by(middle, f64::total_cmp);
        let at = mesh.tracing.iter().map(|t| {
            let center = mesh.origin + t.center.as_dvec3();
            place.transform_point3(center).abs().max_element()
        });
        let at = at.fold(0.0, f64::max);
        let half_step = match format {
            Format::Stl => f64::from(f32::EPSILON),
            _ => f64::EPSILON,
        };
        let by = at * half_step / 2.0;
        (by > ROUNDED * radius).then_some(Self::Rounded { at, by, radius })
    }

    /// Whether nothing of the cell's shape is left.
    pub fn is_lost(&self) -> bool {
        matches!(self, Self::Rounded { by, radius, .. } if by > radius)
    }

    /// What is said of walls that are not there.
    pub fn of_walls(walled: &Walled) -> Option<Self> {
        match walled.left_out.first() {
            Some(&sample) => Some(Self::WallLeftOut {
                walls: walled.left_out.len(),
                sample,
            }),
            None => walled.regions.is_empty().then_some(Self::NoWalls),
        }
    }
}

fn of_crossings(report: &UnionReport) -> Vec<SurfaceWarning> {
    let mut warnings = Vec::new();
    let apart = report.places.iter().filter(|place| place.kin == Kin::Apart);
    let deepest = apart.clone().max_by(|a, b| a.depth.total_cmp(&b.depth));
    warnings.extend(deepest.map(|deepest| SurfaceWarning::BranchesMerged {
        places: apart.count(),
        samples: deepest.points,
        depth: deepest.depth,
    }));
    let pressed = report.pressed_places.first();
    warnings.extend(pressed.map(|first| SurfaceWarning::BranchesPressed {
        places: report.pressed_places.len(),
        samples: first.points,
    }));
    let filled = report.filled.first();
    warnings.extend(filled.map(|first| SurfaceWarning::HolesFilled {
        places: report.filled.len(),
        sample: first.point,
        volume: report.filled.iter().map(|hole| hole.volume).sum(),
    }));
    let joined = report.joined.first();
    warnings.extend(joined.map(|first| SurfaceWarning::Joined {
        places: report.joined.len(),
        sample: first.point,
        volume: report.joined.iter().map(|piece| piece.volume).sum(),
    }));
    let loops = report.handles_made().unwrap_or(0);
    if loops > 0 {
        let first = report.places.first();
        let sample = first.map_or(-1, |place| place.points[0]);
        warnings.push(SurfaceWarning::Handles { loops, sample });
    }
    let dropped = report.dropped.first();
    warnings.extend(dropped.map(|first| SurfaceWarning::PartsDropped {
        parts: report.dropped.len(),
        sample: first.point,
    }));
    let cut_off = report.cut_off.first();
    warnings.extend(cut_off.map(|first| SurfaceWarning::PartsCutOff {
        parts: report.cut_off.len(),
        sample: first.point,
    }));
    warnings
}

fn of_triangles(quality: &Quality) -> Option<SurfaceWarning> {
    let angle = quality.min_angle_p1;
    (angle < THIN_TRIANGLES).then_some(SurfaceWarning::ThinTriangles { angle })
}

impl std::fmt::Display for SurfaceWarning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BranchesMerged {
                places,
                samples: [a, b],
                depth,
            } => write!(
                f,
                "branches that cross grew together in {places} places, deepest at samples {a} and {b} \
                 ({depth:.2} µm): a short circuit for voltage and diffusion"
            ),
            Self::BranchesPressed {
                places,
                samples: [a, b],
            } => write!(
                f,
                "branches that cross were pressed in, thinner there than traced, in {places} places, first at \
                 samples {a} and {b}"
            ),
            Self::HolesFilled {
                places,
                sample,
                volume,
            } => write!(
                f,
                "holes that merging left, smaller than a branch, were filled in {places} places, first at \
                 sample {sample} ({volume:+.2e} µm³ in all)"
            ),
            Self::Joined {
                places,
                sample,
                volume,
            } => write!(
                f,
                "the tube is inside out in {places} places, first at sample {sample}, where a neurite turns back within \
                 its own radius: filled there, so that nothing is cut off ({volume:+.2e} µm³ in all)"
            ),
            Self::Handles { loops, .. } => write!(f, "merging closed {loops} loops (handles)"),
            Self::PartsDropped { parts, .. } => write!(
                f,
                "{parts} pieces of the surface inside others, or splinters: left out"
            ),
            Self::PartsCutOff { parts, .. } => write!(
                f,
                "{parts} pieces of the surface no longer hang together with the rest"
            ),
            Self::SeveralPieces { samples } => {
                let count = samples.len();
                let named = samples.iter().take(NAMED_PIECES);
                let mut named: Vec<String> = named.map(ToString::to_string).collect();
                if count > NAMED_PIECES {
                    named.push(format!("{} more", count - NAMED_PIECES));
                }
                write!(
                    f,
                    "the mesh has {count} pieces that nothing connects, at samples {}: solvers take each for a body of \
                     its own; neurotess convert --join connects tracings",
                    named.join(", ")
                )
            }
            Self::ThinTriangles { angle } => write!(
                f,
                "one in a hundred triangles has an angle below {angle:.1}°: try another edge length (isotropic), or a \
                 smaller aspect (max_aspect)"
            ),
            Self::Thinned { samples } => write!(
                f,
                "neurites would have grown together into loops: thinner there than traced, at {} samples, first at \
                 sample {}",
                samples.len(),
                samples.first().copied().unwrap_or(-1)
            ),
            Self::WallLeftOut { .. } => f.write_str(
                "the border between soma and neurite is no simple ring, or a wall would cross the membrane: no wall \
                 there",
            ),
            Self::NoWalls => f.write_str("no neurite leaves a soma: there are no walls"),
            Self::Rounded { at, by, radius } => write!(
                f,
                "coordinates of up to {at:.3e} µm are rounded by {by:.1e} µm in this file, and the median radius is \
                 {radius:.3} µm: write ply, or move the cell towards the origin"
            ),
        }
    }
}

impl Warning {
    /// A short name, the same in all versions.
    pub fn code(&self) -> &'static str {
        match self {
            Self::File(warning) => warning.code,
            Self::Mesh(warning) => warning.code,
            Self::Surface(warning) => warning.code(),
        }
    }

    /// The line of the file, if it is of one.
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::File(warning) => warning.line,
            Self::Mesh(_) | Self::Surface(_) => None,
        }
    }

    /// The file's number of the sample where it is first, if there is one.
    pub fn sample(&self) -> Option<i64> {
        match self {
            Self::File(_) => None,
            Self::Mesh(warning) => warning.sample,
            Self::Surface(warning) => warning.sample(),
        }
    }

    /// How often.
    pub fn count(&self) -> u64 {
        match self {
            Self::File(warning) => warning.count,
            Self::Mesh(warning) => warning.count as u64,
            Self::Surface(warning) => warning.count(),
        }
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(warning) => f.write_str(&warning.message),
            Self::Mesh(warning) => warning.fmt(f),
            Self::Surface(warning) => warning.fmt(f),
        }
    }
}
