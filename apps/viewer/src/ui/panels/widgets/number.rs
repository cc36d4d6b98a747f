//! Sliders and fields for numbers. Those of egui write back the number as they show it, rounded or
//! limited, even if the user has not touched it. These change a number only if the user does.
//!
//! Each has an id of its own. egui's ids follow from the place, so that a line that comes or goes above a field
//! would take the keyboard from it in the middle of a number.

use std::ops::RangeInclusive;
use std::panic::Location;

use eframe::egui::emath::{Numeric, round_to_decimals};
use eframe::egui::{DragValue, Id, Response, Slider, SliderClamping, Ui, UiBuilder};

/// A slider for a number. `decimals`: how many are shown; none: as many as fit.
#[track_caller]
pub(crate) fn slider<N: Numeric>(
    ui: &mut Ui,
    value: &mut N,
    range: RangeInclusive<N>,
    decimals: Option<usize>,
    dress: impl FnOnce(Slider<'_>) -> Slider<'_>,
) -> Response {
    let range = range.start().to_f64()..=range.end().to_f64();
    let id = own_id(ui, Location::caller());
    edit(value, decimals, &range, |shown| {
        let mut slider = Slider::new(shown, range.clone()).clamping(SliderClamping::Edits);
        if N::INTEGRAL {
            slider = slider.integer();
        } else if let Some(decimals) = decimals {
            slider = slider.fixed_decimals(decimals);
        }
        kept_as(ui, id, |ui| ui.add(dress(slider)))
    })
}

/// A field for a number, to be dragged or typed, with at most this number of decimals.
#[track_caller]
pub(crate) fn field<N: Numeric>(
    ui: &mut Ui,
    value: &mut N,
    range: RangeInclusive<N>,
    decimals: usize,
    dress: impl FnOnce(DragValue<'_>) -> DragValue<'_>,
) -> Response {
    let range = range.start().to_f64()..=range.end().to_f64();
    let decimals = if N::INTEGRAL { 0 } else { decimals };
    let id = own_id(ui, Location::caller());
    edit(value, Some(decimals), &range, |shown| {
        let field = DragValue::new(shown)
            .range(range.clone())
            .clamp_existing_to_range(false)
            .max_decimals(decimals);
        // In lines that wrap, a scope would not begin a new line: there, the whole line is `kept`.
        match ui.layout().main_wrap {
            true => ui.add(dress(field)),
            false => kept_as(ui, id, |ui| ui.add(dress(field))),
        }
    })
}

/// Shows controls whose ids do not depend on what is above them.
pub(crate) fn kept<R>(ui: &mut Ui, name: &str, show: impl FnOnce(&mut Ui) -> R) -> R {
    let id = ui.scope_id().with(("kept", name));
    kept_as(ui, id, show)
}

fn kept_as<R>(ui: &mut Ui, id: Id, show: impl FnOnce(&mut Ui) -> R) -> R {
    ui.scope_builder(UiBuilder::new().scope_id(id), show).inner
}

/// The id of a control by its place in the program, and by how many that place has shown before it in this pass.
fn own_id(ui: &Ui, at: &Location<'_>) -> Id {
    let place = (at.file(), at.line(), at.column());
    let place = ui.scope_id().with(("number", place));
    let pass = ui.ctx().cumulative_pass_nr();
    let count = ui.data_mut(|data| {
        let shown: &mut Option<(u64, u32)> = data.get_temp_mut_or_default(place);
        let count = shown.map_or(0, |(last, count)| if last == pass { count + 1 } else { 0 });
        *shown = Some((pass, count));
        count
    });
    place.with(count)
}

/// Shows a control with the rounded number, and changes the number only if the user has changed
/// that.
fn edit<N: Numeric>(
    value: &mut N,
    decimals: Option<usize>,
    range: &RangeInclusive<f64>,
    show: impl FnOnce(&mut f64) -> Response,
) -> Response {
    let number = value.to_f64();
    let rounded = decimals.map_or(number, |decimals| round_to_decimals(number, decimals));
    // NaN is shown as the least number until the user changes it.
    let shown = if rounded.is_finite() {
        rounded
    } else {
        *range.start()
    };
    let mut now = shown;
    let response = show(&mut now);
    if now != shown {
        *value = N::from_f64(now);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Context, RawInput};

    #[test]
    fn a_field_keeps_its_id_when_lines_come_above_it() {
        let ctx = Context::default();
        let ids = |lines: usize| {
            let mut ids = Vec::new();
            let mut output = ctx.run_ui(RawInput::default(), |ui| {
                for line in 0..lines {
                    ui.label(format!("line {line}"));
                }
                ids.clear();
                for _ in 0..2 {
                    let mut number = 1.0;
                    ids.push(field(ui, &mut number, 0.0..=9.0, 2, |field| field).id);
                    ids.push(slider(ui, &mut number, 0.0..=9.0, None, |slider| slider).id);
                }
            });
            output.textures_delta.clear();
            ids
        };
        let before = ids(0);
        assert_eq!(ids(3), before);
        let mut each = before.clone();
        each.sort_unstable_by_key(Id::value);
        each.dedup();
        assert_eq!(each.len(), before.len());
    }
}
