//! Draws while something moves, in exploration mode: a frame has a limited number of triangles,
//! whatever the scene. The proxies of templates that it needs are computed in the background; until
//! then, the adaptive source draws coarsely.

use std::sync::Arc;

use eframe::egui;
use neurotess::generate::Generated;
use neurotess::render::pick::{ProxyPickResolver, ProxyPickTargets};
use neurotess::render::{DEFAULT_BUDGET, DeviceError, Exploration, Gpu, Proxy};
use rayon::prelude::*;

use crate::io::task::{Progress, Task};
use crate::model::revision::Revision;
use crate::scene::content::{self, InstancesKey, SceneContent};

/// Fewest triangles of a frame, however slow the device.
const MIN_BUDGET: u32 = 12_500;

/// Proxies of the scene's templates, once they are computed.
#[derive(Default)]
pub(crate) struct Explorer {
    built: Option<BuiltScene>,
    making: Option<(Revision, Task<ProxyResult>)>,
    /// Content whose proxies do not fit the device; they are not tried again.
    refused: Option<Revision>,
    budget: Option<u32>,
    /// Most bytes of templates on the device.
    pub(crate) memory: Option<u64>,
    builds: u64,
}

type ProxyResult = Result<(Exploration, Arc<[ProxyPickTargets]>), DeviceError>;

struct BuiltScene {
    exploration: Exploration,
    targets: Arc<[ProxyPickTargets]>,
    /// Revision of the content that it was computed from.
    content: Revision,
    /// Key of its instances.
    instances: Option<InstancesKey>,
    /// Indices of the instances that another source draws, ascending.
    left_out: Arc<[usize]>,
}

impl BuiltScene {
    /// Leaves out these instances, and draws those again that were left out before.
    fn leave_out(&mut self, content: &SceneContent, left_out: &Arc<[usize]>) {
        let before = std::mem::replace(&mut self.left_out, Arc::clone(left_out));
        for &index in before.iter().chain(left_out.iter()) {
            if let Some(instance) = content.instances.get(index) {
                let leaves = left_out.binary_search(&index).is_ok();
                self.exploration
                    .set_hidden(index, instance.hidden || leaves);
            }
        }
    }
}

impl Explorer {
    /// Takes proxies that were computed, and starts to compute those that are missing.
    pub(crate) fn update(
        &mut self,
        gpu: &Arc<Gpu>,
        content: &SceneContent,
        ctx: &egui::Context,
    ) -> Option<String> {
        let mut problem = None;
        if let Some((key, task)) = &self.making {
            let built = task.take()?;
            let key = *key;
            self.making = None;
            match built {
                Ok(Ok((exploration, targets))) => {
                    self.built = Some(BuiltScene {
                        exploration,
                        targets,
                        content: key,
                        instances: None,
                        left_out: Arc::default(),
                    });
                }
                // Too large for the device: the adaptive source draws it.
                Ok(Err(_)) => self.refused = Some(key),
                Err(why) => (self.refused, problem) = (Some(key), Some(why)),
            }
        }
        let fits = |key: &Revision| *key == content.revision;
        let known = self.built.as_ref().map(|built| &built.content);
        if content.sources.is_empty()
            || known.is_some_and(fits)
            || self.refused.as_ref().is_some_and(fits)
        {
            return problem;
        }
        self.built = None;
        self.begin(gpu, content, ctx);
        problem
    }

    fn begin(&mut self, gpu: &Arc<Gpu>, content: &SceneContent, ctx: &egui::Context) {
        self.builds += 1;
        let meshes = content.sources.iter().map(|source| {
            let proxy = source.proxy.clone();
            (Arc::clone(&source.generated), proxy)
        });
        let meshes: Vec<(Arc<Generated>, Option<Arc<Proxy>>)> = meshes.collect();
        let coloring = Arc::clone(&content.coloring);
        let (gpu, ctx, memory) = (Arc::clone(gpu), ctx.clone(), self.memory);
        let work = move |_: &Progress| {
            let cells = meshes.par_iter().zip_eq(&coloring.color_keys);
            let proxies: Vec<Arc<Proxy>> = cells
                .map(|((generated, proxy), color_keys)| match proxy {
                    Some(proxy) => Arc::new(proxy.with_color_keys(color_keys)),
                    None => Arc::new(Proxy::new(&generated.mesh, color_keys)),
                })
                .collect();
            let targets = proxies.iter().map(|proxy| ProxyPickTargets::new(proxy));
            let targets = targets.collect();
            Ok(Exploration::new(&gpu, 1).and_then(|mut exploration| {
                exploration.add_streamed(&gpu, &proxies, memory)?;
                Ok((exploration, targets))
            }))
        };
        let progress = Progress::new("preparing drafts", "cells", 0);
        let task = Task::start(progress, move || ctx.request_repaint(), work);
        self.making = Some((content.revision, task));
    }

    /// The vertex source of exploration mode for exactly this content, with all its instances but those that are
    /// left out, given by ascending indices. `budget`: most triangles. `most_upload`: most bytes that a picture may
    /// upload where not all templates fit the device.
    pub(crate) fn exploration(
        &mut self,
        gpu: &Gpu,
        content: &SceneContent,
        instances_key: Option<InstancesKey>,
        budget: u32,
        left_out: &Arc<[usize]>,
        most_upload: Option<u64>,
    ) -> Option<&mut Exploration> {
        let built = self
            .built
            .as_mut()
            .filter(|built| built.content == content.revision)?;
        if built.instances != instances_key {
            let instances = content::device_instances(&content.instances);
            built.exploration.set_instances(gpu, instances).ok()?;
            built.instances = instances_key;
            built.left_out = Arc::default();
        }
        if built.left_out != *left_out {
            built.leave_out(content, left_out);
        }
        built.exploration.set_budget(budget);
        built.exploration.set_most_upload(most_upload);
        Some(&mut built.exploration)
    }

    /// Whether there are proxies of exactly this content.
    pub(crate) fn fits(&self, content: &SceneContent) -> bool {
        self.built
            .as_ref()
            .is_some_and(|built| built.content == content.revision)
    }

    /// Whether proxies are being computed.
    pub(crate) fn is_making(&self) -> bool {
        self.making.is_some()
    }

    /// Resolves ids of pictures that were drawn from proxies.
    pub(crate) fn resolver(&self) -> Option<ProxyPickResolver> {
        let built = self.built.as_ref()?;
        Some(built.exploration.resolver(Arc::clone(&built.targets)))
    }

    /// Adapts the budget: fewer triangles if frames take too long, more if there is time.
    pub(crate) fn keep_up(&mut self, took_ms: f64, most_ms: f64) {
        let budget = self.budget.unwrap_or(DEFAULT_BUDGET);
        if took_ms > 1.5 * most_ms {
            self.budget = Some((budget / 2).max(MIN_BUDGET));
        } else if took_ms < 0.4 * most_ms {
            self.budget = Some((budget / 5 * 7).min(DEFAULT_BUDGET));
        }
    }

    /// How many times proxies were computed.
    pub(crate) fn builds(&self) -> u64 {
        self.builds
    }

    /// Bytes on the device.
    pub(crate) fn bytes(&self) -> u64 {
        let bytes = self
            .built
            .iter()
            .flat_map(|built| built.exploration.bytes());
        bytes.map(|(_, bytes)| bytes).sum()
    }

    /// Most triangles of a frame.
    pub(crate) fn budget(&self) -> u32 {
        self.budget.unwrap_or(DEFAULT_BUDGET)
    }
}
