//! A color for every type and category that shows, and whether they can be told apart.

use eframe::egui::{Label, RichText, ScrollArea, Ui};
use neurotess::coloring::ColoredThing;

use crate::model::document::Look;
use crate::scene::stage::Stage;
use crate::ui::panels::widgets::tip::Tip;

/// Greatest height of the list; longer ones are scrolled.
const MAX_HEIGHT: f32 = 190.0;

pub(crate) fn show(look: &mut Look, stage: &Stage, ui: &mut Ui) {
    let things = stage.colored_things();
    if things.is_empty() {
        return;
    }
    ui.add_space(2.0);
    let height = ui.spacing().interact_size.y;
    ScrollArea::vertical()
        .id_salt("own colors")
        .max_height(MAX_HEIGHT)
        .auto_shrink([false, true])
        .show_rows(ui, height, things.len(), |ui, rows| {
            for (index, thing) in rows.clone().zip(&things[rows]) {
                ui.push_id(index, |ui| row(look, thing, ui));
            }
        });
    if let Some(closest) = stage.closest_colors() {
        let why = "Simulated for people who lack one kind of cones (Machado and others, 2009)";
        let note = match closest.alike {
            0 => RichText::new("These colors differ for the color-blind, too").weak(),
            _ => RichText::new(closest.to_string()).color(ui.visuals().warn_fg_color),
        };
        // The rows above may be wider than the panel, which cuts them off.
        let room = ui.clip_rect().right() - ui.cursor().left() - 6.0;
        ui.scope(|ui| {
            ui.set_max_width(room.max(80.0));
            ui.add(Label::new(note).wrap()).tip(why);
        });
    }
    let reset = "Gives everything the colors of the palette, also what does not show now";
    if !look.own_colors.is_empty() && ui.button("Reset all colors").tip(reset).clicked() {
        look.own_colors = Default::default();
    }
}

fn row(look: &mut Look, thing: &ColoredThing, ui: &mut Ui) {
    let own = look.own_colors.get(&thing.target);
    let mut color = own.unwrap_or(thing.color);
    ui.horizontal(|ui| {
        let button = ui.color_edit_button_srgb(&mut color);
        // Not what differs: the button writes back what it shows, which may be rounded.
        if button.changed() {
            look.own_colors.set(thing.target.clone(), color);
        }
        if own.is_some() {
            let tip = "The color of the palette";
            if ui.small_button("Reset").tip(tip).clicked() {
                look.own_colors.reset(&thing.target);
            }
        }
        let name = Label::new(thing.target.to_string()).truncate();
        button.labelled_by(ui.add(name).id);
    });
}
