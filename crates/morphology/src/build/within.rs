//! One soma that is written once for each of its neurites, and neurites that begin within a soma and hang on nothing.

use super::notes::Notes;
use super::somata::Somata;
use super::tree::NONE;
use super::{Node, Oddity};

/// Two somata whose centers are nearer than this share of the larger radius are one: no two cells share so much.
const ONE_SOMA: f64 = 0.5;
/// Somata that others are compared with: a file with more has others than neurons.
const MAX_SOMATA: usize = 64;

impl Somata {
    /// Somata in the same place become one: the first, that is the thickest.
    pub(super) fn merge_coincident(&mut self, nodes: &[Node], notes: &mut Notes) {
        if self.members.len() < 2 {
            return;
        }
        let thickest = |members: &[u32]| {
            let sample = |&member: &u32| &nodes[member as usize];
            let thicker = |a: &&Node, b: &&Node| a.radius.total_cmp(&b.radius);
            members.iter().map(sample).max_by(thicker)
        };
        let mut kept: Vec<Vec<u32>> = Vec::with_capacity(self.members.len());
        for members in std::mem::take(&mut self.members) {
            let Some(own) = thickest(&members) else {
                continue;
            };
            let is_same = |other: &Vec<u32>| {
                thickest(other).is_some_and(|other| {
                    let reach = ONE_SOMA * own.radius.max(other.radius);
                    own.position.distance(other.position) < reach
                })
            };
            let same = kept.iter().take(MAX_SOMATA).position(is_same);
            match same {
                None => {
                    for &member in &members {
                        self.set_soma(member, kept.len() as u32);
                    }
                    kept.push(members);
                }
                Some(soma) => {
                    notes.add_many(Oddity::CoincidentSomata, members[0], 1);
                    for member in members {
                        let place = nodes[member as usize].position;
                        let nearest = (0_u32..).zip(&kept[soma]).min_by(|(_, a), (_, b)| {
                            let far = |node: &u32| nodes[*node as usize].position.distance(place);
                            far(a).total_cmp(&far(b))
                        });
                        let sample = nearest.map_or(0, |(sample, _)| sample);
                        self.set_soma(member, soma as u32);
                        self.set_sample(member, sample);
                    }
                }
            }
        }
        self.members = kept;
    }
}

/// Roots of neurites that lie within a soma, each with the sample that it hangs on.
#[derive(Default)]
pub(super) struct RootsInSomata(Vec<(u32, u32)>);

impl RootsInSomata {
    /// Those of nodes whose links are those of trees that hang up by their somata.
    pub(super) fn find(
        nodes: &[Node],
        parents: &[u32],
        somata: &Somata,
        notes: &mut Notes,
    ) -> Self {
        // Of three points the first is the sphere.
        let spheres = |members: &'_ Vec<u32>| match members.len() {
            3 => members[..1].to_vec(),
            _ => members.clone(),
        };
        let members = somata.members.iter().take(MAX_SOMATA).flat_map(spheres);
        let members: Vec<u32> = members
            .filter(|&member| nodes[member as usize].radius > 0.0)
            .take(MAX_SOMATA)
            .collect();
        let mut found = Vec::new();
        if members.is_empty() {
            return Self(found);
        }
        let is_root = |&(index, &parent): &(u32, &u32)| parent == NONE && somata.of(index) == NONE;
        for (index, _) in (0_u32..).zip(parents).filter(is_root) {
            let place = nodes[index as usize].position;
            let holds = |&&member: &&u32| {
                let soma = &nodes[member as usize];
                place.distance(soma.position) <= soma.radius
            };
            if let Some(&member) = members.iter().find(holds) {
                notes.add(Oddity::RootInSoma, index);
                found.push((index, member));
            }
        }
        Self(found)
    }

    /// The soma's node that a root hangs on.
    pub(super) fn member(&self, root: u32) -> Option<u32> {
        let place = self.0.binary_search_by_key(&root, |&(root, _)| root);
        place.ok().map(|place| self.0[place].1)
    }
}
