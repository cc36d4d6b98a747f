//! Looking at a surface while it is read.

use std::sync::{Mutex, PoisonError};

use crate::{Extent, Surface, SurfaceVertex, Unsound, forward_surface};

/// A surface whose vertices are looked at as they are made, for whoever reads them anyway.
pub struct Watched<'a> {
    surface: &'a dyn Surface,
    extent: Mutex<Extent>,
}

impl<'a> Watched<'a> {
    /// Watches a surface.
    pub fn new(surface: &'a dyn Surface) -> Self {
        Self {
            surface,
            extent: Mutex::new(Extent::NONE),
        }
    }

    /// An error if what was made is no surface around its tracing. Surfaces that know no tracing are not judged.
    ///
    /// # Errors
    /// Says why.
    pub fn check(&self) -> Result<(), Unsound> {
        let extent = *self.extent.lock().unwrap_or_else(PoisonError::into_inner);
        let soundness = self.surface.soundness();
        soundness.map_or(Ok(()), |soundness| soundness.check(extent))
    }
}

impl Surface for Watched<'_> {
    forward_surface!(
        surface: origin unit regions soundness attributes vertex_count triangle_count
        quad_count vertex_blocks face_blocks faces
    );

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        let before = out.len();
        self.surface.vertices(block, out);
        let made = out[before..].iter();
        let made = made.fold(Extent::NONE, |extent, vertex| extent.with(vertex.position));
        let mut extent = self.extent.lock().unwrap_or_else(PoisonError::into_inner);
        *extent = extent.and(made);
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::{Faces, Soundness, Unit};

    /// A surface of one vertex here, whose tracing is within a micrometer of the origin.
    struct Far(Vec3);

    impl Surface for Far {
        fn origin(&self) -> DVec3 {
            DVec3::ZERO
        }
        fn soundness(&self) -> Option<Soundness> {
            Some(Soundness {
                volume: 1.0,
                reach: Extent::NONE.with(-Vec3::ONE).with(Vec3::ONE),
            })
        }
        fn vertex_count(&self) -> usize {
            1
        }
        fn triangle_count(&self) -> usize {
            0
        }
        fn quad_count(&self) -> usize {
            0
        }
        fn vertex_blocks(&self) -> usize {
            1
        }
        fn vertices(&self, _: usize, out: &mut Vec<SurfaceVertex>) {
            out.push(SurfaceVertex {
                position: self.0,
                normal: Vec3::X,
                ..SurfaceVertex::default()
            });
        }
        fn face_blocks(&self) -> usize {
            0
        }
        fn faces(&self, _: usize, _: &mut Faces) {}
    }

    #[test]
    fn no_format_takes_a_surface_that_is_far_from_its_tracing() {
        for format in crate::Format::ALL {
            let written = |x: f32, unit: Unit| {
                let far = Far(Vec3::X * x);
                let surface = crate::InUnit::new(&far, unit);
                let mut file = std::io::Cursor::new(Vec::new());
                crate::write(&surface, format, &mut file)
            };
            for unit in [Unit::Micrometer, Unit::Meter] {
                written(0.9, unit).expect("near");
                let error = written(1.1, unit).expect_err("far").to_string();
                assert!(error.contains("fault of neurotess"), "{format:?}: {error}");
            }
        }
    }
}
