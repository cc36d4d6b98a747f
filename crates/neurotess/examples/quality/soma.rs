//! Somata: how much of what was traced is kept, and how smoothly neurites leave them. At level 8.

use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3};
use neurotess::generate::{GenerateError, GenerateOptions, Generated, SomaKeep, generate};
use neurotess::mesh::{CoarseMesh, PatchKind, Role, SurfaceMesh};
use neurotess::morphology::{Morphology, Soma, SomaShape};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};

/// Level at which somata are measured.
const LEVEL: u32 = 8;
/// Angles at which silhouettes are compared.
const ANGLES: usize = 180;
/// Radii of a first ring within which a silhouette is its neck's.
const NECK: f64 = 3.0;
/// A neurite is thick above this share of the soma's radius.
const THICK: f64 = 0.1;

/// The main soma's figures as members of a JSON object; nothing of a cell whose soma is not meshed.
pub(crate) fn figures(
    morphology: &Morphology,
    generated: &Generated,
) -> Result<String, GenerateError> {
    let (Some(soma), Some(report)) = (morphology.soma(), generated.somata.first()) else {
        return Ok(String::new());
    };
    let surface = Part::of_soma(&generated.mesh);
    let rings: Vec<Ring> = generated
        .rings
        .iter()
        .map(|ring| Ring {
            center: ring.center,
            radius: ring.radius,
        })
        .collect();
    let volume = surface.volume();
    let keeping = GenerateOptions {
        soma_keep: SomaKeep::Area,
        ..GenerateOptions::default()
    };
    let area = Part::of_soma(&generate(morphology, &keeping)?.mesh).closed_area();
    let off = |measured: f64, traced: f64| measured / traced - 1.0;
    let mut line = format!(
        r#", "soma_volume": {}, "soma_area": {}, "soma_told": {}"#,
        off(volume, report.traced_volume),
        off(area, report.traced_area),
        off(report.volume, volume),
    );
    if let Some([median, largest]) = silhouette(soma, &surface, &rings) {
        line += &format!(r#", "silhouette": {median}, "silhouette_max": {largest}"#);
    }
    let shape = SomaShape::of(soma);
    let thick = generated
        .rings
        .iter()
        .any(|ring| ring.radius > THICK * shape.radius());
    if thick {
        let size = (report.traced_volume / shape.volume()).cbrt();
        let used: HashSet<u32> = surface.triangles.iter().flatten().copied().collect();
        let places = used.iter().map(|&v| surface.positions[v as usize]);
        let shares = places.map(|place| {
            let off = place - shape.center();
            off.length() / (size * shape.distance(off.normalize_or_zero()))
        });
        line += &format!(r#", "drawn_out": {}"#, percentile(shares.collect(), 0.99));
    }
    let angles = neck_angles(&generated.mesh);
    if !angles.is_empty() {
        line += &format!(
            r#", "neck": {}, "neck_99": {}"#,
            percentile(angles.clone(), 0.5),
            percentile(angles, 0.99)
        );
    }
    Ok(line)
}

struct Ring {
    center: DVec3,
    radius: f64,
}

/// Some of a mesh's patches, refined.
struct Part {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Part {
    /// The somata up to the neurites' first rings.
    fn of_soma(mesh: &CoarseMesh) -> Self {
        Self::new(mesh, |kind, roles| {
            kind == PatchKind::Soma || (kind == PatchKind::Loft && roles.contains(&Role::Soma))
        })
    }

    fn new(mesh: &CoarseMesh, holds: impl Fn(PatchKind, [Role; 4]) -> bool) -> Self {
        let mut mesh = mesh.clone();
        let roles: Vec<Role> = (mesh.vertices.iter())
            .map(|vertex| mesh.tracing[vertex.tracing as usize].role)
            .collect();
        mesh.patches
            .retain(|patch| holds(patch.kind, patch.corners.map(|v| roles[v as usize])));
        let level = LodCriterion::Homogeneous(LEVEL);
        let surface =
            SurfaceMesh::collect(&Refinement::new(&mesh, level, &RefineOptions::default()));
        let quads = surface.faces.quads.iter();
        let quads = quads.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let positions = surface.vertices.iter();
        Self {
            positions: positions.map(|vertex| vertex.position.as_dvec3()).collect(),
            triangles: surface
                .faces
                .triangles
                .iter()
                .copied()
                .chain(quads)
                .collect(),
        }
    }

    fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|v| self.positions[v as usize])
    }

    /// Loops of edges that bound it, each with its middle: the first rings.
    fn caps(&self) -> Vec<[DVec3; 3]> {
        let mut next: HashMap<u32, u32> = HashMap::new();
        let edges = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let all: HashSet<[u32; 2]> = edges.clone().collect();
        let open = edges.filter(|&[a, b]| !all.contains(&[b, a]));
        next.extend(open.map(|[a, b]| (b, a)));
        let mut caps = Vec::new();
        while let Some(&first) = next.keys().min() {
            let mut ring = vec![first];
            let mut here = next.remove(&first);
            while let Some(v) = here.filter(|&v| v != first) {
                ring.push(v);
                here = next.remove(&v);
            }
            let places: Vec<DVec3> = ring.iter().map(|&v| self.positions[v as usize]).collect();
            let middle = places.iter().copied().sum::<DVec3>() / places.len() as f64;
            let pairs = places.iter().zip(places.iter().cycle().skip(1));
            caps.extend(pairs.map(|(&a, &b)| [middle, a, b]));
        }
        caps
    }

    fn volume(&self) -> f64 {
        let first = self.positions.first().copied().unwrap_or_default();
        let triangles = self
            .triangles
            .iter()
            .map(|&triangle| self.corners(triangle));
        let parts = triangles.chain(self.caps()).map(|corners| {
            let [a, b, c] = corners.map(|corner| corner - first);
            a.dot(b.cross(c)) / 6.0
        });
        parts.sum()
    }

    fn closed_area(&self) -> f64 {
        let triangles = self
            .triangles
            .iter()
            .map(|&triangle| self.corners(triangle));
        let parts = triangles.chain(self.caps());
        parts
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
            .sum()
    }
}

/// How far the silhouette is off the largest outline, away from necks: median and largest, in radii of equal area.
fn silhouette(soma: &Soma, surface: &Part, rings: &[Ring]) -> Option<[f64; 2]> {
    let outlines = soma.outlines();
    if outlines.len() != 1 {
        return None; // of a stack other outlines show
    }
    let outline = outlines.first()?;
    let center = SomaShape::of(soma).center();
    let corners = outline.iter().zip(outline.iter().cycle().skip(1));
    let area: DVec3 = corners.map(|(&a, &b)| (a - center).cross(b - center)).sum();
    let normal = area.try_normalize()?;
    let radius = (area.length() / 2.0 / std::f64::consts::PI).sqrt();
    let (e1, e2) = normal.any_orthonormal_pair();
    let flat = |place: DVec3| DVec2::new((place - center).dot(e1), (place - center).dot(e2));
    let outline: Vec<DVec2> = outline.iter().map(|&place| flat(place)).collect();
    let places: Vec<DVec2> = surface.positions.iter().map(|&place| flat(place)).collect();
    let triangles: Vec<[DVec2; 3]> = (surface.triangles.iter())
        .map(|triangle| triangle.map(|v| places[v as usize]))
        .collect();
    let mut off = Vec::new();
    for i in 0..ANGLES {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / ANGLES as f64).sin_cos();
        let ray = DVec2::new(cos, sin);
        let edges = outline.iter().zip(outline.iter().cycle().skip(1));
        let traced = edges.fold(0.0, |far, (&a, &b)| crossing(ray, a, b).max(far));
        let meshed = triangles.iter().fold(0.0, |far, &[a, b, c]| {
            let sides = [(a, b), (b, c), (c, a)];
            sides
                .iter()
                .fold(far, |far, &(a, b)| crossing(ray, a, b).max(far))
        });
        let places = [traced, meshed].map(|t| ray * t);
        let is_neck = rings.iter().any(|ring| {
            places
                .iter()
                .any(|&place| flat(ring.center).distance(place) < NECK * ring.radius + 0.1 * radius)
        });
        if !is_neck {
            off.push((meshed - traced).abs() / radius);
        }
    }
    let median = percentile(off.clone(), 0.5);
    (!off.is_empty()).then(|| [median, percentile(off, 1.0)])
}

