//! Sliders and fields for numbers. Those of egui write back the number as they show it, rounded or
//! limited, even if the user has not touched it. These change a number only if the user does.

use std::ops::RangeInclusive;

use eframe::egui::emath::{Numeric, round_to_decimals};
use eframe::egui::{DragValue, Response, Slider, SliderClamping, Ui};

/// A slider for a number. `decimals`: how many are shown; none: as many as fit.
pub(super) fn slider<N: Numeric>(
    ui: &mut Ui,
    value: &mut N,
    range: RangeInclusive<N>,
    decimals: Option<usize>,
    dress: impl FnOnce(Slider<'_>) -> Slider<'_>,
) -> Response {
    let range = range.start().to_f64()..=range.end().to_f64();
    edit(value, decimals, &range, |shown| {
        let mut slider = Slider::new(shown, range.clone()).clamping(SliderClamping::Edits);
        if N::INTEGRAL {
            slider = slider.integer();
        } else if let Some(decimals) = decimals {
            slider = slider.fixed_decimals(decimals);
        }
        ui.add(dress(slider))
    })
}

/// A field for a number, to be dragged or typed, with at most this number of decimals.
pub(super) fn field<N: Numeric>(
    ui: &mut Ui,
    value: &mut N,
    range: RangeInclusive<N>,
    decimals: usize,
    dress: impl FnOnce(DragValue<'_>) -> DragValue<'_>,
) -> Response {
    let range = range.start().to_f64()..=range.end().to_f64();
    let decimals = if N::INTEGRAL { 0 } else { decimals };
    edit(value, Some(decimals), &range, |shown| {
        let field = DragValue::new(shown)
            .range(range.clone())
            .clamp_existing_to_range(false)
            .max_decimals(decimals);
        ui.add(dress(field))
    })
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
