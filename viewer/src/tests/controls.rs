//! Each control and each key changes what it should.

mod common;

use common::{FRAMES, circles, window};
use eframe::egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, Pos2, TouchPhase, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lamina_viewer::Viewer;
use lamina_viewer::app::Tab;
use lamina_viewer::panels::curves::Quantity;
use lamina_viewer::view::{Colour, TrailsOf, View};
use tempfile::TempDir;

type Window = Harness<'static, Viewer>;

fn opened() -> (TempDir, Window) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut viewer = Viewer::default();
    viewer.open(&circles(folder.path())).expect("a recording");
    (folder, window(viewer))
}

fn press(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run();
}

fn key(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run();
}

fn click_at(window: &mut Window, at: Pos2) {
    window.hover_at(at);
    window.drag_at(at);
    window.drop_at(at);
    window.run();
}

#[test]
fn keys_move_through_time() {
    let (_folder, mut window) = opened();
    let plain = Modifiers::NONE;
    let dt = 1.0 / 60.0;
    for (modifiers, pressed, frame) in [
        (plain, Key::Period, 1),
        (plain, Key::Period, 2),
        (plain, Key::Comma, 1),
        (plain, Key::ArrowRight, 7),
        (plain, Key::ArrowLeft, 1),
        (Modifiers::SHIFT, Key::ArrowRight, 61),
        (Modifiers::SHIFT, Key::ArrowLeft, 1),
        (plain, Key::End, FRAMES - 1),
        (plain, Key::Home, 0),
    ] {
        key(&mut window, modifiers, pressed);
        assert_eq!(window.state().playback.frame(), frame, "{pressed:?}");
        assert_eq!(window.state().panes[0].frame().step, frame as u64, "{pressed:?}");
        let shown = window.state().panes[0].frame().time_secs;
        assert!((shown - frame as f64 * dt).abs() < 1e-6);
    }
}

#[test]
fn space_plays_and_pauses() {
    let (_folder, mut window) = opened();
    window.key_press(Key::Space);
    window.run_steps(30);
    assert!(window.state().playback.playing());
    let frame = window.state().playback.frame();
    assert!((20..40).contains(&frame), "half a second is about thirty frames, not {frame}");
    window.key_press(Key::Space);
    window.run_steps(4);
    assert!(!window.state().playback.playing());
    let paused = window.state().playback.frame();
    window.run_steps(4);
    assert_eq!(window.state().playback.frame(), paused);
}

#[test]
fn the_end_stops_or_begins_again() {
    let (_folder, mut window) = opened();
    window.state_mut().playback.speed = 8.0;
    window.get_by_label("Play").click();
    window.run_steps(40);
    assert_eq!((window.state().playback.playing(), window.state().playback.frame()), (false, FRAMES - 1));
    press(&mut window, "loop");
    window.get_by_label("Play").click();
    window.run_steps(40);
    assert!(window.state().playback.playing(), "it loops");
    window.get_by_label("Pause").click();
    window.run_steps(3);
    assert!(!window.state().playback.playing());
}

#[test]
fn other_keys_do_what_the_list_says() {
    let (_folder, mut window) = opened();
    let plain = Modifiers::NONE;
    key(&mut window, plain, Key::CloseBracket);
    assert_eq!(window.state().playback.speed, 2.0);
    for _ in 0..9 {
        key(&mut window, plain, Key::OpenBracket);
    }
    assert_eq!(window.state().playback.speed, 0.125);
    key(&mut window, plain, Key::L);
    assert!(window.state().playback.looping);
    key(&mut window, plain, Key::G);
    assert!(window.state().view.follow);
    window.state_mut().selected = Some(7);
    key(&mut window, plain, Key::Escape);
    assert_eq!(window.state().selected, None);
    window.state_mut().camera.centre = [1e3, 1e3];
    key(&mut window, plain, Key::F);
    assert!(window.state().camera.centre[0] < 1e3);
    for pressed in [Key::Questionmark, Key::F1] {
        key(&mut window, Modifiers::NONE, pressed);
        assert!(window.state().help);
        assert!(window.query_by_label("play or pause").is_some(), "the keys are listed");
        key(&mut window, Modifiers::NONE, pressed);
        assert!(!window.state().help);
    }
}

