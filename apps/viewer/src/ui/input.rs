//! Handles events of keys and mouse in their order, whatever the frame rate.
//!
//! During one slow frame there may be a whole drag, or a shortcut and the text that was typed after
//! it. egui handles all events of a frame as if they were simultaneous: the drag would be lost, and
//! the text would go to what had the keyboard before. So events wait in a queue, and a frame gets
//! those up to the next one that changes the meaning of later ones: a mouse button, a shortcut that
//! opens a dialog, Enter in a line of text.
//!
//! The rest does not wait for the next frame, which may be a second away, but for the next pass of the same frame:
//! egui lays the window out again and shows only the last pass. Until then no picture is drawn.
//!
//! Shortcuts are found here too. They must match exactly: Ctrl+Shift+Z is not Ctrl+Z.

use std::collections::VecDeque;
use std::num::NonZeroUsize;

use eframe::egui::{
    self, Context, Event, FullOutput, Key, KeyboardShortcut, Modifiers, Plugin, RawInput,
    RepaintCause,
};

use crate::model::command::{Command, Toggles, listed};
use crate::model::state::Dialog;

/// Time (s) of a frame that consists of waiting events only: less than the time between two clicks,
/// but enough for a tap on a key that flies.
const EVENT_FRAME: f64 = 1.0 / 60.0;
/// Number of frames for which keys wait until a dialog's line of text has the keyboard.
const PATIENCE: u32 = 6;

/// Most passes of a frame, each with some of the waiting events: a second of fast clicks has 20.
pub(crate) const MAX_PASSES: NonZeroUsize = NonZeroUsize::MIN.saturating_add(63);

/// The kind of dialog that is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Open {
    #[default]
    Nothing,
    /// A text to read.
    Sheet,
    /// The palette of commands.
    Palette,
    /// A question, or the file dialog.
    Question,
}

impl From<&Dialog> for Open {
    fn from(dialog: &Dialog) -> Self {
        match dialog {
            Dialog::Nothing => Self::Nothing,
            Dialog::Keys | Dialog::Problems => Self::Sheet,
            Dialog::Palette(..) => Self::Palette,
            Dialog::Files(_) | Dialog::Replace(..) | Dialog::Unsaved(_) | Dialog::Recover(_) => {
                Self::Question
            }
        }
    }
}

impl Open {
    /// Whether it must be answered before anything else.
    pub(crate) fn is_modal(self) -> bool {
        matches!(self, Self::Palette | Self::Question)
    }
}

/// What gets the keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct KeyFocus {
    /// Whether a line of text has the keyboard.
    text: bool,
    /// Whether any control has it.
    control: bool,
    /// Whether a menu is open.
    menu: bool,
}

/// The queue of events.
#[derive(Default)]
pub(crate) struct Input {
    /// Events with their times (s).
    waiting: VecDeque<(f64, Event)>,
    /// Shortcuts of this frame, in their order.
    pressed: Vec<KeyboardShortcut>,
    open: Open,
    /// Number of frames for which keys still wait for a dialog's line of text.
    patience: u32,
    /// The time (s) of the last frame.
    time: f64,
    /// Whether a control whose size was not known has asked for another pass of this frame.
    sized: bool,
    shortcuts: Vec<(KeyboardShortcut, Command)>,
}

impl Input {
    pub(crate) fn new() -> Self {
        let items = listed(&Toggles::default())
            .into_iter()
            .flat_map(|(_, items)| items);
        let shortcuts = items.filter_map(|item| Some((item.keys?, item.command)));
        Self {
            shortcuts: shortcuts.collect(),
            ..Self::default()
        }
    }

    /// Shortcuts of this frame, in their order.
    pub(crate) fn take_pressed(&mut self) -> Vec<KeyboardShortcut> {
        std::mem::take(&mut self.pressed)
    }

    /// Sets the kind of dialog that is open.
    pub(crate) fn set_open(&mut self, open: Open) {
        if open != self.open && open.is_modal() {
            self.patience = PATIENCE;
        }
        self.open = open;
    }

