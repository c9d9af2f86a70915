mod saved;
