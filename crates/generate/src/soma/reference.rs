//! What somata are before neurites draw them out: spheres, what was traced, or a mesh that is given; which are none.

use std::sync::Arc;

use glam::DVec3;
use neurotess_morphology::{Hidden, Morphology, Soma, SomaKind, SomaShape};

use crate::tracing::{Root, Skeleton, SomaSphere};
use crate::warning::Warnings;
use crate::{GenerateOptions, SomaMethod};

/// Which somata were traced as neurites are, and are meshed as such.
#[derive(Debug, Default)]
pub(crate) struct AsNeurites {
    /// By soma.
    pub(crate) is: Vec<bool>,
    /// The shapes of those that might have been and are not: to find one takes longer than to read a small cell.
    shapes: Vec<Option<SomaShape>>,
}

impl AsNeurites {
    pub(crate) fn new(
        morphology: &Morphology,
        options: &GenerateOptions,
        warnings: &mut Warnings,
    ) -> Self {
        let shaped = shaped(morphology, options);
        let mut found = Self::default();
        for (index, soma) in morphology.somata.iter().enumerate() {
            let may_be = options.soma == SomaMethod::Fem
                && shaped != Some(index)
                && soma.kind == SomaKind::Cylinders
                && soma.radius > 0.0;
            let shape = may_be.then(|| SomaShape::of(soma));
            let is = shape.as_ref().is_some_and(SomaShape::is_like_neurite);
            if is {
                warnings.add(
                    "soma_as_neurite",
                    soma.samples.first().map(|sample| sample.id),
                    "soma was traced along branches, or is long and bent: meshed as a thick neurite",
                );
            }
            found.is.push(is);
            found.shapes.push(shape.filter(|_| !is));
        }
        found
    }
}

/// The soma that the given shape stands for.
fn shaped(morphology: &Morphology, options: &GenerateOptions) -> Option<usize> {
    let center = options.soma_shape.as_ref()?.center();
    let off = |soma: &Soma| soma.center.as_dvec3().distance_squared(center);
    let somata = morphology.somata.iter().enumerate();
    let nearest = somata.min_by(|(_, a), (_, b)| off(a).total_cmp(&off(b)));
    nearest.map(|(index, _)| index)
}

/// The sphere of each soma that is to be meshed, but of those that are neurites.
pub(crate) fn soma_spheres(
    morphology: &Morphology,
    skeleton: &Skeleton,
    as_neurites: AsNeurites,
    options: &GenerateOptions,
    warnings: &mut Warnings,
) -> Vec<Option<SomaSphere>> {
    let starts = starts(skeleton, morphology.somata.len());
    let shaped = shaped(morphology, options);
    let reach = match options.soma {
        SomaMethod::Fem => FEM_REACH,
        SomaMethod::Sphere => 1.0,
        SomaMethod::Profile => PROFILE_REACH,
        SomaMethod::None => return vec![None; morphology.somata.len()],
    };
    let soma_sphere = |((index, soma), found): ((usize, &Soma), Option<SomaShape>)| {
        if as_neurites.is[index] {
            return None;
        }
        let (center, radius) = (soma.center.as_dvec3(), f64::from(soma.radius));
        let given = options.soma_shape.as_ref();
        let given = given.filter(|_| options.soma == SomaMethod::Fem && shaped == Some(index));
        if let Some(given) = given {
            if let Some(hidden) = given.hidden() {
                warnings.add("soma_hidden", None, &hidden_from_center(hidden));
            }
            return Some(SomaSphere::new(
                Arc::clone(given),
                options.soma_scale,
                reach,
            ));
        }
        let shape = match options.soma {
            _ if !(radius.is_finite() && radius > 0.0) => {
                warnings.add(
                    "soma_radius_mended",
                    soma.samples.first().map(|s| s.id),
                    "soma has no radius: taken from where its neurites start",
                );
                let radius = radius_from_neurites(skeleton, &starts[index], center);
                SomaShape::sphere(center, radius)
            }
            SomaMethod::Fem => found.unwrap_or_else(|| SomaShape::of(soma)),
            SomaMethod::Sphere | SomaMethod::Profile | SomaMethod::None => {
                SomaShape::sphere(center, radius)
            }
        };
        Some(SomaSphere::new(Arc::new(shape), options.soma_scale, reach))
    };
    let somata = morphology.somata.iter().enumerate();
    somata.zip(as_neurites.shapes).map(soma_sphere).collect()
}

fn hidden_from_center(hidden: Hidden) -> String {
    let Hidden { share, place } = hidden;
    format!(
        "the soma's mesh is not quite star-shaped: {:.1} % of what is within it, seen from its middle, is outside, most of it near \
         ({:.2}, {:.2}, {:.2}) µm from the tracing's origin",
        100.0 * share,
        place.x,
        place.y,
        place.z
    )
}

/// Farthest first ring of an elastic soma, in radii: beyond, the pull inverts tetrahedra. Chosen by
/// eye among 1.2 to 1.6: farther ones look like stars.
pub(super) const FEM_REACH: f64 = 1.35;
/// LiveMesh's: the tube has its own radius from 1.5 R on.
const PROFILE_REACH: f64 = 1.5;

/// First nodes of each soma's neurites.
fn starts(skeleton: &Skeleton, somata: usize) -> Vec<Vec<u32>> {
    let mut starts = vec![Vec::new(); somata];
    for (index, node) in skeleton.nodes().iter().enumerate() {
        if let Root::Soma(soma) = node.root {
            starts[soma as usize].push(index as u32);
        }
    }
    starts
}

/// A radius for a soma that has none: half-way to the nearest start of a neurite, and no thinner
/// than the thickest of them.
fn radius_from_neurites(skeleton: &Skeleton, starts: &[u32], center: DVec3) -> f64 {
    let (mut nearest, mut thickest) = (f64::INFINITY, 0.0_f64);
    for &start in starts {
        let start = skeleton.node(start);
        nearest = nearest.min(start.center.distance(center));
        thickest = thickest.max(start.radius);
    }
    let half = if nearest.is_finite() {
        0.5 * nearest
    } else {
        0.0
    };
    half.min(10.0).max(1.5 * thickest).max(0.5)
}
