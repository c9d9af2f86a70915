%CRLF
; Line ends of Windows, also after a continued line
N10 X[COMP OFF \
N20 FRICT]
N30 G01 X50 F1500
N40 X[COMP ON FRICT]
N50 M30
