//! Options of pictures and of what they show, each group in one struct: flags of the command line (by the feature `clap`),
//! keywords of Python and files of JSON have the same names, values and messages.
//!
//! An option is added where its group is, [`groups`], and is everywhere.
#![forbid(unsafe_code)]

mod alike;
mod edit_recipe;
mod error;
mod given;
#[cfg(feature = "clap")]
mod given_picture;
pub mod groups;
mod keywords;
mod picture;
pub mod words;

pub use edit_recipe::{EditRecipe, OF_UNIT};
pub use error::OptionError;
pub use given::text_of;
#[cfg(feature = "clap")]
pub use given_picture::GivenPicture;
pub use keywords::set_option;
pub use picture::{MeshesBeside, Picture};
