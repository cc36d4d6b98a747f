use neurotess_mesh::Role;

use super::*;

/// Corner of a ring, at an angle around its tangent.
fn corner(center: Vec3, tangent: Vec3, radius: f32, angle: f32) -> Corner {
    let tangent = tangent.normalize_or(Vec3::Z);
    let side = tangent.cross(Vec3::X).normalize_or(Vec3::Y);
    let radial = side * angle.cos() + tangent.cross(side) * angle.sin();
    Corner {
        position: center + radial * radius,
        normal: radial,
        center,
        offset: radial * radius,
        radial,
        tangent,
        radius,
        role: Role::Ordinary,
        collar: 0.0,
    }
}

/// Lines would show along the edges of a tube whose rings lean over, if normals on edges were not those beside
/// them: as the mean of the corners they were off by up to 19°.
#[test]
fn normals_along_a_sheared_tube_are_those_beside() {
    let leans = [
        Vec3::ZERO,
        Vec3::new(0.5, 0.2, 0.0),
        Vec3::new(-0.6, 0.4, 0.0),
    ];
    for (from, to) in leans.into_iter().flat_map(|a| leans.map(|b| (a, b))) {
        for quarter in 0..4 {
            let angle = |k: u32| std::f32::consts::FRAC_PI_2 * (quarter + k) as f32 + 0.3;
            let low = |k| corner(Vec3::ZERO, Vec3::Z + from, 1.0, angle(k));
            let high = |k| corner(Vec3::Z * 2.0, Vec3::Z + to, 0.8, angle(k));
            let shape = PatchShape {
                kind: PatchKind::Lateral,
                corners: [low(0), low(1), high(1), high(0)],
                sides: [
                    EdgeKind::Ring,
                    EdgeKind::Along,
                    EdgeKind::Ring,
                    EdgeKind::Along,
                ]
                .map(|kind| (kind, false)),
            };
            let [a, .., d] = &shape.corners;
            for y in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let jet = edge(EdgeKind::Along, a, d, Path::Hermite, y);
                let on = EdgeNormals::new(EdgeKind::Along, a, d).at(jet.derivative, y);
                let (_, beside) = shape.interior(&RefineOptions::default(), 1e-3, y);
                let off = on.angle_between(beside).to_degrees();
                assert!(off < 8.0, "{off}° at {y}, rings lean by {from} and {to}");
            }
        }
    }
}

/// Patches of a soma would show as facets if their normals jumped at the sides.
#[test]
fn normals_of_a_soma_s_patch_go_over_into_those_of_its_sides() {
    let at = |x: f32, y: f32, normal: Vec3| Corner {
        role: Role::Soma,
        position: Vec3::new(x, y, 0.2 * x * y),
        normal: normal.normalize_or(Vec3::Z),
        ..corner(Vec3::ZERO, Vec3::Z, 1.0, 0.0)
    };
    let shape = PatchShape {
        kind: PatchKind::Soma,
        corners: [
            at(0.0, 0.0, Vec3::new(-0.5, -0.3, 1.0)),
            at(1.0, 0.0, Vec3::new(0.6, -0.2, 1.0)),
            at(1.0, 1.0, Vec3::new(0.3, 0.8, 1.0)),
            at(0.0, 1.0, Vec3::new(-0.7, 0.4, 1.0)),
        ],
        sides: [(EdgeKind::Soma, false); 4],
    };
    let (low, high) = (1e-4, 1.0 - 1e-4);
    for t in [0.1, 0.4, 0.8] {
        for (side, x, y) in [(0, t, low), (1, high, t), (2, t, high), (3, low, t)] {
            let on = shape.side_normal(side, &shape.side(side, Path::Hermite, t), t);
            let (_, beside) = shape.interior(&RefineOptions::default(), x, y);
            let off = on.angle_between(beside).to_degrees();
            assert!(off < 0.2, "{off}° at {t} of side {side}");
        }
    }
}
