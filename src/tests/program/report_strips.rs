//! The report's strips of frames: each body in each frame, the same bytes from every run, and commands that work.

use std::process::Command;

use assert_cmd::cargo::cargo_bin;
use lamina::report::Earlier;
use lamina::report::experiments::accuracy::Drawing;
use lamina::report::strip::{SHOTS, Shot, Strip};
use lamina::report::sweep::Sweep;
use lamina::report::{self, Data, Table};
use lamina2d::record::Recording;
use lamina2d::scene::{BodyKind, ShapeSpec, by_name};
use lamina2d::settings::Settings;

use crate::shared_cli::folder;

/// All shapes, falling and lying.
const SMALL: Shot = Shot { file: "strip_all.svg", scene: "all", bodies: 40, steps: &[0, 20, 60] };

fn take(shot: &Shot, settings: Settings) -> Strip {
    shot.take(settings).unwrap_or_else(|why| panic!("{}: {why}", shot.scene))
}

/// The path data of each frame: a frame is an SVG within the strip's.
fn frames(svg: &str) -> Vec<Vec<&str>> {
    fn paths(frame: &str) -> Vec<&str> {
        frame.split(" d=\"").skip(1).filter_map(|path| path.split('"').next()).collect()
    }
    svg.split("<svg ").skip(2).filter_map(|frame| frame.split("</svg>").next()).map(paths).collect()
}

#[test]
fn two_runs_give_the_same_bytes_at_every_lane_width() {
    let first = take(&SMALL, Settings::default());
    assert_eq!(first.svg, take(&SMALL, Settings::default()).svg);
    for lanes in [1, 4, 16] {
        assert_eq!(first.svg, take(&SMALL, Settings { lanes, ..Settings::default() }).svg, "{lanes} lanes");
    }
}

/// A subpath per body: dots and strokes are as many as circles and boxes, outlines are closed.
#[test]
fn every_body_is_in_every_frame() {
    let scene = by_name("all", Some(40), 1).unwrap();
    let strip = take(&SMALL, Settings::default());
    let frames = frames(&strip.svg);
    assert_eq!(frames.len(), 3);
    let polygons = scene.bodies.iter().filter(|b| matches!(b.shape, ShapeSpec::Polygon(_))).count();
    let circles = scene.bodies.iter().filter(|b| matches!(b.shape, ShapeSpec::Circle(_))).count();
    for frame in &frames {
        let count = |of: &str| frame.iter().map(|path| path.matches(of).count()).sum::<usize>();
        assert_eq!(count("m"), scene.bodies.len(), "{frame:#?}");
        assert_eq!(count("z"), polygons, "{frame:#?}");
        assert_eq!(count("h0"), circles, "{frame:#?}");
    }
    assert!(frames[0] != frames[1] && frames[1] != frames[2], "nothing has moved");
}

/// A body of known size and place, read back from the path in metres.
#[test]
fn bodies_are_where_the_world_has_them() {
    let shot = Shot { scene: "stack", bodies: 2, ..SMALL };
    let strip = take(&shot, Settings::default());
    // The static floor is wide and not counted: two boxes of 1 m, a rim of 3 % of their 2 m, 8 units a metre.
    assert!(strip.svg.contains("viewBox=\"0 0 9 17\""), "{}", strip.svg);
    let frames = frames(&strip.svg);
    // Fixed first: the floor of 40 m from −20 to 20 m, below its boxes. Then the boxes, 7 units of 8.
    assert_eq!(frames[0], ["m-155 20h319", "m1 4h7m-7 8h7"], "{}", strip.svg);
}

