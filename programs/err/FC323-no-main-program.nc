; wrong: a blank after L makes it a subprogram, and nothing calls it
%L POCKET
N10 X[COMP OFF FRICT]
N20 G1 X50 F1000
N30 X[COMP ON FRICT]
N40 M17
