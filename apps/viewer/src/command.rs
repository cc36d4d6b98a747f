//! What one can do, as values: menus, shortcuts, the palette and tests share one list.

use std::path::PathBuf;

use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use neurotess::render::Side;
use neurotess::synth::Kind;

use crate::document::{Detail, Document, Look, SomaEdit, SourceId};
use crate::save::{FilmOptions, MeshOptions, PictureFile};
use crate::view::View;

/// One of the panels on the right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// What is selected.
    #[default]
    Inspect,
    /// How somata are made.
    Soma,
    /// Colours and light.
    Look,
    /// How finely.
    Detail,
    /// Meshes, pictures, films.
    Save,
}

impl Tab {
    /// All, with their names.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Inspect, "Inspect"),
        (Self::Soma, "Soma"),
        (Self::Look, "Look"),
        (Self::Detail, "Detail"),
        (Self::Save, "Save"),
    ];
}

/// What files are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// Tracings, circuits, folders, sessions.
    Open,
    /// Where a session goes.
    SaveSession,
}

/// Something to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Shows the file panel.
    AskFiles(Ask),
    /// Reads files, folders, circuits, a session.
    Open(Vec<PathBuf>),
    /// Grows a built-in sample.
    OpenSample(Kind),
    /// Reads files that changed again.
    Reload,
    /// Writes a session.
    SaveSession(PathBuf),
    /// Ends reading or saving.
    Cancel,
    /// Leaves the program.
    Quit,

    /// The one before the last edit.
    Undo,
    /// The one after it.
    Redo,

    /// Selects these, and nothing else unless `add`; what is already selected is dropped then.
    Select(Vec<usize>, bool),
    /// Selects all that is shown.
    SelectAll,
    /// Selects nothing.
    SelectNone,
    /// Selects what is not selected.
    SelectOthers,
    /// Hides what is selected.
    Hide,
    /// Shows only what is selected.
    Isolate,
    /// Shows all.
    ShowAll,
    /// Hides or shows one.
    SetHidden(usize, bool),
    /// Takes what is selected out of the list.
    Remove,
    /// Makes somata in another way.
    SetSoma(Vec<SourceId>, SomaEdit),
    /// Colours and light.
    SetLook(Box<Look>),
    /// How finely.
    SetDetail(Detail),
    /// Side by side, or where traced.
    SetGrid(bool),

    /// Goes to a side.
    Look(Side),
    /// All in the picture, from the front.
    Home,
    /// What is selected in the picture.
    Focus,
    /// Goes to a view.
    Go(View),
    /// Which way y runs.
    SetYDown(bool),
    /// Levels as they are now, whatever the view.
    SetFrozen(bool),

    /// Shows a panel.
    Show(Tab),
    /// The sheet of keys.
    ToggleKeys,
    /// All commands, to search.
    TogglePalette,
    /// What went wrong.
    ToggleProblems,
    /// Dark or light.
    SetDark(bool),
    /// Both side panels.
    TogglePanels,

    /// Writes meshes.
    SaveMeshes(MeshOptions),
    /// Writes a picture.
    SavePicture(PictureFile),
    /// Keeps the view for a film.
    AddKeyView,
    /// Forgets a view of the film.
    DropKeyView(usize),
    /// Writes a film.
    SaveFilm(FilmOptions),
}

impl Command {
    /// What an undo of it is called; none: it is no edit.
    pub fn edit(&self) -> Option<&'static str> {
        Some(match self {
            Self::Select(..) | Self::SelectAll | Self::SelectNone | Self::SelectOthers => "Select",
            Self::Hide | Self::SetHidden(_, true) => "Hide",
            Self::Isolate => "Isolate",
            Self::ShowAll | Self::SetHidden(_, false) => "Show",
            Self::Remove => "Remove",
            Self::SetSoma(..) => "Soma",
            Self::SetLook(_) => "Look",
            Self::SetDetail(_) => "Detail",
            Self::SetGrid(_) => "Grid",
            _ => return None,
        })
    }

    /// Whether several in a row are one edit: a slider that is dragged.
    pub fn joins(&self) -> bool {
        matches!(
            self,
            Self::SetSoma(..) | Self::SetLook(_) | Self::SetDetail(_)
        )
    }

    /// Does an edit.
    pub fn apply(self, document: &mut Document) {
        let neurons = &mut document.neurons;
        match self {
            Self::Select(which, add) => {
                let is = |i: usize| which.contains(&i);
                // Adding what is there already takes it away.
                let all = which
                    .iter()
                    .all(|&i| neurons.get(i).is_some_and(|n| n.selected));
                for (i, neuron) in neurons.iter_mut().enumerate() {
                    neuron.selected = match add {
                        true if is(i) => !all,
                        true => neuron.selected,
                        false => is(i),
                    };
                }
            }
            Self::SelectAll => neurons.iter_mut().for_each(|n| n.selected = !n.hidden),
            Self::SelectNone => neurons.iter_mut().for_each(|n| n.selected = false),
            Self::SelectOthers => neurons
                .iter_mut()
                .for_each(|n| n.selected = !n.selected && !n.hidden),
            Self::Hide => {
                for neuron in neurons.iter_mut().filter(|n| n.selected) {
                    (neuron.hidden, neuron.selected) = (true, false);
                }
            }
            Self::Isolate if neurons.iter().any(|n| n.selected) => {
                neurons.iter_mut().for_each(|n| n.hidden = !n.selected);
            }
            Self::ShowAll => neurons.iter_mut().for_each(|n| n.hidden = false),
            Self::SetHidden(which, hidden) => {
                if let Some(neuron) = neurons.get_mut(which) {
                    neuron.hidden = hidden;
                    neuron.selected &= !hidden;
                }
            }
            Self::Remove => neurons.retain(|n| !n.selected),
            Self::SetSoma(sources, edit) => {
                for source in sources {
                    document.set_soma(source, edit);
                }
            }
            Self::SetLook(look) => document.look = *look,
            Self::SetDetail(detail) => document.detail = detail,
            Self::SetGrid(grid) => document.grid = grid,
            _ => {}
        }
    }
}

