//! `--areas`: a row for each section, with the area of its traced frusta beside that on the mesh.
//!
//! A neurite's **stem**, what the mesh has between the soma and its first traced point, is no part of any frustum. Its
//! faces have the label of the neurite's first section, and are told apart here by where they are: before the plane
//! through the first point, half-way between the ways from the soma and to the second point.

use std::collections::BTreeMap;
use std::io::{Seek, Write};

use glam::DVec3;
use neurotess::mesh::{Surface, WriteError, areas_by};
use neurotess::morphology::{Attachment, Morphology, shape, soma_area_volume};

const HEADER: &str =
    "section,type,parent,first_sample,last_sample,length,traced_area,mesh_area,stem_area\n";

/// Writes the table of a surface in the coordinates of its tracing (µm).
pub(super) fn write<W: Write + Seek>(
    surface: &dyn Surface,
    morphology: &Morphology,
    out: &mut W,
) -> Result<(), WriteError> {
    let stems: Vec<Option<Stem>> = (0..morphology.sections.len())
        .map(|section| Stem::new(morphology, section))
        .collect();
    let areas = areas_by(surface, |label, center| {
        let section = usize::try_from(label.section).ok();
        let section = section.and_then(|number| number.checked_sub(1));
        let stem = section.and_then(|section| stems.get(section)?.as_ref());
        let is_of_stem =
            stem.is_some_and(|stem| label.point == stem.sample && stem.is_before(center));
        (label.section, is_of_stem)
    })?;
    out.write_all(HEADER.as_bytes())?;
    write_rows(morphology, &areas, out)?;
    out.flush()?;
    Ok(())
}

fn write_rows(
    morphology: &Morphology,
    areas: &BTreeMap<(i32, bool), f64>,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let area = |section: i32, is_of_stem| areas.get(&(section, is_of_stem)).copied().unwrap_or(0.0);
    // Faces do not tell somata apart.
    let somata: f64 = (morphology.somata.iter())
        .map(|soma| soma_area_volume(soma).0)
        .sum();
    if !morphology.somata.is_empty() {
        writeln!(out, "0,1,,,,,{somata:.6},{:.6},", area(0, false))?;
    }
    let lengths = shape::section_lengths(morphology);
    let traced = shape::section_areas(morphology);
    for (n, section) in morphology.sections.iter().enumerate() {
        let number = n as i32 + 1;
        let (parent, stem) = match section.attachment {
            Attachment::Section(parent) => ((parent.index() + 1).to_string(), String::new()),
            Attachment::Soma { .. } => ("0".into(), format!("{:.6}", area(number, true))),
            Attachment::Free => (String::new(), String::new()),
        };
        let samples = &morphology.sample_ids[section.range()];
        let [first, last] = [samples.first(), samples.last()].map(|id| id.copied().unwrap_or(-1));
        writeln!(
            out,
            "{number},{},{parent},{first},{last},{:.6},{:.6},{:.6},{stem}",
            section.kind.0,
            lengths[n],
            traced[n],
            area(number, false)
        )?;
    }
    Ok(())
}

/// Where the stem of a neurite ends.
struct Stem {
    /// The first sample of the neurite, and where it is.
    sample: i32,
    end: DVec3,
    /// Along the neurite.
    along: DVec3,
}

impl Stem {
    fn new(morphology: &Morphology, section: usize) -> Option<Self> {
        let section = &morphology.sections[section];
        let Attachment::Soma { soma, .. } = section.attachment else {
            return None;
        };
        let first = section.range().start;
        let place = |position: glam::Vec3| position.as_dvec3() + morphology.origin;
        let end = place(morphology.points.get(first)?.position);
        let center = place(morphology.somata.get(soma as usize)?.center);
        let from_soma = (end - center).normalize_or_zero();
        let onwards = (section.range().len() > 1)
            .then(|| (place(morphology.points[first + 1].position) - end).normalize_or_zero());
        Some(Self {
            sample: morphology.sample_labels().of_point(first),
            end,
            along: from_soma + onwards.unwrap_or_default(),
        })
    }

    fn is_before(&self, place: DVec3) -> bool {
        (place - self.end).dot(self.along) < 0.0
    }
}
