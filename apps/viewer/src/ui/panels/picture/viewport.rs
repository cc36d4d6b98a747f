//! The picture, what the mouse does in it, and what is drawn over it.

use eframe::egui::{
    self, Align2, Area, Color32, Id, Key, PointerButton, Pos2, Rect, Response, Role, Sense, Ui,
    WidgetInfo,
};
use glam::DVec3;

use super::{area, cell_tip, chips, gizmo, measuring, overlay, traced_somata};
use crate::model::command::{Command, Edit, Tab};
use crate::model::document::TracePlace;
use crate::model::markers::MarkerRef;
use crate::model::state::{Picked, State};
use crate::ui::input::Open;
use crate::ui::panels::bars::traces;
use crate::ui::panels::inspect::crossings;
use crate::ui::panels::look::partners;
use crate::ui::panels::widgets::marks;
use crate::ui::panels::widgets::tip;
use crate::ui::panels::{Screen, plate};

/// Angle (radians) for each point that the mouse is dragged.
const TURN: f64 = 0.008;
/// Share of the distance for each point that the wheel scrolls.
const WHEEL: f64 = 0.0022;
/// Speed of flying by keys: multiples of the distance to the target per second.
const SPEED: f64 = 0.7;

/// What the cursor was at in the frame before: a part of a neuron, or a marker.
pub(crate) type Before = (Option<Picked>, Option<MarkerRef>);

/// One picture of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pane {
    /// The only one.
    Only,
    /// The left one of two, and whether commands are for its view.
    Left { commanded: bool },
    /// The right one of two.
    Right { commanded: bool },
}

impl Pane {
    /// Whether commands are for its view.
    fn is_commanded(self) -> bool {
        match self {
            Self::Only => true,
            Self::Left { commanded } | Self::Right { commanded } => commanded,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Only | Self::Left { .. } => "Picture",
            Self::Right { .. } => "Picture on the right",
        }
    }
}

/// Shows a picture.
pub(crate) fn show(screen: &mut Screen<'_>, before: Before, pane: Pane, rect: Rect, ui: &mut Ui) {
    let response = ui.interact(rect, Id::unique(pane.name()), Sense::click_and_drag());
    if !matches!(pane, Pane::Right { .. }) {
        tip::set_picture(ui.ctx(), rect);
    }
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, pane.name()));
    let points = ui.ctx().pixels_per_point();
    let size = [rect.width(), rect.height()].map(|n| (n * points).round().max(0.0) as u32);
    if size.contains(&0) {
        return;
    }
    screen.motion.reshape(
        screen.state,
        f64::from(size[0]) / f64::from(size[1]),
        pane.is_commanded(),
    );
    // Of two pictures, the mouse is in one.
    let held =
        response.dragged() || response.drag_stopped() || response.is_pointer_button_down_on();
    let mine = pane == Pane::Only || held || response.hovered() || response.clicked();
    if mine {
        steer(screen, &response, ui);
        point(screen, before, &response, points);
    }
    // Keys are for a dialog that is open, even while none of its lines has the keyboard.
    let asked = Open::from(&screen.state.layout.dialog).is_modal();
    if pane.is_commanded() && !asked && !ui.ctx().egui_wants_keyboard_input() {
        fly(screen, upwards(screen.state), ui);
    }
    let ctx = ui.ctx().clone();
    let texture = screen.picture(size, &ctx);
    let [r, g, b] = screen.state.document.look.background;
    ui.painter()
        .rect_filled(rect, 0.0, Color32::from_rgb(r, g, b));
    if let Some(texture) = texture {
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        ui.painter().image(texture, rect, whole, Color32::WHITE);
    }
    over(screen, pane, rect, ui);
    if !matches!(pane, Pane::Right { .. }) {
        chips::show(screen.state, rect, ui);
    }
    area::show(
        screen.state,
        &response,
        &ui.painter().with_clip_rect(rect),
        ui,
    );
    response.context_menu(|ui| menu(screen.state, ui));
}

