//! The list of neurons, and the tree of neurites and sections of the selected one.

use eframe::egui::{
    self, Align, Button, CollapsingHeader, Id, Label, Layout, Rect, RichText, ScrollArea, Sense,
    TextEdit, vec2,
};
use neurotess::morphology::{Attachment, Morphology, SectionId};

use crate::model::command::{Command, Edit};
use crate::model::document::NeuronState;
use crate::model::sources::{SectionFacts, Stale};
use crate::model::state::{CellPart, Picked, State};
use crate::ui::panels::measured;
use crate::ui::panels::widgets::tip::Tip;

pub(super) fn show(state: &mut State, ui: &mut egui::Ui) {
    ui.add_space(4.0);
    let neurons = state.document.neurons.len();
    let hidden = state.document.neurons.hidden().len();
    let rows = state.found();
    ui.horizontal(|ui| {
        let title = match state.layout.search.is_empty() {
            true => count(neurons, "neuron"),
            false => format!(
                "{} of {}",
                super::grouped(rows.len() as u64),
                count(neurons, "neuron")
            ),
        };
        ui.label(RichText::new(title).strong());
        if hidden > 0
            && ui
                .link(format!("{hidden} hidden"))
                .tip("Show all")
                .clicked()
        {
            state.requests.push(Edit::ShowAll.into());
        }
    });
    if neurons > FEW || !state.layout.search.is_empty() {
        let search = TextEdit::singleline(&mut state.layout.search)
            .id(Id::unique("filter"))
            .hint_text("Filter by name");
        ui.add(search.desired_width(f32::INFINITY));
    }
    ui.separator();
    let picked = state.pointing.picked.or_else(|| {
        let neuron = state.document.selected().next()?;
        Some(Picked {
            neuron,
            part: CellPart::Soma,
        })
    });
    let mut hovered = None;
    let tree = picked.is_some();
    let height = if tree {
        (0.42 * ui.available_height()).max(80.0)
    } else {
        ui.available_height()
    };
    list(state, &rows, height, &mut hovered, ui);
    if let Some(picked) = picked {
        ui.separator();
        tree_of(state, picked.neuron, &mut hovered, ui);
    }
    // Hidden neurons are not in the picture, so that they cannot be outlined.
    let neurons = &state.document.neurons;
    let shows = |p: &Picked| neurons.shows(p.neuron);
    if hovered.as_ref().is_some_and(shows) {
        state.pointing.hovered = hovered;
    }
}

/// Greatest number of neurons without a search field.
const FEW: usize = 8;

fn list(
    state: &mut State,
    rows: &[usize],
    height: f32,
    hovered: &mut Option<Picked>,
    ui: &mut egui::Ui,
) {
    let row_height = ui.spacing().interact_size.y;
    let step = row_height + ui.spacing().item_spacing.y;
    let wanted = state.pointing.reveal.map(|picked| picked.neuron);
    let wanted = rows.iter().position(|&row| Some(row) == wanted);
    ScrollArea::vertical()
        .id_salt("neurons")
        .max_height(height)
        .auto_shrink([false, true])
        .show_rows(ui, row_height, rows.len(), |ui, shown| {
            if let Some(wanted) = wanted {
                let above = (wanted as f32 - shown.start as f32) * step;
                let line = Rect::from_min_size(
                    ui.max_rect().min + vec2(0.0, above),
                    vec2(1.0, row_height),
                );
                ui.scroll_to_rect(line, None);
            }
            for &index in &rows[shown] {
                row(state, index, hovered, ui);
            }
        });
    if rows.is_empty() {
        ui.weak("No name contains this text");
    }
}

