//! How results are shown, whoever found them: rows as tables and CSV, drawings, times and machines.

pub(crate) mod chart;
mod earlier;
mod machine;
pub(crate) mod table;
pub(crate) mod timing;

pub use earlier::Earlier;
pub use machine::Machine;
pub use table::{Record, Table};
pub use timing::{Timing, fitted_exponent, median};
