//! What the machine can do, measured in the same run: bytes copied per second from each level of its memory, and lane
//! operations per second; and how near to that the stages come.

use std::hint::black_box;
use std::time::Instant;

use serde::Serialize;

use lamina2d::lanes::{Lanes, f32s};

use crate::report::{Data, Record, median};

/// One limit.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// `copy`, or `multiply, add`.
    pub what: &'static str,
    /// Bytes read and written in turn; 0 where nothing is.
    pub bytes: usize,
    /// The smallest level of memory that holds them, or registers.
    pub level: &'static str,
    /// Numbers per vector; 0 for copies.
    pub lanes: usize,
    /// Median, 10⁹ per second.
    pub median: f64,
    /// The best, 10⁹ per second.
    pub best: f64,
    /// Bytes, or lane operations.
    pub unit: &'static str,
}

impl Record for Row {
    const NAME: &'static str = "limits";
    const TITLE: &'static str = "Limits of this machine";
    const COMMAND: &'static str = "lamina report --only limits";
    const NOTE: &'static str = "One thread. A copy reads as many bytes as it writes, both are counted. Multiply, add: \
         independent chains in registers, two operations per lane and link.";
    const HEADER: &'static [&'static str] =
        &["what", "bytes", "level", "lanes", "median G/s", "best G/s", "of"];

    fn cells(&self) -> Vec<String> {
        let or_blank = |n: usize| if n == 0 { String::new() } else { n.to_string() };
        vec![
            self.what.to_owned(),
            or_blank(self.bytes),
            self.level.to_owned(),
            or_blank(self.lanes),
            format!("{:.1}", self.median),
            format!("{:.1}", self.best),
            self.unit.to_owned(),
        ]
    }
}

/// Bytes of a copy, source and target together: for the first and second level, the shared one, and memory.
const COPIES: [usize; 5] = [16 << 10, 256 << 10, 1 << 20, 8 << 20, 256 << 20];

/// Measures all limits, taking turns `repeats` times.
pub fn run(repeats: usize) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    let mut buffers = COPIES.map(|bytes| (vec![1u64; bytes / 16], vec![0u64; bytes / 16]));
    let mut copies = COPIES.map(|_| Vec::new());
    let peaks: [fn(u32) -> f64; 4] =
        [chains::<f32s::X1, 10>, chains::<f32s::X4, 10>, chains::<f32s::X8, 10>, chains::<f32s::X16, 5>];
    let mut rates = peaks.map(|_| Vec::new());
    for _ in 0..repeats {
        for ((from, to), samples) in buffers.iter_mut().zip(&mut copies) {
            samples.push(copy(from, to));
        }
        for (peak, samples) in peaks.iter().zip(&mut rates) {
            samples.push(peak(20_000));
        }
    }
    let best = |samples: &[f64]| samples.iter().copied().fold(0.0, f64::max);
    for (&bytes, samples) in COPIES.iter().zip(&copies) {
        let (median, best) = (median(samples), best(samples));
        rows.push(Row { what: "copy", bytes, level: level(bytes), lanes: 0, median, best, unit: "bytes" });
    }
    for (lanes, samples) in [1, 4, 8, 16].into_iter().zip(&rates) {
        let (median, best) = (median(samples), best(samples));
        let (what, level, unit) = ("multiply, add", "registers", "lane operations");
        rows.push(Row { what, bytes: 0, level, lanes, median, best, unit });
    }
    rows
}

/// GB/s, read and written.
fn copy(from: &[u64], to: &mut [u64]) -> f64 {
    let bytes = size_of_val(from) * 2;
    // Enough calls that the clock's own cost vanishes.
    let calls = ((8 << 20) / bytes).max(1);
    let start = Instant::now();
    for _ in 0..calls {
        to.copy_from_slice(black_box(from));
        black_box(&mut *to);
    }
    (bytes * calls) as f64 / start.elapsed().as_secs_f64() * 1e-9
}

/// 10⁹ lane operations per second in `CHAINS` chains of x·m + a, each of which waits for itself alone.
fn chains<L: Lanes<Elem = f32>, const CHAINS: usize>(links: u32) -> f64 {
    let (m, a) = (black_box(L::lit(0.999)), black_box(L::lit(0.001)));
    let mut x = [L::one(); CHAINS];
    let start = Instant::now();
    for _ in 0..links {
        for x in &mut x {
            *x = *x * m + a;
        }
    }
    let elapsed = start.elapsed().as_secs_f64();
    black_box(x);
    f64::from(links) * (CHAINS * L::WIDTH * 2) as f64 / elapsed * 1e-9
}

/// The smallest cache that holds so many bytes, by the processor's own account.
#[cfg(target_arch = "x86_64")]
fn level(bytes: usize) -> &'static str {
    let Some(caches) = raw_cpuid::CpuId::new().get_cache_parameters() else { return "unknown" };
    let size = |c: raw_cpuid::CacheParameter| {
        c.associativity() * c.physical_line_partitions() * c.coherency_line_size() * c.sets()
    };
    let holds = caches
        .filter(|c| c.cache_type() != raw_cpuid::CacheType::Instruction && size(*c) >= bytes)
        .map(|c| c.level())
        .min();
    match holds {
        Some(1) => "L1",
        Some(2) => "L2",
        Some(3) => "L3",
        Some(_) => "L4",
        None => "memory",
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn level(_bytes: usize) -> &'static str {
    "unknown"
}

