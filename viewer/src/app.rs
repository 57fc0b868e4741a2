//! The viewer: what is open, what is shown of it, and what commands do.

use std::path::Path;

use eframe::egui::{self, Panel};
use lamina2d::record::Difference;
use lamina2d::session::{Action, ActionError};

use crate::canvas::{self, Camera};
use crate::command::{BINDINGS, Command};
use crate::events::{self, Mark};
use crate::live::{Live, Tool};
use crate::pane::Pane;
use crate::panels;
use crate::panels::curves::Curves;
use crate::playback::{Playback, SPEEDS};
use crate::source::{Replay, Source, SourceError};
use crate::view::{TrailsOf, View};

/// Real time between two pictures counts for no more, seconds: a window that was hidden does not leap.
const LONGEST_SECS: f64 = 0.5;
/// Where choices are stored.
const STORED: &str = "lamina-view";

/// Which part of the details is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// The selected body.
    #[default]
    Body,
    /// What was run.
    Run,
    /// How two runs differ.
    Compare,
    /// What is done to a running world.
    Live,
}

/// Everything behind the window.
#[derive(Debug, Default)]
pub struct Viewer {
    /// The runs that are open: none, one, or two.
    pub panes: Vec<Pane>,
    /// Which frame of the first is shown; the second is at the same step.
    pub playback: Playback,
    /// What is shown, and how.
    pub view: View,
    /// The part of the world in sight.
    pub camera: Camera,
    /// The selected body's slot.
    pub selected: Option<usize>,
    /// Which details are shown.
    pub tab: Tab,
    /// Steps worth a jump.
    pub marks: Vec<Mark>,
    /// Where the two runs part.
    pub difference: Option<Difference>,
    /// What went wrong last, in a sentence.
    pub error: Option<String>,
    /// The path being typed.
    pub path: String,
    /// What the list of bodies is searched for.
    pub filter: String,
    /// Curves over time.
    pub curves: Curves,
    /// Is the list of keys open?
    pub help: bool,
    /// Is the view to be fitted to the bodies at the next drawing?
    pub fit: bool,
    /// What a click on the canvas does to a running world.
    pub tool: Tool,
    /// Pictures per second, of late.
    pub fps: f64,
    /// The camera as it was fitted last, and the size of the canvas then, points.
    pub fitted: Option<(Camera, [f32; 2])>,
    /// The scale egui was told last.
    scaled: Option<f32>,
}

impl Viewer {
    /// A viewer without a run.
    pub fn new(view: View) -> Self {
        Self { view, ..Self::default() }
    }

    /// Opens a recording in place of what is open.
    ///
    /// # Errors
    /// A file that is no recording; then what is open stays.
    pub fn open(&mut self, path: &Path) -> Result<(), SourceError> {
        let source = Replay::open(path)?;
        self.set_source(Box::new(source));
        Ok(())
    }

    /// Shows a running world in place of what is open.
    pub fn set_live(&mut self, live: Live) {
        self.set_source(Box::new(live));
        self.tab = Tab::Live;
        self.follow_live();
    }

    /// The running world, if one is open.
    pub fn live(&mut self) -> Option<&mut Live> {
        self.panes.first_mut().and_then(|pane| pane.source.live())
    }

    /// Shows a running world as it is now.
    pub fn follow_live(&mut self) {
        if self.live().is_none() {
            return;
        }
        if let Some(pane) = self.panes.first_mut() {
            let source = &pane.source;
            self.playback.follow(source.first()..source.frames(), |frame| source.time_of(frame));
            pane.refresh();
        }
    }

    /// Does something to the running world, as it is now, and says so where that cannot be.
    pub fn act<T>(&mut self, action: impl FnOnce(&mut Live) -> Result<T, ActionError>) -> Option<T> {
        let done = self.live().map(action)?;
        self.follow_live();
        match done {
            Ok(done) => Some(done),
            Err(why) => {
                self.error = Some(why.to_string());
                None
            }
        }
    }

