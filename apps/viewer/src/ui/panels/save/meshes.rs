//! Saves meshes: what for, how fine, into which files.

use std::path::{Path, PathBuf};

use eframe::egui::{Button, Checkbox, ComboBox, Id, Ui};
use neurotess::mesh::{Format, Unit};
use neurotess::recipe::{Crossings, Levels, Purpose};
use neurotess::refine::{Caps, EdgeRule, LodCriterion, Path as Course};

use super::save;
use crate::model::command::Command;
use crate::model::save::MeshOptions;
use crate::model::state::State;
use crate::model::targets::mesh_file;
use crate::ui::panels::cells::count;
use crate::ui::panels::heading;
use crate::ui::panels::widgets::number::{field, kept};
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::path_line;

pub(super) fn show(state: &mut State, ui: &mut Ui) {
    heading(ui, "Meshes");
    let [shown, selected] = [true, false].map(|all| state.mesh_count(all));
    let (form, folder) = (&mut state.save, &state.settings.folder);
    let mesh = &mut form.mesh;
    ui.horizontal_wrapped(|ui| {
        ui.radio_value(&mut mesh.all, true, format!("visible ({shown})"));
        ui.radio_value(&mut mesh.all, false, format!("selected ({selected})"));
    });
    purpose(mesh, ui);
    crossings(mesh, ui);
    kept(ui, "mesh lod", |ui| levels(mesh, ui));
    if format(mesh, ui) {
        let path = mesh_file(Path::new(&form.mesh_out), mesh.files.format);
        form.mesh_out = path.display().to_string();
    }
    contents(mesh, ui);
    shape(mesh, ui);
    let extension = mesh.files.format.extension();
    path_line::listing_line(
        &mut form.mesh_out,
        Id::unique("mesh path"),
        extension,
        folder,
        ui,
    );
    let number = if mesh.all { shown } else { selected };
    if number > 1 {
        ui.weak("Writes a folder of this name with a file for each neuron.");
    }
    let title = format!("Save {}", count(number, "mesh").replace("meshs", "meshes"));
    let ready = number > 0 && !form.mesh_out.trim().is_empty();
    if ui.add_enabled(ready, Button::new(title)).clicked() {
        let mut options = form.mesh.fitting();
        options.out = PathBuf::from(form.mesh_out.trim());
        save(state, Command::SaveMeshes(options));
    }
}

/// One of several choices; tells whether it was chosen just now.
fn choice(ui: &mut Ui, is_possible: bool, is_chosen: bool, title: &str, tip: &str) -> bool {
    let button = Button::selectable(is_chosen, title);
    let response = ui.add_enabled(is_possible, button).tip(tip);
    response.clicked() && !is_chosen
}

/// What meshes are for.
fn purpose(mesh: &mut MeshOptions, ui: &mut Ui) {
    // Wrapped: what is too wide widens all that comes after it.
    ui.horizontal_wrapped(|ui| {
        ui.label("for");
        for (purpose, title, tip) in [
            (
                Purpose::Surface,
                "pictures, printing",
                "The surface as it is shown",
            ),
            (
                Purpose::Simulation,
                "simulation",
                "A mesh that solvers take: closed, without crossings, short circuits and narrow triangles, or an error \
                 that says where it fails. Takes seconds for each neuron",
            ),
        ] {
            if choice(ui, true, mesh.recipe.purpose == purpose, title, tip) {
                mesh.set_purpose(purpose);
            }
        }
    });
}

/// What becomes of places where a surface crosses itself.
fn crossings(mesh: &mut MeshOptions, ui: &mut Ui) {
    let is_simulation = mesh.recipe.is_simulation();
    ui.horizontal_wrapped(|ui| {
        ui.label("crossings")
            .tip("Places where the surface of a neuron crosses itself");
        for (crossings, title, tip) in [
            (Crossings::Keep, "kept", "They stay: fast, whatever the size"),
            (
                Crossings::Separate,
                "moved apart",
                "Branches that were traced through one another are moved apart; what still crosses, at forks and bends, \
                 is merged",
            ),
            (
                Crossings::Merge,
                "merged",
                "The exact union: no two triangles cross, and branches traced through one another grow together",
            ),
        ] {
            let is_possible = crossings != Crossings::Keep || !is_simulation;
            let is_chosen = mesh.recipe.crossings == crossings;
            if choice(ui, is_possible, is_chosen, title, tip) {
                mesh.recipe.crossings = crossings;
            }
        }
    });
}

fn levels(mesh: &mut MeshOptions, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let is_simulation = mesh.recipe.is_simulation();
        let now = kind_of(mesh);
        for (kind, title, tip) in [
            (
                LevelKind::Subdivisions,
                "subdivisions",
                "Of every edge of the coarse mesh; 0: the coarse mesh itself",
            ),
            (
                LevelKind::Error,
                "max. error",
                "As many subdivisions as keep the mesh within this distance of the smooth surface",
            ),
            (
                LevelKind::Lengths,
                "edge length",
                "Edges about so many local radii long: triangles of even size",
            ),
            (
                LevelKind::AsShown,
                "as shown",
                "The subdivisions of the picture: finer where the camera is close",
            ),
        ] {
            // Of a mesh for solvers, edges have lengths.
            let is_possible = !is_simulation || kind == LevelKind::Lengths;
            if is_possible && choice(ui, true, kind == now, title, tip) {
                choose(mesh, kind);
            }
        }
        if mesh.as_shown {
            return;
        }
        let mut levels = mesh.recipe.levels;
        edit(&mut levels, ui);
        if levels != mesh.recipe.levels {
            mesh.recipe = mesh.recipe.clone().with_levels(levels);
        }
    });
}

