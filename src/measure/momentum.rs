//! Does what bodies gain agree with what is said to have pushed them?

use crate::contact::Contact;

/// What can move, around one round of integrating and solving.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pushed {
    /// kg; 0 of what nothing can push, which counts for nothing.
    pub mass: f64,
    /// kg·m².
    pub inertia: f64,
    /// Centroid where contacts were found, metres.
    pub position: [f64; 2],
    /// Velocity (m/s) and angular velocity (rad/s) before.
    pub before: [f64; 3],
    /// The same after.
    pub after: [f64; 3],
    /// Force (N) and torque (N·m) of fields.
    pub force: [f64; 3],
}

/// ‖M(v⁺ − v⁻) − h·f − Jᵀλ‖ / (‖M·v⁻‖ + h·‖f‖) of a round of `h_secs`: 0 where no impulse is lost or made up. Norms are
/// Euclidean over all bodies; angular momenta count over `unit_length`, metres, such as a body's size.
///
/// `bodies` are by slot, `contacts` those of the round with the impulses of it (N·s), friction's at the mean of a contact's points;
/// contacts that bounce must not be among them, as what they carry ends with the impact. 0 where nothing moves or is pulled.
///
/// The equation of motion of a step as the non-smooth dynamics have it: D. Stewart, J. Trinkle, "An implicit time-stepping
/// scheme for rigid body dynamics", Int. J. Numer. Meth. Eng. 39 (1996) 2673.
pub fn momentum_balance(bodies: &[Pushed], contacts: &[Contact], h_secs: f64, unit_length: f64) -> f64 {
    let mut lacks: Vec<[f64; 3]> = bodies.iter().map(|body| body.lacks(h_secs)).collect();
    for contact in contacts {
        let [a, b] = [contact.a as usize, contact.b as usize];
        let to_b = [0, 1].map(|k| bodies[b].position[k] - bodies[a].position[k]);
        let mut push = |arm: [f64; 2], along: [f64; 2], impulse: f64| {
            let given = along.map(|n| n * impulse);
            for (slot, arm, sign) in [(a, arm, -1.0), (b, [arm[0] - to_b[0], arm[1] - to_b[1]], 1.0)] {
                let turn = arm[0] * given[1] - arm[1] * given[0];
                for (lack, part) in lacks[slot].iter_mut().zip([given[0], given[1], turn]) {
                    *lack -= sign * part;
                }
            }
        };
        let n = contact.normal;
        let count = contact.points.len().max(1) as f64;
        let mut middle = [0.0; 2];
        for point in &contact.points {
            push(point.arm_a, n, point.impulse);
            middle = [0, 1].map(|k| middle[k] + point.arm_a[k] / count);
        }
        push(middle, [-n[1], n[0]], contact.tangent_impulse);
    }
    let norm = |of: &dyn Fn(usize) -> [f64; 3]| {
        let square = |[x, y, turn]: [f64; 3]| x * x + y * y + (turn / unit_length).powi(2);
        let movable = (0..bodies.len()).filter(|slot| bodies[*slot].mass > 0.0);
        movable.map(|slot| square(of(slot))).sum::<f64>().sqrt()
    };
    let scale =
        norm(&|slot| bodies[slot].momentum(bodies[slot].before)) + h_secs * norm(&|slot| bodies[slot].force);
    if scale > 0.0 { norm(&|slot| lacks[slot]) / scale } else { 0.0 }
}

impl Pushed {
    fn momentum(&self, [x, y, turn]: [f64; 3]) -> [f64; 3] {
        [self.mass * x, self.mass * y, self.inertia * turn]
    }

    /// What contacts must have given.
    fn lacks(&self, h_secs: f64) -> [f64; 3] {
        let (before, after) = (self.momentum(self.before), self.momentum(self.after));
        [0, 1, 2].map(|k| after[k] - before[k] - h_secs * self.force[k])
    }
}
