//! Templates that do not fit the device, with details that come and go.
//!
//! **Theory.** Of every template a **base** is always there: all its chunks, each with few segments, or where even these
//! do not fit, the chunks that carry most. What the camera is near enough to show better is uploaded more finely
//! (reduced.rs), into **room** (rooms.rs) that is taken from what was not wanted for the longest time. What shows most is
//! uploaded first: by the error of its base in pixels.
//!
//! The shaders know nothing of it: a shape says where a template's chunks are, chunks say where their points are, and both
//! are rewritten when these come and go. Where all that a picture wants is there, it is the picture of a scene that fits,
//! to the bit.

mod memory;
mod needs;
mod reduced;
mod rooms;

use std::collections::VecDeque;
use std::sync::Arc;

use super::buffers::{Buffers, Counts, Room, shape_of};
use super::layout::{MAX_SEGMENTS, Shape};
use super::proxy::Proxy;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use memory::{base_of, room_for, total};
use needs::View;
use neurotess_picture::Frame;
use neurotess_picture::Instance;
use neurotess_picture::PixelSize;
use reduced::{Detail, reduced};
use rooms::Rooms;

/// Greatest distance (pixels) of what is drawn from the true surface.
const ERROR: f32 = super::ERROR;

/// Details that templates have besides their base, coarse ones first.
const DETAILS: [Detail; 3] = [Detail::of_all(8), Detail::of_all(20), Detail::FULL];
/// Templates whose bases are uploaded at once.
const AT_ONCE: usize = 256;
/// Share of the room that is planned for: the rest lies in pieces.
const PLANNED: f64 = 0.95;

/// What is on the device of templates that do not fit it as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StreamedTemplates {
    /// Templates that are streamed.
    pub templates: usize,
    /// Those that are there more finely than at first.
    pub finer: usize,
    /// Those that are there with all their points.
    pub whole: usize,
    /// Those that the last picture might have shown more finely, had there been room: by the greatest errors of their
    /// polylines, which need not be in view.
    pub coarser: usize,
    /// Bytes of finer points that were uploaded since the start.
    pub uploaded: u64,
}

/// Templates of which the device has as much as fits.
#[derive(Debug)]
pub(super) struct Streaming {
    /// Id of the first template; the others follow.
    first: usize,
    proxies: Arc<Vec<Arc<Proxy>>>,
    base: Detail,
    templates: Vec<Streamed>,
    rooms: Rooms,
    room: Counts,
    /// Counts the pictures.
    picture: u64,
    /// Most bytes that a picture may upload.
    pub(super) most_upload: u64,
    /// Whether more is to be uploaded for the picture that was prepared last.
    pub(super) is_pending: bool,
    /// Bytes uploaded since the start.
    pub(super) uploaded: u64,
    /// Templates that the last picture might have shown more finely, had there been room.
    coarser: usize,
}

/// A template.
#[derive(Debug)]
struct Streamed {
    base: Room,
    base_error: f32,
    /// By detail: error (µm), and elements.
    details: [(f32, Counts); DETAILS.len()],
    /// The detail that is there besides the base, and where.
    finer: Option<(usize, Room)>,
    /// The last picture that wanted it.
    wanted: u64,
}

impl Streamed {
    /// The detail that is there besides the base.
    fn there(&self) -> Option<usize> {
        self.finer.as_ref().map(|(detail, _)| *detail)
    }
}

/// A detail that is to be there for a picture.
#[derive(Clone, Copy, Debug)]
struct Planned {
    template: usize,
    detail: usize,
    /// Whether it is all that the picture shows.
    is_enough: bool,
}

/// Where the arrays of a template were, and how finely it is there, for what reads pictures back.
#[derive(Clone, Debug)]
pub(super) struct Residence {
    first: usize,
    proxies: Arc<Vec<Arc<Proxy>>>,
    details: Vec<Detail>,
}

