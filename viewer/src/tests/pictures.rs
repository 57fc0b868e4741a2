//! Pictures are of the asked size and show something.

mod common;

use std::collections::BTreeSet;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use common::{circles, record};
use lamina_viewer::Viewer;
use lamina_viewer::screenshot::{Camera, write_png, write_sequence};
use lamina_viewer::view::{Arrangement, TrailsOf};
use lamina2d::settings::Integrator;

/// Its size, and how many colours it has.
fn look(path: &Path) -> ([u32; 2], usize) {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).expect("a picture")));
    let mut reader = decoder.read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    let colors: BTreeSet<_> = pixels.chunks_exact(3).map(<[u8]>::to_vec).collect();
    ([info.width, info.height], colors.len())
}

#[test]
fn a_picture_shows_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut viewer = Viewer::default();
    viewer.open(&circles(folder.path())).expect("a recording");
    viewer.playback.go_to(60);
    viewer.view.trails = TrailsOf::All;
    (viewer.view.contacts, viewer.view.normals, viewer.view.depths) = (true, true, true);
    (viewer.view.impulses, viewer.view.circles, viewer.view.velocities) = (true, true, true);
    let path = folder.path().join("window.png");
    write_png(Camera::new([1000, 700]).take(&mut viewer), &path).expect("written");
    let (size, colors) = look(&path);
    assert_eq!(size, [1000, 700]);
    assert!(colors > 50, "{colors}");
    assert_eq!(viewer.panes[0].frame().step, 60);
}

#[test]
fn empty_small_light_and_overlaid_windows_are_drawn_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("window.png");
    write_png(Camera::new([400, 300]).take(&mut Viewer::default()), &path).expect("written");
    assert!(look(&path).1 > 5);
    let mut viewer = Viewer::default();
    viewer.view.dark = false;
    viewer.view.arrangement = Arrangement::Overlaid;
    viewer.open(&record(folder.path(), "a", "circles/50", Integrator::Rk4, 30)).expect("the first");
    viewer
        .open_second(&record(folder.path(), "b", "circles/50", Integrator::ExplicitEuler, 30))
        .expect("the second");
    let frames = folder.path().join("frames");
    write_sequence(&mut viewer, &mut Camera::new([640, 420]), 28..31, &frames).expect("written");
    for frame in 28..31 {
        let (size, colors) = look(&frames.join(format!("frame_{frame:06}.png")));
        assert_eq!(size, [640, 420]);
        assert!(colors > 20, "{colors}");
    }
}
