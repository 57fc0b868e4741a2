//! Numbers that cannot be run with are refused before the first step; those that can are run with.

use lamina2d::joint::{Distance, JointKind, JointSpec};
use lamina2d::scene::{BodySpec, ShapeSpec};

use super::case::{Case, Column, Expect, What, disc, rectangle};

fn refused(name: &str, bodies: Vec<BodySpec>) -> Case {
    Case::new(name.to_owned(), bodies, 1.0).holds(Expect::near(What::Refused, 1.0, 0.0))
}

fn with_step(name: &str, dt_secs: f64) -> Case {
    let mut case = refused(name, vec![disc(0.5, [0.0, 0.0])]);
    case.scene.dt_secs = dt_secs;
    case
}

/// Coasts for a second, far out or with extreme numbers that are still good.
fn coasts(name: &str, body: BodySpec) -> Case {
    let (from, speed) = (body.position[0], body.velocity[0]);
    let to = from + speed;
    Case::new(name.to_owned(), vec![body], 1.0).weightless().end(0, Column::X, to, 1e-5 * to.abs().max(speed))
}

pub(super) fn cases() -> Vec<Case> {
    let outline = ShapeSpec::Polygon(vec![[0.0, 0.0], [10.0, 10.0], [5.0, 5.0], [3.0, 3.0]]);
    let lone = |body: BodySpec| vec![body];
    let zero_rod = JointKind::Distance(Distance { length: Some(0.0), ..Distance::default() });
    let pair = vec![disc(0.1, [0.0, 0.0]), disc(0.1, [1.0, 0.0])];
    vec![
        refused("outline without area", lone(BodySpec::new(outline, [0.0; 2]))),
        refused("radius of zero", lone(disc(0.0, [0.0; 2]))),
        refused("box without height", lone(rectangle([1.0, 0.0], [0.0; 2]))),
        refused("mass of zero", lone(disc(0.5, [0.0; 2]).mass(0.0))),
        refused("mass beyond the precision", lone(disc(0.5, [0.0; 2]).mass(1e300))),
        refused("place that is no number", lone(disc(0.5, [f64::NAN, 0.0]))),
        refused("speed beyond the precision", lone(disc(0.5, [0.0; 2]).moving([1e300, 0.0], 0.0))),
        refused("rod of length zero", pair).joined(vec![JointSpec::new(0, 1, zero_rod)]),
        with_step("step of zero", 0.0),
        with_step("step that is no number", f64::NAN),
        with_step("step too short for its square", 1e-39),
        coasts("speck of 1 µm", disc(1e-6, [0.0; 2]).moving([1e-3, 0.0], 0.0)),
        coasts("disc of 1 km", disc(1e3, [0.0; 2]).moving([100.0, 0.0], 0.0)),
        coasts("1e12 kg", disc(1.0, [0.0; 2]).mass(1e12).moving([3.0, 0.0], 0.0)),
        coasts("1e-9 kg", disc(1.0, [0.0; 2]).mass(1e-9).moving([3.0, 0.0], 0.0)),
    ]
}
