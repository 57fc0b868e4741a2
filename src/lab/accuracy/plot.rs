//! Run time against error, one drawing per case, and the profiles over all cases.

use plotters::coord::Shift;
use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;

use lamina2d::settings::{Precision, Settings};

use super::best::{Cost, Profile, pareto};
use super::sweep::{Results, Row};
use crate::present::chart::{Area, PALETTE, around, plot, to_svg};

const SIZE: (u32, u32) = (1000, 560);
/// For the legend, to the right of the curves.
const LEGEND_PX: u32 = 300;
/// Errors below this are drawn at it: a logarithm has no zero.
const LEAST: f64 = 1e-17;
const GREY: RGBColor = RGBColor(120, 120, 120);

/// Whole powers of ten around all values.
fn decades(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let range = around(values);
    10f64.powf(range.start.log10().floor())..10f64.powf(range.end.log10().ceil())
}

/// Beside the palette's colours, for cases of many methods.
const MORE: [RGBColor; 9] = [
    RGBColor(120, 80, 30),
    RGBColor(90, 90, 90),
    RGBColor(110, 60, 170),
    RGBColor(170, 0, 60),
    RGBColor(90, 130, 0),
    RGBColor(0, 130, 140),
    RGBColor(240, 110, 110),
    RGBColor(150, 150, 220),
    RGBColor(60, 60, 20),
];

fn colour(k: usize) -> RGBColor {
    *PALETTE.iter().chain(&MORE).nth(k % (PALETTE.len() + MORE.len())).unwrap_or(&BLACK)
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

/// One method at one precision.
struct Line<'a> {
    method: &'a str,
    color: RGBColor,
    precision: &'static str,
    rows: Vec<&'a Row>,
}

/// A case: error on x, cost on y; `None` where no run came to its end, or none was counted.
pub(super) fn case(results: &Results, cost: Cost) -> anyhow::Result<Option<String>> {
    let lines = lines(results);
    let best = pareto(results, cost);
    let point = |row: &Row| Some((row.error?.max(LEAST), cost.of(row)?));
    let drawn = || lines.iter().flat_map(|line| line.rows.iter().filter_map(|row| point(row)));
    if drawn().next().is_none() {
        return Ok(None);
    }
    let xs = decades(drawn().map(|p| p.0).chain(Some(results.floor).filter(|floor| *floor > 0.0)));
    let ys = decades(drawn().map(|p| p.1));
    let case = results.case;
    let svg = to_svg(SIZE, |area| {
        let (left, right) = area.split_horizontally(SIZE.0 - LEGEND_PX);
        let mut chart = plot(
            ChartBuilder::on(&left)
                .caption(format!("{} {}", case.item, case.about), ("sans-serif", 19))
                .margin(12)
                .x_label_area_size(48)
                .y_label_area_size(64)
                .build_cartesian_2d(xs.clone().log_scale(), ys.clone().log_scale()),
        )?;
        mesh(&mut chart, &format!("error, {}", case.unit), cost.title())?;
        floors(&mut chart, results, &ys)?;
        for line in &lines {
            draw(&mut chart, line, &best, cost)?;
        }
        staircase(&mut chart, &best, xs.end, cost)?;
        legend(&right, &lines)
    })?;
    Ok(Some(svg))
}

/// Methods in order, each in both precisions, at the usual lane widths.
fn lines(results: &Results) -> Vec<Line<'_>> {
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut methods: Vec<&str> = Vec::new();
    for row in results.told() {
        let precision = if row.precision == "f32" { Precision::F32 } else { Precision::F64 };
        if row.lanes != Settings::default().with_precision(precision).lanes {
            continue;
        }
        if !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
        let color = colour(methods.len() - 1);
        let same = |line: &&mut Line<'_>| line.method == row.method && line.precision == row.precision;
        match lines.last_mut().filter(same) {
            Some(line) => line.rows.push(row),
            None => {
                lines.push(Line { method: &row.method, color, precision: row.precision, rows: vec![row] });
            }
        }
    }
    lines
}

