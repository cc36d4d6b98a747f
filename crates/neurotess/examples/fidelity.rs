//! How near the surface lies to the tracing, and where it crosses itself.
//!
//! `cargo run --release -p neurotess --example fidelity -- FILES…` prints a row of a Markdown table
//! per file, for level 4:
//!
//! * the median distance (µm and in units of the median radius) of the surface's vertices to the
//!   tracing's cones, the soma's own surface aside;
//! * how many of the tracing points that the mesh kept lie inside the surface (winding number along
//!   a ray);
//! * self-intersecting pairs of faces by cause: `fork`, `bend` and `soma` where the two faces belong
//!   to neighboring tracing points, `apart` where neurites were traced through one another.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec3, Vec3};
use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::{CoarseMesh, PatchKind, Role, Surface, SurfaceMesh, self_intersections};
use neurotess::morphology::{Morphology, shape};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() {
    println!(
        "| cell | faces | median distance (µm) | in radii | points inside | pairs | % of faces | \
         fork | bend | soma | apart |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for file in std::env::args().skip(1) {
        match row(Path::new(&file)) {
            Ok(row) => println!("{row}"),
            Err(error) => println!("| {file}: {error} |"),
        }
    }
}

fn row(file: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let morphology = read(file, &ReadOptions::default())?.morphology;
    let generated = generate(&morphology, &GenerateOptions::default()).expect("meshed");
    let refinement = Refinement::new(
        &generated.mesh,
        LodCriterion::Homogeneous(4),
        &RefineOptions::default(),
    );
    let surface = SurfaceMesh::collect(&refinement);
    let (distance, radius) = distance_to_cones(&morphology, &surface);
    let (inside, kept) = points_inside(&generated.mesh, &surface);
    let causes = causes(&generated.mesh, &refinement, &surface);
    let pairs: usize = causes.values().sum();
    let count = |cause: &str| causes.get(cause).copied().unwrap_or(0);
    Ok(format!(
        "| {} | {} | {distance:.4} | {:.3} | {inside} of {kept} | {pairs} | {:.3} | {} | {} | {} | {} |",
        morphology.name,
        surface.faces.triangles.len(),
        distance / radius,
        100.0 * pairs as f64 / surface.faces.triangles.len() as f64,
        count("fork"),
        count("bend"),
        count("soma"),
        count("apart"),
    ))
}

/// Cells of a grid over space.
struct Grid<T> {
    size: f32,
    cells: HashMap<[i32; 3], Vec<T>>,
}

impl<T: Copy> Grid<T> {
    fn new(size: f32) -> Self {
        Self {
            size: size.max(1e-3),
            cells: HashMap::new(),
        }
    }

    fn cell(&self, p: Vec3) -> [i32; 3] {
        (p / self.size).floor().as_ivec3().to_array()
    }

    fn add(&mut self, low: Vec3, high: Vec3, item: T) {
        let (a, b) = (self.cell(low), self.cell(high));
        for x in a[0]..=b[0] {
            for y in a[1]..=b[1] {
                for z in a[2]..=b[2] {
                    self.cells.entry([x, y, z]).or_default().push(item);
                }
            }
        }
    }

    fn at(&self, p: Vec3) -> &[T] {
        self.cells.get(&self.cell(p)).map_or(&[], Vec::as_slice)
    }
}

/// Median over the neurites' vertices of the distance to the nearest cone, and the median radius.
fn distance_to_cones(morphology: &Morphology, surface: &SurfaceMesh) -> (f64, f64) {
    let mut radii: Vec<f32> = morphology.points.iter().map(|p| p.radius).collect();
    radii.sort_by(f32::total_cmp);
    let radius = radii.get(radii.len() / 2).copied().unwrap_or(1.0);
    let mut grid = Grid::new(8.0 * radius.max(0.2));
    let cones: Vec<_> = (0..morphology.sections.len())
        .flat_map(|s| {
            let id = neurotess::morphology::SectionId(s as u32);
            let points: Vec<_> = shape::branch_point(morphology, id)
                .into_iter()
                .chain(morphology.section_points(id))
                .copied()
                .collect();
            points.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>()
        })
        .collect();
    for (index, (a, b)) in cones.iter().enumerate() {
        let reach = Vec3::splat(2.0 * a.radius.max(b.radius).max(radius));
        let (low, high) = (
            a.position.min(b.position) - reach,
            a.position.max(b.position) + reach,
        );
        grid.add(low, high, index as u32);
    }
    let mut distances: Vec<f32> = surface
        .vertices
        .iter()
        .filter(|v| v.section > 0)
        .filter_map(|v| {
            let near = grid.at(v.position).iter().map(|&i| {
                let (a, b) = cones[i as usize];
                let axis = b.position - a.position;
                let t = (v.position - a.position).dot(axis) / axis.length_squared().max(1e-12);
                let t = t.clamp(0.0, 1.0);
                let radius = a.radius + t * (b.radius - a.radius);
                (v.position.distance(a.position + axis * t) - radius).abs()
            });
            near.min_by(f32::total_cmp)
        })
        .collect();
    distances.sort_by(f32::total_cmp);
    (
        f64::from(distances.get(distances.len() / 2).copied().unwrap_or(0.0)),
        f64::from(radius),
    )
}

