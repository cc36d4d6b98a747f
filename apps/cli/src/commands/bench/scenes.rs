//! The scenes that are drawn: neurons, their placements and the camera.

use glam::DVec3;
use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::{CoarseMesh, Role};
use neurotess::render::bounds::{bounds, merged};
use neurotess::render::color::{ColorTable, Palette, category};
use neurotess::render::{BoundingSphere, Camera, Frame, Side};
use neurotess::synth::{Kind, Options, grow};
use rayon::prelude::*;

/// Distance (µm) of neighboring neurons: so near that their dendrites meet.
pub(super) const APART: f64 = 120.0;
/// Field of view (radians): wide, so that some neurons are near and others far.
pub(super) const FOV: f64 = 60.0 * std::f64::consts::PI / 180.0;
/// Number of types with a color of their own; others have the color of the last.
const TYPES: i32 = 8;

/// A neuron and its colors.
pub(crate) struct Neuron {
    pub(crate) mesh: CoarseMesh,
    pub(crate) color_keys: Vec<u32>,
    spheres: Vec<BoundingSphere>,
    /// A single sphere around them.
    whole: Vec<BoundingSphere>,
    /// Translation (µm) that moves its soma to the origin.
    to_origin: DVec3,
}

/// Grows and meshes distinct neurons of all kinds.
pub(crate) fn neurons(distinct: u32, points: u32) -> Vec<Neuron> {
    (0..distinct)
        .into_par_iter()
        .map(|seed| {
            let kind = Kind::ALL[seed as usize % Kind::ALL.len()];
            let mut options = Options::new(kind, u64::from(seed) + 1);
            options.points = Some(points as usize);
            let morphology = grow(&options);
            let soma = morphology.soma().map(|soma| soma.center.as_dvec3());
            let mesh = generate(&morphology, &GenerateOptions::default())
                .expect("a synthetic cell is within 32 bits")
                .mesh;
            let spheres = bounds(&mesh);
            Neuron {
                color_keys: color_keys(&mesh),
                whole: merged(&spheres, 1),
                spheres,
                to_origin: -(mesh.origin + soma.unwrap_or(DVec3::ZERO)),
                mesh,
            }
        })
        .collect()
}

fn color_keys(mesh: &CoarseMesh) -> Vec<u32> {
    let color_key = |point: &neurotess::mesh::TracingPoint| match point.role {
        Role::Soma => category(1),
        _ => category(point.kind.0.clamp(0, TYPES - 1) as u32),
    };
    mesh.tracing.iter().map(color_key).collect()
}

/// Colors of types.
pub(crate) fn colors() -> ColorTable {
    let of_type = |kind| match kind {
        1 => Palette::NeuroM.of_soma(Some([255; 3])),
        _ => Palette::NeuroM.of_type(kind),
    };
    ColorTable {
        scale: Vec::new(),
        categories: (0..TYPES).map(of_type).collect(),
        ..ColorTable::default()
    }
}

/// A scene: neurons on a square grid in the plane, seen as a whole.
pub(crate) struct BenchScene {
    /// Index of the neuron, and the translation (µm) added to its coordinates.
    pub(crate) placements: Vec<(usize, DVec3)>,
    pub(crate) frame: Frame,
    /// Distance (µm) from the eye to the farthest neuron.
    pub(crate) far: f64,
}

/// Most neurons that the camera is fitted to in parts.
const MAX_IN_PARTS: u32 = 20_000;

impl BenchScene {
    pub(crate) fn new(neurons: &[Neuron], count: u32, size: [u32; 2]) -> anyhow::Result<Self> {
        let side = f64::from(count).sqrt().ceil() as u32;
        let placements: Vec<(usize, DVec3)> = (0..count)
            .map(|i| {
                let neuron = i as usize % neurons.len();
                let middle = f64::from(side - 1) / 2.0;
                let [x, z] = [i % side, i / side].map(|n| (f64::from(n) - middle) * APART);
                (neuron, DVec3::new(x, 0.0, z) + neurons[neuron].to_origin)
            })
            .collect();
        let spheres: Vec<BoundingSphere> = placements
            .iter()
            .flat_map(|&(neuron, translation)| {
                let neuron = &neurons[neuron];
                // Spheres of parts fit the picture tightly, and take gigabytes for a million.
                let spheres = match count > MAX_IN_PARTS {
                    true => &neuron.whole,
                    false => &neuron.spheres,
                };
                spheres
                    .iter()
                    .map(move |&(center, radius)| (center + translation, radius))
            })
            .collect();
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let camera = Camera::fit(Side::Iso, FOV, aspect, 0.02, &spheres)?;
        let distance = |&(center, radius): &BoundingSphere| center.distance(camera.eye()) + radius;
        Ok(Self {
            frame: Frame::whole(camera, camera.near(&spheres), size),
            far: spheres.iter().map(distance).fold(0.0, f64::max),
            placements,
        })
    }
}
