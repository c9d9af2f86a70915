//! The language server from the client's point of view.

mod calls;
pub(crate) mod client;
mod contour;
mod fixes;
mod healing;
mod lifecycle;
mod messages;
mod pulled;
mod scripts;
mod shown;
mod typing;
