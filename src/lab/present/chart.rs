//! Charts of the kinds a report needs, drawn into SVG text.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::present::table::significant;

const SIZE: (u32, u32) = (760, 460);
/// Distinct for the common kinds of colour blindness (Okabe and Ito, 2008).
pub(crate) const PALETTE: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Text on the darkest shade: not quite white, which the page turns into its paper's colour.
const ON_DARK: RGBColor = RGBColor(254, 254, 254);

/// Named points of one line, or the heights of one set of bars.
pub(crate) struct Series {
    /// In the legend.
    pub(crate) name: String,
    /// x and y.
    pub(crate) points: Vec<(f64, f64)>,
}

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws into a string; plotters' errors borrow the drawing, so they become text here.
pub(crate) fn to_svg(
    size: (u32, u32),
    draw: impl Fn(&Area<'_>) -> anyhow::Result<()>,
) -> anyhow::Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        plot(area.fill(&WHITE))?;
        draw(&area)?;
        plot(area.present())?;
    }
    Ok(svg)
}

pub(crate) fn plot<T, E: std::fmt::Display>(result: Result<T, E>) -> anyhow::Result<T> {
    result.map_err(|e| anyhow::anyhow!("plot: {e}"))
}

/// A range that holds all values, widened a little, for a logarithmic axis.
pub(crate) fn around(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    low * 0.7..high * 1.4
}

/// A chart with its title and room for names: 44 pixels below it, `left` beside it.
fn titled<'a, 'b>(area: &'a Area<'b>, title: &str, left: u32) -> ChartBuilder<'a, 'static, SVGBackend<'b>> {
    let mut chart = ChartBuilder::on(area);
    chart.caption(title, ("sans-serif", 20)).margin(12).x_label_area_size(44).y_label_area_size(left);
    chart
}

/// Where lines leave room for their names: they rise or fall.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Slope {
    Up,
    Down,
}

/// Lines over two logarithmic axes.
pub(crate) fn log_log(
    title: &str,
    [x_label, y_label]: [&str; 2],
    series: &[Series],
    slope: Slope,
) -> anyhow::Result<String> {
    let xs = around(series.iter().flat_map(|s| s.points.iter().map(|p| p.0)));
    let ys = around(series.iter().flat_map(|s| s.points.iter().map(|p| p.1)));
    to_svg(SIZE, |area| {
        let mut chart =
            plot(titled(area, title, 70).build_cartesian_2d(xs.clone().log_scale(), ys.clone().log_scale()))?;
        plot(
            chart
                .configure_mesh()
                .x_desc(x_label)
                .y_desc(y_label)
                .x_labels(6)
                .x_label_formatter(&|v| significant(*v))
                .y_label_formatter(&|v| significant(*v))
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
        let place = match slope {
            Slope::Up => SeriesLabelPosition::UpperLeft,
            Slope::Down => SeriesLabelPosition::UpperRight,
        };
        legend(&mut chart, place)
    })
}

/// The names of lines and bars.
fn legend<'a, 'b: 'a, C>(
    chart: &mut ChartContext<'a, SVGBackend<'b>, C>,
    place: SeriesLabelPosition,
) -> anyhow::Result<()>
where
    C: plotters::coord::CoordTranslate,
{
    let labels = &mut chart.configure_series_labels();
    plot(labels.position(place).background_style(WHITE.mix(0.85)).border_style(BLACK.mix(0.3)).draw())
}

/// Names whole numbers from 0 up, and nothing between them.
fn label_of(names: &[String]) -> impl Fn(&f64) -> String {
    |x| {
        let at = x.round();
        let name = names.get(at as usize).filter(|_| (x - at).abs() < 0.01 && at >= 0.0);
        name.cloned().unwrap_or_default()
    }
}

