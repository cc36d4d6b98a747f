//! The numbers that NEURON, SONATA and MorphIO give sections, from every reader and through every writer.

use std::collections::HashMap;

use neurotess_formats::{Format, Read, ReadOptions, asc, read, read_bytes, swc, write};
use neurotess_morphology::{Membrane, Morphology, Program, SectionNumbers, SectionPlace};
use neurotess_testing::{shared, shared_data};
use proptest::prelude::*;

fn swc_cell(text: &str) -> Morphology {
    let read = swc::read_bytes(text.as_bytes(), "cell", &ReadOptions::default());
    read.expect("a cell").morphology
}

/// Where each section ends that a program numbers, from the least number on.
fn ends(cell: &Morphology, program: Program) -> Vec<[f32; 3]> {
    let numbers = SectionNumbers::of(cell, program);
    let membrane = Membrane::of(cell);
    let end = |number| match numbers.place(number, 1.0) {
        Some(SectionPlace::Section(section, along)) => {
            let place = membrane.on_section(section, along.into()).expect("on it");
            let rounded = (1e3 * place.center).round() / 1e3;
            rounded.as_vec3().to_array()
        }
        other => panic!("{number} is {other:?}"),
    };
    numbers.numbers().map(end).collect()
}

/// A tree of 13 samples; its axon, second in the file, is the first of NEURON's sections.
const TREE: &str = "1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 16 0 0 1 2\n4 3 26 5 0 1 3\n5 3 36 9 0 1 4\n6 3 36 1 0 1 4\n\
                    7 3 26 -5 0 1 3\n8 2 -6 0 0 .5 1\n9 2 -16 0 0 .5 8\n10 3 0 6 0 1 1\n11 3 0 16 0 1 10\n\
                    12 4 0 0 6 1 1\n13 4 0 0 16 1 12\n";
/// The same with its neurites, and the branches of a fork, the other way round.
const REVERSED: &str = "1 1 0 0 0 5 -1\n2 4 0 0 6 1 1\n3 4 0 0 16 1 2\n4 3 0 6 0 1 1\n5 3 0 16 0 1 4\n\
                        6 2 -6 0 0 .5 1\n7 2 -16 0 0 .5 6\n8 3 6 0 0 1 1\n9 3 16 0 0 1 8\n10 3 26 -5 0 1 9\n\
                        11 3 26 5 0 1 9\n12 3 36 1 0 1 11\n13 3 36 9 0 1 11\n";
/// Each section in one piece, in the order of their distance from the soma.
const BREADTH_FIRST: &str = "1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 20 0 0 1 2\n4 3 25 5 0 .8 3\n5 3 30 10 0 .8 4\n\
                             6 3 25 -5 0 .8 3\n7 3 30 -10 0 .8 6\n8 3 35 15 0 .8 5\n9 3 40 20 0 .8 8\n\
                             10 3 35 10 0 .8 5\n11 3 40 10 0 .8 10\n12 3 35 -10 0 .8 7\n13 3 40 -10 0 .8 12\n\
                             14 3 35 -15 0 .8 7\n15 3 40 -20 0 .8 14\n";
/// A type that changes within a branch begins a section; types of one's own come last.
const TYPED: &str = "1 1 0 0 0 5 -1\n2 3 6 0 0 1 1\n3 3 16 0 0 1 2\n4 4 26 5 0 1 3\n5 4 36 5 0 1 4\n6 7 -6 0 0 1 1\n\
                     7 7 -16 0 0 1 6\n8 2 0 6 0 1 1\n9 2 0 16 0 1 8\n10 3 0 -6 0 1 1\n11 3 0 -16 0 1 10\n";

