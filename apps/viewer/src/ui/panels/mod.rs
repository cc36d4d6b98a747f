//! Panels: plain functions of the state that request commands.

mod bars;
mod cells;
mod detail;
mod dialogs;
mod empty;
mod held;
mod inspect;
mod look;
mod picture;
mod save;
mod soma;
mod widgets;

use std::time::Duration;

use eframe::egui::{
    self, Align2, CentralPanel, Color32, CornerRadius, CursorIcon, FontId, Frame, Margin, Panel,
    RichText, ScrollArea, Sense, UiBuilder, Visuals, vec2,
};
use neurotess::render::DeviceError;

use crate::io::task::Progress;
use crate::model::command::{Command, Tab};
pub(crate) use crate::model::numbers::{grouped, measured};
use crate::model::state::State;
use crate::scene::stage::Stage;
use crate::ui::file_panel::FilePanel;
use crate::ui::motion::Motion;

/// What panels show and change.
pub(crate) struct Screen<'a> {
    pub(crate) state: &'a mut State,
    pub(crate) stage: &'a mut Stage,
    /// That of the right one of two views.
    pub(crate) second: Option<&'a mut Stage>,
    pub(crate) motion: &'a mut Motion,
    /// The file dialog, while it is open.
    pub(crate) files: &'a mut Option<FilePanel>,
    /// Progress of reading, of saving, of reading synapses or points, and of reading traces, while they run.
    pub(crate) tasks: [Option<Progress>; 5],
    /// Whether another pass of this frame follows, which draws the picture.
    pub(crate) passed_over: bool,
    /// The error, if the picture could not be drawn.
    pub(crate) failed: Option<DeviceError>,
}

/// Seconds after the last movement of the mouse for which a presentation says how it ends.
const HINT: f32 = 3.0;
/// Usual height of the plot of traces.
const TRACES: f32 = 230.0;

/// Shows all panels.
pub(crate) fn show(screen: &mut Screen<'_>, ui: &mut egui::Ui) {
    let ctx = ui.ctx().clone();
    let before = screen.state.pointing.hovered.take();
    let marker_before = screen.state.pointing.hovered_marker.take();
    screen.state.pointing.touched = None;
    screen.state.traces.pointed = None;
    screen.state.pointing.dimension = None;
    if screen.state.layout.presenting && !screen.state.document.neurons.is_empty() {
        CentralPanel::no_frame().show(ui, |ui| {
            picture::panes::show(screen, (before, marker_before), ui);
            presentation(ui);
        });
        dialogs::show(screen.state, screen.files, &ctx);
        return;
    }
    Panel::top("menu").show(ui, |ui| bars::menu::show(screen.state, ui));
    let progress = screen.stage.progress();
    Panel::bottom("status").show(ui, |ui| {
        bars::status::show(screen.state, &screen.tasks, progress, ui);
    });
    let any = !screen.state.document.neurons.is_empty();
    if let Some(facts) = screen.state.playback.facts.clone().filter(|_| any) {
        Panel::bottom("time").show(ui, |ui| bars::timeline::show(screen.state, &facts, ui));
    }
    if screen.state.traces.open && any {
        // A part of the picture always stays.
        let most = (0.7 * ui.available_height()).max(80.0);
        let sized = Panel::bottom("traces")
            .resizable(true)
            .default_size(TRACES.min(most));
        sized.size_range(80.0_f32.min(most)..=most).show(ui, |ui| {
            let reading = screen.tasks[3].clone();
            kept_in(ui, |ui| {
                bars::traces::show(screen.state, reading.as_ref(), ui);
            });
        });
    }
    if screen.state.layout.panels && any {
        // Also in a narrow window, a third is left for the picture.
        let all = ui.available_width();
        let sized = |panel: Panel, [least, usual]: [f32; 2], share: f32| {
            let most = share * all;
            panel
                .default_size(usual.min(most))
                .size_range(least.min(most)..=most)
        };
        sized(Panel::left("cells"), [160.0, 236.0], 0.28).show(ui, |ui| {
            kept_in(ui, |ui| cells::show(screen.state, ui));
        });
        sized(Panel::right("side"), [240.0, 292.0], 0.42).show(ui, |ui| {
            kept_in(ui, |ui| side(screen, ui));
        });
    }
    CentralPanel::no_frame().show(ui, |ui| {
        if any {
            picture::panes::show(screen, (before, marker_before), ui);
        } else {
            let reads = screen.tasks[0].is_some();
            empty::show(screen.state, reads, ui);
        }
    });
    dialogs::show(screen.state, screen.files, &ctx);
    held::show(&ctx);
}

