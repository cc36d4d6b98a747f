//! Meshes of neurons, by the recipe of the library: the same as the command line makes.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use glam::{DAffine3, DVec3};
use neurotess::generate::{GenerateOptions, Generated};
use neurotess::morphology::Morphology;
use neurotess::recipe::{
    self, CellMesh, Levels, SaveError, SaveOptions, Saved, Spelling, Stage, Warning, Watch,
    mesh_from, mesh_watched,
};
use neurotess::render::{CullView, Placement};

use super::{Written, existing};
use crate::io::task::{Progress, caught};
use crate::model::document::Detail;
use crate::model::numbers::grouped;
use crate::model::save::MeshOptions;
use crate::model::targets::{file_name, mesh_file, mesh_folder};
use crate::model::view::View;

/// A cell to be written.
#[derive(Clone)]
pub(crate) struct MeshPlan {
    pub(crate) name: String,
    /// The tracing as it is drawn.
    pub(crate) morphology: Arc<Morphology>,
    /// What is drawn, and what it was made by.
    pub(crate) generated: Arc<Generated>,
    pub(crate) generate: GenerateOptions,
    pub(crate) placement: Placement,
}

/// The view that levels may depend on.
#[derive(Clone, Copy)]
pub(crate) struct SeenFrom {
    pub(crate) view: View,
    pub(crate) detail: Detail,
    /// Pixels.
    pub(crate) height: f64,
}

/// Meshes and writes neurons. One that fails is told, and keeps no other from being written.
///
/// # Errors
/// Nothing was written, or it was stopped.
pub(crate) fn meshes(
    plans: &[MeshPlan],
    options: &MeshOptions,
    seen_from: &SeenFrom,
    progress: &Progress,
) -> Result<Written, String> {
    let options = &options.fitting();
    let files = mesh_files(plans, options)?;
    if !options.files.parts {
        // Before any is written.
        for file in &files {
            existing(options.replace)
                .check(file)
                .map_err(|e| e.to_string())?;
        }
    }
    let (mut faces, mut written) = (0, Vec::new());
    let mut remarks = Vec::new();
    let mut last: Option<MadeMesh> = None;
    for index in by_tracing(plans) {
        let (plan, file) = (&plans[index], &files[index]);
        let stopped = || format!("stopped after {} of {} meshes", written.len(), files.len());
        if progress.is_canceled() {
            return Err(stopped());
        }
        let one = Job {
            plan,
            options,
            seen_from,
            progress,
            is_alone: files.len() == 1,
        };
        match caught(|| one.save(file, &mut last)) {
            Ok((saved, said)) => {
                faces += saved.triangles + saved.quads;
                written.extend(saved.files.first().cloned());
                remarks.extend(said.into_iter().map(|said| (plan.name.clone(), said)));
            }
            Err(_) if progress.is_canceled() => return Err(stopped()),
            Err(why) if files.len() == 1 => return Err(why),
            Err(why) => remarks.push((plan.name.clone(), format!("not saved: {why}"))),
        }
        if files.len() > 1 {
            progress.done.fetch_add(1, Ordering::Relaxed);
        }
    }
    let what = match (&written[..], &files[..]) {
        ([], _) => return Err(failures(&remarks)),
        ([one], [_]) => one.display().to_string(),
        (some, all) => {
            let folder = mesh_folder(&options.out);
            let of_all = match all.len() - some.len() {
                0 => String::new(),
                _ => format!(" of {}", all.len()),
            };
            format!("{}{of_all} meshes in {}", some.len(), folder.display())
        }
    };
    Ok(Written {
        status: format!("Saved {what}: {} faces", grouped(faces as u64)),
        remarks,
    })
}

/// Indices of plans, those of a tracing one after the other: it is meshed once.
fn by_tracing(plans: &[MeshPlan]) -> Vec<usize> {
    let mut first: HashMap<*const Generated, usize> = HashMap::new();
    for (index, plan) in plans.iter().enumerate() {
        first.entry(Arc::as_ptr(&plan.generated)).or_insert(index);
    }
    let mut order: Vec<usize> = (0..plans.len()).collect();
    order.sort_by_key(|&index| first[&Arc::as_ptr(&plans[index].generated)]);
    order
}

/// A cell that was meshed, and the coarse mesh that is drawn of it.
struct MadeMesh {
    drawn: Arc<Generated>,
    cell: CellMesh,
}

fn failures(remarks: &[(String, String)]) -> String {
    let first = remarks.first();
    let first = first.map_or(String::new(), |(name, why)| format!("{name}: {why}"));
    match remarks.len() {
        0 | 1 => first,
        more => format!("{first}, and {} more", more - 1),
    }
}

