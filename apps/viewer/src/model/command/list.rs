//! The commands of the menus and the palette.

use std::borrow::Cow;

use eframe::egui::{Key, KeyboardShortcut, Modifiers};
use neurotess::render::Side;
use neurotess::synth::Kind;

use super::{Command, Edit, FilePurpose, PlotOf, Tab};
use crate::model::document::{SpineEdit, SpinePlaces};

/// A command of the menus and the palette.
pub struct Listed {
    /// Its title.
    pub title: Cow<'static, str>,
    /// Its shortcut.
    pub keys: Option<KeyboardShortcut>,
    /// The command.
    pub command: Command,
}

const PLAIN: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers {
    shift: true,
    ..Modifiers::COMMAND
};

/// All commands that need no further input, by menu. `now`: the state that titles depend on.
pub fn listed(now: &Toggles) -> Vec<(&'static str, Vec<Listed>)> {
    let item = |title: &'static str, keys: Option<(Modifiers, Key)>, command| Listed {
        title: title.into(),
        keys: keys.map(|(modifiers, key)| KeyboardShortcut::new(modifiers, key)),
        command,
    };
    let grow = |places| Command::from(Edit::GrowSpines(Some(SpineEdit::at(places))));
    let samples = Kind::ALL.into_iter().zip(SAMPLE_TITLES);
    let samples = samples.map(|(kind, title)| item(title, None, Command::OpenSample(kind)));
    let choose =
        |on: bool, to_on: &'static str, to_off: &'static str| if on { to_off } else { to_on };
    vec![
        (
            "File",
            vec![
                item(
                    "Open…",
                    Some((CTRL, Key::O)),
                    Command::AskFiles(FilePurpose::Open),
                ),
                item(
                    "Open report or spikes…",
                    Some((CTRL_SHIFT, Key::O)),
                    Command::AskFiles(FilePurpose::Report),
                ),
                item("Close the report", None, Edit::SetReport(None).into()),
                item(
                    "Open points (a table of markers)…",
                    None,
                    Command::AskFiles(FilePurpose::Points),
                ),
                item(
                    "Close the points (markers)",
                    None,
                    Edit::SetPoints(None).into(),
                ),
                item(
                    "Add a mesh (brain region, segment, pipette)…",
                    None,
                    Command::AskFiles(FilePurpose::Meshes),
                ),
                item("Remove all meshes", None, Edit::ClearMeshes.into()),
                item(
                    "Save session…",
                    Some((CTRL, Key::S)),
                    Command::AskFiles(FilePurpose::SaveSession),
                ),
                item(
                    "Open palette…",
                    None,
                    Command::AskFiles(FilePurpose::OpenPalette),
                ),
                item(
                    "Save palette…",
                    None,
                    Command::AskFiles(FilePurpose::SavePalette),
                ),
                item(
                    "Save the plot of traces (SVG)…",
                    None,
                    Command::AskFiles(FilePurpose::SavePlot(PlotOf::Traces, "svg")),
                ),
                item(
                    "Save the values of traces (CSV)…",
                    None,
                    Command::AskFiles(FilePurpose::SavePlot(PlotOf::Traces, "csv")),
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
                item("Select all", Some((CTRL, Key::A)), Edit::SelectAll.into()),
                item(
                    "Select none",
                    // While measuring or presenting, Escape leaves that.
                    (!now.measuring && !now.presenting).then_some((PLAIN, Key::Escape)),
                    Edit::SelectNone.into(),
                ),
                item(
                    "Invert the selection",
                    Some((CTRL, Key::I)),
                    Edit::SelectOthers.into(),
                ),
                item(
                    choose(
                        now.lasso,
                        "Select with a lasso (Ctrl + drag, freehand)",
                        "Select with a rectangle (Ctrl + drag, box)",
                    ),
                    Some((PLAIN, Key::L)),
                    Command::SetLasso(!now.lasso),
                ),
                item(
                    choose(
                        now.placing,
                        "Move and turn selected (handles, gizmo, translate, rotate)",
                        "Stop moving and turning (handles, gizmo)",
                    ),
                    Some((PLAIN, Key::P)),
                    Command::SetPlacing(!now.placing),
                ),
                item(
                    "Position and rotation of selected (numbers, coordinates, angles)…",
                    None,
                    Command::Show(Tab::Inspect),
                ),
                item(
                    "Duplicate selected (copy of a cell)",
                    Some((CTRL, Key::D)),
                    Command::Duplicate,
                ),
                item(
                    "Put selected back where they were traced",
                    None,
                    Command::PutBack,
                ),
                item(
                    "Remove selected from the list",
                    Some((PLAIN, Key::Delete)),
                    Edit::Remove.into(),
                ),
                item(
                    choose(
                        now.measuring,
                        "Measure: distance, path length, diameter, angle (ruler)",
                        "Stop measuring",
                    ),
                    Some((PLAIN, Key::M)),
                    Command::SetMeasuring(!now.measuring),
                ),
                item(
                    "Copy all dimensions",
                    Some((CTRL_SHIFT, Key::C)),
                    Command::CopyDimensions(None),
                ),
                item("Remove all dimensions", None, Edit::ClearDimensions.into()),
                item(
                    "Grow spines at random (1 for each µm of dendrites)",
                    None,
                    grow(SpinePlaces::Random),
                ),
                item(
                    "Grow the spines that the file tells of (ASC, H5)",
                    None,
                    grow(SpinePlaces::File),
                ),
                item(
                    "Grow spines at synapses (inputs of a circuit's cell)",
                    None,
                    grow(SpinePlaces::Synapses),
                ),
                item("Remove spines", None, Edit::GrowSpines(None).into()),
                item(
                    "Remove all traces of the plot",
                    None,
                    Edit::ClearTraces.into(),
                ),
            ]
            .into_iter()
            .chain((now.measuring && !now.presenting).then(|| {
                item(
                    "Forget the first place, or stop measuring",
                    Some((PLAIN, Key::Escape)),
                    Command::LeaveMeasuring,
                )
            }))
            .collect(),
        ),
        (
            "View",
            [
                item(
                    "Home: everything, from the front",
                    Some((PLAIN, Key::Home)),
                    Command::Home,
                ),
                item(
                    "Zoom to the selection",
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
                item(
                    choose(
                        now.orthographic,
                        "Orthographic: parallel projection, true scale bar",
                        "Perspective projection (off: orthographic, parallel, true scale bar)",
                    ),
                    Some((PLAIN, Key::O)),
                    Command::SetOrthographic(!now.orthographic),
                ),
                item("Hide selected", Some((PLAIN, Key::H)), Edit::Hide.into()),
                item(
                    "Isolate selected",
                    Some((PLAIN, Key::I)),
                    Edit::Isolate.into(),
                ),
                item("Show all", Some((CTRL, Key::H)), Edit::ShowAll.into()),
                item(
                    choose(
                        now.clamped,
                        "Clamp selected: fine while moving (pin)",
                        "Unclamp selected (unpin)",
                    ),
                    Some((PLAIN, Key::C)),
                    Edit::Clamp(!now.clamped).into(),
                ),
                item("Unclamp all (unpin)", None, Edit::UnclampAll.into()),
                item(
                    choose(now.y_down, "y axis down (electron microscopy)", "y axis up"),
                    Some((PLAIN, Key::Y)),
                    Command::SetYDown(!now.y_down),
                ),
                item(
                    choose(now.grid, "Lay out side by side", "Place as traced"),
                    Some((PLAIN, Key::G)),
                    Edit::SetGrid(!now.grid).into(),
                ),
                item(
                    choose(
                        now.frozen,
                        "Freeze the level of detail",
                        "Unfreeze the level of detail",
                    ),
                    Some((CTRL, Key::F)),
                    Command::SetFrozen(!now.frozen),
                ),
                item(
                    choose(
                        now.split,
                        "Two views side by side (split)",
                        "One view (unsplit)",
                    ),
                    Some((PLAIN, Key::B)),
                    Command::SetSplit(!now.split),
                ),
                item(
                    choose(
                        now.linked,
                        "Link the two views: they move together",
                        "Unlink the two views",
                    ),
                    Some((CTRL, Key::B)),
                    Command::SetLinked(!now.linked),
                ),
                item(
                    choose(
                        now.turning,
                        "Turntable: turn the scene slowly (spin)",
                        "Stop the turntable (spin)",
                    ),
                    Some((PLAIN, Key::R)),
                    Command::SetTurning(!now.turning),
                ),
                item(
                    choose(
                        now.synapses,
                        "Show synapses (contacts, edges; markers)",
                        "Hide synapses (contacts, edges; markers)",
                    ),
                    Some((PLAIN, Key::X)),
                    Edit::ShowSynapses(!now.synapses).into(),
                ),
                item(
                    choose(
                        now.contacts,
                        "Draw synapses as contact discs (boutons, on the membrane)",
                        "Draw synapses as spheres, without contact discs",
                    ),
                    None,
                    Edit::ShowContacts(!now.contacts).into(),
                ),
                item(
                    choose(now.playing, "Play the report", "Stop the report"),
                    Some((PLAIN, Key::Space)),
                    Command::TogglePlay,
                ),
                item(
                    "Previous frame",
                    Some((PLAIN, Key::Comma)),
                    Command::StepTime(-1),
                ),
                item(
                    "Next frame",
                    Some((PLAIN, Key::Period)),
                    Command::StepTime(1),
                ),
                item(
                    choose(
                        now.traces,
                        "Plot values over time (traces, voltage, time course)",
                        "Close the plot of values over time (traces, voltage)",
                    ),
                    Some((PLAIN, Key::T)),
                    Command::ShowTraces(!now.traces),
                ),
                item(
                    choose(
                        now.crossings,
                        "List crossings (self-intersections of the surface)",
                        "Close the list of crossings (self-intersections)",
                    ),
                    None,
                    Command::ListCrossings(!now.crossings),
                ),
                item(
                    "Keep this view for a film",
                    Some((PLAIN, Key::K)),
                    Command::AddKeyView,
                ),
                item(
                    "Save this view under a name (5 to 9 go to the first)",
                    Some((PLAIN, Key::V)),
                    Command::SaveView,
                ),
            ]
            .into_iter()
            .chain((0..).zip(SAVED_VIEWS).map(|(index, (title, key))| {
                item(title, Some((PLAIN, key)), Command::GoSaved(index))
            }))
            .collect(),
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
                    choose(
                        now.caches,
                        "Keep caches of circuits",
                        "Keep no caches of circuits",
                    ),
                    None,
                    Command::SetCaches(!now.caches),
                ),
                item(
                    choose(now.full_screen, "Full screen", "Leave the full screen"),
                    Some((PLAIN, Key::F11)),
                    Command::SetFullScreen(!now.full_screen),
                ),
                item(
                    choose(
                        now.presenting,
                        "Presentation: full screen, no panels, turntable",
                        "End the presentation (turntable)",
                    ),
                    Some((PLAIN, Key::F5)),
                    Command::SetPresenting(!now.presenting),
                ),
                item(
                    "Show or hide the panels",
                    Some((PLAIN, Key::Tab)),
                    Command::TogglePanels,
                ),
                item("What went wrong", None, Command::ToggleProblems),
            ]
            .into_iter()
            .chain(now.presenting.then(|| {
                item(
                    "Leave the presentation",
                    Some((PLAIN, Key::Escape)),
                    Command::SetPresenting(false),
                )
            }))
            .collect(),
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