/// Says how a presentation ends while the mouse moves; hides the cursor while it rests.
fn presentation(ui: &egui::Ui) {
    let rests = ui.input(|i| i.pointer.time_since_last_movement()) > HINT;
    if rests {
        ui.set_cursor_icon(CursorIcon::None);
        return;
    }
    let rect = ui.max_rect();
    let at = rect.center_bottom() - vec2(0.0, 24.0);
    let font = FontId::proportional(14.0);
    let text = "Esc ends the presentation, R stops the turntable".to_owned();
    let line = ui.painter().layout_no_wrap(text, font, Color32::WHITE);
    let place = Align2::CENTER_BOTTOM.anchor_size(at, line.size());
    let dark = Color32::from_black_alpha(170);
    ui.painter().rect_filled(place.expand(8.0), 6.0, dark);
    ui.painter().galley(place.min, line, Color32::WHITE);
    // Once more when the hint is to go.
    ui.ctx()
        .request_repaint_after(Duration::from_secs_f32(HINT));
}

/// Clips what is wider than its panel, since it would push the panel over the picture.
fn kept_in(ui: &mut egui::Ui, show: impl FnOnce(&mut egui::Ui)) {
    let rect = ui.available_rect_before_wrap();
    let mut inner = ui.new_child(UiBuilder::new().max_rect(rect));
    inner.shrink_clip_rect(rect.expand(2.0));
    show(&mut inner);
    ui.allocate_rect(rect, Sense::hover());
}

fn side(screen: &mut Screen<'_>, ui: &mut egui::Ui) {
    ui.add_space(4.0);
    // Sliders fill the panel, up to their usual length.
    let room = (ui.available_width() - 150.0).clamp(40.0, 118.0);
    ui.spacing_mut().slider_width = room;
    ui.horizontal_wrapped(|ui| {
        for (tab, name) in Tab::ALL {
            let selected = screen.state.layout.tab == tab;
            if ui.selectable_label(selected, name).clicked() {
                screen.state.requests.push(Command::Show(tab));
            }
        }
    });
    ui.separator();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.add_space(2.0);
        let state = &mut *screen.state;
        match state.layout.tab {
            Tab::Inspect => inspect::show(state, ui),
            Tab::Soma => soma::show(state, ui),
            Tab::Look => look::show(state, screen.stage, ui),
            Tab::Detail => detail::show(state, ui),
            Tab::Save => save::show(state, ui),
        }
        ui.add_space(8.0);
    });
}

/// Colors and spacing.
pub(crate) fn style(ctx: &egui::Context, dark: bool) {
    ctx.set_theme(if dark {
        egui::Theme::Dark
    } else {
        egui::Theme::Light
    });
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = vec2(8.0, 5.0);
        style.spacing.button_padding = vec2(7.0, 3.0);
        style.spacing.slider_width = 118.0;
        style.interaction.tooltip_delay = 0.4;
    });
    let mut visuals = if dark {
        Visuals::dark()
    } else {
        Visuals::light()
    };
    let accent = Color32::from_rgb(0x2f, 0x7d, 0xc4);
    visuals.selection.bg_fill = if dark {
        accent.gamma_multiply(0.75)
    } else {
        accent.gamma_multiply(0.35)
    };
    visuals.hyperlink_color = accent;
    if dark {
        visuals.panel_fill = Color32::from_gray(30);
        visuals.window_fill = Color32::from_gray(36);
        visuals.extreme_bg_color = Color32::from_gray(18);
        visuals.override_text_color = Some(Color32::from_gray(214));
    } else {
        visuals.override_text_color = Some(Color32::from_gray(28));
    }
    for widget in [
        &mut visuals.widgets.noninteractive,
        &mut visuals.widgets.inactive,
        &mut visuals.widgets.hovered,
        &mut visuals.widgets.active,
        &mut visuals.widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(4);
    }
    ctx.set_visuals_of(
        if dark {
            egui::Theme::Dark
        } else {
            egui::Theme::Light
        },
        visuals,
    );
}

/// A heading with room above it.
fn heading(ui: &mut egui::Ui, text: &str) {
    ui.add_space(6.0);
    ui.label(RichText::new(text).strong().size(13.5));
}

/// Rows of a name and a value.
fn figures(ui: &mut egui::Ui, id: &str, rows: &[(impl AsRef<str>, String)]) {
    egui::Grid::new(id)
        .num_columns(2)
        .spacing([14.0, 3.0])
        .show(ui, |ui| {
            for (name, value) in rows {
                ui.weak(name.as_ref());
                ui.label(value);
                ui.end_row();
            }
        });
}

/// The frame of a box over the picture.
fn plate(ui: &egui::Ui) -> Frame {
    Frame::new()
        .fill(ui.visuals().window_fill.gamma_multiply(0.92))
        .corner_radius(6)
        .inner_margin(Margin::same(8))
}

/// Keys with the signs of the keyboard: `?`, not "Questionmark".
fn keys_text(ui: &egui::Ui, keys: &egui::KeyboardShortcut) -> String {
    let key = keys.logical_key;
    let text = ui.ctx().format_shortcut(keys);
    text.replace(key.name(), key.symbol_or_name())
}

/// The window of a dialog.
fn window<'a>(title: &'a str, ctx: &egui::Context) -> egui::Window<'a> {
    egui::Window::new(title)
        .collapsible(false)
        .resizable(false)
        .pivot(Align2::CENTER_CENTER)
        .default_pos(ctx.content_rect().center())
}
