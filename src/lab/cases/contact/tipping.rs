//! B23 and B31: a block that rocks, a rod on its end.

use lamina2d::force::Forces;
use lamina2d::scene::basics::floor;
use lamina2d::scene::named::scene;
use lamina2d::vec2::{Rot, Vec2};

use super::{BodySpec, Scene, ShapeSpec};

/// Half the width and half the height of the block of B23, metres.
const BLOCK: [f64; 2] = [0.15, 0.6];

/// Half the width and half the height of B23's block, metres.
pub fn rocking_block() -> [f64; 2] {
    BLOCK
}

/// Angle between a side and the diagonal of B23's block, rad.
fn slenderness() -> f64 {
    (BLOCK[0] / BLOCK[1]).atan()
}

/// B23: a block of 0.3 m by 1.2 m, tilted about its lower right edge by half of what would topple it, let go.
pub(super) fn rocking() -> Scene {
    let tilt = -0.5 * slenderness();
    let centre = Rot::<f64>::from_angle(tilt).apply(Vec2::new(-BLOCK[0], BLOCK[1]));
    let block = BodySpec::new(ShapeSpec::Box(BLOCK), [centre.x, centre.y]).turned(tilt).surface(0.0, 1.0);
    scene("a block rocks from edge to edge", vec![floor(1.0, 0.0), block], Forces::gravity(), 120)
}

/// Spin after an impact of B23 over spin before: 1 − 1.5 sin²α (Housner 1963).
///
/// About the edge that is hit nothing turns the block: with I = ⅓mR² about its centre, ⅓mR²ω + mR²ω cos 2α before is
/// (⅓ + 1)mR²ω after.
pub fn rocking_ratio() -> f64 {
    1.0 - 1.5 * slenderness().sin().powi(2)
}

/// Friction of B31's floor.
const ROUGH: f64 = 2.0;
/// Half the length and half the thickness of the rod, metres.
const ROD: [f64; 2] = [0.5, 0.01];

/// The least friction at which a thin rod at the attitude of B31 is Painlevé's paradox: (1 + 3cos²θ)/(3 sin θ cos θ),
/// least, 4/3, at tan θ = 2.
///
/// With the point of contact r from the centre, I = ⅓ml² and friction −μN against the sliding, the point's acceleration
/// up is N(1 + 3cos²θ − 3μ sin θ cos θ)/m: where it is negative, more force brings the end down faster.
pub fn painleve_friction() -> f64 {
    let (s, c) = 2f64.atan().sin_cos();
    (1.0 + 3.0 * c * c) / (3.0 * s * c)
}

/// B31: a rod of 1 m at tan θ = 2, its lower end in front, at 5 m/s over a floor with μ = 2.
pub(super) fn painleve() -> Scene {
    let turn = -2f64.atan();
    // The lowest corner is at the right end, on the lower side.
    let corner = Rot::<f64>::from_angle(turn).apply(Vec2::new(ROD[0], -ROD[1]));
    let rod = BodySpec::new(ShapeSpec::Box(ROD), [0.0, -corner.y]).turned(turn);
    let rod = rod.moving([5.0, 0.0], 0.0).surface(0.0, ROUGH);
    scene("a rod sent along a rough floor", vec![floor(ROUGH, 0.0), rod], Forces::gravity(), 120)
}