/// As NEURON 9.0.2 and MorphIO 3.5.0 print them.
#[neurotess_testing::test]
fn sections_have_the_numbers_of_neuron_and_morphio() {
    type Places = &'static [[f32; 3]];
    let table: [(&str, Places, Places); 4] = [
        (
            TREE,
            &[
                [-16., 0., 0.],
                [16., 0., 0.],
                [26., 5., 0.],
                [36., 9., 0.],
                [36., 1., 0.],
                [26., -5., 0.],
                [0., 16., 0.],
                [0., 0., 16.],
            ],
            &[
                [16., 0., 0.],
                [26., 5., 0.],
                [36., 9., 0.],
                [36., 1., 0.],
                [26., -5., 0.],
                [-16., 0., 0.],
                [0., 16., 0.],
                [0., 0., 16.],
            ],
        ),
        (
            REVERSED,
            &[
                [-16., 0., 0.],
                [0., 16., 0.],
                [16., 0., 0.],
                [26., -5., 0.],
                [26., 5., 0.],
                [36., 1., 0.],
                [36., 9., 0.],
                [0., 0., 16.],
            ],
            &[
                [0., 0., 16.],
                [0., 16., 0.],
                [-16., 0., 0.],
                [16., 0., 0.],
                [26., -5., 0.],
                [26., 5., 0.],
                [36., 1., 0.],
                [36., 9., 0.],
            ],
        ),
        (
            BREADTH_FIRST,
            &[
                [20., 0., 0.],
                [30., 10., 0.],
                [30., -10., 0.],
                [40., 20., 0.],
                [40., 10., 0.],
                [40., -10., 0.],
                [40., -20., 0.],
            ],
            &[
                [20., 0., 0.],
                [30., 10., 0.],
                [40., 20., 0.],
                [40., 10., 0.],
                [30., -10., 0.],
                [40., -10., 0.],
                [40., -20., 0.],
            ],
        ),
        (
            TYPED,
            &[
                [0., 16., 0.],
                [16., 0., 0.],
                [0., -16., 0.],
                [36., 5., 0.],
                [-16., 0., 0.],
            ],
            // MorphIO refuses it.
            &[],
        ),
    ];
    for (text, neuron, morphio) in table {
        let cell = swc_cell(text);
        assert_eq!(ends(&cell, Program::Neuron), neuron);
        if !morphio.is_empty() {
            assert_eq!(ends(&cell, Program::Morphio), morphio);
        }
    }
}

/// Sections of ASC with an only child, and with branches that are but copies of their fork: NEURON 9.0.2 and MorphIO 3.5.0
/// number the first, and leave out the others.
const ONLY_CHILD: &str = "(\"CellBody\" (CellBody) (5 0 0 0.1) (0 5 0 0.1) (-5 0 0 0.1) (0 -5 0 0.1))\n\
    ((Dendrite) (6 0 0 2) (20 0 0 2)\n ((20 0 0 2)\n | (30 2 0 1.6) (40 4 0 1.6)\n\
    ((40 4 0 1.6) ((50 10 0 1) (60 10 0 1)) | (50 0 0 1) (60 0 0 1))))\n\
    ((Dendrite) (-6 0 0 2) (-30 0 0 1) ((-40 0 0 1) (-50 0 0 1)))\n((Axon) (0 6 0 1) (0 30 0 1))\n";

#[neurotess_testing::test]
fn an_only_child_has_a_number_of_its_own() {
    let read = asc::read_bytes(ONLY_CHILD.as_bytes(), "cell", &ReadOptions::default());
    let cell = read.expect("a cell").morphology;
    // Ours go on through only children.
    assert_eq!(cell.sections.len(), 5);
    let dendrites = [[20., 0., 0.], [40., 4., 0.], [60., 10., 0.], [60., 0., 0.]];
    let others = [[-30., 0., 0.], [-50., 0., 0.]];
    let axon = [0., 30., 0.];
    let neuron: Vec<[f32; 3]> = [axon].into_iter().chain(dendrites).chain(others).collect();
    let morphio: Vec<[f32; 3]> = dendrites.into_iter().chain(others).chain([axon]).collect();
    assert_eq!(ends(&cell, Program::Neuron), neuron);
    assert_eq!(ends(&cell, Program::Morphio), morphio);
    let numbers = SectionNumbers::of(&cell, Program::Neuron);
    // Half-way along the only child: 30 µm of the 44 that it and its parent have, and back.
    let Some(SectionPlace::Section(section, along)) = numbers.place(7, 0.5) else {
        panic!("no section 7");
    };
    assert_eq!(cell.section_points(section).len(), 4);
    assert!((along - 34.0 / 44.0).abs() < 1e-6, "{along}");
    let (number, share) = numbers.at(section, 34.0);
    assert!(
        number == 7 && (share - 0.5).abs() < 1e-6,
        "{number} {share}"
    );
    assert_eq!(numbers.at(section, 24.0), (6, 1.0));
    // ASC and H5 keep them, SWC cannot and says so.
    for format in [Format::Asc, Format::H5] {
        let (copy, codes) = through(&cell, format);
        assert_eq!(ends(&copy, Program::Neuron), neuron, "{format:?}");
        assert!(!codes.contains(&"sections_renumbered"), "{codes:?}");
    }
    let (copy, codes) = through(&cell, Format::Swc);
    assert_eq!(copy.file_sections.sections.len(), 5);
    assert!(codes.contains(&"sections_renumbered"), "{codes:?}");
}

