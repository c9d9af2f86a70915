; wrong: the language has no exponents
N10 G01 X1E2 F1000
N20 M30
