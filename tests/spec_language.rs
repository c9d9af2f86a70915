//! Chapter 2: the language, rule by rule.

mod language;
mod support;