    /// Opens a recording beside the first, or as the first if there is none.
    ///
    /// # Errors
    /// A file that is no recording.
    pub fn open_second(&mut self, path: &Path) -> Result<(), SourceError> {
        if self.panes.is_empty() {
            return self.open(path);
        }
        let source = Replay::open(path)?;
        self.panes.truncate(1);
        self.panes.push(Pane::new(Box::new(source)));
        self.tab = Tab::Compare;
        self.find_marks();
        self.fit = true;
        Ok(())
    }

    /// Shows a source in place of what is open.
    pub fn set_source(&mut self, source: Box<dyn Source>) {
        let times = (0..source.frames()).map(|frame| source.time_of(frame)).collect();
        self.playback.set_times(times);
        self.panes = vec![Pane::new(source)];
        self.selected = None;
        self.error = None;
        self.tab = Tab::Run;
        self.fit = true;
        self.find_marks();
    }

    /// Closes the second recording.
    pub fn close_second(&mut self) {
        self.panes.truncate(1);
        self.tab = Tab::Body;
        self.find_marks();
    }

    /// Opens what the user typed or dropped, and says so if it cannot be.
    pub fn try_open(&mut self, path: &Path, second: bool) {
        let opened = if second { self.open_second(path) } else { self.open(path) };
        self.error = opened.err().map(|why| why.to_string());
    }

    fn find_marks(&mut self) {
        self.curves.forget();
        self.difference = None;
        self.marks = self.panes.first().map(|pane| events::marks(pane.source.as_ref())).unwrap_or_default();
        if let [a, b] = self.panes.as_mut_slice() {
            match events::difference(a.source.as_mut(), b.source.as_mut()) {
                Ok(Some((mark, difference))) => {
                    self.marks.push(mark);
                    self.difference = Some(difference);
                }
                Ok(None) => {}
                Err(why) => self.error = Some(why.to_string()),
            }
        }
        self.marks.sort_by_key(|mark| mark.step);
    }

    /// Does what a key or a button asks for.
    pub fn run(&mut self, command: Command) {
        let at_present = self.playback.at_present();
        let playback = &mut self.playback;
        match command {
            Command::Play => {
                playback.toggle();
                if at_present && !playback.playing() {
                    self.find_marks();
                }
            }
            Command::Step(by) => {
                playback.step(by.into());
                if by > 0 && at_present {
                    self.step_live();
                }
            }
            Command::Jump(by) => playback.jump(f64::from(by) * 0.1),
            Command::First => playback.go_to(playback.first()),
            Command::Last => playback.go_to(playback.last()),
            Command::Speed(by) => {
                let at = SPEEDS.iter().position(|speed| *speed >= playback.speed).unwrap_or(SPEEDS.len() - 1);
                playback.speed = SPEEDS[at.saturating_add_signed(by.into()).min(SPEEDS.len() - 1)];
            }
            Command::Loop => playback.looping = !playback.looping,
            Command::Fit => self.fit = true,
            Command::Follow => self.view.follow = !self.view.follow,
            Command::Deselect => self.selected = None,
            Command::Help => self.help = !self.help,
            Command::Use(tool) => self.tool = tool,
            Command::Pin => {
                if let Some(slot) = self.selected {
                    self.act(|live| live.toggle_static(slot));
                }
            }
            Command::Delete => {
                if let Some(slot) = self.selected
                    && self.act(|live| live.act(Action::Remove { slot: slot as u32 })).is_some()
                {
                    self.selected = None;
                }
            }
        }
    }

    fn step_live(&mut self) {
        if let Some(live) = self.live() {
            live.step();
        }
        self.follow_live();
        self.tell_stop();
    }

    /// Pauses, and says so, where a running world has stopped by itself.
    fn tell_stop(&mut self) {
        if let Some(why) = self.live().and_then(|live| live.stopped().map(str::to_owned)) {
            self.playback.pause();
            self.error = Some(format!("it has stopped: {why}"));
            self.find_marks();
        }
    }

    /// Lets time pass: a running world steps, a recording moves on.
    fn pass(&mut self, elapsed_secs: f64) {
        let speed = self.playback.speed;
        let Some(taken) = self.live().map(|live| live.advance(elapsed_secs, speed)) else {
            return self.playback.advance(elapsed_secs);
        };
        if taken > 0 {
            self.follow_live();
        }
        self.tell_stop();
    }

