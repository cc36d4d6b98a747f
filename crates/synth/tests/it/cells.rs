//! What holds for every synthetic cell.

use std::f64::consts::PI;

use neurotess_formats::{ReadOptions, swc};
use neurotess_morphology::{Attachment, Measures, Morphology, NeuriteKind, SectionId, shape};
use neurotess_synth::{Kind, Options, POINTS, grow};

fn cell(kind: Kind, seed: u64, points: usize) -> Morphology {
    grow(&Options {
        points: Some(points),
        ..Options::new(kind, seed)
    })
}

/// Some of each kind, from small to large.
fn cells() -> impl Iterator<Item = (String, Morphology)> {
    let sizes = [
        (1, 50),
        (2, 51),
        (3, 200),
        (4, 1000),
        (5, 5000),
        (6, 30_000),
    ];
    Kind::ALL.into_iter().flat_map(move |kind| {
        sizes.map(|(seed, points)| (format!("{kind} {seed} {points}"), cell(kind, seed, points)))
    })
}

fn written(cell: &Morphology) -> Vec<u8> {
    let mut text = Vec::new();
    swc::write(cell, &mut text).expect("memory");
    text
}

/// FNV-1a, 64 bits.
fn hash(bytes: &[u8]) -> u64 {
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

#[neurotess_testing::test]
fn kind_and_seed_decide_every_byte_of_the_file() {
    for (golden, may_cross) in [(GOLDEN, false), (GOLDEN_CROSSING, true)] {
        let found: Vec<(&str, u64, u64)> = Kind::ALL
            .into_iter()
            .flat_map(|kind| [1, 2].map(|seed| Options::new(kind, seed)))
            .map(|options| {
                let cell = grow(&Options {
                    may_cross,
                    ..options
                });
                (options.kind.name(), options.seed, hash(&written(&cell)))
            })
            .collect();
        assert_eq!(
            found, golden,
            "may_cross {may_cross}: if that is meant, write these here and renew the samples"
        );
    }
}

#[neurotess_testing::test]
fn the_number_of_points_is_met_exactly() {
    for (name, cell) in cells() {
        let points: usize = name
            .rsplit(' ')
            .next()
            .and_then(|n| n.parse().ok())
            .expect("a number");
        assert_eq!(cell.points.len(), points, "{name}");
    }
}

#[neurotess_testing::test]
fn numbers_of_points_out_of_range_become_the_nearest() {
    assert_eq!(cell(Kind::Star, 1, 3).points.len(), *POINTS.start());
}

#[neurotess_testing::test(needs(neurotess_testing::full))]
fn large_cells_have_more_and_longer_branches() {
    for kind in Kind::ALL {
        let sizes = [50, 5000, 500_000].map(|points| cell(kind, 9, points));
        let forks = sizes
            .each_ref()
            .map(|cell| Measures::of(cell).n_bifurcations);
        let reach = sizes
            .each_ref()
            .map(|cell| shape::path_lengths(cell).into_iter().fold(0.0, f64::max));
        assert!(
            forks[1] > 3 * forks[0] && forks[2] > 8 * forks[1],
            "{kind}: {forks:?} forks"
        );
        assert!(
            reach[1] > 1.5 * reach[0] && reach[2] > 1.5 * reach[1],
            "{kind}: {reach:?} µm"
        );
        assert_eq!(sizes[2].points.len(), 500_000, "{kind}");
    }
}

#[neurotess_testing::test]
fn radii_are_positive_and_steps_no_shorter_than_they() {
    for (name, cell) in cells() {
        assert!(cell.points.iter().all(|p| p.radius > 0.05), "{name}");
        for index in 0..cell.sections.len() {
            for (a, b) in shape::links(&cell, SectionId(index as u32)) {
                let step = a.position.distance(b.position);
                assert!(step > 0.95 * a.radius.max(b.radius), "{name}: {a:?} {b:?}");
            }
        }
    }
}

#[neurotess_testing::test]
fn neurites_start_outside_the_soma_and_axons_start_thin() {
    for (name, cell) in cells() {
        let soma = cell.soma().expect("a soma");
        let mut thickest_axon = 0.0_f32;
        let mut thickest = 0.0_f32;
        for section in &cell.sections {
            if section.attachment == (Attachment::Soma { soma: 0, sample: 0 }) {
                let first = cell.points[section.first as usize];
                let distance = first.position.distance(soma.center);
                assert!(distance >= soma.radius + first.radius - 0.01, "{name}");
                thickest = thickest.max(first.radius);
                if section.kind == NeuriteKind::AXON {
                    thickest_axon = thickest_axon.max(first.radius);
                }
            } else {
                assert!(
                    section.parent().is_some(),
                    "{name}: a neurite hangs on nothing"
                );
            }
        }
        assert!(
            thickest_axon < 0.75 * thickest,
            "{name}: {thickest_axon} of {thickest}"
        );
    }
}

#[neurotess_testing::test]
fn radii_obey_ralls_law_where_no_daughter_is_the_thinnest() {
    let mut forks = 0;
    for (name, cell) in cells() {
        for (index, [a, b]) in daughters(&cell) {
            let parent = cell
                .section_points(SectionId(index))
                .last()
                .expect("a point")
                .radius;
            let of_kind = cell.sections[index as usize].kind;
            let same = cell.sections.iter().filter(|s| s.kind == of_kind);
            let radii = same.flat_map(|s| &cell.points[s.range()]).map(|p| p.radius);
            let thinnest = radii.fold(f32::INFINITY, f32::min);
            assert!(
                a.max(b) <= parent + 1e-4,
                "{name}: a daughter is thicker than its parent"
            );
            if a.min(b) > 1.1 * thinnest {
                forks += 1;
                let (sum, whole) = (a.powf(1.5) + b.powf(1.5), parent.powf(1.5));
                assert!(
                    (sum / whole - 1.0).abs() < 2e-3,
                    "{name}: {a} and {b} of {parent}"
                );
            }
        }
    }
    assert!(
        forks > 200,
        "only {forks} forks are thick enough to look at"
    );
}

/// Radii at the start of the two daughters of sections that have them, of small cells.
fn daughters(cell: &Morphology) -> Vec<(u32, [f32; 2])> {
    if cell.points.len() > 5000 {
        return Vec::new();
    }
    let mut first = vec![Vec::new(); cell.sections.len()];
    for section in &cell.sections {
        if let Some(parent) = section.parent() {
            first[parent.index()].push(cell.points[section.first as usize].radius);
        }
    }
    let pairs = (0_u32..).zip(first);
    pairs
        .filter_map(|(i, radii)| Some((i, <[f32; 2]>::try_from(radii).ok()?)))
        .collect()
}

#[neurotess_testing::test]
fn branches_wind_and_fork_like_those_of_real_cells() {
    for kind in Kind::ALL {
        let cell = cell(kind, 3, 5000);
        let lengths = shape::section_lengths(&cell);
        let long = shape::contractions(&cell)
            .into_iter()
            .zip(&lengths)
            .filter(|(_, l)| **l > 20.0);
        let contraction = mean(long.filter_map(|(contraction, _)| contraction));
        assert!(
            (0.85..0.97).contains(&contraction),
            "{kind}: contraction {contraction}"
        );
        let angle = mean(shape::fork_angles(&cell, 10.0).into_iter().flatten()) * 180.0 / PI;
        let usual = if kind == Kind::Granule {
            50.0..110.0
        } else {
            50.0..80.0
        };
        assert!(usual.contains(&angle), "{kind}: fork angle {angle}°");
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[neurotess_testing::test]
fn a_purkinje_cells_fan_is_flat() {
    let cell = cell(Kind::Purkinje, 1, 6000);
    let fan = cell
        .sections
        .iter()
        .filter(|s| s.kind == NeuriteKind::BASAL_DENDRITE);
    let points = || fan.clone().flat_map(|s| &cell.points[s.range()]);
    let reach = |axis: usize| points().map(|p| p.position[axis].abs()).fold(0.0, f32::max);
    assert!(
        reach(2) < 0.15 * reach(0).max(reach(1)),
        "{} by {} by {}",
        reach(0),
        reach(1),
        reach(2)
    );
}

#[neurotess_testing::test]
fn files_of_synthetic_cells_are_read_strictly_and_equal() {
    for (name, cell) in cells() {
        let file = format!("{}.swc", cell.name);
        let read = swc::read_bytes(
            &written(&cell),
            &file,
            &ReadOptions {
                strict: true,
                ..ReadOptions::default()
            },
        );
        assert!(read.expect(&name).morphology == cell, "{name}");
    }
}

#[neurotess_testing::test]
fn kinds_are_parsed_by_their_names() {
    for kind in Kind::ALL {
        assert_eq!(kind.to_string().parse(), Ok(kind));
    }
    let e = "glia".parse::<Kind>().expect_err("no neuron").to_string();
    assert!(e.contains("pyramidal, purkinje"), "{e}");
}

/// Kind, seed, hash of the SWC file at the usual size, of cells that may cross themselves.
const GOLDEN_CROSSING: [(&str, u64, u64); 12] = [
    ("pyramidal", 1, 3_404_723_738_286_854_517),
    ("pyramidal", 2, 6_161_919_719_877_750_040),
    ("purkinje", 1, 9_692_813_581_083_885_980),
    ("purkinje", 2, 8_668_493_766_881_020_317),
    ("granule", 1, 11_682_729_029_823_113_795),
    ("granule", 2, 1_485_074_767_557_933_427),
    ("basket", 1, 6_690_333_554_927_843_683),
    ("basket", 2, 11_752_134_174_137_509_544),
    ("motor", 1, 4_538_575_594_779_081_678),
    ("motor", 2, 16_739_063_700_720_842_464),
    ("star", 1, 6_767_737_289_165_049_164),
    ("star", 2, 1_565_589_172_851_256_163),
];

/// The same of cells that keep clear of themselves.
const GOLDEN: [(&str, u64, u64); 12] = [
    ("pyramidal", 1, 7_541_148_502_588_144_356),
    ("pyramidal", 2, 9_291_984_363_005_563_818),
    ("purkinje", 1, 7_056_461_752_850_214_758),
    ("purkinje", 2, 14_417_780_747_152_851_903),
    ("granule", 1, 10_024_616_438_738_374_696),
    ("granule", 2, 2_642_073_958_036_474_178),
    ("basket", 1, 13_438_046_400_541_607_636),
    ("basket", 2, 2_612_930_697_610_275_111),
    ("motor", 1, 673_609_113_110_350_626),
    ("motor", 2, 3_977_480_284_558_576_671),
    ("star", 1, 3_818_989_364_909_102_493),
    ("star", 2, 11_027_502_472_665_331_781),
];
