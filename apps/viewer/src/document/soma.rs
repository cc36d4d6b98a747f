//! How a soma is made.

use neurotess::generate::{GenerateOptions, SomaMethod, SphereKind};
use serde::{Deserialize, Serialize};

/// How a soma is made.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SomaEdit {
    /// The method.
    pub method: Method,
    /// Poisson's ratio, 0 to 0.49.
    pub poisson: f64,
    /// Factor on the radius.
    pub scale: f64,
    /// The paper's octahedron instead of a cube.
    pub octahedron: bool,
    /// Resolution of the reference sphere; 0: what fits.
    pub level: u32,
}

/// How a soma is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// A sphere deformed by elasticity.
    #[default]
    Elastic,
    /// A sphere.
    Sphere,
    /// LiveMesh's radius function.
    Profile,
    /// None.
    None,
}

impl Default for SomaEdit {
    fn default() -> Self {
        Self {
            method: Method::Elastic,
            poisson: 0.3,
            scale: 1.0,
            octahedron: false,
            level: 0,
        }
    }
}

impl SomaEdit {
    /// What the generator is told.
    pub fn options(&self) -> GenerateOptions {
        GenerateOptions {
            soma: match self.method {
                Method::Elastic => SomaMethod::Fem,
                Method::Sphere => SomaMethod::Sphere,
                Method::Profile => SomaMethod::Profile,
                Method::None => SomaMethod::None,
            },
            poisson: self.poisson.clamp(0.0, 0.49),
            soma_scale: self.scale.clamp(0.05, 20.0),
            sphere: match self.octahedron {
                true => SphereKind::Octahedron,
                false => SphereKind::Cube,
            },
            sphere_level: (self.level > 0).then(|| {
                let (low, high) = self.levels();
                self.level.clamp(low, high)
            }),
            kinds: None,
        }
    }

    /// Least and greatest resolution of the sphere.
    pub fn levels(&self) -> (u32, u32) {
        if self.octahedron { (1, 5) } else { (2, 32) }
    }
}
