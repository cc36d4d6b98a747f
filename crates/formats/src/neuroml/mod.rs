//! NeuroML 2: cells of segments, frusta that hang on one another anywhere along their parent.
//!
//! A segment has a distal end, and a proximal one where that is not its parent's; both give
//! **diameters** in µm. One that begins part of the way along its parent gets a point of its own
//! there, so the parent's frustum is cut in two of the same shape. A root that ends where it begins
//! is a spherical soma. What a segment is is told by its groups, else by its name. Of several cells
//! the first is read, and networks are left out, both with a warning.

mod kinds;
mod members;
mod records;

use std::collections::HashMap;

use glam::DVec3;
use neurotess_morphology::{BuildError, Morphology, NeuriteKind, Node};

use crate::sample::Sample;
use crate::text::Located;
use crate::warning::Warnings;
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text, xml};
use records::{Records, Segment};

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_text(Format::NeuroMl, name, options, |name, warnings| {
        interpret(bytes, name, warnings)
    })
}

fn interpret(bytes: &[u8], name: &str, warnings: &mut Warnings) -> Located<Morphology> {
    let text = xml::text(bytes)?;
    let records = records::records(&text)?;
    if records.segments.is_empty() {
        return Err((1, Fault::NoMorphology));
    }
    if records.morphologies > 1 {
        warnings.add_many(
            records.second,
            "other_cells_left_out",
            "another cell in the file: only the first is read",
            records.morphologies - 1,
        );
    }
    if records.instances > 0 {
        warnings.add_many(
            records.first_instance,
            "network_left_out",
            "a cell of a network: places are not read",
            records.instances,
        );
    }
    let (nodes, lines) = Layout::of(&records)?.nodes(&records)?;
    let header = records.notes.lines().map(|l| l.trim().to_owned());
    let header = header.filter(|l| !l.is_empty()).collect();
    let built = Morphology::from_nodes(name, header, &nodes).map_err(|e| match e {
        BuildError::Cycle { node } | BuildError::OutOfRange { node } => {
            (lines[node as usize], Fault::OwnAncestor)
        }
        BuildError::UnknownParent { .. } | BuildError::TooMany { .. } => (1, Fault::TooMany),
    })?;
    warnings.add_notes(built.notes, |node| lines[node as usize]);
    Ok(built.morphology)
}

/// How segments hang together.
struct Layout {
    /// Index of each one's parent.
    parents: Vec<Option<usize>>,
    /// Parents before children.
    order: Vec<usize>,
    /// Where, within each one, others begin: sorted, neither 0 nor 1.
    inner: Vec<Vec<f64>>,
    kinds: Vec<NeuriteKind>,
}

/// A segment's nodes, once they are made: where along it they are, and their index.
type Stations = Vec<(f64, u32)>;

