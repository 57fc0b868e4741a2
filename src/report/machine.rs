//! The machine and the build that numbers come from.

use serde::Serialize;

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
}

impl Machine {
    /// This machine and this build.
    pub fn read() -> Self {
        Self {
            cpu: cpu_name(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            os: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            rustc: env!("LAMINA_RUSTC"),
            build: env!("LAMINA_PROFILE"),
            flags: env!("LAMINA_FLAGS"),
            features: crate::build_features(),
            commit: env!("LAMINA_COMMIT"),
            version: env!("CARGO_PKG_VERSION"),
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
