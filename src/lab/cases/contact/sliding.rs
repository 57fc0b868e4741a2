//! B2, B3, B24 and B25: what friction holds, lets go and takes along.

use glam::DVec2;

use lamina2d::force::Forces;
use lamina2d::scene::basics::{floor, on_slope};
use lamina2d::scene::named::scene;

use super::{BodySpec, GRAVITY, Scene, ShapeSpec, kinematic};
use crate::cases::{Exact, moved};

/// Of the block of B2: it stays where tan θ < μ.
pub const STICK_FRICTION: f64 = 0.5;

/// A flat block of 1 m by 0.5 m at rest on a slope of `angle` rad with μ = [`STICK_FRICTION`].
pub fn block_on_slope(angle: f64) -> Scene {
    let shape = ShapeSpec::Box([0.5, 0.25]);
    on_slope("a block at rest on a slope", shape, 0.25, angle, STICK_FRICTION, 120)
}

pub(super) fn stick_limit() -> Scene {
    block_on_slope(STICK_FRICTION.atan())
}

/// Half the width and half the height of the box of B3, metres.
const TALL: [f64; 2] = [0.25, 0.5];
/// Width over height of that box: it stands where tan θ is less, as its weight then points into its base.
pub const TOPPLE_RATIO: f64 = TALL[0] / TALL[1];

/// A box of 0.5 m by 1 m at rest on a slope of `angle` rad with μ = 1, so that it topples before it slides.
pub fn box_on_slope(angle: f64) -> Scene {
    on_slope("a tall box on a slope", ShapeSpec::Box(TALL), TALL[1], angle, 1.0, 240)
}

pub(super) fn topple_limit() -> Scene {
    box_on_slope(TOPPLE_RATIO.atan())
}

/// Of the board and of each disc of B24, kg.
const BOARD_KG: f64 = 10.0;
const DISC_KG: f64 = 1.0;
const DISCS: usize = 3;
const DISC_RADIUS_M: f64 = 0.25;
/// What pushes the board, N, and what the floor holds against it.
const PUSH_N: f64 = 60.0;
const FLOOR_FRICTION: f64 = 0.2;
/// Half the length and half the thickness of the board, metres.
const BOARD: [f64; 2] = [5.0, 0.1];

/// B24: a board of 10 kg on a floor with μ = 0.2, pushed by 60 N, carries three discs of 1 kg that roll on it.
///
/// Bodies: the floor, the board, the discs.
pub(super) fn pushed_board() -> Scene {
    let board = BodySpec::new(ShapeSpec::Box(BOARD), [0.0, BOARD[1]]).mass(BOARD_KG).surface(0.0, 0.8);
    let board = BodySpec { force: [PUSH_N, 0.0], ..board };
    let disc = |k: usize| {
        let x = 2.0 * (k as f64 - (DISCS as f64 - 1.0) / 2.0);
        BodySpec::new(ShapeSpec::Circle(DISC_RADIUS_M), [x, 2.0 * BOARD[1] + DISC_RADIUS_M])
            .mass(DISC_KG)
            .surface(0.0, 0.8)
    };
    let bodies = [floor(FLOOR_FRICTION, 0.0), board].into_iter().chain((0..DISCS).map(disc)).collect();
    scene("a pushed board carries rolling discs", bodies, Forces::gravity(), 60)
}

/// Accelerations of the board and of the discs of B24, m/s².
///
/// Friction f drives a disc: ma₂ = f, and spins it by α = fR/½mR² = 2a₂/R, so that its lowest point, which goes with the
/// board, has a₁ = a₂ + αR = 3a₂. The board: Ma₁ = F − μ(M + nm)g − nf with f = ⅓ma₁.
pub fn pushed_board_accelerations() -> [f64; 2] {
    let carried = DISCS as f64 * DISC_KG;
    let board = (PUSH_N - FLOOR_FRICTION * (BOARD_KG + carried) * GRAVITY) / (BOARD_KG + carried / 3.0);
    [board, board / 3.0]
}

/// x = ½at², and the discs turn by 2·½a₂t²/R: counter-clockwise, as the board runs away below them to the right.
pub(super) fn pushed_board_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let [board, disc] = pushed_board_accelerations().map(|a| 0.5 * a * t * t);
    let along = |way: f64| DVec2::new(way, 0.0);
    let discs = (2..2 + DISCS).map(|k| moved(k, &scene.bodies[k], along(disc), 2.0 * disc / DISC_RADIUS_M));
    std::iter::once(moved(1, &scene.bodies[1], along(board), 0.0)).chain(discs).collect()
}

/// Speed of the belt of B25, m/s, and its friction.
const BELT_SPEED: f64 = 2.0;
const BELT_FRICTION: f64 = 0.3;

/// B25: a block set down at rest on a belt that runs at 2 m/s, μ = 0.3.
pub(super) fn conveyor() -> Scene {
    let belt = kinematic(floor(BELT_FRICTION, 0.0).moving([BELT_SPEED, 0.0], 0.0));
    let block = BodySpec::new(ShapeSpec::Box([0.5, 0.25]), [0.0, 0.25]).surface(0.0, BELT_FRICTION);
    scene("a block on a belt", vec![belt, block], Forces::gravity(), 120)
}

/// ½μgt² until u/μg, then ut − u²/2μg: the block slips by u²/2μg over the belt.
pub(super) fn conveyor_at(scene: &Scene, t: f64) -> Vec<Exact> {
    let pull = BELT_FRICTION * GRAVITY;
    let slips = t.min(BELT_SPEED / pull);
    let way = 0.5 * pull * slips * slips + BELT_SPEED * (t - slips);
    vec![moved(1, &scene.bodies[1], DVec2::new(way, 0.0), 0.0)]
}
