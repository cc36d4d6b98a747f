//! Meshes of neurons.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use glam::DAffine3;
use neurotess::generate::Generated;
use neurotess::mesh::{self, Placed, Surface};
use neurotess::output::write_whole;
use neurotess::refine::{
    Caps, CoarseSurface, Lod, LodCriterion, Path as Course, RefineOptions, Refinement,
};
use neurotess::render::{CullView, Placement};

use super::existing;
use crate::io::task::Progress;
use crate::model::document::Detail;
use crate::model::numbers::grouped;
use crate::model::save::{MeshLod, MeshOptions};
use crate::model::targets::{file_name, mesh_file, mesh_folder};
use crate::model::view::View;

/// A cell to be written.
#[derive(Clone)]
pub(crate) struct MeshPlan {
    pub(crate) name: String,
    pub(crate) generated: Arc<Generated>,
    pub(crate) placement: Placement,
}

/// Writes meshes.
pub(crate) fn meshes(
    plans: &[MeshPlan],
    options: &MeshOptions,
    view: &View,
    detail: &Detail,
    height: f64,
    progress: &Progress,
) -> Result<String, String> {
    let files = mesh_files(plans, options)?;
    for file in &files {
        if !options.replace && file.exists() {
            return Err(format!(
                "{} exists: allow it to be replaced",
                file.display()
            ));
        }
    }
    let (mut faces, mut written) = (0, 0);
    for (plan, file) in plans.iter().zip(&files) {
        if progress.is_canceled() {
            return Err(format!("stopped after {written} of {} meshes", files.len()));
        }
        faces += write_mesh(plan, options, view, detail, height, file)?;
        written += 1;
        progress.done.fetch_add(1, Ordering::Relaxed);
    }
    let what = match &files[..] {
        [one] => one.display().to_string(),
        many => format!("{} meshes in {}", many.len(), options.out.display()),
    };
    Ok(format!("Saved {what}: {} faces", grouped(faces as u64)))
}

/// The file of each plan. Equal names get a number.
fn mesh_files(plans: &[MeshPlan], options: &MeshOptions) -> Result<Vec<PathBuf>, String> {
    let extension = options.format.extension();
    if let [_] = plans {
        return Ok(vec![mesh_file(&options.out, options.format)]);
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

fn write_mesh(
    plan: &MeshPlan,
    options: &MeshOptions,
    view: &View,
    detail: &Detail,
    height: f64,
    file: &Path,
) -> Result<usize, String> {
    let coarse = &plan.generated.mesh;
    let refine = RefineOptions {
        path: if options.linear {
            Course::Linear
        } else {
            Course::Hermite
        },
        caps: if options.flat {
            Caps::Flat
        } else {
            Caps::Round
        },
        quads: options.quads && options.format.has_quads(),
    };
    let (refinement, quads);
    let surface: &dyn Surface = match mesh_lod(options.lod, plan, view, detail, height) {
        Some(lod) => {
            refinement = Refinement::new(coarse, lod, &refine);
            &refinement
        }
        None => {
            quads = CoarseSurface::new(coarse, options.format.has_quads());
            &quads
        }
    };
    let moved = options.placed.then(|| {
        let p = plan.placement;
        let linear =
            DAffine3::from_quat(p.rotation) * DAffine3::from_scale(glam::DVec3::splat(p.scale));
        Placed::new(surface, DAffine3::from_translation(p.translation) * linear)
    });
    let surface: &dyn Surface = moved.as_ref().map_or(surface, |moved| moved);
    write_whole(file, existing(options.replace), |to| {
        mesh::write(surface, options.format, to).map_err(std::io::Error::other)
    })
    .map_err(|e| e.to_string())?;
    Ok(surface.triangle_count() + surface.quad_count())
}

fn mesh_lod(
    lod: MeshLod,
    plan: &MeshPlan,
    view: &View,
    detail: &Detail,
    height: f64,
) -> Option<Lod<'static>> {
    match lod {
        MeshLod::Fixed(criterion) => {
            let limited = match criterion? {
                LodCriterion::Homogeneous(level) => LodCriterion::Homogeneous(level.clamp(1, 64)),
                LodCriterion::MaxError(error) => LodCriterion::MaxError(error.max(1e-4)),
                other => other,
            };
            Some(limited.into())
        }
        MeshLod::AsShown => {
            let camera = view.camera();
            let placement = &plan.placement;
            let cull_view = CullView::new(&camera, 1, height.max(1.0) as u32, 1e-3);
            let local = cull_view.local_view(placement, plan.generated.mesh.origin);
            Some(Lod::seen_from(detail.lod().scaled(placement.scale), local))
        }
    }
}

#[cfg(test)]
mod tests {
    use neurotess::mesh::Format;

    use super::*;
    use crate::io::load;
    use crate::model::document::SomaEdit;
    use crate::model::sources;

    const LEVEL_1: MeshLod = MeshLod::Fixed(Some(LodCriterion::Homogeneous(1)));

    fn plan(name: &str) -> MeshPlan {
        let star = sources::sample(neurotess::synth::Kind::Star);
        let source = load::load(&star, SomaEdit::default(), None).expect("grown");
        MeshPlan {
            name: name.into(),
            generated: source.generated,
            placement: Placement {
                translation: glam::DVec3::X * 1000.0,
                ..Placement::default()
            },
        }
    }

    fn options(out: PathBuf) -> MeshOptions {
        MeshOptions {
            out,
            format: Format::Ply,
            lod: LEVEL_1,
            quads: false,
            linear: false,
            flat: false,
            placed: true,
            all: true,
            replace: false,
        }
    }

    #[test]
    fn meshes_are_closed_stand_where_told_and_replace_nothing_unasked() {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("a.ply");
        let view = View::default();
        let write = |lod, replace| {
            let options = MeshOptions {
                lod,
                replace,
                ..options(out.clone())
            };
            meshes(
                &[plan("a")],
                &options,
                &view,
                &Detail::default(),
                600.0,
                &Progress::new("", "", 1),
            )
        };
        for lod in [
            LEVEL_1,
            MeshLod::Fixed(None),
            MeshLod::AsShown,
            MeshLod::Fixed(Some(LodCriterion::MaxError(0.1))),
        ] {
            write(lod, true).expect("written");
            let bytes = std::fs::read(&out).expect("there");
            let mesh = mesh::read_bytes(&bytes, Format::Ply).expect("a mesh");
            assert!(mesh::check(&mesh).closed, "{lod:?}");
            let x = mesh.origin.x + f64::from(mesh.vertices[0].position.x);
            assert!(x > 300.0, "{x}");
        }
        assert!(
            write(LEVEL_1, false)
                .expect_err("is there")
                .contains("exists")
        );
    }

    #[test]
    fn many_meshes_go_to_a_folder_with_names_of_their_own() {
        let plans = [plan("a"), plan("a"), plan("b/c")];
        let files = mesh_files(&plans, &options(PathBuf::from("out/all.ply"))).expect("named");
        let names: Vec<String> = files
            .iter()
            .map(|f| f.display().to_string().replace('\\', "/"))
            .collect();
        assert_eq!(
            names,
            ["out/all/a.ply", "out/all/a_1.ply", "out/all/b_c.ply"]
        );
        assert!(mesh_files(&[], &options(PathBuf::new())).is_err());
    }
}