/// A stage beside its limit.
#[derive(Clone, Debug, Serialize)]
pub struct Share {
    /// The stage's kernel.
    pub stage: String,
    /// What it ran on.
    pub scene: String,
    /// What an element is.
    pub element: &'static str,
    /// Median time per element at 8 lanes, ns.
    pub ns: f64,
    /// Lane operations per element, at least.
    pub operations: f64,
    /// Bytes per element that stream from the level below.
    pub bytes: f64,
    /// Time its operations would take at the machine's peak at 8 lanes, ns.
    pub operations_ns: f64,
    /// Time its bytes would take at the copy bandwidth of their working set, ns.
    pub bytes_ns: f64,
    /// The longer of the two over the time it took.
    pub share: f64,
}

impl Record for Share {
    const NAME: &'static str = "limit_shares";
    const TITLE: &'static str = "Stages beside their limits";
    const COMMAND: &'static str = "lamina report --only limits,lanes,contacts,flight";
    const NOTE: &'static str = "8 lanes. Operations are counted in the kernel's text (arithmetic, comparisons, selects; \
         not loads, stores, gathers and transposes), so that the share is a lower bound of how busy the lanes are; \
         bytes are those that every call streams. The limit is the longer of the two times.";
    const HEADER: &'static [&'static str] = &[
        "stage",
        "scene",
        "element",
        "ns",
        "operations",
        "bytes",
        "operations' ns",
        "bytes' ns",
        "bound by",
        "share of limit",
    ];

    fn cells(&self) -> Vec<String> {
        let bound = if self.operations_ns > self.bytes_ns { "operations" } else { "bytes" };
        vec![
            self.stage.clone(),
            self.scene.clone(),
            self.element.to_owned(),
            format!("{:.2}", self.ns),
            format!("{:.0}", self.operations),
            format!("{:.0}", self.bytes),
            format!("{:.2}", self.operations_ns),
            format!("{:.2}", self.bytes_ns),
            bound.to_owned(),
            format!("{:.0} %", self.share * 100.0),
        ]
    }
}

/// Lane operations and streamed bytes per element of a kernel: x, y, r of the other circle; two pose rows of 32 bytes
/// (and two hulls of 128) in, a manifold out.
const KERNELS: [(&str, &str, f64, f64); 4] = [
    ("broad brute", "test", 8.0, 12.0),
    ("circle-circle", "pair", 22.0, 144.0),
    ("box-box", "pair", 200.0, 160.0),
    // Twelve axes of six products each, two searches for the facing edge, one clip.
    ("polygon-polygon (SAT)", "pair", 660.0, 416.0),
];
/// Of `soft`, the mean of a push and a relaxation with friction, per two-point and one-point contact.
const SOLVE_OPERATIONS: [f64; 2] = [130.0, 70.0];
/// Semi-implicit Euler of a body that does not spin: two velocities and two coordinates, a multiplication and an
/// addition each.
const EULER_OPERATIONS: f64 = 8.0;

/// Every stage of a report that has a limit; none where the limits were not measured.
pub fn shares(data: &Data) -> Vec<Share> {
    let peak = data.limits.iter().find(|row| row.lanes == 8).map(|row| row.median);
    let Some(peak) = peak else { return Vec::new() };
    let bandwidth = |bytes: f64| {
        let mut copies = data.limits.iter().filter(|row| row.what == "copy");
        copies.find(|row| row.bytes as f64 >= bytes).or(data.limits.iter().rfind(|row| row.what == "copy"))
    };
    let share = |stage: &str, scene: &str, element, ns: f64, operations: f64, bytes: f64, elements: usize| {
        let per_ns = bandwidth(bytes * elements as f64).map_or(f64::NAN, |row| row.median);
        let (operations_ns, bytes_ns) = (operations / peak, bytes / per_ns);
        Share {
            stage: stage.to_owned(),
            scene: scene.to_owned(),
            element,
            ns,
            operations,
            bytes,
            operations_ns,
            bytes_ns,
            share: operations_ns.max(bytes_ns) / ns,
        }
    };
    let mut rows = Vec::new();
    for row in data.flight.iter().filter(|row| row.integrator.name() == "semi_implicit_euler") {
        let scene = format!("free_flight/{}", row.bodies);
        let bytes = row.bytes_per_body as f64;
        rows.push(share("integrate", &scene, "body", row.ns_per_body, EULER_OPERATIONS, bytes, row.bodies));
    }
    for (kernel, element, operations, bytes) in KERNELS {
        let timed = data.lanes.iter().filter(|row| row.kernel == kernel && row.lanes == 8);
        // The circles of a brute search stay in the first level.
        let elements = |row: &super::lanes::Row| if element == "test" { 0 } else { row.elements };
        rows.extend(timed.map(|row| {
            share(kernel, row.scene, element, row.ns_per_element, operations, bytes, elements(row))
        }));
    }
    for row in data.contacts.iter().filter(|row| row.lanes == 8) {
        let one_point = usize::from(row.scene.starts_with("circles/"));
        let (operations, bytes) = (SOLVE_OPERATIONS[one_point], row.bytes_per_contact[one_point] as f64);
        let ns = row.ns_per_contact_and_pass;
        rows.push(share("solve, a pass", row.scene, "contact", ns, operations, bytes, row.contacts));
    }
    rows
}
