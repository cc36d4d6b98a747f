//! A row for each section, with the area of its traced frusta, what shows of them, and that on the mesh.
//!
//! Stems and caps are no part of any frustum. Their faces have the labels of sections, and are told apart here by where
//! they are.

use std::collections::BTreeMap;
use std::io::{Seek, Write};

use neurotess_mesh::{Surface, WriteError, areas_by};
use neurotess_morphology::{
    Attachment, Morphology, SectionEnds, SectionPart, exposed_areas, shape, soma_area_volume,
};

const HEADER: &str = "section,type,parent,first_sample,last_sample,length,traced_area,exposed_area,mesh_area,stem_area,cap_area\n";

/// Writes the table of a surface in the coordinates of its tracing (µm).
pub(super) fn write<W: Write + Seek>(
    surface: &dyn Surface,
    morphology: &Morphology,
    out: &mut W,
) -> Result<(), WriteError> {
    let ends = SectionEnds::new(morphology);
    let areas = areas_by(surface, |label, center| {
        let section = usize::try_from(i64::from(label.section) - 1).ok();
        let part = section.map(|section| ends.part(section, label.point, center));
        (label.section, part.unwrap_or(SectionPart::Side))
    })?;
    out.write_all(HEADER.as_bytes())?;
    write_rows(morphology, &areas, out)?;
    out.flush()?;
    Ok(())
}

fn write_rows(
    morphology: &Morphology,
    areas: &BTreeMap<(i32, SectionPart), f64>,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let area = |section: i32, part| areas.get(&(section, part)).copied().unwrap_or(0.0);
    // Faces do not tell somata apart.
    let somata: f64 = (morphology.somata.iter())
        .map(|soma| soma_area_volume(soma).0)
        .sum();
    if !morphology.somata.is_empty() {
        let meshed = area(0, SectionPart::Side);
        writeln!(out, "0,1,,,,,{somata:.6},,{meshed:.6},,")?;
    }
    let lengths = shape::section_lengths(morphology);
    let traced = shape::section_areas(morphology);
    let exposed = exposed_areas(morphology);
    for (n, section) in morphology.sections.iter().enumerate() {
        let number = n as i32 + 1;
        let stem = format!("{:.6}", area(number, SectionPart::Stem));
        let (parent, stem) = match section.attachment {
            Attachment::Section(parent) => ((parent.index() + 1).to_string(), String::new()),
            Attachment::Soma { .. } => ("0".into(), stem),
            Attachment::Free => (String::new(), String::new()),
        };
        let samples = &morphology.sample_ids[section.range()];
        let [first, last] = [samples.first(), samples.last()].map(|id| id.copied().unwrap_or(-1));
        writeln!(
            out,
            "{number},{},{parent},{first},{last},{:.6},{:.6},{:.6},{:.6},{stem},{:.6}",
            section.kind.0,
            lengths[n],
            traced[n],
            exposed[n],
            area(number, SectionPart::Side),
            area(number, SectionPart::Cap),
        )?;
    }
    Ok(())
}
