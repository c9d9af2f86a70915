//! Option values with the words of the library.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use frictcomp_physics::simulation::FrictionModel;
use frictcomp_report::{ListingFormat, TimelineFormat};

/// Parses the word of a friction model.
pub(crate) fn friction_model() -> impl TypedValueParser<Value = FrictionModel> {
    one_of(&FrictionModel::ALL, |it| (it.as_str(), it.title()))
}

/// Parses the word of a format of messages.
pub(crate) fn listing_format() -> impl TypedValueParser<Value = ListingFormat> {
    one_of(&ListingFormat::ALL, |it| (it.as_str(), it.title()))
}

/// Parses the word of a format of the timeline.
pub(crate) fn timeline_format() -> impl TypedValueParser<Value = TimelineFormat> {
    one_of(&TimelineFormat::ALL, |it| (it.as_str(), it.title()))
}

/// Parses one of several values, each of which has a word and a title.
fn one_of<T: Copy + Send + Sync + 'static>(
    values: &'static [T],
    named: fn(T) -> (&'static str, &'static str),
) -> impl TypedValueParser<Value = T> {
    let possible = values.iter().map(move |&value| {
        let (word, title) = named(value);
        PossibleValue::new(word).help(title)
    });
    PossibleValuesParser::new(possible).map(move |word| {
        let mut values = values.iter();
        *values
            .find(|&&value| named(value).0 == word)
            .expect("the word of one of them")
    })
}
