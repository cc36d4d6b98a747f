//! The files that commands write: how they are named, and which of them there are already.

use std::fs;
use std::path::{Path, PathBuf};

use neurotess::mesh::Format;

use crate::model::command::Command;
use crate::model::film::length;
use crate::model::save::{FilmOptions, MeshOptions, PictureFile};
use crate::model::session_name::EXTENSION;
use crate::model::state::{Dialog, State};

/// A path with an ending. One of `others` is replaced by it. Whatever else follows a dot is a part of the name:
/// `cell.v2` becomes `cell.v2.ply`.
pub(crate) fn named(path: &Path, ending: &str, others: impl Fn(&Path) -> bool) -> PathBuf {
    let has = path
        .extension()
        .is_some_and(|now| now.eq_ignore_ascii_case(ending));
    match path.file_name() {
        _ if has => path.to_path_buf(),
        None => path.to_path_buf(),
        Some(_) if others(path) => path.with_extension(ending),
        Some(name) => {
            let mut name = name.to_os_string();
            name.push(".");
            name.push(ending);
            path.with_file_name(name)
        }
    }
}

/// A name without what file systems do not take in names.
pub(crate) fn file_name(name: &str) -> String {
    let kept = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    name.chars()
        .map(|c| if kept(c) { c } else { '_' })
        .collect()
}

/// The file of one mesh.
pub(crate) fn mesh_file(path: &Path, format: Format) -> PathBuf {
    named(path, format.extension(), is_mesh)
}

/// The files of one mesh, or those that may be parts of it.
fn files_of_mesh(options: &MeshOptions) -> Vec<PathBuf> {
    let file = mesh_file(&options.out, options.files.format);
    let mut files: Vec<PathBuf> = options
        .fitting()
        .files
        .materials_of(&file)
        .into_iter()
        .collect();
    if !options.files.parts {
        files.push(file);
        return files;
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let beside = fs::read_dir(match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    });
    let stem = format!(
        "{}_",
        file.file_stem().unwrap_or_default().to_string_lossy()
    );
    let is_part = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(&stem) && path.extension() == file.extension()
    };
    let beside = beside.into_iter().flatten().flatten();
    files.extend(beside.map(|entry| entry.path()).filter(is_part));
    files
}

/// The folder of several meshes: without the ending of a file that is named for them.
pub(crate) fn mesh_folder(path: &Path) -> PathBuf {
    match is_mesh(path) {
        true => path.with_extension(""),
        false => path.to_path_buf(),
    }
}

fn is_mesh(path: &Path) -> bool {
    Format::from_extension(path).is_ok()
}

/// The file of a picture.
pub(crate) fn picture_file(path: &Path) -> PathBuf {
    named(path, "png", |_| false)
}

/// The files of a film, or of one picture.
pub(crate) fn film_files(path: &Path, count: usize) -> Vec<PathBuf> {
    let whole = picture_file(path);
    if count == 1 {
        return vec![whole];
    }
    let stem = whole.file_stem().unwrap_or_default();
    let stem = stem.to_string_lossy();
    let file = |i: usize| whole.with_file_name(format!("{stem}_{i:04}.png"));
    (0..count).map(file).collect()
}

/// The video of numbered pictures, by the first of them.
pub(crate) fn video_file(first: &Path) -> PathBuf {
    let name = first.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.strip_suffix("_0000.png").unwrap_or(&name);
    first.with_file_name(format!("{stem}.mp4"))
}

/// The file of a session.
pub(crate) fn session_file(path: &Path) -> PathBuf {
    named(path, EXTENSION, |_| false)
}

impl State {
    /// Requests a command, unless it would replace a file: then the dialog that asks. All that saves goes through
    /// here.
    pub(crate) fn request(&mut self, command: Command) -> Dialog {
        match self.replaces(&command) {
            Some(path) => Dialog::Replace(path, Box::new(replacing(command))),
            None => {
                self.requests.push(command);
                Dialog::Nothing
            }
        }
    }

    /// A file or folder that a command would replace without being allowed to.
    fn replaces(&self, command: &Command) -> Option<PathBuf> {
        let files = match command {
            // What was opened or saved before is what a session is saved to.
            Command::SaveSession(path) if self.is_own_session(path) => Vec::new(),
            Command::SaveSession(path)
            | Command::SavePalette(path)
            | Command::SavePage(path)
            | Command::SavePlot(_, path) => vec![path.clone()],
            Command::SaveMeshes(meshes) if !meshes.replace => match self.mesh_count(meshes.all) {
                1 => files_of_mesh(meshes),
                _ => vec![mesh_folder(&meshes.out)],
            },
            Command::SavePicture(picture) if !picture.replace => vec![picture_file(&picture.out)],
            Command::SaveFilm(film) if !film.picture.replace => {
                let over_time = film.time.is_some() && self.playback.facts.is_some();
                let count = length(self.views.key_views.len(), film.frames, over_time);
                let mut files = film_files(&film.picture.out, count);
                let video = files.first().filter(|_| film.video && count > 1);
                files.extend(video.map(|first| video_file(first)));
                files
            }
            _ => Vec::new(),
        };
        files.into_iter().find(|file| file.exists())
    }

    fn is_own_session(&self, path: &Path) -> bool {
        let whole = |path: &Path| fs::canonicalize(path).ok();
        let own = self.session.as_deref();
        own.is_some_and(|own| own == path || whole(own).is_some_and(|own| whole(path) == Some(own)))
    }

