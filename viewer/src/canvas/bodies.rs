//! Bodies: filled, rimmed, coloured by what was asked for.

use eframe::egui::{Color32, Pos2};
use lamina2d::record::Frame;
use lamina2d::scene::{BodyKind, ShapeSpec};
use lamina2d::world::BodyEntry;

use super::{Brush, Palette, Scenery};
use crate::pane::{Pane, column};
use crate::view::Colour;

/// Seconds of motion a velocity arrow shows.
const VELOCITY_SECS: f64 = 0.1;

/// The least and greatest corner of a body, metres.
pub fn bounds(frame: &Frame, slot: usize, shape: &ShapeSpec) -> [[f64; 2]; 2] {
    let centre = [frame.get(column::X, slot), frame.get(column::Y, slot)];
    let (c, s) = (frame.get(column::COS, slot), frame.get(column::SIN, slot));
    let reach = |half: [f64; 2]| {
        [[centre[0] - half[0], centre[1] - half[1]], [centre[0] + half[0], centre[1] + half[1]]]
    };
    match shape {
        ShapeSpec::Circle(radius) => reach([*radius; 2]),
        ShapeSpec::Box([x, y]) => reach([x * c.abs() + y * s.abs(), x * s.abs() + y * c.abs()]),
        ShapeSpec::Polygon(outline) => {
            let corners = outline.iter().map(|[x, y]| [centre[0] + c * x - s * y, centre[1] + s * x + c * y]);
            let around = corners.map(|corner| [corner; 2]).reduce(super::union);
            around.unwrap_or([centre; 2])
        }
    }
}

/// The greatest speed of a dynamic body, m/s.
pub fn top_speed(pane: &Pane) -> f64 {
    let dynamic = pane.bodies().filter(|(_, body)| body.kind == BodyKind::Dynamic);
    dynamic.map(|(slot, _)| speed(pane.frame(), slot)).filter(|speed| speed.is_finite()).fold(0.0, f64::max)
}

/// Of a centroid, m/s.
pub fn speed(frame: &Frame, slot: usize) -> f64 {
    frame.get(column::VX, slot).hypot(frame.get(column::VY, slot))
}

fn fill(palette: &Palette, colour: Colour, pane: &Pane, slot: usize, body: &BodyEntry, top: f64) -> Color32 {
    match body.kind {
        BodyKind::Static => return palette.fixed,
        BodyKind::Kinematic => return palette.kinematic,
        BodyKind::Dynamic => {}
    }
    match colour {
        Colour::Shape => match body.shape {
            ShapeSpec::Circle(_) => palette.shapes[0],
            ShapeSpec::Box(_) => palette.shapes[1],
            ShapeSpec::Polygon(_) => palette.shapes[2],
        },
        Colour::Speed => Palette::ramp(speed(pane.frame(), slot) / top.max(f64::MIN_POSITIVE)),
        Colour::Island => palette.island(pane.island(slot)),
        Colour::Sleep => {
            let asleep = pane.frame().asleep.get(slot - 1).is_some_and(|asleep| *asleep);
            if asleep { palette.asleep } else { palette.shapes[1] }
        }
    }
}

