//! From a morphology to a closed coarse mesh.
#![forbid(unsafe_code)]

mod bytes;
mod error;
mod judge;
mod options;
mod plan;
mod sides;
mod soma;
mod tracing;
mod tubes;
mod warning;

pub use error::GenerateError;
pub use options::{Crossings, GenerateOptions, Smooth, SomaKeep, SomaMethod, SphereKind};
pub use sides::{Equal, Polygons, Sides};
pub use tracing::separate::{SeparatedPlace, Separation};
pub use tracing::smooth::Smoothing;

pub use warning::Warning;

use glam::DVec3;
use neurotess_mesh::{CoarseMesh, Role, SectionNumber, Stage, Steps, SwcType, Vertex, Watch};
use neurotess_morphology::{Morphology, NeuriteKind, Soma};

use soma::first_rings::RingRequests;
use soma::hubs::{self, Hub};
use soma::{near_forks, stems, stubs};
use tracing::{Skeleton, coordinates, mend, repeated, separate, smooth, soma_ends, thin};
use tubes::{SomaLabel, Somata};
use warning::Warnings;

/// A coarse mesh and what there is to say about it.
#[derive(Clone, Debug, Default)]
pub struct Generated {
    /// The closed coarse mesh.
    pub mesh: CoarseMesh,
    /// One report per soma.
    pub somata: Vec<SomaReport>,
    /// Where each neurite of a soma begins, in the order of the tracing.
    pub rings: Vec<FirstRing>,
    /// What was mended, counted by cause.
    pub warnings: Vec<Warning>,
    /// How far [`Smooth`] moved points; none where it was not asked for.
    pub smoothing: Option<Smoothing>,
    /// What [`Crossings::Separate`] found and did; none without it.
    pub separation: Option<Separation>,
    /// Seconds that somata took, by the clock of [`generate_watched`]; 0 without one.
    pub soma_seconds: f64,
}

/// Figures of a rebuilt soma.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SomaReport {
    /// Volume (µm³) within the soma's refined surface, closed by the planes of the first rings.
    pub volume: f64,
    /// Area (µm²) of the soma's refined surface without what neurites take.
    pub area: f64,
    /// Volume (µm³) as traced: of the sphere, the outlines' body or the frusta, times the cube of
    /// [`GenerateOptions::soma_scale`], and of what was traced of neurites between there and their first rings.
    pub traced_volume: f64,
    /// Area (µm²) as traced, without neurites.
    pub traced_area: f64,
}

/// The first ring of a neurite on its soma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstRing {
    /// Number of the neurite, from 0 in the order of the tracing. A neurite that forks inside its soma
    /// has several rings.
    pub neurite: u32,
    /// Where it is: 0 on the soma's sphere, 1 at the first traced point outside it, 2 beyond; see
    /// [`GenerateOptions::rings`].
    pub position: f64,
    /// Its center (µm), relative to the mesh's origin.
    pub center: DVec3,
    /// Unit normal of its plane, away from the soma.
    pub outwards: DVec3,
    /// Its radius (µm).
    pub radius: f64,
}

/// Builds the closed coarse mesh of a cell. What cannot be meshed as traced is mended or left out, and
/// reported.
///
/// # Errors
/// Where coordinates or radii are so large that 32-bit coordinates do not hold the surface.
pub fn generate(
    morphology: &Morphology,
    options: &GenerateOptions,
) -> Result<Generated, GenerateError> {
    generate_watched(morphology, options, &Watch::default())
}

/// What is to be said of kinds that are asked for and that no section has: of usual ones only where there is none, since they
/// may be asked for of many cells.
pub fn unused_kinds<'m>(
    cells: impl IntoIterator<Item = &'m Morphology>,
    kinds: Option<&[NeuriteKind]>,
) -> Option<String> {
    let kinds = kinds?;
    let mut unused: Vec<i32> = kinds.iter().map(|kind| kind.0).collect();
    for cell in cells {
        unused.retain(|&kind| !cell.sections.iter().any(|section| section.kind.0 == kind));
    }
    let is_usual = |kind: &i32| (0..=4).contains(kind);
    if unused.len() < kinds.len() {
        unused.retain(|kind| !is_usual(kind));
    }
    let names: Vec<String> = unused.iter().map(i32::to_string).collect();
    (!names.is_empty()).then(|| format!("no point is of type {}", names.join(", ")))
}

/// [`generate`], which ends soon after it is stopped, and reports what share of the time somata take.
///
/// # Errors
/// As [`generate`], and [`GenerateError::Stopped`].
pub fn generate_watched(
    morphology: &Morphology,
    options: &GenerateOptions,
    watch: &Watch<'_>,
) -> Result<Generated, GenerateError> {
    let labels = morphology.sample_labels();
    let mut generated = labeled(morphology, options, watch)
        .map_err(|e| e.with_own_sample(|label| labels.own_number(label)))?;
    if !labels.are_own() {
        for warning in &mut generated.warnings {
            warning.sample = warning.sample.map(|label| labels.own_number(label));
        }
        let mut long = Warnings::default();
        let first = morphology
            .sample_ids
            .iter()
            .find(|id| i32::try_from(**id).is_err());
        long.add(
            "long_sample_numbers",
            first.copied(),
            "numbers of samples that 32 bits do not hold: the mesh has places instead, from 1 on, the somata's samples first, \
             then the points in depth-first order, as in the rows of a table of the cell",
        );
        generated.warnings.extend(long.into_vec());
    }
    Ok(generated)
}

