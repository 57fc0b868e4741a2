//! The program `lamina-viewer`: a window, or pictures without one.
//!
//! Exit codes: 0 done; 1 a window or file that could not be had; 2 input that was refused.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{anyhow, bail, ensure};
use clap::Parser;
use lamina_viewer::app::stored_view;
use lamina_viewer::screenshot::{Camera, MOST_PIXELS, write_png, write_sequence};
use lamina_viewer::view::{Arrangement, Colour, TrailsOf, View};
use lamina_viewer::{Live, Viewer};
use lamina2d::record::{Stamp, set_stamp};
use lamina2d::scene;

/// Shows recordings of lamina2d frame by frame; two of them side by side.
#[derive(Debug, Parser)]
#[command(name = "lamina-viewer", version, about, max_term_width = 100)]
#[expect(clippy::struct_excessive_bools, reason = "each is one flag")]
struct Args {
    /// A recording, made by `lamina run SCENE --record FILE`.
    file: Option<PathBuf>,
    /// Another one, shown at the same steps.
    file2: Option<PathBuf>,
    /// Run this scene: the path of a .toml file, or the name or `name/parameter` of one of the engine's own.
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["file", "file2", "sequence"])]
    live: Option<String>,
    /// Number of bodies of the scene, as it takes it.
    #[arg(long, value_name = "N", requires = "live")]
    bodies: Option<usize>,
    /// Where the scene's random numbers come from.
    #[arg(long, value_name = "N", requires = "live", default_value_t = 1)]
    seed: u64,
    /// Record what happens, and what is done, as it happens.
    #[arg(long, value_name = "FILE", requires = "live")]
    record: Option<PathBuf>,
    /// Write a picture of the window (PNG) and end; no display is needed.
    #[arg(long, value_name = "OUT", conflicts_with = "sequence")]
    screenshot: Option<PathBuf>,
    /// The frame to show first, from 0; with --live so many steps are taken first.
    #[arg(long, value_name = "N", conflicts_with = "frames")]
    frame: Option<usize>,
    /// Frames of a sequence, B not included.
    #[arg(long, value_name = "A..B", value_parser = range, requires = "sequence")]
    frames: Option<std::ops::Range<usize>>,
    /// Write a picture of each frame into this folder and end.
    #[arg(long, value_name = "DIR")]
    sequence: Option<PathBuf>,
    /// Size of pictures, or of the window at first, pixels.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "1280x800")]
    size: [usize; 2],
    /// Dark.
    #[arg(long, conflicts_with = "light")]
    dark: bool,
    /// Light.
    #[arg(long)]
    light: bool,
    /// What colours say.
    #[arg(long, value_enum, ignore_case = true)]
    colour: Option<Colour>,
    /// Show contact points, normals and impulses.
    #[arg(long)]
    contacts: bool,
    /// Show all bodies' trails over so many frames.
    #[arg(long, value_name = "N")]
    trails: Option<usize>,
    /// Draw the second recording over the first, not beside it.
    #[arg(long, requires = "file2")]
    overlay: bool,
}

fn size(given: &str) -> Result<[usize; 2], String> {
    let sides = given.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides
        .filter(|sides: &[usize; 2]| sides.iter().all(|side| (64..=MOST_PIXELS).contains(side)))
        .ok_or_else(|| format!("not WIDTHxHEIGHT with sides of 64 to {MOST_PIXELS} pixels, like 1280x800"))
}

fn range(given: &str) -> Result<std::ops::Range<usize>, String> {
    let ends = given.split_once("..").and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
    ends.filter(|ends: &std::ops::Range<usize>| !ends.is_empty())
        .ok_or_else(|| "not A..B with A less than B, like 0..100".to_owned())
}

/// Applies what the command line says to what was chosen before.
fn choose(args: &Args, view: &mut View) {
    if args.dark || args.light {
        view.dark = args.dark;
    }
    if let Some(colour) = args.colour {
        view.colour = colour;
    }
    if args.contacts {
        (view.contacts, view.normals, view.impulses) = (true, true, true);
    }
    if let Some(frames) = args.trails {
        (view.trails, view.trail_frames) = (TrailsOf::All, frames);
    }
    if args.overlay {
        view.arrangement = Arrangement::Overlaid;
    }
}

