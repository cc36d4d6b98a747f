//! What shaders share with this crate: constants, structs and the twins of its functions.
//!
//! A shader is composed ([`compose`](crate::wgsl::compose)) of its own file, which imports those of
//! [`FILES`] that it needs, with [`constants`]. Constants are defined in Rust and passed to WGSL;
//! layouts of structs are compared field by field in `tests/shaders.rs`.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use neurotess_mesh::{PatchKind, Role};

use crate::bounding_sphere::{SOMA_REACH, TUBE_REACH};
use crate::decode::{
    ANCHOR_TAPER_SHIFT, BORDER_SHIFT, COLLAR_AGAINST, COLLAR_SHIFT, CREASE_CORNER_SHIFT,
    CREASE_STEPS, EXPLICIT, MAX_CREASE, MAX_HEIGHT, POINT_END, POINT_EXPLICIT, POINT_GOES_ON,
    POINT_KIND_SHIFT, POINT_NARROWS, POINT_SHAPED, POINTS_OF_SPHERE, POSITION_STEPS, RADIUS_BASE,
    SHAPED_CREASE_SHIFT, SHAPED_INSET, SHAPED_LEVEL_SHIFT, SHAPED_OPEN_SHIFT, SHAPED_U32S,
    SPHERE_U32S, TAPER_LOW_BITS, TAPER_NARROWS,
};
use crate::evaluate::{
    BORDER_CUBIC, CLEAR_OF_ROWS, LEAST_LIFT, MAX_OFFSET, MAX_SWAY, SOMA_FILLET, STEEPEST_PROFILE,
};
use crate::level::{HIGHEST_LEVEL, SHARE, SLACK, STEEPEST};
use crate::wgsl::{Constants, WgslFile};
use crate::{Caps, LodCriterion, LodView, Path, RefineOptions};

/// A file of this crate.
macro_rules! file {
    ($name:literal) => {
        WgslFile {
            name: $name,
            text: include_str!($name),
        }
    };
}

/// Twin of `evaluate.rs`.
pub const EVALUATE: WgslFile = file!("evaluate.wgsl");
/// Twin of `evaluate/profile.rs`.
pub const PROFILE: WgslFile = file!("profile.wgsl");
/// Twin of `level.rs`.
pub const LEVEL: WgslFile = file!("level.wgsl");
/// The layout of a packed mesh, twin of `decode.rs`; binds group 0, binding 0.
pub const TEMPLATE: WgslFile = file!("template.wgsl");
/// Twin of `plan.rs`. Another file must define `CornerSource`, `base_of` and `corner_of`, by which
/// it reads the corners of patches; [`CORNER_SOURCE`] is one.
pub const PLAN: WgslFile = file!("plan.wgsl");
/// Corners read from the packed mesh, for shaders that do not compute them beforehand.
pub const CORNER_SOURCE: WgslFile = file!("corner_source.wgsl");

/// All files, for imports.
pub const FILES: [WgslFile; 6] = [EVALUATE, PROFILE, LEVEL, TEMPLATE, PLAN, CORNER_SOURCE];

const EDGE_RING: u32 = 0;
const EDGE_ALONG: u32 = 1;
const EDGE_SOMA: u32 = 2;
/// That of patches, which shaders rely on.
const EDGE_LOFT: u32 = PatchKind::Loft as u32;
const SIDE_KIND: u32 = 3;
const SIDE_REVERSED: u32 = 4;
const LEVELS_HOMOGENEOUS: u32 = 0;
const LEVELS_PER_POINT: u32 = 1;
const LEVELS_MAX_ERROR: u32 = 2;
const LEVELS_DISTANCE: u32 = 3;
const LEVELS_PIXEL_SIZE: u32 = 4;
const LEVELS_PIXEL_ERROR: u32 = 5;

