N10 #VAR
V.I.LIMITS[3]
#ENDVAR
N20 X10
; wrong: the array is there, with three elements
N30 #VAR
V.I.LIMITS[4]
#ENDVAR
N40 M30
