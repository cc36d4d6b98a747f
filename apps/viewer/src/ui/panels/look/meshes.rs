//! Meshes beside the cells: which, and how they look.

use eframe::egui::{Label, RichText, Role, Ui, WidgetInfo};

use crate::model::command::{Command, Edit, FilePurpose};
use crate::model::document::MeshEntry;
use crate::model::state::State;
use crate::ui::panels::widgets::number::{field, slider};
use crate::ui::panels::widgets::tip::Tip;
use crate::ui::panels::{grouped, heading};

/// The section of *Look*. `released`: whether a mouse button was released.
pub(crate) fn show(state: &mut State, released: bool, ui: &mut Ui) {
    heading(ui, "Meshes");
    ui.horizontal_wrapped(|ui| {
        let tip = "Brain regions, segments of electron microscopy, pipettes: PLY, OBJ, STL, GLB and others, in the \
                   coordinates of the scene (µm)";
        if ui.button("Add a mesh…").tip(tip).clicked() {
            state.requests.push(Command::AskFiles(FilePurpose::Meshes));
        }
        let many = state.document.meshes.len() > 1;
        if many && ui.button("Remove all").tip("Show no meshes").clicked() {
            state.requests.push(Edit::ClearMeshes.into());
        }
    });
    if !state.document.meshes.is_empty() && !state.places_meshes() {
        ui.weak("Not shown while cells are side by side (G)");
    }
    let entries = state.document.meshes.to_vec();
    let mut changed = false;
    for (index, entry) in entries.into_iter().enumerate() {
        let mut now = entry.clone();
        ui.push_id(index, |ui| row(state, index, &mut now, ui));
        if now != entry {
            changed = true;
            state.requests.push(Edit::SetMesh(index, now).into());
        }
    }
    if released && !changed {
        state.history.end_joining();
    }
}

fn row(state: &mut State, index: usize, entry: &mut MeshEntry, ui: &mut Ui) {
    let name = entry.name();
    let file = entry.file.display().to_string();
    ui.horizontal(|ui| {
        let color = ui.color_edit_button_srgb(&mut entry.color);
        let remove = ui.small_button("×");
        let enabled = ui.is_enabled();
        remove.widget_info(|| WidgetInfo::labeled(Role::Button, enabled, format!("Remove {name}")));
        if remove.on_hover_text("Remove this mesh").clicked() {
            state.requests.push(Edit::RemoveMesh(index).into());
        }
        let mut shown = !entry.hidden;
        if ui
            .checkbox(&mut shown, "")
            .on_hover_text("Show this mesh")
            .changed()
        {
            entry.hidden = !shown;
        }
        let label = ui.add(Label::new(&name).truncate());
        color.labelled_by(label.id);
        label.on_hover_text(match state.mesh_data.faces(&entry.file) {
            Some(faces) => format!("{file}\n{} faces", grouped(faces as u64)),
            None => file,
        });
    });
    if let Some(why) = state.mesh_data.failure(&entry.file) {
        let color = ui.visuals().warn_fg_color;
        ui.label(RichText::new(why).color(color).small());
        return;
    }
    if entry.hidden {
        return;
    }
    ui.indent("look", |ui| {
        slider(ui, &mut entry.opacity, 0.02..=1.0, Some(2), |slider| {
            slider.text("opacity")
        })
        .tip("Of each layer: two layers of 0.5 hide three quarters of what is behind them");
        ui.horizontal(|ui| {
            ui.checkbox(&mut entry.edges, "edges only")
                .tip("Draw the edges of its faces only");
            field(ui, &mut entry.scale, 1e-6..=1e6, 6, |field| {
                field.prefix("unit: ").suffix(" µm").speed(0.01)
            })
            .tip("Micrometers of a unit of the file; 0.001 for nanometers");
        });
    });
}
