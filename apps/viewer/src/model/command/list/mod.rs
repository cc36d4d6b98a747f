//! The commands of the menus and the palette: a file for each menu.

mod edit;
mod file;
mod help;
mod view;
mod window;

use std::borrow::Cow;

use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use neurotess::synth::Kind;

use super::{Command, Edit};
use crate::model::document::{SpineEdit, SpinePlaces};

/// A command of the menus and the palette.
pub struct Listed {
    /// Its title.
    pub title: Cow<'static, str>,
    /// Words by which people look for it, beside those of its title.
    pub words: &'static str,
    /// Its shortcut.
    pub keys: Option<KeyboardShortcut>,
    /// The command.
    pub command: Command,
    /// Whether a group of the menu begins with it.
    pub begins: bool,
}

const PLAIN: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::COMMAND
};

/// All commands that need no further input, by menu. `now`: the state that titles depend on.
pub fn listed(now: &Toggles) -> Vec<(&'static str, Vec<Listed>)> {
    let samples = Kind::ALL.into_iter().zip(SAMPLE_TITLES);
    let samples = samples.map(|(kind, title)| item(title, None, Command::OpenSample(kind)));
    vec![
        ("File", file::menu()),
        ("Samples", samples.collect()),
        ("Edit", edit::menu(now)),
        ("View", view::menu(now)),
        ("Window", window::menu(now)),
        ("Help", help::menu()),
    ]
}

/// A line of a menu. After its title, and a bar, there may be words by which people look for it.
fn item(title: &'static str, keys: Option<(Modifiers, Key)>, command: Command) -> Listed {
    let (title, words) = title.split_once(" | ").unwrap_or((title, ""));
    Listed {
        title: title.into(),
        words,
        keys: keys.map(|(modifiers, key)| KeyboardShortcut::new(modifiers, key)),
        command,
        begins: false,
    }
}

/// The first of a group of a menu.
fn first(title: &'static str, keys: Option<(Modifiers, Key)>, command: Command) -> Listed {
    Listed {
        begins: true,
        ..item(title, keys, command)
    }
}

/// One of two titles.
fn choose(on: bool, to_on: &'static str, to_off: &'static str) -> &'static str {
    if on { to_off } else { to_on }
}

/// Grows spines at places.
fn grow(places: SpinePlaces) -> Command {
    Edit::GrowSpines(Some(SpineEdit::at(places))).into()
}

/// Saved views that have a key. Menus show those that there are, by their names.
const SAVED_VIEWS: [(&str, Key); 5] = [
    ("Saved view 1", Key::Num5),
    ("Saved view 2", Key::Num6),
    ("Saved view 3", Key::Num7),
    ("Saved view 4", Key::Num8),
    ("Saved view 5", Key::Num9),
];

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
    /// Whether there is no perspective.
    pub orthographic: bool,
    /// Whether y points down.
    pub y_down: bool,
    /// Whether neurons are side by side.
    pub grid: bool,
    /// Whether levels are frozen.
    pub frozen: bool,
    /// Whether circuits have caches.
    pub caches: bool,
    /// Whether the theme is dark.
    pub dark: bool,
    /// Whether a recording is playing.
    pub playing: bool,
    /// Whether clicks measure.
    pub measuring: bool,
    /// Whether synapses are shown.
    pub synapses: bool,
    /// Whether synapses are drawn with contact discs.
    pub contacts: bool,
    /// Whether values over time are plotted.
    pub traces: bool,
    /// Whether places where surfaces cross themselves are listed.
    pub crossings: bool,
    /// Whether a drag that selects draws a lasso.
    pub lasso: bool,
    /// Whether all selected neurons are clamped.
    pub clamped: bool,
    /// Whether handles move and turn the selected cells.
    pub placing: bool,
    /// Whether the window presents.
    pub presenting: bool,
    /// Whether there are two views.
    pub split: bool,
    /// Whether they move together.
    pub linked: bool,
    /// Whether the scene turns.
    pub turning: bool,
    /// Whether it fills the screen.
    pub full_screen: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_are_short_and_have_no_words_to_look_for() {
        for (menu, items) in listed(&Toggles::default()) {
            for item in items {
                assert!(item.title.len() <= 56, "{menu}: {}", item.title);
                assert!(!item.title.contains('|') && !item.words.contains('|'));
            }
        }
    }

    #[test]
    fn no_keys_are_used_twice() {
        for (measuring, presenting) in [(false, false), (true, false), (false, true), (true, true)]
        {
            let menus = listed(&Toggles {
                measuring,
                presenting,
                ..Toggles::default()
            });
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
}
