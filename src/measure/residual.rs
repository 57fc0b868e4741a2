//! How well contacts obey their laws: what each impulse should have been by the velocities and gaps it left behind.
//!
//! Signorini's and Coulomb's laws as projections (M. Jean, "The non-smooth contact dynamics method", Comput. Methods
//! Appl. Mech. Eng. 177 (1999) 235): an impulse is right where one more step of a projected iteration leaves it as it is.

use crate::contact::Contact;

/// What moves on one side of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Side {
    /// Centroid, metres.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
    /// rad/s.
    pub angular_velocity: f64,
    /// 1/kg; 0 where nothing can push it.
    pub inv_mass: f64,
    /// 1/(kg·m²); 0 where nothing can turn it.
    pub inv_inertia: f64,
    /// Coulomb coefficient.
    pub friction: f64,
}

/// The largest of each over all contact points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residuals {
    /// |λₙ − max(0, λₙ − ρuₙ)|, N·s: does a point push only where it does not part, and never pull? uₙ is the speed at
    /// which the point parts, ρ the effective mass there.
    pub signorini: f64,
    /// |λₜ − clamp(λₜ − ρuₜ, ±μΣλₙ)|, N·s: does friction stop what slides, as far as it may?
    pub friction: f64,
    /// |min(φ, λₙ/k)|, metres, with k = the unit impulse over the unit length given: is there either a gap or a push?
    pub complementarity: f64,
}

impl Residuals {
    /// Of the contacts of a step that do not bounce: impulses of its last round, and the velocities at its end. `side`
    /// tells of a slot's body. `unit_impulse` (N·s, such as mgh of a round) and `unit_length` (metres, such as a body's
    /// size) make impulses and gaps comparable in [`Residuals::complementarity`].
    pub fn of(contacts: &[Contact], side: impl Fn(u32) -> Side, unit_impulse: f64, unit_length: f64) -> Self {
        let mut worst = Self::default();
        for contact in contacts {
            let sides = [side(contact.a), side(contact.b)];
            let n = contact.normal;
            let t = [-n[1], n[0]];
            let mut pushed = 0.0;
            for point in &contact.points {
                let (mass, speed) = seen(&sides, point.arm_a, n);
                let (impulse, gap) = (point.impulse, point.separation);
                let right = (impulse - mass * speed).max(0.0);
                worst.signorini = worst.signorini.max((impulse - right).abs());
                let either = (gap / unit_length).min(impulse / unit_impulse).abs() * unit_length;
                worst.complementarity = worst.complementarity.max(either);
                pushed += impulse;
            }
            let count = contact.points.len().max(1) as f64;
            let sum = |k: usize| contact.points.iter().map(|point| point.arm_a[k]).sum::<f64>();
            let (mass, speed) = seen(&sides, [sum(0) / count, sum(1) / count], t);
            let most = sides[0].friction.min(sides[1].friction) * pushed.max(0.0);
            let right = (contact.tangent_impulse - mass * speed).clamp(-most, most);
            worst.friction = worst.friction.max((contact.tangent_impulse - right).abs());
        }
        worst
    }

    /// The same, in shares of an impulse and a length.
    #[must_use]
    pub fn over(self, unit_impulse: f64, unit_length: f64) -> Self {
        Self {
            signorini: self.signorini / unit_impulse,
            friction: self.friction / unit_impulse,
            complementarity: self.complementarity / unit_length,
        }
    }
}

/// Effective mass (kg) and speed (m/s, of B seen from A) along a direction at a point `arm_a` metres from A's centroid.
/// 0 kg where nothing can be moved there.
fn seen(sides: &[Side; 2], arm_a: [f64; 2], along: [f64; 2]) -> (f64, f64) {
    let [a, b] = sides;
    let arm_b = [0, 1].map(|k| a.position[k] + arm_a[k] - b.position[k]);
    let speed = |side: &Side, arm: [f64; 2]| {
        let w = side.angular_velocity;
        along[0] * (side.velocity[0] - w * arm[1]) + along[1] * (side.velocity[1] + w * arm[0])
    };
    let lever = |arm: [f64; 2]| arm[0] * along[1] - arm[1] * along[0];
    let inverse = a.inv_mass
        + b.inv_mass
        + a.inv_inertia * lever(arm_a) * lever(arm_a)
        + b.inv_inertia * lever(arm_b) * lever(arm_b);
    let mass = if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
    (mass, speed(b, arm_b) - speed(a, arm_a))
}
