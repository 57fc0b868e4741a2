//! SVG plots of a report's rows.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::experiments::{broad_phase, matrix, stability};
use super::{Data, fitted_exponent};
use crate::settings::Solver;

/// One drawing.
#[derive(Clone, Debug)]
pub(super) struct Plot {
    /// File name in the report's folder.
    pub(super) file: &'static str,
    /// What it shows, for those who cannot see it.
    pub(super) about: String,
    /// The command that makes its rows.
    pub(super) command: &'static str,
    /// The drawing.
    pub(super) svg: String,
}

const SIZE: (u32, u32) = (760, 460);
/// Distinct for the common kinds of colour blindness (Okabe and Ito, 2008).
const PALETTE: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

struct Series {
    name: String,
    points: Vec<(f64, f64)>,
}

/// All plots of a report.
pub(super) fn draw(data: &Data) -> anyhow::Result<Vec<Plot>> {
    Ok(vec![
        time_against_bodies(data)?,
        time_against_overlap(data)?,
        broad_on_off(data)?,
        lanes_speed_up(data)?,
        times_faster(data)?,
    ])
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws into a string; plotters' errors borrow the drawing, so they become text here.
fn to_svg(draw: impl Fn(&Area<'_>) -> anyhow::Result<()>) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        plot(area.fill(&WHITE))?;
        draw(&area)?;
        plot(area.present())?;
    }
    Ok(svg)
}

fn plot<T, E: std::fmt::Display>(result: Result<T, E>) -> anyhow::Result<T> {
    result.map_err(|e| anyhow::anyhow!("plot: {e}"))
}

/// A range that holds all values, widened a little, for a logarithmic axis.
fn around(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    low * 0.7..high * 1.4
}

/// Where lines leave room for their names: they rise or fall.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Slope {
    Up,
    Down,
}

fn log_log(
    title: &str,
    [x_label, y_label]: [&str; 2],
    series: &[Series],
    slope: Slope,
) -> anyhow::Result<String> {
    let xs = around(series.iter().flat_map(|s| s.points.iter().map(|p| p.0)));
    let ys = around(series.iter().flat_map(|s| s.points.iter().map(|p| p.1)));
    to_svg(|area| {
        let mut chart = plot(
            ChartBuilder::on(area)
                .caption(title, ("sans-serif", 20))
                .margin(12)
                .x_label_area_size(44)
                .y_label_area_size(70)
                .build_cartesian_2d(xs.clone().log_scale(), ys.clone().log_scale()),
        )?;
        plot(
            chart
                .configure_mesh()
                .x_desc(x_label)
                .y_desc(y_label)
                .x_label_formatter(&|v| format!("{v}"))
                .y_label_formatter(&|v| short(*v))
                .light_line_style(WHITE)
                .draw(),
        )?;
        for (k, series) in series.iter().enumerate() {
            let color = PALETTE[k % PALETTE.len()];
            let line = LineSeries::new(series.points.iter().copied(), color.stroke_width(2)).point_size(4);
            plot(chart.draw_series(line))?
                .label(&series.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(3)));
        }
        plot(
            chart
                .configure_series_labels()
                .position(match slope {
                    Slope::Up => SeriesLabelPosition::UpperLeft,
                    Slope::Down => SeriesLabelPosition::UpperRight,
                })
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.3))
                .draw(),
        )
    })
}

/// Groups of bars: for each label one bar per series.
fn bars(title: &str, y_label: &str, labels: &[String], series: &[Series]) -> anyhow::Result<String> {
    let top = series.iter().flat_map(|s| s.points.iter().map(|p| p.1)).fold(0.0, f64::max) * 1.15;
    let groups = labels.len();
    to_svg(|area| {
        let mut chart = plot(
            ChartBuilder::on(area)
                .caption(title, ("sans-serif", 20))
                .margin(12)
                .x_label_area_size(44)
                .y_label_area_size(60)
                .build_cartesian_2d(-0.5..groups as f64 - 0.5, 0.0..top),
        )?;
        let label = |x: &f64| {
            let at = x.round();
            let name = labels.get(at as usize).filter(|_| (x - at).abs() < 0.01 && at >= 0.0);
            name.cloned().unwrap_or_default()
        };
        let mesh = &mut chart.configure_mesh();
        plot(
            mesh.disable_x_mesh().x_labels(groups * 2 + 1).x_label_formatter(&label).y_desc(y_label).draw(),
        )?;
        let width = 0.8 / series.len() as f64;
        for (k, series) in series.iter().enumerate() {
            let color = PALETTE[k % PALETTE.len()];
            let left = |x: f64| x - 0.4 + width * k as f64;
            let bar = |&(x, y): &(f64, f64)| {
                Rectangle::new([(left(x), 0.0), (left(x) + width * 0.9, y)], color.filled())
            };
            plot(chart.draw_series(series.points.iter().map(bar)))?
                .label(&series.name)
                .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], color.filled()));
        }
        plot(
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .background_style(WHITE.mix(0.85))
                .border_style(BLACK.mix(0.3))
                .draw(),
        )
    })
}

