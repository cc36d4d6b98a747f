//! The list of neurons, and the tree of neurites and sections of the selected one.

use eframe::egui::{self, CollapsingHeader, Label, RichText, ScrollArea, Sense, TextEdit};
use neurotess::morphology::{Attachment, Morphology, SectionId};

use super::measured;
use crate::command::Command;
use crate::sources::{SectionFacts, Stale};
use crate::state::{Part, Picked, State};

pub(super) fn show(state: &mut State, ui: &mut egui::Ui) {
    ui.add_space(4.0);
    let neurons = state.document.neurons.len();
    let hidden = state.document.neurons.iter().filter(|n| n.hidden).count();
    ui.horizontal(|ui| {
        ui.label(RichText::new(count(neurons, "neuron")).strong());
        if hidden > 0
            && ui
                .link(format!("{hidden} hidden"))
                .on_hover_text("Show all")
                .clicked()
        {
            state.asked.push(Command::ShowAll);
        }
    });
    if neurons > 8 {
        let search = TextEdit::singleline(&mut state.search).hint_text("Search names");
        ui.add(search.desired_width(f32::INFINITY));
    }
    ui.separator();
    let picked = state.picked.or_else(|| {
        let neuron = state.document.selected().next()?;
        Some(Picked {
            neuron,
            part: Part::Soma,
        })
    });
    let mut hovered = None;
    let tree = picked.is_some();
    let height = if tree {
        (0.42 * ui.available_height()).max(80.0)
    } else {
        ui.available_height()
    };
    list(state, height, &mut hovered, ui);
    if let Some(picked) = picked {
        ui.separator();
        tree_of(state, picked.neuron, &mut hovered, ui);
    }
    if hovered.is_some() {
        state.hovered = hovered;
    }
}

fn list(state: &mut State, height: f32, hovered: &mut Option<Picked>, ui: &mut egui::Ui) {
    let wanted = state.search.to_lowercase();
    let rows: Vec<usize> = state
        .document
        .neurons
        .iter()
        .enumerate()
        .filter(|(_, n)| wanted.is_empty() || n.name.to_lowercase().contains(&wanted))
        .map(|(i, _)| i)
        .collect();
    let row_height = ui.spacing().interact_size.y;
    ScrollArea::vertical()
        .id_salt("neurons")
        .max_height(height)
        .auto_shrink([false, true])
        .show_rows(ui, row_height, rows.len(), |ui, shown| {
            for &index in &rows[shown] {
                row(state, index, hovered, ui);
            }
        });
    if rows.is_empty() {
        ui.weak("No name has this in it");
    }
}

fn row(state: &mut State, index: usize, hovered: &mut Option<Picked>, ui: &mut egui::Ui) {
    let neuron = &state.document.neurons[index];
    let (name, hidden, selected) = (neuron.name.clone(), neuron.hidden, neuron.selected);
    let stale = state.source_of(index).and_then(|s| s.stale);
    let warnings = state.source_of(index).map_or(0, |s| s.warnings.len());
    ui.horizontal(|ui| {
        let mut shown = !hidden;
        let says = if hidden { "Show" } else { "Hide" };
        if ui.checkbox(&mut shown, "").on_hover_text(says).changed() {
            state.asked.push(Command::SetHidden(index, !shown));
        }
        let text = RichText::new(&name);
        let text = if hidden { text.weak() } else { text };
        let response = ui.selectable_label(selected, text);
        if response.hovered() {
            *hovered = Some(Picked {
                neuron: index,
                part: Part::Soma,
            });
        }
        if response.double_clicked() {
            state.asked.push(Command::Select(vec![index], false));
            state.asked.push(Command::Focus);
        } else if response.clicked() {
            let adds = ui.input(|i| i.modifiers.shift || i.modifiers.command);
            state.asked.push(Command::Select(vec![index], adds));
            state.picked = Some(Picked {
                neuron: index,
                part: Part::Soma,
            });
        }
        response.context_menu(|ui| menu(state, index, ui));
        let reloads = |ui: &mut egui::Ui| {
            let says = "Its file has changed: read it again";
            ui.small_button("reload").on_hover_text(says).clicked()
        };
        match stale {
            Some(Stale::Changed) => {
                state.asked.extend(reloads(ui).then_some(Command::Reload));
            }
            Some(Stale::Gone) => {
                ui.colored_label(ui.visuals().warn_fg_color, "gone")
                    .on_hover_text("Its file is gone; what was read still shows");
            }
            None if warnings > 0 => {
                ui.weak("!")
                    .on_hover_text(format!("{}: see Inspect", count(warnings, "remark")));
            }
            None => {}
        }
    });
}

