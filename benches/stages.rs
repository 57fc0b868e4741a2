//! Each stage's kernels alone, on the bodies of settled scenes, at every lane width: what they are, see
//! [`kernels`]. Time per element.

mod clock;
mod common;
mod kernels;

use std::time::{Duration, Instant};

use criterion::{Bencher, BenchmarkId, Throughput};

use clock::criterion;
use common::{Agreement, Settled, step_through};
use kernels::{Kernel, Work};

fn main() {
    let mut criterion = criterion();
    let settled = Settled::new(step_through);
    let agreement = Agreement::default();
    let kernels = kernels::all();
    for group in kernels.chunk_by(|a, b| group_of(a) == group_of(b)) {
        let mut timed = criterion.benchmark_group(group_of(&group[0]));
        for kernel in group {
            let mut work = kernel.build(&settled);
            let (function, lanes) = split(&kernel.name);
            timed.throughput(Throughput::Elements(work.elements() as u64));
            let mut checked = false;
            timed.bench_function(BenchmarkId::new(function, lanes), |bencher| {
                if !std::mem::replace(&mut checked, true) {
                    work.run();
                    let answer = work.answer();
                    assert!(answer.count > 0, "{} found nothing to do", kernel.name);
                    agreement.check(&kernel.alike, &kernel.name, answer);
                }
                time(bencher, work.as_mut());
            });
        }
        timed.finish();
    }
    criterion.final_summary();
}

fn group_of(kernel: &Kernel) -> &str {
    kernel.name.split('/').next().unwrap_or_default()
}

/// `group/function/…/xLANES` without its group.
fn split(name: &str) -> (&str, &str) {
    let (function, lanes) = name.rsplit_once('/').expect("a name that ends in lanes");
    (function.split_once('/').expect("a name that begins with a group").1, lanes)
}

/// Calls one after the other in the same memory. Where one would find the work of the last done, memory is put back
/// as it was while the clock stands.
fn time(bencher: &mut Bencher<'_>, work: &mut dyn Work) {
    if !work.resets() {
        return bencher.iter(|| work.run());
    }
    bencher.iter_custom(|calls| {
        let mut elapsed = Duration::ZERO;
        for _ in 0..calls {
            work.reset();
            let start = Instant::now();
            work.run();
            elapsed += start.elapsed();
        }
        elapsed
    });
}