/// The file of each plan. Equal names get a number.
fn mesh_files(plans: &[MeshPlan], options: &MeshOptions) -> Result<Vec<PathBuf>, String> {
    let format = options.files.format;
    let extension = format.extension();
    if let [_] = plans {
        return Ok(vec![mesh_file(&options.out, format)]);
    }
    if plans.is_empty() {
        return Err("nothing is selected: select neurons, or save all that show".into());
    }
    // If a file is named for several cells, its stem becomes the name of a folder.
    let folder = mesh_folder(&options.out);
    let mut files: Vec<PathBuf> = Vec::new();
    for plan in plans {
        let stem = file_name(&plan.name);
        let name = |n: usize| match n {
            0 => folder.join(format!("{stem}.{extension}")),
            n => folder.join(format!("{stem}_{n}.{extension}")),
        };
        let file = (0..).map(name).find(|file| !files.contains(file));
        files.extend(file);
    }
    Ok(files)
}

/// A cell that is meshed and written.
struct Job<'a> {
    plan: &'a MeshPlan,
    options: &'a MeshOptions,
    seen_from: &'a SeenFrom,
    progress: &'a Progress,
    /// Whether its steps are counted, since there are no other cells to count.
    is_alone: bool,
}

impl Job<'_> {
    /// Saves it; also gives what is to be said of the mesh. `last`: what was saved before, which may be of the same tracing.
    fn save(
        &self,
        file: &Path,
        last: &mut Option<MadeMesh>,
    ) -> Result<(Saved, Vec<String>), String> {
        let tell = |told: recipe::Progress| self.tell(told);
        let watch = Watch::stopped_by(&self.progress.canceled).with_progress(&tell);
        let drawn = &self.plan.generated;
        // Levels of the picture are other ones for each neuron.
        let is_same = |last: &MadeMesh| Arc::ptr_eq(&last.drawn, drawn) && !self.options.as_shown;
        let again = last.take().filter(is_same);
        let is_again = again.is_some();
        let made = match again {
            Some(made) => made,
            None => MadeMesh {
                drawn: Arc::clone(drawn),
                cell: self.mesh(&watch)?,
            },
        };
        let cell = &last.insert(made).cell;
        let mut to = SaveOptions::new(self.options.files.format);
        to.files = self.options.files;
        to.existing = existing(self.options.replace);
        let placement = &self.plan.placement;
        to.world_from_cell = self.options.placed.then(|| world_from_cell(placement));
        let saved = cell.save_with(file, &to, &watch).map_err(|e| match e {
            SaveError::Options(e) => e.told(Spelling::Label),
            e => e.to_string(),
        })?;
        // What is to be said of the coarse mesh is said where the tracing was opened.
        let warnings = match is_again {
            true => Vec::new(),
            false => cell.report().warnings,
        };
        let of_surface = warnings
            .into_iter()
            .filter(|warning| matches!(warning, Warning::Surface(_)));
        let said = of_surface.map(|warning| warning.to_string());
        let of_walls = saved.warning.as_ref().filter(|_| !is_again);
        let of_walls = of_walls.map(ToString::to_string);
        let said = said.chain(of_walls).collect();
        Ok((saved, said))
    }

    fn mesh(&self, watch: &Watch<'_>) -> Result<CellMesh, String> {
        let MeshPlan {
            morphology,
            generated,
            generate,
            ..
        } = self.plan;
        let options = self.recipe();
        // What is drawn is what is asked for, unless branches are moved apart or rings have other radii.
        let morphology = Arc::clone(morphology);
        let made = match options.generate_options() == *generate {
            true => mesh_from(Arc::clone(generated), morphology, &options, watch),
            false => mesh_watched(morphology, &options, watch),
        };
        made.map_err(|e| e.told(Spelling::Label))
    }

    /// The options with the soma of the neuron, and with the levels of the picture if these are asked for.
    fn recipe(&self) -> recipe::MeshOptions {
        let mut options = self.options.recipe.clone();
        options.generate = GenerateOptions {
            polygons: options.generate.polygons,
            ..self.plan.generate.clone()
        };
        if !self.options.as_shown {
            return options;
        }
        let SeenFrom {
            view,
            detail,
            height,
        } = *self.seen_from;
        let placement = &self.plan.placement;
        let cull_view = CullView::new(&view.camera(), 1, height.max(1.0) as u32, 1e-3);
        options.with_levels(Levels::Seen {
            criterion: detail.lod().scaled(placement.scale),
            view: cull_view.local_view(placement, self.plan.generated.mesh.origin),
        })
    }

    fn tell(&self, told: recipe::Progress) {
        self.progress.note(match told.stage {
            Stage::Mesh => "meshing",
            Stage::Merge => "merging what crosses",
            _ => "",
        });
        if self.is_alone {
            self.progress.all.store(told.all, Ordering::Relaxed);
            self.progress.done.store(told.done, Ordering::Relaxed);
        }
    }
}

fn world_from_cell(placement: &Placement) -> DAffine3 {
    DAffine3::from_scale_rotation_translation(
        DVec3::splat(placement.scale),
        placement.rotation,
        placement.translation,
    )
}

#[cfg(test)]
mod tests;
