//! The file dialog: folders to walk through, and a line to type or paste a path into. It does not
//! use the desktop's own dialog, so it is the same everywhere.

use std::fs;
use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, RichText, ScrollArea};

use crate::io::find;
use crate::io::paths::{self, Name, completed, goes_on, parted};
use crate::model::command::{Command, Edit, FilePurpose, PlotOf};
use crate::model::document::is_mesh;
use crate::model::session;
use crate::model::targets::{named, session_file};
use crate::ui::path_line;

/// State of the file dialog: the folder, and what is typed.
#[derive(Clone, Debug)]
pub(crate) struct FilePanel {
    purpose: FilePurpose,
    folder: PathBuf,
    entries: Vec<Entry>,
    typed: String,
    /// The name that is being typed; only names that begin with it are listed.
    begun: String,
    chosen: Vec<PathBuf>,
    said: String,
    fresh: bool,
}

#[derive(Clone, Debug)]
struct Entry {
    path: PathBuf,
    name: String,
    is_folder: bool,
    size: u64,
}

impl FilePanel {
    /// A dialog that shows a folder. `session`: the file that the session was last saved to.
    /// `name`: what a session is named after that has no file yet.
    pub(crate) fn new(
        purpose: FilePurpose,
        folder: &Path,
        session: Option<&Path>,
        name: &str,
    ) -> Self {
        let typed = match (purpose, session) {
            (FilePurpose::SaveSession, Some(session)) => session.display().to_string(),
            (FilePurpose::SaveSession, None) => {
                let name = format!("{name}.{}", session::EXTENSION);
                folder.join(name).display().to_string()
            }
            (FilePurpose::SavePage, _) => folder.join(format!("{name}.html")).display().to_string(),
            (FilePurpose::SavePalette, _) => folder.join("palette.toml").display().to_string(),
            (FilePurpose::SavePlot(of, extension), _) => {
                let name = plot_name(of);
                folder
                    .join(format!("{name}.{extension}"))
                    .display()
                    .to_string()
            }
            (
                FilePurpose::Open
                | FilePurpose::Report
                | FilePurpose::Points
                | FilePurpose::Meshes
                | FilePurpose::OpenPalette,
                _,
            ) => String::new(),
        };
        let mut panel = Self {
            purpose,
            folder: PathBuf::new(),
            entries: Vec::new(),
            typed,
            begun: String::new(),
            chosen: Vec::new(),
            said: String::new(),
            fresh: true,
        };
        panel.enter(folder);
        panel
    }

    /// Whether it is for this purpose.
    pub(crate) fn is_for(&self, purpose: FilePurpose) -> bool {
        self.purpose == purpose
    }

    /// Its purpose, when it is shown again: its line gets the keyboard.
    pub(crate) fn again(&mut self) -> FilePurpose {
        self.fresh = true;
        self.purpose
    }