/// Opens what was named; what is damaged is said.
fn load(args: &Args) -> anyhow::Result<Viewer> {
    let mut viewer = Viewer::default();
    if let Some(name) = &args.live {
        let (scene, settings) = scene::load(name, args.bodies, args.seed)?;
        let mut live = Live::new(scene, settings, args.record.clone())?;
        for _ in 0..args.frame.unwrap_or(0) {
            if !live.step() {
                break;
            }
        }
        viewer.set_live(live);
        return Ok(viewer);
    }
    if let Some(path) = &args.file {
        viewer.open(path)?;
    }
    if let Some(path) = &args.file2 {
        viewer.open_second(path)?;
    }
    for pane in &viewer.panes {
        if let Some(loss) = pane.source.loss() {
            eprintln!("{} is damaged or unfinished: {loss}", pane.source.name());
        }
    }
    let frames = viewer.playback.frames();
    if let Some(frame) = args.frame {
        ensure!(
            frame < frames,
            "--frame {frame}: there is no such frame, the recording has {frames}, from 0"
        );
        viewer.playback.go_to(frame);
    }
    if let Some(range) = &args.frames {
        ensure!(range.end <= frames, "--frames {}..{}: the recording has {frames}", range.start, range.end);
    }
    if args.sequence.is_some() && args.file.is_none() {
        bail!("--sequence: there is no recording to take frames from; name one first");
    }
    Ok(viewer)
}

fn window(args: &Args, mut viewer: Viewer) -> anyhow::Result<()> {
    let size = args.size.map(|side| side as f32);
    let options = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default()
            .with_inner_size(size)
            .with_min_inner_size([640.0, 420.0]),
        multisampling: 4,
        ..eframe::NativeOptions::default()
    };
    let start = |creation: &eframe::CreationContext<'_>| {
        if let Some(view) = creation.storage.and_then(stored_view) {
            viewer.view = view;
        }
        choose(args, &mut viewer.view);
        Ok(Box::new(viewer) as Box<dyn eframe::App>)
    };
    eframe::run_native("lamina-viewer", options, Box::new(start))
        .map_err(|why| why.to_string())
        // winit begins with the place in its own source.
        .map_err(|why| why.rsplit(": ").next().unwrap_or(&why).trim_end_matches('.').to_owned())
        .map_err(|why| anyhow!("no window could be opened: {why}; --screenshot needs none"))
}

fn run(args: &Args, mut viewer: Viewer) -> anyhow::Result<()> {
    if args.screenshot.is_none() && args.sequence.is_none() {
        return window(args, viewer);
    }
    choose(args, &mut viewer.view);
    let mut camera = Camera::new(args.size);
    if let Some(path) = &args.screenshot {
        write_png(camera.take(&mut viewer), path)?;
    }
    if let Some(folder) = &args.sequence {
        let frames = args.frames.clone().unwrap_or(0..viewer.playback.frames());
        write_sequence(&mut viewer, &mut camera, frames, folder)?;
    }
    Ok(())
}

fn main() -> ExitCode {
    if let Err(sentence) = lamina2d::processor::check() {
        eprintln!("lamina-viewer: {sentence}");
        return ExitCode::from(2);
    }
    set_stamp(Stamp {
        commit: env!("LAMINA_COMMIT"),
        rustc: env!("LAMINA_RUSTC"),
        flags: env!("LAMINA_FLAGS"),
    });
    let args = Args::parse();
    let (why, code) = match load(&args) {
        Err(why) => (why, 2),
        Ok(viewer) => match run(&args, viewer) {
            Err(why) => (why, 1),
            Ok(()) => return ExitCode::SUCCESS,
        },
    };
    eprintln!("lamina-viewer: {why:#}");
    ExitCode::from(code)
}
