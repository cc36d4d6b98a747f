//! The surface of a soma as it was traced, by its distance from a center.
//!
//! **Theory.** Whatever a file holds becomes a star-shaped body: a distance r(direction) about a center within it.
//!
//! | traced as | the body |
//! | --- | --- |
//! | one sample, three points | the sphere |
//! | one outline | circular cross-sections along its long axis, as NEURON reads it: [`outline`](super::outline) |
//! | outlines in a stack | the loft through all of them, with round caps: [`stack`](super::stack) |
//! | cylinders | the union of their frusta, with half-depth ends: [`cones`](super::cones); a short chain stands for a ball |
//! | samples on its surface | the sphere of their mean distance |
//! | a mesh beside the tracing | its own distances: [`triangles`](super::triangles) |
//!
//! Where a body is not star-shaped about any of its points, r is the outermost crossing; of cylinders this is told
//! ([`SomaShape::is_like_neurite`]), because they are better a thick neurite.
//!
//! **Practice.** A shape is made once for each soma; r takes 10 ns of a sphere and up to 3 µs of a stack.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::cones::{Cones, Ends};
use super::directions::{ByDirection, Directions};
use super::frusta::short_chain;
use super::outline::Outline;
use super::soma_area_volume;
use super::stack::Stack;
use super::triangles::{Hidden, SomaMeshError, Triangles};
use crate::{Soma, SomaKind, SomaSample};

/// A soma's surface as it was traced: its distance from a center in each direction. µm, relative to the
/// morphology's origin.
#[derive(Clone, Debug, PartialEq)]
pub struct SomaShape {
    center: DVec3,
    body: Body,
    volume: f64,
    area: f64,
    farthest: f64,
    stretch: DMat3,
    hidden: Option<Hidden>,
}

#[derive(Clone, Debug, PartialEq)]
enum Body {
    Sphere(f64),
    Outline(Box<Outline>),
    Stack(Stack),
    Cones(Cones),
    /// Frusta that fork or bend, made smooth: where faces meet there are edges that nothing in a soma is like.
    Forked(Cones, ByDirection),
    Triangles(Triangles),
}

/// Directions by whose distances volume and area are summed, along an edge of a cube: 864 hold the volume of an ellipsoid
/// of 3 : 1 : 1 to 0.1 %.
const SUMMED: u32 = 12;
/// Directions along an edge of a cube of frusta that fork, and the angle (radians) within which they are made smooth. By eye.
const SMOOTHED: u32 = 16;
const ROUNDED: f64 = 0.2;
/// Farthest over nearest distance from the center beyond which cylinders are a thick neurite: sampled by direction, what is
/// longer has too few samples at its ends. By eye, on capsules of 2 to 8 radii.
const LONGEST: f64 = 4.0;

impl SomaShape {
    /// The shape of a soma; that of one without extent is a sphere of radius 0.
    pub fn of(soma: &Soma) -> Self {
        let body = match soma.kind {
            SomaKind::Point | SomaKind::ThreePoint | SomaKind::Surface => None,
            SomaKind::Contour => of_outlines(soma),
            SomaKind::Cylinders => match short_chain(&soma.samples) {
                Some(_) => None,
                None => match Cones::new(&soma.samples, Ends::HalfDepth) {
                    Some((center, cones)) if cones.has_joints() => {
                        let mut shape = Self::forked(center, cones);
                        if soma.is_chain() {
                            shape.volume = soma_area_volume(soma).1;
                        }
                        return shape;
                    }
                    body => body.map(|(center, cones)| (center, Body::Cones(cones))),
                },
            },
        };
        let mut shape = match body {
            Some((center, body)) => Self::new(center, body),
            None => return Self::sphere(soma.center.as_dvec3(), f64::from(soma.radius)),
        };
        if soma.kind == SomaKind::Cylinders && soma.is_chain() {
            // Sums over directions miss a little of what is long.
            shape.volume = soma_area_volume(soma).1;
        }
        shape
    }

    /// The union of the frusta of linked samples, with flat faces where branches go on: a hub of thick branches. None of
    /// samples without extent.
    pub fn of_hub(samples: &[SomaSample]) -> Option<Self> {
        let (center, cones) = Cones::new(samples, Ends::Flat)?;
        Some(Self::forked(center, cones))
    }

    /// Frusta that fork: a smooth body with their volume.
    fn forked(center: DVec3, cones: Cones) -> Self {
        let smooth = ByDirection::smoothed(SMOOTHED, ROUNDED, |unit| cones.distance(center, unit));
        let exact = Self::new(center, Body::Cones(cones.clone()));
        let mut shape = Self::new(center, Body::Forked(cones, smooth));
        shape.volume = exact.volume;
        shape
    }

    /// A sphere.
    pub fn sphere(center: DVec3, radius: f64) -> Self {
        let radius = match radius.is_finite() {
            true => radius.max(0.0),
            false => 0.0,
        };
        Self {
            center,
            body: Body::Sphere(radius),
            volume: 4.0 / 3.0 * PI * radius.powi(3),
            area: 4.0 * PI * radius * radius,
            farthest: radius,
            stretch: DMat3::IDENTITY,
            hidden: None,
        }
    }

