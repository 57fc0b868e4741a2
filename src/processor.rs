//! Does this processor have the instructions the program was built for?
//!
//! `is_x86_feature_detected!` answers from the compiler's flags where they promise a feature, so the
//! processor itself is asked.

/// Refuses a processor without the features this build relies on; programs ask before all else.
///
/// # Errors
/// A sentence that says what is missing and what to do.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2"))]
#[inline(never)]
pub fn check() -> Result<(), &'static str> {
    let cpu = raw_cpuid::CpuId::new();
    let avx =
        cpu.get_feature_info().is_some_and(|f| f.has_avx() && f.has_fma() && f.has_movbe() && f.has_oxsave());
    let avx2 = cpu.get_extended_feature_info().is_some_and(|f| f.has_avx2() && f.has_bmi1() && f.has_bmi2());
    if avx && avx2 {
        Ok(())
    } else {
        Err("this program was built for x86-64-v3 (AVX2), which this processor does not have; \
             rebuild it with RUSTFLAGS=\"-C target-cpu=x86-64\"")
    }
}

/// Other builds rely on nothing beyond their target's baseline.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2")))]
#[expect(clippy::unnecessary_wraps, reason = "one signature for all targets")]
pub fn check() -> Result<(), &'static str> {
    Ok(())
}

/// Vector features the code was compiled for.
pub fn features() -> Vec<&'static str> {
    let features = [
        ("sse2", cfg!(target_feature = "sse2")),
        ("avx", cfg!(target_feature = "avx")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("avx512f", cfg!(target_feature = "avx512f")),
    ];
    features.into_iter().filter(|(_, has)| *has).map(|(name, _)| name).collect()
}