/// Moves the camera by mouse.
fn steer(screen: &mut Screen<'_>, response: &Response, ui: &Ui) {
    let view = screen.state.view;
    let height = f64::from(response.rect.height());
    let upwards = upwards(screen.state);
    let taken = area::drag(screen.state, response, ui) || gizmo::drag(screen.state, response, ui);
    let drag = response.drag_delta();
    let (dx, dy) = (f64::from(drag.x), f64::from(drag.y));
    let shift = ui.input(|i| i.modifiers.shift);
    let left = response.dragged_by(PointerButton::Primary);
    let moves = response.dragged_by(PointerButton::Middle)
        || response.dragged_by(PointerButton::Secondary)
        || (left && shift);
    if drag != egui::Vec2::ZERO && !taken {
        if moves {
            screen
                .motion
                .steer(screen.state, view.panned(dx, dy, height));
        } else if left {
            screen
                .motion
                .steer(screen.state, view.orbited(dx * TURN, dy * TURN, upwards));
        }
    }
    if response.hovered() {
        zoom(screen, response, ui);
    }
}

fn upwards(state: &State) -> DVec3 {
    match state.document.y_down {
        true => DVec3::NEG_Y,
        false => DVec3::Y,
    }
}

fn zoom(screen: &mut Screen<'_>, response: &Response, ui: &Ui) {
    let (scroll, pinch) = ui.input(|i| {
        (
            f64::from(i.smooth_scroll_delta().y),
            f64::from(i.zoom_delta()),
        )
    });
    let factor = (-scroll * WHEEL).exp() / pinch;
    if factor == 1.0 {
        return;
    }
    let view = screen.state.view;
    let points = f64::from(ui.ctx().pixels_per_point());
    let place = response.hover_pos().map(|at| {
        let offset = at - response.rect.min;
        let pixel = [f64::from(offset.x), f64::from(offset.y)];
        let size = [
            f64::from(response.rect.width()),
            f64::from(response.rect.height()),
        ];
        // Towards what is under the cursor; if there is nothing, towards that point at the target's
        // depth.
        let seen = screen
            .stage
            .hit_at((pixel[0] * points) as f32, (pixel[1] * points) as f32);
        match seen {
            Some(seen) => view.at_depth(pixel, size, view.depth_in_front(seen.place)),
            None => view.under(pixel, size),
        }
    });
    if let Some(place) = place {
        screen
            .motion
            .steer(screen.state, view.zoomed(factor, place));
    }
}

fn fly(screen: &mut Screen<'_>, upwards: DVec3, ui: &Ui) {
    let (keys, fast, dt) = ui.input(|i| {
        let down = |key| {
            if i.key_down(key) && !i.modifiers.command {
                1.0
            } else {
                0.0
            }
        };
        let keys = [
            down(Key::D) - down(Key::A),
            down(Key::E) - down(Key::Q),
            down(Key::W) - down(Key::S),
            down(Key::ArrowRight) - down(Key::ArrowLeft),
            down(Key::ArrowUp) - down(Key::ArrowDown),
            down(Key::Plus) + down(Key::Equals) - down(Key::Minus),
        ];
        (keys, i.modifiers.shift, f64::from(i.stable_dt.min(0.1)))
    });
    if keys == [0.0; 6] {
        return;
    }
    let camera = screen.state.view.camera();
    let distance = camera.eye().distance(camera.target());
    let step = distance * SPEED * dt * if fast { 4.0 } else { 1.0 };
    let turn = 1.2 * dt;
    let view = screen
        .state
        .view
        .flown(keys[0] * step, keys[1] * step, keys[2] * step)
        .orbited(-keys[3] * turn, -keys[4] * turn, upwards)
        .zoomed((-keys[5] * 1.5 * dt).exp(), camera.target());
    screen.motion.steer(screen.state, view);
    ui.ctx().request_repaint();
}

