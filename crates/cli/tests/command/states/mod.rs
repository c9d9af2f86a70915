mod saved;
mod undescribed;
mod versions;
