//! `impulse`: the thesis's resolution, cleaned. One pass per substep; the cheap end of the diagram.
//!
//! Kept from it: e = min, μ = min, one impulse per point at once, positional correction by a share of
//! the depth beyond a slop. Mended: separating points are left alone, friction stays in Coulomb's cone,
//! slow approaches do not bounce, both points of a face are corrected, rotation takes part in the
//! correction, and the result does not depend on memory order.
//!
//! For a point with arms rA, rB and normal n, k = 1/mA + 1/mB + (rA×n)²/IA + (rB×n)²/IB and
//! jₙ = max(0, −(1 + e)·vₙ/k); jₜ = clamp(−vₜ/kₜ, ±μ·jₙ) along t = n turned a quarter counter-clockwise.
//! A point's present separation is s + n·(Δx_B + Δθ_B×rB − Δx_A − Δθ_A×rA): changes since the step began.
//!
//! The two points of a face are solved together, directly and by cases ([`non_negative`]): one after the
//! other left a resting box turning at 0.02 rad/s and creeping sideways at 5 cm/s; together, neither.

use crate::column::Column;
use crate::contact::Manifolds;
use crate::lanes::{Lanes, ROW};

use super::Traits;
use super::color::{Batch, Coloring};
use super::constraint::{BOUNCE_THRESHOLD_M_PER_S, Contacts, Side, non_negative};

/// One pass over all contacts, colour by colour.
pub(super) fn solve<L: Lanes>(
    traits: Traits,
    manifolds: &Manifolds<L::Elem>,
    coloring: &Coloring,
    rows: &mut Column<L::Elem>,
) {
    let rows = rows.rows_mut();
    match (traits.friction, traits.restitution) {
        (true, true) => solve_with::<L, true, true>(manifolds, coloring, rows),
        (true, false) => solve_with::<L, true, false>(manifolds, coloring, rows),
        (false, true) => solve_with::<L, false, true>(manifolds, coloring, rows),
        (false, false) => solve_with::<L, false, false>(manifolds, coloring, rows),
    }
}

fn solve_with<L: Lanes, const FRICTION: bool, const BOUNCE: bool>(
    manifolds: &Manifolds<L::Elem>,
    coloring: &Coloring,
    rows: &mut [[L::Elem; ROW]],
) {
    for batch in coloring.batches() {
        if batch.points == 1 {
            solve_batch::<L, FRICTION, BOUNCE, 1>(manifolds, batch, rows);
        } else {
            solve_batch::<L, FRICTION, BOUNCE, 2>(manifolds, batch, rows);
        }
    }
}

/// The contacts of a batch: bodies gathered once, normal impulses, friction, correction, scattered once.
#[inline(always)]
fn solve_batch<L: Lanes, const FRICTION: bool, const BOUNCE: bool, const POINTS: usize>(
    manifolds: &Manifolds<L::Elem>,
    batch: &Batch,
    rows: &mut [[L::Elem; ROW]],
) {
    let contacts = Contacts::<L, POINTS>::gather(manifolds, batch);
    let (mut a, mut b) = (Side::gather(rows, &batch.a), Side::gather(rows, &batch.b));
    let response = contacts.response(&a, &b);

    let approaches: [L; POINTS] = std::array::from_fn(|k| {
        let approach = contacts.velocity(&a, &b, k).dot(contacts.normal);
        if BOUNCE {
            let bounces = approach.lt(L::lit(-BOUNCE_THRESHOLD_M_PER_S));
            approach * (L::one() + L::select(bounces, contacts.restitution, L::zero()))
        } else {
            approach
        }
    });
    let impulses = non_negative(&response, approaches);
    for k in 0..POINTS {
        contacts.push(&mut a, &mut b, k, contacts.normal * impulses[k]);
    }
    if FRICTION {
        for k in 0..POINTS {
            let bound = contacts.friction * impulses[k];
            let sliding = contacts.velocity(&a, &b, k).dot(contacts.tangent);
            let held = (-bound).max(bound.min(-(sliding * contacts.tangent_mass(&a, &b, k))));
            contacts.push(&mut a, &mut b, k, contacts.tangent * held);
        }
    }
    contacts.correct(&response, &mut a, &mut b);
    a.scatter(rows, &batch.a[..batch.len]);
    b.scatter(rows, &batch.b[..batch.len]);
}
