//! A virtual ship for the systems of Kanazawa 2023, where his own was a co-simulation: two azimuth
//! thrusters under one order, as on R/V Gunnerus, by a law that `derive` writes from that list; in
//! wind, current and waves of which its foundation knows the wind alone.
//!
//! The foundation is the zoo's `gunnerus-34m`, a law of another form. The hull's coefficients were
//! fitted to what that law gives over the whole range of motion, so that the two differ by form
//! (foils and powers of the speeds there, a polynomial with sines here); what a foundation has
//! wrong besides is put into it by Eq. 4.6.

pub mod foundation;
pub mod hull;
pub mod sailed;
pub mod scenarios;
pub mod seas;
pub mod seaway;
pub mod weather;