#[neurotess_testing::test]
fn rows_of_h5_are_numbers_even_where_they_repeat_their_fork_alone() {
    use hdf5_pure::FileBuilder;
    let points: [[f64; 4]; 11] = [
        [0., 0., 0., 9.],
        [6., 0., 0., 2.],
        [20., 0., 0., 2.],
        [-6., 0., 0., 2.],
        [-20., 0., 0., 2.],
        // A row with a copy of the fork and nothing else, then its sibling.
        [20., 0., 0., 2.],
        [20., 0., 0., 2.],
        [30., -10., 0., 2.],
        [30., -10., 0., 2.],
        [40., -10., 0., 2.],
        [40., -10., 0., 2.],
    ];
    let structure = [
        [0, 1, -1],
        [1, 3, 0],
        [3, 2, 0],
        [5, 3, 1],
        [6, 3, 1],
        [8, 3, 4],
    ];
    let mut file = FileBuilder::new();
    let flat: Vec<f64> = points[..10].iter().flatten().copied().collect();
    file.create_dataset("points")
        .with_f64_data(&flat)
        .with_shape(&[10, 4]);
    let flat: Vec<i32> = structure.iter().flatten().copied().collect();
    file.create_dataset("structure")
        .with_i32_data(&flat)
        .with_shape(&[6, 3]);
    let bytes = file.finish().expect("a file");
    let read = read_bytes(bytes, "cell.h5", Some(Format::H5), &ReadOptions::default());
    let cell = read.expect("a cell").morphology;
    // The empty row is where its fork is.
    let neuron = [
        [-20., 0., 0.],
        [20., 0., 0.],
        [20., 0., 0.],
        [30., -10., 0.],
        [40., -10., 0.],
    ];
    let morphio = [
        [20., 0., 0.],
        [-20., 0., 0.],
        [20., 0., 0.],
        [30., -10., 0.],
        [40., -10., 0.],
    ];
    assert_eq!(ends(&cell, Program::Neuron), neuron);
    assert_eq!(ends(&cell, Program::Morphio), morphio);
}

#[neurotess_testing::test(needs(shared))]
fn public_cells_with_only_children_have_as_many_sections_as_their_files() {
    let file = shared_data().join("../faults/s2_only_child_asc/morph/cell.asc");
    let cell = read(&file, &ReadOptions::default())
        .expect("a cell")
        .morphology;
    let expected = [
        [20., 0., 0.],
        [40., 4., 0.],
        [60., 10., 0.],
        [60., 0., 0.],
        [-30., 0., 0.],
    ];
    assert_eq!(ends(&cell, Program::Neuron), expected);
    let file = shared_data().join("../faults/s1_breadth_first/morph/cell.swc");
    let cell = read(&file, &ReadOptions::default())
        .expect("a cell")
        .morphology;
    assert_eq!(ends(&cell, Program::Neuron)[2], [30., -10., 0.]);
}

/// What was written, and the codes of what it lost.
fn through(cell: &Morphology, format: Format) -> (Morphology, Vec<&'static str>) {
    let mut bytes = Vec::new();
    let lost = write(cell, format, &mut bytes).expect("memory takes it");
    let read = read_bytes(bytes, "copy", Some(format), &ReadOptions::default());
    let Read { morphology, .. } = read.expect("a copy");
    (morphology, lost.into_iter().map(|w| w.code).collect())
}

