//! What is saved of neurons.

use neurotess::mesh::{self, Format};
use neurotess::recipe::Crossings;

use super::*;
use crate::io::load;
use crate::model::document::SomaEdit;
use crate::model::sources;

fn plan(name: &str) -> MeshPlan {
    let star = sources::sample(neurotess::synth::Kind::Star);
    let source = load::load(&star, SomaEdit::default(), None).expect("grown");
    MeshPlan {
        name: name.into(),
        morphology: source.morphology,
        generated: source.generated,
        generate: source.soma.options(),
        placement: Placement {
            translation: DVec3::X * 1000.0,
            ..Placement::default()
        },
    }
}

fn options(out: &Path, format: Format) -> MeshOptions {
    let mut options = MeshOptions::new(out, format);
    options.recipe = options.recipe.with_level(1);
    options.placed = true;
    options
}

fn seen_from() -> SeenFrom {
    SeenFrom {
        view: View::default(),
        detail: Detail::default(),
        height: 600.0,
    }
}

fn save(plans: &[MeshPlan], options: &MeshOptions) -> Result<Written, String> {
    meshes(plans, options, &seen_from(), &Progress::new("", "", 1))
}

fn read(out: &Path) -> mesh::SurfaceMesh {
    mesh::read(out).expect("a mesh")
}

#[test]
fn meshes_are_closed_stand_where_told_and_replace_nothing_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("a.ply");
    let usual = options(&out, Format::Ply);
    let mut as_shown = usual.clone();
    as_shown.as_shown = true;
    let with = |recipe: recipe::MeshOptions| MeshOptions {
        recipe,
        ..usual.clone()
    };
    let plans = [plan("a")];
    for options in [
        usual.clone(),
        with(usual.recipe.clone().with_level(0)),
        as_shown,
        with(usual.recipe.clone().with_max_error(0.1)),
    ] {
        let replacing = MeshOptions {
            replace: true,
            ..options
        };
        save(&plans, &replacing).expect("written");
        let mesh = read(&out);
        assert!(mesh::check(&mesh).closed, "{replacing:?}");
        let x = mesh.origin.x + f64::from(mesh.vertices[0].position.x);
        assert!(x > 300.0, "{x}");
    }
    assert!(
        save(&plans, &usual)
            .expect_err("is there")
            .contains("exists")
    );
}

#[test]
fn simulation_meshes_are_those_of_the_library() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("a.msh");
    let mut simulation = options(&out, Format::Msh);
    simulation.placed = false;
    simulation.recipe = recipe::MeshOptions::simulation();
    let plan = plan("a");
    save(std::slice::from_ref(&plan), &simulation).expect("written");
    let ours = std::fs::read(&out).expect("there");
    let cell = recipe::mesh(&*plan.morphology, &recipe::MeshOptions::simulation());
    cell.expect("meshed").save(&out).expect("written");
    assert_eq!(ours, std::fs::read(&out).expect("there"));
    assert_eq!(mesh::check(&read(&out)).self_intersections, 0);
}

#[test]
fn walls_parts_and_materials_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let plans = [plan("a")];
    let at = |name: &str| folder.path().join(name);
    let mut walls = options(&at("walls.msh"), Format::Msh);
    walls.files.walls = true;
    walls.recipe = walls.recipe.with_crossings(Crossings::Merge);
    save(&plans, &walls).expect("written");
    let without = MeshOptions {
        out: at("open.msh"),
        files: recipe::FileOptions::new(Format::Msh),
        ..walls.clone()
    };
    save(&plans, &without).expect("written");
    let triangles = |name: &str| read(&at(name)).faces.triangles.len();
    assert!(triangles("walls.msh") > triangles("open.msh"));

    let mut parts = options(&at("parts.obj"), Format::Obj);
    (parts.files.parts, parts.files.materials) = (true, true);
    // What the format does not hold is left out.
    parts.files.walls = false;
    save(&plans, &parts).expect("written");
    for name in ["parts_soma.obj", "parts.mtl"] {
        assert!(at(name).exists(), "{name}");
    }
    assert!(!at("parts.obj").exists());
}

#[test]
fn what_is_stopped_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("a.ply");
    let mut options = options(&out, Format::Ply);
    options.recipe = options.recipe.with_crossings(Crossings::Merge);
    let progress = Progress::new("", "", 0);
    progress.cancel();
    let job = Job {
        plan: &plan("a"),
        options: &options,
        seen_from: &seen_from(),
        progress: &progress,
        is_alone: true,
    };
    assert_eq!(job.save(&out, &mut None).expect_err("stopped"), "stopped");
    let stopped = meshes(&[plan("a")], &options, &seen_from(), &progress);
    assert!(stopped.expect_err("stopped").starts_with("stopped"));
    assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 0);
}

#[test]
fn many_meshes_go_to_a_folder_with_names_of_their_own() {
    let plans = [plan("a"), plan("a"), plan("b/c")];
    let files = mesh_files(&plans, &options(Path::new("out/all.ply"), Format::Ply));
    let names: Vec<String> = files
        .expect("named")
        .iter()
        .map(|f| f.display().to_string().replace('\\', "/"))
        .collect();
    assert_eq!(
        names,
        ["out/all/a.ply", "out/all/a_1.ply", "out/all/b_c.ply"]
    );
    assert!(mesh_files(&[], &options(Path::new(""), Format::Ply)).is_err());
}

#[test]
fn one_that_fails_keeps_no_other_from_being_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut bad = plan("bad");
    let mut poor = bad.generate.clone();
    poor.poisson = 0.7;
    bad.generate = poor;
    let out = folder.path().join("all");
    let written = save(&[plan("good"), bad], &options(&out, Format::Ply)).expect("one");
    assert!(
        written.status.contains("1 of 2 meshes"),
        "{}",
        written.status
    );
    let [(name, why)] = &written.remarks[..] else {
        panic!("{:?}", written.remarks);
    };
    assert!(name == "bad" && why.contains("'poisson'"), "{why}");
    assert!(out.join("good.ply").exists() && !out.join("bad.ply").exists());
}

#[test]
fn a_tracing_of_several_neurons_is_meshed_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let (first, other) = (plan("a"), plan("b"));
    let mut elsewhere = first.clone();
    elsewhere.name = "c".into();
    elsewhere.placement.translation *= 2.0;
    let plans = [first, other, elsewhere];
    assert_eq!(by_tracing(&plans), [0, 2, 1]);
    let mut merged = options(&folder.path().join("all"), Format::Ply);
    merged.recipe = merged.recipe.with_crossings(Crossings::Merge);
    save(&plans, &merged).expect("written");
    let at = |name: &str| read(&folder.path().join("all").join(name));
    let (a, c) = (at("a.ply"), at("c.ply"));
    assert_eq!(a.faces, c.faces);
    assert!((c.origin.x - a.origin.x - 1000.0).abs() < 1e-6);
}