    /// The shape of a surface that goes around the soma, closed or with holes where neurites were cut off.
    /// `vertices` are µm, relative to the morphology's origin; triangles face outwards, or all inwards.
    ///
    /// # Errors
    /// The surface goes around nothing, or is not star-shaped by far; see [`hidden`](Self::hidden).
    pub fn from_mesh(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, SomaMeshError> {
        let cast = Triangles::cast(vertices, triangles)?;
        let mut shape = Self::new(cast.center, Body::Triangles(cast.body));
        shape.hidden = cast.hidden;
        Ok(shape)
    }

    fn new(center: DVec3, body: Body) -> Self {
        let mut shape = Self {
            center,
            body,
            volume: 0.0,
            area: 0.0,
            farthest: 0.0,
            stretch: DMat3::IDENTITY,
            hidden: None,
        };
        let directions = Directions::new(SUMMED);
        let distances: Vec<f64> = (directions.units.iter())
            .map(|&unit| shape.distance(unit))
            .collect();
        (shape.volume, shape.area) = directions.volume_and_area(&distances);
        shape.stretch = directions.stretch(&distances);
        // Corners between two directions: 7.5° off, at most.
        shape.farthest = 1.1 * distances.iter().copied().fold(0.0, f64::max);
        shape
    }

    /// The place that the surface is seen from.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Volume (µm³).
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Area (µm²).
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Radius (µm) of the sphere of equal volume.
    pub fn radius(&self) -> f64 {
        (self.volume * 0.75 / PI).cbrt()
    }

    /// A distance (µm) from the center that no part of the surface is beyond, or hardly.
    pub fn farthest(&self) -> f64 {
        self.farthest
    }

    /// A map of directions that brings more of them to where the surface is far: a sphere of directions is
    /// about evenly dense on the surface once it is mapped. Symmetric and positive definite.
    pub fn stretch(&self) -> DMat3 {
        self.stretch
    }

    /// Distance (µm) of the surface along a unit direction once the shape is larger by a factor: of one outline, deeper,
    /// so that its silhouette stays.
    pub fn distance_of_size(&self, direction: DVec3, size: f64) -> f64 {
        let Body::Outline(outline) = &self.body else {
            return size * self.distance(direction);
        };
        let depth = direction.dot(outline.normal());
        let before = direction + outline.normal() * (depth / size - depth);
        let length = before.length();
        outline.distance(before / length) / length
    }

    /// Power of the size that the volume grows by.
    pub fn grows_by(&self) -> f64 {
        match self.body {
            Body::Outline(_) => 1.0,
            Body::Sphere(_)
            | Body::Stack(_)
            | Body::Cones(_)
            | Body::Forked(..)
            | Body::Triangles(_) => 3.0,
        }
    }

    /// What of a mesh the center does not see, where it has another distance than its outermost one.
    pub fn hidden(&self) -> Option<Hidden> {
        self.hidden
    }

    /// Whether it is a sphere.
    pub fn is_sphere(&self) -> bool {
        matches!(self.body, Body::Sphere(_))
    }

    /// Distance (µm) of the surface from the center along a unit direction.
    pub fn distance(&self, direction: DVec3) -> f64 {
        match &self.body {
            Body::Sphere(radius) => *radius,
            Body::Outline(outline) => outline.distance(direction),
            Body::Stack(stack) => stack.distance(direction),
            Body::Cones(cones) => cones.distance(self.center, direction),
            Body::Forked(_, smooth) => smooth.at(direction),
            Body::Triangles(triangles) => triangles.distance(direction),
        }
    }

    /// Whether it was traced as a neurite is: cylinders along branches, around bends, or much longer than they are
    /// thick, of which no star about a point is a good picture.
    pub fn is_like_neurite(&self) -> bool {
        let (Body::Cones(cones) | Body::Forked(cones, _)) = &self.body else {
            return false;
        };
        let directions = Directions::new(SUMMED);
        let distances = directions.units.iter();
        let distances = distances.map(|&unit| cones.distance(self.center, unit));
        let (least, most) = distances.fold((f64::INFINITY, 0.0_f64), |(least, most), r| {
            (least.min(r), most.max(r))
        });
        most > LONGEST * least || !cones.is_star(self.center, &directions)
    }
}

/// The body of outlines that go around something.
fn of_outlines(soma: &Soma) -> Option<(DVec3, Body)> {
    let outlines = soma.outlines();
    match &outlines[..] {
        [] => None,
        [outline] => {
            let (center, outline) = Outline::new(outline)?;
            Some((center, Body::Outline(Box::new(outline))))
        }
        _ => {
            if let Some((center, stack)) = Stack::new(&outlines) {
                return Some((center, Body::Stack(stack)));
            }
            let mut outlines = outlines.iter().filter_map(|outline| Outline::new(outline));
            let (center, outline) = outlines.next()?;
            Some((center, Body::Outline(Box::new(outline))))
        }
    }
}

#[cfg(test)]
mod tests;