/// The mesh, with samples called by their [labels](neurotess_morphology::SampleLabels) everywhere.
fn labeled(
    morphology: &Morphology,
    options: &GenerateOptions,
    watch: &Watch<'_>,
) -> Result<Generated, GenerateError> {
    let mut steps = Steps::begin(watch, Stage::Mesh, 4);
    let mut warnings = Warnings::default();
    if let Some(message) = unused_kinds([morphology], options.kinds.as_deref()) {
        warnings.add("types_unused", None, &message);
    }
    let as_neurites = soma::AsNeurites::new(morphology, options, &mut warnings);
    let mut skeleton = Skeleton::new(morphology, options.kinds.as_deref(), &as_neurites.is);
    mend::mend_radii(&mut skeleton, options.unknown_radius, &mut warnings);
    mend::thicken(&mut skeleton, options.least_radius, &mut warnings);
    coordinates::check(morphology, &skeleton, &mut warnings)?;
    soma_ends::finish(&mut skeleton);
    mend::merge_coincident(&mut skeleton, &mut warnings);
    repeated::leave_out(&mut skeleton, &mut warnings);
    let mut soma_spheres =
        soma::soma_spheres(morphology, &skeleton, as_neurites, options, &mut warnings);
    let hubs = hubs::find(&mut skeleton, &mut soma_spheres, options, &mut warnings);
    let labels = labels(morphology, &hubs);
    stubs::measure(&skeleton, &mut soma_spheres, options);
    near_forks::part(
        &mut skeleton,
        &soma_spheres,
        options.soma == SomaMethod::Fem,
        &mut warnings,
    );
    mend::leave_out_inside(&mut skeleton, &soma_spheres, &mut warnings);
    let smoothing = smooth::smooth(&mut skeleton, options.smooth, &mut warnings);
    if options.radius_factor != 1.0 || options.polygons.is_some() {
        // After smoothing, which is to take away the noise of the radii that were traced.
        mend::change_radii(&mut skeleton, |traced| options.radius(traced));
        coordinates::check(morphology, &skeleton, &mut Warnings::default())?;
    }
    stems::gather(&mut skeleton, &soma_spheres, &mut warnings);
    watch.check()?;
    steps.next();
    let start = watch.seconds();
    let requests = RingRequests::new(morphology, options);
    let built = soma::build(
        &mut skeleton,
        &mut soma_spheres,
        &requests,
        options,
        &mut warnings,
        watch,
    );
    let soma_seconds = watch.seconds() - start;
    watch.check()?;
    steps.next();

    thin::drop_buried_twigs(&mut skeleton, &mut warnings);
    thin::merge_close_forks(&mut skeleton, &mut warnings);
    skeleton.start_free_trees_at_an_end();
    mend::lengthen_single_points(&mut skeleton, &mut warnings);
    thin::space_points(&mut skeleton, &mut warnings);
    let separated = match options.crossings {
        Crossings::Keep => None,
        Crossings::Separate => Some(separate::separate(
            &mut skeleton,
            &soma_spheres,
            &labels
                .iter()
                .map(|label| label.sample)
                .collect::<Vec<i64>>(),
            &mut warnings,
            watch,
        )),
    };
    watch.check()?;
    steps.next();
    let may_join = |from: u32, to: u32| {
        let separated = separated.as_ref();
        separated.is_none_or(|separated| separated.clearance.allows(from, to))
    };
    let somata = Somata {
        labels: &labels,
        soma_spheres: &soma_spheres,
        surfaces: &built.somata,
    };
    let mut mesh = judge::sound_mesh(&skeleton, &somata, &may_join, &mut warnings, &steps);
    watch.check()?;
    steps.next();
    mesh.origin = morphology.origin;
    if let Some(polygons) = options.polygons {
        tell_traced_radii(&mut mesh, polygons);
    }
    let lost = |v: &&Vertex| !(v.position.is_finite() && v.normal.is_finite());
    if let Some(vertex) = mesh.vertices.iter().find(lost) {
        let sample = i64::from(mesh.tracing[vertex.tracing as usize].sample.0);
        return Err(GenerateError::NotFinite { sample });
    }
    let reports = built.somata.iter().flatten().map(|soma| soma.report);
    Ok(Generated {
        mesh,
        somata: reports.collect(),
        rings: built.rings,
        warnings: warnings.into_vec(),
        smoothing,
        separation: separated.map(|s| s.report),
        soma_seconds,
    })
}

/// Tells the radii of neurites as they were traced; their rings are larger.
fn tell_traced_radii(mesh: &mut CoarseMesh, polygons: Polygons) {
    let tracing = mesh.tracing.iter_mut();
    for point in tracing.filter(|point| point.role != Role::Soma) {
        point.radius = polygons.traced(f64::from(point.radius)) as f32;
    }
}

/// What the surfaces of somata are labeled as, those of hubs after all others.
fn labels(morphology: &Morphology, hubs: &[Hub]) -> Vec<SomaLabel> {
    let numbers = morphology.sample_labels();
    let of_soma = |(index, soma): (usize, &Soma)| SomaLabel {
        sample: match soma.samples.is_empty() {
            true => -1,
            false => numbers.of_soma(index, 0).into(),
        },
        kind: SwcType::SOMA,
        section: SectionNumber::SOMA,
    };
    let of_hub = |hub: &Hub| SomaLabel {
        sample: hub.node.sample,
        kind: hub.node.kind,
        section: hub.node.section,
    };
    let somata = morphology.somata.iter().enumerate().map(of_soma);
    somata.chain(hubs.iter().map(of_hub)).collect()
}
