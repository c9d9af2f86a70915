//! The formats of messages: each is a file and a row of the table.

use crate::wording::Look;

use super::carets::Carets;
use super::concise::Concise;
use super::github::GitHub;
use super::gitlab::GitLab;
use super::junit::JUnit;
use super::message_format::MessageFormat;
use super::objects::Objects;
use super::sarif::Sarif;

/// Contents that a format supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Holds {
    /// Messages alone.
    Messages,
    /// Results of other kinds too.
    Records,
}

macro_rules! formats {
    ($($(#[$meta:meta])* $format:ident $name:literal $title:literal $holds:ident $begin:expr;)+) => {
        /// A format for diagnostics.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
        #[non_exhaustive]
        pub enum ListingFormat {
            $(#[doc = concat!($title, ".")] $(#[$meta])* $format,)+
        }

        impl ListingFormat {
            /// Every format.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$format),+];

            /// Returns the name of the format.
            pub fn as_str(self) -> &'static str {
                match self { $(Self::$format => $name,)+ }
            }

            /// Returns the meaning in a few words.
            pub fn title(self) -> &'static str {
                match self { $(Self::$format => $title,)+ }
            }

            fn holds(self) -> Holds {
                match self { $(Self::$format => Holds::$holds,)+ }
            }

            /// Begins a list; `look` matters for text only.
            pub(super) fn begin(self, look: Look) -> Box<dyn MessageFormat + Send> {
                let begin: fn(Look) -> Box<dyn MessageFormat + Send> = match self {
                    $(Self::$format => $begin,)+
                };
                begin(look)
            }
        }
    };
}

formats! {
    #[default]
    Text "text" "Source lines with carets, for people" Records |look| Box::new(Carets::new(look));
    Concise "concise" "One line per message" Records |_| Box::new(Concise);
    Json "json" "One JSON document" Records |_| Box::new(Objects::document());
    Ndjson "ndjson" "One JSON object per line" Records |_| Box::new(Objects::lines());
    Github "github" "GitHub workflow commands" Messages |_| Box::new(GitHub);
    Gitlab "gitlab" "GitLab Code Quality report" Messages |_| Box::new(GitLab::default());
    Junit "junit" "JUnit report" Messages |_| Box::new(JUnit::default());
    Sarif "sarif" "SARIF 2.1.0" Messages |_| Box::new(Sarif::default());
}

impl ListingFormat {
    /// Returns whether it is for diagnostics only, without records of other kinds.
    pub fn is_for_diagnostics(self) -> bool {
        self.holds() == Holds::Messages
    }
}
