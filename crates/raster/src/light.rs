//! How samples are lit. Twin of lighting.wgsl, and of the edges in shade.wgsl.

use glam::Vec3;
use neurotess_picture::{KEY, Light, Look, edge_color};

use crate::sample::Surface;

/// The lights of a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lights {
    /// Unit directions to the lights in the view; none: plain colors.
    key: Option<Vec3>,
    fill: Vec3,
    /// Color of edges.
    ink: [f32; 4],
}

/// How a surface is lit, whatever its color.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lit {
    /// Factor of the color.
    pub(crate) factor: f32,
    /// White that is added.
    pub(crate) white: f32,
    /// The normal that it was lit with.
    pub(crate) normal: Vec3,
}

impl Lights {
    pub(crate) fn new(look: &Look) -> Self {
        let key = match look.light {
            Light::Soft => Some(KEY),
            Light::From(direction) => Some(direction),
            Light::Flat => None,
        };
        Self {
            key: key.map(|key| key.normalize_or(KEY)),
            fill: Vec3::new(0.7, -0.35, 0.6).normalize_or(Vec3::X),
            ink: edge_color(look),
        }
    }

    /// Light on a surface. `to_eye`: unit direction in the view.
    pub(crate) fn on(&self, surface: Surface, to_eye: Vec3) -> Lit {
        let world = surface.normal();
        // A thin line is lit like a surface that faces the viewer.
        let n = world.lerp(to_eye, surface.thin()).normalize_or(to_eye);
        let Some(key) = self.key else {
            return Lit {
                factor: 1.0,
                white: 0.0,
                normal: n,
            };
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let lit = ((n.dot(key) + 0.3) / 1.3).max(0.0);
        let fill = n.dot(self.fill).max(0.0);
        let sky = 0.5 + 0.5 * n.y;
        let diffuse = 0.85 * lit * lit + 0.18 * fill + mix(0.22, 0.52, sky);
        let half = (key + to_eye).normalize_or(to_eye);
        let towards = n.dot(half).max(0.0);
        let p2 = towards * towards;
        let p10 = p2 * p2 * p2 * p2 * p2;
        let p20 = p10 * p10;
        let sheen = 0.045 * p10 + 0.05 * (p20 * p20 * p20);
        let grazing = 1.0 - n.dot(to_eye).max(0.0);
        let rim = 0.16 * grazing * grazing * grazing * mix(0.4, 1.0, sky);
        Lit {
            factor: diffuse + rim,
            white: sheen + 0.25 * rim,
            normal: n,
        }
    }

    /// Share of the edge's color where a color does not stand out at all: rises towards the outline.
    pub(crate) fn edge(&self, surface: Surface, to_eye: Vec3) -> f32 {
        if self.key.is_none() {
            return 0.0;
        }
        let facing = surface.normal().dot(to_eye);
        let across = (1.0 - facing * facing).max(0.0).sqrt();
        let t = ((across - 0.5) / 0.35).clamp(0.0, 1.0);
        0.7 * (t * t * (3.0 - 2.0 * t))
    }

    /// The color of a surface in this light.
    pub(crate) fn colored(&self, surface: Surface, lit: &Lit, to_eye: Vec3) -> [f32; 3] {
        let bare = surface.color().map(|c| c * lit.factor + lit.white);
        if surface.edge() == 0.0 {
            return bare;
        }
        let share = self.edge(surface, to_eye) * surface.edge();
        [0, 1, 2].map(|k| bare[k] + share * (self.ink[k] - bare[k]))
    }
}
