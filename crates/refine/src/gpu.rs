//! What shaders share with this crate: constants, structs and the twins of its functions.
//!
//! A shader is composed by joining [`prelude`], [`EVALUATE_WGSL`], [`LEVEL_WGSL`],
//! [`TEMPLATE_WGSL`], [`PLAN_WGSL`] and a source of corners with its own text: [`compose`]. Constants go one
//! way, from Rust into the prelude; layouts are compared field by field in `tests/shaders.rs`.

use std::fmt::Write;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use neurotess_mesh::{PatchKind, Role};

use crate::ball::{SOMA_REACH, TUBE_REACH};
use crate::decode::{
    BALL_WORDS, LOOSE, POINT_END, POINT_GOES_ON, POINT_KIND_SHIFT, POINT_LOOSE, POINT_NARROWS,
    POINTS_OF_BALL, POSITION_STEPS, RADIUS_BASE,
};
use crate::evaluate::MOST_SWAY;
use crate::level::{HIGHEST_LEVEL, SHARE, SLACK, STEEPEST};
use crate::{Caps, Levels, Path, RefineOptions, View};

/// Twin of `evaluate.rs`.
pub const EVALUATE_WGSL: &str = include_str!("evaluate.wgsl");
/// Twin of `level.rs`.
pub const LEVEL_WGSL: &str = include_str!("level.wgsl");
/// The layout of resident data, twin of `decode.rs`; binds group 0, binding 0.
pub const TEMPLATE_WGSL: &str = include_str!("template.wgsl");
/// Twin of `plan.rs`.
pub const PLAN_WGSL: &str = include_str!("plan.wgsl");

const EDGE_RING: u32 = 0;
const EDGE_ALONG: u32 = 1;
const EDGE_SOMA: u32 = 2;
const SIDE_KIND: u32 = 3;
const SIDE_REVERSED: u32 = 4;
const LEVELS_HOMOGENEOUS: u32 = 0;
const LEVELS_PER_POINT: u32 = 1;
const LEVELS_MAX_ERROR: u32 = 2;
const LEVELS_DISTANCE: u32 = 3;
const LEVELS_PIXEL_SIZE: u32 = 4;
const LEVELS_PIXEL_ERROR: u32 = 5;

/// Corners as they are resident, for whoever has no others: see [`compose`].
pub const SOURCE_WGSL: &str = include_str!("source.wgsl");

/// A shader's whole text: constants, the twins, and what is its own, in which `Source`, `base_of` and
/// `corner_of` say where patches have their corners from; [`SOURCE_WGSL`] is one such text.
pub fn compose(own: &[&str]) -> String {
    let mut text = prelude();
    for part in [EVALUATE_WGSL, LEVEL_WGSL, TEMPLATE_WGSL, PLAN_WGSL] {
        text.push_str(part);
    }
    own.iter().for_each(|part| text.push_str(part));
    text
}

/// The constants, as WGSL.
pub fn prelude() -> String {
    let mut text = String::new();
    let mut whole = |name: &str, value: u32| {
        // Writing to a String does not fail.
        let _ = writeln!(text, "const {name}: u32 = {value}u;");
    };
    whole("HIGHEST_LEVEL", HIGHEST_LEVEL);
    whole("ROLE_JOINT", Role::Joint as u32);
    whole("ROLE_SOMA", Role::Soma as u32);
    whole("PATCH_LATERAL", PatchKind::Lateral as u32);
    whole("PATCH_CAP", PatchKind::Cap as u32);
    whole("PATCH_SOMA", PatchKind::Soma as u32);
    whole("LOOSE", LOOSE);
    whole("POINT_KIND_SHIFT", POINT_KIND_SHIFT);
    whole("POINT_END", POINT_END);
    whole("POINT_LOOSE", POINT_LOOSE);
    whole("POINT_NARROWS", POINT_NARROWS);
    whole("POINT_GOES_ON", POINT_GOES_ON);
    whole("POINTS_OF_BALL", POINTS_OF_BALL as u32);
    whole("PLACES_OF_BALL", 4 * POINTS_OF_BALL as u32);
    whole("BALL_WORDS", BALL_WORDS as u32);
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
    whole("SIDE_KIND", SIDE_KIND);
    whole("SIDE_REVERSED", SIDE_REVERSED);
    whole("LEVELS_PER_POINT", LEVELS_PER_POINT);
    whole("LEVELS_MAX_ERROR", LEVELS_MAX_ERROR);
    whole("LEVELS_DISTANCE", LEVELS_DISTANCE);
    whole("LEVELS_PIXEL_SIZE", LEVELS_PIXEL_SIZE);
    whole("LEVELS_PIXEL_ERROR", LEVELS_PIXEL_ERROR);
    let mut real = |name: &str, value: f32| {
        let _ = writeln!(text, "const {name}: f32 = {value:?};");
    };
    real("MOST_SWAY", MOST_SWAY);
    real("SHARE", SHARE);
    real("SLACK", SLACK);
    real("STEEPEST", STEEPEST);
    real("POSITION_STEPS", POSITION_STEPS);
    real("TUBE_REACH", TUBE_REACH);
    real("SOMA_REACH", SOMA_REACH);
    real("SQRT_2", std::f32::consts::SQRT_2);
    real("HALF_PI", std::f32::consts::FRAC_PI_2);
    text
}

/// A [`View`] as shaders have it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GpuView {
    /// See [`View`].
    pub eye: [f32; 3],
    /// See [`View`].
    pub slope: f32,
    /// See [`View`].
    pub forward: [f32; 3],
    /// See [`View`].
    pub flat: f32,
    /// See [`View`].
    pub near: f32,
    /// To a multiple of 16 bytes.
    pub pad: [f32; 3],
}

impl From<View> for GpuView {
    fn from(view: View) -> Self {
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

/// [`Levels`] and [`RefineOptions`] as shaders have them; the view stands in a [`GpuView`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Criterion {
    /// Which.
    pub kind: u32,
    /// Level of those that have one.
    pub level: u32,
    /// Length (µm) or pixels of those that have one.
    pub amount: f32,
    /// Course of the path.
    pub path: u32,
    /// Shape of the ends.
    pub caps: u32,
}

impl Criterion {
    /// Translates levels; those per point travel in the tracing points themselves.
    pub fn new(levels: &Levels<'_>, options: &RefineOptions) -> Self {
        let (kind, level, amount) = match *levels {
            Levels::Homogeneous(level) => (LEVELS_HOMOGENEOUS, level, 0.0),
            Levels::PerPoint(_) => (LEVELS_PER_POINT, 1, 0.0),
            Levels::MaxError(error) => (LEVELS_MAX_ERROR, 1, error),
            Levels::Distance { level, far, .. } => (LEVELS_DISTANCE, level, far),
            Levels::PixelSize { pixels, .. } => (LEVELS_PIXEL_SIZE, 1, pixels),
            Levels::PixelError { pixels, .. } => (LEVELS_PIXEL_ERROR, 1, pixels),
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

impl Levels<'_> {
    /// The view that levels are chosen from, if they depend on one.
    pub fn view(&self) -> Option<View> {
        match *self {
            Levels::Distance { view, .. }
            | Levels::PixelSize { view, .. }
            | Levels::PixelError { view, .. } => Some(view),
            Levels::Homogeneous(_) | Levels::PerPoint(_) | Levels::MaxError(_) => None,
        }
    }
}

impl View {
    /// A view without perspective whose pixels are `size` µm wide, of anything at the eye's depth
    /// or beyond.
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
