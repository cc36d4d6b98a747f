//! What a surface that changes little of another one has from it.

/// Methods of [`Surface`](crate::Surface), by name, that are those of a field: a surface made of another one writes out
/// only what it changes.
///
/// ```
/// use neurotess_mesh::{Faces, Surface, SurfaceVertex, forward_surface};
///
/// /// A surface that is seen from within.
/// struct Inverted<'a>(&'a dyn Surface);
///
/// impl Surface for Inverted<'_> {
///     forward_surface!(0: origin unit vertex_count triangle_count quad_count vertex_blocks vertices face_blocks);
///
///     fn faces(&self, block: usize, out: &mut Faces) {
///         let (triangles, quads) = (out.triangles.len(), out.quads.len());
///         self.0.faces(block, out);
///         out.triangles[triangles..].iter_mut().for_each(|face| face.reverse());
///         out.quads[quads..].iter_mut().for_each(|face| face.reverse());
///     }
/// }
/// ```
#[macro_export]
macro_rules! forward_surface {
    ($under:tt: $($method:ident)+) => {
        $($crate::forward_surface!(@ $under $method);)+
    };
    (@ $under:tt origin) => {
        fn origin(&self) -> $crate::glam::DVec3 {
            self.$under.origin()
        }
    };
    (@ $under:tt unit) => {
        fn unit(&self) -> $crate::Unit {
            self.$under.unit()
        }
    };
    (@ $under:tt regions) => {
        fn regions(&self) -> Vec<$crate::Region> {
            self.$under.regions()
        }
    };
    (@ $under:tt soundness) => {
        fn soundness(&self) -> Option<$crate::Soundness> {
            self.$under.soundness()
        }
    };
    (@ $under:tt attributes) => {
        fn attributes(&self) -> &[$crate::VertexAttribute<'_>] {
            self.$under.attributes()
        }
    };
    (@ $under:tt vertices) => {
        fn vertices(&self, block: usize, out: &mut Vec<$crate::SurfaceVertex>) {
            self.$under.vertices(block, out);
        }
    };
    (@ $under:tt faces) => {
        fn faces(&self, block: usize, out: &mut $crate::Faces) {
            self.$under.faces(block, out);
        }
    };
    (@ $under:tt $count:ident) => {
        fn $count(&self) -> usize {
            self.$under.$count()
        }
    };
}
