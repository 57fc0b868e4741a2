//! A running world: what the hand, the tools and the controls do to it, and that all of it can be had again.

mod common;

use std::path::Path;
use std::time::{Duration, Instant};

use common::window;
use eframe::egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lamina_viewer::live::Tool;
use lamina_viewer::{Live, Viewer};
use lamina2d::record::{Recording, verify};
use lamina2d::scene::{self, BodyKind};
use lamina2d::session::Action;
use lamina2d::settings::{Integrator, Solver};

type Window = Harness<'static, Viewer>;

fn running(name: &str, record: Option<&Path>) -> Window {
    let (scene, settings) = scene::load(name, None, 1).expect("a scene");
    let live = Live::new(scene, settings, record.map(Path::to_owned)).expect("a world");
    let mut viewer = Viewer::default();
    viewer.set_live(live);
    window(viewer)
}

fn live(window: &mut Window) -> &mut Live {
    window.state_mut().live().expect("a running world")
}

fn steps(window: &mut Window) -> u64 {
    live(window).session().world().steps()
}

fn bodies(window: &mut Window) -> usize {
    live(window).session().world().bodies()
}

fn press(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run();
}

fn key(window: &mut Window, key: Key) {
    window.key_press_modifiers(Modifiers::NONE, key);
    window.run();
}

/// Where a point of the world is on the screen.
fn on_screen(window: &Window, world: [f64; 2]) -> Pos2 {
    let canvas = window.get_by_label("Canvas").rect();
    window.state().camera.screen(canvas, world)
}

fn click_at(window: &mut Window, at: Pos2) {
    window.hover_at(at);
    window.drag_at(at);
    window.drop_at(at);
    window.run();
}

/// Saves the session, and has it verified at every lane width.
fn is_had_again(window: &mut Window) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("live.mcap");
    live(window).path = path.display().to_string();
    window.run();
    press_once(window, "Save recording");
    let begin = Instant::now();
    while live(window).is_saving() {
        assert!(begin.elapsed() < Duration::from_mins(1), "saving takes too long");
        std::thread::sleep(Duration::from_millis(5));
    }
    let said = live(window).said.clone().expect("something was said");
    assert!(said.starts_with("saved"), "{said}");
    let hash = live(window).session().world().hash();
    let mut recording = Recording::open(&path).expect("a recording");
    assert_eq!(recording.events(), live(window).session().events());
    assert_eq!(recording.rows().last().map(|row| row.hash), Some(hash));
    for lanes in [1, 4, 8, 16] {
        assert_eq!(verify(&mut recording, Some(lanes), |_| ()).expect("a run"), None, "{lanes} lanes");
    }
}

/// While it saves another picture is always wanted.
fn press_once(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run_steps(2);
}

#[test]
fn time_passes_and_stands_still() {
    let mut window = running("circles/50", None);
    assert_eq!(steps(&mut window), 0);
    window.key_press(Key::Space);
    window.run_steps(30);
    let taken = steps(&mut window);
    assert!((15..45).contains(&taken), "half a second is about thirty steps, not {taken}");
    assert_eq!(window.state().panes[0].frame().step, window.state().playback.frame() as u64);
    assert!(window.query_by_label("pictures per second").is_some());
    window.key_press(Key::Space);
    window.run_steps(3);
    let paused = steps(&mut window);
    window.run_steps(5);
    assert_eq!(steps(&mut window), paused);
    key(&mut window, Key::Period);
    assert_eq!(steps(&mut window), paused + 1, "a step by hand");
    key(&mut window, Key::Comma);
    assert_eq!(window.state().playback.frame() as u64, paused, "back to a frame that is kept");
    assert_eq!(steps(&mut window), paused + 1, "time does not run back");
    key(&mut window, Key::Period);
    assert_eq!((window.state().playback.frame() as u64, steps(&mut window)), (paused + 1, paused + 1));
    key(&mut window, Key::Home);
    assert_eq!(window.state().panes[0].frame().step, 0);
    window.key_press(Key::Space);
    window.run_steps(3);
    assert!(window.state().playback.at_present(), "it goes on where it stood");
}

