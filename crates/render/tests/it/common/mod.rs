//! Cells with every kind of patch.

pub(crate) mod draw;
#[path = "../../../../refine/tests/it/trees.rs"]
pub(crate) mod trees;

use glam::{DVec3, Vec3};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{CoarseMesh, PatchKind, Role};
use neurotess_morphology::{
    Attachment, Morphology, NeuriteKind, Point, Section, SectionId, Soma, SomaKind, SomaSample,
};
use neurotess_render::{Camera, CullView};
use trees::{Twig, grow};

/// Splitmix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn whole(&mut self, below: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % below
    }

    pub(crate) fn real(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.whole(1 << 53) as f64 / (1_u64 << 53) as f64)
    }

    pub(crate) fn direction(&mut self) -> DVec3 {
        let mut real = || self.real(-1.0, 1.0);
        DVec3::new(real(), real(), real()).normalize_or(DVec3::X)
    }
}

/// A cell with a soma of radius 6 µm, joints, bends and ends, from a seed.
pub(crate) fn cell(seed: u64, twigs: usize) -> CoarseMesh {
    let mut random = Random(seed);
    let twigs: Vec<Twig> = (0..twigs)
        .map(|i| Twig {
            parent: if i < 4 {
                i
            } else {
                random.whole(i as u64) as usize
            },
            seed: random.whole(u64::MAX),
            points: 2 + random.whole(7) as usize,
            step: random.real(1.5, 6.0) as f32,
            wild: random.real(0.1, 0.5) as f32,
            radius: random.real(0.3, 1.2) as f32,
        })
        .collect();
    let mesh = generate(&grow(&twigs, Some(6.0)), &GenerateOptions::default())
        .expect("meshed")
        .mesh;
    for kind in [PatchKind::Lateral, PatchKind::Cap, PatchKind::Soma] {
        assert!(mesh.patches.iter().any(|p| p.kind == kind), "{kind:?}");
    }
    assert!(
        mesh.tracing
            .iter()
            .any(|t| matches!(t.role, Role::Joint | Role::Inset)),
        "no fork"
    );
    mesh
}

/// A cell whose neurites end in forks with the children straight to either side: the children are the trunk, and the
/// neurite ends in an inset on it.
pub(crate) fn cell_across() -> CoarseMesh {
    let mut cell = round_soma("across");
    for k in 0..4 {
        let (sin, cos) = (1.3 * k as f32).sin_cos();
        let out = Vec3::new(cos, sin, 0.4 * k as f32 - 0.6).normalize_or(Vec3::X);
        let side = out
            .cross(Vec3::new(0.2, 0.1 * k as f32, 1.0))
            .normalize_or(Vec3::X);
        let root = Attachment::Soma { soma: 0, sample: 0 };
        let id = SectionId(cell.sections.len() as u32);
        let at = grow_section(&mut cell, root, out * 7.5, out, Vec3::ZERO, 0.7);
        for side in [side, -side] {
            let root = Attachment::Section(id);
            grow_section(&mut cell, root, at + side * 3.5, side, Vec3::ZERO, 0.75);
        }
    }
    let mesh = generate(&cell, &GenerateOptions::default())
        .expect("meshed")
        .mesh;
    let ends = mesh.tracing.iter().filter(|t| t.collar < 0.0).count();
    assert_eq!(ends, 4, "neurites that end in insets");
    mesh
}

/// A cell without sharp bends: neurites all around a soma that curve gently and fork once. No part
/// of its surface is folded over at any level.
pub(crate) fn smooth_cell(seed: u64) -> CoarseMesh {
    let mut random = Random(seed);
    let mut cell = round_soma("smooth");
    for k in 0..5 {
        // Evenly over the sphere.
        let z = 0.8 - 0.4 * k as f32;
        let (sin, cos) = (2.4 * k as f32).sin_cos();
        let out = Vec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vec3::Z * z;
        let side = (out.any_orthonormal_vector() + random.direction().as_vec3() * 0.1)
            .normalize_or(Vec3::X);
        let root = Attachment::Soma { soma: 0, sample: 0 };
        let id = SectionId(cell.sections.len() as u32);
        let at = grow_section(&mut cell, root, out * 7.5, out, side * 0.06, 0.9);
        for turn in [0.8, -0.8] {
            let heading = (out + side * turn).normalize_or(out);
            let root = Attachment::Section(id);
            let start = at + heading * 3.5;
            grow_section(&mut cell, root, start, heading, side * -0.06 * turn, 0.7);
        }
    }
    generate(&cell, &GenerateOptions::default())
        .expect("meshed")
        .mesh
}

/// A soma of radius 6 µm.
fn round_soma(name: &str) -> Morphology {
    let sample = SomaSample {
        id: 1,
        position: Vec3::ZERO,
        radius: 6.0,
        parent: None,
    };
    Morphology {
        name: name.into(),
        somata: vec![Soma {
            kind: SomaKind::Point,
            samples: vec![sample],
            center: Vec3::ZERO,
            radius: 6.0,
        }],
        ..Morphology::default()
    }
}

fn grow_section(
    cell: &mut Morphology,
    attachment: Attachment,
    mut at: Vec3,
    mut heading: Vec3,
    curve: Vec3,
    radius: f32,
) -> Vec3 {
    let first = cell.points.len() as u32;
    for k in 0..6 {
        cell.sample_ids.push(cell.points.len() as i64 + 2);
        cell.points.push(Point {
            position: at,
            radius: radius - 0.02 * k as f32,
        });
        heading = (heading + curve).normalize_or(heading);
        at += heading * 2.8;
    }
    cell.sections.push(Section {
        kind: NeuriteKind(3),
        attachment,
        first,
        end: cell.points.len() as u32,
    });
    cell.points[cell.points.len() - 1].position
}

/// Middle and reach (µm) of a mesh in its tracing's coordinates.
pub(crate) fn extent(mesh: &CoarseMesh) -> (DVec3, f64) {
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    for vertex in &mesh.vertices {
        low = low.min(vertex.position.as_dvec3());
        high = high.max(vertex.position.as_dvec3());
    }
    (
        (low + high) / 2.0 + mesh.origin,
        (high - low).length() / 2.0,
    )
}

/// Random levels 1 to 64, mostly small.
pub(crate) fn random_values(mesh: &CoarseMesh, seed: u64) -> Vec<u8> {
    let mut random = Random(seed);
    let set = [1, 1, 2, 3, 4, 5, 7, 8, 12, 17, 33, 64];
    mesh.tracing
        .iter()
        .map(|_| set[random.whole(set.len() as u64) as usize])
        .collect()
}

/// An eye at `distance` reaches from the middle of the mesh, looking nearly there.
pub(crate) fn look(mesh: &CoarseMesh, random: &mut Random, distance: f64) -> Camera {
    let (middle, reach) = extent(mesh);
    let eye = middle + random.direction() * reach * distance;
    let target = middle + random.direction() * reach * 0.2 * distance.min(1.0);
    let up = (target - eye).any_orthogonal_vector();
    Camera::new(eye, target, up, 0.7).expect("a camera")
}

pub(crate) fn cull_view(camera: &Camera, width: u32, height: u32) -> CullView {
    // Without perspective everything is in front.
    let near = if camera.is_orthographic() { -1e5 } else { 1e-3 };
    CullView::new(camera, width, height, near)
}
