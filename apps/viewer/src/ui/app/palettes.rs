//! Palettes in files, which pictures of the command line and of Python take, too.

use std::io::Write;
use std::path::Path;

use neurotess::coloring::PaletteFile;
use neurotess::formats::read_regular;
use neurotess::output::{Existing, write_whole};

use super::Viewer;
use crate::model::command::Edit;
use crate::model::document::PAPER;

impl Viewer {
    /// Takes the colors of a palette's file, as an edit. If it is none, the colors stay.
    pub(super) fn open_palette(&mut self, path: &Path) {
        let content = read_regular(path).map_err(|e| format!("cannot be read: {e}"));
        let read = content.and_then(|c| PaletteFile::parse(&c).map_err(|e| e.to_string()));
        match read {
            Ok(file) => {
                let mut look = self.state.document.look.clone();
                look.palette = file.base.unwrap_or_default();
                look.own_colors = file.own_colors;
                look.background = file.background.unwrap_or(look.background);
                self.run(Edit::SetLook(Box::new(look)).into());
                self.state.history.end_joining();
                self.state.messages.status = format!("Colors of {}", path.display());
            }
            Err(why) => {
                self.state.messages.status = "The palette was not opened".into();
                self.state.problem(path.display().to_string(), why);
            }
        }
    }

    /// Writes the palette. The window's own background is not part of it: pictures have theirs.
    pub(super) fn save_palette(&mut self, path: &Path) {
        let look = &self.state.document.look;
        let file = PaletteFile {
            base: Some(look.palette),
            own_colors: look.own_colors.clone(),
            background: (look.background != PAPER).then_some(look.background),
        };
        let text = file.text();
        let written = write_whole(path, Existing::Replace, |to| to.write_all(text.as_bytes()));
        match written {
            Ok(()) => self.state.messages.status = format!("Saved {}", path.display()),
            Err(e) => {
                self.state.messages.status = "The palette was not saved".into();
                self.state
                    .problem(path.display().to_string(), e.to_string());
            }
        }
    }
}
