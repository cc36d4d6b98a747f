//! Tracings mended, compared and measured on the command line: `convert` with edits, `diff`, packed files,
//! tables of `info`.
//! Nothing here needs the features of pictures and windows.

mod compare;
mod mend;
mod neurom;
mod packed;
mod page;
mod spines;
mod table;
