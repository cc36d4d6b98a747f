//! What draws while something moves: the scene as a sketch, whose frames have a bounded number of
//! triangles whatever there is. It is made beside; until it is there, the other maker draws coarsely.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use eframe::egui;
use neurotess::coloring::Coloring;
use neurotess::generate::Generated;
use neurotess::render::{
    DEFAULT_BUDGET, DeviceError, Exploration, Gpu, Proxy, ProxyPickResolver, ProxyPickTargets,
};

use crate::scene::content::{self, Shown, Standing};

/// Fewest triangles of a frame, however slow the device.
const LEAST_BUDGET: u32 = 12_500;

/// A sketch of what is shown, if it is there.
#[derive(Default)]
pub(crate) struct Explorer {
    made: Option<Made>,
    making: Option<(Key, Receiver<Sketched>)>,
    /// What could not be sketched is not tried again.
    refused: Option<Key>,
    budget: Option<u32>,
}

type Sketched = Result<(Exploration, Arc<[ProxyPickTargets]>), DeviceError>;

struct Made {
    maker: Exploration,
    names: Arc<[ProxyPickTargets]>,
    key: Key,
    standing: Vec<Standing>,
}

/// What a sketch is of.
#[derive(Clone)]
struct Key {
    meshes: Vec<Arc<Generated>>,
    coloring: Arc<Coloring>,
}

impl Key {
    fn of(shown: &Shown) -> Self {
        Self {
            meshes: shown
                .sources
                .iter()
                .map(|s| Arc::clone(&s.generated))
                .collect(),
            coloring: Arc::clone(&shown.coloring),
        }
    }

    fn fits(&self, shown: &Shown) -> bool {
        self.meshes.len() == shown.sources.len()
            && Arc::ptr_eq(&self.coloring, &shown.coloring)
            && self
                .meshes
                .iter()
                .zip(&shown.sources)
                .all(|(mesh, source)| Arc::ptr_eq(mesh, &source.generated))
    }
}

impl Explorer {
    /// Takes what was made and begins what is not there yet.
    pub(crate) fn update(&mut self, gpu: &Arc<Gpu>, shown: &Shown, ctx: &egui::Context) {
        if let Some((key, receiver)) = &self.making {
            let Ok(made) = receiver.try_recv() else {
                return;
            };
            let key = key.clone();
            self.making = None;
            match made {
                Ok((maker, names)) => {
                    self.made = Some(Made {
                        maker,
                        names,
                        key,
                        standing: Vec::new(),
                    });
                }
                // Too large for the device: the other maker draws it.
                Err(_) => self.refused = Some(key),
            }
        }
        let fits = |key: &Key| key.fits(shown);
        let known = self.made.as_ref().map(|made| &made.key);
        if shown.sources.is_empty()
            || known.is_some_and(fits)
            || self.refused.as_ref().is_some_and(fits)
        {
            return;
        }
        self.made = None;
        self.begin(gpu, Key::of(shown), ctx);
    }

    fn begin(&mut self, gpu: &Arc<Gpu>, key: Key, ctx: &egui::Context) {
        let (sender, receiver) = channel();
        self.making = Some((key.clone(), receiver));
        let (gpu, ctx) = (Arc::clone(gpu), ctx.clone());
        std::thread::spawn(move || {
            let cells = key.meshes.iter().zip(&key.coloring.color_keys);
            let sketches: Vec<Proxy> = cells
                .map(|(cell, words)| Proxy::new(&cell.mesh, words))
                .collect();
            let made = Exploration::new(&gpu, 1).and_then(|mut maker| {
                maker.add(&gpu, &sketches)?;
                Ok((maker, sketches.iter().map(ProxyPickTargets::new).collect()))
            });
            // Nobody waits for it if the window is closed.
            let _ = sender.send(made);
            ctx.request_repaint();
        });
    }

    /// The maker of a sketch of just this, with all neurons where they stand.
    /// `budget`: its triangles.
    pub(crate) fn maker(
        &mut self,
        gpu: &Gpu,
        shown: &Shown,
        budget: u32,
    ) -> Option<&mut Exploration> {
        let made = self.made.as_mut().filter(|made| made.key.fits(shown))?;
        if made.standing != shown.instances {
            let instances = content::instances(&shown.instances);
            made.maker.set_instances(gpu, instances).ok()?;
            made.standing.clone_from(&shown.instances);
        }
        made.maker.set_budget(budget);
        Some(&mut made.maker)
    }

    /// Whether there is a sketch of just this.
    pub(crate) fn fits(&self, shown: &Shown) -> bool {
        self.made.as_ref().is_some_and(|made| made.key.fits(shown))
    }

    /// Whether a sketch will be there soon.
    pub(crate) fn is_making(&self) -> bool {
        self.making.is_some()
    }

    /// Who tells what ids of pictures of the sketch mean.
    pub(crate) fn namer(&self) -> Option<ProxyPickResolver> {
        let made = self.made.as_ref()?;
        Some(made.maker.namer(Arc::clone(&made.names)))
    }

    /// Frames have fewer triangles where they take too long, and more where there is time.
    pub(crate) fn keep_up(&mut self, took_ms: f64, most_ms: f64) {
        let budget = self.budget.unwrap_or(DEFAULT_BUDGET);
        if took_ms > 1.5 * most_ms {
            self.budget = Some((budget / 2).max(LEAST_BUDGET));
        } else if took_ms < 0.4 * most_ms {
            self.budget = Some((budget / 5 * 7).min(DEFAULT_BUDGET));
        }
    }

    /// Triangles of a frame.
    pub(crate) fn budget(&self) -> u32 {
        self.budget.unwrap_or(DEFAULT_BUDGET)
    }
}
