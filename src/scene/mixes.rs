//! The thesis's four shape mixes at any number of bodies, and its determinism scene.
//!
//! The thesis's window is 800 × 600 px at 25 px/m with y down; here it is 32 × 24 m with y up. Its five
//! static bodies and the bodies' sizes are kept; the positions it clicked by hand are a seeded, jittered
//! grid above the floor. For other numbers of bodies the box and its obstacles are scaled by √(N/150),
//! so that the fill stays the same.

use rand::RngExt;
use rand::SeedableRng;
use rand_pcg::Pcg32;

use super::{BodySpec, Scene, ShapeSpec};
use crate::force::Forces;
use crate::vec2::Rot;

/// Pixels per metre in the thesis.
pub const PX_PER_M: f64 = 25.0;
/// The thesis's window height, px: its y runs down from here.
const WINDOW_HEIGHT_PX: f64 = 600.0;
/// The number of bodies its box was drawn for.
const REFERENCE_BODIES: f64 = 150.0;

/// Which shapes a mix interleaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mix {
    /// Circles only.
    Circles,
    /// Circles and polygons in turn.
    CirclesPolygons,
    /// Polygons only.
    Polygons,
    /// Circles, boxes and polygons in turn.
    All,
}

impl Mix {
    /// All four, in the thesis's order.
    pub const ALL: [Self; 4] = [Self::Circles, Self::CirclesPolygons, Self::Polygons, Self::All];

    /// The scene's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Circles => "circles",
            Self::CirclesPolygons => "circles_polygons",
            Self::Polygons => "polygons",
            Self::All => "all",
        }
    }

    fn shapes(self) -> &'static [Kind] {
        match self {
            Self::Circles => &[Kind::Circle],
            Self::CirclesPolygons => &[Kind::Circle, Kind::Polygon],
            Self::Polygons => &[Kind::Polygon],
            Self::All => &[Kind::Circle, Kind::Box, Kind::Polygon],
        }
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Circle,
    Box,
    Polygon,
}

/// Window pixels, y down, to metres, y up.
fn from_px(x: f64, y: f64) -> [f64; 2] {
    [x / PX_PER_M, (WINDOW_HEIGHT_PX - y) / PX_PER_M]
}

/// The thesis's five static bodies, scaled about the middle of the floor's top edge.
fn statics(scale: f64, wall_height: f64) -> Vec<BodySpec> {
    let place = |x: f64, y: f64| [(x - 400.0) / PX_PER_M * scale, (555.0 - y) / PX_PER_M * scale];
    let half = |x: f64, y: f64| ShapeSpec::Box([x / PX_PER_M * scale, y / PX_PER_M * scale]);
    let wall = |x: f64| {
        // Extended upward: the bottom stays where it was.
        let [x, bottom] = place(x, 555.0);
        let half_height = wall_height / 2.0;
        BodySpec::new(ShapeSpec::Box([30.0 / PX_PER_M * scale, half_height]), [x, bottom + half_height])
    };
    vec![
        BodySpec::new(ShapeSpec::Circle(50.0 / PX_PER_M * scale), place(200.0, 300.0)).surface(1.0, 0.5),
        BodySpec::new(half(50.0, 50.0), place(500.0, 300.0))
            .surface(0.5, 0.5)
            .turned(-0.45 * std::f64::consts::PI),
        BodySpec::new(half(400.0, 30.0), place(400.0, 585.0)).surface(0.2, 0.2),
        wall(15.0).surface(0.2, 0.2),
        wall(785.0).surface(0.2, 0.2),
    ]
    .into_iter()
    .map(BodySpec::fixed)
    .collect()
}

/// A mix of `bodies` dynamic bodies falling into the thesis's box.
///
/// The grid starts at the floor and leaves out the cells of the two obstacles; nothing overlaps at first.
pub fn mix(mix: Mix, bodies: usize, seed: u64) -> Scene {
    let mut random = Pcg32::seed_from_u64(seed);
    let scale = (bodies as f64 / REFERENCE_BODIES).sqrt();
    // A cell holds the largest body of the mix wherever the jitter puts it.
    let (pitch, jitter) = if mix == Mix::Circles { (1.32, 0.05) } else { (2.5, 0.04) };
    let cells = grid_cells(bodies, pitch, scale);
    let top = cells.last().map_or(0.0, |cell| cell[1]) + pitch;
    let mut specs = statics(scale, 2.0 * top);
    for (k, cell) in cells.into_iter().enumerate() {
        let position = cell.map(|at| at + random.random_range(-jitter..=jitter));
        let shapes = mix.shapes();
        let body = match shapes[k % shapes.len()] {
            Kind::Circle => BodySpec::new(ShapeSpec::Circle(15.0 / PX_PER_M), position).surface(0.5, 0.5),
            Kind::Box => BodySpec::new(ShapeSpec::Box([1.0, 1.0]), position).surface(0.1, 0.2),
            Kind::Polygon => BodySpec::new(random_hexagon(&mut random), position).surface(0.5, 0.5),
        };
        specs.push(body.mass(1.0));
    }
    Scene {
        name: mix.name().to_owned(),
        about: format!("the thesis's box filled with {}", mix.name().replace('_', " and ")),
        bodies: specs,
        joints: Vec::new(),
        forces: Forces::gravity(),
        events: Vec::new(),
        dt_secs: 1.0 / 60.0,
        steps: 600,
        seed,
    }
}