fn row(state: &mut State, index: usize, hovered: &mut Option<Picked>, ui: &mut egui::Ui) {
    let name = state.document.neurons[index].name.clone();
    let NeuronState {
        hidden,
        selected,
        clamped,
    } = state.document.neurons.state(index);
    let stale = state.source_of(index).and_then(|s| s.stale);
    let warnings = state.source_of(index).map_or(0, |s| {
        let concerns = s.warnings.iter().filter(|w| w.concerns);
        concerns.count()
    });
    ui.horizontal(|ui| {
        let mut shown = !hidden;
        let says = if hidden { "Show" } else { "Hide" };
        if ui.checkbox(&mut shown, "").tip(says).changed() {
            state.requests.push(Edit::SetHidden(index, !shown).into());
        }
        // From right to left: figures first, then the name in the remaining width.
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            match stale {
                Some(Stale::Changed) => {
                    let says = "The file has changed: read it again";
                    let reloads = ui.small_button("reload").tip(says).clicked();
                    state.requests.extend(reloads.then_some(Command::Reload));
                }
                Some(Stale::Gone) => {
                    ui.colored_label(ui.visuals().warn_fg_color, "file gone")
                        .tip("The file was moved or deleted; what was read is still shown");
                }
                None if warnings > 0 => {
                    ui.colored_label(ui.visuals().warn_fg_color, "!")
                        .tip(format!("{} to check: see Inspect", count(warnings, "note")));
                }
                None => {}
            }
            if clamped {
                ui.weak("clamped")
                    .tip("Drawn finely, also while the camera moves (C)");
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let text = RichText::new(&name);
                let text = if hidden { text.weak() } else { text };
                let response = ui.add(Button::selectable(selected, text).truncate());
                named(state, index, &response, hovered);
            });
        });
    });
}

/// Handles the cursor and clicks on the name of a neuron.
fn named(state: &mut State, index: usize, response: &egui::Response, hovered: &mut Option<Picked>) {
    let soma = Picked {
        neuron: index,
        part: CellPart::Soma,
    };
    if response.hovered() {
        *hovered = Some(soma);
    }
    if response.double_clicked() {
        state.requests.push(Edit::Select(vec![index], false).into());
        state.requests.push(Command::Focus);
    } else if response.clicked() {
        let modifiers = response.ctx.input(|i| i.modifiers);
        let edit = match state.pointing.listed.filter(|_| modifiers.shift) {
            Some(from) => Edit::Select(between(&state.found(), from, index), false),
            None => Edit::Select(vec![index], modifiers.command),
        };
        state.requests.push(edit.into());
        if !modifiers.shift {
            state.pointing.listed = Some(index);
        }
        // The whole cell is meant, no part of it.
        state.pointing.picked = None;
    }
    response.context_menu(|ui| menu(state, index, ui));
}

/// The neurons of the list from one to another, whichever is above.
fn between(rows: &[usize], from: usize, to: usize) -> Vec<usize> {
    let place = |neuron: usize| rows.iter().position(|&row| row == neuron);
    match (place(from), place(to)) {
        (Some(a), Some(b)) => rows[a.min(b)..=a.max(b)].to_vec(),
        _ => vec![to],
    }
}

fn menu(state: &mut State, index: usize, ui: &mut egui::Ui) {
    let mut choice = |ui: &mut egui::Ui, title: &str, commands: Vec<Command>| {
        if ui.button(title).clicked() {
            state.requests.extend(commands);
            ui.close();
        }
    };
    let select = Command::from(Edit::Select(vec![index], false));
    choice(ui, "Focus", vec![select.clone(), Command::Focus]);
    choice(ui, "Isolate", vec![select.clone(), Edit::Isolate.into()]);
    choice(ui, "Hide", vec![Edit::SetHidden(index, true).into()]);
    choice(
        ui,
        "Remove from the list",
        vec![select, Edit::Remove.into()],
    );
}

fn tree_of(state: &mut State, neuron: usize, hovered: &mut Option<Picked>, ui: &mut egui::Ui) {
    let Some(source) = state.source_of(neuron) else {
        return;
    };
    let (morphology, facts) = (source.morphology.clone(), source.sections.clone());
    let name = state.document.neurons[neuron].name.clone();
    ui.add(Label::new(RichText::new(name).strong()).truncate());
    let reveal = state.pointing.reveal.take().filter(|p| p.neuron == neuron);
    ScrollArea::vertical()
        .id_salt("tree")
        .auto_shrink(false)
        .show(ui, |ui| {
            let mut leaf = Leaf {
                state,
                neuron,
                hovered,
                reveal,
                opening: false,
            };
            if morphology.soma().is_some() {
                leaf.show(CellPart::Soma, "Soma".into(), ui);
            }
            for (index, section) in morphology.sections.iter().enumerate() {
                if !matches!(section.attachment, Attachment::Section(_)) {
                    neurite(&mut leaf, &morphology, &facts, index, ui);
                }
            }
            // While the lines of a neurite unfold, the revealed one moves: the request is repeated.
            if leaf.opening {
                leaf.state.pointing.reveal = reveal;
            }
        });
}

