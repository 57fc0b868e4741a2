//! Contact, table B of the cases: one file per family, each scene with its closed form and where that comes from beside
//! it. What a case varies to find a limit (an angle, an overhang, a thickness) is a parameter of its function; the named
//! scene has it at the limit, or where the case looks.

mod chain;
mod gas;
mod impact;
mod rolling;
mod sliding;
mod stacks;
mod tipping;

use lamina2d::scene::named::{SceneInfo, fixed as info};
use lamina2d::scene::{basics, driven};

use super::{BodyKind, BodySpec, Form, Scene, ShapeSpec, exact};

pub use chain::{CHAIN_LENGTH_M, chain_at};
pub use gas::{GAS, Gas, reversed};
pub use impact::{
    BILLIARD_SECS, BILLIARD_SIZE_M, ELASTIC_DROP_M, after_head_on, after_oblique, cradle_at_once_after,
    cradle_gaps_after, cradle_touching_after,
};
pub use rolling::{LOOP_RADIUS_M, bowl_period_secs, loop_at};
pub use sliding::{STICK_FRICTION, TOPPLE_RATIO, block_on_slope, box_on_slope, pushed_board_accelerations};
pub use stacks::{ARCH_LIMIT, OVERHANG_BLOCKS, arch, offset_loads, overhang, stack_loads};
pub use tipping::{painleve_friction, rocking_block, rocking_ratio};

/// m/s², downward.
pub const GRAVITY: f64 = 9.81;

/// A body that goes straight on with its velocity.
fn kinematic(body: BodySpec) -> BodySpec {
    BodySpec { kind: BodyKind::Kinematic, ..body }
}

/// The scenes of table B, in its order.
pub(super) const SCENES: &[SceneInfo] = &[
    info("b01_sliding_block", "B1: a block slides to a stop", |_, _| basics::slide(), 1),
    info(
        "b02_stick_limit",
        "B2: a block on the steepest slope it stays on",
        |_, _| sliding::stick_limit(),
        1,
    ),
    info("b03_incline_slide", "B3: a block slides down a slope", |_, _| basics::incline(), 1),
    info("b03_topple", "B3: a box on the steepest slope it stands on", |_, _| sliding::topple_limit(), 1),
    info("b04_rolling_disc", "B4: a disc rolls down a slope", |_, _| basics::roll(), 1),
    info("b04_slipping_disc", "B4: a disc slips down a steep slope", |_, _| rolling::slipping(), 1),
    info("b05_slide_to_roll", "B5: a disc slides until it rolls", |_, _| basics::slide_to_roll(), 1),
    info("b06_bowl", "B6: a disc rolls to and fro in a bowl", |_, _| rolling::bowl(), 1),
    info("b08_loop_sliding", "B8: a disc slides round a loop, just", |_, _| rolling::loop_sliding(), 1),
    info("b08_loop_rolling", "B8: a disc rolls round a loop, just", |_, _| rolling::loop_rolling(), 1),
    info("b10_bounces", "B10: a disc bounces, e = 0.8", |_, _| basics::bounce(), 1),
    info("b11_elastic_ball", "B11: a disc bounces for ever, e = 1", |_, _| impact::elastic_ball(), 1),
    info("b12_head_on", "B12: discs of many masses and e meet head on", |_, _| impact::head_on(), 32),
    info(
        "b12_head_on_boxes",
        "B12: boxes of many masses and e meet head on",
        |_, _| impact::head_on_boxes(),
        32,
    ),
    info("b13_oblique", "B13: spinning discs meet a wall obliquely", |_, _| impact::oblique(), 8),
    info("b14_rod_hit", "B14: a disc hits a free rod off its middle", |_, _| basics::rod_hit(), 2),
    info("b16_box_billiard", "B16: a disc in a box, e = 1", |_, _| impact::box_billiard(), 1),
    info("b17_cradle_gaps", "B17: a cradle whose discs are apart", |_, _| impact::cradle_gaps(), 5),
    info("b17_cradle_touching", "B17: a cradle whose discs touch", |_, _| impact::cradle_touching(), 3),
    info("b18_stack", "B18: boxes of many masses on each other", |_, _| stacks::stack(), 10),
    info("b18_offset", "B18: a box off the middle of another", |_, _| stacks::offset(), 2),
    info("b21_overhang", "B21: blocks that reach out as far as they can", |_, _| stacks::overhang(1.0), 5),
    info("b22_arch", "B22: a semicircular arch as thin as it can be", |_, _| stacks::arch(ARCH_LIMIT), 31),
    info("b23_rocking_block", "B23: a block rocks from edge to edge", |_, _| tipping::rocking(), 1),
    info("b24_pushed_board", "B24: a pushed board carries rolling discs", |_, _| sliding::pushed_board(), 4),
    info("b25_conveyor", "B25: a block on a belt", |_, _| sliding::conveyor(), 2),
    info("b26_hanging_chain", "B26: a chain that hangs from both ends", |_, _| chain::hanging(), 20),
    info("b27_dominoes", "B27: a row of dominoes", |_, _| driven::dominoes(16), 16),
    info("b28_gas", "B28: a gas of hard discs, e = 1", |_, seed| gas::gas(seed), 400),
    info("b30_break", "B30: a billiard break", |_, _| gas::billiard_break(), 16),
    info("b31_painleve", "B31: a rod sent along a rough floor on its end", |_, _| tipping::painleve(), 1),
];

/// The closed forms of those whose whole course is known.
pub(super) const FORMS: &[(&str, Form)] = &[
    ("b01_sliding_block", exact::slide_at),
    ("b03_incline_slide", exact::incline_at),
    ("b04_rolling_disc", exact::roll_at),
    ("b04_slipping_disc", rolling::slipping_at),
    ("b05_slide_to_roll", exact::slide_to_roll_at),
    ("b10_bounces", exact::bounce_at),
    ("b14_rod_hit", exact::rod_hit_at),
    ("b16_box_billiard", impact::box_billiard_at),
    ("b24_pushed_board", sliding::pushed_board_at),
    ("b25_conveyor", sliding::conveyor_at),
    ("b26_hanging_chain", chain::hanging_at),
];
