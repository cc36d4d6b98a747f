//! How a camera projects, and the size of a pixel that follows from it.

/// Whether things look smaller the farther away they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// They do, as to an eye.
    #[default]
    Perspective,
    /// They do not: lengths across the direction of view are true everywhere.
    Orthographic,
}

/// How a camera projects.
///
/// Both projections have an angle. Where an orthographic camera and a perspective one have the same
/// angle, eye and target, their pictures have the same scale at the target; so one can be exchanged
/// for the other, and moving nearer enlarges both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Vertical angle of view (radians). An orthographic picture is as high as what a perspective
    /// camera of this angle shows at its target.
    pub fov: f64,
    /// The projection.
    pub projection: Projection,
}

impl Lens {
    /// Tangent of half the angle: of libm, since those of platforms differ in the last bit.
    pub(crate) fn tan(&self) -> f64 {
        libm::tan(self.fov / 2.0)
    }

    /// An orthographic lens of this angle (radians).
    pub fn orthographic(fov: f64) -> Self {
        Self {
            fov,
            projection: Projection::Orthographic,
        }
    }
}

/// A perspective lens of this angle (radians).
impl From<f64> for Lens {
    fn from(fov: f64) -> Self {
        Self {
            fov,
            projection: Projection::Perspective,
        }
    }
}

/// Size of a pixel (µm) by depth: `slope · depth + flat`, of which one is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelSize {
    /// What each µm of depth adds: 0 without perspective.
    pub slope: f64,
    /// What it is at every depth (µm): 0 with perspective.
    pub flat: f64,
}

impl PixelSize {
    /// Size (µm) of a pixel at a depth (µm).
    pub fn at(&self, depth: f64) -> f64 {
        self.slope * depth + self.flat
    }

    /// Size of this many pixels.
    pub fn times(&self, pixels: f64) -> Self {
        Self {
            slope: self.slope * pixels,
            flat: self.flat * pixels,
        }
    }
}
