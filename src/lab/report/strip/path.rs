//! Bodies as path data. A circle is a dot of a round pen and a box a stroke of a flat one, each a few bytes;
//! only polygons are outlines.

use std::collections::BTreeMap;

use lamina2d::scene::{BodyKind, ShapeSpec};
use lamina2d::simulation::BodyState;
use lamina2d::world::BodyEntry;

/// The thinnest moving body is so many units thick: enough to show how it lies.
pub(super) const UNITS_PER_BODY: i64 = 8;

/// What a colour says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Ink {
    Fixed,
    Kinematic,
    Circle,
    Box,
    Polygon,
}

impl Ink {
    pub(super) const ALL: [Self; 5] = [Self::Fixed, Self::Kinematic, Self::Circle, Self::Box, Self::Polygon];

    pub(super) fn of(body: &BodyEntry) -> Self {
        match (body.kind, &body.shape) {
            (BodyKind::Static, _) => Self::Fixed,
            (BodyKind::Kinematic, _) => Self::Kinematic,
            (BodyKind::Dynamic, ShapeSpec::Circle(_)) => Self::Circle,
            (BodyKind::Dynamic, ShapeSpec::Box(_)) => Self::Box,
            (BodyKind::Dynamic, ShapeSpec::Polygon(_)) => Self::Polygon,
        }
    }

    /// In the legend.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Fixed => "static",
            Self::Kinematic => "kinematic",
            Self::Circle => "circle",
            Self::Box => "box",
            Self::Polygon => "polygon",
        }
    }

    /// The viewer's hues, of a lightness between white and black paper.
    pub(super) const fn colour(self) -> &'static str {
        match self {
            Self::Fixed => "#868E98",
            Self::Kinematic => "#9B72C4",
            Self::Circle => "#3F97D6",
            Self::Box => "#E0932F",
            Self::Polygon => "#35AD84",
        }
    }
}

/// What draws a body; the widths are units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Pen {
    Round(i64),
    Flat(i64),
    Outline,
}

/// From metres, y up, to units, y down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub(super) units_per_m: f64,
    /// The left upper corner, metres.
    pub(super) origin: [f64; 2],
}

impl Scale {
    fn units(&self, length_m: f64) -> i64 {
        (length_m * self.units_per_m).round() as i64
    }

    fn point(&self, [x, y]: [f64; 2]) -> [i64; 2] {
        [self.units(x - self.origin[0]), self.units(self.origin[1] - y)]
    }

    /// The pen, and where it goes. Dots and strokes are a unit smaller than the body, as outlines have a rim of half a
    /// unit: neighbours stay apart.
    fn stroke(&self, body: &BodyEntry, state: &BodyState) -> (Pen, Vec<[i64; 2]>) {
        let width = |radius: f64| (self.units(2.0 * radius) - 1).max(1);
        match &body.shape {
            ShapeSpec::Circle(radius) => (Pen::Round(width(*radius)), vec![self.point(state.position)]),
            ShapeSpec::Box(half) => {
                let along = usize::from(half[1] > half[0]);
                let mut end = [0.0; 2];
                end[along] = (half[along] - 0.5 / self.units_per_m).max(0.0);
                let ends = [end.map(|e| -e), end].map(|end| self.point(to_world(state, end)));
                (Pen::Flat(width(half[1 - along])), ends.to_vec())
            }
            ShapeSpec::Polygon(outline) => {
                let mut corners: Vec<_> = outline.iter().map(|&v| self.point(to_world(state, v))).collect();
                corners.dedup();
                (Pen::Outline, corners)
            }
        }
    }
}

/// Metres, of a point of a body.
pub(super) fn to_world(state: &BodyState, [x, y]: [f64; 2]) -> [f64; 2] {
    let ([px, py], [c, s]) = (state.position, state.rotation);
    [px + c * x - s * y, py + s * x + c * y]
}

/// The bodies as `path` elements: one per colour and width of pen.
pub(super) fn paths(scale: &Scale, bodies: &[BodyEntry], states: &[BodyState]) -> String {
    let mut groups = BTreeMap::<(Ink, Pen), Vec<Vec<[i64; 2]>>>::new();
    for (body, state) in bodies.iter().zip(states) {
        let (pen, points) = scale.stroke(body, state);
        groups.entry((Ink::of(body), pen)).or_default().push(points);
    }
    groups.into_iter().map(|((ink, pen), strokes)| element(ink, pen, strokes)).collect()
}

fn element(ink: Ink, pen: Pen, mut strokes: Vec<Vec<[i64; 2]>>) -> String {
    in_rows(&mut strokes);
    let (colour, data) = (ink.colour(), data(&strokes));
    let style = match pen {
        Pen::Round(width) => {
            format!("stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\"")
        }
        Pen::Flat(width) => format!("stroke=\"{colour}\" stroke-width=\"{width}\""),
        Pen::Outline => format!("stroke=\"#FFFFFF\" fill=\"{colour}\""),
    };
    format!("<path {style} d=\"{data}\"/>\n")
}

/// Row by row: from one stroke to the next is a short way, which few digits tell.
fn in_rows(strokes: &mut [Vec<[i64; 2]>]) {
    strokes.sort_by_key(|points| {
        let [x, y] = points[0];
        (y.div_euclid(UNITS_PER_BODY), x, y)
    });
}

/// Path data of dots (one point), strokes (two) and closed outlines.
fn data(strokes: &[Vec<[i64; 2]>]) -> String {
    let (mut text, mut at) = (String::new(), [0; 2]);
    for points in strokes {
        text.push('m');
        for (k, &to) in points.iter().enumerate() {
            let [x, y] = [to[0] - at[0], to[1] - at[1]];
            // Most boxes of a scene that stands lie level.
            let level = points.len() == 2 && k == 1 && y == 0;
            if level {
                text.push('h');
            }
            number(&mut text, x);
            if !level {
                number(&mut text, y);
            }
            at = to;
        }
        match points.len() {
            1 => text.push_str("h0"),
            2 => {}
            _ => {
                text.push('z');
                at = points[0];
            }
        }
    }
    text
}

/// A sign or a letter parts numbers as well as a space does.
fn number(text: &mut String, value: i64) {
    if value >= 0 && text.ends_with(|last: char| last.is_ascii_digit()) {
        text.push(' ');
    }
    text.push_str(&value.to_string());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stroke_starts_where_the_one_before_has_ended() {
        let strokes = [
            vec![[3, 4]],
            vec![[5, 2], [5, 9]],
            vec![[6, 9], [2, 9]],
            vec![[10, 10], [14, 10], [12, 7]],
            vec![[10, 11]],
        ];
        assert_eq!(data(&strokes), "m3 4h0m2-2 0 7m1 0h-4m8 1 4 0-2-3zm0 1h0");
    }

    #[test]
    fn rows_run_to_the_right_from_the_top_down() {
        let mut strokes = [[0, 30], [9, 2], [9, 31], [0, 5]].map(|point| vec![point]);
        in_rows(&mut strokes);
        assert_eq!(strokes, [[0, 5], [9, 2], [0, 30], [9, 31]].map(|point| vec![point]));
    }
}