/// Constants that the files share with Rust.
pub fn constants() -> Constants {
    let mut constants = Constants::default();
    let mut whole = |name: &str, value: u32| constants.u32(name, value);
    whole("HIGHEST_LEVEL", HIGHEST_LEVEL);
    whole("ROLE_JOINT", Role::Joint as u32);
    whole("ROLE_SOMA", Role::Soma as u32);
    whole("PATCH_LATERAL", PatchKind::Lateral as u32);
    whole("PATCH_CAP", PatchKind::Cap as u32);
    whole("PATCH_SOMA", PatchKind::Soma as u32);
    whole("PATCH_LOFT", PatchKind::Loft as u32);
    whole("ROLE_INSET", Role::Inset as u32);
    whole("EXPLICIT", EXPLICIT);
    whole("POINT_KIND_SHIFT", POINT_KIND_SHIFT);
    whole("POINT_END", POINT_END);
    whole("POINT_EXPLICIT", POINT_EXPLICIT);
    whole("POINT_SHAPED", POINT_SHAPED);
    whole("SHAPED_U32S", SHAPED_U32S as u32);
    whole("SHAPED_LEVEL_SHIFT", SHAPED_LEVEL_SHIFT);
    whole("SHAPED_OPEN_SHIFT", SHAPED_OPEN_SHIFT);
    whole("SHAPED_INSET", SHAPED_INSET);
    whole("COLLAR_AGAINST", COLLAR_AGAINST);
    whole("CREASE_CORNER_SHIFT", CREASE_CORNER_SHIFT);
    whole("TAPER_LOW_BITS", TAPER_LOW_BITS);
    whole("TAPER_NARROWS", TAPER_NARROWS);
    whole("ANCHOR_TAPER_SHIFT", ANCHOR_TAPER_SHIFT);
    whole("COLLAR_SHIFT", COLLAR_SHIFT);
    whole("BORDER_SHIFT", BORDER_SHIFT);
    whole("SHAPED_CREASE_SHIFT", SHAPED_CREASE_SHIFT);
    whole("POINT_NARROWS", POINT_NARROWS);
    whole("POINT_GOES_ON", POINT_GOES_ON);
    whole("POINTS_OF_SPHERE", POINTS_OF_SPHERE as u32);
    whole("PATCHES_OF_SPHERE", 4 * POINTS_OF_SPHERE as u32);
    whole("SPHERE_U32S", SPHERE_U32S as u32);
    whole("RADIUS_BASE", RADIUS_BASE);
    whole("ROLE_ORDINARY", Role::Ordinary as u32);
    whole("ROLE_END", Role::End as u32);
    whole("PATH_HERMITE", Path::Hermite as u32);
    whole("PATH_LINEAR", Path::Linear as u32);
    whole("CAPS_ROUND", Caps::Round as u32);
    whole("CAPS_FLAT", Caps::Flat as u32);
    whole("EDGE_RING", EDGE_RING);
    whole("EDGE_ALONG", EDGE_ALONG);
    whole("EDGE_SOMA", EDGE_SOMA);
    whole("EDGE_LOFT", EDGE_LOFT);
    whole("SIDE_KIND", SIDE_KIND);
    whole("SIDE_REVERSED", SIDE_REVERSED);
    whole("LEVELS_HOMOGENEOUS", LEVELS_HOMOGENEOUS);
    whole("LEVELS_PER_POINT", LEVELS_PER_POINT);
    whole("LEVELS_MAX_ERROR", LEVELS_MAX_ERROR);
    whole("LEVELS_DISTANCE", LEVELS_DISTANCE);
    whole("LEVELS_PIXEL_SIZE", LEVELS_PIXEL_SIZE);
    whole("LEVELS_PIXEL_ERROR", LEVELS_PIXEL_ERROR);
    let mut real = |name: &str, value: f32| constants.f32(name, value);
    real("MAX_OFFSET", MAX_OFFSET);
    real("MAX_SWAY", MAX_SWAY);
    real("SOMA_FILLET", SOMA_FILLET);
    real("LEAST_LIFT", LEAST_LIFT);
    real("BORDER_CUBIC", BORDER_CUBIC);
    real("CLEAR_OF_ROWS", CLEAR_OF_ROWS);
    real("STEEPEST_PROFILE", STEEPEST_PROFILE);
    real("SHARE", SHARE);
    real("SLACK", SLACK);
    real("STEEPEST", STEEPEST);
    real("POSITION_STEPS", POSITION_STEPS);
    real("MAX_HEIGHT", MAX_HEIGHT);
    real("CREASE_STEP", MAX_CREASE / CREASE_STEPS);
    real("TUBE_REACH", TUBE_REACH);
    real("SOMA_REACH", SOMA_REACH);
    real("SQRT_2", std::f32::consts::SQRT_2);
    real("HALF_PI", std::f32::consts::FRAC_PI_2);
    constants
}

/// A [`LodView`] for shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GpuLodView {
    /// See [`LodView`].
    pub eye: [f32; 3],
    /// See [`LodView`].
    pub slope: f32,
    /// See [`LodView`].
    pub forward: [f32; 3],
    /// See [`LodView`].
    pub flat: f32,
    /// See [`LodView`].
    pub near: f32,
    /// Padding to a multiple of 16 bytes.
    pub pad: [f32; 3],
}

impl From<LodView> for GpuLodView {
    fn from(view: LodView) -> Self {
        Self {
            eye: view.eye.to_array(),
            slope: view.slope,
            forward: view.forward.to_array(),
            flat: view.flat,
            near: view.near,
            pad: [0.0; 3],
        }
    }
}

/// [`LodCriterion`] and [`RefineOptions`] for shaders; the view is a [`GpuLodView`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GpuLodCriterion {
    /// Which criterion: a `LEVELS_…` constant.
    pub kind: u32,
    /// The criterion's level, if it has one.
    pub level: u32,
    /// The criterion's length (µm) or number of pixels, if it has one.
    pub amount: f32,
    /// A [`Path`].
    pub path: u32,
    /// The [`Caps`].
    pub caps: u32,
}

impl GpuLodCriterion {
    /// Translates a criterion. Levels per point are not part of it: they are stored with the
    /// points.
    pub fn new(criterion: LodCriterion, options: &RefineOptions) -> Self {
        let (kind, level, amount) = match criterion {
            LodCriterion::Homogeneous(level) => (LEVELS_HOMOGENEOUS, level, 0.0),
            LodCriterion::PerPoint => (LEVELS_PER_POINT, 1, 0.0),
            LodCriterion::MaxError(error) => (LEVELS_MAX_ERROR, 1, error),
            LodCriterion::Distance { level, far } => (LEVELS_DISTANCE, level, far),
            LodCriterion::PixelSize(pixels) => (LEVELS_PIXEL_SIZE, 1, pixels),
            LodCriterion::PixelError(pixels) => (LEVELS_PIXEL_ERROR, 1, pixels),
        };
        Self {
            kind,
            level,
            amount,
            path: options.path as u32,
            caps: options.caps as u32,
        }
    }
}

impl LodView {
    /// A view without perspective, with pixels of `size` µm.
    pub fn parallel(eye: Vec3, forward: Vec3, size: f32) -> Self {
        Self {
            eye,
            forward,
            slope: 0.0,
            flat: size,
            near: 0.0,
        }
    }
}
