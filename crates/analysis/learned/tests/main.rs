//! Learned branches: one program, for what trains them is compiled anew in each.
#![allow(clippy::unwrap_used)]

mod bounded;
mod derivatives;
mod horizon;
mod learning;
mod papers;
mod ships;

#[path = "../../../../tests/examples/branches/paper_i.rs"]
#[allow(dead_code)]
mod paper_i;
#[path = "../../../../tests/examples/branches/paper_ii.rs"]
#[allow(dead_code)]
mod paper_ii;
#[path = "../../../../tests/examples/branches/paper_iii.rs"]
#[allow(dead_code)]
mod paper_iii;
#[path = "../../../../tests/examples/branches/paper_iv.rs"]
#[allow(dead_code)]
mod paper_iv;
#[path = "../../../../tests/examples/branches/paper_vi.rs"]
#[allow(dead_code)]
mod paper_vi;
#[path = "../../../../tests/examples/branches/vessel/mod.rs"]
#[allow(dead_code)]
mod vessel;
