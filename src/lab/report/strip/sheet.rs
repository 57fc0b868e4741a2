//! The strip around the bodies: frames side by side, their times, a scale bar and a legend.

use lamina2d::scene::{BodyKind, ShapeSpec};
use lamina2d::simulation::BodyState;
use lamina2d::world::BodyEntry;

use super::path::{Ink, Scale, UNITS_PER_BODY, paths, to_world};

/// Units a strip is wide.
const WIDTH: f64 = 960.0;
/// Around everything, and between frames.
const MARGIN: f64 = 16.0;
/// The tallest a frame may be; a scene taller than wide has narrow frames then.
const MAX_HEIGHT: f64 = 480.0;
/// Where frames begin: below the title.
const TOP: f64 = 44.0;
/// From line to line.
const LINE: f64 = 26.0;
/// Of letters.
const FONT: f64 = 18.0;

/// A world at a time.
pub(super) struct Moment {
    pub(super) time_secs: f64,
    /// As long as the list of bodies.
    pub(super) states: Vec<BodyState>,
}

impl Moment {
    /// In words.
    pub(super) fn time(&self) -> String {
        format!("{:.1} s", self.time_secs)
    }
}

/// The strip. All frames show the same part of the plane: the one that moving bodies reach in any of them.
pub(super) fn draw(title: &str, bodies: &[BodyEntry], moments: &[Moment]) -> String {
    let [low, high] = reach(bodies, moments);
    let thinnest = bodies.iter().filter(|body| moves(body)).map(thickness).fold(f64::MAX, f64::min);
    let units_per_m = (UNITS_PER_BODY as f64 / thinnest).ceil();
    let scale = Scale { units_per_m, origin: [low[0], high[1]] };
    let size_m = [high[0] - low[0], high[1] - low[1]];
    let [columns, rows] = size_m.map(|side| (side * units_per_m).ceil());

    let count = moments.len() as f64;
    let room = (WIDTH - MARGIN * (count + 1.0)) / count;
    let width = room.min(MAX_HEIGHT * columns / rows).floor();
    let height = (width * rows / columns).ceil();
    let left = ((WIDTH - width * count - MARGIN * (count - 1.0)) / 2.0).round();
    let bottom = TOP + height + 2.0 * LINE + MARGIN;

    let head = format!(
        "<svg width=\"{WIDTH}\" height=\"{bottom}\" viewBox=\"0 0 {WIDTH} {bottom}\" \
         xmlns=\"http://www.w3.org/2000/svg\" font-family=\"sans-serif\" font-size=\"{FONT}\">\n\
         <rect width=\"{WIDTH}\" height=\"{bottom}\" fill=\"#FFFFFF\"/>\n"
    );
    let frame = |(k, moment): (usize, &Moment)| {
        let x = left + (width + MARGIN) * k as f64;
        let place = format!("x=\"{x}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\"");
        let drawn = paths(&scale, bodies, &moment.states);
        let time = text([x + width / 2.0, TOP + height + LINE - 4.0], "middle", &moment.time());
        format!(
            "<svg {place} viewBox=\"0 0 {columns} {rows}\" fill=\"none\">\n{drawn}</svg>\n\
             <rect {place} fill=\"none\" stroke=\"#000000\" stroke-opacity=\"0.25\"/>\n{time}"
        )
    };
    let last_line = bottom - MARGIN;
    let parts = [
        head,
        text([WIDTH / 2.0, TOP - 16.0], "middle", title),
        moments.iter().enumerate().map(frame).collect(),
        scale_bar(width / size_m[0], width, last_line),
        legend(bodies, last_line),
    ];
    parts.concat() + "</svg>\n"
}

fn moves(body: &BodyEntry) -> bool {
    body.kind != BodyKind::Static
}

/// Metres across, the short way.
fn thickness(body: &BodyEntry) -> f64 {
    match &body.shape {
        ShapeSpec::Circle(radius) => 2.0 * radius,
        ShapeSpec::Box(half) => 2.0 * half[0].min(half[1]),
        // Not quite: an outline shows how it lies at any size.
        ShapeSpec::Polygon(_) => body.radius,
    }
}

