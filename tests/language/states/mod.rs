mod model;
mod program;
mod saved;
mod sessions;
mod ways;
mod ways_given;
