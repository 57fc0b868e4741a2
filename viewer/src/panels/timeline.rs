//! The panel at the bottom: play, step, speed, the scrub bar with its marks.

use eframe::egui::{Button, Color32, ComboBox, Pos2, Rect, Role, Sense, Stroke, Ui, WidgetInfo, vec2};

use super::name;
use crate::app::Viewer;
use crate::canvas::Palette;
use crate::command::Command;
use crate::events::What;
use crate::playback::SPEEDS;

/// Height of the scrub bar, points.
const HEIGHT: f32 = 22.0;

/// Buttons that only run a command: what is on them, their names, and what they do.
const BUTTONS: [(&str, &str, Command); 6] = [
    ("|<", "First frame", Command::First),
    ("-1 s", "A second back", Command::Jump(-10)),
    ("-1", "A frame back", Command::Step(-1)),
    ("+1", "A frame on", Command::Step(1)),
    ("+1 s", "A second on", Command::Jump(10)),
    (">|", "Last frame", Command::Last),
];

/// Draws it.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    ui.add_space(4.0);
    ui.add_enabled_ui(!viewer.panes.is_empty(), |ui| {
        scrub(ui, viewer);
        ui.horizontal_wrapped(|ui| {
            buttons(ui, viewer);
            speed(ui, viewer);
            ui.separator();
            jumps(ui, viewer);
        });
    });
    ui.add_space(4.0);
}

fn buttons(ui: &mut Ui, viewer: &mut Viewer) {
    let word = if viewer.playback.playing() { "Pause" } else { "Play" };
    let play = ui.add_sized(vec2(52.0, 20.0), Button::new(word)).on_hover_text("space");
    if play.clicked() {
        viewer.run(Command::Play);
    }
    for (sign, about, command) in BUTTONS {
        let button = ui.button(sign).on_hover_text(about);
        name(&button, Role::Button, about);
        if button.clicked() {
            viewer.run(command);
        }
    }
}

/// A speed as a fraction.
fn written(speed: f64) -> String {
    if speed < 1.0 { format!("1/{}×", (1.0 / speed).round()) } else { format!("{speed}×") }
}

fn speed(ui: &mut Ui, viewer: &mut Viewer) {
    let playback = &mut viewer.playback;
    let choice = ComboBox::from_id_salt("speed").width(56.0).selected_text(written(playback.speed));
    let choice = choice.show_ui(ui, |ui| {
        for speed in SPEEDS {
            ui.selectable_value(&mut playback.speed, speed, written(speed));
        }
    });
    name(&choice.response, Role::ComboBox, "Speed");
    ui.checkbox(&mut playback.looping, "loop");
    let step = viewer.step();
    let playback = &viewer.playback;
    let place = format!(
        "{:.3} / {:.3} s   step {step}   frame {} / {}",
        playback.time_secs(),
        playback.end_secs(),
        playback.frame(),
        playback.last()
    );
    ui.monospace(place);
}

fn mark_color(what: What, palette: &Palette) -> Color32 {
    match what {
        What::Overlap => palette.contact,
        What::Energy => palette.impulse,
        What::Difference => palette.depths[1],
        What::NonFinite => palette.kinematic,
    }
}

fn jumps(ui: &mut Ui, viewer: &mut Viewer) {
    let mut to = None;
    let palette = Palette::of(viewer.view.dark);
    for mark in &viewer.marks {
        let button = Button::new(mark.what.name()).stroke(Stroke::new(1.0, mark_color(mark.what, &palette)));
        if ui.add(button).on_hover_text(&mark.text).clicked() {
            to = Some(mark.frame);
        }
    }
    if let Some(frame) = to {
        viewer.playback.pause();
        viewer.playback.go_to(frame);
    }
}

fn scrub(ui: &mut Ui, viewer: &mut Viewer) {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click_and_drag());
    let playback = &mut viewer.playback;
    let first = playback.first();
    let span = (playback.last() - first.min(playback.last())).max(1) as f32;
    let track = Rect::from_center_size(rect.center(), vec2((rect.width() - 12.0).max(1.0), 6.0));
    if let Some(at) = response.interact_pointer_pos() {
        let share = ((at.x - track.left()) / track.width()).clamp(0.0, 1.0);
        playback.pause();
        playback.go_to(first + (share * span).round() as usize);
    }
    let frame = playback.frame();
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), frame as f64, "Timeline"));
    let x = |frame: usize| track.left() + track.width() * frame.saturating_sub(first) as f32 / span;
    let palette = Palette::of(viewer.view.dark);
    let painter = ui.painter();
    painter.rect_filled(track, 3.0, ui.visuals().extreme_bg_color);
    painter.rect_filled(track.with_max_x(x(frame)), 3.0, ui.visuals().selection.bg_fill);
    for mark in &viewer.marks {
        let line = Rect::from_center_size(Pos2::new(x(mark.frame), rect.center().y), vec2(3.0, 16.0));
        painter.rect_filled(line, 1.0, mark_color(mark.what, &palette));
    }
    painter.circle_filled(Pos2::new(x(frame), rect.center().y), 6.0, ui.visuals().strong_text_color());
    if let Some(pointer) = response.hover_pos() {
        let near = viewer.marks.iter().filter(|mark| (x(mark.frame) - pointer.x).abs() < 4.0);
        let texts: Vec<_> = near.map(|mark| mark.text.as_str()).collect();
        if !texts.is_empty() {
            response.on_hover_text(texts.join("\n"));
        }
    }
}