    /// Whether events wait for the next pass.
    pub(crate) fn waits(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// The events of the next frame, and its time; `time`: the current one.
    fn next(&mut self, focus: KeyFocus, events: Vec<Event>, time: f64) -> (Vec<Event>, f64) {
        self.waiting
            .extend(events.into_iter().map(|event| (time, event)));
        let mut batch = Batch::default();
        let (mut came, waits) = (time, self.waits_for_text(focus));
        while let Some((_, event)) = self.waiting.front() {
            if (waits && is_typed(event)) || batch.ends_before(event, focus) {
                break;
            }
            let Some((at, event)) = self.waiting.pop_front() else {
                break;
            };
            came = at;
            if let Some((keys, command)) = self.shortcut(&event, focus) {
                self.pressed.push(keys);
                self.drop_twin(&event);
                if command.moves_keyboard() {
                    break;
                }
                continue;
            }
            let ends = ends_after(&event, focus);
            batch.add(event);
            if ends {
                break;
            }
        }
        // The time of the last event, so that two clicks that waited are still a double click.
        self.time = came.max(self.time + EVENT_FRAME).min(time).max(self.time);
        (batch.events, self.time)
    }

    /// Whether keys wait for a dialog that is opening, whose line of text does not have the
    /// keyboard yet. In the first frame the keyboard may still be where it was before.
    fn waits_for_text(&mut self, focus: KeyFocus) -> bool {
        let waits = match self.patience {
            0 => false,
            PATIENCE => true,
            _ => self.open.is_modal() && !focus.text,
        };
        self.patience = if waits { self.patience - 1 } else { 0 };
        waits
    }

    /// The shortcut of an event, unless the event is for something that has the keyboard.
    fn shortcut(&self, event: &Event, focus: KeyFocus) -> Option<(KeyboardShortcut, Command)> {
        let (key, modifiers) = match event {
            Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } => (*key, *modifiers),
            // With some keyboards it comes as text only.
            Event::Text(text) if text == "?" => (Key::Questionmark, Modifiers::NONE),
            _ => return None,
        };
        let fits = |keys: &KeyboardShortcut| fits(keys, key, modifiers);
        let (keys, command) = self.shortcuts.iter().find(|(keys, _)| fits(keys))?;
        let heard = match (command, key) {
            // The palette's shortcut also closes it.
            (Command::TogglePalette, _) => self.open != Open::Question,
            _ if focus.text || self.open.is_modal() => false,
            (_, Key::Tab | Key::Space) => !focus.control,
            (_, Key::Escape) => !focus.control && !focus.menu && self.open == Open::Nothing,
            _ => true,
        };
        heard.then(|| (*keys, command.clone()))
    }

    /// Drops the text event of a key that was a shortcut.
    fn drop_twin(&mut self, event: &Event) {
        let types = matches!(event, Event::Key { modifiers, .. } if !modifiers.command);
        if types && matches!(self.waiting.front(), Some((_, Event::Text(_)))) {
            self.waiting.pop_front();
        }
    }
}

impl Plugin for Input {
    fn debug_name(&self) -> &'static str {
        "input"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        self.sized &= ctx.current_pass_index() > 0;
        let focus = KeyFocus {
            text: ctx.text_edit_focused(),
            control: ctx.egui_wants_keyboard_input(),
            menu: egui::Popup::is_any_open(ctx),
        };
        let events = std::mem::take(&mut input.events);
        let now = input.time.unwrap_or(self.time + EVENT_FRAME);
        let (events, time) = self.next(focus, events, now);
        input.events = events;
        input.time = input.time.map(|_| time);
    }

    fn output_hook(&mut self, _ctx: &Context, output: &mut FullOutput) {
        let reasons = &mut output.platform_output.request_discard_reasons;
        if self.waits() {
            reasons.push(RepaintCause::new_reason("events wait"));
        } else if self.sized {
            // Once, as egui does by itself: a control that asks each time would take all passes.
            reasons.clear();
        } else {
            self.sized = !reasons.is_empty();
        }
    }
}

/// Events of one frame.
#[derive(Default)]
struct Batch {
    events: Vec<Event>,
    moved: bool,
    pressed: Vec<Key>,
}

impl Batch {
    fn add(&mut self, event: Event) {
        match &event {
            Event::PointerMoved(_) => self.moved = true,
            Event::Key {
                key, pressed: true, ..
            } => self.pressed.push(*key),
            _ => {}
        }
        self.events.push(event);
    }

    /// Whether an event must be in a later frame than those before it.
    fn ends_before(&self, event: &Event, focus: KeyFocus) -> bool {
        match event {
            // A drag must be handled before the button is released.
            Event::PointerButton { pressed: false, .. } => self.moved,
            // A key that flies must be down for at least one frame.
            Event::Key {
                key,
                pressed: false,
                ..
            } => !focus.text && self.pressed.contains(key),
            _ => false,
        }
    }
}

/// Whether an event may change the meaning of those after it.
fn ends_after(event: &Event, focus: KeyFocus) -> bool {
    match event {
        Event::PointerButton { .. } => true,
        Event::Key {
            key: Key::Enter | Key::Escape | Key::Tab,
            pressed: true,
            ..
        } => focus.text || focus.control || focus.menu,
        _ => false,
    }
}

fn is_typed(event: &Event) -> bool {
    matches!(
        event,
        Event::Key { .. } | Event::Text(_) | Event::Paste(_) | Event::Cut | Event::Copy
    )
}

