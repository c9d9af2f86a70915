%L STEP
; wrong: the subprogram calls itself without an end
N10 G91 G01 X1 F1500
N20 LL STEP
N30 M17
%STAIRS
N40 LL STEP
N50 M30
