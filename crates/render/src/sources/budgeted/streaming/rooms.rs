//! Room in the buffers of templates that is taken and given back.

use range_alloc::{RangeAllocationError, RangeAllocator};

use crate::sources::budgeted::buffers::{Counts, Room};

/// The rooms of all templates that come and go.
#[derive(Debug)]
pub(super) struct Rooms {
    chunks: RangeAllocator<u64>,
    packed: RangeAllocator<u64>,
    color_keys: RangeAllocator<u64>,
}

impl Rooms {
    /// All of it is free.
    pub(super) fn new(all: Room) -> Self {
        Self {
            chunks: RangeAllocator::new(all.chunks),
            packed: RangeAllocator::new(all.packed),
            color_keys: RangeAllocator::new(all.color_keys),
        }
    }

    /// Takes room for so many elements, if there is some in one piece.
    pub(super) fn take(&mut self, counts: &Counts) -> Option<Room> {
        let mut room = Room::default();
        match self.fill(counts, &mut room) {
            Ok(()) => Some(room),
            Err(RangeAllocationError { .. }) => {
                self.give_back(room);
                None
            }
        }
    }

    fn fill(&mut self, counts: &Counts, room: &mut Room) -> Result<(), RangeAllocationError<u64>> {
        let parts = [
            (&mut self.chunks, counts.chunks, &mut room.chunks),
            (&mut self.packed, counts.packed, &mut room.packed),
            (
                &mut self.color_keys,
                counts.color_keys,
                &mut room.color_keys,
            ),
        ];
        for (rooms, count, range) in parts {
            if count > 0 {
                *range = rooms.allocate_range(count)?;
            }
        }
        Ok(())
    }

    /// Gives room back that was taken.
    pub(super) fn give_back(&mut self, room: Room) {
        let parts = [
            (&mut self.chunks, room.chunks),
            (&mut self.packed, room.packed),
            (&mut self.color_keys, room.color_keys),
        ];
        for (rooms, range) in parts {
            if !range.is_empty() {
                rooms.free_range(range);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_given_back_also_where_only_a_part_was_there() {
        let mut rooms = Rooms::new(Room {
            chunks: 10..20,
            packed: 0..100,
            color_keys: 5..6,
        });
        let counts = |chunks, packed, color_keys| Counts {
            chunks,
            packed,
            color_keys,
        };
        let first = rooms.take(&counts(6, 60, 0)).expect("room");
        assert!((10..20).contains(&first.chunks.start) && first.color_keys.is_empty());
        assert_eq!(rooms.take(&counts(4, 41, 0)), None, "too few points");
        assert_eq!(rooms.take(&counts(4, 40, 2)), None, "too few colors");
        let second = rooms.take(&counts(4, 40, 1)).expect("nothing was lost");
        assert!(second.chunks.end <= first.chunks.start || second.chunks.start >= first.chunks.end);
        rooms.give_back(first);
        rooms.give_back(second);
        assert!(
            rooms.take(&counts(10, 100, 1)).is_some(),
            "all of it in one piece"
        );
    }
}
