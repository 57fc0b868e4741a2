//! Stability, table T of the cases: each scene as a function of the one number that is raised until it breaks. What the
//! named scene has for it is where the table looks.

mod joined;
mod moving;
mod piles;

use lamina2d::scene::named::{SceneInfo, fixed as info};

pub use joined::{heavy_chain, net};
pub use moving::{confined, dense, drifting, fired, flung, pulled, spun, stirred, tumbling};
pub use piles::{
    arched, card_house, column, crowned, far, footed, heavy, laden, pyramid, scaled, sizes, sunk, tilted,
    wide,
};

/// Boxes of a tilted column.
pub const TILTED_BOXES: usize = 10;
/// The weight that T16 takes away: the last body.
pub const LADEN_BOXES: usize = 5;

/// The scenes of table T, in its order.
pub(super) const SCENES: &[SceneInfo] = &[
    info(
        "t01_column",
        "T1: a column of 15 boxes, 1 cm to the right and left in turn",
        |_, _| column(15.0),
        15,
    ),
    info("t02_columns", "T2: a column of 80 boxes", |_, _| column(80.0), 80),
    info("t03_tilted", "T3: columns that lean by 1 to 19 cm a box", |_, _| tilted(0.2), 100),
    info("t04_pyramid", "T4: a pyramid of 5050 boxes", |_, _| pyramid(100.0), 5050),
    info("t05_crowned", "T5: a pyramid whose top is 300 times as dense", |_, _| crowned(300.0), 55),
    info("t06_feet", "T6: a box of 20 m on two of 1 m", |_, _| footed(20.0), 3),
    info("t07_heavy", "T7: a box on one of a hundredth of its mass", |_, _| heavy(100.0), 2),
    info("t08_sizes", "T8: boxes of 1 to 32 m, the smallest at the bottom", |_, _| sizes(6.0), 6),
    info("t09_chain", "T9: a chain of 17 links and a weight of 1000", |_, _| heavy_chain(17, 1000.0), 18),
    info("t10_chain", "T10: a chain of 50 links and a weight of 50000", |_, _| heavy_chain(50, 5e4), 51),
    info("t12_cards", "T12: a house of cards", |_, _| card_house(4.0), 26),
    info("t13_arch", "T13: an arch with four boxes on its keystone", |_, _| arched(4.0), 21),
    info("t14_overlap", "T14: boxes a quarter in each other", |_, _| sunk(0.25), 100),
    info("t14_point", "T14: bodies at one point", |_, _| dense(20.0), 20),
    info("t15_confined", "T15: 625 discs packed into a box", |_, _| confined(0.39), 625),
    info("t16_removed", "T16: a weight of 100 boxes, to be taken away", |_, _| laden(100.0), 6),
    info("t17_pulled", "T17: 400 discs pulled to the centre", |_, _| pulled(400.0), 400),
    info("t18_bullet", "T18: a disc at 200 m/s and a thin wall", |_, _| fired(200.0), 1),
    info("t19_bullets", "T19: wedge, sliver and plate and thin walls", |_, _| flung(1.0), 3),
    info("t20_spinner", "T20: a bar that stirs 2000 small bodies", |_, seed| stirred(2000.0, seed), 2000),
    info("t21_far", "T21: a pyramid 1e5 m from the origin", |_, _| far(1e5), 55),
    info("t22_wide", "T22: a column on a floor of 2000 km", |_, _| wide(1e6), 5),
    info("t23_tiny", "T23: a pyramid of boxes of 5 cm", |_, _| scaled(0.05), 465),
    info("t24_net", "T24: a net of discs", |_, _| net(8.0), 64),
    info("t25_spin", "T25: a long box at 1000 rad/s", |_, _| spun(1000.0), 1),
    info("t27_drift", "T27: bodies that drift without gravity", |_, _| drifting(1.0), 12),
];