/// Lower and upper corner of what is shown, metres: all that moving bodies cover in any frame, static bodies that are
/// small beside it, and a rim in which floors and walls are seen.
fn reach(bodies: &[BodyEntry], moments: &[Moment]) -> [[f64; 2]; 2] {
    let mut shown = NOTHING;
    for moment in moments {
        let moving = bodies.iter().zip(&moment.states).filter(|(body, _)| moves(body));
        shown = moving.fold(shown, |shown, (body, state)| around(shown, corners(body, state)));
    }
    let side = |[low, high]: [[f64; 2]; 2]| (high[0] - low[0]).max(high[1] - low[1]);
    let small = side(shown) / 2.0;
    let at_first = moments.first().map_or(&[][..], |moment| &moment.states);
    let fixed = bodies.iter().zip(at_first).filter(|(body, _)| !moves(body));
    for (body, state) in fixed {
        let corners = corners(body, state);
        if side(around(NOTHING, corners.clone())) < small {
            shown = around(shown, corners);
        }
    }
    let rim = 0.03 * side(shown);
    [shown[0].map(|at| at - rim), shown[1].map(|at| at + rim)]
}

/// The corners of a box around no point.
const NOTHING: [[f64; 2]; 2] = [[f64::MAX; 2], [f64::MIN; 2]];

/// The box that holds these points too.
fn around([mut low, mut high]: [[f64; 2]; 2], points: Vec<[f64; 2]>) -> [[f64; 2]; 2] {
    for point in points {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    [low, high]
}

/// Points in the world whose box is the body's, metres.
fn corners(body: &BodyEntry, state: &BodyState) -> Vec<[f64; 2]> {
    match &body.shape {
        ShapeSpec::Circle(radius) => [-radius, *radius].map(|r| state.position.map(|at| at + r)).to_vec(),
        ShapeSpec::Box([x, y]) => {
            [[-x, -y], [*x, -y], [*x, *y], [-x, *y]].map(|corner| to_world(state, corner)).to_vec()
        }
        ShapeSpec::Polygon(outline) => outline.iter().map(|&corner| to_world(state, corner)).collect(),
    }
}

/// A bar of 1, 2 or 5 times a power of ten metres, about a quarter of a frame long.
fn scale_bar(px_per_m: f64, frame_px: f64, y: f64) -> String {
    let most_m = frame_px / px_per_m / 4.0;
    let power = 10f64.powi(most_m.log10().floor() as i32);
    let factor = [5.0, 2.0, 1.0].into_iter().find(|factor| factor * power <= most_m).unwrap_or(1.0);
    let length_m = factor * power;
    let (middle, end) = (y - FONT / 3.0, MARGIN + length_m * px_per_m);
    let bar = format!(
        "<path stroke=\"#000000\" stroke-width=\"2\" fill=\"none\" \
         d=\"M{MARGIN} {middle}H{end:.1}m0-5v10M{MARGIN} {}v10\"/>\n",
        middle - 5.0
    );
    bar + &text([end + 8.0, y], "start", &format!("{length_m} m"))
}

/// Which colours there are, up to the right margin.
fn legend(bodies: &[BodyEntry], y: f64) -> String {
    let shown = Ink::ALL.into_iter().filter(|ink| bodies.iter().any(|body| Ink::of(body) == *ink));
    let item = |(k, ink): (usize, Ink)| {
        let gap = if k == 0 { 0.0 } else { MARGIN };
        format!("<tspan fill=\"{}\" dx=\"{gap}\">■</tspan> {}", ink.colour(), ink.name())
    };
    text([WIDTH - MARGIN, y], "end", &shown.enumerate().map(item).collect::<String>())
}

fn text([x, y]: [f64; 2], anchor: &str, words: &str) -> String {
    format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" fill=\"#000000\">{words}</text>\n")
}
