N10 #CLEAR CONFIG
; wrong: nothing is saved any more
N20 #LOAD CONFIG [AX]
N30 M30
