//! Bodies over flush static shapes: nothing of the joints is felt.
//!
//! Without friction nothing acts along the surface: x = v·t, the height stays, and so does ½mv². On a slope the pull along
//! it is g·sin α. A bounce at a joint of one straight surface is one bounce off that surface: v′ = v − 2(v·n)n.

use lamina2d::scene::{BodySpec, ShapeSpec};

use super::case::{Case, Column, Expect, G, RATE, What, disc, rectangle};

/// A shape that fits into 0.5 m, lying on y = 0 at the origin, with its height.
fn slider(shape: usize, size: f64) -> (BodySpec, f64) {
    match shape {
        0 => (disc(size, [0.0, size]), size),
        1 => (rectangle([size; 2], [0.0, size]), size),
        _ => {
            let low = size * 3f64.sqrt() / 2.0;
            let corner = |k: u32| (f64::from(k) * 60f64.to_radians()).sin_cos();
            let outline = (0..6).map(|k| [size * corner(k).1, size * corner(k).0]).collect();
            (BodySpec::new(ShapeSpec::Polygon(outline), [0.0, low]), low)
        }
    }
}

const NAMES: [&str; 3] = ["disc", "box", "hexagon"];

/// Tiles of a width from the origin's left to as far as a body comes, `extra` wider than their pitch.
fn tiles(width: f64, extra: f64, length: f64) -> Vec<BodySpec> {
    let deep = width.max(0.5);
    let tile = |k: usize| {
        let x = (k as f64 - 1.0) * width;
        rectangle([0.5 * (width + extra), 0.5 * deep], [x, -0.5 * deep]).surface(0.0, 0.0).fixed()
    };
    (0..3 + ((length + 1.0) / width).ceil() as usize).map(tile).collect()
}

/// A body goes over tiles at a speed, for six of them or a minute.
fn over(shape: usize, width: f64, extra: f64, speed: f64) -> Case {
    let length = (6.3 * width).max(1.0).min(60.0 * speed);
    let steps = (length / speed * RATE).round().max(3.0);
    let secs = steps / RATE;
    let mut bodies = tiles(width, extra, speed * secs);
    let (body, height) = slider(shape, 0.25);
    let at = bodies.len();
    bodies.push(body.mass(1.0).surface(0.0, 0.0).moving([speed, 0.0], 0.0));
    let gap = match extra {
        e if e < 0.0 => ", gaps",
        e if e > 0.0 => ", overlaps",
        _ => "",
    };
    let name = format!("{} over tiles of {width} m at {speed} m/s{gap}", NAMES[shape]);
    let energy = 0.5 * speed * speed;
    Case::new(name, bodies, secs)
        .end(at, Column::X, speed * secs, 1e-4 * speed * secs + 1e-3)
        .end(at, Column::Y, height, 2e-3)
        .expect(What::KineticAlways, energy, 1e-3 * energy + 1e-5)
}

/// A disc or box slides down a straight slope made of tiles.
fn down(shape: usize, slope_rad: f64) -> Case {
    let (s, c) = slope_rad.sin_cos();
    let along = |t: f64, n: f64| [t * c + n * s, -t * s + n * c];
    let tile = |k: usize| {
        rectangle([0.5, 0.5], along(k as f64 - 1.0, -0.5)).turned(-slope_rad).surface(0.0, 0.0).fixed()
    };
    let mut bodies: Vec<_> = (0..16).map(tile).collect();
    let (body, height) = slider(shape, 0.25);
    let (at, secs) = (bodies.len(), 2.0);
    bodies.push(
        BodySpec { position: along(0.0, height), ..body }.turned(-slope_rad).mass(1.0).surface(0.0, 0.0),
    );
    let (pull, name) = (G * s, format!("{} down tiles at {slope_rad} rad", NAMES[shape]));
    let [vx, vy] = along(pull * secs, 0.0);
    let right = along(0.5 * pull * secs * secs, height);
    Case::new(name, bodies, secs)
        .end(at, Column::Vx, vx, 2e-3 * vx.abs())
        .end(at, Column::Vy, vy, 2e-3 * vy.abs())
        .end(at, Column::X, right[0], 2e-3 * right[0].abs() + 5e-3)
}

/// An elastic disc falls exactly onto the joint of two triangles that form one straight slope.
fn bounce(slope: f64) -> Case {
    let long = 2.0;
    let left = ShapeSpec::Polygon(vec![[-long, long * slope], [0.0, -long], [0.0, 0.0]]);
    let right = ShapeSpec::Polygon(vec![[0.0, 0.0], [0.0, -long], [long, -long * slope]]);
    let still = |shape| BodySpec::new(shape, [0.0; 2]).surface(1.0, 0.0).fixed();
    let over = (1.0 + slope * slope).sqrt();
    let normal = [slope / over, 1.0 / over];
    let touch = normal.map(|n| 0.1 * n);
    let ball = disc(0.1, [touch[0], touch[1] + 1.0]).mass(1.0).surface(1.0, 0.0);
    let speed = (2.0 * G).sqrt();
    let after = [2.0 * speed * normal[1] * normal[0], -speed + 2.0 * speed * normal[1] * normal[1]];
    let fall_secs = (2.0 / G).sqrt();
    // Long enough to fly, too short to come down.
    let steps = ((fall_secs + 0.2) * RATE).ceil();
    let rest = steps / RATE - fall_secs;
    Case::new(
        format!("bounce at the joint of a slope of {slope}"),
        vec![still(left), still(right), ball],
        steps / RATE,
    )
    .end(2, Column::Vx, after[0], 0.01 * speed)
    .end(2, Column::Vy, after[1] - G * rest, 0.01 * speed)
    .end(2, Column::X, touch[0] + after[0] * rest, 0.02)
}

/// A box thrown along tiles turns no more than on one slab.
fn straight(speed: f64) -> Case {
    let case = over(1, 0.5, 0.0, speed);
    let at = case.scene.bodies.len() - 1;
    let angle = case.last(at, Column::Angle);
    Case { name: format!("box keeps its attitude over tiles at {speed} m/s"), ..case }
        .holds(Expect::near(angle, 0.0, 1e-3))
}

pub(super) fn cases() -> Vec<Case> {
    let ways = [(0.02, 0.05), (0.1, 0.05), (0.1, 5.0), (1.0, 5.0), (1.0, 50.0), (20.0, 50.0)];
    let plain = (0..3).flat_map(|shape| ways.map(|(width, speed)| over(shape, width, 0.0, speed)));
    let rough =
        [(0, 1e-3), (1, 1e-3), (0, -1e-4), (1, -1e-4)].map(|(shape, extra)| over(shape, 1.0, extra, 5.0));
    let slopes = [(0, 0.1), (1, 0.1), (0, 0.5), (1, 0.5)].map(|(shape, slope)| down(shape, slope));
    let bounces = [0.25, 0.5, 1.0].map(bounce);
    plain.chain(rough).chain(slopes).chain(bounces).chain([straight(0.5), straight(10.0)]).collect()
}
