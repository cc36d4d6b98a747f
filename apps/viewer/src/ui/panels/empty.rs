//! Shown before anything is open: how to begin.

use eframe::egui::{self, Align, Layout, RichText};
use neurotess::synth::Kind;

use crate::model::command::{Command, FilePurpose};
use crate::model::state::State;

pub(super) fn show(state: &mut State, reading: bool, ui: &mut egui::Ui) {
    let height = ui.available_height();
    ui.with_layout(Layout::top_down(Align::Center), |ui| {
        ui.add_space((height * 0.2).max(12.0));
        ui.label(RichText::new("neurotess").size(34.0).strong());
        ui.label(RichText::new("Surface meshes of neurons from their tracings").size(15.0).weak());
        ui.add_space(22.0);
        if reading {
            ui.spinner();
            ui.label("Reading…");
            return;
        }
        let open = egui::Button::new(RichText::new("Open…").size(17.0)).min_size([190.0, 38.0].into());
        if ui.add(open).clicked() {
            state.requests.push(Command::AskFiles(FilePurpose::Open));
        }
        ui.add_space(4.0);
        ui.weak("or drop files and folders here: SWC, ASC, H5, NeuroML, SONATA circuits, scenes, sessions");
        ui.add_space(22.0);
        ui.label("Nothing at hand? Look at a sample:");
        ui.add_space(2.0);
        let names = ["pyramidal", "Purkinje", "granule", "basket", "motor", "star"];
        let width = 6.0 * 92.0;
        ui.allocate_ui_with_layout([width, 30.0].into(), Layout::left_to_right(Align::Center), |ui| {
            for (kind, name) in Kind::ALL.into_iter().zip(names) {
                if ui.add(egui::Button::new(name).min_size([84.0, 26.0].into())).clicked() {
                    state.requests.push(Command::OpenSample(kind));
                }
            }
        });
        recent(state, ui);
        ui.add_space(20.0);
        ui.weak("?  keys and mouse        Ctrl P  find a command");
    });
}

fn recent(state: &mut State, ui: &mut egui::Ui) {
    if state.settings.recent.is_empty() {
        return;
    }
    ui.add_space(18.0);
    ui.label("Recent");
    for path in state
        .settings
        .recent
        .iter()
        .take(5)
        .cloned()
        .collect::<Vec<_>>()
    {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if ui
            .link(name)
            .on_hover_text(path.display().to_string())
            .clicked()
        {
            state.requests.push(Command::Open(vec![path]));
        }
    }
}
