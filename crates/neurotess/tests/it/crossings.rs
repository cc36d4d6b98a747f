//! Branches that were traced through one another are moved apart: judged on triangles.

#[path = "../../examples/crossings/judge.rs"]
mod judge;

use std::path::PathBuf;

use neurotess::formats::{Format, ReadOptions, read, read_bytes};
use neurotess::generate::{Crossings, GenerateOptions, Generated, SeparatedPlace, generate};
#[cfg(feature = "synth")]
use neurotess::mesh::{SurfaceMesh, search_self_intersections};
use neurotess::morphology::Morphology;
#[cfg(feature = "synth")]
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_testing::{note, shared, shared_data};

use judge::judge;

fn with(morphology: &Morphology, crossings: Crossings) -> Generated {
    let options = GenerateOptions {
        crossings,
        ..GenerateOptions::default()
    };
    generate(morphology, &options).expect("meshed")
}

/// A soma with two dendrites; an axon runs through one of them, and its tip through the soma.
const TANGLED: &str = "\
1 1 0 0 0 6 -1
2 3 7 0 0 1 1
3 3 20 0 0 1 2
4 3 40 4 0 1 3
5 3 -7 0 0 1.2 1
6 3 -30 0 3 1 5
7 2 0 7 0 0.4 1
8 2 10 14 2 0.4 7
9 2 20 6 1 0.4 8
10 2 20 -6 -1 0.3 9
11 2 8 -10 -1 0.3 10
12 2 -12 1.5 -4 0.3 11
13 2 -16 4 -5 0.3 12
14 2 -18 9 -5 0.3 13
";

fn tangled() -> Morphology {
    let bytes = TANGLED.as_bytes().to_vec();
    let read = read_bytes(bytes, "tangled", Some(Format::Swc), &ReadOptions::default());
    read.expect("a tracing").morphology
}

#[neurotess_testing::test]
fn a_tangled_cell_gets_a_surface_without_crossings() {
    let morphology = tangled();
    let kept = with(&morphology, Crossings::Keep);
    assert!(kept.separation.is_none());
    assert!(judge(&morphology, &kept.mesh).apart > 0);
    let parted = with(&morphology, Crossings::Separate);
    let crossing = judge(&morphology, &parted.mesh);
    assert_eq!((crossing.near, crossing.apart), (0, 0), "{crossing:?}");
    let topology = parted.mesh.topology();
    assert!(topology.closed && topology.oriented, "{topology:?}");
    let places = parted.separation.expect("a report").places;
    let samples: Vec<[i64; 2]> = places.iter().map(|p| p.samples).collect();
    // The dendrite at (20, 0, 0), and the soma, whose first sample is 1.
    assert!(samples.iter().any(|s| s[0] == 3), "{places:?}");
    assert!(samples.iter().any(|s| s[1] == 1), "{places:?}");
    assert!(
        places.iter().all(|p| p.before > 0.0 && p.after == 0.0),
        "{places:?}"
    );
}

#[neurotess_testing::test]
fn the_same_cell_gets_the_same_surface_again() {
    let morphology = tangled();
    let first = with(&morphology, Crossings::Separate);
    let second = with(&morphology, Crossings::Separate);
    assert_eq!(first.mesh, second.mesh);
    assert_eq!(first.separation, second.separation);
}

#[cfg(feature = "synth")]
#[neurotess_testing::test]
fn grown_cells_have_surfaces_without_crossings() {
    use neurotess::synth::{Kind, Options, grow};
    let pairs = |options: &Options, level| {
        let mesh = with(&grow(options), Crossings::Keep).mesh;
        let lod = LodCriterion::Homogeneous(level);
        let refinement = Refinement::new(&mesh, lod, &RefineOptions::default());
        let surface = SurfaceMesh::collect(&refinement);
        search_self_intersections(&surface.positions(), &surface.faces)
            .pairs
            .len()
    };
    for kind in Kind::ALL {
        let sample = Options::sample(kind);
        assert_eq!([2, 4].map(|level| pairs(&sample, level)), [0, 0], "{kind}");
        for seed in 2..neurotess_testing::cases(3, 5) {
            assert_eq!(pairs(&Options::new(kind, seed), 2), 0, "{kind} {seed}");
        }
    }
    let crossing = Options {
        may_cross: true,
        ..Options::sample(Kind::Purkinje)
    };
    assert!(pairs(&crossing, 2) > 1000);
}

/// Real cells of 149 to 19,016 points, without copies of one another.
fn real_cells() -> Vec<PathBuf> {
    let names = [
        "swc/Cha-F-700113.CNG.swc",
        "swc/ExampleNeuron.swc",
        "swc/WT-Contralateral-18.CNG.swc",
        "swc/Cell_305_MPD_8_FT_100_XYZ_Sorted-swc_N3DFix-swc_pruned.swc",
        "swc/Neuron.swc",
        "swc/Pvalb_469628681_m.swc",
        "swc/IF4_140201.CNG.swc",
        "swc/172993.swc",
        "swc/C270106C_-_Scale_x1.000_y1.050_z1.000.swc",
        "swc/C210401C.swc",
        "swc/485184849_reconstruction.swc",
        "swc/vd130423_idC.swc",
        "asc/bio_neuron-000.asc",
        "asc/C270106A.asc",
        "asc/neuron_Neurolucida_ASC.asc",
    ];
    names.iter().map(|name| shared_data().join(name)).collect()
}

#[neurotess_testing::test(needs(neurotess_testing::full, shared))]
fn branches_of_real_cells_are_apart_and_hardly_moved() {
    let mut crossing_cells = Vec::new();
    for file in real_cells() {
        let morphology = read(&file, &ReadOptions::default())
            .expect("a tracing")
            .morphology;
        let generated = with(&morphology, Crossings::Separate);
        let separation = generated.separation.as_ref().expect("a report");
        let name = &morphology.name;
        let crossing = judge(&morphology, &generated.mesh);
        note!("{name}: {} places, {crossing:?}", separation.places.len());
        assert!(separation.complete, "{name}");
        // Two children of a fork may begin at its very place, as of sample 10943 of one cell, thick 0.145 µm and 0.025 µm
        // in one another there: the fork's own patches join them, and nothing crosses.
        let at_fork = |p: &SeparatedPlace| p.samples[0] == p.samples[1] && p.after < 0.03;
        assert!(
            separation
                .places
                .iter()
                .all(|p| p.after == 0.0 || at_fork(p)),
            "{name}: {separation:?}"
        );
        assert!(separation.median_move_radii <= 1.0, "{name}");
        assert!(separation.length_change.abs() <= 0.02, "{name}");
        if crossing.apart > 0 {
            crossing_cells.push((name.clone(), crossing.apart));
        }
    }
    // Two forks of a cell whose radii jump are wider than their branches are apart.
    let allowed = |(name, pairs): &(String, usize)| name == "Neuron" && *pairs <= 20;
    assert!(crossing_cells.iter().all(allowed), "{crossing_cells:?}");
}