/// Three significant digits without trailing zeros.
fn short(value: f64) -> String {
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 8) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn time_against_bodies(data: &Data) -> anyhow::Result<Plot> {
    let engines = [("lamina2d", 8), ("lamina2d", 1), ("tidy", 1), ("thesis", 1)];
    let series = engines.map(|(engine, lanes)| {
        let wanted = |row: &&matrix::Row| {
            row.engine == engine
                && row.lanes == lanes
                && row.mix == "polygons"
                && row.substeps != 2
                && row.integrator == "semi_implicit_euler"
        };
        let points: Vec<_> =
            data.matrix.iter().filter(wanted).map(|r| (r.bodies as f64, r.ms_per_step.median)).collect();
        let exponent = fitted_exponent(&points).map_or_else(String::new, |p| format!(", N^{p:.2}"));
        let lanes = if engine == "lamina2d" { format!(", {lanes} lanes") } else { String::new() };
        Series { name: format!("{engine}{lanes}{exponent}"), points }
    });
    Ok(Plot {
        file: "time_against_bodies.svg",
        about: "Median time per step against the number of polygons, both logarithmic, with fitted exponents"
            .to_owned(),
        command: "lamina bench",
        svg: log_log("Polygons, settled: time per step", ["bodies", "ms per step"], &series, Slope::Up)?,
    })
}

fn time_against_overlap(data: &Data) -> anyhow::Result<Plot> {
    const SCENE: &str = "stack/10";
    let stands = |row: &&stability::Row| row.scene == SCENE && row.failed.is_none() && row.moved < 0.5;
    let of = |solver: &Solver| {
        let rows: Vec<_> = data.stability.iter().filter(stands).filter(|row| row.solver == *solver).collect();
        let overlap_mm = |row: &stability::Row| row.max_penetration.max(1e-7) * 1e3;
        let mut points: Vec<_> = rows.iter().map(|row| (row.ms_per_step, overlap_mm(row))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let substeps: Vec<_> = rows.iter().map(|row| row.substeps.to_string()).collect();
        Series { name: format!("{solver}: {} substeps", substeps.join(", ")), points }
    };
    let series: Vec<_> = Solver::ALL.iter().map(of).filter(|s| !s.points.is_empty()).collect();
    Ok(Plot {
        file: "time_against_overlap.svg",
        about:
            "Largest overlap of a stack of ten boxes against the median time per step, by solver and substeps"
                .to_owned(),
        command: "lamina report",
        svg: log_log(
            "Ten boxes at rest: error against run time",
            ["ms per step", "largest overlap mm"],
            &series,
            Slope::Down,
        )?,
    })
}

fn broad_on_off(data: &Data) -> anyhow::Result<Plot> {
    let mut series = Vec::new();
    for engine in ["lamina2d", "thesis"] {
        let rows: Vec<_> = data.broad_phase.iter().filter(|r| r.engine == engine).collect();
        let mut add = |what: &str, time: fn(&broad_phase::Row) -> f64| {
            let points: Vec<_> = rows.iter().map(|r| (r.bodies as f64, time(r))).collect();
            let exponent = fitted_exponent(&points).map_or_else(String::new, |p| format!(", N^{p:.2}"));
            series.push(Series { name: format!("{engine}, {what}{exponent}"), points });
        };
        add("on", |r| r.on_ms);
        add("off", |r| r.off_ms);
    }
    Ok(Plot {
        file: "broad_on_off.svg",
        about: "Median time per step with the broad phase on and off, 60 to 200 polygons".to_owned(),
        command: "lamina bench",
        svg: log_log("Polygons: broad phase on and off", ["bodies", "ms per step"], &series, Slope::Up)?,
    })
}

fn lanes_speed_up(data: &Data) -> anyhow::Result<Plot> {
    let mut kernels: Vec<String> = Vec::new();
    for row in &data.lanes {
        if !kernels.iter().any(|k| k == row.kernel) {
            kernels.push(row.kernel.to_owned());
        }
    }
    let series = [4, 8, 16].map(|lanes| {
        let of = |(k, kernel): (usize, &String)| {
            let row = data.lanes.iter().find(|r| r.kernel == kernel && r.lanes == lanes);
            (k as f64, row.map_or(0.0, |r| r.speed_up))
        };
        Series { name: format!("{lanes} lanes"), points: kernels.iter().enumerate().map(of).collect() }
    });
    Ok(Plot {
        file: "lanes.svg",
        about: "How many times faster than one lane each kernel runs at 4, 8 and 16 lanes".to_owned(),
        command: "lamina report",
        svg: bars("Kernels: speed-up over one lane", "times faster", &kernels, &series)?,
    })
}

fn times_faster(data: &Data) -> anyhow::Result<Plot> {
    let smallest = data.matrix.iter().map(|r| r.bodies).min().unwrap_or(0);
    let headlines: Vec<_> = data.headlines().into_iter().filter(|h| h.bodies == smallest).collect();
    let with = |substeps| headlines.iter().filter(move |h| h.substeps == substeps);
    let labels: Vec<String> = with(4).map(|h| h.mix.clone()).collect();
    let series = |name: &str, substeps, of: fn(&super::Headline) -> Option<f64>| {
        let points = with(substeps).enumerate().map(|(k, h)| (k as f64, of(h).unwrap_or(0.0)));
        Series { name: format!("against {name}, {substeps} substeps"), points: points.collect() }
    };
    let series = [
        series("thesis", 2, |h| h.times_thesis),
        series("thesis", 4, |h| h.times_thesis),
        series("tidy", 2, |h| h.times_tidy),
        series("tidy", 4, |h| h.times_tidy),
    ];
    Ok(Plot {
        file: "times_faster.svg",
        about: format!("How many times faster than the thesis engine each mix of {smallest} bodies runs"),
        command: "lamina bench",
        svg: bars(&format!("{smallest} bodies, settled: times faster"), "times faster", &labels, &series)?,
    })
}
