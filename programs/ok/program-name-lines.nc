%L RETRACT (local subprogram: a blank follows the L)
N10 G00 Z100
N20 M17

%L PARK ; its end is the next percent line
N30 G00 X0 Y0

% LEVEL (main program, a blank may stand in front of the name)
N40 LL RETRACT
N50 LL PARK
N60 M30
