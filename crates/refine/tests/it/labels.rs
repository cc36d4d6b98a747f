//! What the parts of a surface show of the cell.

use glam::Vec3;
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{CoarseMesh, FaceLabel, PatchKind, SurfaceMesh};
use neurotess_morphology::{Attachment, Morphology, NeuriteKind, Point, Section, SectionId};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

/// A straight trunk of radius 1, and a branch that leaves it at an angle (radians). Sections are the trunk before and
/// behind the fork, and the branch.
fn fork(radius: f32, angle: f32) -> Morphology {
    let direction = Vec3::X * angle.cos() + Vec3::Y * angle.sin();
    let of_trunk = |range: std::ops::RangeInclusive<i32>| range.map(|x| (Vec3::X * x as f32, 1.0));
    let of_branch = (1..=4).map(|k| (direction * (1.0 + k as f32), radius));
    let points = of_trunk(-8..=0).chain(of_trunk(1..=8)).chain(of_branch);
    let section = |attachment, first, end| Section {
        kind: NeuriteKind::AXON,
        attachment,
        first,
        end,
    };
    Morphology {
        points: points
            .map(|(position, radius)| Point { position, radius })
            .collect(),
        sample_ids: (1..=21).collect(),
        sections: vec![
            section(Attachment::Free, 0, 9),
            section(Attachment::Section(SectionId(0)), 9, 17),
            section(Attachment::Section(SectionId(0)), 17, 21),
        ],
        ..Morphology::default()
    }
}

/// Area of lofts that show the branch while the trunk's cone is the nearer one, and of those the other way round.
fn mislabeled(mesh: &CoarseMesh, level: u32, radius: f32, angle: f32) -> [f32; 2] {
    let refinement = Refinement::new(
        mesh,
        LodCriterion::Homogeneous(level),
        &RefineOptions::default(),
    );
    let surface = SurfaceMesh::collect(&refinement);
    let direction = Vec3::X * angle.cos() + Vec3::Y * angle.sin();
    let mut faces = surface.faces.triangles.iter();
    let mut areas = [0.0; 2];
    for (number, patch) in mesh.patches.iter().enumerate() {
        for face in faces.by_ref().take(refinement.patch_face_count(number)) {
            let [a, b, c] = face.map(|corner| &surface.vertices[corner as usize]);
            let center = (a.position + b.position + c.position) / 3.0 + mesh.origin.as_vec3();
            let to_trunk = center.reject_from(Vec3::X).length() - 1.0;
            let to_branch = center.reject_from(direction).length() - radius;
            let shows = FaceLabel::of([a, b, c]).section == 3;
            if patch.kind == PatchKind::Loft && shows != (to_branch < to_trunk) {
                let across = (b.position - a.position).cross(c.position - a.position);
                areas[usize::from(!shows)] += 0.5 * across.length();
            }
        }
    }
    areas
}

#[neurotess_testing::test]
fn lofts_are_the_trunk_s_up_to_the_nearest_cone_of_the_branch() {
    for (radius, degrees) in [
        (0.2, 90.0),
        (0.2, 60.0),
        (0.5, 90.0),
        (0.5, 60.0),
        (0.8, 90.0),
    ] {
        let angle = f32::to_radians(degrees);
        let cell = fork(radius, angle);
        let mesh = generate(&cell, &GenerateOptions::default())
            .expect("meshed")
            .mesh;
        let lofts = mesh
            .patches
            .iter()
            .filter(|patch| patch.kind == PatchKind::Loft);
        assert_eq!(lofts.count(), 4, "an inset");
        for level in [4, 16] {
            let shares = mislabeled(&mesh, level, radius, angle)
                .map(|area| area / (std::f32::consts::PI * radius * radius));
            // Measured: 0.14 and 0.23; with all of a loft as the branch's 11 for the first of these.
            let [over, under] = shares;
            assert!(
                over < 0.2 && under < 0.3,
                "{radius} {degrees} {level}: {shares:?}"
            );
        }
    }
}
