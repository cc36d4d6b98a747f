//! How the camera moves: by mouse and keys, in a flight to another view, and when the window
//! changes size.

use std::time::{Duration, Instant};

use eframe::egui::Vec2;

use crate::model::state::State;
use crate::model::view::View;

/// Duration of a flight to another view.
const FLIGHT: Duration = Duration::from_millis(260);

/// The camera's flight, and the window's size.
pub(crate) struct Motion {
    /// Whether views change gradually; in tests they change at once.
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

    /// Ends the flight at the current view.
    pub(crate) fn stop(&mut self) {
        self.flight = None;
    }

    /// Moves the camera by mouse or keys, which ends a flight.
    pub(crate) fn steer(&mut self, state: &mut State, view: View) {
        self.flight = None;
        state.fitted = None;
        state.view = view;
    }

    /// Goes to a view: gradually, if there is anything to see meanwhile.
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

    /// Changes the projection, also of a flight. What is at the target's depth keeps its size.
    pub(crate) fn project(&mut self, state: &mut State, orthographic: bool) {
        state.view.orthographic = orthographic;
        if let Some(flight) = &mut self.flight {
            flight.from.orthographic = orthographic;
            flight.to.orthographic = orthographic;
        }
    }

    /// Goes to a view at once.
    pub(crate) fn jump(&mut self, state: &mut State, to: View) {
        state.view = to;
    }

    /// Advances a flight by the clock. True if there is one.
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

    /// Adapts the view to the picture's aspect ratio (width by height), in a window of this size. A
    /// view that fits everything still does; another one changes only with the window's size, not
    /// with panels.
    pub(crate) fn reshape(&mut self, state: &mut State, aspect: f64, window: Vec2) {
        let before = self.window.replace(window);
        let resized = before.is_some_and(|before| before != window);
        let fitted = state.fitted.is_some();
        let Some(view) = state.reshape(aspect) else {
            return;
        };
        match &mut self.flight {
            Some(flight) if fitted => flight.to = view,
            // A flight goes on to its destination.
            Some(_) => {}
            None if fitted || resized => state.view = view,
            None => {}
        }
    }
}
