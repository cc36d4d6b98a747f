//! Writing H5 version 1.3.

use std::io::{self, Write};

use glam::DVec3;
use hdf5_pure::{AttrValue, FileBuilder};
use neurotess_morphology::{Attachment, Morphology, NeuriteKind};

use crate::Warning;
use crate::losses::Losses;
use crate::outlines::outlines;

/// Writes a morphology as H5 of version 1.3, in `f32` or, where that would round a coordinate, in `f64`, so that positions and
/// radii come back exactly. Datasets are contiguous and without filters: MorphIO's wheels open no others.
/// What the format cannot say is returned: numbers of samples, header, somata other than outlines.
///
/// # Errors
/// Those of the writer.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(morphology: &Morphology, mut writer: impl Write) -> io::Result<Vec<Warning>> {
    let mut points: Vec<f64> = Vec::new();
    let mut push = |position: glam::Vec3, radius: f32| {
        let place: DVec3 = morphology.origin + position.as_dvec3();
        points.extend(place.to_array());
        points.push(2.0 * f64::from(radius));
        points.len() as i32 / 4
    };
    let mut structure: Vec<i32> = Vec::new();
    let (mut next, mut untyped) = (0, 0);
    let soma_rows = i32::from(!morphology.somata.is_empty());
    if soma_rows > 0 {
        structure.extend([0, 1, -1]);
        for (position, radius) in outlines(morphology).into_iter().flatten() {
            next = push(position, radius);
        }
    }
    // Rows in the order of the file, so that they keep their numbers.
    let pieces = morphology.pieces_in_file_order();
    let mut row_ending_at = vec![-1; morphology.points.len()];
    for (piece, row) in pieces.iter().zip(soma_rows..) {
        let section = &morphology.sections[piece.section.index()];
        let fork = piece.branch_point(morphology);
        let parent = match (fork, section.attachment) {
            (Some(fork), _) => row_ending_at[fork],
            (None, Attachment::Free) if soma_rows == 0 => -1,
            (None, _) => 0,
        };
        row_ending_at[piece.points.end - 1] = row;
        // Type 1 is the soma's alone: readers take points of it for an outline.
        let is_untyped = section.kind == NeuriteKind::SOMA;
        untyped += u64::from(is_untyped);
        structure.extend([next, if is_untyped { 0 } else { section.kind.0 }, parent]);
        for point in fork.into_iter().chain(piece.points.clone()) {
            let point = &morphology.points[point];
            next = push(point.position, point.radius);
        }
    }
    let mut file = FileBuilder::new();
    let rows = points.len() as u64 / 4;
    // MorphIO warns of 64 bits, which only coordinates far away need to come back exactly.
    let narrow: Vec<f32> = points.iter().map(|&number| number as f32).collect();
    let exact = points
        .iter()
        .zip(&narrow)
        .all(|(&wide, &narrow)| f64::from(narrow) == wide);
    let dataset = file.create_dataset("points");
    match exact {
        true => dataset.with_f32_data(&narrow),
        false => dataset.with_f64_data(&points),
    }
    .with_shape(&[rows, 4]);
    let rows = structure.len() as u64 / 3;
    file.create_dataset("structure")
        .with_i32_data(&structure)
        .with_shape(&[rows, 3]);
    let mut metadata = file.create_group("metadata");
    metadata.set_attr("version", AttrValue::U32Array(vec![1, 3]));
    metadata.set_attr("cell_family", AttrValue::U32Array(vec![0]));
    file.add_group(metadata.finish());
    let bytes = file.finish().map_err(io::Error::other)?;
    writer.write_all(&bytes)?;
    writer.flush()?;
    let mut losses = Losses::of(morphology);
    losses.header(morphology);
    let message = "a section of type 1 in a neurite is written without a type";
    losses.add("types_changed", message, untyped);
    Ok(losses.into_warnings())
}