/// Distance at which a ray meets an edge; 0 if it does not.
fn crossing(ray: DVec2, a: DVec2, b: DVec2) -> f64 {
    let (from, to) = (ray.perp_dot(a), ray.perp_dot(b));
    match (from > 0.0) == (to > 0.0) {
        true => 0.0,
        false => a.lerp(b, from / (from - to)).dot(ray),
    }
}

/// Angles (degrees) between the facets on both sides of the first rings' edges.
fn neck_angles(mesh: &CoarseMesh) -> Vec<f64> {
    let is_soma = |kind: PatchKind, roles: [Role; 4]| {
        kind == PatchKind::Soma || (kind == PatchKind::Loft && roles.contains(&Role::Soma))
    };
    let is_tube = |kind: PatchKind, roles: [Role; 4]| {
        kind == PatchKind::Lateral
            && roles
                .iter()
                .any(|role| matches!(role, Role::Insertion | Role::Inset))
    };
    let (soma, tubes) = (Part::new(mesh, is_soma), Part::new(mesh, is_tube));
    let key = |place: DVec3| place.to_array().map(f64::to_bits);
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize_or_zero();
    let sides = |part: &Part| -> HashMap<[[u64; 3]; 2], DVec3> {
        let triangles = part
            .triangles
            .iter()
            .map(|&triangle| part.corners(triangle));
        let sides = triangles.flat_map(|corners| {
            let [a, b, c] = corners.map(key);
            [[a, b], [b, c], [c, a]].map(|side| (side, normal(corners)))
        });
        sides.collect()
    };
    let (soma, tubes) = (sides(&soma), sides(&tubes));
    let shared = soma.iter().filter_map(|([a, b], normal)| {
        let other = tubes.get(&[*b, *a])?;
        Some(normal.angle_between(*other).to_degrees())
    });
    shared.filter(|angle| angle.is_finite()).collect()
}

fn percentile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    values
        .get((share * last as f64).round() as usize)
        .copied()
        .unwrap_or_default()
}
