%ENDLESS
; wrong: the loop has no end
N10 P1 = 0
N20 $WHILE 1
N30 P1 = P1 + 1
N40 $ENDWHILE
N50 M30
