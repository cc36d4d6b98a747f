//! The colors of numbers: of cells, or of synapses and points.

use eframe::egui::{ComboBox, Ui};
use neurotess::render::color::ColorMap;

use crate::model::document::Look;

pub(crate) fn show(look: &mut Look, ui: &mut Ui) {
    ComboBox::from_id_salt("map")
        .selected_text(look.color_map.name())
        .show_ui(ui, |ui| {
            for map in ColorMap::ALL {
                ui.selectable_value(&mut look.color_map, map, map.name());
            }
        });
}
