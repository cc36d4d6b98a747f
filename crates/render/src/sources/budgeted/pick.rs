//! What a picking id of exploration mode means: an instance, and a tracing point of its mesh. Reads
//! what visible_chunks_id.wgsl writes.

use std::sync::Arc;

use super::Exploration;
use super::layout::CHUNK_SOMA;
use super::proxy::Proxy;
use super::streaming::{Residence, Streaming};
use crate::sources::pick::PickId;
use crate::sources::pick::{POINT_BITS, PickHit, PickTarget};

/// Which tracing points of a mesh the points of its proxy's chunks are.
#[derive(Clone, Debug, Default)]
pub struct ProxyPickTargets {
    /// By chunk: where its points begin, and whether it is a soma.
    chunks: Vec<(u32, bool)>,
    /// Tracing points of all chunks, one chunk after the other.
    points: Vec<u32>,
}

impl ProxyPickTargets {
    /// The pick targets of a proxy.
    pub fn new(proxy: &Proxy) -> Self {
        let mut targets = Self::default();
        for (chunk, colors) in proxy.chunks.iter().zip(&proxy.colors) {
            let soma = chunk.flags & CHUNK_SOMA != 0;
            targets.chunks.push((targets.points.len() as u32, soma));
            targets.points.extend(colors);
        }
        targets
    }

    /// The pick target of a chunk's point.
    fn target(&self, chunk: usize, point: usize) -> Option<PickTarget> {
        let &(first, soma) = self.chunks.get(chunk)?;
        let end = self
            .chunks
            .get(chunk + 1)
            .map_or(self.points.len(), |r| r.0 as usize);
        let points = self.points.get(first as usize..end)?;
        let point = points.get(point).or(points.last()).copied()?;
        Some(if soma {
            PickTarget::Soma(point)
        } else {
            PickTarget::Point(point)
        })
    }
}

/// Resolves the ids of one frame of exploration mode, also after other frames were drawn.
#[derive(Clone, Debug)]
pub struct ProxyPickResolver {
    targets: Arc<[ProxyPickTargets]>,
    /// By instance: its template, and the template's first chunk.
    instances: Vec<(u32, u32)>,
    /// How finely streamed templates were there.
    residence: Option<Residence>,
}

impl ProxyPickResolver {
    /// What was drawn at a pixel with this id; nothing if nothing was.
    pub fn resolve(&self, [first, second]: PickId) -> Option<PickHit> {
        let instance = first.checked_sub(1)?;
        let &(template, first_chunk) = self.instances.get(instance as usize)?;
        let chunk = (second >> POINT_BITS).checked_sub(first_chunk)?;
        let (template, chunk) = (template as usize, chunk as usize);
        let point = (second & ((1 << POINT_BITS) - 1)) as usize;
        let point = match &self.residence {
            Some(residence) => residence.point(template, chunk, point),
            None => point,
        };
        let target = self.targets.get(template)?.target(chunk, point)?;
        Some(PickHit { instance, target })
    }
}

impl Exploration {
    /// Resolves ids of the current instances. `targets`: those of all proxies that were added, in
    /// order.
    pub fn resolver(&self, targets: Arc<[ProxyPickTargets]>) -> ProxyPickResolver {
        let instances = self.instances.iter().map(|instance| {
            let template = instance.template.0;
            (template, self.known[template as usize].first_chunk)
        });
        ProxyPickResolver {
            targets,
            instances: instances.collect(),
            residence: self.streaming.as_ref().map(Streaming::residence),
        }
    }
}
