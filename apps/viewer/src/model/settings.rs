//! Settings, which are kept between starts in a file in the user's configuration folder.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use directories::ProjectDirs;
use neurotess::output::{Existing, write_whole};
use serde::{Deserialize, Serialize};

use crate::model::document::{Detail, Look};

/// Most files in the recent list.
const RECENT: usize = 12;
/// Settings that are not written yet.
static UNWRITTEN: Mutex<Option<Settings>> = Mutex::new(None);

/// Environment variable that names another folder for the file.
pub const FOLDER_VARIABLE: &str = "NEUROTESS_CONFIG";

/// Settings that are kept between starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Whether the theme is dark.
    pub dark: bool,
    /// Whether a drag that selects draws a lasso instead of a rectangle.
    pub lasso: bool,
    /// Folder of the last file.
    pub folder: PathBuf,
    /// Files that were opened last, the newest first.
    pub recent: Vec<PathBuf>,
    /// Size (pixels) of pictures that are saved.
    pub picture_size: [u32; 2],
    /// Factor on everything's size.
    pub zoom: f32,
    /// Whether circuits have a cache.
    pub caches: bool,
    /// Colors and light, as far as they are taste.
    pub look: Look,
    /// The level of detail, without what hides anything.
    pub detail: Detail,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            dark: true,
            lasso: false,
            folder: std::env::current_dir().unwrap_or_default(),
            recent: Vec::new(),
            picture_size: [1920, 1440],
            zoom: 1.0,
            caches: true,
            look: Look::default(),
            detail: Detail::default(),
        }
    }
}

impl Settings {
    /// Reads the settings. If there are none, or if they are invalid, the default ones; then with
    /// the reason.
    pub fn load() -> (Self, Option<String>) {
        let Some(file) = file() else {
            return (Self::default(), None);
        };
        let Ok(text) = fs::read_to_string(&file) else {
            return (Self::default(), None);
        };
        match toml::from_str::<Self>(&text) {
            Ok(mut settings) => {
                // Earlier versions kept all.
                settings.look = settings.look.taste();
                settings.detail = settings.detail.taste();
                (settings, None)
            }
            Err(e) => (
                Self::default(),
                Some(format!(
                    "{} was not understood ({}): what was remembered is lost",
                    file.display(),
                    e.message()
                )),
            ),
        }
    }

    /// Writes the settings to their file.
    ///
    /// # Errors
    /// The reason, if that fails.
    pub fn save(&self) -> Result<(), String> {
        let Some(file) = file() else {
            return Ok(());
        };
        let text = toml::to_string_pretty(self).map_err(|e| e.to_string())?;
        write_whole(&file, Existing::Replace, |to| to.write_all(text.as_bytes()))
            .map_err(|e| e.to_string())
    }

    /// Keeps the settings to be written by [`write_noted`] if the program ends before the window
    /// closes.
    pub(crate) fn note(&self) {
        *UNWRITTEN.lock().unwrap_or_else(PoisonError::into_inner) = Some(self.clone());
    }

    /// Puts files on top of the recent list.
    pub fn remember_files(&mut self, paths: &[PathBuf]) {
        for path in paths {
            let whole = fs::canonicalize(path).unwrap_or_else(|_| path.clone());
            if let Some(folder) = whole.parent() {
                self.folder = folder.to_path_buf();
            }
            self.recent.retain(|known| *known != whole);
            self.recent.insert(0, whole);
        }
        self.recent.truncate(RECENT);
    }

    /// Takes a file that could not be read off the recent list.
    pub(crate) fn forget_file(&mut self, path: &Path) {
        let whole = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        self.recent.retain(|known| *known != whole);
    }
}

/// Writes settings that are not written yet, when the program is interrupted. From any thread.
///
/// # Errors
/// The reason, if that fails.
pub fn write_noted() -> Result<(), String> {
    let noted = UNWRITTEN
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take();
    noted.map_or(Ok(()), |settings| settings.save())
}

/// The folder of the settings' file.
pub fn folder() -> Option<PathBuf> {
    if let Some(folder) = std::env::var_os(FOLDER_VARIABLE) {
        return Some(PathBuf::from(folder));
    }
    let dirs = ProjectDirs::from("", "", "neurotess")?;
    Some(dirs.config_dir().to_path_buf())
}

fn file() -> Option<PathBuf> {
    folder().map(|folder| folder.join(Path::new("viewer.toml")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_remembered_survives_a_round_trip() {
        let mut settings = Settings {
            dark: false,
            ..Settings::default()
        };
        for i in 0..20 {
            settings.remember_files(&[PathBuf::from(format!("/a/{i}.swc"))]);
        }
        settings.remember_files(&[PathBuf::from("/a/15.swc")]);
        assert_eq!(settings.recent.len(), RECENT);
        assert_eq!(settings.recent[0], PathBuf::from("/a/15.swc"));
        let text = toml::to_string_pretty(&settings).expect("written");
        assert_eq!(toml::from_str::<Settings>(&text).expect("read"), settings);
        assert_eq!(
            toml::from_str::<Settings>("dark = false").map(|s| s.dark),
            Ok(false)
        );
    }
}