/// Finds the part under the cursor, and handles clicks.
fn point(screen: &mut Screen<'_>, before: Before, response: &Response, points: f32) {
    let at = response
        .hover_pos()
        .map(|at| (at - response.rect.min) * points);
    let seen = at.and_then(|at| screen.stage.hit_at(at.x, at.y));
    // Lists and sliders set the part themselves; elsewhere the cursor is over the picture.
    if at.is_some() {
        let now = || {
            let picked = seen.and_then(|s| s.picked());
            (picked, seen.and_then(|s| s.marker()))
        };
        let state = &mut *screen.state;
        (state.pointing.hovered, state.pointing.hovered_marker) = match screen.stage.can_pick() {
            true => now(),
            false => before,
        };
    }
    if let (Some(at), None) = (at, seen)
        && let Some(mesh) = screen.stage.mesh_at(at.x, at.y)
    {
        response.clone().on_hover_text_at_pointer(mesh);
    }
    let place = match (&screen.state.playback.facts, screen.stage.can_pick()) {
        (Some(_), true) => measuring::trace_place(screen.state, seen, response),
        _ => None,
    };
    screen.state.traces.pointed = place;
    if screen.state.tools.measuring.is_some() {
        measuring::point(screen.state, seen, response);
        if response.clicked() {
            measuring::click(screen.state, response.rect);
        }
    } else if response.double_clicked() {
        if let Some(seen) = seen {
            let view = screen.state.view;
            let camera = view.camera();
            // The height of what is seen there becomes 0.35 of it.
            let size = 0.35 / 2.0 * camera.pixel_size(1.0).at(camera.depth(seen.place));
            screen
                .state
                .requests
                .push(Command::Go(view.focused((seen.place, size))));
        }
    } else if response.clicked() {
        match seen.and_then(|s| s.marker()) {
            Some(marker) => click_marker(screen.state, marker),
            None => {
                let picked = seen.and_then(|s| s.picked());
                let place = place.filter(|_| screen.state.traces.open);
                let place = place.filter(|place| has_values(screen, place.neuron));
                click(screen.state, picked, place, response);
            }
        }
    }
}

/// Tells what a synapse or point is. The selection stays, since it decides which synapses show.
fn click_marker(state: &mut State, marker: MarkerRef) {
    (state.pointing.picked, state.pointing.picked_marker) = (None, Some(marker));
    if let Some(facts) = state.marker_facts(marker) {
        let rows = facts
            .rows
            .iter()
            .map(|(name, value)| format!("{name} {value}"));
        let rows: Vec<String> = rows.collect();
        state.messages.status = format!("{}: {}", facts.title, rows.join(", "));
    }
    if state.layout.tab != Tab::Inspect {
        state.requests.push(Command::Show(Tab::Inspect));
    }
}

/// Whether the recording has values of a neuron; else the window says that it has none.
fn has_values(screen: &mut Screen<'_>, neuron: usize) -> bool {
    let recording = screen.stage.recording_of(&screen.state.document);
    let has = recording.is_some_and(|recording| recording.has_values_of(neuron));
    if let (false, Some(of)) = (has, screen.state.document.neurons.get(neuron)) {
        screen.state.messages.status = format!("The report has no values of {}", of.name);
    }
    has
}

/// Selects what was clicked. `place`: its values are plotted.
fn click(
    state: &mut State,
    picked: Option<Picked>,
    place: Option<TracePlace>,
    response: &Response,
) {
    let adds = response
        .ctx
        .input(|i| i.modifiers.shift || i.modifiers.command);
    state.pointing.picked_marker = None;
    match picked {
        Some(picked) => {
            state.pointing.picked = Some(picked);
            state.pointing.reveal = Some(picked);
            if let Some(place) = place {
                let place = state.middle_of_compartment(place);
                state.requests.push(Edit::Plot(place, adds).into());
                return;
            }
            let selected = state.document.neurons.selected();
            let (already, only) = (selected.contains(picked.neuron), selected.len() == 1);
            // A click on another part of the selected neuron does not change the selection.
            if adds || !already || !only {
                state
                    .requests
                    .push(Edit::Select(vec![picked.neuron], adds).into());
            }
        }
        None if !adds => {
            state.pointing.picked = None;
            state.requests.push(Edit::SelectNone.into());
        }
        None => {}
    }
}

