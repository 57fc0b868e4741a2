//! The error of a state.

use lamina2d::measure::Invariants;
use lamina2d::scene::{BodyKind, BodySpec, Scene};
use lamina2d::simulation::{BodyState, Simulation};

use super::case::Norm;
use crate::cases::Exact;

/// Bodies that can move, with their numbers.
pub(super) fn movable(scene: &Scene) -> impl Iterator<Item = (usize, &BodySpec)> {
    scene.bodies.iter().enumerate().filter(|(_, body)| body.kind != BodyKind::Static)
}

/// A growth beyond this is as good as any: nothing more is to be seen on an axis that goes on to 10¹¹⁹.
const GROWN: f64 = 1e6;

/// What a run began with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    sums: Invariants,
    reach: f64,
}

impl Start {
    pub(super) fn of(world: &dyn Simulation) -> Self {
        let reach = world.states().last().map_or(0.0, |body| body.position[0].abs());
        Self { sums: world.invariants(), reach }
    }
}

impl Norm {
    /// Is it taken after every step, rather than at samples?
    pub(super) fn at_every_step(self) -> bool {
        !matches!(self, Self::Place(_) | Self::Turn)
    }

    /// Of a state that is finite.
    pub(super) fn error(self, world: &dyn Simulation, start: &Start, exact: &[Exact]) -> f64 {
        match self {
            Self::Place(size) => worst(world, exact, |body, exact| {
                let [x, y] = exact.position;
                (body.position[0] - x).hypot(body.position[1] - y) / size
            }),
            Self::Turn => worst(world, exact, |body, exact| {
                let (s, c) = exact.angle.sin_cos();
                (body.rotation[0] - c).hypot(body.rotation[1] - s)
            }),
            Self::Energy(scale) => {
                let total = |sums: &Invariants| sums.kinetic_energy + sums.potential_energy;
                (total(&world.invariants()) - total(&start.sums)).abs() / scale
            }
            Self::Momentum => (world.invariants().angular_momentum / start.sums.angular_momentum - 1.0).abs(),
            Self::Apsis => last(world, apsis),
            Self::Length => last(world, |body| (body.position[0].hypot(body.position[1]) - 1.0).abs()),
            Self::Own(_) => f64::NAN,
            Self::Growth => last(world, |body| (body.position[0].abs() / start.reach).min(GROWN)),
        }
    }
}

fn worst(world: &dyn Simulation, exact: &[Exact], error: impl Fn(&BodyState, &Exact) -> f64) -> f64 {
    let states = world.states();
    exact.iter().map(|exact| error(&states[exact.body], exact)).fold(0.0, f64::max)
}

fn last(world: &dyn Simulation, error: impl Fn(&BodyState) -> f64) -> f64 {
    world.states().last().map_or(f64::NAN, error)
}

/// The angle of the vector of Laplace, Runge and Lenz for μ = 1 about the origin, rad: 0 at first, as orbits begin
/// at their periapsis on the x axis.
fn apsis(body: &BodyState) -> f64 {
    let ([x, y], [vx, vy]) = (body.position, body.velocity);
    let (momentum, r) = (x * vy - y * vx, x.hypot(y));
    (-vx * momentum - y / r).atan2(vy * momentum - x / r).abs()
}
