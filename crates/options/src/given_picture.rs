//! A picture as flags give it, with what was given: the options of another one are taken for the rest.

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches};

use crate::Picture;

/// A picture as flags give it, and the names of the options that were given.
#[derive(Clone, Debug, Default)]
pub struct GivenPicture {
    /// The picture.
    pub picture: Picture,
    /// Names of the options that were given.
    pub given: Vec<String>,
}

impl Args for GivenPicture {
    fn augment_args(command: Command) -> Command {
        Picture::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Picture::augment_args_for_update(command)
    }
}

impl FromArgMatches for GivenPicture {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let picture = Picture::from_arg_matches(matches)?;
        let known = |name: &String| matches.try_contains_id(name).is_ok();
        let given = |name: &String| {
            known(name) && matches.value_source(name) == Some(ValueSource::CommandLine)
        };
        let names = Picture::keywords().into_iter().map(|(name, _)| name);
        Ok(Self {
            picture,
            given: names.filter(given).collect(),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