#[test]
fn the_tools_put_bodies_where_one_clicks() {
    let mut window = running("stack/2", None);
    let before = bodies(&mut window);
    for (k, (label, pressed, tool)) in [
        ("new circle", Key::C, Tool::Circle),
        ("new box", Key::B, Tool::Box),
        ("new polygon", Key::P, Tool::Polygon),
    ]
    .into_iter()
    .enumerate()
    {
        press(&mut window, label);
        assert_eq!(window.state().tool, tool);
        key(&mut window, Key::H);
        assert_eq!(window.state().tool, Tool::Hand);
        key(&mut window, pressed);
        assert_eq!(window.state().tool, tool);
        let at = [1.2 - 0.1 * k as f64, 0.5 + 0.4 * k as f64];
        let place = on_screen(&window, at);
        click_at(&mut window, place);
        let said = window.state().error.clone();
        assert_eq!((bodies(&mut window), said), (before + k + 1, None), "{label}");
        let slot = window.state().selected.expect("the new one is selected");
        let found = window.state().panes[0].position(slot).expect("it is shown at once");
        assert!((found[0] - at[0]).hypot(found[1] - at[1]) < 0.3, "{found:?} is not {at:?}");
    }
    press(&mut window, "hand");
    for _ in 0..40 {
        key(&mut window, Key::Period);
    }
    is_had_again(&mut window);
}

#[test]
fn the_hand_pulls_a_body_and_lets_it_go() {
    let mut window = running("stack/3", None);
    let slot = 4;
    let begin = live(&mut window).session().world().body(slot).expect("the top box").state.position;
    let from = on_screen(&window, begin);
    window.hover_at(from);
    window.drag_at(from);
    window.run_steps(2);
    let to = from + vec2(0.0, -120.0);
    window.hover_at(to);
    window.run_steps(2);
    assert_eq!(live(&mut window).session().pull().map(|pull| pull.id.slot()), Some(slot));
    window.key_press(Key::Space);
    window.run_steps(60);
    let metres = 120.0 / window.state().camera.points_per_metre;
    let lifted = live(&mut window).session().world().body(slot).expect("a box").state.position;
    assert!(
        (lifted[1] - begin[1] - metres).abs() < 0.1 * metres + 0.05,
        "{lifted:?} from {begin:?} by {metres}"
    );
    window.drop_at(to);
    window.run_steps(30);
    assert!(live(&mut window).session().pull().is_none());
    let fallen = live(&mut window).session().world().body(slot).expect("a box").state.position;
    assert!(fallen[1] < lifted[1] - 0.1);
    window.key_press(Key::Space);
    window.run_steps(3);
    let done = live(&mut window).session().events().to_vec();
    assert!(done.len() >= 3 && done.len() < 10, "a hand that rests says nothing: {done:?}");
    is_had_again(&mut window);
}

#[test]
fn a_drag_beside_bodies_moves_the_view() {
    let mut window = running("stack/2", None);
    let before = window.state().camera.centre;
    let at = on_screen(&window, [1.2, 1.0]);
    window.hover_at(at);
    window.drag_at(at);
    window.hover_at(at + vec2(40.0, 0.0));
    window.drop_at(at + vec2(40.0, 0.0));
    window.run();
    assert!(live(&mut window).session().events().is_empty());
    assert!(window.state().camera.centre[0] < before[0]);
}

