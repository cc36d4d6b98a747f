//! How the camera moves: by mouse and keys, in a flight to another view, and when the window
//! changes size.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use eframe::egui::Vec2;
use glam::DVec3;

use crate::model::state::State;
use crate::model::view::View;

/// Duration (s) of a turn of the turntable.
const TURN: f64 = 24.0;
/// Longest time (s) of one step of it: after a long frame it goes on as if that had been short.
const STEP: f64 = 0.1;
/// Duration of a flight to another view.
const FLIGHT: Duration = Duration::from_millis(260);

/// The camera's flight, and the window's size.
pub(crate) struct Motion {
    /// Whether views change gradually; in tests they change at once.
    smooth: bool,
    flight: Option<Flight>,
    /// Size of the window, once it is known, and whether it has just changed.
    window: (Option<Vec2>, bool),
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
            window: (None, false),
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
        state.views.fitted = None;
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

    /// Turns the scene by what the turntable turns in this time (s).
    pub(crate) fn turn(&mut self, state: &mut State, time: f64) {
        let upwards = match state.document.y_down {
            true => DVec3::NEG_Y,
            false => DVec3::Y,
        };
        let angle = TAU * time.clamp(0.0, STEP) / TURN;
        self.steer(state, state.view.orbited(-angle, 0.0, upwards));
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

    /// Notes the size of the window in this frame.
    pub(crate) fn note_window(&mut self, size: Vec2) {
        let resized = self.window.0.is_some_and(|before| before != size);
        self.window = (Some(size), resized);
    }

    /// Adapts the view to the picture's aspect ratio (width by height). A view that fits everything still does;
    /// another one changes only with the window's size, not with panels. `flies`: whether a flight is that of this
    /// view.
    pub(crate) fn reshape(&mut self, state: &mut State, aspect: f64, flies: bool) {
        let (_, resized) = self.window;
        let fitted = state.views.fitted.is_some();
        let Some(view) = state.reshape(aspect) else {
            return;
        };
        match self.flight.as_mut().filter(|_| flies) {
            Some(flight) if fitted => flight.to = view,
            // A flight goes on to its destination.
            Some(_) => {}
            None if fitted || resized => state.view = view,
            None => {}
        }
    }
}
