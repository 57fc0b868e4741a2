//! Numbers of every step over time, with a cursor at the frame that is shown.

use eframe::egui::{Color32, Ui};
use egui_plot::{Legend, Line, LineStyle, Plot, PlotPoint, PlotPoints, VLine};
use lamina2d::record::StepRow;

use crate::app::Viewer;
use crate::canvas::Palette;

/// Points of a curve at most; of each bucket of steps the least and the greatest are kept.
pub const MOST_POINTS: usize = 4000;

/// Which numbers are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// Kinetic, potential, and their sum, J.
    #[default]
    Energy,
    /// kg·m/s and kg·m²/s.
    Momentum,
    /// Largest and mean, metres.
    Overlap,
    /// How many.
    Contacts,
    /// Nanoseconds per stage.
    Times,
}

/// A curve's name, and its number in a row.
type Curve = (&'static str, fn(&StepRow) -> f64);

/// A column of the row by its name.
macro_rules! column {
    ($name:literal) => {
        ($name, |row: &StepRow| row.get($name).unwrap_or(f64::NAN))
    };
}

impl Quantity {
    /// Every choice, in order.
    pub const ALL: [Self; 5] = [Self::Energy, Self::Momentum, Self::Overlap, Self::Contacts, Self::Times];

    /// The name on its tab.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Energy => "Energy",
            Self::Momentum => "Momentum",
            Self::Overlap => "Overlap",
            Self::Contacts => "Contacts",
            Self::Times => "Stage times",
        }
    }

    /// Of its numbers.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Energy => "J",
            Self::Momentum => "kg·m/s, kg·m²/s",
            Self::Overlap => "m",
            Self::Contacts => "number",
            Self::Times => "ns",
        }
    }

    fn curves(self) -> &'static [Curve] {
        match self {
            Self::Energy => {
                const {
                    &[
                        ("energy", crate::events::energy),
                        column!("kinetic_energy"),
                        column!("potential_energy"),
                    ]
                }
            }
            Self::Momentum => {
                const { &[column!("momentum_x"), column!("momentum_y"), column!("angular_momentum")] }
            }
            Self::Overlap => const { &[column!("max_overlap"), column!("mean_overlap")] },
            Self::Contacts => {
                const { &[column!("contacts"), column!("pairs"), column!("candidates"), column!("sleeping")] }
            }
            Self::Times => {
                const {
                    &[
                        column!("broad_ns"),
                        column!("narrow_ns"),
                        column!("prepare_ns"),
                        column!("integrate_ns"),
                        column!("solve_ns"),
                        column!("measure_ns"),
                    ]
                }
            }
        }
    }
}

/// A curve ready to be drawn: seconds and its number.
#[derive(Debug)]
struct Drawn {
    name: String,
    points: Vec<PlotPoint>,
    /// Of which run.
    pane: usize,
    /// Which of the quantity's curves.
    at: usize,
}

/// The curves that are shown, and the points they were thinned to.
#[derive(Debug, Default)]
pub struct Curves {
    /// Which numbers are drawn.
    pub quantity: Quantity,
    drawn: Vec<Drawn>,
    /// What they were made of: the quantity and the rows of each run.
    made_of: Option<(Quantity, Vec<usize>)>,
}

impl Curves {
    /// Other runs are open.
    pub fn forget(&mut self) {
        self.made_of = None;
    }

    fn make(&mut self, panes: &[crate::pane::Pane]) {
        let made_of = Some((self.quantity, panes.iter().map(|pane| pane.source.rows().len()).collect()));
        if self.made_of == made_of {
            return;
        }
        self.made_of = made_of;
        self.drawn.clear();
        for (pane, run) in panes.iter().enumerate() {
            for (at, (name, value)) in self.quantity.curves().iter().enumerate() {
                let points = thin(run.source.rows(), value);
                let name = name.replace('_', " ");
                self.drawn.push(Drawn { name, points, pane, at });
            }
        }
    }
}

