%CONTINUED
N10 G1 X10 \
N11 Y20 \ ; the word goes on
    F1500
N20 X[COMP OFF \
    (comment lines may stand between)

N21 FRICT]
N30 #VAR
V.P.STEPS[4] = [1, 2, \
3, 4]
#ENDVAR
N40 X[COMP ON FRICT]
N50 M30
