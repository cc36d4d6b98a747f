//! Two views side by side: which one commands are for, and how one follows the other.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use neurotess::render::Side;

use super::State;
use crate::model::split::{Split, following};

impl State {
    /// Shows two views, or one.
    pub(super) fn set_split(&mut self, on: bool) {
        if self.views.split.is_some() == on {
            return;
        }
        if !on {
            self.views.split = None;
            return;
        }
        // From the side, so that both together show all of it.
        let upwards = if self.document.y_down {
            DVec3::NEG_Y
        } else {
            DVec3::Y
        };
        let side = Some(Side::Right).filter(|_| self.views.fitted == Some(Side::Front));
        let view = match side {
            Some(side) => self.fit(side),
            None => self.view.orbited(-FRAC_PI_2, 0.0, upwards),
        };
        self.views.split = Some(Split {
            fitted: side,
            aspect: self.views.aspect,
            ..Split::new(view)
        });
        self.messages.status = "Keys are for the view that was clicked last".into();
    }

    /// Links the two views, or no longer.
    pub(super) fn set_linked(&mut self, linked: bool) {
        if linked {
            self.set_split(true);
        }
        if let Some(split) = &mut self.views.split {
            (split.linked, split.followed) = (linked, None);
        }
    }

    /// Exchanges the two views, until the other one is drawn.
    pub(crate) fn exchange_views(&mut self) {
        if let Some(split) = &mut self.views.split {
            std::mem::swap(&mut self.view, &mut split.view);
            std::mem::swap(&mut self.views.fitted, &mut split.fitted);
            std::mem::swap(&mut self.views.aspect, &mut split.aspect);
        }
    }

    /// Makes commands be for the right view, or for the left one.
    pub(crate) fn command_view(&mut self, right: bool) {
        if self.views.split.is_some_and(|split| split.right != right) {
            self.exchange_views();
            if let Some(split) = &mut self.views.split {
                (split.right, split.followed) = (right, None);
            }
        }
    }

    /// Moves the view that has not been moved as the other one was, if they are linked.
    pub(crate) fn follow(&mut self) {
        let Some(split) = self.views.split.filter(|split| split.linked) else {
            return;
        };
        let (mut view, mut other) = (self.view, split.view);
        if let Some([view_before, other_before]) = split.followed {
            if view != view_before {
                other = following(&other_before, &view_before, &view);
            } else if other != other_before {
                view = following(&view_before, &other_before, &other);
            }
        }
        if view != self.view {
            (self.view, self.views.fitted) = (view, None);
        }
        if let Some(split) = &mut self.views.split {
            if split.view != other {
                (split.view, split.fitted) = (other, None);
            }
            split.followed = Some([view, other]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::command::Command;
    use crate::model::settings::Settings;

    #[test]
    fn linked_views_follow_whichever_was_moved() {
        let mut state = State::new(Settings::default());
        state.run(Command::SetLinked(true));
        let angle = |state: &State| {
            let other = state.views.split.expect("two views").view.camera();
            state.view.camera().axes()[2].dot(other.axes()[2])
        };
        state.follow();
        let before = angle(&state);
        assert!(before.abs() < 1e-9, "one is from the side of the other");
        let first = state.views.split.expect("two views").view;
        state.view = state.view.orbited(0.3, 0.0, DVec3::Y);
        state.follow();
        let second = state.views.split.expect("two views").view;
        assert!(first != second && (angle(&state) - before).abs() < 1e-9);
        let view = state.view;
        if let Some(split) = &mut state.views.split {
            split.view = second.orbited(-0.2, 0.0, DVec3::Y);
        }
        state.follow();
        assert!(state.view != view && (angle(&state) - before).abs() < 1e-9);
        // Not linked, each is by itself.
        state.run(Command::SetLinked(false));
        let other = state.views.split.expect("two views").view;
        state.view = state.view.orbited(0.3, 0.0, DVec3::Y);
        state.follow();
        assert_eq!(state.views.split.expect("two views").view, other);
    }

    #[test]
    fn commands_are_for_the_view_that_was_chosen() {
        let mut state = State::new(Settings::default());
        state.run(Command::SetSplit(true));
        let (left, right) = (state.view, state.views.split.expect("two views").view);
        state.command_view(true);
        assert_eq!(
            (state.view, state.views.split.expect("two").view),
            (right, left)
        );
        state.command_view(true);
        assert_eq!(state.view, right);
        state.command_view(false);
        assert_eq!(state.view, left);
        state.run(Command::SetSplit(false));
        assert_eq!((state.view, state.views.split), (left, None));
    }
}