/// Ways to say how fine a mesh is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LevelKind {
    Subdivisions,
    Error,
    Lengths,
    AsShown,
}

fn kind_of(mesh: &MeshOptions) -> LevelKind {
    match mesh.recipe.levels {
        _ if mesh.as_shown => LevelKind::AsShown,
        Levels::Criterion(LodCriterion::MaxError(_)) => LevelKind::Error,
        levels if levels.is_by_length() => LevelKind::Lengths,
        _ => LevelKind::Subdivisions,
    }
}

fn choose(mesh: &mut MeshOptions, kind: LevelKind) {
    mesh.as_shown = kind == LevelKind::AsShown;
    let recipe = mesh.recipe.clone();
    mesh.recipe = match kind {
        LevelKind::Subdivisions => recipe.with_level(4),
        LevelKind::Error => recipe.with_max_error(0.05),
        LevelKind::Lengths => recipe.with_levels(Levels::Edges(EdgeRule::Lengths {
            radii: 1.0,
            aspect: 1.0,
            least: 0.0,
            most: f32::INFINITY,
        })),
        LevelKind::AsShown => recipe,
    };
}

/// The numbers of levels.
fn edit(levels: &mut Levels, ui: &mut Ui) {
    match levels {
        Levels::Criterion(LodCriterion::MaxError(error)) => {
            field(ui, error, 0.001..=10.0, 4, |field| {
                field.speed(0.005).suffix(" µm")
            });
        }
        Levels::Edges(EdgeRule::Lengths { radii, aspect, .. }) => {
            field(ui, radii, 0.1..=10.0, 2, |field| {
                field.speed(0.02).suffix(" radii")
            })
            .tip("Length of edges, in radii of the neurite");
            field(ui, aspect, 1.0..=20.0, 1, |field| {
                field.speed(0.05).prefix("up to × ")
            })
            .tip("How many times as long edges along neurites may be");
        }
        levels => {
            let mut level = match levels {
                Levels::Criterion(LodCriterion::Homogeneous(level)) => *level,
                _ => 0,
            };
            field(ui, &mut level, 0..=64, 0, |field| field.suffix(" per edge"));
            *levels = match level {
                0 => Levels::Coarse,
                level => Levels::Criterion(LodCriterion::Homogeneous(level)),
            };
        }
    }
}

/// What a format is called in the list: files of both versions of MSH end alike.
fn title(format: Format) -> &'static str {
    match format {
        Format::Msh => "msh 4.1",
        Format::Msh2 => "msh 2.2",
        other => other.name(),
    }
}

/// The format and the unit. Tells whether another format was chosen.
fn format(mesh: &mut MeshOptions, ui: &mut Ui) -> bool {
    let mut is_new = false;
    ui.horizontal(|ui| {
        ui.label("format");
        ComboBox::from_id_salt("format")
            .width(70.0)
            .selected_text(title(mesh.files.format))
            .show_ui(ui, |ui| {
                for format in Format::ALL {
                    let label = ui.selectable_value(&mut mesh.files.format, format, title(format));
                    is_new |= label.clicked();
                }
            });
        ui.label("in");
        for (unit, title) in [(Unit::Micrometer, "µm"), (Unit::Meter, "m")] {
            ui.selectable_value(&mut mesh.files.unit, unit, title);
        }
    });
    is_new
}

/// What is in the files.
fn contents(mesh: &mut MeshOptions, ui: &mut Ui) {
    let (quads, walls) = (mesh.can_have_quads(), mesh.can_have_walls());
    let materials = mesh.can_have_materials();
    let check =
        |ui: &mut Ui, is_possible: bool, value: &mut bool, title: &str, tip: &str, why: &str| {
            // What cannot be had shows as left out, and comes back once it can.
            let mut shown = *value && is_possible;
            let response = ui.add_enabled(is_possible, Checkbox::new(&mut shown, title));
            if response.clicked() {
                *value = shown;
            }
            response.tip(tip).on_disabled_hover_text(why);
        };
    ui.horizontal_wrapped(|ui| {
        check(
            ui,
            quads,
            &mut mesh.recipe.refine.quads,
            "quads",
            "Quads where possible, instead of triangles",
            "For ply, obj, off and vtu, where crossings are kept",
        );
        check(
            ui,
            walls,
            &mut mesh.files.walls,
            "walls",
            "Walls part the soma from neurites, so that each is a closed body",
            "For triangles in msh, poly and smesh, or with a file for each type",
        );
        check(
            ui,
            materials,
            &mut mesh.files.materials,
            "colors of types",
            "Faces have a material in the color of their type, as for Blender",
            "For glb and obj",
        );
        check(
            ui,
            true,
            &mut mesh.files.parts,
            "a file for each type",
            "Soma, axon and dendrites in files of their own, named after the mesh",
            "",
        );
    });
}

/// Where and in which shape neurons are.
fn shape(mesh: &mut MeshOptions, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut mesh.placed, "placed as shown").tip(
            "Positions as in the window (side by side, or in the circuit); otherwise the coordinates of each file",
        );
        let refine = &mut mesh.recipe.refine;
        let mut is_straight = refine.path == Course::Linear;
        let straight = ui
            .checkbox(&mut is_straight, "straight segments")
            .tip("Straight between traced points; otherwise smooth curves through them");
        if straight.clicked() {
            refine.path = match is_straight {
                true => Course::Linear,
                false => Course::Hermite,
            };
        }
        let mut is_flat = refine.caps == Caps::Flat;
        let flat = ui
            .checkbox(&mut is_flat, "flat ends")
            .tip("Neurites end in flat disks; otherwise in half spheres");
        if flat.clicked() {
            refine.caps = match is_flat {
                true => Caps::Flat,
                false => Caps::Round,
            };
        }
    });
}
