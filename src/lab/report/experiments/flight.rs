//! Free flight against the machine: bytes the integrator moves per second, beside a plain copy of as many.

use std::time::Instant;

use serde::Serialize;

use lamina2d::force::Forces;
use lamina2d::internals::{self, Plan, Workers};
use lamina2d::settings::{Integrator, Skips};

use crate::cases::by_name;
use crate::report::{Record, median};

/// Reads x, y, vx, vy, w, 1/m and writes x, y, vx, vy of a body that does not spin: f32 each.
const BYTES_PER_BODY: usize = (6 + 4) * 4;

/// One number of bodies.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Bodies, all in free flight.
    pub bodies: usize,
    /// The integrator.
    pub integrator: Integrator,
    /// Median, ns per body and step.
    pub ns_per_body: f64,
    /// Bytes read and written per body and step.
    pub bytes_per_body: usize,
    /// GB/s of the integrator, read + written.
    pub gb_per_s: f64,
    /// GB/s of a copy with the same number of bytes read + written.
    pub copy_gb_per_s: f64,
    /// The integrator's share of the copy.
    pub share: f64,
}

impl Record for Row {
    const NAME: &'static str = "flight";
    const TITLE: &'static str = "Free flight against copy bandwidth";
    const COMMAND: &'static str = "lamina report --only flight";
    const NOTE: &'static str = "The integration pass alone, 8 lanes, beside a copy that reads and writes as many bytes in the same run.";
    const HEADER: &'static [&'static str] =
        &["bodies", "integrator", "ns per body", "bytes per body", "GB/s", "copy GB/s", "share"];

    fn cells(&self) -> Vec<String> {
        vec![
            self.bodies.to_string(),
            self.integrator.to_string(),
            format!("{:.3}", self.ns_per_body),
            self.bytes_per_body.to_string(),
            format!("{:.1}", self.gb_per_s),
            format!("{:.1}", self.copy_gb_per_s),
            format!("{:.0} %", self.share * 100.0),
        ]
    }
}

/// Times the fused integration pass and a copy of as many bytes, taking turns `repeats` times.
///
/// # Errors
/// A scene that cannot be run.
pub fn run(repeats: usize) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for bodies in [1000, 10_000, 100_000, 1_000_000] {
        for integrator in [Integrator::SemiImplicitEuler, Integrator::Rk4] {
            rows.push(measure(bodies, integrator, repeats)?);
        }
    }
    Ok(rows)
}

fn measure(count: usize, integrator: Integrator, repeats: usize) -> anyhow::Result<Row> {
    let scene = by_name("free_flight", Some(count), 1)?;
    let (mut bodies, _) = internals::bodies_after(&scene, 0).map_err(anyhow::Error::from_boxed)?;
    let fields = Forces::gravity().fields();
    let plan = Plan {
        integrator,
        fields: &fields,
        h_secs: 1.0 / 60.0,
        since_secs: 0.0,
        substeps: 1,
        skips: Skips::ALL,
        moving: false,
        carries: false,
        workers: &Workers::ALONE,
    };
    let from = vec![1.0f32; count * BYTES_PER_BODY / 8];
    let mut to = vec![0.0f32; from.len()];
    // Enough calls that the clock's own cost vanishes.
    let calls = (200_000 / count).max(1);
    let (mut ours, mut copies) = (Vec::new(), Vec::new());
    for _ in 0..repeats {
        let start = Instant::now();
        for _ in 0..calls {
            internals::fly_at(8, &plan, std::hint::black_box(&mut bodies));
        }
        ours.push(start.elapsed().as_secs_f64() / calls as f64);
        let start = Instant::now();
        for _ in 0..calls {
            to.copy_from_slice(std::hint::black_box(&from));
            std::hint::black_box(&mut to);
        }
        copies.push(start.elapsed().as_secs_f64() / calls as f64);
    }
    let bytes = (count * BYTES_PER_BODY) as f64;
    let (ours, copy) = (median(&ours), median(&copies));
    Ok(Row {
        bodies: count,
        integrator,
        ns_per_body: ours * 1e9 / count as f64,
        bytes_per_body: BYTES_PER_BODY,
        gb_per_s: bytes / ours / 1e9,
        copy_gb_per_s: bytes / copy / 1e9,
        share: copy / ours,
    })
}
