//! A soma as its neurites meet it.

use std::sync::Arc;

use glam::DVec3;
use neurotess_morphology::SomaShape;

/// A soma as the neurites meet it: its surface as it was traced, and the sphere of the same volume.
#[derive(Clone, Debug)]
pub(crate) struct SomaSphere {
    pub(crate) center: DVec3,
    /// Radius of the sphere.
    pub(crate) radius: f64,
    /// Farthest distance of a first ring without a request, in distances of the surface.
    pub(crate) reach: f64,
    shape: Arc<SomaShape>,
    /// Size of the soma, of the shape's.
    scale: f64,
    farthest: f64,
    hillocks: f64,
    /// Centers of first rings, with the normals of their planes.
    rings: Vec<[DVec3; 2]>,
    /// Parts of neurites outside: places about the center, and volumes (µm³).
    stubs: Vec<(DVec3, f64)>,
}

impl SomaSphere {
    /// `scale`: factor on the shape.
    pub(crate) fn new(shape: Arc<SomaShape>, scale: f64, reach: f64) -> Self {
        Self {
            center: shape.center(),
            radius: shape.radius() * scale,
            reach,
            farthest: scale * shape.farthest(),
            hillocks: 1.0,
            rings: Vec::new(),
            stubs: Vec::new(),
            shape,
            scale,
        }
    }

    /// The sphere of the same volume.
    pub(crate) fn rounded(&self, reach: f64) -> Self {
        let sphere = SomaShape::sphere(self.center, self.radius);
        Self {
            stubs: self.stubs.clone(),
            ..Self::new(Arc::new(sphere), 1.0, reach)
        }
    }

    /// Distance of the surface from the center along a unit direction.
    pub(crate) fn surface(&self, direction: DVec3) -> f64 {
        self.scale * self.shape.distance(direction)
    }

    /// Distance of the surface once it is larger by a factor.
    pub(crate) fn surface_of_size(&self, direction: DVec3, size: f64) -> f64 {
        self.scale * self.shape.distance_of_size(direction, size)
    }

    /// What was traced.
    pub(crate) fn shape(&self) -> &SomaShape {
        &self.shape
    }

    /// Distance of the surface from the center towards a place.
    pub(crate) fn towards(&self, place: DVec3) -> f64 {
        self.surface(self.direction(place))
    }

    /// A distance from the center that no part of the surface is beyond.
    pub(crate) fn farthest(&self) -> f64 {
        self.farthest
    }

    /// Unit direction of a place from the center.
    pub(crate) fn direction(&self, place: DVec3) -> DVec3 {
        (place - self.center).try_normalize().unwrap_or(DVec3::Y)
    }

    /// Share of their height that hillocks have, less where rings are nearer than usual.
    pub(crate) fn hillocks(&self) -> f64 {
        self.hillocks
    }

    /// Says where first rings are: their centers and the normals of their planes.
    pub(crate) fn set_rings(&mut self, rings: Vec<[DVec3; 2]>) {
        self.rings = rings;
    }

    /// Says what was traced of neurites next to it: places about the center, and volumes (µm³).
    pub(crate) fn set_stubs(&mut self, stubs: Vec<(DVec3, f64)>) {
        self.stubs = stubs;
    }

    /// What was traced of neurites next to it.
    pub(crate) fn stubs(&self) -> &[(DVec3, f64)] {
        &self.stubs
    }

    /// Unit normal of the plane of the first ring with this center, away from the soma.
    pub(crate) fn axis(&self, ring: DVec3) -> DVec3 {
        let off = |[center, _]: &&[DVec3; 2]| center.distance_squared(ring);
        let nearest = self.rings.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.map_or_else(|| self.direction(ring), |[_, axis]| *axis)
    }

    /// Moves rings nearer: to this share of their distance from the surface.
    pub(crate) fn set_share(&mut self, farthest: f64, share: f64) {
        self.reach = 1.0 + (farthest - 1.0) * share;
        self.hillocks = share;
    }

    /// Whether it is a sphere.
    pub(crate) fn is_sphere(&self) -> bool {
        self.shape.is_sphere()
    }

    /// Volume (µm³) and area (µm²) as traced, without neurites.
    pub(crate) fn traced(&self) -> (f64, f64) {
        let square = self.scale * self.scale;
        (
            self.shape.volume() * square * self.scale,
            self.shape.area() * square,
        )
    }
}