/// The last samples of a file's sections as SONATA's guide words it: a section is a chain of samples between forks and ends;
/// those of the axon come first, then the basal ones, then the apical ones; within these, in the order in which their first
/// segments stand in the file, where each sample is the end of one.
fn by_the_guide(text: &str) -> Vec<[f32; 3]> {
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|line| {
            line.split(' ')
                .map(|x| x.parse().expect("a number"))
                .collect()
        })
        .collect();
    let row_of: HashMap<i64, usize> = rows
        .iter()
        .enumerate()
        .map(|(i, r)| (r[0] as i64, i))
        .collect();
    let parent = |row: usize| row_of.get(&(rows[row][6] as i64)).copied();
    let mut children = vec![Vec::new(); rows.len()];
    for row in 0..rows.len() {
        if let Some(parent) = parent(row) {
            children[parent].push(row);
        }
    }
    let kind = |row: usize| rows[row][1] as i64;
    let begins = |row: &usize| {
        kind(*row) != 1
            && parent(*row)
                .is_none_or(|p| kind(p) == 1 || children[p].len() > 1 || kind(p) != kind(*row))
    };
    let mut sections = Vec::new();
    for group in [2, 3, 4] {
        for first in (0..rows.len())
            .filter(begins)
            .filter(|&row| kind(row) == group)
        {
            let mut last = first;
            while let [only] = children[last][..]
                && kind(only) == kind(last)
            {
                last = only;
            }
            let [x, y, z] = [2, 3, 4].map(|column| rows[last][column] as f32);
            sections.push([x, y, z]);
        }
    }
    sections
}

/// A file of a soma and neurites, each row below its parent's: samples in any such order, with numbers that ascend, or any.
fn files() -> impl Strategy<Value = String> {
    let rows =
        proptest::collection::vec((any::<u16>(), 2..5_i32, any::<u32>(), any::<bool>()), 1..40);
    (rows, any::<bool>()).prop_map(|(rows, shuffled)| {
        let mut numbers: Vec<i64> = (1..=rows.len() as i64 + 1).collect();
        if shuffled {
            let keys: Vec<u32> = [0]
                .into_iter()
                .chain(rows.iter().map(|row| row.2))
                .collect();
            numbers.sort_by_key(|&n| (keys[n as usize - 1], n));
        }
        let mut kinds = vec![1];
        let mut text = format!("{} 1 0 0 0 5 -1\n", numbers[0]);
        for (i, &(parent, kind, _, goes_on)) in rows.iter().enumerate() {
            // Chains are as frequent as forks.
            let parent = if goes_on {
                i
            } else {
                usize::from(parent) % (i + 1)
            };
            let kind = if kinds[parent] == 1 {
                kind
            } else {
                kinds[parent]
            };
            kinds.push(kind);
            let (number, above) = (numbers[i + 1], numbers[parent]);
            text += &format!(
                "{number} {kind} {} {} {} 1 {above}\n",
                9 * i + 9,
                i % 7,
                i % 5
            );
        }
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(300, 3000)))]
    #[neurotess_testing::test]
    fn numbers_are_those_of_the_guide_and_go_through_every_format(text in files()) {
        let cell = swc_cell(&text);
        let expected = by_the_guide(&text);
        prop_assert_eq!(&ends(&cell, Program::Neuron), &expected);
        for format in [Format::Swc, Format::Asc, Format::H5, Format::NeuroMl] {
            let (copy, codes) = through(&cell, format);
            let same = ends(&copy, Program::Neuron) == expected;
            prop_assert_eq!(same, !codes.contains(&"sections_renumbered"), "{:?}", format);
            // ASC is depth first. In NeuroML, a neurite's first point and the next are one segment.
            let lone = cell.sections.iter().any(|s| s.parent().is_none() && s.range().len() == 1);
            if format != Format::Asc && !(lone && format == Format::NeuroMl) {
                prop_assert!(same, "{:?}", format);
            }
        }
        let mut written = Vec::new();
        swc::write(&cell, &mut written).expect("memory takes it");
        let written = String::from_utf8(written).expect("text");
        let ids: Vec<i64> = written.lines().map(|row| {
            row.split(' ').next().expect("a number").parse().expect("a number")
        }).collect();
        prop_assert!(ids.windows(2).all(|pair| pair[0] < pair[1]));
        // NEURON reads the same cell: sections are in one piece.
        let copy = swc_cell(&written);
        prop_assert_eq!(&ends(&copy, Program::Neuron), &by_the_guide(&written));
        let rows: Vec<Vec<&str>> = written.lines().map(|row| row.split(' ').collect()).collect();
        for (row, next) in rows.iter().zip(&rows[1..]).skip(1) {
            let children = rows.iter().filter(|other| other[6] == row[0]);
            if children.count() == 1 {
                prop_assert_eq!(next[6], row[0], "{}", written);
            }
        }
    }
}
