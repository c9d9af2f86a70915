%WIDE
; Blanks and tabs are free between the tokens of a command
N10 X [COMP OFF FRICT]
N20 G01 X50 F1500
N30	X[	COMP	ON	FRICT	]
N40 M30
