%COOLANT
; wrong: a letter outside ASCII in a message without quotes
N10 #MSG [Kühlung ein]
N20 G01 X50 F1500
N30 M30