/// Draws all bodies of a frame; `alpha`: 1 for solid ones.
pub fn draw(brush: &mut Brush, scenery: &Scenery<'_>, pane: &Pane, alpha: f32) {
    let (frame, palette, view) = (pane.frame(), &scenery.palette, scenery.view);
    let top = if view.colour == Colour::Speed { top_speed(pane) } else { 0.0 };
    let mut circle = Circles::default();
    let mut outline = Vec::new();
    let zoom = scenery.camera.points_per_metre;
    for (slot, body) in pane.bodies() {
        let centre = scenery.screen([frame.get(column::X, slot), frame.get(column::Y, slot)]);
        let radius = (body.radius * zoom) as f32;
        if !scenery.sees(centre, radius) {
            continue;
        }
        let mut color = fill(palette, view.colour, pane, slot, body, top);
        let chosen = scenery.selected == Some(slot);
        let mut rim = if chosen { palette.selected } else { palette.rim(color) };
        if alpha < 1.0 {
            (color, rim) = (color.gamma_multiply(alpha), rim.gamma_multiply(alpha));
        }
        let width: f32 = if chosen {
            3.0
        } else if radius > 4.0 {
            1.2
        } else {
            0.0
        };
        let turn = [frame.get(column::COS, slot), frame.get(column::SIN, slot)].map(|value| value as f32);
        place(&body.shape, centre, turn, zoom, &mut circle, &mut outline);
        brush.convex(&outline, color, rim, width.min(0.4 * radius));
        if radius > 5.0 && matches!(body.shape, ShapeSpec::Circle(_)) && body.kind != BodyKind::Static {
            let to = Pos2::new(centre.x + radius * turn[0], centre.y - radius * turn[1]);
            brush.line(centre, to, rim, 1.0);
        }
        if view.circles && body.kind != BodyKind::Static {
            circle.around(centre, radius, &mut outline);
            brush.outline(&outline, palette.circle, 0.5);
        }
        if view.velocities && body.kind != BodyKind::Static {
            let [vx, vy] = [frame.get(column::VX, slot), frame.get(column::VY, slot)];
            let by = [vx, vy].map(|value| (value * VELOCITY_SECS * zoom) as f32);
            brush.arrow(centre, Pos2::new(centre.x + by[0], centre.y - by[1]), palette.velocity, 1.0);
        }
    }
}

/// The outline of a shape on the screen. `turn`: cos and sin of the attitude.
fn place(
    shape: &ShapeSpec,
    centre: Pos2,
    turn: [f32; 2],
    zoom: f64,
    circle: &mut Circles,
    outline: &mut Vec<Pos2>,
) {
    let corner = |[x, y]: [f64; 2]| {
        let [x, y] = [(x * zoom) as f32, (y * zoom) as f32];
        Pos2::new(centre.x + turn[0] * x - turn[1] * y, centre.y - turn[1] * x - turn[0] * y)
    };
    match shape {
        ShapeSpec::Circle(radius) => circle.around(centre, (radius * zoom) as f32, outline),
        ShapeSpec::Box([x, y]) => {
            outline.clear();
            outline.extend([[-x, -y], [*x, -y], [*x, *y], [-x, *y]].map(corner));
        }
        ShapeSpec::Polygon(corners) => {
            outline.clear();
            outline.extend(corners.iter().copied().map(corner));
        }
    }
}

/// Draws a line from each dynamic body to its twin in another run, the redder the farther they are apart, where that
/// shows at all.
pub fn connect(brush: &mut Brush, scenery: &Scenery<'_>, pane: &Pane, twin: &Pane) {
    let pairs = || {
        let dynamic = pane.bodies().filter(|(_, body)| body.kind != BodyKind::Static);
        dynamic.filter_map(|(slot, _)| Some((pane.position(slot)?, twin.position(slot)?)))
    };
    let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let farthest = pairs().map(|(a, b)| apart(a, b)).filter(|d| d.is_finite()).fold(0.0, f64::max);
    for (a, b) in pairs() {
        let color = Palette::ramp(apart(a, b) / farthest.max(f64::MIN_POSITIVE));
        let (from, to) = (scenery.screen(a), scenery.screen(b));
        if a != b && (scenery.sees(from, 0.0) || scenery.sees(to, 0.0)) {
            brush.line(from, to, color, 2.0);
            brush.point(to, 2.5, color);
        }
    }
}

/// Circles of as many corners as their size asks for.
#[derive(Debug, Default)]
struct Circles {
    /// cos and sin, for circles of 8, 16, 32 and 64 corners.
    units: [Vec<[f32; 2]>; 4],
}

impl Circles {
    /// The corners of a circle, points.
    fn around(&mut self, centre: Pos2, radius: f32, outline: &mut Vec<Pos2>) {
        let size = match radius {
            r if r < 3.0 => 0,
            r if r < 12.0 => 1,
            r if r < 60.0 => 2,
            _ => 3,
        };
        let unit = &mut self.units[size];
        if unit.is_empty() {
            let corners = 8_u32 << size;
            let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(corners);
            unit.extend((0..corners).map(|k| [angle(k).cos() as f32, angle(k).sin() as f32]));
        }
        outline.clear();
        outline.extend(unit.iter().map(|[c, s]| Pos2::new(centre.x + radius * c, centre.y + radius * s)));
    }
}