/// Seconds and numbers of rows, thinned to [`MOST_POINTS`]; what is not finite leaves a gap at the end of its bucket.
pub fn thin(rows: &[StepRow], value: impl Fn(&StepRow) -> f64) -> Vec<PlotPoint> {
    let point = |row: &StepRow| [row.get("time_secs").unwrap_or(f64::NAN), value(row)];
    let finite = |point: &[f64; 2]| point.iter().all(|value| value.is_finite());
    if rows.len() <= MOST_POINTS {
        return rows.iter().map(point).filter(finite).map(PlotPoint::from).collect();
    }
    let size = rows.len().div_ceil(MOST_POINTS / 2);
    let mut points = Vec::with_capacity(MOST_POINTS);
    for bucket in rows.chunks(size) {
        let known = || bucket.iter().map(point).filter(finite);
        let least = known().min_by(|a, b| a[1].total_cmp(&b[1]));
        let greatest = known().max_by(|a, b| a[1].total_cmp(&b[1]));
        let mut both: Vec<[f64; 2]> = least.into_iter().chain(greatest).collect();
        both.sort_by(|a, b| a[0].total_cmp(&b[0]));
        both.dedup();
        points.extend(both.into_iter().map(PlotPoint::from));
    }
    points
}

fn color(at: usize, palette: &Palette) -> Color32 {
    let colors = [
        palette.shapes[1],
        palette.shapes[0],
        palette.shapes[2],
        palette.contact,
        palette.kinematic,
        palette.text,
    ];
    colors[at % colors.len()]
}

/// A number beside an axis.
fn tick(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.1e}");
    }
    let digits = format!("{value:.4}");
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Draws them.
pub fn show(ui: &mut Ui, viewer: &mut Viewer) {
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        for quantity in Quantity::ALL {
            ui.selectable_value(&mut viewer.curves.quantity, quantity, quantity.name());
        }
        ui.weak(viewer.curves.quantity.unit());
        if viewer.panes.len() > 1 {
            ui.weak("dashed: the second");
        }
    });
    viewer.curves.make(&viewer.panes);
    let palette = Palette::of(viewer.view.dark);
    let (now, cursor) = (viewer.playback.time_secs(), ui.visuals().strong_text_color());
    let drawn = &viewer.curves.drawn;
    let id = ("curves", viewer.curves.quantity as u8);
    let plot = Plot::new(id).legend(Legend::default()).x_axis_label("seconds").allow_scroll(false);
    let plot = plot.y_axis_formatter(|mark, _| tick(mark.value));
    let shown = plot.show(ui, |plot| {
        for curve in drawn {
            let points = PlotPoints::Borrowed(&curve.points);
            let line = Line::new(curve.name.as_str(), points).color(color(curve.at, &palette)).width(1.2);
            plot.line(if curve.pane == 0 { line } else { line.style(LineStyle::dashed_dense()) });
        }
        plot.vline(VLine::new("", now).color(cursor).width(1.0));
        plot.pointer_coordinate()
    });
    super::name(&shown.response, eframe::egui::Role::GraphicsDocument, "Curves");
    if let (true, Some(at)) = (shown.response.clicked(), shown.inner) {
        viewer.playback.pause();
        viewer.playback.seek(at.x);
    }
}

#[cfg(test)]
mod tests {
    use lamina2d::record::STATISTICS;

    use super::*;

    #[test]
    fn long_curves_keep_their_peaks() {
        let row = |k: u64| {
            let mut row = StepRow { step: k, hash: 0, values: [0.0; STATISTICS.len()] };
            row.values[0] = k as f64;
            row.values[19] = if k == 54_321 { 9.0 } else { (k % 7) as f64 * 0.1 };
            row
        };
        let rows: Vec<_> = (0..100_000).map(row).collect();
        let points = thin(&rows, |row| row.get("max_overlap").unwrap_or(f64::NAN));
        assert!(points.len() <= MOST_POINTS, "{}", points.len());
        assert!(points.iter().any(|point| point.x == 54_321.0 && point.y == 9.0));
        assert!(points.is_sorted_by(|a, b| a.x <= b.x));
    }
}
