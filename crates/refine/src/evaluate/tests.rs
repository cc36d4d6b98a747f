use neurotess_mesh::Role;

use super::*;

/// Corner of a ring, at an angle around its tangent.
fn corner(center: Vec3, tangent: Vec3, radius: f32, angle: f32) -> Corners {
    let tangent = tangent.normalize_or(Vec3::Z);
    let side = tangent.cross(Vec3::X).normalize_or(Vec3::Y);
    let radial = side * angle.cos() + tangent.cross(side) * angle.sin();
    Corners {
        position: Vec3x4::splat(center + radial * radius),
        normal: Vec3x4::splat(radial),
        center: Vec3x4::splat(center),
        offset: Vec3x4::splat(radial * radius),
        radial: Vec3x4::splat(radial),
        tangent: Vec3x4::splat(tangent),
        radius: F32x4::splat(radius),
        role: [Role::Ordinary; 4],
        collar: F32x4::ZERO,
        taper: F32x4::ZERO,
    }
}

/// Position and derivative of an edge along a tube.
fn along(a: &Corners, b: &Corners, t: f32) -> (Vec3, Vec3) {
    let jets = EdgeCurves::new(EdgeKind::Along, a, b, Path::Hermite).at(F32x4::splat(t));
    (jets.position.each()[0], jets.derivative.each()[0])
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
            let corners = [low(0), low(1), high(1), high(0)];
            let sides = [
                EdgeKind::Ring,
                EdgeKind::Along,
                EdgeKind::Ring,
                EdgeKind::Along,
            ];
            let sides = sides.map(|kind| (kind, false));
            let shape = PatchShape::of_corners(PatchKind::Lateral, corners, sides);
            let [a, .., d] = &shape.corners;
            for y in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let derivative = Vec3x4::splat(along(a, d, y).1);
                let on = EdgeNormals::new(EdgeKind::Along, a, d).at(derivative, F32x4::splat(y));
                let on = on.each()[0];
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
    let at = |x: f32, y: f32, normal: Vec3| Corners {
        role: [Role::Soma; 4],
        position: Vec3x4::splat(Vec3::new(x, y, 0.2 * x * y)),
        normal: Vec3x4::splat(normal.normalize_or(Vec3::Z)),
        ..corner(Vec3::ZERO, Vec3::Z, 1.0, 0.0)
    };
    let corners = [
        at(0.0, 0.0, Vec3::new(-0.5, -0.3, 1.0)),
        at(1.0, 0.0, Vec3::new(0.6, -0.2, 1.0)),
        at(1.0, 1.0, Vec3::new(0.3, 0.8, 1.0)),
        at(0.0, 1.0, Vec3::new(-0.7, 0.4, 1.0)),
    ];
    let shape = PatchShape::of_corners(PatchKind::Soma, corners, [(EdgeKind::Soma, false); 4]);
    let (low, high) = (1e-4, 1.0 - 1e-4);
    for t in [0.1, 0.4, 0.8] {
        for (side, x, y) in [(0, t, low), (1, high, t), (2, t, high), (3, low, t)] {
            let on = shape.coons_side(side, F32x4::splat(t)).normal.each()[0];
            let (_, beside) = shape.interior(&RefineOptions::default(), x, y);
            let off = on.angle_between(beside).to_degrees();
            assert!(off < 0.2, "{off}° at {t} of side {side}");
        }
    }
}

/// A corner of a straight tube along z, at this height.
fn along_z(height: f32, radius: f32, taper: f32, role: Role) -> Corners {
    Corners {
        taper: F32x4::splat(taper),
        role: [role; 4],
        ..corner(Vec3::Z * height, Vec3::Z, radius, 0.0)
    }
}

/// Radius of a straight tube and its slope (µm per µm) at a share of the way between two corners.
fn radius_and_slope(a: &Corners, b: &Corners, y: f32) -> (f32, f32) {
    let (position, derivative) = along(a, b, y);
    let axis = Vec3::new(position.x, position.y, 0.0);
    let out = axis.normalize_or(Vec3::X);
    (axis.length(), derivative.dot(out) / derivative.z)
}