/// Centres of the first `bodies` free cells between the walls, from the floor up.
fn grid_cells(bodies: usize, pitch: f64, scale: f64) -> Vec<[f64; 2]> {
    let columns = ((710.0 / PX_PER_M * scale / pitch) as usize).max(1);
    // Circle of 2 m and box of 2√2 m half-diagonal, each with a cell around it.
    let obstacles = [([-8.0, 10.2], 2.0), ([4.0, 10.2], 2.0 * std::f64::consts::SQRT_2)];
    let free = |&[x, y]: &[f64; 2]| {
        obstacles
            .iter()
            .all(|([ox, oy], r)| (x - ox * scale).hypot(y - oy * scale) > r * scale + 0.75 * pitch)
    };
    let centre = |row: usize, column: usize| {
        [(column as f64 - (columns as f64 - 1.0) / 2.0) * pitch, (row as f64 + 0.55) * pitch]
    };
    (0..)
        .flat_map(|row| (0..columns).map(move |column| centre(row, column)))
        .filter(free)
        .take(bodies)
        .collect()
}

/// A polygon of the mixes, by a seed: six vertices on a circle of 0.8 to 1.2 m.
pub fn polygon(seed: u64) -> ShapeSpec {
    random_hexagon(&mut Pcg32::seed_from_u64(seed))
}

/// Six vertices at i·60° ± 30° on a circle of 20 to 30 px.
///
/// Two neighbours may come arbitrarily close at random; such a draw is taken again, as is one whose
/// centroid lies so far out that the shape would leave its grid cell.
fn random_hexagon(random: &mut Pcg32) -> ShapeSpec {
    loop {
        let radius = random.random_range(20.0..30.0) / PX_PER_M;
        let outline: Vec<[f64; 2]> = (0..6)
            .map(|k| {
                let angle = (f64::from(k) * 60.0 + random.random_range(-30.0..30.0_f64)).to_radians();
                {
                    let turn = Rot::<f64>::from_angle(angle);
                    [radius * turn.c, radius * turn.s]
                }
            })
            .collect();
        let apart = (0..6).all(|k| {
            let (a, b) = (outline[k], outline[(k + 1) % 6]);
            (a[0] - b[0]).hypot(a[1] - b[1]) > 0.05 * radius
        });
        let spec = ShapeSpec::Polygon(outline);
        if apart && spec.build().is_ok_and(|shape| shape.bounding_radius() <= 1.2 * radius) {
            return spec;
        }
    }
}

/// The six bodies and five statics with which the thesis tried whether two runs agree.
pub fn determinism() -> Scene {
    let circle = |r: f64| ShapeSpec::Circle(r / PX_PER_M);
    let half = |x: f64, y: f64| ShapeSpec::Box([x / PX_PER_M, y / PX_PER_M]);
    let polygon = |points: &[(f64, f64)]| {
        ShapeSpec::Polygon(points.iter().map(|&(x, y)| [x / PX_PER_M, -y / PX_PER_M]).collect())
    };
    let octet = [
        (29.0, 6.0),
        (11.0, 28.0),
        (-9.0, 29.0),
        (-29.0, 8.0),
        (-27.0, -13.0),
        (-19.0, -23.0),
        (13.0, -27.0),
    ];
    let hexagon = [(49.0, 10.0), (11.0, 49.0), (-28.0, 41.0), (-49.0, -9.0), (-26.0, -43.0), (3.0, -50.0)];
    // Placed in the window's coordinates, then shifted to where `statics` puts its floor.
    let place = |x: f64, y: f64| {
        let ([x, y], [floor_x, floor_y]) = (from_px(x, y), from_px(400.0, 555.0));
        [x - floor_x, y - floor_y]
    };
    let mut bodies = statics(1.0, 2.0 * 300.0 / PX_PER_M);
    bodies.extend([
        BodySpec::new(circle(25.0), place(400.0, 100.0)).mass(10.0).surface(0.5, 0.5),
        BodySpec::new(circle(25.0), place(410.0, 150.0)).mass(5.0).surface(0.1, 0.8).turned(-20.0),
        BodySpec::new(half(50.0, 25.0), place(350.0, 20.0)).mass(10.0).surface(0.5, 0.5),
        BodySpec::new(half(20.0, 45.0), place(350.0, 300.0)).mass(5.0).surface(0.2, 0.4).turned(-10.0),
        BodySpec::new(polygon(&hexagon), place(500.0, 100.0)).mass(10.0).surface(0.5, 0.5),
        BodySpec::new(polygon(&octet), place(220.0, 150.0)).mass(5.0).surface(0.8, 0.2).turned(-70.0),
    ]);
    Scene {
        name: "determinism".to_owned(),
        about: "the thesis's six bodies, run twice".to_owned(),
        bodies,
        joints: Vec::new(),
        forces: Forces::gravity(),
        events: Vec::new(),
        dt_secs: 1.0 / 60.0,
        steps: 900,
        seed: 0,
    }
}