    /// The step of the frame that is shown.
    pub fn step(&self) -> u64 {
        self.panes.first().map_or(0, |pane| pane.source.step_of(self.playback.frame()).unwrap_or(0))
    }

    /// Reads the frames that are to be shown.
    pub fn sync(&mut self) {
        let (frame, step) = (self.playback.frame(), self.step());
        for (at, pane) in self.panes.iter_mut().enumerate() {
            pane.show(if at == 0 { frame } else { pane.source.frame_at(step).unwrap_or(0) });
            let length = if self.view.trails == TrailsOf::None { 0 } else { self.view.trail_frames };
            pane.extend_trail(length);
        }
        if let (true, Some(slot), Some(pane)) = (self.view.follow, self.selected, self.panes.first())
            && let Some(position) = pane.position(slot).filter(|at| at.iter().all(|value| value.is_finite()))
        {
            self.camera.centre = position;
        }
    }

    /// Keys, dropped files, and the time that has passed.
    fn listen(&mut self, ctx: &egui::Context) {
        if !ctx.text_edit_focused() {
            for binding in &BINDINGS {
                if ctx.input_mut(|input| input.consume_key(binding.modifiers, binding.key)) {
                    self.run(binding.command);
                }
            }
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        for (at, path) in dropped.iter().map(|file| file.path()).take(2).enumerate() {
            self.try_open(path, at == 1);
        }
        let elapsed = ctx.input(|input| f64::from(input.stable_dt)).min(LONGEST_SECS);
        if self.playback.playing() {
            self.fps = if elapsed > 0.0 { 0.9 * self.fps + 0.1 / elapsed } else { self.fps };
            self.pass(elapsed);
            canvas::again(ctx);
        } else {
            self.fps = 0.0;
        }
    }

    /// Takes over a scale that was chosen in the panel, or by egui's own keys (ctrl + and -).
    fn scale(&mut self, ctx: &egui::Context) {
        let chosen = self.view.ui_scale;
        if self.scaled != Some(chosen) {
            ctx.set_zoom_factor(chosen);
        } else if ctx.zoom_factor() != chosen {
            self.view.ui_scale = ctx.zoom_factor();
        }
        self.scaled = Some(self.view.ui_scale);
    }

    /// Draws the whole window.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        let ctx = ui.ctx().clone();
        ctx.set_theme(if self.view.dark { egui::Theme::Dark } else { egui::Theme::Light });
        self.scale(&ctx);
        self.listen(&ctx);
        self.sync();
        Panel::top("bar").show(ui, |ui| panels::bar::show(ui, self));
        Panel::bottom("timeline").show(ui, |ui| panels::timeline::show(ui, self));
        Panel::left("view").resizable(false).exact_size(176.0).show(ui, |ui| panels::choices::show(ui, self));
        Panel::right("details")
            .default_size(320.0)
            .size_range(240.0..=600.0)
            .show(ui, |ui| panels::details(ui, self));
        if !self.panes.is_empty() {
            let curves =
                Panel::bottom("curves").resizable(true).default_size(190.0).size_range(110.0..=500.0);
            curves.show(ui, |ui| panels::curves::show(ui, self));
        }
        egui::CentralPanel::no_frame().show(ui, |ui| panels::stage::show(ui, self));
        panels::keys::show(&ctx, self);
        // What was clicked during this drawing is shown by the next.
        if self.panes.first().is_some_and(|pane| pane.frame().step != self.step() && pane.error().is_none()) {
            canvas::again(&ctx);
        }
    }
}

impl eframe::App for Viewer {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }
    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        if let Some(Err(why)) = self.live().map(Live::finish) {
            eprintln!("lamina-viewer: {why}");
        }
    }
    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, STORED, &self.view);
    }
}

/// The choices of the last time.
pub fn stored_view(storage: &dyn eframe::Storage) -> Option<View> {
    eframe::get_value(storage, STORED)
}