impl Streaming {
    /// Uploads the bases of templates, and takes the rest of the memory (bytes) for their details.
    ///
    /// # Errors
    /// Not even the coarsest base fits the memory or a binding of the device, or the device reports another error.
    pub(super) fn new(
        gpu: &Gpu,
        buffers: &mut Buffers,
        first: usize,
        proxies: &[Arc<Proxy>],
        memory: u64,
    ) -> Result<Self, DeviceError> {
        let (base, taken) = base_of(gpu, buffers, proxies, memory)?;
        let left = memory.saturating_sub(taken.bytes());
        let shares_chunks = base.chunks == usize::MAX;
        let mut full = total(proxies, Detail::FULL);
        if shares_chunks {
            full.chunks = 0;
        }
        let room = room_for(gpu, buffers, &full, &taken, left);
        buffers.reserve(gpu, &taken.plus(&room))?;
        let mut bases = Vec::with_capacity(proxies.len());
        for some in proxies.chunks(AT_ONCE) {
            let less: Vec<Proxy> = some.iter().map(|proxy| reduced(proxy, base)).collect();
            let (rooms, _) = buffers.append(gpu, &less)?;
            bases.extend(rooms);
            // What is written takes memory of its own until then.
            gpu.wait()?;
        }
        let all = buffers.take(&room);
        let templates = proxies.iter().zip(bases).map(|(proxy, room)| Streamed {
            base: room,
            base_error: base.error(proxy),
            details: DETAILS.map(|detail| {
                let counts = detail.counts(proxy);
                let chunks = if shares_chunks { 0 } else { counts.chunks };
                (detail.error(proxy), Counts { chunks, ..counts })
            }),
            finer: None,
            wanted: 0,
        });
        Ok(Self {
            first,
            templates: templates.collect(),
            base,
            rooms: Rooms::new(all),
            room,
            proxies: Arc::new(proxies.to_vec()),
            picture: 0,
            most_upload: u64::MAX,
            is_pending: false,
            uploaded: 0,
            coarser: 0,
        })
    }

    /// What shaders read of a template's base.
    pub(super) fn base_shape(&self, template: usize) -> Shape {
        let less = reduced(&self.proxies[template], self.base);
        shape_of(&less, &self.templates[template].base)
    }

    /// Whether the base has all chunks: those of details then take the place of the base's.
    fn shares_chunks(&self) -> bool {
        self.base.chunks == usize::MAX
    }

    /// Uploads what a picture shows more finely than it is there, as far as there is room, and most of what shows most.
    /// Returns the shapes that changed, by template's id.
    pub(super) fn follow(
        &mut self,
        gpu: &Gpu,
        buffers: &Buffers,
        instances: &[Instance],
        frame: &Frame,
        pixel: PixelSize,
    ) -> Vec<(usize, Shape)> {
        self.picture += 1;
        let pixels = self.nearest_pixels(instances, frame, pixel);
        let (plan, no_room) = self.plan(&pixels);
        self.coarser = no_room + plan.iter().filter(|planned| !planned.is_enough).count();
        for planned in &plan {
            self.templates[planned.template].wanted = self.picture;
        }
        let mut victims = self.victims();
        let mut changed = Vec::new();
        let (mut uploaded, mut moved_together) = (0, false);
        self.is_pending = false;
        let mut next = 0;
        while let Some(&Planned {
            template,
            detail,
            is_enough,
        }) = plan.get(next)
        {
            next += 1;
            if self.templates[template].there() == Some(detail) {
                continue;
            }
            if uploaded >= self.most_upload {
                self.is_pending = true;
                break;
            }
            let counts = self.templates[template].details[detail].1;
            self.leave(template);
            let room = loop {
                if let Some(room) = self.rooms.take(&counts) {
                    break Some(room);
                }
                let Some(victim) = victims.pop_front() else {
                    break None;
                };
                self.leave(victim);
                changed.push((self.first + victim, self.fall_back(gpu, buffers, victim)));
            };
            let shape = match room {
                Some(room) => {
                    uploaded += counts.bytes();
                    self.upload(gpu, buffers, template, detail, room)
                }
                // What is free lies in pieces: all that is planned leaves, and comes back side by side.
                None if !moved_together && self.bytes(&plan) <= self.most_upload - uploaded => {
                    moved_together = true;
                    plan.iter().for_each(|planned| self.leave(planned.template));
                    next = 0;
                    continue;
                }
                // That would take more than this picture may upload: the base is drawn.
                None => {
                    self.coarser += usize::from(is_enough);
                    self.fall_back(gpu, buffers, template)
                }
            };
            changed.push((self.first + template, shape));
        }
        self.uploaded += uploaded;
        changed
    }

    /// Bytes of all that is planned.
    fn bytes(&self, plan: &[Planned]) -> u64 {
        let counts = |planned: &Planned| self.templates[planned.template].details[planned.detail].1;
        plan.iter().map(|planned| counts(planned).bytes()).sum()
    }

    /// By template: the size (µm) of a pixel where it is nearest; infinite if it does not show.
    fn nearest_pixels(&self, instances: &[Instance], frame: &Frame, pixel: PixelSize) -> Vec<f32> {
        let view = View::new(frame, pixel);
        let mut pixels = vec![f32::INFINITY; self.templates.len()];
        for instance in instances {
            let template = (instance.template.0 as usize).checked_sub(self.first);
            let Some((template, proxy)) = template.and_then(|at| Some((at, self.proxies.get(at)?)))
            else {
                continue;
            };
            if let Some(nearest) = view.nearest_pixel(instance, proxy) {
                pixels[template] = pixels[template].min(nearest);
            }
        }
        pixels
    }

