//! How the camera moves: by hand, on its way to another view, and with the window's shape.

use std::time::{Duration, Instant};

use eframe::egui::Vec2;

use crate::model::state::State;
use crate::model::view::View;

/// How long the way to another view takes.
const FLIGHT: Duration = Duration::from_millis(260);

/// The camera's way to another view, and what it takes to follow the window's shape.
pub(crate) struct Motion {
    /// Whether views change gradually; tests want them at once.
    smooth: bool,
    flight: Option<Flight>,
    /// Size of the window, once it is known.
    window: Option<Vec2>,
}

#[derive(Clone, Copy)]
struct Flight {
    from: View,
    to: View,
    begun: Instant,
}

impl Motion {
    pub(crate) fn new() -> Self {
        Self {
            smooth: true,
            flight: None,
            window: None,
        }
    }

    pub(crate) fn set_smooth(&mut self, smooth: bool) {
        self.smooth = smooth;
    }

    pub(crate) fn is_flying(&self) -> bool {
        self.flight.is_some()
    }

    /// Ends the flight where it is.
    pub(crate) fn stop(&mut self) {
        self.flight = None;
    }

    /// Moves the camera by hand.
    pub(crate) fn steer(&mut self, state: &mut State, view: View) {
        self.flight = None;
        state.fitted = None;
        state.view = view;
    }

    /// Goes to a view: gradually, if there is anything to see on the way.
    pub(crate) fn fly(&mut self, state: &mut State, to: View) {
        if self.smooth && !state.document.neurons.is_empty() {
            self.flight = Some(Flight {
                from: state.view,
                to,
                begun: Instant::now(),
            });
        } else {
            state.view = to;
        }
    }

    /// Goes to a view at once.
    pub(crate) fn jump(&mut self, state: &mut State, to: View) {
        state.view = to;
    }

    /// Lets a flight go on by the clock; whether there is one.
    pub(crate) fn advance(&mut self, state: &mut State) -> bool {
        let Some(Flight { from, to, begun }) = self.flight else {
            return false;
        };
        let t = begun.elapsed().as_secs_f64() / FLIGHT.as_secs_f64();
        if t >= 1.0 {
            (state.view, self.flight) = (to, None);
        } else {
            state.view = from.between(&to, t * t * (3.0 - 2.0 * t));
        }
        true
    }

    /// The picture has this shape (width by height) in a window of this size. A view that fits everything
    /// does so in any shape; another one changes with the window's size only, not with panels.
    pub(crate) fn reshape(&mut self, state: &mut State, aspect: f64, window: Vec2) {
        let before = self.window.replace(window);
        let resized = before.is_some_and(|before| before != window);
        let fitted = state.fitted.is_some();
        let Some(view) = state.reshape(aspect) else {
            return;
        };
        match &mut self.flight {
            Some(flight) if fitted => flight.to = view,
            // What is on its way goes where it was sent.
            Some(_) => {}
            None if fitted || resized => state.view = view,
            None => {}
        }
    }
}