fn mesh(chart: &mut Chart<'_, '_>, x: &str, y: &str) -> anyhow::Result<()> {
    plot(
        chart
            .configure_mesh()
            .x_desc(x)
            .y_desc(y)
            .x_labels(9)
            .y_labels(9)
            .x_label_formatter(&|v| power_of_ten(*v))
            .y_label_formatter(&|v| power_of_ten(*v))
            .bold_line_style(BLACK.mix(0.12))
            .light_line_style(TRANSPARENT)
            .draw(),
    )
}

/// 10ⁿ; nothing for what is no power of ten.
fn power_of_ten(value: f64) -> String {
    let exponent = value.log10().round();
    if (value / 10f64.powf(exponent) - 1.0).abs() > 1e-6 {
        return String::new();
    }
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    format!("10{}", (exponent as i32).to_string().chars().map(raised).collect::<String>())
}

/// Dashed: the least error of any `f32` run, and how sure the reference is.
fn floors(chart: &mut Chart<'_, '_>, results: &Results, ys: &std::ops::Range<f64>) -> anyhow::Result<()> {
    let single = results.rows.iter().filter(|row| row.precision == "f32").filter_map(|row| row.error);
    let single = single.fold(f64::INFINITY, f64::min);
    let lines = [(single, "f32 floor"), (results.floor, "reference floor")];
    for (k, (at, name)) in lines.into_iter().filter(|(at, _)| at.is_finite() && *at > 0.0).enumerate() {
        let at = at.max(LEAST);
        let line = DashedLineSeries::new([(at, ys.start), (at, ys.end)], 5, 4, GREY.stroke_width(1));
        plot(chart.draw_series(line))?;
        let low = ys.start * (ys.end / ys.start).powf(0.03 + 0.05 * k as f64);
        let text = Text::new(format!(" {name}"), (at, low), ("sans-serif", 12).into_font().color(&GREY));
        plot(chart.draw_series(std::iter::once(text)))?;
    }
    Ok(())
}

/// A line with a marker per step: full for `f64`, hollow for `f32`; pale where another run is better in both.
fn draw(chart: &mut Chart<'_, '_>, line: &Line<'_>, best: &[&Row], cost: Cost) -> anyhow::Result<()> {
    let single = line.precision == "f32";
    let width = if single { 1 } else { 2 };
    let points: Vec<_> =
        line.rows.iter().filter_map(|row| Some((*row, row.error?.max(LEAST), cost.of(row)?))).collect();
    let style = line.color.mix(0.45).stroke_width(width);
    // A gap in the middle is not bridged.
    for part in line.rows.split(|row| row.error.is_none() || cost.of(row).is_none()) {
        let part = part.iter().filter_map(|row| Some((row.error?.max(LEAST), cost.of(row)?)));
        plot(chart.draw_series(LineSeries::new(part, style)))?;
    }
    let marker = |(row, x, y): &(&Row, f64, f64)| {
        let strength = if best.iter().any(|other| std::ptr::eq(*other, *row)) { 1.0 } else { 0.45 };
        let color = line.color.mix(strength);
        Circle::new((*x, *y), 3, if single { color.stroke_width(1) } else { color.filled() })
    };
    plot(chart.draw_series(points.iter().map(marker)))?;
    Ok(())
}

/// What no run beats: for each time the least error reached by then.
fn staircase(chart: &mut Chart<'_, '_>, best: &[&Row], most: f64, cost: Cost) -> anyhow::Result<()> {
    let mut steps = Vec::new();
    let mut from = most;
    for row in best {
        if let (Some(error), Some(ns)) = (row.error, cost.of(row)) {
            let error = error.max(LEAST);
            steps.extend([(from, ns), (error, ns)]);
            from = error;
        }
    }
    plot(chart.draw_series(LineSeries::new(steps, BLACK.stroke_width(1))))?;
    Ok(())
}

