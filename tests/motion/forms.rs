//! R5.1 and R5.3: what lines, arcs and dwells are followed along.
