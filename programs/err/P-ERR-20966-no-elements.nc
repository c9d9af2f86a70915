; wrong: an array of no elements
N10 #VAR
V.P.TABLE[0]
#ENDVAR
N20 M30
