//! Chapter 5.1: from programs to commanded traces, rule by rule.

mod motion;