fn menu(state: &mut State, index: usize, ui: &mut egui::Ui) {
    let mut choice = |ui: &mut egui::Ui, title: &str, commands: Vec<Command>| {
        if ui.button(title).clicked() {
            state.asked.extend(commands);
            ui.close();
        }
    };
    let select = Command::Select(vec![index], false);
    choice(ui, "Focus", vec![select.clone(), Command::Focus]);
    choice(ui, "Isolate", vec![select.clone(), Command::Isolate]);
    choice(ui, "Hide", vec![Command::SetHidden(index, true)]);
    choice(ui, "Remove from the list", vec![select, Command::Remove]);
}

fn tree_of(state: &mut State, neuron: usize, hovered: &mut Option<Picked>, ui: &mut egui::Ui) {
    let Some(source) = state.source_of(neuron) else {
        return;
    };
    let (morphology, facts) = (source.morphology.clone(), source.sections.clone());
    let name = state.document.neurons[neuron].name.clone();
    ui.add(Label::new(RichText::new(name).strong()).truncate());
    let reveal = state.reveal.take().filter(|p| p.neuron == neuron);
    ScrollArea::vertical()
        .id_salt("tree")
        .auto_shrink(false)
        .show(ui, |ui| {
            let mut leaf = Leaf {
                state,
                neuron,
                hovered,
                reveal,
            };
            if morphology.soma().is_some() {
                leaf.show(Part::Soma, "Soma".into(), ui);
            }
            for (index, section) in morphology.sections.iter().enumerate() {
                if !matches!(section.attachment, Attachment::Section(_)) {
                    neurite(&mut leaf, &morphology, &facts, index, ui);
                }
            }
        });
}

/// A line of the tree.
struct Leaf<'a> {
    state: &'a mut State,
    neuron: usize,
    hovered: &'a mut Option<Picked>,
    reveal: Option<Picked>,
}

impl Leaf<'_> {
    fn show(&mut self, part: Part, text: String, ui: &mut egui::Ui) {
        let picked = Picked {
            neuron: self.neuron,
            part,
        };
        let chosen = self.state.picked == Some(picked);
        let under = self.state.hovered == Some(picked);
        let text = if under {
            RichText::new(text).underline()
        } else {
            RichText::new(text)
        };
        let response = ui.selectable_label(chosen, text);
        if self.reveal == Some(picked) {
            response.scroll_to_me(Some(egui::Align::Center));
        }
        self.respond(picked, &response);
    }

    fn respond(&mut self, picked: Picked, response: &egui::Response) {
        if response.hovered() {
            *self.hovered = Some(picked);
        }
        if response.clicked() {
            self.state.picked = Some(picked);
            self.state
                .asked
                .push(Command::Select(vec![self.neuron], false));
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
        Part::Section(section) => facts
            .get(section as usize)
            .is_some_and(|f| f.neurite == number),
        Part::Neurite(neurite) => neurite == number,
        Part::Soma => false,
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
                    leaf.show(Part::Section(section as u32), text, ui);
                });
            }
        });
    let picked = Picked {
        neuron: leaf.neuron,
        part: Part::Neurite(number),
    };
    if header.header_response.interact(Sense::hover()).hovered() {
        *leaf.hovered = Some(picked);
    }
    if header.header_response.clicked() {
        leaf.state.picked = Some(picked);
    }
}

/// Kind of a section for people.
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
