//! Where an instance is, which of its patches show, and at which levels. Twin of `decide` in render's cull.rs.

use glam::{Mat3, Vec3, Vec4};
use neurotess_mesh::{CoarseMesh, Patch};
use neurotess_picture::bounds::shows;
use neurotess_picture::{AdaptiveSettings, CullView, Instance};
use neurotess_refine::{Lod, LodView, patch_sphere};
use rayon::prelude::*;

use crate::painting::Painting;
use crate::scene::SceneTemplate;

/// An instance's transform, in 32 bits relative to the eye.
pub(crate) struct Placed {
    linear: Mat3,
    turn: Mat3,
    at: Vec3,
    pub(crate) scale: f32,
    view: LodView,
    planes: [Vec4; 5],
}

impl Placed {
    pub(crate) fn new(painting: &Painting<'_>, instance: &Instance, mesh: &CoarseMesh) -> Self {
        let placement = &instance.placement;
        let camera = &painting.view.camera;
        let [width, height] = painting.size.map(|n| n / painting.scale);
        // Levels go by whole pixels.
        let view = CullView::new(camera, width, height, painting.view.near);
        Self {
            linear: placement.linear().as_mat3(),
            turn: glam::DMat3::from_quat(placement.rotation).as_mat3(),
            // Subtracted in f64, where large coordinates cancel; the difference fits an f32.
            at: (placement.world_from_cell(mesh.origin) - camera.eye()).as_vec3(),
            scale: placement.scale as f32,
            view: view.local_view(placement, mesh.origin),
            planes: painting.frame().frustum(),
        }
    }

    /// A point of the mesh relative to the eye.
    pub(crate) fn relative(&self, p: Vec3) -> Vec3 {
        self.linear * p + self.at
    }

    /// A direction of the mesh in the world.
    pub(crate) fn turned(&self, v: Vec3) -> Vec3 {
        self.turn * v
    }

    /// What the levels of a template depend on here.
    pub(crate) fn lod<'a>(
        &self,
        settings: &AdaptiveSettings,
        template: &SceneTemplate<'a>,
    ) -> Lod<'a> {
        Lod {
            criterion: settings.lod.scaled(f64::from(self.scale)),
            view: self.view,
            point_levels: template.template.values,
            edges: None,
        }
    }

    /// Whether a sphere reaches into the frustum, with room for tubes that are widened.
    fn shows(&self, painting: &Painting<'_>, center: Vec3, radius: f32) -> bool {
        let center = self.relative(center);
        let radius = radius * self.scale;
        let depth = center.length() + radius;
        let widened = painting.projection.widest() * painting.projection.sub_pixel(depth);
        shows(&self.planes, center, radius + widened)
    }
}

/// Which patches of a template show; none if nothing does.
pub(crate) fn shown(
    template: &SceneTemplate<'_>,
    placed: &Placed,
    painting: &Painting<'_>,
) -> Option<Vec<bool>> {
    let mesh = template.template.mesh;
    let (center, radius) = template.sphere;
    if !placed.shows(painting, center, radius) {
        return None;
    }
    let shows = |patch: &Patch| {
        let (center, radius) = patch_sphere(mesh, patch);
        placed.shows(painting, center, radius)
    };
    let patches = mesh.patches.par_iter().with_min_len(4096);
    let shown: Vec<bool> = patches.map(shows).collect();
    shown.contains(&true).then_some(shown)
}
