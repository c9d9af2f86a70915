%BOM
; The file begins with a byte order mark
N10 G01 X50 F1500
N20 M30