/// Height of the k-th entry of a legend, pixels from the top.
fn entry_y(k: usize) -> anyhow::Result<i32> {
    Ok(56 + 20 * i32::try_from(k)?)
}

/// Names beside the curves, with the order observed.
fn legend(area: &DrawingArea<SVGBackend<'_>, Shift>, lines: &[Line<'_>]) -> anyhow::Result<()> {
    let entry = |k: usize, name: String, color: RGBColor, width: u32, marker: Option<ShapeStyle>| {
        let y = entry_y(k)?;
        plot(area.draw(&PathElement::new([(4, y), (28, y)], color.stroke_width(width))))?;
        marker.map_or(Ok(()), |style| plot(area.draw(&Circle::new((16, y), 3, style))))?;
        plot(area.draw(&Text::new(name, (36, y - 6), ("sans-serif", 13))))
    };
    let mut methods: Vec<&Line<'_>> = Vec::new();
    for line in lines {
        if methods.iter().all(|other| other.method != line.method) {
            methods.push(line);
        }
    }
    for (k, line) in methods.iter().enumerate() {
        let order = line.rows.iter().find_map(|row| row.order);
        let order = order.map_or_else(String::new, |order| format!(", order {order:.2}"));
        entry(k, format!("{}{order}", line.method), line.color, 2, Some(line.color.filled()))?;
    }
    let below = methods.len();
    entry(below, "f64".to_owned(), GREY, 2, Some(GREY.filled()))?;
    entry(below + 1, "f32".to_owned(), GREY, 1, Some(GREY.stroke_width(1)))?;
    entry(below + 2, "not beaten by any run at any width".to_owned(), BLACK, 1, None)
}

/// Profiles at one error: the share of cases a method solves within τ times the best time, over τ.
pub(super) fn profiles(level: f64, profiles: &[Profile]) -> anyhow::Result<String> {
    let cases = profiles.first().map_or(0, |profile| profile.ratios.len());
    to_svg(SIZE, |area| {
        let (left, right) = area.split_horizontally(SIZE.0 - LEGEND_PX);
        let title =
            format!("Cases solved to {} within τ times the best time, of {cases}", power_of_ten(level));
        let mut chart = plot(
            ChartBuilder::on(&left)
                .caption(title, ("sans-serif", 19))
                .margin(12)
                .x_label_area_size(48)
                .y_label_area_size(64)
                .build_cartesian_2d((1.0..1e5).log_scale(), 0.0..1.02),
        )?;
        plot(
            chart
                .configure_mesh()
                .x_desc("τ")
                .y_desc("share of cases")
                .x_labels(6)
                .x_label_formatter(&|v| power_of_ten(*v))
                .bold_line_style(BLACK.mix(0.12))
                .light_line_style(TRANSPARENT)
                .draw(),
        )?;
        for (k, profile) in profiles.iter().enumerate() {
            // Rows come in f64, then f32.
            let (color, single) = (colour(k / 2), profile.method.ends_with("f32"));
            let width = if single { 1 } else { 2 };
            let mut steps = vec![(1.0, profile.share(1.0))];
            for ratio in profile.ratios.iter().filter(|ratio| **ratio > 1.0 && ratio.is_finite()) {
                let before = steps.last().map_or(0.0, |step| step.1);
                steps.extend([(*ratio, before), (*ratio, profile.share(*ratio))]);
            }
            steps.push((1e5, steps.last().map_or(0.0, |step| step.1)));
            plot(chart.draw_series(LineSeries::new(steps, color.stroke_width(width))))?;
            profile_entry(&right, k, profile, color.stroke_width(width))?;
        }
        Ok(())
    })
}

fn profile_entry(area: &Area<'_>, k: usize, profile: &Profile, style: ShapeStyle) -> anyhow::Result<()> {
    let y = entry_y(k)?;
    plot(area.draw(&PathElement::new([(4, y), (28, y)], style)))?;
    plot(area.draw(&Text::new(profile.method.clone(), (36, y - 6), ("sans-serif", 13))))
}
