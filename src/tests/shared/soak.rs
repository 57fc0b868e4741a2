//! Long runs of cases of stability.

use lamina::stress::{CASES, Case, run};
use lamina2d::settings::Settings;

pub(crate) fn case(name: &str) -> &'static Case {
    CASES.iter().find(|case| case.name == name).expect("a case")
}

pub(crate) fn at_8() -> Settings {
    Settings { substeps: 8, ..Settings::default() }
}

/// T24 for so many steps: a pile, a net and a tumbler in which bodies come and go.
pub(crate) fn soak(name: &str, steps: u64) {
    let case = case(name);
    let secs = steps as f64 / 60.0;
    let row = run(case, case.parameter.value, at_8(), secs).expect("a scene that can be run");
    println!("{name}, {steps} steps: {:?} {:?}", row.metrics, row.found);
    assert!(row.pass, "{name}: {} asked, {:?} found, {:?}", row.threshold, row.found, row.failed);
}