    /// What files are named after by themselves: the one cell that is selected or shown, or all of them.
    pub(crate) fn usual_name(&self) -> String {
        let neurons = &self.document.neurons;
        let only = (neurons.len() == 1).then_some(0);
        let one = neurons.selected().only().or(only);
        let one = one.and_then(|one| neurons.get(one));
        let name = one.map_or("neurons", |neuron| &neuron.name);
        file_name(name)
    }

    /// Number of meshes that are written.
    pub(crate) fn mesh_count(&self, all: bool) -> usize {
        let neurons = &self.document.neurons;
        match all {
            true => self.shown(),
            false => neurons.selected().len(),
        }
    }
}

/// The command that may replace its files.
fn replacing(command: Command) -> Command {
    let picture = |picture| PictureFile {
        replace: true,
        ..picture
    };
    match command {
        Command::SaveMeshes(meshes) => Command::SaveMeshes(MeshOptions {
            replace: true,
            ..meshes
        }),
        Command::SavePicture(options) => Command::SavePicture(picture(options)),
        Command::SaveFilm(film) => Command::SaveFilm(FilmOptions {
            picture: picture(film.picture),
            ..film
        }),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::command::{Edit, PlotOf};
    use crate::model::document::{Neuron, SourceId};
    use crate::model::settings::Settings;
    use crate::model::view::View;

    #[test]
    fn an_ending_is_added_and_replaces_no_part_of_a_name() {
        let mesh = |name: &str| mesh_file(Path::new(name), Format::Ply);
        for (typed, named) in [
            ("a/cell.v2", "a/cell.v2.ply"),
            ("a.b/cell", "a.b/cell.ply"),
            ("m1.CNG", "m1.CNG.ply"),
            ("cell.ply", "cell.ply"),
            ("cell.PLY", "cell.PLY"),
            ("cell.v2.stl", "cell.v2.ply"),
            ("", ""),
        ] {
            assert_eq!(mesh(typed), Path::new(named), "{typed}");
        }
        assert_eq!(mesh_folder(Path::new("all.v2")), Path::new("all.v2"));
        assert_eq!(mesh_folder(Path::new("all.v2.ply")), Path::new("all.v2"));
        let picture = |name: &str| picture_file(Path::new(name));
        assert_eq!(picture("cell.v2"), Path::new("cell.v2.png"));
        let film = film_files(Path::new("f/cell.v2"), 2);
        assert_eq!(film[1], Path::new("f/cell.v2_0001.png"));
        assert_eq!(video_file(&film[0]), Path::new("f/cell.v2.mp4"));
        let session = |name: &str| session_file(Path::new(name));
        assert_eq!(session("cell.v2"), Path::new("cell.v2.neurotess"));
    }

    fn every_kind(state: &State, folder: &Path) -> Vec<(PathBuf, Command)> {
        let at = |name: &str| folder.join(name);
        let (mesh, picture) = (state.save.mesh.clone(), state.save.picture.clone());
        let meshes = |out, all| {
            Command::SaveMeshes(MeshOptions {
                out,
                all,
                ..mesh.clone()
            })
        };
        let picture = |out| PictureFile {
            out,
            ..picture.clone()
        };
        let film = |frames, video| {
            Command::SaveFilm(FilmOptions {
                picture: picture(at("film.v2")),
                frames,
                time: None,
                video,
            })
        };
        vec![
            (at("a.neurotess"), Command::SaveSession(at("a.neurotess"))),
            (at("a.toml"), Command::SavePalette(at("a.toml"))),
            (at("a.svg"), Command::SavePlot(PlotOf::Measure, at("a.svg"))),
            (at("one.v2.ply"), meshes(at("one.v2"), false)),
            (at("all.v2"), meshes(at("all.v2"), true)),
            (at("a.v2.png"), Command::SavePicture(picture(at("a.v2")))),
            (at("film.v2_0000.png"), film(2, false)),
            (at("film.v2_0002.png"), film(2, false)),
            (at("film.v2.mp4"), film(2, true)),
        ]
    }

    #[test]
    fn whatever_is_saved_asks_before_it_replaces() {
        let mut state = State::new(Settings::default());
        for i in 0..2 {
            let neuron = Neuron::new(SourceId(i), format!("n{i}"));
            state.document.neurons.push(neuron);
        }
        state.run(Edit::Select(vec![0], false));
        state.views.key_views = vec![View::default(), View::default()];
        let folder = tempfile::tempdir().expect("a folder");
        for (file, command) in every_kind(&state, folder.path()) {
            assert!(matches!(state.request(command.clone()), Dialog::Nothing));
            assert_eq!(state.requests.pop(), Some(command.clone()));
            fs::write(&file, "kept").expect("written");
            let Dialog::Replace(which, then) = state.request(command) else {
                panic!("{} is replaced unasked", file.display());
            };
            assert_eq!(which, file);
            assert!(state.requests.is_empty());
            fs::remove_file(&file).expect("removed");
            // The answer runs, and asks no more.
            fs::write(&file, "kept").expect("written");
            if matches!(
                *then,
                Command::SaveMeshes(_) | Command::SavePicture(_) | Command::SaveFilm(_)
            ) {
                assert!(state.replaces(&then).is_none());
            }
            fs::remove_file(&file).expect("removed");
        }
    }

    #[test]
    fn a_session_is_saved_to_its_own_file_without_a_question() {
        let folder = tempfile::tempdir().expect("a folder");
        let own = folder.path().join("own.neurotess");
        fs::write(&own, "").expect("written");
        let mut state = State::new(Settings::default());
        state.session = Some(own.clone());
        let same = folder.path().join(".").join("own.neurotess");
        assert!(state.replaces(&Command::SaveSession(same)).is_none());
        state.session = None;
        assert_eq!(
            state.replaces(&Command::SaveSession(own.clone())),
            Some(own)
        );
    }
}
