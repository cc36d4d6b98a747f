//! Samples of type 1 around a soma that hang on nothing and have no radius of their own: its outline or surface, each
//! place a root of its own, or the outline in one piece. They become samples of that soma, which says what they tell.

use super::Node;
use super::somata::Somata;
use super::tree::NONE;
use crate::soma::{FEWEST_MARKS, THIN};

/// They are no farther from its middle than so many of its radii.
const NEAR: f64 = 2.0;
/// Somata that others may belong to.
const MAX_HOSTS: usize = 16;

impl Somata {
    /// Hangs such samples on the thickest sample of their soma; whether there were any.
    pub(super) fn gather_marks(&mut self, nodes: &[Node], parents: &mut [u32]) -> bool {
        let of_soma: Vec<Thickness> = self
            .members
            .iter()
            .map(|m| Thickness::of(m, nodes))
            .collect();
        let mut host_of = vec![NONE; self.members.len()];
        for (host, own) in (0..).zip(&of_soma).take(MAX_HOSTS) {
            if own.most <= 0.0 || host_of[host as usize] != NONE {
                continue;
            }
            let center = nodes[own.thickest as usize].position;
            let near =
                |&member: &u32| nodes[member as usize].position.distance(center) <= NEAR * own.most;
            let belongs = |soma: usize| {
                let marks = &of_soma[soma];
                let is_thin = marks.most <= THIN * own.most && marks.least == marks.most;
                is_thin && host_of[soma] == NONE && self.members[soma].iter().all(near)
            };
            let others = (host as usize + 1..self.members.len()).filter(|&soma| belongs(soma));
            let mut marks: Vec<usize> = others.collect();
            // Radii that all have say nothing, others are somata's.
            let radius_of = |soma: &usize| of_soma[*soma].most;
            let usual = usual(marks.iter().map(radius_of));
            marks.retain(|soma| radius_of(soma) <= 0.0 || Some(radius_of(soma)) == usual);
            let count: usize = marks.iter().map(|&soma| self.members[soma].len()).sum();
            if count >= FEWEST_MARKS || marks.iter().all(|soma| radius_of(soma) <= 0.0) {
                marks.iter().for_each(|&soma| host_of[soma] = host);
            }
        }
        let found = host_of.iter().any(|&host| host != NONE);
        for (soma, &host) in host_of
            .iter()
            .enumerate()
            .filter(|(_, host)| **host != NONE)
        {
            parents[self.tops[soma] as usize] = of_soma[host as usize].thickest;
            let marks = std::mem::take(&mut self.members[soma]);
            self.members[host as usize].extend(marks);
        }
        if found {
            self.renumber();
        }
        found
    }

    /// Leaves out somata without members, and numbers the members of the others.
    fn renumber(&mut self) {
        let mut members = self.members.iter();
        self.tops
            .retain(|_| members.next().is_some_and(|m| !m.is_empty()));
        self.members.retain(|members| !members.is_empty());
        let mut members = std::mem::take(&mut self.members);
        for (soma, members) in (0..).zip(&mut members) {
            members.sort_unstable();
            for (sample, &member) in (0..).zip(&*members) {
                self.set_soma(member, soma);
                self.set_sample(member, sample);
            }
        }
        self.members = members;
    }
}

/// The radii of a soma's samples (µm), none less than 0, and which sample is the thickest.
struct Thickness {
    thickest: u32,
    most: f64,
    least: f64,
}

impl Thickness {
    fn of(members: &[u32], nodes: &[Node]) -> Self {
        let radius = |member: u32| nodes[member as usize].radius.max(0.0);
        let thinner = |&a: &u32, &b: &u32| radius(a).total_cmp(&radius(b)).then(b.cmp(&a));
        let thickest = members.iter().copied().max_by(thinner).unwrap_or(NONE);
        let radii = members.iter().map(|&member| radius(member));
        Self {
            thickest,
            most: radii.clone().fold(0.0, f64::max),
            least: radii.fold(f64::INFINITY, f64::min),
        }
    }
}

/// The most frequent of positive radii.
fn usual(radii: impl Iterator<Item = f64>) -> Option<f64> {
    let mut radii: Vec<f64> = radii.filter(|radius| *radius > 0.0).collect();
    radii.sort_by(f64::total_cmp);
    let runs = radii.chunk_by(|a, b| a == b);
    runs.max_by_key(|run| run.len()).map(|run| run[0])
}
