N10 #VAR
V.P.TABLE[3]
#ENDVAR
; wrong: which element?
N20 P1 = V.P.TABLE
N30 M30
