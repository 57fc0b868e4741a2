//! Free flight, scheme by scheme, with its closed form and without.

use lamina2d::body::Bodies;
use lamina2d::force::{Field, Forces};
use lamina2d::internals::{self, Plan, Workers};
use lamina2d::lanes::{Lanes, f32s};
use lamina2d::measure::state_hash;
use lamina2d::settings::{Integrator, Skip, Skips};

use super::{Kernel, SIZES, Stage, list_width, list_widths};
use crate::common::{Answer, DT_SECS, Settled};

/// One step of bodies that touch nothing.
struct Flight {
    bodies: Bodies<f32>,
    fields: Vec<Field<f32>>,
    integrator: Integrator,
    skips: Skips,
}

impl Flight {
    fn new(settled: &Settled, bodies: usize, integrator: Integrator, skips: Skips) -> Self {
        let mut bodies = settled.get(&format!("free_flight/{bodies}"), 0).bodies().clone();
        for slot in bodies.slots().collect::<Vec<_>>() {
            bodies.w[slot] = 1.0;
        }
        Self { bodies, fields: Forces::gravity().fields(), integrator, skips }
    }
}

impl Stage for Flight {
    type Memory<L: Lanes<Elem = f32>> = Bodies<f32>;

    fn elements(&self) -> usize {
        self.bodies.live()
    }

    fn memory<L: Lanes<Elem = f32>>(&self) -> Bodies<f32> {
        self.bodies.clone()
    }

    fn run<L: Lanes<Elem = f32>>(&self, bodies: &mut Bodies<f32>) {
        let Self { integrator, ref fields, skips, .. } = *self;
        internals::fly_at(
            L::WIDTH,
            &Plan {
                integrator,
                fields,
                h_secs: DT_SECS,
                since_secs: 0.0,
                substeps: 1,
                skips,
                moving: false,
                carries: false,
                workers: &Workers::ALONE,
            },
            bodies,
        );
    }

    fn answer<L: Lanes<Elem = f32>>(&self, bodies: &Bodies<f32>) -> Answer {
        let moved = bodies.slots().filter(|&slot| bodies.y[slot] != self.bodies.y[slot]);
        Answer { count: moved.count(), hash: state_hash(bodies) }
    }
}

/// The kernel the gate proves itself with, once, with a hundredth more to do, and with twice as much: bodies fill 6400,
/// 6464 and 12,800 slots with the world's.
fn list_proof(kernels: &mut Vec<Kernel>) {
    for (name, bodies) in [("once", 6399), ("one_percent_more", 6463), ("twice", 12_799)] {
        let kernel = format!("proof/{name}/{bodies}");
        list_width::<f32s::X8, _>(kernels, &kernel, &kernel, move |settled| {
            Flight::new(settled, bodies, Integrator::Rk4, Skips::NONE)
        });
    }
}

/// Every scheme.
pub(super) fn list(kernels: &mut Vec<Kernel>) {
    for size in SIZES {
        for &integrator in Integrator::ALL {
            // Under gravity alone the closed form is the same to the bit.
            let alike = format!("integrate/{integrator}/{size}");
            // Nothing else is left out: attitudes are turned.
            list_widths(kernels, &alike, &alike, move |settled| {
                Flight::new(settled, size, integrator, Skips::NONE)
            });
            if matches!(integrator, Integrator::ExplicitEuler | Integrator::SemiImplicitEuler) {
                // They have one stage and no closed form.
                continue;
            }
            list_widths(
                kernels,
                &format!("integrate/{integrator}_closed_form/{size}"),
                &alike,
                move |settled| Flight::new(settled, size, integrator, Skips::NONE.with(Skip::ClosedForm)),
            );
        }
    }
    list_proof(kernels);
}
