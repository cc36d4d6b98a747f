//! MSH, version 2.2, text and binary:
//! <https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format-version-2-_0028Legacy_0029>.
//!
//! Of each element there are a number, a type, tags (its physical group and its entity first) and nodes. Binary files
//! give type and number of tags once for some elements together. Counts of nodes and elements are text in both.

use glam::DVec3;

use super::msh::{Face, File, curved, nodes_of, region_of};
use super::numbers::Encoding;
use super::{FilePosition, ReadError, malformed};

/// Most tags that an element may have: Gmsh writes two, and a few more for parts of a parallel computation.
const TAGS: u64 = 1 << 16;

impl File<'_> {
    pub(super) fn nodes_2(&mut self) -> Result<(), ReadError> {
        for _ in 0..self.count()? {
            let at = self.input.place();
            let tag = self.whole()?;
            let position = DVec3::new(self.input.real()?, self.input.real()?, self.input.real()?);
            self.node(at, tag, position)?;
        }
        Ok(())
    }

    pub(super) fn elements_2(&mut self) -> Result<(), ReadError> {
        let binary = self.input.encoding != Encoding::Text;
        let mut left = self.count()?;
        while left > 0 {
            let at = self.input.place();
            // Text: number, type, tags; binary: type, how many elements follow, tags, and each begins with its number.
            let first = self.input.int()?;
            let second = self.input.int()?;
            let (kind, together) = match binary {
                true => (first, u64::try_from(second).unwrap_or(0)),
                false => (second, 1),
            };
            if together == 0 || together > left {
                let found = format!("{second} elements together");
                return Err(malformed(at, found, "no more than the section has"));
            }
            left -= together;
            let at_tags = self.input.place();
            let tags = self.whole()?;
            if tags > TAGS {
                let found = format!("{tags} tags");
                return Err(malformed(at_tags, found, "two, or some more"));
            }
            let nodes = nodes_of(kind, at)?;
            for _ in 0..together {
                let at = self.input.place();
                if binary {
                    self.input.int()?;
                }
                self.element(at, kind, tags, nodes)?;
            }
        }
        Ok(())
    }

    /// The tags and nodes of an element.
    fn element(
        &mut self,
        at: FilePosition,
        kind: i32,
        tags: u64,
        nodes: usize,
    ) -> Result<(), ReadError> {
        let mut own = [None; 2];
        for n in 0..tags {
            let tag = self.input.int()?;
            if let Some(own) = own.get_mut(n as usize) {
                *own = Some(tag);
            }
        }
        let mut corners = [0; 4];
        for n in 0..nodes {
            let node = self.whole()?;
            if let Some(corner) = corners.get_mut(n) {
                *corner = node;
            }
        }
        match kind {
            // Points and lines.
            15 | 1 | 8 => {}
            2 | 3 => {
                let [group, surface] = own;
                let region = surface.zip(group).filter(|_| self.ours);
                self.faces.push(Face {
                    at,
                    corners,
                    count: nodes,
                    region: region.map(|(surface, group)| region_of(surface, group)),
                });
            }
            9 | 10 | 16 => return Err(curved(at)),
            _ => self.solid = true,
        }
        Ok(())
    }

    /// The count at the start of a section: text on a line of its own.
    fn count(&mut self) -> Result<u64, ReadError> {
        let encoding = std::mem::replace(&mut self.input.encoding, Encoding::Text);
        let count = self.input.size()?;
        self.input.encoding = encoding;
        if encoding != Encoding::Text {
            self.input.end_of_line();
        }
        Ok(count)
    }

    /// A number of a node or of tags.
    fn whole(&mut self) -> Result<u64, ReadError> {
        let at = self.input.place();
        let number = self.input.int()?;
        u64::try_from(number)
            .map_err(|_| malformed(at, number.to_string(), "a whole number from 0 on"))
    }
}
