//! How this machine rounds: machines that do alike give the same bits.

use armill_core::kernel::lanes::Backend;
use pyo3::prelude::*;

/// -> str: `fused` where a product and a sum are rounded once, `plain` where each is. Machines of one kind give the same bits.
#[pyfunction]
pub(crate) fn arithmetic() -> &'static str {
    if Backend::fastest().fuses() {
        "fused"
    } else {
        "plain"
    }
}
