mod model;
mod program;
mod saved;
mod sessions;
mod undescribed;
mod versions;
mod ways;
mod ways_given;
