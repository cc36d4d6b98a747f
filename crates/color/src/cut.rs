//! Inserts a point into a tracing at the middle of each compartment of a report, so that all its
//! values show.
//!
//! **Theory.** The membrane shows the value of the nearest tracing point, so a dendrite of two
//! points would show only two of its compartments, and a section of one point its parent's. Values
//! belong to positions along a section, wherever points were traced. **Practice.** Before such a
//! cell is meshed, points are inserted on the straight line between two traced ones, with the
//! radius between theirs, at the middle of each compartment; none where a traced point is there
//! already. Colors then change half-way between two middles, which is where compartments meet.
//!
//! **Why not** a position along the section for each vertex, looked up in the shader: joints and
//! somata have no such position, and every source of vertices would carry another number.

use std::collections::HashMap;
use std::path::Path;

use neurotess_circuit::{Circuit, CircuitError, Compartment, NodeRef, RecordingFile};
use neurotess_morphology::{
    FileSections, Morphology, Point, Program, SectionId, SectionNumbers, SectionPlace, shape,
};

/// No point is inserted if a traced one is this near to the compartment's middle (share of the
/// compartment's length).
const NEAR: f64 = 0.05;

/// How cells are cut into compartments in a report: for each cell, the compartments of the first
/// neuron with values that shows it. `instances`: the cell that each neuron shows and its node.
/// Empty for spikes. `report`: a file, or a name that the circuit gives it.
///
/// # Errors
/// The file is invalid, or belongs to another circuit.
pub fn cuts(
    report: &Path,
    circuit: &Circuit,
    instances: &[(usize, NodeRef)],
) -> Result<HashMap<usize, Vec<Compartment>>, CircuitError> {
    let mut cuts = HashMap::new();
    let path = circuit.report_of_sections(report)?;
    let RecordingFile::Report(report) = circuit.open_recording(&path)? else {
        return Ok(cuts);
    };
    for population in &report.populations {
        let nodes = population.nodes_in(circuit)?;
        let rows: HashMap<NodeRef, usize> = nodes.into_iter().zip(0..).collect();
        for (cell, node) in instances {
            if let Some(&row) = rows.get(node)
                && !cuts.contains_key(cell)
            {
                cuts.insert(*cell, population.compartments(row)?);
            }
        }
    }
    Ok(cuts)
}

/// The morphology with a point at the middle of each compartment.
pub fn with_middles(morphology: &Morphology, compartments: &[Compartment]) -> Morphology {
    let numbers = SectionNumbers::of(morphology, Program::Neuron);
    let mut middles: Vec<Vec<f64>> = vec![Vec::new(); morphology.sections.len()];
    for compartment in compartments {
        if let Some(SectionPlace::Section(section, along)) = compartment.place(&numbers) {
            middles[section.index()].push(f64::from(along));
        }
    }
    let somata = morphology.somata.iter().flat_map(|soma| &soma.samples);
    let known = morphology.sample_ids.iter().copied();
    let last = known.chain(somata.map(|sample| sample.id)).max();
    let known = morphology.known_file_sections();
    let mut of_points = Vec::with_capacity(morphology.points.len() + compartments.len());
    let mut cut = Morphology {
        points: Vec::with_capacity(morphology.points.len() + compartments.len()),
        sample_ids: Vec::with_capacity(morphology.points.len() + compartments.len()),
        ..morphology.clone()
    };
    let mut next = last.unwrap_or(0).saturating_add(1);
    for (index, middles) in middles.iter_mut().enumerate() {
        middles.sort_by(f64::total_cmp);
        let section = &morphology.sections[index];
        let first = cut.points.len() as u32;
        let mut before = shape::branch_point(morphology, SectionId(index as u32)).copied();
        let mut ahead = MiddlesAhead::new(morphology, index, middles);
        for point_index in section.range() {
            let point = &morphology.points[point_index];
            let sample = &morphology.sample_ids[point_index];
            let file_section = known.of_points[point_index];
            if let Some(before) = before {
                for share in ahead.within(&before, point) {
                    cut.points.push(between(&before, point, share));
                    cut.sample_ids.push(next);
                    of_points.push(file_section);
                    next = next.saturating_add(1);
                }
            }
            cut.points.push(*point);
            cut.sample_ids.push(*sample);
            of_points.push(file_section);
            before = Some(*point);
        }
        cut.sections[index].first = first;
        cut.sections[index].end = cut.points.len() as u32;
    }
    cut.file_sections = FileSections {
        of_points,
        ..known.into_owned()
    };
    cut
}

