//! Flush static outlines are one surface: what slides, rolls or bounces along it feels nothing of where they join.

use lamina2d::force::Forces;
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::Settings;
use lamina2d::simulation::BodyState;

use crate::EVERY;
use crate::shared_motion::{at_every_width, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

/// How tiles are laid: their width, how far each begins behind the last one's end (overlapping where negative).
#[derive(Clone, Copy, Debug)]
struct Row {
    width: f64,
    gap: f64,
    polygons: bool,
}

/// A floor of tiles with its top at 0, from −1 m on, at least so long.
fn floor(row: Row, length: f64) -> Vec<BodySpec> {
    let Row { width, gap, polygons } = row;
    let thick = width.min(1.0);
    let count = ((length + 2.0) / (width + gap)).ceil() as usize;
    let tile = |k: usize| {
        let at = [-1.0 + (k as f64 + 0.5) * (width + gap), -0.5 * thick];
        let (x, y) = (0.5 * width, 0.5 * thick);
        let shape = if polygons {
            ShapeSpec::Polygon(vec![[-x, -y], [x, -y], [x, y], [-x, y]])
        } else {
            ShapeSpec::Box([x, y])
        };
        BodySpec::new(shape, at).surface(0.0, 0.0).fixed()
    };
    (0..count).map(tile).collect()
}

/// The mover's state before and after some seconds over a floor.
fn slide(row: Row, mover: BodySpec, secs: f64, settings: Settings) -> [BodyState; 2] {
    let length = mover.velocity[0] * secs;
    let mut bodies = floor(row, length);
    bodies.push(mover.surface(0.0, 0.0));
    let mut world = start(&scene_of(bodies, Forces::gravity()), settings);
    let begun = *world.states().last().expect("a mover");
    for _ in 0..(secs / DT_SECS).round() as usize {
        world.step(DT_SECS).expect("stays finite");
    }
    [begun, *world.states().last().expect("a mover")]
}

fn movers() -> [(&'static str, BodySpec); 3] {
    let wedge = vec![[-0.15, -0.1], [0.15, -0.1], [0.1, 0.1], [-0.1, 0.1]];
    [
        ("disc", BodySpec::new(ShapeSpec::Circle(0.1), [0.0, 0.1])),
        ("box", BodySpec::new(ShapeSpec::Box([0.25, 0.1]), [0.0, 0.1])),
        ("polygon", BodySpec::new(ShapeSpec::Polygon(wedge), [0.0, 0.1])),
    ]
}

/// Energy, direction and attitude to 1e-4, for discs, boxes and polygons, over tiles of 1 cm to 20 m, flush, 1e-4 m apart or
/// overlapping, at 0.01 to 50 m/s, with and without continuous collision.
#[test]
fn seams_take_nothing_from_what_slides() {
    let rows = [(0.01, 0.0), (0.1, 1e-4), (0.1, 0.0), (0.5, -0.01), (2.0, 0.0), (20.0, 0.0), (20.0, 1e-4)];
    let rows =
        rows.into_iter().flat_map(|(width, gap)| [false, true].map(|polygons| Row { width, gap, polygons }));
    let speeds = rows.flat_map(|row| [0.01, 0.3, 5.0, 50.0].map(|speed| (row, speed)));
    let cases = speeds.flat_map(|(row, speed)| {
        movers().into_iter().flat_map(move |mover| [false, true].map(|on| (row, speed, mover.clone(), on)))
    });
    let mut seams = 0;
    for (row, speed, (name, mover), continuous) in cases.step_by(EVERY) {
        let secs = f64::min(2.0, 40.0 * row.width / speed).max(0.5);
        let settings = Settings { continuous, ..Settings::default() };
        let [begun, end] = slide(row, mover.mass(1.0).moving([speed, 0.0], 0.0), secs, settings);
        let case = format!("{name} at {speed} m/s, {row:?}, continuous {continuous}: {end:?}");
        assert!((end.velocity[0] / speed - 1.0).abs() < 1e-4, "{case}");
        let gone = end.position[0] - begun.position[0];
        assert!((gone - speed * secs).abs() < 1e-3 + 1e-4 * speed * secs, "{case}");
        assert!(end.velocity[1].abs() < 1e-3 && end.rotation[1].abs() < 1e-3, "{case}");
        assert!((end.position[1] - begun.position[1]).abs() < 1e-3, "{case}");
        seams += (speed * secs / (row.width + row.gap)) as usize;
    }
    assert!(seams > 10_000 / EVERY, "{seams} seams");
}

/// A ball meets the joint of two flush slabs under any slope, at it and beside it: one bounce, after the mirror law.
#[test]
fn a_bounce_at_a_seam_is_one_bounce() {
    for slope in [0.0, -0.3, 0.6] {
        let (sin, cos) = f64::sin_cos(slope);
        // Tops through the origin, where they join.
        let slab = |side: f64| {
            let at = [side * 3.0 * cos + 0.5 * sin, side * 3.0 * sin - 0.5 * cos];
            BodySpec::new(ShapeSpec::Box([3.0, 0.5]), at).turned(slope).surface(1.0, 0.0).fixed()
        };
        for beside in [-0.1, -0.01, -1e-4, 0.0, 1e-4, 0.01, 0.1] {
            let touches = [beside * cos - 0.1 * sin, beside * sin + 0.1 * cos];
            let ball = BodySpec::new(ShapeSpec::Circle(0.1), [touches[0], touches[1] + 0.8]);
            let bodies = vec![slab(-1.0), slab(1.0), ball.mass(1.0).surface(1.0, 0.0)];
            let mut world = start(&scene_of(bodies, Forces::gravity()), Settings::default());
            let secs = (2.0 * 0.8f64 / 9.81).sqrt();
            let steps = (secs / DT_SECS).ceil() as usize + 4;
            for _ in 0..steps {
                world.step(DT_SECS).expect("stays finite");
            }
            let fallen = (2.0f64 * 9.81 * 0.8).sqrt();
            let since = steps as f64 * DT_SECS - secs;
            let right = [-fallen * (2.0 * slope).sin(), fallen * (2.0 * slope).cos() - 9.81 * since];
            let state = world.states()[2];
            for k in 0..2 {
                let off = (state.velocity[k] - right[k]).abs();
                assert!(off < 0.02 * fallen, "{slope} rad, {beside} m beside: {state:?}, not {right:?}");
            }
        }
    }
}

/// A step between tiles is no seam: what is higher stops, what is lower lets fall, and a wall at a floor's end stands.
#[test]
fn steps_and_walls_are_none() {
    let tile = |x: f64, top: f64| {
        BodySpec::new(ShapeSpec::Box([1.0, 0.5]), [x, top - 0.5]).surface(0.0, 0.0).fixed()
    };
    let after = |tiles: Vec<BodySpec>| {
        let disc = BodySpec::new(ShapeSpec::Circle(0.2), [0.0, 0.2]).mass(1.0).moving([2.0, 0.0], 0.0);
        let bodies = tiles.into_iter().chain([disc.surface(0.0, 0.0)]).collect();
        let mut world = start(&scene_of(bodies, Forces::gravity()), Settings::default());
        for _ in 0..80 {
            world.step(DT_SECS).expect("stays finite");
        }
        *world.states().last().expect("a disc")
    };
    let higher = after(vec![tile(0.0, 0.0), tile(2.0, 0.5)]);
    assert!(higher.position[0] < 0.81 && higher.velocity[0].abs() < 0.05, "{higher:?}");
    let lower = after(vec![tile(0.0, 0.0), tile(2.0, -0.3)]);
    assert!((lower.position[1] + 0.1).abs() < 0.02 && lower.position[0] > 2.0, "{lower:?}");
    let wall = BodySpec::new(ShapeSpec::Box([0.1, 2.0]), [1.1, 1.5]).surface(0.0, 0.0).fixed();
    let stopped = after(vec![tile(0.0, 0.0), wall]);
    assert!((stopped.position[0] - 0.8).abs() < 0.01, "{stopped:?}");
}

/// A corner that turns outward is one: a disc rolls over the ridge of a roof and off the end of a row.
#[test]
fn ridges_and_ends_are_corners() {
    let half = |side: f64| {
        BodySpec::new(ShapeSpec::Polygon(vec![[0.0, 0.0], [side * -2.0, -1.0], [0.0, -1.0]]), [0.0, 0.0])
            .surface(0.0, 0.0)
            .fixed()
    };
    let order = |side: f64, spec: BodySpec| {
        // Counter-clockwise, whichever side it is on.
        let ShapeSpec::Polygon(mut outline) = spec.shape.clone() else { unreachable!() };
        if side < 0.0 {
            outline.reverse();
        }
        BodySpec { shape: ShapeSpec::Polygon(outline), ..spec }
    };
    let roof = vec![order(1.0, half(1.0)), order(-1.0, half(-1.0))];
    let disc = BodySpec::new(ShapeSpec::Circle(0.1), [-1.0, 0.7]).mass(1.0).moving([4.0, 1.0], 0.0);
    let bodies = roof.into_iter().chain([disc.surface(0.0, 0.0)]).collect();
    let mut world = start(&scene_of(bodies, Forces::gravity()), Settings::default());
    for _ in 0..90 {
        world.step(DT_SECS).expect("stays finite");
        let overlap = world.penetration().max;
        assert!(overlap < 0.01, "{overlap} m into the roof");
    }
    assert!(world.states()[2].position[0] > 1.5, "{:?}", world.states()[2]);
}

/// The same bits at every width, with seams underneath.
#[test]
fn no_width_moves_a_bit_over_seams() {
    let scene = |seed: usize| -> Scene {
        let mut bodies = floor(Row { width: 0.3, gap: 0.0, polygons: seed == 1 }, 6.0);
        for k in 0..12 {
            let at = [f64::from(k) * 0.4, 0.5 + 0.3 * f64::from(k % 3)];
            let shape = match k % 3 {
                0 => ShapeSpec::Circle(0.15),
                1 => ShapeSpec::Box([0.2, 0.1]),
                _ => ShapeSpec::Polygon(vec![[-0.2, -0.1], [0.2, -0.1], [0.0, 0.2]]),
            };
            bodies.push(BodySpec::new(shape, at).surface(0.3, 0.4).moving([1.0, 0.0], 2.0));
        }
        scene_of(bodies, Forces::gravity())
    };
    for seed in 0..2 {
        let mut ends = Vec::new();
        for settings in at_every_width(Settings::default()) {
            let mut world = start(&scene(seed), settings);
            for _ in 0..180 {
                world.step(DT_SECS).expect("stays finite");
            }
            ends.push((settings.precision, world.hash()));
        }
        assert!(ends.iter().all(|end| ends.iter().all(|other| end.0 != other.0 || end == other)), "{ends:?}");
    }
}
