//! The numbers that other programs give a cell's sections, and the places that they mean.
//!
//! **Theory.** SONATA's reports and synapses number sections as NEURON does: 0 is the soma, then all sections of the axon,
//! of the basal dendrites, of the apical ones, and of the rest, each kind in the order in which the first segments of its
//! sections stand in the file (SONATA developer guide, "SWC Format additional requirements"; NEURON 9.0.2 likewise).
//! MorphIO 3.5.0 counts from 0, without the soma: rows of SWC depth first, sections of ASC and H5 as the file has them.
//! **Practice.** [`FileSection`](crate::FileSection)s are sorted once; a place along one of them is found by bisection.

use crate::{FileSection, FileSections, Morphology, NeuriteKind, SectionId, shape};

/// Whose numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Program {
    /// NEURON 9, bmtk, LFPy and SONATA: from 1 by kind and place in the file; 0 is the soma.
    Neuron,
    /// MorphIO 3.5: from 0; the soma has none.
    Morphio,
}

/// A place along one of our sections, or in the soma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SectionPlace {
    /// The soma.
    Soma,
    /// Along a section, from 0 at its start to 1 at its end.
    Section(SectionId, f32),
}

/// The sections of a cell as a program numbers them.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionNumbers {
    program: Program,
    /// By number less the first one: index of the file's section.
    order: Vec<u32>,
    /// By section of the file: its number.
    numbers: Vec<u64>,
    /// Stretches of our sections, in the order of the points.
    stretches: Vec<Stretch>,
    /// By section of ours: index of its first stretch, and at the end how many there are.
    of_section: Vec<u32>,
    /// Indices of stretches, by section of the file.
    by_file_section: Vec<u32>,
    /// By section of the file: its length (µm), and where it is if it has no points: the end of a stretch.
    file_sections: Vec<(f64, Option<u32>)>,
    /// Lengths of our sections (µm).
    lengths: Vec<f64>,
}

/// A [`Piece`](crate::Piece) with distances (µm).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stretch {
    section: SectionId,
    file_section: u32,
    /// Along our section.
    from: f64,
    to: f64,
    /// Where it begins along the file's section.
    begins: f64,
}

impl SectionNumbers {
    /// Takes time linear in the points, and n log n in the sections.
    pub fn of(morphology: &Morphology, program: Program) -> Self {
        let known = morphology.known_file_sections();
        let count = known.sections.len();
        let mut stretches: Vec<Stretch> = Vec::with_capacity(morphology.sections.len());
        let mut of_section = Vec::with_capacity(morphology.sections.len() + 1);
        let mut lengths = Vec::with_capacity(morphology.sections.len());
        let mut file_lengths = vec![0.0; count];
        let mut pieces = morphology.pieces().into_iter().peekable();
        for index in 0..morphology.sections.len() {
            let id = SectionId(index as u32);
            of_section.push(stretches.len() as u32);
            let mut links = shape::links(morphology, id)
                .map(|(a, b)| (a.position.as_dvec3()).distance(b.position.as_dvec3()));
            let begins_on_section = morphology.sections[index].parent().is_some();
            let mut way = 0.0;
            let mut first = !begins_on_section;
            while let Some(piece) = pieces.next_if(|piece| piece.section == id) {
                // The first point of a neurite ends no link.
                let own = piece.points.len() - usize::from(std::mem::take(&mut first));
                let length: f64 = links.by_ref().take(own).sum();
                let of_file = &mut file_lengths[piece.file_section as usize];
                stretches.push(Stretch {
                    section: id,
                    file_section: piece.file_section,
                    from: way,
                    to: way + length,
                    begins: *of_file,
                });
                *of_file += length;
                way += length;
            }
            lengths.push(way);
        }
        of_section.push(stretches.len() as u32);
        let order = order(&known, &stretches, program);
        let mut numbers = vec![0; count];
        for (&file_section, number) in order.iter().zip(program.first()..) {
            numbers[file_section as usize] = number;
        }
        let mut by_file_section: Vec<u32> = (0..stretches.len() as u32).collect();
        by_file_section.sort_by_key(|&stretch| stretches[stretch as usize].file_section);
        let mut numbers = Self {
            program,
            order,
            numbers,
            stretches,
            of_section,
            by_file_section,
            file_sections: file_lengths.into_iter().map(|l| (l, None)).collect(),
            lengths,
        };
        numbers.place_empty(&known.sections);
        numbers
    }

    /// Sections of the file without points are at the end of what they hang on.
    fn place_empty(&mut self, sections: &[FileSection]) {
        for (index, section) in sections.iter().enumerate() {
            let (mut above, mut steps) = (section.parent.filter(|_| section.empty), 0);
            while let Some(parent) = above {
                if let Some(&last) = self.stretches_of(parent).last() {
                    self.file_sections[index].1 = Some(last);
                    break;
                }
                steps += 1;
                // A ring of parents has no beginning.
                let next = sections
                    .get(parent as usize)
                    .filter(|_| steps < sections.len());
                above = next.and_then(|section| section.parent);
            }
        }
    }

