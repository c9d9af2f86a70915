; wrong: names of programs are ASCII
%Läufer
N10 X[COMP OFF FRICT]
N20 X[COMP ON FRICT]
N30 M30