/// A chart whose x axis has a label at each whole number, and whose y axis goes from 0 to `top`.
fn bar_chart<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    y_label: &str,
    labels: &[String],
    top: f64,
) -> anyhow::Result<ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>> {
    let groups = labels.len();
    let mut chart = plot(titled(area, title, 60).build_cartesian_2d(-0.5..groups as f64 - 0.5, 0.0..top))?;
    let label = label_of(labels);
    let mesh = &mut chart.configure_mesh();
    plot(
        mesh.disable_x_mesh()
            .x_labels(groups * 2 + 1)
            .x_label_formatter(&label)
            .y_desc(y_label)
            .light_line_style(TRANSPARENT)
            .draw(),
    )?;
    Ok(chart)
}

/// Groups of bars: for each label one bar per series.
pub(crate) fn bars(
    title: &str,
    y_label: &str,
    labels: &[String],
    series: &[Series],
) -> anyhow::Result<String> {
    let top = series.iter().flat_map(|s| s.points.iter().map(|p| p.1)).fold(0.0, f64::max) * 1.15;
    to_svg(SIZE, |area| {
        let mut chart = bar_chart(area, title, y_label, labels, top)?;
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
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}

/// For each label one bar, its series on top of each other.
pub(crate) fn stacked(
    title: &str,
    y_label: &str,
    labels: &[String],
    series: &[Series],
) -> anyhow::Result<String> {
    let groups = labels.len();
    let height = |x: usize| series.iter().map(|s| s.points[x].1).sum::<f64>();
    let top = (0..groups).map(height).fold(0.0, f64::max) * 1.3;
    to_svg(SIZE, |area| {
        let mut chart = bar_chart(area, title, y_label, labels, top)?;
        let mut floor = vec![0.0; groups];
        for (k, series) in series.iter().enumerate() {
            let color = PALETTE[k % PALETTE.len()];
            let bar = |(floor, &(x, y)): (&mut f64, &(f64, f64))| {
                let from = *floor;
                *floor += y;
                Rectangle::new([(x - 0.3, from), (x + 0.3, *floor)], color.filled())
            };
            let bars: Vec<_> = floor.iter_mut().zip(&series.points).map(bar).collect();
            plot(chart.draw_series(bars))?
                .label(&series.name)
                .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], color.filled()));
        }
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}

/// Numbers as shades, with the numbers written into them; `values[row][column]`.
pub(crate) fn heat_map(
    title: &str,
    columns: &[String],
    rows: &[String],
    values: &[Vec<f64>],
) -> anyhow::Result<String> {
    let all = values.iter().flatten().copied();
    let (low, high) = all.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    to_svg(SIZE, |area| {
        let mut chart = plot(
            titled(area, title, 150)
                .build_cartesian_2d(-0.5..columns.len() as f64 - 0.5, -0.5..rows.len() as f64 - 0.5),
        )?;
        let (column, row) = (label_of(columns), label_of(rows));
        plot(
            chart
                .configure_mesh()
                .disable_mesh()
                .x_labels(columns.len() * 2 + 1)
                .y_labels(rows.len() * 2 + 1)
                .x_label_formatter(&column)
                .y_label_formatter(&row)
                .draw(),
        )?;
        for (y, row) in values.iter().enumerate() {
            for (x, &value) in row.iter().enumerate() {
                let share = (value - low) / (high - low).max(f64::MIN_POSITIVE);
                // From light to the palette's first colour; white text where it is dark.
                let shade = PALETTE[0].mix(0.12 + 0.88 * share);
                let (x, y) = (x as f64, y as f64);
                let cell = Rectangle::new([(x - 0.48, y - 0.46), (x + 0.48, y + 0.46)], shade.filled());
                plot(chart.draw_series(std::iter::once(cell)))?;
                let color = if share > 0.5 { ON_DARK } else { BLACK };
                let style = ("sans-serif", 15).into_font().color(&color);
                let middle = style.pos(Pos::new(HPos::Center, VPos::Center));
                plot(chart.draw_series(std::iter::once(Text::new(significant(value), (x, y), middle))))?;
            }
        }
        Ok(())
    })
}