#[test]
fn the_selected_body_is_pinned_and_deleted() {
    let mut window = running("stack/3", None);
    let kind = |window: &mut Window| live(window).session().world().body(3).map(|body| body.kind);
    let at = on_screen(
        &window,
        live(&mut running("stack/3", None)).session().world().body(3).expect("a box").state.position,
    );
    click_at(&mut window, at);
    assert_eq!(window.state().selected, Some(3));
    let mass = live(&mut window).session().world().body(3).expect("a box").inv_mass;
    press(&mut window, "Make static");
    assert_eq!(kind(&mut window), Some(BodyKind::Static));
    press(&mut window, "Make dynamic");
    assert_eq!(kind(&mut window), Some(BodyKind::Dynamic));
    assert_eq!(
        live(&mut window).session().world().body(3).expect("a box").inv_mass,
        mass,
        "its own mass again"
    );
    key(&mut window, Key::S);
    assert_eq!(kind(&mut window), Some(BodyKind::Static));
    press(&mut window, "Delete");
    assert_eq!((kind(&mut window), window.state().selected), (None, None));
    window.state_mut().selected = Some(4);
    key(&mut window, Key::Delete);
    assert!(live(&mut window).session().world().body(4).is_none());
    for _ in 0..5 {
        key(&mut window, Key::Period);
    }
    is_had_again(&mut window);
}

#[test]
fn methods_and_gravity_are_chosen() {
    let mut window = running("stack/3", None);
    press(&mut window, "Integrator");
    press(&mut window, "rk4");
    press(&mut window, "Solver");
    press(&mut window, "xpbd");
    let settings = *live(&mut window).settings();
    assert_eq!((settings.integrator, settings.solver), (Integrator::Rk4, Solver::Xpbd));
    let typed = |window: &mut Window, label: &str, text: &str| {
        let field = window.get_by_label(label);
        field.click();
        window.run();
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.get_by_label(label).type_text(text);
        window.key_press(Key::Enter);
        window.run();
    };
    typed(&mut window, "Substeps", "7");
    assert_eq!(live(&mut window).settings().substeps, 7);
    typed(&mut window, "Gravity y", "-1.5");
    typed(&mut window, "Gravity x", "0.5");
    let forces = live(&mut window).session().world().body_table().forces;
    assert_eq!(forces.gravity, Some([0.5, -1.5]));
    for _ in 0..20 {
        key(&mut window, Key::Period);
    }
    is_had_again(&mut window);
}

#[test]
fn it_is_recorded_as_it_happens() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("all.mcap");
    let mut window = running("all/30", Some(&path));
    for k in 0..20 {
        key(&mut window, Key::Period);
        if k == 7 {
            live(&mut window).act(Action::Remove { slot: 9 }).expect("a body");
        }
    }
    assert!(!path.exists(), "not before it is finished");
    let hash = live(&mut window).session().world().hash();
    drop(window);
    let mut recording = Recording::open(&path).expect("a recording");
    assert_eq!((recording.loss(), recording.events().len(), recording.frames()), (None, 1, 21));
    assert_eq!(recording.rows().last().map(|row| row.hash), Some(hash));
    assert_eq!(verify(&mut recording, None, |_| ()).expect("a run"), None);
}

#[test]
fn it_starts_anew() {
    let mut window = running("stack/3", None);
    for _ in 0..5 {
        key(&mut window, Key::Period);
    }
    live(&mut window).act(Action::Remove { slot: 3 }).expect("a body");
    press(&mut window, "Start anew");
    assert_eq!((steps(&mut window), bodies(&mut window)), (0, 4));
    assert_eq!(window.state().playback.frames(), 1);
}

#[test]
fn what_cannot_be_saved_says_so_and_nothing_is_lost() {
    let mut window = running("stack/2", None);
    key(&mut window, Key::Period);
    live(&mut window).path = "/".to_owned();
    window.run();
    press_once(&mut window, "Save recording");
    let begin = Instant::now();
    while live(&mut window).is_saving() {
        assert!(begin.elapsed() < Duration::from_mins(1));
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(live(&mut window).said.as_deref().is_some_and(|said| said.contains("a folder")));
    window.run();
    is_had_again(&mut window);
}

/// A body of a spawned size that cannot be is refused in the bar at the top.
#[test]
fn a_refusal_is_shown() {
    let mut window = running("stack/2", None);
    window.state_mut().selected = Some(77);
    key(&mut window, Key::S);
    assert_eq!(window.state().error.as_deref(), Some("no body lives in slot 77"));
    press(&mut window, "Dismiss");
    assert_eq!(window.state().error, None);
}
