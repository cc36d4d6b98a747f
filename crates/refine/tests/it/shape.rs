//! The refined surface lies where the tracing says, within the error that was asked for.

use crate::trees::{Twig, grow};
use glam::Vec3;
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{CoarseMesh, Role, SurfaceMesh};
use neurotess_refine::{LodCriterion, Path, RefineOptions, Refinement};

fn cell(seed: u64) -> CoarseMesh {
    let twigs: Vec<Twig> = [(0, 6), (0, 5), (1, 4), (3, 3)]
        .iter()
        .enumerate()
        .map(|(i, &(parent, points))| Twig {
            parent,
            seed: seed + i as u64,
            points,
            step: 4.0,
            wild: 0.5,
            radius: 0.6,
        })
        .collect();
    generate(&grow(&twigs, Some(4.0)), &GenerateOptions::default())
        .expect("meshed")
        .mesh
}

fn surface(mesh: &CoarseMesh, lod: LodCriterion, path: Path) -> SurfaceMesh {
    let options = RefineOptions {
        path,
        ..RefineOptions::default()
    };
    SurfaceMesh::collect(&Refinement::new(mesh, lod, &options))
}

/// Distance from a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
fn distance(p: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return p.distance(a);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return p.distance(b);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return p.distance(c);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return p.distance(a + ab * (d1 / (d1 - d3)));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return p.distance(a + ac * (d2 / (d2 - d6)));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return p.distance(b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    }
    let n = ab.cross(ac).normalize_or_zero();
    n.dot(ap).abs()
}

/// Farthest that a vertex of `fine` lies from `coarse`.
fn farthest(fine: &SurfaceMesh, coarse: &SurfaceMesh) -> f32 {
    let triangles: Vec<([Vec3; 3], Vec3, f32)> = coarse
        .faces
        .triangles
        .iter()
        .map(|t| {
            let t = t.map(|i| coarse.vertices[i as usize].position);
            let center = (t[0] + t[1] + t[2]) / 3.0;
            (
                t,
                center,
                t.iter().map(|p| p.distance(center)).fold(0.0, f32::max),
            )
        })
        .collect();
    fine.vertices
        .iter()
        .step_by(41)
        .map(|v| {
            triangles.iter().fold(f32::MAX, |best, (t, center, reach)| {
                if v.position.distance(*center) - reach > best {
                    best
                } else {
                    best.min(distance(v.position, *t))
                }
            })
        })
        .fold(0.0, f32::max)
}

#[neurotess_testing::test]
fn adaptive_error_is_kept() {
    for seed in 1..=neurotess_testing::cases(1, 3) {
        let mesh = cell(seed);
        let finest = surface(&mesh, LodCriterion::Homogeneous(64), Path::Hermite);
        for error in [0.2, 0.05, 0.01] {
            let adaptive = surface(&mesh, LodCriterion::MaxError(error), Path::Hermite);
            let measured = farthest(&finest, &adaptive);
            assert!(
                measured <= error,
                "seed {seed}: {measured} µm for {error} µm"
            );
            assert!(adaptive.faces.triangles.len() < finest.faces.triangles.len() / 4);
        }
    }
}

#[neurotess_testing::test]
fn rings_are_circles_of_the_traced_radius() {
    let mesh = cell(5);
    let refined = surface(&mesh, LodCriterion::Homogeneous(8), Path::Hermite);
    let mut checked = 0;
    let reach = |number: usize| {
        let corners = mesh
            .vertices
            .iter()
            .filter(move |v| v.tracing as usize == number);
        let center = mesh.tracing[number].center;
        corners.fold(0.0_f32, |most, v| most.max(v.position.distance(center)))
    };
    for (number, tracing) in mesh.tracing.iter().enumerate() {
        // At bends, rings are half ellipses on the inner side.
        if tracing.role != Role::Ordinary || reach(number) > 1.01 * tracing.radius {
            continue;
        }
        // Vertices in the ring's plane and near its center are the ring's.
        let ring = refined.vertices.iter().filter(|v| {
            let offset = v.position - tracing.center;
            offset.dot(tracing.tangent).abs() < 1e-5 && offset.length() < 1.2 * tracing.radius
        });
        let ring: Vec<f32> = ring.map(|v| v.position.distance(tracing.center)).collect();
        assert!(ring.len() >= 32, "{} vertices on a ring", ring.len());
        for radius in &ring {
            assert!((radius - tracing.radius).abs() < 1e-5 * tracing.radius.max(0.3));
        }
        checked += 1;
    }
    assert!(checked > 5);
}

