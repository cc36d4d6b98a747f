//! Everything that draws also draws on OpenGL. Its pictures are compared with those of the adapter that is
//! used otherwise, as an eye does: where pixels are covered in part, OpenGL takes its samples elsewhere,
//! with one in each sub-pixel instead of four.

use neurotess_mesh::CoarseMesh;
use neurotess_render::pick::{PickHit, PickTarget};
use neurotess_render::{Gpu, Image, Look, Occlusion, PictureOptions, Placement, Steps};

use crate::adapter::{device, gpu};
use crate::compared::Difference;
use crate::pictured::{CELL, camera, explored, mesh};
use crate::renderer::{SIZE, picks, renderer, source, view};

/// The backend.
const OPENGL: &str = "gl";

/// The need of these tests: OpenGL, and another adapter beside it.
fn opengl() -> Result<(), String> {
    Gpu::open(Some(OPENGL)).map_err(|error| error.to_string())?;
    match Gpu::open(None) {
        Ok(other) if other.adapter.backend != OPENGL => Ok(()),
        Ok(_) => Err("no adapter beside OpenGL to compare with".into()),
        Err(error) => Err(error.to_string()),
    }
}

/// Draws on both adapters and compares. At least a hundredth of the picture must be drawn.
fn compare(name: &str, draw: impl Fn(&Gpu) -> Image) {
    let there = draw(&device());
    let opengl = draw(&Gpu::open(Some(OPENGL)).expect("the test has needs(opengl)"));
    let shown = there.pixels.chunks(4).filter(|pixel| *pixel != [255; 4]);
    assert!(
        100 * shown.count() > there.pixels.len() / 4,
        "{name}: empty"
    );
    let difference = Difference::between(&there, &opengl);
    neurotess_testing::note!("{name}: {difference}");
    assert!(!difference.is_seen(), "{name}: {difference}");
}

fn small() -> PictureOptions {
    PictureOptions {
        size: SIZE,
        ..PictureOptions::default()
    }
}

#[neurotess_testing::test(needs(gpu, opengl))]
fn saved_pictures_look_alike() {
    let mesh = mesh(CELL);
    let wireframe = Look {
        wire: 1.0,
        ..Look::default()
    };
    let all = [
        ("default", small()),
        (
            "one sample",
            PictureOptions {
                samples: 1,
                ..small()
            },
        ),
        (
            "without occlusion",
            PictureOptions {
                occlusion: Occlusion::Off,
                ..small()
            },
        ),
        (
            "wireframe",
            PictureOptions {
                look: wireframe,
                ..small()
            },
        ),
    ];
    for (name, options) in all {
        let camera = camera(&mesh, SIZE);
        compare(name, |gpu| {
            crate::pictured::picture(gpu, &mesh, &camera, &options)
        });
    }
}

/// Levels are selected by compute shaders, and draws are indirect.
#[neurotess_testing::test(needs(gpu, opengl))]
fn pictures_of_a_window_look_alike() {
    let mesh = mesh(CELL);
    let steps = Steps {
        steps: 16,
        slices: 1,
    };
    compare("adaptive", |gpu| {
        let mut source = source(gpu, &mesh, &[Placement::default()]);
        let mut renderer = renderer(gpu, &mesh);
        crate::renderer::picture(gpu, &mut renderer, &mut source, view(&mesh), steps)
    });
}

#[neurotess_testing::test(needs(gpu, opengl))]
fn neurons_within_a_budget_look_alike() {
    let mesh = mesh(CELL);
    let camera = camera(&mesh, SIZE);
    compare("exploration", |gpu| {
        explored(gpu, &mesh, 6, 4000, &camera, &small())
    });
}

/// Ids are of one sample. The id of a flat patch is one of its corners: the first of a triangle, on OpenGL
/// the last.
#[neurotess_testing::test(needs(gpu, opengl))]
fn ids_name_the_same_patches() {
    let mesh = mesh(CELL);
    let of = |gpu: &Gpu| {
        let mut source = source(gpu, &mesh, &[Placement::default()]);
        let mut renderer = renderer(gpu, &mesh);
        picks(gpu, &mut renderer, &mut source, &view(&mesh))
    };
    let there = of(&device());
    let opengl = of(&Gpu::open(Some(OPENGL)).expect("the test has needs(opengl)"));
    let shown = there.iter().flatten().count();
    assert!(shown > 2000, "{shown}");
    let apart = there.iter().zip(&opengl);
    let apart = apart.filter(|(a, b)| !of_one_patch(&mesh, a.as_ref(), b.as_ref()));
    // Pixels whose centers are on an outline, up to rounding.
    let apart = apart.count();
    assert!(500 * apart < shown, "{apart} of {shown}");
}

fn of_one_patch(mesh: &CoarseMesh, a: Option<&PickHit>, b: Option<&PickHit>) -> bool {
    let (Some(a), Some(b)) = (a, b) else {
        return a == b;
    };
    match (a.target, b.target) {
        (PickTarget::Vertex(one), PickTarget::Vertex(other)) => {
            let has = |corners: &[u32; 4]| corners.contains(&one) && corners.contains(&other);
            mesh.patches.iter().any(|patch| has(&patch.corners))
        }
        (one, other) => one == other,
    }
}
