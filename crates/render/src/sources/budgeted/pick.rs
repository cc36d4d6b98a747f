//! What an id of exploration means: instance, and traced point of its mesh. Twin of visible_chunks_id.wgsl.

use std::sync::Arc;

use super::Exploration;
use super::layout::CHUNK_SOMA;
use super::proxy::Proxy;
use crate::sources::pick::PickId;
use crate::sources::pick::{POINT_BITS, PickHit, PickTarget};

/// What the points of a proxy's chunks are in its mesh.
#[derive(Clone, Debug, Default)]
pub struct ProxyPickTargets {
    /// By chunk: where its points begin, and whether it is a soma.
    chunks: Vec<(u32, bool)>,
    /// Tracing points.
    points: Vec<u32>,
}

impl ProxyPickTargets {
    /// Of a proxy.
    pub fn new(proxy: &Proxy) -> Self {
        let mut names = Self::default();
        for (chunk, colors) in proxy.chunks.iter().zip(&proxy.colors) {
            let soma = chunk.flags & CHUNK_SOMA != 0;
            names.chunks.push((names.points.len() as u32, soma));
            names.points.extend(colors);
        }
        names
    }

    /// What a point of a chunk is.
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

/// Knows what the ids of a frame of exploration mean, also when other frames came after.
#[derive(Clone, Debug)]
pub struct ProxyPickResolver {
    names: Arc<[ProxyPickTargets]>,
    /// By instance: its template, and the first of that one's chunks.
    instances: Vec<(u32, u32)>,
}

impl ProxyPickResolver {
    /// What an id of the frame means; nothing where nothing was drawn.
    pub fn resolve(&self, [first, place]: PickId) -> Option<PickHit> {
        let instance = first.checked_sub(1)?;
        let &(template, first_chunk) = self.instances.get(instance as usize)?;
        let chunk = (place >> POINT_BITS).checked_sub(first_chunk)?;
        let point = place & ((1 << POINT_BITS) - 1);
        let names = self.names.get(template as usize)?;
        let target = names.target(chunk as usize, point as usize)?;
        Some(PickHit { instance, target })
    }
}

impl Exploration {
    /// Who tells what ids of the instances of now mean. `names`: of all proxies that were added.
    pub fn resolver(&self, names: Arc<[ProxyPickTargets]>) -> ProxyPickResolver {
        let instances = self.instances.iter().map(|instance| {
            let template = instance.template.0;
            (template, self.known[template as usize].first_chunk)
        });
        ProxyPickResolver {
            names,
            instances: instances.collect(),
        }
    }
}