fn menu(state: &mut State, ui: &mut Ui) {
    let measures = state.tools.measuring.is_some();
    let measure = if measures {
        "Stop measuring"
    } else {
        "Measure"
    };
    let places = state.tools.placing.is_some();
    let place = if places {
        "Stop moving and turning"
    } else {
        "Move and turn selected"
    };
    let clamps = state.document.neurons.clamps_selected();
    let clamp = if clamps {
        "Unclamp selected"
    } else {
        "Clamp selected"
    };
    for (title, command) in [
        (measure, Command::SetMeasuring(!measures)),
        ("Zoom to the selection", Command::Focus),
        ("Hide selected", Edit::Hide.into()),
        ("Isolate selected", Edit::Isolate.into()),
        (clamp, Edit::Clamp(!clamps).into()),
        (place, Command::SetPlacing(!places)),
        ("Duplicate selected", Command::Duplicate),
        ("Show all", Edit::ShowAll.into()),
        ("Everything, from the front", Command::Home),
        ("Keep this view for a film", Command::AddKeyView),
        ("Save this view under a name", Command::SaveView),
    ] {
        if ui.button(title).clicked() {
            state.requests.push(command);
            ui.close();
        }
    }
}

/// Draws legend, scale bar and axes.
fn over(screen: &Screen<'_>, pane: Pane, rect: Rect, ui: &mut Ui) {
    let look = &screen.state.document.look;
    if look.legend && !matches!(pane, Pane::Right { .. }) {
        let told = screen.stage.legend().clone();
        overlay::legend(
            told.with_widths(
                look.least_width_of(screen.state.shown()),
                look.radius_factor(),
            ),
            screen,
            rect,
            ui,
        );
    }
    if look.scale_bar {
        overlay::scale_bar(screen.state, rect, ui);
    }
    if look.axes {
        overlay::axes(screen.state, rect, ui);
    }
    let painter = ui.painter().with_clip_rect(rect);
    traced_somata::show(screen.state, rect, &painter);
    marks::rings(screen.state, rect, &painter);
    partners::show(screen.state, rect, &painter);
    crossings::marks(screen.state, rect, &painter);
    traces::marks(screen.state, rect, &painter);
    gizmo::show(screen.state, rect, &painter);
    measuring::show(screen.state, rect, ui);
    if screen.state.tools.measuring.is_none() {
        cell_tip::show(screen.state, rect, ui);
    }
    if !screen.stage.can_pick() {
        marks::hovered(screen.state, rect, &painter);
    }
    if !screen.stage.is_settled() && screen.stage.content().sources.is_empty() {
        // Of two pictures, each has its own.
        Area::new(Id::unique("meshing").with(rect.left() as i32))
            .fixed_pos(rect.center())
            .pivot(Align2::CENTER_CENTER)
            .show(ui.ctx(), |ui| {
                plate(ui).show(ui, |ui| {
                    ui.horizontal(|ui| {
                        ui.spinner();
                        ui.label("Preparing the picture…");
                    });
                });
            });
    }
}

impl Screen<'_> {
    /// Draws the picture in this size; keeps the error in `failed` if it cannot.
    fn picture(&mut self, size: [u32; 2], ctx: &egui::Context) -> Option<egui::TextureId> {
        if self.passed_over {
            return self
                .stage
                .pass_over(self.state, size, ctx.pixels_per_point());
        }
        match self.stage.update(self.state, size, ctx) {
            Ok(texture) => texture,
            Err(e) => {
                self.failed = Some(e);
                None
            }
        }
    }
}