    /// The details to be there for a picture, those first that show most; and how many templates have no room for any.
    fn plan(&self, pixels: &[f32]) -> (Vec<Planned>, usize) {
        let mut wanted: Vec<(f32, usize)> = (0..)
            .zip(&self.templates)
            .map(|(index, template)| (template.base_error / pixels[index], index))
            .filter(|&(error, _)| error > ERROR)
            .collect();
        wanted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let planned = |count: u64| (count as f64 * PLANNED) as u64;
        let room = Counts {
            chunks: planned(self.room.chunks),
            packed: planned(self.room.packed),
            color_keys: planned(self.room.color_keys),
        };
        let mut taken = Counts::default();
        let (mut plan, mut no_room) = (Vec::new(), 0);
        for (_, index) in wanted {
            let template = &self.templates[index];
            let enough = |&detail: &usize| template.details[detail].0 <= ERROR * pixels[index];
            let enough = (0..DETAILS.len()).find(enough).unwrap_or(DETAILS.len() - 1);
            // What is there and finer than needed need not be uploaded anew.
            let there = template.there().filter(|&there| there >= enough);
            let first = there.into_iter().chain((0..=enough).rev());
            let mut fitting = first.filter(|&detail| {
                let (error, counts) = &template.details[detail];
                *error < template.base_error && taken.plus(counts).fit(&room)
            });
            let Some(detail) = fitting.next() else {
                no_room += 1;
                continue;
            };
            taken = taken.plus(&template.details[detail].1);
            plan.push(Planned {
                template: index,
                detail,
                is_enough: detail >= enough,
            });
        }
        (plan, no_room)
    }

    /// Templates whose details this picture does not want, the longest unwanted first.
    fn victims(&self) -> VecDeque<usize> {
        let mut victims: Vec<(u64, usize)> = (0..)
            .zip(&self.templates)
            .filter(|(_, template)| template.finer.is_some() && template.wanted < self.picture)
            .map(|(index, template)| (template.wanted, index))
            .collect();
        victims.sort_unstable();
        victims.into_iter().map(|(_, index)| index).collect()
    }

    /// Gives the room of a template's details back.
    fn leave(&mut self, template: usize) {
        if let Some((_, room)) = self.templates[template].finer.take() {
            self.rooms.give_back(room);
        }
    }

    /// Shows the base of a template whose details have left.
    fn fall_back(&self, gpu: &Gpu, buffers: &Buffers, template: usize) -> Shape {
        let less = reduced(&self.proxies[template], self.base);
        let room = &self.templates[template].base;
        if self.shares_chunks() {
            buffers.write_chunks(gpu, room, &less);
        }
        shape_of(&less, room)
    }

    fn upload(
        &mut self,
        gpu: &Gpu,
        buffers: &Buffers,
        template: usize,
        detail: usize,
        room: Room,
    ) -> Shape {
        let less = reduced(&self.proxies[template], DETAILS[detail]);
        let mut at = room.clone();
        if self.shares_chunks() {
            at.chunks = self.templates[template].base.chunks.clone();
        }
        buffers.write(gpu, &at, &less);
        let shape = shape_of(&less, &at);
        self.templates[template].finer = Some((detail, room));
        shape
    }

    /// How finely templates are there now.
    pub(super) fn residence(&self) -> Residence {
        let details = self.templates.iter().map(|template| match template.finer {
            Some((detail, _)) => DETAILS[detail],
            None => self.base,
        });
        Residence {
            first: self.first,
            proxies: Arc::clone(&self.proxies),
            details: details.collect(),
        }
    }

    /// What is there now.
    pub(super) fn stats(&self) -> StreamedTemplates {
        let finer = self
            .templates
            .iter()
            .filter_map(|template| template.finer.as_ref());
        let full = DETAILS.len() - 1;
        StreamedTemplates {
            templates: self.templates.len(),
            finer: finer.clone().count(),
            whole: finer.filter(|(detail, _)| *detail == full).count(),
            coarser: self.coarser,
            uploaded: self.uploaded,
        }
    }
}

impl Residence {
    /// Which of all points of a template's chunk a point of it on the device was.
    pub(super) fn point(&self, template: usize, chunk: usize, point: usize) -> usize {
        let index = template.checked_sub(self.first);
        let known = index.and_then(|at| Some((self.proxies.get(at)?, self.details.get(at)?)));
        known.map_or(point, |(proxy, detail)| detail.point(proxy, chunk, point))
    }
}

const _: () = assert!(DETAILS[DETAILS.len() - 1].segments == MAX_SEGMENTS);
