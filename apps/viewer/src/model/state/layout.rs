//! Which parts of the window show.

use super::Dialog;
use crate::model::command::Tab;

/// Which parts of the window show.
#[derive(Debug)]
pub struct Layout {
    /// The panel on the right.
    pub tab: Tab,
    /// Whether what was traced of somata lies over the picture, while the panel *Soma* shows.
    pub traced_somata: bool,
    /// Text to search the list by.
    pub search: String,
    /// The dialog that is open.
    pub dialog: Dialog,
    /// Whether the side panels show.
    pub panels: bool,
    /// Whether the window presents: the whole screen, and no panels.
    pub presenting: bool,
    /// Whether the window was asked to fill the screen.
    pub full_screen: bool,
}

impl Default for Layout {
    /// Panels, and no dialog.
    fn default() -> Self {
        Self {
            tab: Tab::default(),
            traced_somata: true,
            search: String::new(),
            dialog: Dialog::Nothing,
            panels: true,
            presenting: false,
            full_screen: false,
        }
    }
}