/// A line of the tree.
struct Leaf<'a> {
    state: &'a mut State,
    neuron: usize,
    hovered: &'a mut Option<Picked>,
    reveal: Option<Picked>,
    /// Whether lines around the part to be revealed are still unfolding.
    opening: bool,
}

impl Leaf<'_> {
    fn show(&mut self, part: CellPart, text: String, ui: &mut egui::Ui) {
        let picked = Picked {
            neuron: self.neuron,
            part,
        };
        let chosen = self.state.pointing.picked == Some(picked);
        let under = self.state.pointing.hovered == Some(picked);
        let text = if under {
            RichText::new(text).underline()
        } else {
            RichText::new(text)
        };
        let response = ui.selectable_label(chosen, text);
        if self.reveal == Some(picked) {
            response.scroll_to_me(Some(Align::Center));
        }
        self.respond(picked, &response);
    }

    fn respond(&mut self, picked: Picked, response: &egui::Response) {
        if response.hovered() {
            *self.hovered = Some(picked);
        }
        if response.double_clicked() {
            go_to(self.state, picked);
        }
        if response.clicked() {
            self.state.pointing.picked = Some(picked);
            self.state
                .requests
                .push(Edit::Select(vec![self.neuron], false).into());
        }
    }
}

fn neurite(
    leaf: &mut Leaf<'_>,
    morphology: &Morphology,
    facts: &[SectionFacts],
    root: usize,
    ui: &mut egui::Ui,
) {
    let number = facts[root].neurite;
    let sections = (root..facts.len()).take_while(|&s| facts[s].neurite == number);
    let sections: Vec<usize> = sections.collect();
    let length: f64 = sections.iter().map(|&s| facts[s].length).sum();
    let kind = kind_name(morphology, root);
    let title = format!("{kind} {}  ·  {}", number + 1, measured(length, "µm"));
    let holds = |picked: &Picked| match picked.part {
        CellPart::Section(section) => facts
            .get(section as usize)
            .is_some_and(|f| f.neurite == number),
        CellPart::Neurite(neurite) => neurite == number,
        CellPart::Soma => false,
    };
    let opens = leaf.reveal.as_ref().is_some_and(holds);
    let header = CollapsingHeader::new(title)
        .id_salt((leaf.neuron, number))
        .open(opens.then_some(true))
        .show(ui, |ui| {
            for &section in &sections {
                let facts = &facts[section];
                ui.horizontal(|ui| {
                    ui.add_space(9.0 * facts.order.min(9) as f32);
                    let text = format!("{}  {}", section, measured(facts.length, "µm"));
                    leaf.show(CellPart::Section(section as u32), text, ui);
                });
            }
        });
    leaf.opening |= opens && !header.fully_open();
    let picked = Picked {
        neuron: leaf.neuron,
        part: CellPart::Neurite(number),
    };
    if header.header_response.interact(Sense::hover()).hovered() {
        *leaf.hovered = Some(picked);
    }
    if header.header_response.double_clicked() {
        go_to(leaf.state, picked);
    }
    if header.header_response.clicked() {
        leaf.state.pointing.picked = Some(picked);
    }
}

/// Zooms to a part.
fn go_to(state: &mut State, picked: Picked) {
    if let Some(sphere) = state.part_sphere(picked) {
        state.requests.push(Command::Go(state.view.focused(sphere)));
    }
}

/// Kind of a section as text.
pub(super) fn kind_name(morphology: &Morphology, section: usize) -> String {
    let id = SectionId(section as u32);
    let name = morphology.sections[id.index()]
        .kind
        .name()
        .replace('_', " ");
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// `1 neuron`, `2 neurons`.
pub(super) fn count(number: usize, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{} {thing}{plural}", super::grouped(number as u64))
}
