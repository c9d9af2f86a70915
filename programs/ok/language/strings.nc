%STRINGS
N10 V.P.S = "Hello" + " world!"
N20 P1 = LEN[V.P.S]
N30 P2 = FIND[V.P.S, "world"]
N40 P3 = ORD["H"]
N50 V.P.T = LEFT[V.P.S, 5] + MID[V.P.S, 3, 7] + RIGHT[V.P.S, 1]
$IF P1 == 12 && P2 == 7 && P3 == 72 && V.P.T == "Hellowor!"
N60 X[COMP OFF FRICT]
$ENDIF
N70 X[COMP ON FRICT]
N80 M30