#[test]
fn buttons_move_through_time() {
    let (_folder, mut window) = opened();
    for (label, frame) in [
        ("A frame on", 1),
        ("A second on", 61),
        ("A frame back", 60),
        ("A second back", 0),
        ("Last frame", FRAMES - 1),
        ("First frame", 0),
    ] {
        press(&mut window, label);
        assert_eq!(window.state().playback.frame(), frame, "{label}");
    }
}

#[test]
fn the_timeline_is_scrubbed() {
    let (_folder, mut window) = opened();
    let bar = window.get_by_label("Timeline").rect();
    click_at(&mut window, bar.center());
    assert_eq!(window.state().playback.frame(), FRAMES / 2);
    click_at(&mut window, bar.right_center() - vec2(1.0, 0.0));
    assert_eq!(window.state().playback.frame(), FRAMES - 1);
}

#[test]
fn marks_are_jumped_to() {
    let (_folder, mut window) = opened();
    let marks = window.state().marks.clone();
    assert!(marks.len() >= 2, "{marks:?}");
    for mark in marks {
        press(&mut window, mark.what.name());
        assert_eq!(window.state().playback.frame(), mark.frame);
        assert_eq!(mark.frame as u64, mark.step, "each step is a frame here");
    }
}

#[test]
fn speeds_are_chosen() {
    let (_folder, mut window) = opened();
    press(&mut window, "Speed");
    press(&mut window, "1/4×");
    assert_eq!(window.state().playback.speed, 0.25);
}

#[test]
fn what_is_shown_is_chosen() {
    type Shown = fn(&View) -> bool;
    let boxes: [(&str, Shown); 8] = [
        ("grid", |view| view.grid),
        ("contact points", |view| view.contacts),
        ("normals", |view| view.normals),
        ("contact start and end", |view| view.depths),
        ("impulses", |view| view.impulses),
        ("joint lines", |view| view.joints),
        ("bounding circles", |view| view.circles),
        ("velocities", |view| view.velocities),
    ];
    let (_folder, mut window) = opened();
    for (label, shown) in boxes {
        let before = shown(&window.state().view);
        press(&mut window, label);
        assert_ne!(shown(&window.state().view), before, "{label}");
    }
    for colour in Colour::ALL {
        press(&mut window, colour.name());
        assert_eq!(window.state().view.colour, colour);
    }
    for of in TrailsOf::ALL {
        press(&mut window, of.name());
        assert_eq!(window.state().view.trails, of);
    }
    press(&mut window, "follow selected");
    assert!(window.state().view.follow);
    press(&mut window, "Light");
    assert!(!window.state().view.dark);
    press(&mut window, "Dark");
    assert!(window.state().view.dark);
}

#[test]
fn trails_reach_back_as_far_as_asked() {
    let (_folder, mut window) = opened();
    window.state_mut().view.trails = TrailsOf::All;
    window.state_mut().view.trail_frames = 20;
    window.state_mut().playback.go_to(50);
    window.run();
    assert_eq!(window.state().panes[0].trail().count(), 21);
    window.state_mut().view.trail_frames = 40;
    window.run();
    assert_eq!(window.state().panes[0].trail().count(), 41);
    window.state_mut().playback.go_to(10);
    window.run();
    assert_eq!(window.state().panes[0].trail().count(), 11);
}

