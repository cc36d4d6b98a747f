//! Things of one kind are evaluated four at once: a queue for each kind.

/// Up to four things of one kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Four {
    things: [u32; 4],
    count: usize,
}

impl Four {
    /// Four; where there are fewer, the first stands in for those that are missing.
    pub(crate) fn all(&self) -> [u32; 4] {
        self.things
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }
}

/// By kind, those that still wait for others.
#[derive(Debug, Default)]
pub(crate) struct Fours(Vec<(u32, Four)>);

impl Fours {
    /// Adds a thing of a kind. Returns four as soon as there are four of the kind.
    pub(crate) fn add(&mut self, kind: u32, thing: u32) -> Option<Four> {
        let Some(at) = self.0.iter().position(|&(of, _)| of == kind) else {
            let things = [thing; 4];
            self.0.push((kind, Four { things, count: 1 }));
            return None;
        };
        let four = &mut self.0[at].1;
        four.things[four.count] = thing;
        four.count += 1;
        (four.count == 4).then(|| self.0.swap_remove(at).1)
    }

    /// Those that wait.
    pub(crate) fn rest(self) -> impl Iterator<Item = Four> {
        self.0.into_iter().map(|(_, four)| four)
    }
}
