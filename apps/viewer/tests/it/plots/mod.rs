//! Plots in the window.

mod measures;
mod traces;
