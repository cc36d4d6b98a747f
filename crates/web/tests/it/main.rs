//! Pages: what is in them, and what a browser makes of them.

mod browser;
mod browsing;
mod by_processor;
mod contents;
mod core;
mod dropping;
mod unpacked;
mod widget;
mod written;

neurotess_testing::main!();