/// What a ring's taper is between two others: the straight slope over both, as steep as is allowed.
fn taper_between(before: (f32, f32), here: (f32, f32), after: (f32, f32)) -> f32 {
    let slope = |a: (f32, f32), b: (f32, f32)| (b.1 - a.1) / (b.0 - a.0);
    let (near, far) = (slope(before, here), slope(here, after));
    if near * far <= 0.0 {
        return 0.0;
    }
    let most = 3.0 * near.abs().min(far.abs());
    slope(before, after).clamp(-most, most).clamp(-1.0, 1.0)
}

/// With a radius that is linear between rings the slopes beside one differ by up to 0.7 here.
#[test]
fn slope_of_the_radius_is_continuous_across_a_ring() {
    let rings = [
        (0.0, 1.0),
        (2.0, 1.1),
        (3.0, 1.6),
        (6.0, 1.0),
        (7.0, 0.95),
        (9.0, 0.4),
    ];
    for three in rings.windows(3) {
        let &[before, here, after] = three else {
            unreachable!("windows of three")
        };
        let taper = taper_between(before, here, after);
        for role in [Role::Ordinary, Role::Joint, Role::End] {
            let start = along_z(before.0, before.1, 0.0, role);
            let middle = along_z(here.0, here.1, taper, Role::Ordinary);
            let end = along_z(after.0, after.1, 0.0, role);
            let step = 1e-3;
            let (below, slope_below) = radius_and_slope(&start, &middle, 1.0 - step);
            let (above, slope_above) = radius_and_slope(&middle, &end, step);
            assert!((slope_below - taper).abs() < 0.01, "{slope_below}, {taper}");
            assert!((slope_above - taper).abs() < 0.01, "{slope_above}, {taper}");
            // Also as surfaces measure it.
            let (down, up) = (here.0 - before.0, after.0 - here.0);
            let differences = [
                (here.1 - below) / (step * down),
                (above - here.1) / (step * up),
            ];
            let apart = (differences[0] - differences[1]).abs();
            assert!(apart < 0.01, "{differences:?} at {here:?}");
        }
    }
}

/// Whatever the tapers say.
#[test]
fn radius_is_the_traced_one_at_rings_and_between_the_two_on_the_way() {
    let radii = [0.1, 0.11, 0.7, 4.0];
    let tapers = [-1.0, -0.2, 0.0, 0.03, 0.4, 1.0, f32::NAN];
    let roles = [Role::Ordinary, Role::End, Role::Joint, Role::Inset];
    let pairs = |taper: f32| tapers.map(|other| (taper, other));
    for (from, to) in radii.into_iter().flat_map(|a| radii.map(|b| (a, b))) {
        for (near, far) in tapers.into_iter().flat_map(pairs) {
            for (start, end) in roles.into_iter().flat_map(|a| roles.map(|b| (a, b))) {
                let a = along_z(0.0, from, near, start);
                let b = along_z(3.0, to, far, end);
                let curves = EdgeCurves::new(EdgeKind::Along, &a, &b, Path::Hermite);
                let radius = |y: f32| curves.radius(F32x4::splat(y)).x;
                let start = along(&a, &b, 0.0).0;
                assert_eq!((radius(0.0), start), (from, a.position.each()[0]));
                assert!((radius(1.0) - to).abs() < 1e-6 * to);
                let mut last = from;
                for k in 1..=64 {
                    let y = k as f32 / 64.0;
                    let radius = radius(y);
                    let forwards = (radius - last) * (to - from).signum();
                    assert!(
                        forwards >= -2e-6 * from.max(to),
                        "{from} to {to} at {y}: {radius} after {last}"
                    );
                    let (drawn, _) = radius_and_slope(&a, &b, y);
                    assert!((drawn - radius).abs() < 1e-5 * radius, "{drawn}, {radius}");
                    last = radius;
                }
            }
        }
    }
}
