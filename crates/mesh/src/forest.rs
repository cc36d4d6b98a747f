//! Disjoint sets by number.

/// A disjoint-set forest with path halving; the lowest member stands for its set.
#[derive(Clone, Debug)]
pub struct Forest {
    parent: Vec<u32>,
}

impl Forest {
    /// Every member a set of its own.
    pub fn new(members: usize) -> Self {
        Self {
            parent: (0..members as u32).collect(),
        }
    }

    /// Joins the sets of two members; false if they are one already. Panics if there is no such member.
    pub fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// The lowest member of a member's set.
    pub fn root(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let above = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }
}
