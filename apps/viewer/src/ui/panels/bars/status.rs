//! The status bar: running tasks, problems, and where quality is reduced.

use eframe::egui::{self, Align, Layout, ProgressBar, RichText, Ui};

use crate::io::task::Progress;
use crate::model::command::{Command, Edit};
use crate::model::state::{Lowered, State};
use crate::ui::panels::cells::count;
use crate::ui::panels::grouped;

pub(crate) fn show(
    state: &mut State,
    tasks: &[Option<Progress>; 5],
    drawing: Option<f32>,
    ui: &mut Ui,
) {
    ui.horizontal(|ui| {
        for progress in tasks.iter().flatten() {
            let share = progress.share();
            ui.label(progress.text());
            ui.add(
                ProgressBar::new(share)
                    .desired_width(110.0)
                    .desired_height(12.0),
            );
            if ui.small_button("stop").clicked() {
                state.requests.push(Command::Cancel);
            }
        }
        problems(state, ui);
        let hidden = state.document.neurons.hidden().len();
        if hidden > 0 {
            let link = ui.link(format!("{hidden} hidden"));
            if link.on_hover_text("Show all").clicked() {
                state.requests.push(Edit::ShowAll.into());
            }
        }
        lowered(state, ui);
        ui.add(egui::Label::new(RichText::new(&state.messages.status).weak()).truncate());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            right(state, drawing, ui);
        });
    });
}

fn problems(state: &mut State, ui: &mut Ui) {
    let stale = state.sources.stale();
    if stale > 0 {
        let text = format!("{} changed or gone", count(stale, "file"));
        let response = ui.link(RichText::new(text).color(ui.visuals().warn_fg_color));
        if response.on_hover_text("Read changed files again").clicked() {
            state.requests.push(Command::Reload);
        }
    }
    let wrong = state.messages.problems.len();
    if wrong > 0 {
        let last = &state.messages.problems[wrong - 1];
        let says = format!("{}: {}", last.what, last.why);
        let text = RichText::new(count(wrong, "problem"));
        let response = ui
            .link(text.color(ui.visuals().error_fg_color))
            .on_hover_text(says);
        if response.clicked() {
            state.requests.push(Command::ToggleProblems);
        }
    }
}

const LOWERED: &str = "Full detail would block the window here. Hide or isolate neurons, or move closer, to get it back. \
    Saved pictures always have full detail.";

const COMPLETES: &str =
    "Full detail is drawn beside the window, and shows when it is there, unless something moves.";

const THINNED: &str = "More synapses or points are in view than pixels, or a frame, can show: they are left out \
    evenly. Move closer to see all.";

/// Says where quality is reduced, and why.
fn lowered(state: &State, ui: &mut Ui) {
    let warn = ui.visuals().warn_fg_color;
    if state.views.frozen.is_some() {
        ui.colored_label(warn, "detail frozen")
            .on_hover_text("The triangles are those of another view (Ctrl F)");
    }
    if state.view.orthographic {
        ui.weak("orthographic")
            .on_hover_text("No perspective: lengths are true at all depths (O)");
    }
    if state.document.detail.smallest > 0.0 {
        let text = format!("hidden below {:.1} px", state.document.detail.smallest);
        ui.colored_label(warn, text).on_hover_text("Set in Detail");
    }
    if let Some(lowered) = state.drawing.counters.lowered {
        let text = match lowered {
            Lowered::Triangles(Some([drawn, wanted])) if drawn < wanted => {
                format!(
                    "reduced: {} of {} triangles",
                    grouped(drawn),
                    grouped(wanted)
                )
            }
            Lowered::Triangles(_) => "reduced: fewer triangles".to_owned(),
            Lowered::Error(times) => format!("reduced: {times:.0} times as coarse"),
        };
        let (text, says) = match state.drawing.counters.completes {
            true => (format!("{text}, drawing all"), COMPLETES),
            false => (text, LOWERED),
        };
        ui.colored_label(warn, text).on_hover_text(says);
    }
    if let Some([drawn, in_view, _]) = state.drawing.counters.markers
        && drawn < in_view
    {
        let [drawn, in_view] = [drawn, in_view].map(|n| grouped(n as u64));
        ui.colored_label(warn, format!("{drawn} of {in_view} markers drawn"))
            .on_hover_text(THINNED);
    }
    if state.document.look.cut.is_some() {
        ui.colored_label(warn, "cutting plane")
            .on_hover_text("Part of the scene is cut away: set in Look");
    }
}

fn right(state: &State, drawing: Option<f32>, ui: &mut Ui) {
    let (adapter, software) = &state.drawing.adapter;
    if *software {
        ui.weak("software graphics").on_hover_text(format!(
            "Drawn by the processor ({adapter}). A graphics card is far faster."
        ));
    } else {
        let short: String = adapter.chars().take(28).collect();
        ui.weak(short).on_hover_text(adapter);
    }
    if let Some(share) = drawing {
        ui.weak(format!("drawing {:.0} %", 100.0 * share));
    }
    let selected = state.document.neurons.selected().len();
    if selected > 0 {
        ui.label(format!("{selected} selected"));
    }
    if let Some(hovered) = state.pointing.hovered
        && let Some(neuron) = state.document.neurons.get(hovered.neuron)
    {
        ui.label(describe(state, hovered, &neuron.name));
    }
}

fn describe(state: &State, hovered: crate::model::state::Picked, name: &str) -> String {
    use crate::model::state::CellPart;
    let Some(source) = state.source_of(hovered.neuron) else {
        return name.to_owned();
    };
    match hovered.part {
        CellPart::Soma => format!("{name}: soma"),
        CellPart::Neurite(neurite) => format!("{name}: neurite {}", neurite + 1),
        CellPart::Section(section) => {
            let facts = source
                .sections
                .get(section as usize)
                .copied()
                .unwrap_or_default();
            let kind = crate::ui::panels::cells::kind_name(&source.morphology, section as usize)
                .to_lowercase();
            format!(
                "{name}: {kind}, section {section}, {}",
                crate::ui::panels::measured(facts.length, "µm")
            )
        }
    }
}
