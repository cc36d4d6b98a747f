//! Which tracings the refined picture has on the device, where they do not all fit.
//!
//! All are templates of the scene; those that are not there are empty. Before a refined picture begins, the tracings in
//! view and the clamped ones are uploaded, in place of those that were not drawn for the longest time.

use neurotess::mesh::CoarseMesh;
use neurotess::render::{DeviceError, Template, TemplateId};

use super::Stage;
use crate::scene::templates::SceneTemplate;

/// Bytes on the device for each tracing point, and some for somata.
const BYTES_PER_POINT: u64 = 32;

/// Which tracings there is room for on the device.
#[derive(Default)]
pub(super) struct Room {
    /// Most bytes of templates on the device.
    pub(super) memory: Option<u64>,
    /// Which templates refined pictures have, if not all fit.
    pub(super) residency: Option<Residency>,
    /// Patches of the neurons in the picture, and their templates.
    pub(super) patches: u64,
    pub(super) in_view: Vec<usize>,
}

/// The tracings on the device.
#[derive(Debug)]
pub(crate) struct Residency {
    /// Most bytes.
    most: u64,
    /// By template: bytes when it is there.
    bytes: Vec<u64>,
    /// By template: the picture that it was last there for; 0: it is not there.
    drawn: Vec<u64>,
    pictures: u64,
}

impl Residency {
    /// None is there. Nothing if all fit.
    pub(crate) fn new(sources: &[SceneTemplate], most: Option<u64>) -> Option<Self> {
        let bytes = sources.iter().map(|source| {
            let points = source.generated.mesh.tracing.len() as u64;
            BYTES_PER_POINT * points
        });
        let bytes: Vec<u64> = bytes.collect();
        let most = most.filter(|&most| bytes.iter().sum::<u64>() > most)?;
        Some(Self {
            most,
            drawn: vec![0; bytes.len()],
            bytes,
            pictures: 0,
        })
    }

    /// Whether these templates fit together.
    pub(super) fn fit(&self, templates: &[usize]) -> bool {
        let bytes = templates.iter().filter_map(|&at| self.bytes.get(at));
        bytes.sum::<u64>() <= self.most
    }

    /// Notes a picture of these templates: those to upload for it, and before it those to leave out. What does not fit
    /// stays away, the last first.
    fn follow(&mut self, needed: &[usize]) -> Changes {
        self.pictures += 1;
        let mut changes = Changes::default();
        let mut left = self.most;
        for &template in needed {
            let bytes = self.bytes.get(template).copied().unwrap_or(u64::MAX);
            let Some(rest) = left.checked_sub(bytes) else {
                continue;
            };
            left = rest;
            if self.drawn[template] == 0 {
                changes.uploads.push(template);
            }
            self.drawn[template] = self.pictures;
        }
        // Others stay as long as there is room.
        let now = self.pictures;
        let mut others: Vec<(u64, usize)> = (0..)
            .zip(&self.drawn)
            .filter(|&(_, &drawn)| drawn > 0 && drawn < now)
            .map(|(template, &drawn)| (drawn, template))
            .collect();
        others.sort_unstable_by(|a, b| b.cmp(a));
        for (_, template) in others {
            match left.checked_sub(self.bytes[template]) {
                Some(rest) => left = rest,
                None => {
                    self.drawn[template] = 0;
                    changes.left_out.push(template);
                }
            }
        }
        changes
    }
}

/// Templates that come and go.
#[derive(Debug, Default, PartialEq, Eq)]
struct Changes {
    left_out: Vec<usize>,
    uploads: Vec<usize>,
}

impl Stage {
    /// Brings these templates and those of clamped neurons to the device, as far as they fit.
    pub(super) fn bring(&mut self, templates: &[usize]) -> Result<(), DeviceError> {
        let Some(residency) = &mut self.room.residency else {
            return Ok(());
        };
        let instances = &self.content.instances;
        let clamped = self.clamped.fine.iter().filter_map(|&at| instances.get(at));
        let mut needed: Vec<usize> = clamped.map(|instance| instance.source).collect();
        needed.extend(templates);
        let mut seen = vec![false; self.content.sources.len()];
        needed.retain(|&template| !std::mem::replace(&mut seen[template], true));
        let changes = residency.follow(&needed);
        if changes == Changes::default() {
            return Ok(());
        }
        let mut scene = self.adaptive.take_scene();
        let none = CoarseMesh::default();
        let color_keys = &self.content.coloring.color_keys;
        let left_out = changes.left_out.iter().map(|&at| (at, &none));
        let uploads = changes.uploads.iter();
        let uploads = uploads.map(|&at| (at, &self.content.sources[at].generated.mesh));
        let mut done = Ok(());
        for (at, mesh) in left_out.chain(uploads) {
            let template = Template {
                mesh,
                color_keys: &color_keys[at],
                values: &[],
            };
            let id = TemplateId(at as u32);
            done = done.and_then(|()| scene.replace(&self.gpu, id, &template));
        }
        self.adaptive.set_scene(scene);
        done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residency(most: u64, bytes: &[u64]) -> Residency {
        Residency {
            most,
            bytes: bytes.to_vec(),
            drawn: vec![0; bytes.len()],
            pictures: 0,
        }
    }

    #[test]
    fn what_was_not_drawn_for_the_longest_time_goes_first() {
        let mut there = residency(100, &[40, 30, 30, 20, 90]);
        let changes = |there: &mut Residency, needed: &[usize]| {
            let Changes { left_out, uploads } = there.follow(needed);
            (left_out, uploads)
        };
        assert_eq!(changes(&mut there, &[0, 1]), (vec![], vec![0, 1]));
        assert_eq!(changes(&mut there, &[2]), (vec![], vec![2]), "all fit");
        assert_eq!(
            changes(&mut there, &[0, 3]),
            (vec![1], vec![3]),
            "the oldest goes"
        );
        assert_eq!(
            changes(&mut there, &[0, 3]),
            (vec![], vec![]),
            "nothing changes"
        );
        assert_eq!(changes(&mut there, &[4]), (vec![3, 0, 2], vec![4]));
        assert!(there.fit(&[0, 1, 2]) && !there.fit(&[0, 1, 2, 3]));
        // What is needed beyond the room stays away.
        assert_eq!(changes(&mut there, &[0, 4, 1]), (vec![4], vec![0, 1]));
    }
}