/// A command that stands in menus and the palette.
pub struct Listed {
    /// What it is called.
    pub title: &'static str,
    /// The keys for it.
    pub keys: Option<KeyboardShortcut>,
    /// It.
    pub command: Command,
}

const PLAIN: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::COMMAND
};

/// All commands that need nothing more said, by menu. `y_down` and so on: as they are now.
pub fn listed(now: &Toggles) -> Vec<(&'static str, Vec<Listed>)> {
    let item = |title, keys: Option<(Modifiers, Key)>, command| Listed {
        title,
        keys: keys.map(|(modifiers, key)| KeyboardShortcut::new(modifiers, key)),
        command,
    };
    let samples = Kind::ALL.into_iter().zip(SAMPLE_TITLES);
    let samples = samples.map(|(kind, title)| item(title, None, Command::OpenSample(kind)));
    let choose =
        |on: bool, to_on: &'static str, to_off: &'static str| if on { to_off } else { to_on };
    vec![
        (
            "File",
            vec![
                item("Open…", Some((CTRL, Key::O)), Command::AskFiles(Ask::Open)),
                item(
                    "Save session…",
                    Some((CTRL, Key::S)),
                    Command::AskFiles(Ask::SaveSession),
                ),
                item(
                    "Save mesh, picture or film…",
                    Some((CTRL, Key::E)),
                    Command::Show(Tab::Save),
                ),
                item(
                    "Reload changed files",
                    Some((CTRL, Key::R)),
                    Command::Reload,
                ),
                item("Stop reading or saving", None, Command::Cancel),
                item("Quit", Some((CTRL, Key::Q)), Command::Quit),
            ],
        ),
        ("Samples", samples.collect()),
        (
            "Edit",
            vec![
                item("Undo", Some((CTRL, Key::Z)), Command::Undo),
                item("Redo", Some((CTRL_SHIFT, Key::Z)), Command::Redo),
                item("Select all", Some((CTRL, Key::A)), Command::SelectAll),
                item(
                    "Select none",
                    Some((PLAIN, Key::Escape)),
                    Command::SelectNone,
                ),
                item(
                    "Select the others",
                    Some((CTRL, Key::I)),
                    Command::SelectOthers,
                ),
                item(
                    "Remove selected from the list",
                    Some((PLAIN, Key::Delete)),
                    Command::Remove,
                ),
            ],
        ),
        (
            "View",
            vec![
                item(
                    "Home: everything, from the front",
                    Some((PLAIN, Key::Home)),
                    Command::Home,
                ),
                item(
                    "Focus on the selection",
                    Some((PLAIN, Key::F)),
                    Command::Focus,
                ),
                item(
                    "Front",
                    Some((PLAIN, Key::Num1)),
                    Command::Look(Side::Front),
                ),
                item(
                    "Right",
                    Some((PLAIN, Key::Num2)),
                    Command::Look(Side::Right),
                ),
                item("Top", Some((PLAIN, Key::Num3)), Command::Look(Side::Top)),
                item("Back", Some((CTRL, Key::Num1)), Command::Look(Side::Back)),
                item("Left", Some((CTRL, Key::Num2)), Command::Look(Side::Left)),
                item(
                    "Bottom",
                    Some((CTRL, Key::Num3)),
                    Command::Look(Side::Bottom),
                ),
                item(
                    "From a corner",
                    Some((PLAIN, Key::Num4)),
                    Command::Look(Side::Iso),
                ),
                item("Hide selected", Some((PLAIN, Key::H)), Command::Hide),
                item("Isolate selected", Some((PLAIN, Key::I)), Command::Isolate),
                item("Show all", Some((CTRL, Key::H)), Command::ShowAll),
                item(
                    choose(
                        now.y_down,
                        "Let y run down (electron microscopy)",
                        "Let y run up",
                    ),
                    Some((PLAIN, Key::Y)),
                    Command::SetYDown(!now.y_down),
                ),
                item(
                    choose(
                        now.grid,
                        "Lay out side by side",
                        "Put where they were traced",
                    ),
                    Some((PLAIN, Key::G)),
                    Command::SetGrid(!now.grid),
                ),
                item(
                    choose(
                        now.frozen,
                        "Freeze the level of detail",
                        "Thaw the level of detail",
                    ),
                    Some((CTRL, Key::F)),
                    Command::SetFrozen(!now.frozen),
                ),
                item(
                    "Keep this view for a film",
                    Some((PLAIN, Key::K)),
                    Command::AddKeyView,
                ),
            ],
        ),
        (
            "Window",
            vec![
                item(
                    "Inspect",
                    Some((CTRL_SHIFT, Key::I)),
                    Command::Show(Tab::Inspect),
                ),
                item(
                    "Soma editor",
                    Some((CTRL_SHIFT, Key::S)),
                    Command::Show(Tab::Soma),
                ),
                item("Look", Some((CTRL_SHIFT, Key::L)), Command::Show(Tab::Look)),
                item(
                    "Level of detail",
                    Some((CTRL_SHIFT, Key::D)),
                    Command::Show(Tab::Detail),
                ),
                item(
                    choose(now.dark, "Dark theme", "Light theme"),
                    None,
                    Command::SetDark(!now.dark),
                ),
                item(
                    "Show or hide the panels",
                    Some((PLAIN, Key::Tab)),
                    Command::TogglePanels,
                ),
                item("What went wrong", None, Command::ToggleProblems),
            ],
        ),
        (
            "Help",
            vec![
                item(
                    "Find a command…",
                    Some((CTRL, Key::P)),
                    Command::TogglePalette,
                ),
                item(
                    "Keys and mouse",
                    Some((PLAIN, Key::Questionmark)),
                    Command::ToggleKeys,
                ),
            ],
        ),
    ]
}

