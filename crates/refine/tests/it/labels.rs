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

/// The same with the branch as the parent of both halves of the trunk. With a twig on the left half, the trunk's path
/// begins on the right: it runs against the order of sections.
fn fork_across(has_twig: bool) -> Morphology {
    let half = |sign: f32| (1..=8).map(move |k| (Vec3::X * (sign * k as f32), 1.0));
    let parent = (1..=5).map(|k| (Vec3::Y * (6.0 - k as f32), 0.5));
    let twig = (1..=4).map(|k| (Vec3::new(-5.0, 0.0, 1.0 + k as f32), 0.2));
    let mut points: Vec<(Vec3, f32)> = parent.chain([(Vec3::ZERO, 1.0)]).collect();
    points.extend(half(-1.0));
    if has_twig {
        points.splice(11..11, twig);
    }
    points.extend(half(1.0));
    let section = |attachment, first, end| Section {
        kind: NeuriteKind::AXON,
        attachment,
        first,
        end,
    };
    let of = |parent, first, end| section(Attachment::Section(SectionId(parent)), first, end);
    let root = section(Attachment::Free, 0, 6);
    Morphology {
        sample_ids: (1..=points.len() as i64).collect(),
        points: points
            .into_iter()
            .map(|(position, radius)| Point { position, radius })
            .collect(),
        sections: match has_twig {
            true => vec![
                root,
                of(0, 6, 11),
                of(1, 11, 15),
                of(1, 15, 18),
                of(0, 18, 26),
            ],
            false => vec![root, of(0, 6, 14), of(0, 14, 22)],
        },
        ..Morphology::default()
    }
}

/// Area within 3 µm of the fork that shows the wrong one of the trunk's two sections, over its circumference: how far
/// (µm) off the border between them is.
fn border_off(mesh: &CoarseMesh, level: u32, [left, right]: [i32; 2]) -> f32 {
    let refinement = Refinement::new(
        mesh,
        LodCriterion::Homogeneous(level),
        &RefineOptions::default(),
    );
    let surface = SurfaceMesh::collect(&refinement);
    let wrong = surface.faces.triangles.iter().map(|face| {
        let [a, b, c] = face.map(|corner| &surface.vertices[corner as usize]);
        let x = (a.position.x + b.position.x + c.position.x) / 3.0 + mesh.origin.x as f32;
        let other = if x < 0.0 { right } else { left };
        if x.abs() > 3.0 || FaceLabel::of([a, b, c]).section != other {
            return 0.0;
        }
        let across = (b.position - a.position).cross(c.position - a.position);
        0.5 * across.length()
    });
    wrong.sum::<f32>() / std::f32::consts::TAU
}

#[neurotess_testing::test]
fn sections_of_a_trunk_change_where_its_fork_lies() {
    let forks = [(0.2, 90.0), (0.5, 60.0), (0.5, 35.0), (0.8, 90.0)];
    let forks = forks.map(|(radius, angle)| (fork(radius, f32::to_radians(angle)), [1, 2], 1));
    let across = [
        (fork_across(false), [2, 3], 1),
        (fork_across(true), [2, 5], -1),
    ];
    for (number, (cell, sections, sign)) in forks.into_iter().chain(across).enumerate() {
        let mesh = generate(&cell, &GenerateOptions::default())
            .expect("meshed")
            .mesh;
        let borders = mesh.tracing.iter().map(|point| point.border);
        let borders: Vec<i8> = borders.filter(|&border| border != 0).collect();
        assert!(
            borders.iter().any(|border| border.signum() == sign),
            "{number}: {borders:?}"
        );
        for level in [4, 16] {
            let off = border_off(&mesh, level, sections);
            // Half a row of a zone of 2.6 µm, and half a sixteenth. With borders half way it was up to 1.2.
            let most = if level == 4 { 0.35 } else { 0.1 };
            assert!(off < most, "{number} {level} {borders:?}: {off}");
        }
    }
}
