%REVERSAL
N10 G01 X0 F60 (the trace begins here)
N20 X0.02
N30 X0
N40 X[COMP OFF FRICT] ; frictcomp: allow FC407 the example ends with it
N50 X0.005
N60 M30
