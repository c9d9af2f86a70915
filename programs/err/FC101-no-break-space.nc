%PASTED
; wrong: a no-break space, pasted from a document, stands after G01
N10 G90
N20 G01 X50 F1500
N30 M30