#[test]
fn a_click_selects_the_body_under_it_and_the_list_any() {
    let (_folder, mut window) = opened();
    let canvas = window.get_by_label("Canvas").rect();
    let (slot, at) = {
        let viewer = window.state();
        let slot = viewer.panes[0].bodies().map(|(slot, _)| slot).last().expect("a body");
        (slot, viewer.camera.screen(canvas, viewer.panes[0].position(slot).expect("a place")))
    };
    click_at(&mut window, at);
    assert_eq!((window.state().selected, window.state().tab), (Some(slot), Tab::Body));
    assert!(window.query_by_label("vx").is_some(), "its columns are listed");
    window.get_by_label("Filter of bodies").focus();
    window.run();
    window.get_by_label("Filter of bodies").type_text("12");
    window.run();
    assert_eq!(window.state().filter, "12");
    press(&mut window, "12: circle");
    assert_eq!(window.state().selected, Some(12));
}

#[test]
fn the_selected_body_is_followed() {
    let (_folder, mut window) = opened();
    window.state_mut().selected = Some(12);
    window.state_mut().view.follow = true;
    for frame in [0, 60, 120] {
        window.state_mut().playback.go_to(frame);
        window.run();
        let viewer = window.state();
        assert_eq!(Some(viewer.camera.centre), viewer.panes[0].position(12));
    }
}

#[test]
fn the_canvas_is_moved_and_magnified() {
    let (_folder, mut window) = opened();
    let middle = window.get_by_label("Canvas").rect().center();
    let before = window.state().camera;
    window.hover_at(middle);
    window.drag_at(middle);
    window.hover_at(middle + vec2(50.0, 0.0));
    window.drop_at(middle + vec2(50.0, 0.0));
    window.run();
    let moved = window.state().camera;
    let metres = 50.0 / before.points_per_metre;
    assert!((before.centre[0] - metres - moved.centre[0]).abs() < 1e-6);
    window.hover_at(middle);
    let wheel = Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 40.0),
        phase: TouchPhase::Move,
        source: MouseWheelSource::Unknown,
        modifiers: Modifiers::COMMAND,
    };
    window.event_modifiers(wheel, Modifiers::COMMAND);
    window.run_steps(10);
    assert!(window.state().camera.points_per_metre > moved.points_per_metre);
}

#[test]
fn curves_are_chosen_and_lead_to_their_time() {
    let (_folder, mut window) = opened();
    for quantity in Quantity::ALL {
        press(&mut window, quantity.name());
        assert_eq!(window.state().curves.quantity, quantity);
    }
    let plot = window.get_by_label("Curves").rect();
    click_at(&mut window, plot.center());
    let frame = window.state().playback.frame();
    assert!((40..80).contains(&frame), "{frame}");
}

#[test]
fn keys_belong_to_the_field_that_is_typed_in() {
    let (_folder, mut window) = opened();
    window.get_by_label("Path of a recording").focus();
    window.run();
    key(&mut window, Modifiers::NONE, Key::End);
    key(&mut window, Modifiers::NONE, Key::L);
    assert_eq!((window.state().playback.frame(), window.state().playback.looping), (0, false));
}

#[test]
fn contacts_of_the_selected_body_lead_to_its_neighbours() {
    let (_folder, mut window) = opened();
    window.state_mut().playback.go_to(FRAMES - 1);
    window.run();
    let touching = |slots: &[u32; 2]| slots.iter().all(|slot| *slot > 5);
    let pane = &window.state().panes[0];
    let slots = pane
        .data()
        .contacts
        .iter()
        .map(|contact| contact.slots)
        .find(touching)
        .expect("two circles that touch");
    window.state_mut().selected = Some(slots[0] as usize);
    window.state_mut().tab = Tab::Body;
    window.run();
    press(&mut window, &format!("body {}", slots[1]));
    assert_eq!(window.state().selected, Some(slots[1] as usize));
}

#[test]
fn the_scale_is_chosen_in_the_panel_or_by_keys() {
    let (_folder, mut window) = opened();
    window.state_mut().view.ui_scale = 1.5;
    window.run();
    assert_eq!(window.ctx.zoom_factor(), 1.5);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num0);
    window.run();
    assert_eq!((window.ctx.zoom_factor(), window.state().view.ui_scale), (1.0, 1.0));
}
