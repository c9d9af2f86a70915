mod advice;
mod lints;
mod model;
mod program;
mod saved;
mod sessions;
mod undescribed;
mod versions;