/// The middles of compartments that are still ahead along a section.
struct MiddlesAhead<'m> {
    /// Shares of the section's length, ascending.
    middles: &'m [f64],
    /// Length of the section (µm).
    length: f64,
    /// Distance so far (µm).
    way: f64,
}

impl<'m> MiddlesAhead<'m> {
    fn new(morphology: &Morphology, section: usize, middles: &'m [f64]) -> Self {
        let links = shape::links(morphology, SectionId(section as u32));
        let length = links.map(|(a, b)| f64::from(a.position.distance(b.position)));
        Self {
            middles,
            length: length.sum(),
            way: 0.0,
        }
    }

    /// Positions between two points, as shares of their distance, at which to insert points.
    fn within(&mut self, from: &Point, to: &Point) -> Vec<f32> {
        let distance = f64::from(from.position.distance(to.position));
        let end = self.way + distance;
        let count = self.middles.partition_point(|m| m * self.length < end);
        let (here, rest) = self.middles.split_at(count);
        let near = NEAR * self.length / (here.len() + rest.len()).max(1) as f64;
        let mut last = self.way;
        let mut shares = Vec::new();
        for middle in here {
            let way = middle * self.length;
            if way - last > near && end - way > near {
                shares.push(((way - self.way) / distance) as f32);
                last = way;
            }
        }
        self.middles = rest;
        self.way = end;
        shares
    }
}

fn between(a: &Point, b: &Point, share: f32) -> Point {
    Point {
        position: a.position.lerp(b.position, share),
        radius: a.radius + share * (b.radius - a.radius),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compartments::on_cell;
    use crate::path_distance::path_distances;
    use crate::scheme::Cell;

    const BALL_AND_STICK: &str = "1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 3 0 106 0 1 2\n";
    /// A fork: the second child has one point of its own.
    const FORKED: &str = "1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n3 3 0 50 0 1 2\n4 3 30 90 0 1 3\n\
                          5 3 -30 90 0 1 3\n";

    fn compartments(sections: u64, each: u32) -> Vec<Compartment> {
        let of = |section: u64| {
            (0..each).map(move |k| Compartment {
                section,
                along: (k as f32 + 0.5) / each as f32,
            })
        };
        let soma = Compartment {
            section: 0,
            along: 0.5,
        };
        std::iter::once(soma)
            .chain((1..=sections).flat_map(of))
            .collect()
    }

    fn shown(text: &str, compartments: &[Compartment]) -> Vec<u32> {
        let read = neurotess_formats::swc::read_bytes(text.as_bytes(), "cell", &Default::default());
        let morphology = with_middles(&read.expect("a cell").morphology, compartments);
        let mesh = neurotess_generate::generate(&morphology, &Default::default())
            .expect("meshed")
            .mesh;
        assert!(mesh.topology().closed);
        let cell = Cell {
            name: "",
            morphology: &morphology,
            mesh: &mesh,
            radius_factor: 1.0,
        };
        assert!(
            path_distances(&cell)
                .iter()
                .flatten()
                .all(|way| way.is_finite())
        );
        let mut color_keys = on_cell(&cell, compartments);
        color_keys.sort_unstable();
        color_keys.dedup();
        color_keys
    }

    #[test]
    fn a_ball_and_stick_of_two_points_shows_all_its_compartments() {
        let compartments = compartments(1, 7);
        assert_eq!(
            shown(BALL_AND_STICK, &compartments),
            (0..8).collect::<Vec<u32>>()
        );
    }

    #[test]
    fn a_section_of_one_point_shows_all_of_its_own() {
        let compartments = compartments(3, 5);
        assert_eq!(shown(FORKED, &compartments), (0..16).collect::<Vec<u32>>());
    }

    #[test]
    fn what_is_traced_stays_and_is_enough_where_it_is_dense() {
        let text: String = (2..60)
            .map(|i| format!("{i} 3 0 {} 0 {} {}\n", 2 * i, 3.0 / f64::from(i), i - 1))
            .collect();
        let text = format!("1 1 0 0 0 2 -1\n{text}");
        let read = neurotess_formats::swc::read_bytes(text.as_bytes(), "cell", &Default::default());
        let morphology = read.expect("a cell").morphology;
        let cut = with_middles(&morphology, &compartments(1, 4));
        let traced = morphology.points.iter().zip(&morphology.sample_ids);
        for (point, id) in traced {
            let place = cut.sample_ids.iter().position(|other| other == id);
            assert_eq!(cut.points[place.expect("there")], *point);
        }
        assert!(cut.points.len() <= morphology.points.len() + 4);
        // Without compartments nothing changes.
        assert_eq!(with_middles(&morphology, &[]), morphology);
    }
}