impl Layout {
    fn of(records: &Records) -> Located<Self> {
        let segments = &records.segments;
        let mut index = HashMap::new();
        for (i, segment) in segments.iter().enumerate() {
            if let Some(first) = index.insert(segment.id, i) {
                let first_line = segments[first].line;
                let id = segment.id;
                return Err((segment.line, Fault::RepeatedSegment { id, first_line }));
            }
        }
        let mut parents = Vec::with_capacity(segments.len());
        let mut inner: Vec<Vec<f64>> = vec![Vec::new(); segments.len()];
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); segments.len()];
        for (i, segment) in segments.iter().enumerate() {
            let Some((parent, along)) = segment.parent else {
                parents.push(None);
                continue;
            };
            let Some(&p) = index.get(&parent) else {
                let id = segment.id;
                return Err((segment.line, Fault::UnknownSegment { id, parent }));
            };
            parents.push(Some(p));
            children[p].push(i);
            if along > 0.0 && along < 1.0 {
                inner[p].push(along);
            }
        }
        for places in &mut inner {
            places.sort_by(f64::total_cmp);
            places.dedup();
        }
        let roots = (0..segments.len()).rev().filter(|&i| parents[i].is_none());
        let mut open: Vec<usize> = roots.collect();
        let mut order = Vec::with_capacity(segments.len());
        while let Some(i) = open.pop() {
            order.push(i);
            open.extend(children[i].iter().rev());
        }
        if order.len() < segments.len() {
            let mut reached = vec![false; segments.len()];
            order.iter().for_each(|&i| reached[i] = true);
            let lost = reached.iter().position(|r| !r).unwrap_or(0);
            return Err((segments[lost].line, Fault::OwnAncestor));
        }
        Ok(Self {
            kinds: kinds::kinds(records, &parents),
            parents,
            order,
            inner,
        })
    }

    /// Nodes and their lines.
    fn nodes(&self, records: &Records) -> Located<(Vec<Node>, Vec<u64>)> {
        let segments = &records.segments;
        let mut made = Made::default();
        let mut stations: Vec<Stations> = vec![Vec::new(); segments.len()];
        for &i in &self.order {
            let segment = &segments[i];
            let kind = self.kinds[i];
            let distal = segment.distal.ok_or((
                segment.line,
                Fault::NoEnd {
                    id: segment.id,
                    end: "distal",
                },
            ))?;
            let hung = self.parents[i].map(|p| {
                let along = segment.parent.map_or(1.0, |(_, along)| along);
                (at(&stations[p], along), self.kinds[p])
            });
            let own = made.start(segment, kind, hung)?;
            let start = made.sample(own);
            let mut here = own;
            let mut places = vec![(0.0, own)];
            let sphere = hung.is_none() && same(&start, &distal);
            let ends = if sphere { &[][..] } else { &self.inner[i] };
            for &along in ends {
                here = made.push(between(&start, &distal, along), kind, Some(here));
                places.push((along, here));
            }
            if !sphere {
                here = made.push(distal, kind, Some(here));
            }
            places.push((1.0, here));
            stations[i] = places;
        }
        Ok((made.nodes, made.lines))
    }
}

/// The station nearest to a place along the segment.
fn at(stations: &Stations, along: f64) -> u32 {
    let off = |s: &&(f64, u32)| (s.0 - along).abs();
    let nearest = stations.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.map_or(0, |s| s.1)
}

fn same(a: &Sample, b: &Sample) -> bool {
    a.position == b.position && a.radius == b.radius
}

fn between(a: &Sample, b: &Sample, along: f64) -> Sample {
    Sample {
        position: DVec3::lerp(a.position, b.position, along),
        radius: a.radius + (b.radius - a.radius) * along,
        line: b.line,
    }
}

#[derive(Default)]
struct Made {
    nodes: Vec<Node>,
    lines: Vec<u64>,
}

impl Made {
    /// The node that a segment starts at: its parent's where both are one point of one thing, else
    /// one of its own.
    fn start(
        &mut self,
        segment: &Segment,
        kind: NeuriteKind,
        hung: Option<(u32, NeuriteKind)>,
    ) -> Located<u32> {
        let Some((on, parents_kind)) = hung else {
            let missing = Fault::NoEnd {
                id: segment.id,
                end: "proximal",
            };
            let proximal = segment.proximal.ok_or((segment.line, missing))?;
            return Ok(self.push(proximal, kind, None));
        };
        let there = self.sample(on);
        let proximal = segment.proximal.unwrap_or(there);
        // A neurite's way through its soma is no part of it.
        let leaves_soma = parents_kind == NeuriteKind::SOMA && kind != NeuriteKind::SOMA;
        if same(&proximal, &there) && !leaves_soma {
            return Ok(on);
        }
        Ok(self.push(proximal, kind, Some(on)))
    }

    fn push(&mut self, sample: Sample, kind: NeuriteKind, parent: Option<u32>) -> u32 {
        let index = self.nodes.len() as u32;
        self.nodes.push(Node {
            id: i64::from(index) + 1,
            kind,
            position: sample.position,
            radius: sample.radius,
            parent,
        });
        self.lines.push(sample.line);
        index
    }

    fn sample(&self, node: u32) -> Sample {
        let at = &self.nodes[node as usize];
        Sample {
            position: at.position,
            radius: at.radius,
            line: self.lines[node as usize],
        }
    }
}
