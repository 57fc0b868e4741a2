//! Nothing open, something that is no recording, a damaged one, two of them.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use common::{FRAMES, circles, record, window};
use eframe::egui::DroppedFile;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lamina_viewer::Viewer;
use lamina_viewer::app::Tab;
use lamina_viewer::events::What;
use lamina_viewer::view::Arrangement;
use lamina2d::record::Recorder;
use lamina2d::scene;
use lamina2d::settings::Integrator;
use lamina2d::settings::Settings;
use lamina2d::simulation::simulate;

fn type_path(window: &mut Harness<'static, Viewer>, path: &str) {
    window.get_by_label("Path of a recording").focus();
    window.run();
    window.get_by_label("Path of a recording").type_text(path);
    window.run();
}

#[test]
fn an_empty_start_says_what_to_do() {
    let mut window = window(Viewer::default());
    assert!(window.query_by_label("Canvas").is_none());
    window.get_by_label("Open").click();
    window.run();
    assert!(window.state().panes.is_empty());
    assert_eq!(window.state().error, None);
}

#[test]
fn a_path_is_typed_and_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = circles(folder.path());
    let mut window = window(Viewer::default());
    type_path(&mut window, &path.display().to_string());
    window.get_by_label("Open").click();
    window.run();
    assert_eq!(window.state().playback.frames(), FRAMES);
    assert_eq!(window.state().tab, Tab::Run);
}

#[test]
fn what_is_no_recording_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = circles(folder.path());
    let bad = folder.path().join("notes.txt");
    fs::write(&bad, "not a recording").expect("written");
    let mut viewer = Viewer::default();
    viewer.open(&good).expect("a recording");
    let mut window = window(viewer);
    type_path(&mut window, &bad.display().to_string());
    window.get_by_label("Open").click();
    window.run();
    let why = window.state().error.clone().expect("an error");
    assert!(why.contains("notes.txt"), "{why}");
    assert_eq!(window.state().panes.len(), 1, "what was open stays");
    assert!(window.query_by_label(&why).is_some(), "the window says so");
    window.get_by_label("Dismiss").click();
    window.run();
    assert_eq!(window.state().error, None);
}

#[test]
fn a_damaged_recording_opens_as_far_as_it_is_good() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = record(folder.path(), "long.mcap", "circles/150", Integrator::SemiImplicitEuler, 400);
    let bytes = fs::read(&path).expect("read");
    fs::write(&path, &bytes[..bytes.len() * 2 / 3]).expect("cut");
    let mut viewer = Viewer::default();
    viewer.open(&path).expect("its beginning");
    let frames = viewer.playback.frames();
    assert!((1..401).contains(&frames), "{frames}");
    let loss = viewer.panes[0].source.loss().expect("a loss");
    let mut window = window(viewer);
    assert!(window.query_by_label_contains("is damaged or unfinished").is_some(), "{loss}");
    window.get_by_label("Last frame").click();
    window.run();
    assert_eq!(window.state().panes[0].error(), None);
}

#[test]
fn two_recordings_are_locked_by_step() {
    let folder = tempfile::tempdir().expect("a folder");
    let a = record(folder.path(), "a.mcap", "circles/50", Integrator::VelocityVerlet, 60);
    let b = record(folder.path(), "b.mcap", "circles/50", Integrator::ExplicitEuler, 60);
    let mut viewer = Viewer::default();
    viewer.open(&a).expect("the first");
    viewer.open_second(&b).expect("the second");
    assert!(viewer.difference.as_ref().is_some_and(|difference| difference.slot.is_some()));
    let mut window = window(viewer);
    assert!(window.query_by_label("Second canvas").is_some());
    assert_eq!(window.state().tab, Tab::Compare);
    window.get_by_label("Last frame").click();
    window.run();
    let steps: Vec<_> = window.state().panes.iter().map(|pane| pane.frame().step).collect();
    assert_eq!(steps, [60, 60]);
    window.get_by_label(What::Difference.name()).click();
    window.run();
    assert_eq!(
        Some(window.state().step()),
        window.state().difference.as_ref().map(|difference| difference.step)
    );
    window.get_by_label("overlaid").click();
    window.run();
    assert_eq!(window.state().view.arrangement, Arrangement::Overlaid);
    assert!(window.query_by_label("Second canvas").is_none());
    window.get_by_label("side by side").click();
    window.run();
    assert!(window.query_by_label("Second canvas").is_some());
    window.get_by_label("Close second").click();
    window.run();
    assert_eq!(window.state().panes.len(), 1);
    assert_eq!(window.state().difference, None);
}

#[test]
fn the_same_run_twice_does_not_differ() {
    let folder = tempfile::tempdir().expect("a folder");
    let a = circles(folder.path());
    let mut viewer = Viewer::default();
    viewer.open(&a).expect("the first");
    viewer.open_second(&a).expect("the second");
    assert_eq!(viewer.difference, None);
    assert!(viewer.marks.iter().all(|mark| mark.what != What::Difference));
}

/// A file as the system hands it over.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }
    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|why| why.to_string())
    }
}

#[test]
fn dropped_files_are_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = circles(folder.path());
    let mut window = window(Viewer::default());
    let dropped = |path: &Path| Arc::new(Dropped(path.to_owned()));
    window.input_mut().dropped_files.push(dropped(&path));
    window.run();
    assert_eq!(window.state().panes.len(), 1);
    window.input_mut().dropped_files.extend([dropped(&path) as Arc<_>, dropped(&path) as Arc<_>]);
    window.run();
    assert_eq!(window.state().panes.len(), 2);
}

#[test]
fn a_run_that_turned_non_finite_is_marked_and_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("broken.mcap");
    let scene = scene::by_name("circles/50", None, 1).expect("a scene");
    let settings = Settings { dt_secs: 1e19, ..Settings::default() };
    let mut world = simulate(&scene, settings).expect("a world");
    let mut recorder = Recorder::create(&path, &scene, world.as_ref(), 1).expect("a recorder");
    assert!(world.step(settings.dt_secs).is_err());
    recorder.record(world.as_ref(), true).expect("recorded");
    recorder.finish().expect("finished");
    let mut viewer = Viewer::default();
    viewer.open(&path).expect("a recording");
    let mut window = window(viewer);
    window.get_by_label(What::NonFinite.name()).click();
    window.run();
    assert_eq!(window.state().step(), 1);
}