#[neurotess_testing::test]
fn normals_are_those_of_the_surface() {
    let mesh = cell(7);
    let refined = surface(&mesh, LodCriterion::Homogeneous(16), Path::Hermite);
    let mut faces = vec![Vec3::ZERO; refined.vertices.len()];
    for t in &refined.faces.triangles {
        let [a, b, c] = t.map(|i| refined.vertices[i as usize].position);
        t.iter()
            .for_each(|&i| faces[i as usize] += (b - a).cross(c - a));
    }
    let mut angles: Vec<f32> = refined
        .vertices
        .iter()
        .zip(&faces)
        .map(|(v, n)| {
            v.normal
                .angle_between(n.normalize_or(v.normal))
                .to_degrees()
        })
        .collect();
    angles.sort_by(f32::total_cmp);
    let median = angles[angles.len() / 2];
    let most = angles[angles.len() * 95 / 100];
    assert!(
        median < 2.0 && most < 15.0,
        "median {median}°, 95 % {most}°"
    );
}

/// A straight cone's lateral area and volume are those of the frustum.
#[neurotess_testing::test]
fn smooth_neurite_has_the_area_of_its_frusta() {
    let twig = Twig {
        parent: 0,
        seed: 3,
        points: 40,
        step: 3.0,
        wild: 0.05,
        radius: 0.5,
    };
    let morphology = grow(&[twig], None);
    let mesh = generate(&morphology, &GenerateOptions::default())
        .expect("meshed")
        .mesh;
    let options = RefineOptions {
        path: Path::Linear,
        ..RefineOptions::default()
    };
    let refinement = Refinement::new(&mesh, LodCriterion::Homogeneous(8), &options);
    let (volume, area) = refinement.volume_and_area();
    let (mut frusta_volume, mut frusta_area) = (0.0, 0.0);
    let cap = |r: f64| {
        (
            2.0 / 3.0 * std::f64::consts::PI * r.powi(3),
            std::f64::consts::TAU * r * r,
        )
    };
    for pair in morphology.points.windows(2) {
        let (r, s) = (f64::from(pair[0].radius), f64::from(pair[1].radius));
        let h = f64::from(pair[0].position.distance(pair[1].position));
        frusta_volume += std::f64::consts::PI * h * (r * r + r * s + s * s) / 3.0;
        frusta_area += std::f64::consts::PI * (r + s) * (r - s).hypot(h);
    }
    for end in [morphology.points.first(), morphology.points.last()] {
        let (v, a) = cap(f64::from(end.expect("a point").radius));
        frusta_volume += v;
        frusta_area += a;
    }
    assert!(
        (volume / frusta_volume - 1.0).abs() < 0.01,
        "{volume} for {frusta_volume}"
    );
    assert!(
        (area / frusta_area - 1.0).abs() < 0.01,
        "{area} for {frusta_area}"
    );
}

/// A thin neurite stands on its soma in a fillet that is as wide all around, not a star with four points
/// towards the corners of its quad.
#[neurotess_testing::test]
fn fillet_on_a_soma_is_round() {
    let twig = Twig {
        parent: 0,
        seed: 7,
        points: 6,
        step: 6.0,
        wild: 0.0,
        radius: 0.5,
    };
    let soma = 8.0;
    let mut cell = grow(&[twig], Some(soma));
    // Straight away from the soma: one that leaves it at a slant has a fillet as slanted.
    for (point, place) in cell.points.iter_mut().zip(0_u8..) {
        point.position = Vec3::X * (9.0 + 3.0 * f32::from(place));
    }
    let generated = generate(&cell, &GenerateOptions::default());
    let mesh = generated.expect("meshed").mesh;
    let insets = mesh.tracing.iter().filter(|t| t.role == Role::Inset);
    let insets: Vec<_> = insets.collect();
    let [inset] = insets[..] else {
        panic!("one inset, not {}", insets.len());
    };
    let soma_center = inset.center - inset.tangent * inset.tangent.dot(inset.center);
    assert!(soma_center.length() < 0.1, "the soma is at the origin");
    let surface = surface(&mesh, LodCriterion::Homogeneous(32), Path::Hermite);
    let low = surface.vertices.iter().filter_map(|v| {
        let height = (v.position.length() - soma) / inset.radius;
        let beside = v.position - inset.tangent * v.position.dot(inset.tangent);
        ((0.08..0.16).contains(&height)).then_some(beside.length() / inset.radius)
    });
    let widths: Vec<f32> = low.collect();
    assert!(widths.len() > 40, "{} vertices", widths.len());
    let least = widths.iter().copied().fold(f32::INFINITY, f32::min);
    let most = widths.iter().copied().fold(0.0, f32::max);
    assert!(most < 1.3 * least, "{least} to {most} radii");
}
