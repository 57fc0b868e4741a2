//! What keys do: one table, for the keyboard and for the list that `?` shows.

use eframe::egui::{Key, Modifiers};

use crate::live::Tool;

/// Something a key or a button asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Play or pause.
    Play,
    /// Pause and move by so many frames.
    Step(i8),
    /// Move by so many tenths of a second.
    Jump(i8),
    /// To the first frame.
    First,
    /// To the last frame.
    Last,
    /// To the next slower or faster speed.
    Speed(i8),
    /// Begin again at the end, or not.
    Loop,
    /// Show all bodies.
    Fit,
    /// Follow the selected body, or not.
    Follow,
    /// Select nothing.
    Deselect,
    /// Show the keys, or hide them.
    Help,
    /// In a running world: what a click does.
    Use(Tool),
    /// In a running world: makes the selected body static, or dynamic.
    Pin,
    /// In a running world: takes the selected body out.
    Delete,
}

/// A key and what it does.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Held down with it: shift or nothing.
    pub modifiers: Modifiers,
    /// The key.
    pub key: Key,
    /// What it does.
    pub command: Command,
    /// The key as it is written on keyboards.
    pub keys: &'static str,
    /// What it does, in words.
    pub about: &'static str,
}

const fn bind(key: Key, command: Command, keys: &'static str, about: &'static str) -> Binding {
    Binding { modifiers: Modifiers::NONE, key, command, keys, about }
}

const fn shifted(key: Key, command: Command, keys: &'static str, about: &'static str) -> Binding {
    Binding { modifiers: Modifiers::SHIFT, key, command, keys, about }
}

/// All keys. Those with shift come before their plain ones, which would take them.
pub const BINDINGS: [Binding; 24] = [
    bind(Key::Space, Command::Play, "space", "play or pause"),
    bind(Key::Comma, Command::Step(-1), ",", "a frame back"),
    bind(Key::Period, Command::Step(1), ".", "a frame on"),
    shifted(Key::ArrowLeft, Command::Jump(-10), "shift ←", "a second back"),
    shifted(Key::ArrowRight, Command::Jump(10), "shift →", "a second on"),
    bind(Key::ArrowLeft, Command::Jump(-1), "←", "a tenth of a second back"),
    bind(Key::ArrowRight, Command::Jump(1), "→", "a tenth of a second on"),
    bind(Key::Home, Command::First, "home", "to the first frame"),
    bind(Key::End, Command::Last, "end", "to the last frame"),
    bind(Key::OpenBracket, Command::Speed(-1), "[", "slower"),
    bind(Key::CloseBracket, Command::Speed(1), "]", "faster"),
    bind(Key::L, Command::Loop, "L", "loop, or not"),
    bind(Key::F, Command::Fit, "F", "fit all bodies into view"),
    bind(Key::G, Command::Follow, "G", "follow the selected body, or not"),
    bind(Key::Escape, Command::Deselect, "esc", "select nothing"),
    bind(Key::Questionmark, Command::Help, "?", "show or hide this list"),
    // Some layouts tell of the key, not of the sign.
    shifted(Key::Slash, Command::Help, "", ""),
    bind(Key::F1, Command::Help, "F1", "show or hide this list"),
    bind(Key::H, Command::Use(Tool::Hand), "H", "running world: the hand, which selects and pulls"),
    bind(Key::C, Command::Use(Tool::Circle), "C", "running world: a click puts a circle there"),
    bind(Key::B, Command::Use(Tool::Box), "B", "running world: a click puts a box there"),
    bind(Key::P, Command::Use(Tool::Polygon), "P", "running world: a click puts a polygon there"),
    bind(Key::S, Command::Pin, "S", "running world: the selected body static, or dynamic"),
    bind(Key::Delete, Command::Delete, "delete", "running world: take the selected body out"),
];