/// Whether keys are exactly those of a shortcut. Signs and digits may be typed with Shift or Alt,
/// which some keyboards need for them.
fn fits(keys: &KeyboardShortcut, key: Key, modifiers: Modifiers) -> bool {
    if keys.logical_key != key {
        return false;
    }
    let is_letter = key.name().len() == 1 && key.name().starts_with(char::is_alphabetic);
    let is_named = matches!(
        key,
        Key::Tab | Key::Escape | Key::Home | Key::Delete | Key::Space
    );
    match is_letter || is_named {
        true => modifiers.matches_exact(keys.modifiers),
        false => modifiers.matches_logically(keys.modifiers),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{PointerButton, Pos2};

    const WINDOW: KeyFocus = KeyFocus {
        text: false,
        control: false,
        menu: false,
    };
    const TEXT: KeyFocus = KeyFocus {
        text: true,
        control: true,
        menu: false,
    };
    fn key(key: Key, modifiers: Modifiers, pressed: bool) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers,
        }
    }

    fn typed(text: &str) -> Vec<Event> {
        text.chars().map(|c| Event::Text(c.to_string())).collect()
    }

    fn button(pressed: bool) -> Event {
        Event::PointerButton {
            pos: Pos2::ZERO,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    fn moved(x: f32) -> Event {
        Event::PointerMoved(Pos2::new(x, 0.0))
    }

    fn commands(input: &mut Input) -> Vec<Command> {
        let keys = input.take_pressed();
        let of = |keys| input.shortcuts.iter().find(|(k, _)| *k == keys);
        keys.into_iter()
            .filter_map(|keys| Some(of(keys)?.1.clone()))
            .collect()
    }

    #[test]
    fn every_shortcut_is_itself_and_no_other() {
        let mut input = Input::new();
        for (keys, command) in input.shortcuts.clone() {
            let pressed = key(keys.logical_key, keys.modifiers, true);
            let (rest, _) = input.next(WINDOW, vec![pressed], 0.0);
            assert!(rest.is_empty(), "{keys:?} is heard once");
            assert_eq!(commands(&mut input), [command]);
        }
        let more = key(Key::H, Modifiers::SHIFT, true);
        assert_eq!(input.next(WINDOW, vec![more.clone()], 0.0).0, [more]);
    }

    #[test]
    fn a_question_mark_is_one_whatever_the_keyboard_sends() {
        let both = [
            key(Key::Questionmark, Modifiers::SHIFT, true),
            Event::Text("?".into()),
        ];
        for events in [&both[..], &both[..1], &both[1..]] {
            let mut input = Input::new();
            input.next(WINDOW, events.to_vec(), 0.0);
            assert_eq!(commands(&mut input), [Command::ToggleKeys], "{events:?}");
        }
    }

    #[test]
    fn text_after_a_dialogs_keys_waits_for_its_line() {
        let mut input = Input::new();
        let mut events = vec![key(Key::O, Modifiers::COMMAND, true)];
        events.extend(typed("/home"));
        assert_eq!(input.next(WINDOW, events, 0.0).0, []);
        assert_eq!(commands(&mut input).len(), 1);
        input.set_open(Open::Question);
        // The dialog is shown, but its line of text does not have the keyboard yet.
        assert_eq!(input.next(WINDOW, vec![], 0.1).0, []);
        let (there, _) = input.next(TEXT, vec![], 0.2);
        assert_eq!(there, typed("/home"));
        assert!(commands(&mut input).is_empty() && !input.waits());
    }

    #[test]
    fn text_that_no_line_comes_for_runs_nothing() {
        let mut input = Input::new();
        input.set_open(Open::Question);
        input.next(WINDOW, vec![key(Key::H, Modifiers::NONE, true)], 0.1);
        assert!(input.waits());
        (0..PATIENCE).for_each(|_| drop(input.next(WINDOW, vec![], 0.4)));
        assert!(!input.waits() && commands(&mut input).is_empty());
        input.next(WINDOW, vec![key(Key::Y, Modifiers::NONE, true)], 0.5);
        assert!(!input.waits() && commands(&mut input).is_empty());
    }

    #[test]
    fn a_drag_within_one_frame_becomes_three() {
        let mut input = Input::new();
        let all = vec![
            moved(5.0),
            button(true),
            moved(9.0),
            moved(30.0),
            button(false),
        ];
        let frames: Vec<(Vec<Event>, f64)> = std::iter::once(input.next(WINDOW, all.clone(), 1.0))
            .chain((1..4).map(|i| input.next(WINDOW, vec![], 1.0 + f64::from(i))))
            .collect();
        let sizes: Vec<usize> = frames.iter().map(|(events, _)| events.len()).collect();
        assert_eq!(sizes, [2, 2, 1, 0]);
        let joined: Vec<Event> = frames.iter().flat_map(|(e, _)| e.clone()).collect();
        assert_eq!(joined, all);
        // Two clicks that are close in time stay close.
        assert!(
            frames[2].1 - frames[0].1 < 0.1 && frames[3].1 > 3.0,
            "{frames:?}"
        );
    }

    #[test]
    fn a_tapped_key_is_down_in_one_frame() {
        let mut input = Input::new();
        let [down, up] = [true, false].map(|pressed| key(Key::W, Modifiers::NONE, pressed));
        let both = vec![down.clone(), up.clone()];
        assert_eq!(input.next(WINDOW, both.clone(), 0.0).0, [down]);
        assert_eq!(input.next(WINDOW, vec![], 0.1).0, [up]);
        assert_eq!(input.next(TEXT, both.clone(), 0.2).0, both);
    }
}
