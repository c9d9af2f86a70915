mod config;
mod drive;
mod host;
mod robust;
mod values;
mod written;
