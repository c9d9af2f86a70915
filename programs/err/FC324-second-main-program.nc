; wrong: a file runs its first main program, and this one has two
%FIRST
N10 X[COMP OFF FRICT]
N20 X[COMP ON FRICT]
N30 M30
%SECOND
N10 X[COMP OFF FRICT]
N20 M30
