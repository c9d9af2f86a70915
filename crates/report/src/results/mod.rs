//! The results of the commands, each as a document and as data.

pub mod ask;
pub mod audit;
pub mod circle;
pub mod commission;
pub mod compare;
pub mod configuration;
pub mod contour;
pub mod current;
pub mod drives;
pub mod identify;
pub mod learn;
pub mod lists;
pub mod replay;
pub mod schema;
pub mod stiction;
pub mod trace;
pub mod trend;
pub mod tune;
pub mod verify;
