//! Small recordings, and a window without a screen.

use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use lamina_viewer::Viewer;
use lamina2d::record::Recorder;
use lamina2d::scene;
use lamina2d::settings::{Integrator, Settings};
use lamina2d::simulation::simulate;

/// Frames of the recordings made here: the state before the first step is one.
#[allow(dead_code, reason = "not every test file opens a recording")]
pub(crate) const FRAMES: usize = 121;

/// Records a scene for so many steps.
#[allow(dead_code, reason = "not every test file makes one")]
pub(crate) fn record(folder: &Path, name: &str, scene: &str, integrator: Integrator, steps: u64) -> PathBuf {
    let path = folder.join(name);
    let scene = scene::by_name(scene, None, 1).expect("a scene");
    let settings = Settings { dt_secs: scene.dt_secs, integrator, ..Settings::default() };
    let mut world = simulate(&scene, settings).expect("a world");
    let mut recorder = Recorder::create(&path, &scene, world.as_ref(), 1).expect("a recorder");
    for _ in 0..steps {
        world.step(settings.dt_secs).expect("a step");
        recorder.record(world.as_ref(), false).expect("recorded");
    }
    recorder.finish().expect("finished");
    path
}

/// Fifty circles over two seconds.
#[allow(dead_code, reason = "not every test file opens a recording")]
pub(crate) fn circles(folder: &Path) -> PathBuf {
    record(folder, "circles.mcap", "circles/50", Integrator::SemiImplicitEuler, FRAMES as u64 - 1)
}

/// The window around a viewer.
#[allow(dead_code, reason = "not every test file opens a window")]
pub(crate) fn window(viewer: Viewer) -> Harness<'static, Viewer> {
    let builder = Harness::builder().with_size([1280.0, 1000.0]).with_max_steps(16).with_step_dt(1.0 / 60.0);
    let mut harness = builder.build_ui_state(|ui, viewer: &mut Viewer| viewer.show(ui), viewer);
    harness.run();
    harness
}