/// Kept tracing points inside the surface, of how many: signed crossings along +z.
fn points_inside(mesh: &CoarseMesh, surface: &SurfaceMesh) -> (usize, usize) {
    let corner = |i: u32| surface.vertices[i as usize].position.as_dvec3();
    let mut radii: Vec<f32> = mesh.tracing.iter().map(|t| t.radius).collect();
    radii.sort_by(f32::total_cmp);
    let mut columns = Grid::new(2.0 * radii.get(radii.len() / 2).copied().unwrap_or(1.0));
    let flat = |p: DVec3| Vec3::new(p.x as f32, p.y as f32, 0.0);
    for (index, t) in surface.faces.triangles.iter().enumerate() {
        let [a, b, c] = t.map(corner);
        columns.add(flat(a.min(b).min(c)), flat(a.max(b).max(c)), index as u32);
    }
    let inside = |p: DVec3| {
        let crossings = columns.at(flat(p)).iter().map(|&i| {
            let [a, b, c] = surface.faces.triangles[i as usize]
                .map(corner)
                .map(|v| v - p);
            let side = |u: DVec3, v: DVec3| u.x * v.y - u.y * v.x;
            let (ab, bc, ca) = (side(a, b), side(b, c), side(c, a));
            let area = ab + bc + ca;
            let through = (ab > 0.0 && bc > 0.0 && ca > 0.0) || (ab < 0.0 && bc < 0.0 && ca < 0.0);
            let z = (bc * a.z + ca * b.z + ab * c.z) / area;
            if through && z > 0.0 {
                area.signum() as i32
            } else {
                0
            }
        });
        crossings.sum::<i32>() > 0
    };
    let traced = |role: Role| matches!(role, Role::Ordinary | Role::Joint | Role::Insertion);
    let kept: Vec<_> = mesh.tracing.iter().filter(|t| traced(t.role)).collect();
    // Off the center by a hair: rays through vertices would count twice.
    let aside = DVec3::new(1.3e-4, 0.7e-4, 0.0);
    let count = kept
        .iter()
        .filter(|t| inside(t.center.as_dvec3() + aside * f64::from(t.radius)));
    (count.count(), kept.len())
}

/// Self-intersecting pairs by what they belong to.
fn causes(
    mesh: &CoarseMesh,
    refinement: &Refinement<'_>,
    surface: &SurfaceMesh,
) -> HashMap<&'static str, usize> {
    let positions: Vec<Vec3> = surface.vertices.iter().map(|v| v.position).collect();
    let pairs = self_intersections(&positions, &surface.faces);
    let mut owner = Vec::with_capacity(refinement.triangle_count());
    for patch in 0..mesh.patches.len() {
        owner.extend(std::iter::repeat_n(
            patch,
            refinement.patch_face_count(patch),
        ));
    }
    let ends = |patch: usize| {
        let corners = mesh.patches[patch].corners;
        [corners[0], corners[3]].map(|v| mesh.vertices[v as usize].tracing)
    };
    let mut causes = HashMap::new();
    for [a, b] in pairs {
        let (p, q) = (owner[a as usize], owner[b as usize]);
        let (ep, eq) = (ends(p), ends(q));
        let role = |t: u32| mesh.tracing[t as usize].role;
        let soma = |patch: usize| mesh.patches[patch].kind == PatchKind::Soma;
        let cause = if soma(p) && soma(q) {
            "soma"
        } else if !ep.iter().any(|t| eq.contains(t)) {
            "apart"
        } else if ep.iter().chain(&eq).any(|&t| role(t) == Role::Joint) {
            "fork"
        } else {
            "bend"
        };
        *causes.entry(cause).or_default() += 1;
    }
    causes
}
