//! `pgs`: sequential impulses (projected Gauss–Seidel) with warm start and friction cone.
//!
//! Each contact keeps the impulses λ it needed last time; a substep applies them first and then corrects
//! them, [`ITERATIONS`] times over all contacts: λ ← the non-negative solution of K·λ + (v − K·λ_old) = 0 for
//! the normals of a contact together, λ_t ← clamp(λ_t − m_t·v_t, ±μ·λ_n) for friction. What one pass cannot
//! solve the next step begins with, so a pile that `impulse` lets sink by 20 cm stands.
//! Source: Catto, Iterative Dynamics with Temporal Coherence, GDC 2005; the pair of points after his
//! block solver in Box2D Lite's successor, written anew for lanes.
//!
//! Overlap is corrected as in `impulse`: displacement, not velocity, so that it adds no energy.
//! Contacts up to [`MARGIN_M`] apart take part: their points may approach by no more than the gap. Without
//! it contacts came and went from step to step, and a stack of ten breathed by 4 cm.
//! A contact bounces only where it is new: one that carried load in the last step is resting.

use crate::column::Column;
use crate::contact::{Impulses, Manifolds, impulse};
use crate::lanes::{Lanes, ROW, Real};

use super::Traits;
use super::color::{Batch, Coloring};
use super::constraint::{BOUNCE_THRESHOLD_M_PER_S, Contacts, Side, non_negative};

/// Gaps up to this are contacts, metres.
pub(super) const MARGIN_M: f64 = 0.01;
/// Passes over all contacts per substep.
const ITERATIONS: usize = 1;

/// Warm start and [`ITERATIONS`] passes over all contacts, colour by colour.
pub(super) fn solve<L: Lanes>(
    traits: Traits,
    h_secs: f64,
    manifolds: &Manifolds<L::Elem>,
    impulses: &mut Impulses<L::Elem>,
    coloring: &Coloring,
    rows: &mut Column<L::Elem>,
) {
    let per_sec = L::lit(1.0 / h_secs);
    let (rows, impulses) = (rows.rows_mut(), impulses.rows_mut());
    for batch in coloring.batches() {
        if batch.points == 1 {
            warm_start::<L, 1>(manifolds, impulses, batch, rows);
        } else {
            warm_start::<L, 2>(manifolds, impulses, batch, rows);
        }
    }
    for _ in 0..ITERATIONS {
        match (traits.friction, traits.restitution) {
            (true, true) => pass::<L, true, true>(manifolds, impulses, per_sec, coloring, rows),
            (true, false) => pass::<L, true, false>(manifolds, impulses, per_sec, coloring, rows),
            (false, true) => pass::<L, false, true>(manifolds, impulses, per_sec, coloring, rows),
            (false, false) => pass::<L, false, false>(manifolds, impulses, per_sec, coloring, rows),
        }
    }
}

fn pass<L: Lanes, const FRICTION: bool, const BOUNCE: bool>(
    manifolds: &Manifolds<L::Elem>,
    impulses: &mut [[L::Elem; ROW]],
    per_sec: L,
    coloring: &Coloring,
    rows: &mut [[L::Elem; ROW]],
) {
    for batch in coloring.batches() {
        if batch.points == 1 {
            solve_batch::<L, FRICTION, BOUNCE, 1>(manifolds, impulses, per_sec, batch, rows);
        } else {
            solve_batch::<L, FRICTION, BOUNCE, 2>(manifolds, impulses, per_sec, batch, rows);
        }
    }
}

/// Applies the impulses a batch of contacts carries.
#[inline(always)]
fn warm_start<L: Lanes, const POINTS: usize>(
    manifolds: &Manifolds<L::Elem>,
    impulses: &[[L::Elem; ROW]],
    batch: &Batch,
    rows: &mut [[L::Elem; ROW]],
) {
    let contacts = Contacts::<L, POINTS>::gather(manifolds, batch);
    let carried = L::gather_rows(impulses, &batch.contact);
    let (mut a, mut b) = (Side::gather(rows, &batch.a), Side::gather(rows, &batch.b));
    for k in 0..POINTS {
        let (normal, tangent) = (carried[impulse::NORMAL + k], carried[impulse::TANGENT + k]);
        contacts.push(&mut a, &mut b, k, contacts.normal * normal + contacts.tangent * tangent);
    }
    a.scatter(rows, &batch.a[..batch.len]);
    b.scatter(rows, &batch.b[..batch.len]);
}

/// One visit to a batch of contacts.
#[inline(always)]
fn solve_batch<L: Lanes, const FRICTION: bool, const BOUNCE: bool, const POINTS: usize>(
    manifolds: &Manifolds<L::Elem>,
    impulses: &mut [[L::Elem; ROW]],
    per_sec: L,
    batch: &Batch,
    rows: &mut [[L::Elem; ROW]],
) {
    let contacts = Contacts::<L, POINTS>::gather(manifolds, batch);
    let mut carried = L::gather_rows(impulses, &batch.contact);
    let (mut a, mut b) = (Side::gather(rows, &batch.a), Side::gather(rows, &batch.b));
    let response = contacts.response(&a, &b);

    let old: [L; POINTS] = std::array::from_fn(|k| carried[impulse::NORMAL + k]);
    let answered = response.times(old);
    let wanted: [L; POINTS] = std::array::from_fn(|k| {
        let mut approach = contacts.velocity(&a, &b, k).dot(contacts.normal);
        if BOUNCE {
            // Decided at the first visit and kept for the others.
            let bounces = approach.lt(L::lit(-BOUNCE_THRESHOLD_M_PER_S)) & old[k].le(L::zero());
            let bounce = L::select(bounces, contacts.restitution * approach, carried[impulse::BOUNCE + k]);
            carried[impulse::BOUNCE + k] = bounce;
            approach = approach + bounce;
        }
        // A point still apart may close its gap within the substep.
        let gap = L::zero().max(contacts.separation(&a, &b, k));
        approach + gap * per_sec - answered[k]
    });
    let total = non_negative(&response, wanted);
    for k in 0..POINTS {
        carried[impulse::NORMAL + k] = total[k];
        contacts.push(&mut a, &mut b, k, contacts.normal * (total[k] - old[k]));
    }
    if FRICTION {
        for k in 0..POINTS {
            let bound = contacts.friction * total[k];
            let sliding = contacts.velocity(&a, &b, k).dot(contacts.tangent);
            let held = carried[impulse::TANGENT + k];
            let next = (-bound).max(bound.min(held - sliding * contacts.tangent_mass(&a, &b, k)));
            carried[impulse::TANGENT + k] = next;
            contacts.push(&mut a, &mut b, k, contacts.tangent * (next - held));
        }
    }
    contacts.correct(&response, &mut a, &mut b);
    a.scatter(rows, &batch.a[..batch.len]);
    b.scatter(rows, &batch.b[..batch.len]);
    let mut out = [[L::Elem::ZERO; ROW]; 16];
    L::store_rows(carried, &mut out);
    for (row, &contact) in out.iter().zip(&batch.contact[..batch.len]) {
        impulses[contact as usize] = *row;
    }
}