    fn enter(&mut self, folder: &Path) {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        self.chosen.clear();
        self.begun.clear();
        match fs::read_dir(folder) {
            Ok(entries) => {
                let mut found: Vec<Entry> = entries
                    .flatten()
                    .filter_map(|entry| self.entry(&entry.path()))
                    .collect();
                found.sort_by_key(|e| (!e.is_folder, e.name.to_lowercase()));
                self.entries = found;
                self.folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_path_buf());
                self.said.clear();
            }
            Err(e) => self.said = format!("{} cannot be opened: {e}", folder.display()),
        }
    }

    fn entry(&self, path: &Path) -> Option<Entry> {
        let name = path.file_name()?.to_string_lossy().into_owned();
        let data = fs::metadata(path).ok()?;
        let is_folder = data.is_dir();
        let is = |extension| {
            let own = path.extension();
            own.is_some_and(|e| e.eq_ignore_ascii_case(extension))
        };
        let wanted = match self.purpose {
            FilePurpose::Open => {
                is_folder || find::is_readable(path) || session::is_session(path) || is("json")
            }
            FilePurpose::Report => is_folder || find::is_hdf5(path),
            FilePurpose::Points => is_folder || is("csv") || is("tsv"),
            FilePurpose::Meshes => is_folder || is_mesh(path),
            FilePurpose::SaveSession => is_folder || session::is_session(path),
            FilePurpose::OpenPalette | FilePurpose::SavePalette => is_folder || is("toml"),
            FilePurpose::SavePage => is_folder || is("html"),
            FilePurpose::SavePlot(_, extension) => is_folder || is(extension),
        };
        wanted.then(|| Entry {
            path: path.to_path_buf(),
            name,
            is_folder,
            size: data.len(),
        })
    }

    /// Shows the dialog. Returns the command to run, if there is one; clears `open` when it must be
    /// closed.
    pub(crate) fn show(&mut self, ctx: &egui::Context, open: &mut bool) -> Option<Command> {
        let title = match self.purpose {
            FilePurpose::Open => "Open tracings, folders, circuits or a session",
            FilePurpose::Report => "Open a report or spikes of a simulation",
            FilePurpose::Points => {
                "Open a table of points: CSV or TSV with columns x, y and z (µm)"
            }
            FilePurpose::Meshes => "Add meshes that are no cells (coordinates of the scene, µm)",
            FilePurpose::SaveSession => "Save the session",
            FilePurpose::OpenPalette => "Open a palette",
            FilePurpose::SavePalette => "Save the palette",
            FilePurpose::SavePage => "Save a page of what shows, to open in any browser",
            FilePurpose::SavePlot(_, "csv") => "Save the numbers of the plot",
            FilePurpose::SavePlot(..) => "Save the plot",
        };
        let mut done = None;
        let mut stays = *open;
        egui::Window::new(title)
            .id(egui::Id::unique("files"))
            .open(&mut stays)
            .collapsible(false)
            .default_size([620.0, 440.0])
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(ctx.content_rect().center())
            .show(ctx, |ui| {
                self.places(ui);
                ui.separator();
                self.list(ui, &mut done);
                ui.separator();
                self.typed_line(ui, &mut done);
            });
        if ctx.input(|i| i.key_pressed(Key::Escape)) {
            stays = false;
        }
        *open = stays && done.is_none();
        done
    }

    fn places(&mut self, ui: &mut egui::Ui) {
        let mut go = None;
        ui.horizontal_wrapped(|ui| {
            if let Some(parent) = self.folder.parent()
                && ui.button("Up").on_hover_text("The folder above").clicked()
            {
                go = Some(parent.to_path_buf());
            }
            if let Some(dirs) = directories::UserDirs::new()
                && ui.button("Home").clicked()
            {
                go = Some(dirs.home_dir().to_path_buf());
            }
            ui.label(RichText::new(self.folder.display().to_string()).monospace());
        });
        if let Some(folder) = go {
            self.enter(&folder);
            self.type_here();
        }
    }

    /// Sets the typed path to the current folder. What is saved keeps its name.
    fn type_here(&mut self) {
        match (self.purpose, Path::new(&self.typed).file_name()) {
            (purpose, Some(name)) if saves(purpose) => {
                self.typed = self.folder.join(name).display().to_string();
            }
            _ => self.typed.clear(),
        }
    }

    /// Lists what fits the typed path: its folder, and names that begin with its last part. True if
    /// that has changed the typed path.
    fn follow(&mut self) -> bool {
        let (before, begun) = parted(&self.typed);
        let begun = begun.to_owned();
        let folder = paths::whole(Path::new(before), &self.folder);
        let other = fs::canonicalize(&folder).is_ok_and(|folder| folder != self.folder);
        let mut rewritten = false;
        if other && folder.is_dir() {
            if !Path::new(before).is_absolute() && !before.starts_with('~') {
                // The typed path was relative to the folder before, which is no longer shown.
                self.typed = folder.join(&begun).display().to_string();
                rewritten = true;
            }
            self.enter(&folder);
        }
        self.chosen.clear();
        self.begun = begun;
        rewritten
    }

    fn list(&mut self, ui: &mut egui::Ui, done: &mut Option<Command>) {
        let mut enter = None;
        let height = (ui.available_height() - 78.0).max(120.0);
        let entries = self.entries.iter();
        let entries = entries.filter(|entry| goes_on(&entry.name, &self.begun));
        let entries: Vec<Entry> = entries.cloned().collect();
        if entries.is_empty() {
            let says = match (self.begun.is_empty(), self.purpose) {
                (false, _) => "No name here begins like that",
                (true, FilePurpose::SaveSession) => "No folder and no session here yet",
                (true, FilePurpose::SavePalette) => "No folder and no palette here yet",
                (true, FilePurpose::SavePage) => "No folder and no page here yet",
                (true, FilePurpose::SavePlot(..)) => "No folder and no plot here yet",
                (true, _) => "No folder and no file to open here",
            };
            ui.allocate_ui([ui.available_width(), height].into(), |ui| {
                ui.centered_and_justified(|ui| ui.weak(says));
            });
            return;
        }
        let row = ui.spacing().interact_size.y;
        ScrollArea::vertical()
            .max_height(height)
            .auto_shrink(false)
            .show_rows(ui, row, entries.len(), |ui, rows| {
                for entry in &entries[rows] {
                    let slash = if entry.is_folder { "/" } else { "" };
                    let chosen = self.chosen.contains(&entry.path);
                    let text = format!("{}{slash}", entry.name);
                    ui.horizontal(|ui| {
                        let response = ui.selectable_label(chosen, text);
                        if !entry.is_folder {
                            ui.weak(size(entry.size));
                        }
                        if response.double_clicked()
                            || (response.clicked() && entry.is_folder && saves(self.purpose))
                        {
                            enter = Some(entry.clone());
                        } else if response.clicked() {
                            let adds = ui.input(|i| i.modifiers.command || i.modifiers.shift);
                            choose(&mut self.chosen, &entry.path, adds);
                            self.typed = entry.path.display().to_string();
                            self.begun.clear();
                        }
                    });
                }
            });
        match enter {
            Some(entry) if entry.is_folder => {
                self.enter(&entry.path);
                self.type_here();
            }
            Some(entry) => *done = Some(self.command(vec![entry.path])),
            None => {}
        }
    }

    fn typed_line(&mut self, ui: &mut egui::Ui, done: &mut Option<Command>) {
        let hint = "Type or paste a path (Tab completes it), or drop files on the window";
        let names: Vec<Name> = self
            .entries
            .iter()
            .map(|entry| Name {
                name: entry.name.clone(),
                is_folder: entry.is_folder,
            })
            .collect();
        let line = path_line::line(
            &mut self.typed,
            egui::Id::unique("files line"),
            hint,
            |typed| completed(typed, &names),
            ui,
        );
        if line.changed() && self.follow() {
            path_line::to_end(line.id, &self.typed, ui);
        }
        if std::mem::take(&mut self.fresh) {
            line.request_focus();
        }
        let entered = line.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
        ui.horizontal(|ui| {
            let many = self.chosen.len();
            let name = match (self.purpose, many) {
                (FilePurpose::Open, 2..) => format!("Open {many}"),
                (purpose, _) if saves(purpose) => "Save".to_owned(),
                _ => "Open".to_owned(),
            };
            let typed = PathBuf::from(self.typed.trim());
            let enabled = many > 1 || !typed.as_os_str().is_empty();
            let pressed = ui.add_enabled(enabled, egui::Button::new(name)).clicked();
            if enabled && (pressed || entered) {
                let paths = if many > 1 {
                    self.chosen.clone()
                } else {
                    vec![paths::whole(&typed, &self.folder)]
                };
                let saves = saves(self.purpose);
                match paths.iter().find(|p| !saves && !p.exists()) {
                    Some(missing) => self.said = format!("There is no {}", missing.display()),
                    None => *done = Some(self.command(paths)),
                }
            }
            if self.purpose == FilePurpose::Open && ui.button("Open this whole folder").clicked() {
                *done = Some(self.command(vec![self.folder.clone()]));
            }
            ui.colored_label(ui.visuals().warn_fg_color, &self.said);
        });
    }

    fn command(&self, mut paths: Vec<PathBuf>) -> Command {
        match self.purpose {
            FilePurpose::Open => Command::Open(paths),
            FilePurpose::Report => Edit::SetReport(paths.pop()).into(),
            FilePurpose::Points => Command::OpenPoints(paths.pop().unwrap_or_default()),
            FilePurpose::Meshes => Command::OpenMeshes(paths),
            FilePurpose::SaveSession => {
                let named = session_file(&paths.pop().unwrap_or_default());
                Command::SaveSession(named)
            }
            FilePurpose::OpenPalette => Command::OpenPalette(paths.pop().unwrap_or_default()),
            FilePurpose::SavePalette => {
                let path = paths.pop().unwrap_or_default();
                Command::SavePalette(named(&path, "toml", |_| false))
            }
            FilePurpose::SavePage => {
                let path = paths.pop().unwrap_or_default();
                Command::SavePage(named(&path, "html", |_| false))
            }
            FilePurpose::SavePlot(of, extension) => {
                let path = paths.pop().unwrap_or_default();
                let is = |known| {
                    path.extension()
                        .is_some_and(|e| e.eq_ignore_ascii_case(known))
                };
                let path = match is("svg") || is("csv") {
                    true => path,
                    false => named(&path, extension, |_| false),
                };
                Command::SavePlot(of, path)
            }
        }
    }
}

fn saves(purpose: FilePurpose) -> bool {
    matches!(
        purpose,
        FilePurpose::SaveSession
            | FilePurpose::SavePalette
            | FilePurpose::SavePage
            | FilePurpose::SavePlot(..)
    )
}

/// Name of a plot's file, without its extension.
fn plot_name(of: PlotOf) -> &'static str {
    match of {
        PlotOf::Traces => "traces",
        PlotOf::Measure => "measure",
    }
}

fn choose(chosen: &mut Vec<PathBuf>, path: &Path, adds: bool) {
    match chosen.iter().position(|known| known == path) {
        Some(place) if adds => {
            chosen.remove(place);
        }
        _ => {
            if !adds {
                chosen.clear();
            }
            chosen.push(path.to_path_buf());
        }
    }
}

/// A number of bytes as text.
pub(crate) fn size(bytes: u64) -> String {
    let b = bytes as f64;
    match bytes {
        0..1_000 => format!("{bytes} B"),
        1_000..1_000_000 => format!("{:.0} kB", b / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", b / 1e6),
        _ => format!("{:.2} GB", b / 1e9),
    }
}
