//! Projection and saved views, in *Look*.

use eframe::egui::{Id, TextEdit, Ui};

use crate::model::command::{Command, Edit};
use crate::model::state::State;
use crate::ui::panels::heading;
use crate::ui::panels::widgets::tip::Tip;

pub(crate) fn show(state: &mut State, ui: &mut Ui) {
    heading(ui, "View");
    let mut orthographic = state.view.orthographic;
    let parallel = ui
        .checkbox(&mut orthographic, "Orthographic")
        .tip("No perspective: lengths are true at all depths, and so is the scale bar (O)");
    if parallel.changed() {
        state.requests.push(Command::SetOrthographic(orthographic));
    }
    for (index, saved) in state.document.saved_views.clone().into_iter().enumerate() {
        ui.horizontal(|ui| {
            let mut name = saved.name;
            let line = TextEdit::singleline(&mut name)
                .id(Id::unique(("saved view", index)))
                .desired_width(140.0);
            let line = ui.add(line).tip("Its name");
            if line.changed() {
                state.requests.push(Edit::RenameView(index, name).into());
            }
            if line.lost_focus() {
                state.history.end_joining();
            }
            let keys = match index {
                0..5 => format!("Go there ({})", index + 5),
                _ => "Go there".to_owned(),
            };
            if ui.button("Go").tip(keys).clicked() {
                state.requests.push(Command::GoSaved(index));
            }
            if ui.small_button("×").tip("Forget this view").clicked() {
                state.requests.push(Edit::RemoveView(index).into());
            }
        });
    }
    let tip = "Under a name, to come back to it; sessions keep it (V)";
    if ui.button("Save this view").tip(tip).clicked() {
        state.requests.push(Command::SaveView);
    }
}
