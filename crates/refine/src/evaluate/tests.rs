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
                let on = edge_normal(EdgeKind::Along, a, d, jet.derivative, y);
                let (_, beside) = shape.interior(&RefineOptions::default(), 1e-3, y);
                let off = on.angle_between(beside).to_degrees();
                assert!(off < 8.0, "{off}° at {y}, rings lean by {from} and {to}");
            }
        }
    }
}
