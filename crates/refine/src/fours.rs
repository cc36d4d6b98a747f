//! Things of one kind are evaluated four at once: a queue for each kind.

/// By kind, up to three things that wait for others.
#[derive(Debug)]
pub(crate) struct Fours<T>(Vec<Waiting<T>>);

#[derive(Debug)]
struct Waiting<T> {
    kind: u32,
    things: [T; 4],
    count: usize,
}

impl<T> Default for Fours<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Copy> Fours<T> {
    /// Adds a thing of a kind. Returns four as soon as there are four of the kind.
    pub(crate) fn add(&mut self, kind: u32, thing: T) -> Option<[T; 4]> {
        let Some(at) = self.0.iter().position(|waiting| waiting.kind == kind) else {
            self.0.push(Waiting {
                kind,
                things: [thing; 4],
                count: 1,
            });
            return None;
        };
        let waiting = &mut self.0[at];
        waiting.things[waiting.count] = thing;
        waiting.count += 1;
        (waiting.count == 4).then(|| self.0.swap_remove(at).things)
    }

    /// Those that still wait. The first of a kind stands in for those that are missing: it is evaluated several times,
    /// with the same result.
    pub(crate) fn rest(self) -> impl Iterator<Item = [T; 4]> {
        self.0.into_iter().map(|waiting| waiting.things)
    }
}

/// What a function has of 0 to 3.
#[inline(always)]
pub(crate) fn four<T>(of: impl Fn(usize) -> T) -> [T; 4] {
    [of(0), of(1), of(2), of(3)]
}
