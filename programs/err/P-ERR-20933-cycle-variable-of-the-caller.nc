%L SUB
; wrong: the variable belongs to the main program
N10 #DELETE V.CYC.DEPTH
N20 M17
%MAIN
N30 V.CYC.DEPTH = 3
N40 LL SUB
N50 M30