    /// Indices of the stretches of a section of the file.
    fn stretches_of(&self, file_section: u32) -> &[u32] {
        let of = |&stretch: &u32| self.stretches[stretch as usize].file_section;
        let begin = self
            .by_file_section
            .partition_point(|s| of(s) < file_section);
        let end = self
            .by_file_section
            .partition_point(|s| of(s) <= file_section);
        &self.by_file_section[begin..end]
    }

    /// How many sections have numbers, the soma not counted.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is no section.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The numbers of sections, from the least on.
    pub fn numbers(&self) -> std::ops::Range<u64> {
        let first = self.program.first();
        first..first + self.order.len() as u64
    }

    /// The length (µm) of the section with a number; none if no section has it.
    pub fn length(&self, number: u64) -> Option<f64> {
        let index = usize::try_from(number.checked_sub(self.program.first())?).ok()?;
        let file_section = *self.order.get(index)?;
        Some(self.file_sections[file_section as usize].0)
    }

    /// The place at a share of the length of the section with a number, from 0 at its start to 1 at its end. None if
    /// no section has the number, or all its points were taken away.
    pub fn place(&self, number: u64, along: f32) -> Option<SectionPlace> {
        if self.program == Program::Neuron && number == 0 {
            return Some(SectionPlace::Soma);
        }
        let index = usize::try_from(number.checked_sub(self.program.first())?).ok()?;
        let file_section = *self.order.get(index)?;
        if along.is_nan() {
            return None;
        }
        let (length, end) = self.file_sections[file_section as usize];
        let end = end.map(|stretch| &self.stretches[stretch as usize]);
        let stretches = self.stretches_of(file_section);
        let (stretch, way) = match (stretches, end) {
            ([], end) => (end?, f64::INFINITY),
            (stretches, _) => {
                let way = f64::from(along) * length;
                let begun = |&stretch: &u32| self.stretches[stretch as usize].begins <= way;
                let last = stretches.partition_point(begun).max(1) - 1;
                let stretch = &self.stretches[stretches[last] as usize];
                (stretch, way - stretch.begins)
            }
        };
        let own = self.lengths[stretch.section.index()];
        let whole = stretch.from <= 0.0 && stretch.to >= own && stretch.begins <= 0.0;
        let along = match whole && length <= own {
            // Not a bit of it is lost where both are one.
            true if way.is_finite() => along,
            _ if own > 0.0 => ((stretch.from + way).min(stretch.to) / own) as f32,
            _ => 0.0,
        };
        Some(SectionPlace::Section(stretch.section, along))
    }

    /// The number of the section at a distance (µm) from the start of one of ours, and the share of its length there. What
    /// lies between two sections of the file belongs to the one that ends.
    ///
    /// # Panics
    /// If the section is not of the cell.
    pub fn at(&self, section: SectionId, way: f64) -> (u64, f32) {
        let begin = self.of_section[section.index()] as usize;
        let end = self.of_section[section.index() + 1] as usize;
        let stretches = &self.stretches[begin..end];
        // Distances are sums of single-precision steps elsewhere.
        let ended = |stretch: &Stretch| stretch.to < way - 1e-6 * (1.0 + way);
        let stretch = &stretches[stretches.partition_point(ended).min(stretches.len() - 1)];
        let (length, _) = self.file_sections[stretch.file_section as usize];
        let way = (way - stretch.from).clamp(0.0, stretch.to - stretch.from) + stretch.begins;
        let share = if length > 0.0 { way / length } else { 0.0 };
        (self.numbers[stretch.file_section as usize], share as f32)
    }

    /// By point: the number of the section that it is from.
    pub fn of_points(&self, morphology: &Morphology) -> Vec<u64> {
        let known = morphology.known_file_sections();
        let number = |&section: &u32| self.numbers[section as usize];
        known.of_points.iter().map(number).collect()
    }

    /// By section of ours: the number of the file's section that its first point is from.
    pub fn of_sections(&self) -> Vec<u64> {
        let firsts = &self.of_section[..self.lengths.len()];
        let number = |&first: &u32| {
            let stretch = &self.stretches[first as usize];
            self.numbers[stretch.file_section as usize]
        };
        firsts.iter().map(number).collect()
    }
}

impl Program {
    /// The number of the first section that is no soma.
    fn first(self) -> u64 {
        match self {
            Self::Neuron => 1,
            Self::Morphio => 0,
        }
    }
}

/// The file's sections as a program counts them.
fn order(known: &FileSections, stretches: &[Stretch], program: Program) -> Vec<u32> {
    let sections = &known.sections;
    let mut order: Vec<u32> = (0..sections.len() as u32).collect();
    match program {
        Program::Neuron => {
            let rank = |kind: NeuriteKind| match kind {
                NeuriteKind::AXON => (0, 0),
                NeuriteKind::BASAL_DENDRITE => (1, 0),
                NeuriteKind::APICAL_DENDRITE => (2, 0),
                NeuriteKind(other) => (3, other),
            };
            order.sort_by_key(|&section| rank(sections[section as usize].kind));
        }
        Program::Morphio if known.told => {}
        Program::Morphio => {
            let mut firsts = vec![u32::MAX; sections.len()];
            for (stretch, place) in stretches.iter().zip(0..) {
                let first = &mut firsts[stretch.file_section as usize];
                *first = (*first).min(place);
            }
            order.sort_by_key(|&section| firsts[section as usize]);
        }
    }
    order
}