const SAMPLE_TITLES: [&str; 6] = [
    "Pyramidal cell",
    "Purkinje cell",
    "Granule cell",
    "Basket cell",
    "Motor neuron",
    "Star-shaped interneuron",
];

/// What titles of commands depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Toggles {
    /// y runs down.
    pub y_down: bool,
    /// Side by side.
    pub grid: bool,
    /// Levels are frozen.
    pub frozen: bool,
    /// Dark theme.
    pub dark: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Neuron;

    fn document() -> Document {
        let neuron = |i| Neuron::new(SourceId(i), format!("n{i}"));
        Document {
            neurons: (0..4).map(neuron).collect(),
            ..Document::default()
        }
    }

    fn selected(document: &Document) -> Vec<usize> {
        document.selected().collect()
    }

    #[test]
    fn shift_adds_and_takes_away() {
        let mut doc = document();
        Command::Select(vec![1], false).apply(&mut doc);
        Command::Select(vec![2, 3], true).apply(&mut doc);
        assert_eq!(selected(&doc), [1, 2, 3]);
        Command::Select(vec![2], true).apply(&mut doc);
        assert_eq!(selected(&doc), [1, 3]);
        Command::Select(vec![0], false).apply(&mut doc);
        assert_eq!(selected(&doc), [0]);
    }

    #[test]
    fn what_is_hidden_is_not_selected() {
        let mut doc = document();
        Command::Select(vec![1, 2], false).apply(&mut doc);
        Command::Hide.apply(&mut doc);
        assert!(doc.neurons[1].hidden && selected(&doc).is_empty());
        Command::SelectAll.apply(&mut doc);
        assert_eq!(selected(&doc), [0, 3]);
        Command::Isolate.apply(&mut doc);
        Command::ShowAll.apply(&mut doc);
        assert!(doc.neurons.iter().all(|n| !n.hidden));
        Command::Remove.apply(&mut doc);
        assert_eq!(doc.neurons.len(), 2);
    }

    #[test]
    fn no_keys_are_used_twice() {
        let menus = listed(&Toggles::default());
        let keys: Vec<_> = menus
            .iter()
            .flat_map(|(_, items)| items)
            .filter_map(|i| i.keys)
            .collect();
        for (i, a) in keys.iter().enumerate() {
            assert!(!keys[..i].contains(a), "{a:?}");
        }
    }
}