/// What the page shows is what a reader can record: frame numbers are steps.
#[test]
fn the_command_records_the_frames_that_are_shown() {
    let strip = take(&SMALL, Settings::default());
    let [record, open] = &strip.replay;
    let args = record.strip_prefix("cargo run --release -- ").unwrap().split(' ');
    let folder = folder();
    let output = Command::new(cargo_bin!("lamina")).current_dir(folder.path()).args(args).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    let words: Vec<_> = open.split(' ').collect();
    let [file, "--frame", frame] = words[words.len() - 3..] else { panic!("{open}") };
    let recording = Recording::open(&folder.path().join(file)).unwrap();
    let last = SMALL.steps[SMALL.steps.len() - 1];
    assert_eq!(recording.frames() as u64, last + 1);
    let step = recording.step_of(frame.parse().unwrap()).unwrap();
    assert!(SMALL.steps.contains(&step), "{step}");
}

/// A file, a figure and a line of the summary for each, and every one has something to look at.
#[test]
fn the_report_shows_all_strips() {
    let take = |shot: &Shot| take(&Shot { steps: &[0, 1], ..*shot }, Settings::default());
    let data = Data { strips: SHOTS.iter().map(take).collect(), ..Data::empty(true) };
    let folder = folder();
    report::write(&data, folder.path()).unwrap();
    let read = |file: &str| std::fs::read_to_string(folder.path().join(file)).unwrap();
    let (page, summary) = (read("index.html"), read("summary.md"));
    assert_eq!(page.matches("<figure").count(), SHOTS.len());
    for strip in &data.strips {
        assert_eq!(read(strip.file), strip.svg);
        assert!(summary.contains(&format!("({})", strip.file)), "{summary}");
        // A block of its own: lines that break at hyphens cannot be read as commands.
        assert!(page.contains(&format!(">{}</pre>", strip.replay.join("\n"))), "{:?}", strip.replay);
        for command in &strip.replay {
            assert!(summary.contains(&format!("`{command}`")), "{command}");
        }
    }
    // On the page, paper and ink are the page's own.
    assert!(!page.contains("\"#FFFFFF\"") && !page.contains("\"#000000\""));
    for shot in SHOTS {
        let scene = by_name(shot.scene, Some(shot.bodies), 1).unwrap();
        assert!(scene.bodies.iter().any(|body| body.kind == BodyKind::Dynamic), "{}", shot.scene);
        assert!(shot.steps.is_sorted() && shot.steps.len() > 1, "{}: {:?}", shot.scene, shot.steps);
    }
}

/// Rows of other runs say so beside table, drawing and heading; only a report of one run claims to be one.
#[test]
fn what_this_run_did_not_measure_says_so() {
    let of = Earlier { commit: "0123abc".to_owned(), cpu: "a slow one".to_owned(), when: None };
    let table = |name: &str| Table { name: name.to_owned(), title: name.to_owned(), ..Table::default() };
    let drawing = Drawing {
        file: "accuracy_kepler.svg".to_owned(),
        about: "orbits".to_owned(),
        svg: "<svg/>".to_owned(),
    };
    let sweep = Sweep {
        machine: of.clone(),
        tables: vec![table("fastest").of_run(Some(of.clone()))],
        answers: vec!["Nothing is free.".to_owned()],
        drawings: vec![drawing],
    };
    let written = |data: &Data| {
        let folder = folder();
        report::write(data, folder.path()).unwrap();
        ["index.html", "summary.md"].map(|file| std::fs::read_to_string(folder.path().join(file)).unwrap())
    };
    let data = Data { earlier_accuracy: Some(sweep), ..Data::empty(true) };
    for page in written(&data) {
        // Of its section, its drawing and its table.
        assert_eq!(page.matches("Not of this run:").count(), 3, "{page}");
        assert_eq!(page.matches("measured earlier, at commit 0123abc on a slow one").count(), 3, "{page}");
        assert!(!page.to_lowercase().contains("one machine, one run"), "{page}");
    }
    for page in written(&Data { not_run: vec!["skips", "limits"], ..Data::empty(true) }) {
        assert!(page.to_lowercase().contains("one machine, one run") && !page.contains("Not of this run"));
        assert!(page.contains("Not measured: skips, limits"), "{page}");
    }
}
