//! The machine and the build that numbers come from.

use serde::Serialize;

use crate::stamp::{PROFILE, STAMP};

/// Where and with which build something was measured. Names no host and no path.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// The processor's own name.
    pub cpu: String,
    /// Threads the system offers; the engine uses one.
    pub threads: usize,
    /// Operating system and architecture.
    pub os: String,
    /// The compiler.
    pub rustc: &'static str,
    /// Profile and optimisation level.
    pub build: &'static str,
    /// Flags given to the compiler.
    pub flags: &'static str,
    /// Vector features the code was compiled for.
    pub features: Vec<&'static str>,
    /// The commit it was built from.
    pub commit: &'static str,
    /// This crate's version.
    pub version: &'static str,
    /// When this was asked, UTC.
    pub when: String,
}

impl Machine {
    /// This machine and this build.
    pub fn read() -> Self {
        Self {
            cpu: cpu_name(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            os: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            rustc: STAMP.rustc,
            build: PROFILE,
            flags: STAMP.flags,
            features: lamina2d::processor::features(),
            commit: STAMP.commit,
            version: env!("CARGO_PKG_VERSION"),
            when: humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn cpu_name() -> String {
    let brand = raw_cpuid::CpuId::new().get_processor_brand_string();
    brand.map_or_else(|| "unknown x86-64".to_owned(), |b| b.as_str().trim().to_owned())
}

#[cfg(not(target_arch = "x86_64"))]
fn cpu_name() -> String {
    std::env::consts::ARCH.to_owned()
}
