//! Sliders of first rings, where neurites leave their soma. The ring of the slider in use is shown
//! in the picture.

use eframe::egui::{Button, Color32, Label, RichText, Sense, Ui};

use crate::model::command::Edit;
use crate::model::document::SourceId;
use crate::model::sources::Source;
use crate::model::state::{CellPart, Picked, State};
use crate::ui::panels::cells;
use crate::ui::panels::widgets::number::slider;
use crate::ui::panels::widgets::tip::Tip;

/// A neurite that has a ring.
struct Row {
    neurite: u32,
    name: String,
    color: Color32,
    /// Current position of the ring, and the requested one.
    position: f64,
    requested: Option<f64>,
}

/// Sliders for one cell.
pub(crate) fn show(state: &mut State, id: SourceId, ui: &mut Ui) {
    let Some(source) = state.sources.get(id) else {
        return;
    };
    let rows = rows(state, id, source);
    if rows.is_empty() {
        return;
    }
    let any = rows.iter().any(|row| row.requested.is_some());
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        ui.label(RichText::new("First rings").strong().size(13.5));
        let reset = Button::new("reset all").small();
        if ui
            .add_enabled(any, reset)
            .tip("All first rings at their automatic positions")
            .clicked()
        {
            state.requests.push(Edit::ResetRings(id).into());
        }
    });
    ui.weak("0: on the traced soma, 1: at the first traced point");
    for row in &rows {
        self::row(state, id, row, ui);
    }
}

fn rows(state: &State, id: SourceId, source: &Source) -> Vec<Row> {
    let requested = state.document.soma(id).rings;
    let look = &state.document.look;
    let mut rows: Vec<Row> = Vec::new();
    for ring in &source.generated.rings {
        // A neurite that forks inside the soma has several rings, which are moved together.
        if rows.iter().any(|row| row.neurite == ring.neurite) {
            continue;
        }
        let root = source
            .sections
            .iter()
            .position(|s| s.neurite == ring.neurite);
        let Some(root) = root else { continue };
        let [r, g, b] = look.type_color(source.morphology.sections[root].kind.0);
        let kind = cells::kind_name(&source.morphology, root);
        rows.push(Row {
            neurite: ring.neurite,
            name: format!("{kind} {}", ring.neurite + 1),
            color: Color32::from_rgb(r, g, b),
            position: ring.position,
            requested: requested.get(&ring.neurite).copied(),
        });
    }
    rows.sort_by_key(|row| row.neurite);
    rows
}

fn row(state: &mut State, id: SourceId, row: &Row, ui: &mut Ui) {
    let mut value = row.requested.unwrap_or(row.position);
    let before = value;
    let mut touched = false;
    ui.horizontal(|ui| {
        let (swatch, _) = ui.allocate_exact_size([10.0, 10.0].into(), Sense::hover());
        ui.painter().rect_filled(swatch, 2.0, row.color);
        let name = ui.add(Label::new(&row.name).sense(Sense::hover()));
        touched |= name.hovered();
        name.tip(
            "Where the neurite's mesh begins: 0 on the soma's sphere, 1 at the first traced point outside \
             it, 2 as far beyond along the path (at least half the soma's radius)",
        );
        match row.requested {
            None => {
                ui.weak("automatic");
            }
            Some(requested) if row.position < requested - 5e-3 => {
                let text = format!("limited to {:.2}", row.position);
                ui.label(RichText::new(text).color(ui.visuals().warn_fg_color))
                    .tip(
                        "A fork, the neurite's end or a turn of its path is in the way, or the soma \
                         would fold over itself",
                    );
            }
            Some(_) => {}
        }
    });
    ui.horizontal(|ui| {
        // Without a tooltip, which would hide the moving ring.
        let response = slider(ui, &mut value, 0.0..=2.0, Some(2), |slider| slider);
        touched |= response.hovered() || response.dragged() || response.has_focus();
        let ended = response.drag_stopped() || response.lost_focus();
        if value != before {
            state
                .requests
                .push(Edit::SetRing(id, row.neurite, Some(value)).into());
        } else if ended {
            state.history.end_joining();
        }
        let reset = Button::new("reset").small();
        if ui
            .add_enabled(row.requested.is_some(), reset)
            .tip("Automatic position")
            .clicked()
        {
            state
                .requests
                .push(Edit::SetRing(id, row.neurite, None).into());
        }
    });
    if touched {
        touch(state, id, row.neurite);
    }
}

/// Shows the neurite in the picture as if it were under the cursor, and its ring.
fn touch(state: &mut State, id: SourceId, neurite: u32) {
    state.pointing.touched = Some((id, neurite));
    let neurons = &state.document.neurons;
    let shows = |selected: bool| {
        let mut shown = neurons
            .iter()
            .enumerate()
            .filter(|(i, _)| neurons.shows(*i));
        let found =
            shown.find(|(i, n)| n.source == id && (!selected || neurons.selected().contains(*i)));
        found.map(|(index, _)| index)
    };
    state.pointing.hovered = shows(true).or_else(|| shows(false)).map(|neuron| Picked {
        neuron,
        part: CellPart::Neurite(neurite),
    });
}
