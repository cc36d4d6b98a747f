//! Which look the next cell and the next start have.

use crate::model::document::Look;
use crate::model::state::State;

impl State {
    /// Leaves taste only, for the next cell.
    pub(crate) fn forget_look(&mut self) {
        self.document.look = self.document.look.taste();
        self.document.detail = self.document.detail.taste();
        self.document.y_down = false;
    }

    /// Remembers the look for the next start, unless it is that of a picture.
    pub(super) fn remember(&mut self) {
        let look = self.document.look.taste();
        if self.look_of_picture.as_ref() != Some(&look) {
            self.settings.look = look;
            self.look_of_picture = None;
        }
        self.settings.detail = self.document.detail.taste();
    }

    /// Leaves the look of the settings as it was while a picture's is shown, which was asked for here and not for the next
    /// start, until it is changed.
    pub(crate) fn keep_look(&mut self, of_settings: Look) {
        self.settings.look = of_settings;
        self.look_of_picture = Some(self.document.look.taste());
    }
}
